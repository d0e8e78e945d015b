// Which columns of a motion are drawn as curves: groups of one unit.
import { $, make } from "./dom.js";

const KINDS = { m: "Positions (m)", "m/s": "Velocities (m/s)", rad: "Angles (rad)", "rad/s": "Angular velocities (rad/s)", N: "Forces (N)", "N m": "Torques (N m)", J: "Energies (J)", 1: "Attitudes" };
const MOST = 12, COLORS = ["deep", "warm", "third", "stable", "separatrix", "soft"];
/** Curves of one chart, in six colours with and without dashes. */

const varies = ({ data }) => data.some((x) => x !== data[0]);

/** Columns by kind, each component by itself: `{label, data, unit}`. */
export function columnGroups(columns) {
  const groups = new Map();
  for (const [name, { unit, values }] of Object.entries(columns)) {
    const kind = KINDS[unit] || unit, plain = name.replace(".position", "").replace(".velocity", "");
    if (!groups.has(kind)) groups.set(kind, []);
    if (Array.isArray(values[0])) values[0].forEach((_, k) => groups.get(kind).push({ label: `${plain} ${unit === "1" && values[0].length === 4 ? "wxyz"[k] : "xyz"[k]}`, data: values.map((v) => v?.[k] ?? null), unit }));
    else groups.get(kind).push({ label: name, data: values, unit });
  }
  return groups;
}

export class CurveChoice {
  constructor(chart) {
    Object.assign(this, { chart, groups: new Map(), time: [] });
    $("curves").onchange = () => this.show();
  }

  /** Offer the columns of a trajectory; the kind that was chosen stays. */
  offer(trajectory) {
    this.groups = columnGroups(trajectory?.columns || {});
    this.time = trajectory?.time || [];
    const { groups } = this, before = $("curves").value;
    $("curves").replaceChildren(...[...groups.keys()].map((kind) => make("option", { textContent: kind })));
    if (groups.has(before)) $("curves").value = before;
    else $("curves").value = ["Angles (rad)", ...groups.keys()].find((kind) => groups.get(kind)?.some(varies)) ?? [...groups.keys()][0] ?? "";
    this.show();
  }

  show() {
    const list = this.groups.get($("curves").value)?.slice(0, MOST);
    if (!list) return this.chart.clear();
    const series = list.map(({ label }, i) => ({ label, color: COLORS[i % 6], dash: i < 6 ? undefined : [6, 4] }));
    this.chart.show(series, [this.time, ...list.map((c) => c.data)]);
    return $("chart").setAttribute("aria-label", `${$("curves").value} over time: ${series.map((s) => s.label).join(", ")}`);
  }
}

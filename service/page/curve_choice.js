// Which columns of a motion are drawn, against time or against one another, beside those of another run; and as a table.
import { $, make, written } from "./dom.js";
import { PlaneChart } from "./plane_chart.js";

const KINDS = { m: "Positions", "m/s": "Velocities", rad: "Angles", "rad/s": "Angular velocities", N: "Forces", "N m": "Torques", J: "Energies", 1: "Attitudes" };
const MOST = 12, COLORS = ["deep", "warm", "third", "stable", "separatrix", "soft"], ROWS = 41;
/** Curves of one chart, in six colours with and without dashes; rows of the table. */

const varies = ({ data }) => data.some((x) => x !== data[0]);
const titled = (label, unit) => (unit === "1" ? label : `${label} (${unit})`);

/** Columns by kind, each component by itself: `{label, data, unit}`. */
export function columnGroups(columns) {
  const groups = new Map();
  for (const [name, { unit, values }] of Object.entries(columns)) {
    const kind = titled(KINDS[unit] || "Others", unit), plain = name.replace(".position", "").replace(".velocity", " velocity");
    if (!groups.has(kind)) groups.set(kind, []);
    if (Array.isArray(values[0])) values[0].forEach((_, k) => groups.get(kind).push({ label: `${plain} ${unit === "1" && values[0].length === 4 ? "wxyz"[k] : "xyz"[k]}`, data: values.map((v) => v?.[k] ?? null), unit }));
    else groups.get(kind).push({ label: name, data: values, unit });
  }
  return groups;
}

export class CurveChoice {
  /** `chart` draws against time; `player` has the time that is marked. */
  constructor(chart, player) {
    this.chart = chart;
    /** @type {Map<string, any[]>} */
    this.groups = new Map();
    /** @type {number[]} */
    this.time = [];
    /** @type {any} */
    this.other = null;
    this.plane = new PlaneChart($("plane-chart"), player, 300);
    for (const name of ["curves", "against", "table-shown"]) $(name).onchange = () => this.show();
  }

  /** Offer the columns of a trajectory; what was chosen stays where it can. */
  offer(trajectory) {
    this.groups = columnGroups(trajectory?.columns || {});
    this.time = trajectory?.time || [];
    const all = [...this.groups.values()].flat(), options = [...this.groups.keys()].map((kind) => make("option", { textContent: kind }));
    const single = (list) => list.map((c) => make("option", { value: c.label, textContent: titled(c.label, c.unit) }));
    this.refill($("curves"), [make("optgroup", { label: "All of a kind" }, ...options), make("optgroup", { label: "One" }, ...single(all))], ["Angles (rad)", ...this.groups.keys()].find((kind) => this.groups.get(kind)?.some(varies)) ?? [...this.groups.keys()][0] ?? "");
    this.refill($("against"), [make("option", { value: "", textContent: "time (s)" }), ...single(all)], "");
    this.show();
  }

  refill(select, content, otherwise) {
    const before = select.value;
    select.replaceChildren(...content);
    select.value = before;
    if (select.selectedIndex < 0 || (before === "" && otherwise)) select.value = otherwise;
  }

  chosen(groups) {
    const name = $("curves").value;
    return groups.get(name)?.slice(0, MOST) ?? [...groups.values()].flat().filter((c) => c.label === name);
  }

  /** Show curves of another run beside this one: `{trajectory, words}`, or null. */
  compare(other) {
    this.other = other && { groups: columnGroups(other.trajectory.columns), time: other.trajectory.time, words: other.words };
    this.show();
  }

  show() {
    const list = this.chosen(this.groups), across = [...this.groups.values()].flat().find((c) => c.label === $("against").value);
    const beside = this.other ? this.chosen(this.other.groups) : [];
    $("chart").hidden = Boolean(across) || !list.length;
    $("plane-chart").hidden = !across || !list.length;
    if (!list.length) return this.chart.clear();
    const named = [...list.map((c, i) => ({ ...c, color: COLORS[i % 6], dash: i < 6 ? undefined : [6, 4], time: this.time })), ...beside.map((c, i) => ({ ...c, label: `${c.label}, ${this.other.words}`, color: COLORS[i % 6], dash: [3, 4], time: this.other.time }))];
    const words = `${$("curves").value} over ${across ? across.label : "time"}: ${named.map((c) => c.label).join(", ")}`;
    if (across) {
      const others = this.other && [...this.other.groups.values()].flat().find((c) => c.label === across.label);
      const curves = named.map((c) => ({ ...c, x: c.time === this.time ? across.data : others?.data ?? [], y: c.data })).filter((c) => c.x.length === c.y.length);
      this.plane.show(curves, this.time, [titled(across.label, across.unit), list.length === 1 ? titled(list[0].label, list[0].unit) : $("curves").value]);
    } else this.chart.show(named, [this.time, ...named.map((c) => (c.time === this.time ? c.data : sampled(c, this.time)))], { live: true, unit: list.length === 1 ? titled(list[0].label, list[0].unit) : $("curves").value });
    for (const id of ["chart", "plane-chart"]) $(id).setAttribute("aria-label", words);
    this.table(list);
  }

  table(list) {
    $("table").hidden = !$("table-shown").checked;
    if ($("table").hidden) return;
    const rows = [...new Set([...Array(Math.min(ROWS, this.time.length)).keys()].map((k, _, all) => Math.round((k * (this.time.length - 1)) / Math.max(1, all.length - 1))))];
    const head = make("tr", {}, make("th", { scope: "col", textContent: "time (s)" }), ...list.map((c) => make("th", { scope: "col", textContent: titled(c.label, c.unit) })));
    const body = rows.map((k) => make("tr", {}, make("th", { scope: "row", textContent: written(this.time[k], 6) }), ...list.map((c) => make("td", { textContent: c.data[k] === null ? "none" : written(c.data[k], 8) }))));
    $("table").replaceChildren(make("table", {}, make("thead", {}, head), make("tbody", {}, ...body)));
  }
}

/** Values of a column at other times, between its own; none beyond them. */
function sampled({ time, data }, times) {
  let k = 0;
  return times.map((t) => {
    while (k < time.length - 2 && time[k + 1] < t) k++;
    const step = time[k + 1] - time[k];
    if (t > time.at(-1) * (1 + 1e-12) || !(step > 0) || data[k] === null || data[k + 1] === null) return null;
    return data[k] + ((t - time[k]) / step) * (data[k + 1] - data[k]);
  });
}

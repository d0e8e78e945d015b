// A figure of a study over two of its inputs: coloured cells between axes, a colour bar, and the cell under the pointer; drawn by uPlot.
import { color, make, onTheme, written } from "./dom.js";
import { tickWords } from "./plots.js";
import uPlot from "./vendor/uplot.js";

const HEIGHT = 420, BAR = 104, SHADES = 64;
/** Pixels of the map's height and of the colour bar's width; steps of the colour bar. */

/** Colours from dark to light, of equal steps in lightness. */
export const shade = (share) => `hsl(${250 - 200 * share} 70% ${20 + 65 * share}%)`;

/** The levels of an input along an axis: where cells begin and end, and in words. Levels that are no growing numbers are counted. */
export function axisOf({ pointer, unit }, levels) {
  const growing = levels.every((x, k) => typeof x === "number" && (k === 0 || x > levels[k - 1]));
  const places = growing ? levels : levels.map((_, k) => k), first = places[1] - places[0] || Math.abs(places[0]) || 1, last = places.at(-1) - places.at(-2) || first;
  const edges = [places[0] - first / 2, ...places.slice(1).map((x, k) => (x + places[k]) / 2), places.at(-1) + last / 2];
  const words = (k) => (typeof levels[k] === "number" ? written(levels[k], 5) : JSON.stringify(levels[k]));
  const ticks = growing ? tickWords : (plot, values) => values.map((v) => (Number.isInteger(v) && v >= 0 && v < levels.length ? words(v) : ""));
  return { edges, words, ticks, pointer, label: unit && unit !== "1" ? `${pointer} (${unit})` : pointer, count: levels.length };
}

/** The cell that has a value, or -1. */
const cellAt = ({ edges, count }, value) => {
  const k = edges.findIndex((edge) => edge > value) - 1;
  return k >= 0 && k < count ? k : -1;
};

/** Axes in the colours of the theme. */
export const axisInk = () => ({ stroke: color("soft"), grid: { show: false }, ticks: { stroke: color("line"), width: 1 }, font: "12px system-ui", labelFont: "12px system-ui", labelSize: 18 });

export class StudyMap {
  /** `said` receives the cell under the pointer in words; `open(member)` is called for a cell that is pressed. */
  constructor(panel, said, open) {
    this.panel = panel;
    this.said = said;
    this.open = open;
    /** @type {any} */
    this.shown = null;
    /** @type {any[]} */
    this.plots = [];
    this.at = [0, 0];
    /** @type {number | null} */
    this.hovered = null;
    this.map = make("div", { className: "map", tabIndex: 0, role: "application" });
    this.bar = make("div", { className: "bar", "aria-hidden": "true" });
    panel.append(this.map, this.bar);
    this.map.onkeydown = (event) => this.key(event);
    new ResizeObserver(() => this.plots[0]?.setSize({ width: this.width, height: HEIGHT })).observe(panel);
    onTheme(() => this.shown && this.show(this.shown));
  }

  get width() {
    return Math.max(200, this.panel.clientWidth - BAR - 8);
  }

  /** Show `values` by member, the second axis varying fastest, between `low` and `high`; `unit` is of the values. */
  show(shown) {
    this.shown = shown;
    const { slow, fast, values, low, high, unit, name } = shown, span = high - low || 1;
    for (const plot of this.plots) plot.destroy();
    const cells = (plot) => this.cells(plot, (value) => (value === null ? color("line") : shade((value - low) / span)));
    const middles = values.map((_, k) => [Math.floor(k / fast.count), k % fast.count].map((i, d) => (([slow, fast][d].edges[i] + [slow, fast][d].edges[i + 1]) / 2)));
    const map = new uPlot({
      mode: 2, width: this.width, height: HEIGHT, legend: { show: false },
      scales: { x: { time: false, range: [slow.edges[0], slow.edges.at(-1)] }, y: { range: [fast.edges[0], fast.edges.at(-1)] } },
      axes: [{ ...axisInk(), size: 44, label: slow.label, values: slow.ticks }, { ...axisInk(), size: 58, label: fast.label, values: fast.ticks }],
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      hooks: { setCursor: [(plot) => this.hover(plot)] },
      series: [{}, { paths: cells, facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }] }],
    }, [null, [middles.map(([x]) => x), middles.map(([, y]) => y)]], this.map);
    map.over.addEventListener("click", () => this.hovered !== null && this.open(this.hovered));
    const steps = [...Array(SHADES + 1).keys()].map((k) => low + (span * k) / SHADES);
    const bar = new uPlot({
      mode: 2, width: BAR, height: HEIGHT, padding: [null, 0, null, 0], legend: { show: false }, cursor: { show: false },
      scales: { x: { time: false, range: [0, 1] }, y: { range: [low, low + span] } },
      axes: [{ ...axisInk(), size: 44, label: " ", values: () => [], ticks: { show: false } }, { ...axisInk(), side: 1, size: 58, label: unit || "value", values: tickWords }],
      series: [{}, { paths: (plot) => stripes(plot, steps, low, span), facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }] }],
    }, [null, [steps.map(() => 0.5), steps]], this.bar);
    this.plots = [map, bar];
    this.hovered = null;
    this.map.setAttribute("aria-label", `Map of ${name} over ${slow.pointer} and ${fast.pointer}, from ${written(low)} to ${written(high)}${unit && ` ${unit}`}. Arrow keys go from cell to cell, Enter opens one`);
  }

  cells(plot, ink) {
    const { slow, fast, values } = this.shown, x = slow.edges.map((v) => Math.round(plot.valToPos(v, "x", true))), y = fast.edges.map((v) => Math.round(plot.valToPos(v, "y", true)));
    values.forEach((value, k) => {
      const i = Math.floor(k / fast.count), j = k % fast.count;
      plot.ctx.fillStyle = ink(value);
      plot.ctx.fillRect(x[i], y[j + 1], x[i + 1] - x[i], y[j] - y[j + 1]);
    });
    return null;
  }

  hover(plot) {
    const { left, top } = plot.cursor;
    if (!(left >= 0)) return;
    this.at = [cellAt(this.shown.slow, plot.posToVal(left, "x")), cellAt(this.shown.fast, plot.posToVal(top, "y"))];
    this.say();
  }

  /** Say what the cell has at which the pointer or the keys are. */
  say() {
    const [i, j] = this.at, { slow, fast, values, unit } = this.shown;
    this.hovered = i < 0 || j < 0 ? null : i * fast.count + j;
    if (this.hovered === null) return;
    const value = values[this.hovered];
    this.said.textContent = `${slow.pointer} ${slow.words(i)}, ${fast.pointer} ${fast.words(j)}: ${value === null ? "no value" : `${written(value)}${unit && ` ${unit}`}`}`;
  }

  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key], { slow, fast } = this.shown;
    if (event.key === "Enter" && this.hovered !== null) this.open(this.hovered);
    if (!step) return;
    event.preventDefault();
    this.at = this.at.map((k, d) => Math.max(0, Math.min([slow, fast][d].count - 1, k + step[d])));
    this.say();
  }
}

/** The colours of a bar from its lowest to its highest value. */
function stripes(plot, steps, low, span) {
  const { left, width } = plot.bbox;
  steps.slice(1).forEach((value, k) => {
    const top = Math.round(plot.valToPos(value, "y", true)), bottom = Math.round(plot.valToPos(steps[k], "y", true));
    plot.ctx.fillStyle = shade((value - low) / span);
    plot.ctx.fillRect(left, top, width, bottom - top);
  });
  return null;
}

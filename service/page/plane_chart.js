// A quantity against another, as in a phase plane: curves that need not go from left to right, drawn by uPlot.
import { color, onTheme } from "./dom.js";
import { tickWords } from "./plots.js";
import uPlot from "./vendor/uplot.js";

const MARGIN = 0.05;
/** Share of a range that is left free on both sides. */

/** The path of a curve given by its points, for a plot whose curves have their own places across. */
function curvePath(plot, index) {
  const [xs, ys] = plot.data[index], path = new Path2D();
  xs.forEach((x, i) => {
    if (x === null || ys[i] === null) return;
    path[i && xs[i - 1] !== null ? "lineTo" : "moveTo"](plot.valToPos(x, "x", true), plot.valToPos(ys[i], "y", true));
  });
  return { stroke: path, fill: null, clip: null, flags: 0 };
}

const rangeOf = (lists) => {
  const all = lists.flat().filter((x) => x !== null && Number.isFinite(x)), low = Math.min(...all), high = Math.max(...all);
  const free = MARGIN * (high - low || Math.abs(high) || 1);
  return [low - free, high + free];
};

export class PlaneChart {
  constructor(panel, player, height) {
    this.panel = panel;
    this.player = player;
    this.height = height;
    this.plot = null;
    this.zoomed = false;
    /** @type {any} */
    this.shown = null;
    /** @type {any[]} */
    this.curves = [];
    /** @type {number[]} */
    this.time = [];
    player.onTime(() => this.move());
    new ResizeObserver(() => this.plot?.setSize({ width: Math.max(200, panel.clientWidth), height })).observe(panel);
    onTheme(() => this.shown && this.show(...this.shown));
  }

  /** Show curves `{label, color, dash, x, y}` over axes with these labels; `time` are the times of the points. */
  show(curves, time, [across, up]) {
    this.shown = [curves, time, [across, up]];
    this.clear();
    this.curves = curves;
    this.time = time;
    const ink = { stroke: color("soft"), grid: { stroke: color("line"), width: 1 }, ticks: { stroke: color("line"), width: 1 }, values: tickWords, labelSize: 18, labelFont: "12px system-ui" };
    const [xs, ys] = [rangeOf(curves.map((c) => c.x)), rangeOf(curves.map((c) => c.y))];
    this.plot = new uPlot({
      mode: 2, width: Math.max(200, this.panel.clientWidth), height: this.height,
      scales: { x: { time: false, range: (_, low, high) => (this.zoomed ? [low, high] : xs) }, y: { range: (_, low, high) => (this.zoomed ? [low, high] : ys) } },
      axes: [{ ...ink, size: 44, label: across }, { ...ink, size: 58, label: up }],
      cursor: { drag: { x: true, y: true, setScale: true, uni: 20 }, points: { show: false } },
      hooks: { setSelect: [() => { this.zoomed = true; }], draw: [() => this.mark()] },
      legend: { show: true, live: false },
      series: [{}, ...curves.map((c) => ({ label: c.label, stroke: color(c.color), dash: c.dash, width: 2, paths: curvePath, facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }] }))],
    }, [null, ...curves.map((c) => [c.x, c.y])], this.panel);
    this.plot.over.addEventListener("dblclick", () => { this.zoomed = false; this.show(curves, time, [across, up]); });
  }

  clear() {
    this.plot?.destroy();
    this.plot = null;
    this.zoomed = false;
    this.panel.replaceChildren();
  }

  move() {
    this.plot?.redraw(false, false);
  }

  /** A dot on every curve at the time that is shown. */
  mark() {
    const { plot, time, player } = this;
    if (!plot || !time.length) return;
    let k = time.findIndex((t) => t > player.time);
    k = k < 0 ? time.length - 1 : Math.max(0, k - 1);
    for (const c of this.curves) {
      if (c.x[k] === null || c.y[k] === null || c.dash) continue;
      plot.ctx.beginPath();
      plot.ctx.arc(plot.valToPos(c.x[k], "x", true), plot.valToPos(c.y[k], "y", true), 5 * devicePixelRatio, 0, 2 * Math.PI);
      plot.ctx.fillStyle = color(c.color);
      plot.ctx.fill();
    }
  }
}

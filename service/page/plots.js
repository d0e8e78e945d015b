// Curves against time, with the playhead; drawn by uPlot.
import { color, make, onTheme, written } from "./dom.js";
import uPlot from "./vendor/uplot.js";

/** A chart in `panel`; `player` moves its playhead, a press on the chart moves the player. */
export class TimeChart {
  constructor(panel, player, title, height = 170) {
    this.panel = panel;
    this.player = player;
    this.title = title;
    this.height = height;
    this.plot = null;
    this.data = null;
    this.series = [];
    this.options = {};
    this.head = make("div", { className: "head" });
    player.onTime(() => this.move());
    new ResizeObserver(() => this.resize()).observe(panel);
    onTheme(() => this.data && this.show(this.series, this.data, this.options));
  }

  /** Show columns over `data[0]`; `series` has label, colour name and optional dash of each further column. */
  show(series, data, options = {}) {
    this.series = series;
    this.data = data;
    this.options = options;
    this.plot?.destroy();
    this.panel.replaceChildren();
    const ink = { stroke: color("soft"), grid: { stroke: color("line"), width: 1 }, ticks: { stroke: color("line"), width: 1 } };
    const values = tickWords;
    this.plot = new uPlot(
      {
        width: Math.max(200, this.panel.clientWidth),
        height: this.height,
        scales: { x: { time: false }, y: options.range ? { range: options.range } : {} },
        axes: [{ ...ink, size: options.live ? 44 : 30, values, label: options.live ? "time (s)" : undefined, labelSize: 16, labelFont: "12px system-ui" }, { ...ink, size: 58, values, label: options.unit || undefined, labelSize: 18, labelFont: "12px system-ui" }],
        // Live curves are brought closer by dragging across them, and read at the crosshair.
        cursor: { drag: { x: Boolean(options.live), y: false, dist: 8 }, points: { show: Boolean(options.live), size: 6 }, y: Boolean(options.live) },
        legend: { live: Boolean(options.live), markers: { width: 2, dash: (plot, i) => (plot.series[i].dash ? "dashed" : "solid") } },
        series: [{ label: options.live ? "time (s)" : "time", value: (plot, v) => (v === null ? "" : written(v, 5)) }, ...series.map((s) => ({ label: s.label, stroke: color(s.color), width: s.width || 2, dash: s.dash, value: (plot, v) => (v === null || v === undefined ? "" : written(v, 5)), points: { show: false } }))],
      },
      data,
      this.panel,
    );
    this.plot.over.append(this.head);
    // A press moves the playhead; the end of a drag is none.
    let from = 0;
    this.plot.over.addEventListener("mousedown", (event) => { from = event.offsetX; });
    this.plot.over.addEventListener("click", (event) => Math.abs(event.offsetX - from) < 8 && this.player.seek(this.plot.posToVal(event.offsetX, "x")));
    this.move();
  }

  clear() {
    this.plot?.destroy();
    this.plot = this.data = null;
    this.panel.replaceChildren();
  }

  move() {
    if (!this.plot) return;
    this.head.style.transform = `translateX(${this.plot.valToPos(this.player.time, "x")}px)`;
  }

  resize() {
    if (!this.plot) return;
    this.plot.setSize({ width: Math.max(200, this.panel.clientWidth), height: this.height });
    this.move();
  }
}

/** Ticks in words: powers of ten only where they are needed. */
export const tickWords = (plot, ticks) => ticks.map((v) => (v === 0 ? "0" : Math.abs(v) >= 1e4 || Math.abs(v) < 1e-2 ? v.toExponential(digitsBeside(v, ticks)) : String(Number(v.toPrecision(4)))));

/** Digits behind the point by which a tick is told from its neighbours. */
function digitsBeside(value, ticks) {
  const power = (x) => Math.floor(Math.log10(Math.abs(x)) + 1e-9);
  return ticks.length > 1 ? Math.max(0, Math.min(8, power(value) - power(ticks[1] - ticks[0]))) : 0;
}

/** Errors against evaluations, both logarithmic; `points` are [evaluations, error], `now` is marked. */
export function tradeChart(panel, points, now) {
  panel.replaceChildren();
  const sorted = points.filter(([x, y]) => x > 0 && y > 0).sort((a, b) => a[0] - b[0]);
  if (!sorted.length) return null;
  const ink = { stroke: color("soft"), grid: { stroke: color("line"), width: 1 }, ticks: { stroke: color("line") } };
  const xs = [...sorted.map((p) => p[0]), now[0]];
  const order = xs.map((_, i) => i).sort((a, b) => xs[a] - xs[b]);
  const pick = (list) => order.map((i) => list[i]);
  const power = (plot, ticks) => ticks.map((v) => (v && Number.isInteger(Math.round(Math.log10(v) * 1e9) / 1e9) ? v.toExponential(0) : ""));
  return new uPlot(
    {
      width: Math.max(200, panel.clientWidth), height: 180,
      scales: { x: { time: false, distr: 3 }, y: { distr: 3 } },
      axes: [{ ...ink, size: 44, values: power, label: "evaluations", labelSize: 16, labelFont: "12px system-ui" }, { ...ink, size: 58, values: power, label: "error", labelSize: 16, labelFont: "12px system-ui" }],
      cursor: { show: false }, legend: { show: false },
      series: [{}, { stroke: color("deep"), width: 2, spanGaps: true, points: { show: true, size: 5 } }, { stroke: color("warm"), width: 0, points: { show: true, size: 12, fill: color("warm") } }],
    },
    [pick(xs), pick([...sorted.map((p) => p[1]), null]), pick([...sorted.map(() => null), now[1]])],
    panel,
  );
}

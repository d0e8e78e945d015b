// How often values of a figure occur: bars between axes, the bar under the pointer in words; drawn by uPlot.
import { color, onTheme, written } from "./dom.js";
import { axisInk } from "./study_map.js";
import { tickWords } from "./plots.js";
import uPlot from "./vendor/uplot.js";

const HEIGHT = 230;
/** Pixels. */

export class Histogram {
  constructor(panel) {
    this.panel = panel;
    this.plot = this.shown = null;
    new ResizeObserver(() => this.plot?.setSize({ width: this.width, height: HEIGHT })).observe(panel);
    onTheme(() => this.shown && this.show(...this.shown));
  }

  get width() {
    return Math.max(200, this.panel.clientWidth);
  }

  /** Show `{edges, counts}` of a figure with this name and unit. */
  show({ edges, counts }, name, unit) {
    this.shown = [{ edges, counts }, name, unit];
    this.plot?.destroy();
    const bin = (k) => `${written(edges[k], 4)} to ${written(edges[k + 1], 4)}${unit && ` ${unit}`}`;
    const ends = edges[0] < edges.at(-1) ? [edges[0], edges.at(-1)] : [edges[0] - 0.5, edges[0] + 0.5];
    this.plot = new uPlot({
      width: this.width, height: HEIGHT,
      scales: { x: { time: false, range: ends }, y: { range: [0, Math.max(...counts) * 1.05] } },
      axes: [{ ...axisInk(), size: 44, label: unit ? `${name} (${unit})` : name, values: tickWords }, { ...axisInk(), size: 58, label: "members", values: tickWords }],
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      series: [
        { label: "from", value: (plot, v, series, k) => (k === null || k === undefined ? "" : bin(k)) },
        { label: "members", stroke: color("panel"), fill: color("deep"), width: 1, paths: uPlot.paths.bars({ size: [1, Infinity], gap: 0 }), points: { show: false }, value: (plot, v) => (v === null || v === undefined ? "" : String(v)) },
      ],
    }, [counts.map((_, k) => (edges[k] + edges[k + 1]) / 2), counts], this.panel);
    this.panel.setAttribute("aria-label", `Histogram from ${bin(0).split(" to ")[0]} to ${written(edges.at(-1), 4)}${unit && ` ${unit}`}, at most ${Math.max(...counts)} members in a bin`);
  }
}

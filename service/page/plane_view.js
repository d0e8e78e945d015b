// A described scene of the plane on a canvas, seen by a camera that can be moved.
import { paint } from "./canvas_paint.js";
import { color, onTheme, oncePerFrame } from "./dom.js";
import { distanceTo, drawingOf, extentOf } from "./plane_drawing.js";
import { svgOf } from "./svg_paint.js";

const INKS = ["ink", "soft", "line", "deep", "warm", "face", "faceTwo", "faceThree", "panel", "stable", "unstable", "separatrix", "third"];
const MARGIN = 0.14, START = { low: [-2, -1.25], high: [2, 1.25] };
/** Share of the size that is left around a scene; what is seen of an empty one (m). */

export class PlaneView {
  constructor(frame) {
    this.frame = frame;
    this.canvas = frame.querySelector("canvas");
    this.pen = this.canvas.getContext("2d");
    this.look = { forces: true, trails: true };
    this.lit = new Set();
    this.wrong = new Set();
    this.overlays = [];
    this.box = START;
    this.middle = [0, 0];
    this.scale = 100;
    this.items = [];
    this.render = oncePerFrame(() => this.draw());
    new ResizeObserver(() => { this.fit(this.box); this.render(); }).observe(frame);
    onTheme(() => this.render());
  }

  /** Show a model; the camera stays where it is unless it is asked to fit. */
  show(model, fit = true) {
    this.model = model;
    if (fit) this.fit(model?.bodies.length ? model.bounds() : START);
    this.render();
  }

  /** Move the camera so that a box is seen. */
  fit(box) {
    this.box = box;
    const { low, high } = box, margin = MARGIN * Math.max(...high.map((x, k) => x - low[k]), 1e-9);
    this.middle = low.map((x, k) => (x + high[k]) / 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width) this.scale = Math.min(width / (high[0] - low[0] + 2 * margin), height / (high[1] - low[1] + 2 * margin));
    this.render();
  }

  /** Bring what is seen closer by a factor; a point of the scene stays where it is. */
  zoom(factor, about = this.middle) {
    this.scale *= factor;
    this.moveTo(this.middle.map((x, k) => about[k] + (x - about[k]) / factor));
  }

  moveTo(middle) {
    this.middle = middle;
    const half = [this.canvas.clientWidth, this.canvas.clientHeight].map((x) => x / 2 / this.scale / (1 + 2 * MARGIN));
    this.box = { low: middle.map((x, k) => x - half[k]), high: middle.map((x, k) => x + half[k]) };
    this.render();
  }

  /** Pixels of a point of the scene, from the left upper corner of the canvas. */
  at([x, y]) {
    return [this.canvas.clientWidth / 2 + this.scale * (x - this.middle[0]), this.canvas.clientHeight / 2 - this.scale * (y - this.middle[1])];
  }

  /** The point of the scene at pixels. */
  pointAt([x, y]) {
    return [this.middle[0] + (x - this.canvas.clientWidth / 2) / this.scale, this.middle[1] - (y - this.canvas.clientHeight / 2) / this.scale];
  }

  get px() {
    return 1 / this.scale;
  }

  /** What is drawn now. */
  drawing() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    return drawingOf(this.model, { ...this.look, px: this.px, view: { low: this.pointAt([0, h]), high: this.pointAt([w, 0]) } });
  }

  draw() {
    const { pen, canvas } = this;
    if (!canvas.clientWidth) return;
    const ratio = Math.min(2, devicePixelRatio);
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.items = this.model ? this.drawing() : [];
    for (const overlay of this.overlays) this.items.push(...overlay());
    paint(pen, this.items, this.painting());
  }

  painting() {
    return { at: (p) => this.at(p), scale: this.scale, inks: Object.fromEntries(INKS.map((name) => [name, color(name)])), lit: this.lit, wrong: this.wrong };
  }

  /** The picture of the moment as the text of an SVG file. */
  svg(title) {
    return svgOf(this.drawing(), { ...this.painting(), width: this.canvas.clientWidth, height: this.canvas.clientHeight, title });
  }

  /** The part that is seen at a point of the scene, the uppermost first; null if there is none within some pixels. */
  partAt(point, pixels = 9) {
    const near = this.items.filter((item) => item.part).map((item, order) => ({ part: item.part, order, far: distanceTo(item, point) })).filter(({ far }) => far <= pixels * this.px);
    const first = (kind) => near.filter(({ part }) => part.startsWith(kind)).sort((p, q) => Math.round((p.far - q.far) / this.px / 3) || q.order - p.order)[0];
    return (first("body:") ?? first("connection:") ?? first("face:"))?.part ?? null;
  }

  extent() {
    return extentOf(this.items);
  }
}

// Bodies of a scene in space dragged in its picture: level, or with Shift up and down.
import { bodyPart } from "./plane_drawing.js";
import { groundOf, movedBy } from "./scene_changes.js";
import { gridStep, toGrid } from "./snapping.js";
import { Vector3 } from "./vendor/three.js";

const NEAR = 24, FLAT = 0.15;
/** Pixels within which a body is caught; how level a line of sight may be for drags on the level. */

export class SpaceBoard {
  /** `page` has `view`, `doc`, `board`, `ready()`, `start()`, `selected()`, `dropped(words)`. */
  constructor({ view, doc, board, ready, start, selected, dropped }) {
    this.view = view;
    this.doc = doc;
    this.board = board;
    this.ready = ready;
    this.start = start;
    this.selected = selected;
    this.dropped = dropped;
    /** @type {any} */
    this.gesture = null;
    this.runs = 0;
    const { frame } = this.view;
    // Before the picture itself, which otherwise turns.
    frame.addEventListener("pointerdown", (event) => this.down(event), true);
    frame.addEventListener("pointermove", (event) => this.move(event), true);
    frame.addEventListener("pointerup", (event) => this.up(event), true);
    this.view.canvas.addEventListener("touchstart", (event) => { if (this.bodyAt(event.touches[0])) event.preventDefault(); }, { passive: false });
  }

  /** @returns {[number, number]} */
  pixel({ clientX, clientY }) {
    const box = this.view.canvas.getBoundingClientRect();
    return [clientX - box.left, clientY - box.top];
  }

  bodyAt(event) {
    if (!this.ready() || !this.view.model) return null;
    const [x, y] = this.pixel(event);
    const seen = this.view.model.bodies.map((body) => ({ body, at: this.view.project(new Vector3(...this.view.place(body.at))) }));
    const near = seen.map(({ body, at }) => ({ body, far: Math.hypot(at.x - x, at.y - y) })).filter(({ far }) => far < NEAR).sort((p, q) => p.far - q.far);
    return near[0]?.body ?? null;
  }

  down(event) {
    const body = event.target === this.view.canvas ? this.bodyAt(event) : null;
    if (!body) return;
    event.stopPropagation();
    this.view.canvas.setPointerCapture(event.pointerId);
    const { selection } = this.doc, id = bodyPart(body.name);
    if (event.shiftKey && selection.size && !selection.has(id)) selection.add(id);
    else if (!selection.has(id)) { selection.clear(); selection.add(id); }
    this.selected();
    this.start();
    this.gesture = { from: this.pixel(event), scene: this.doc.scene, run: `space-${++this.runs}`, moved: false };
  }

  /**
   * The way in the scene (m) that belongs to one on the screen.
   * @param {[number, number]} to
   * @param {boolean} upward
   */
  offset([x, y], upward) {
    const [left, top] = this.gesture.from, a = this.view.ray(left, top), b = this.view.ray(x, y), way = b.origin.clone().sub(a.origin), sight = a.direction;
    const step = gridStep(this.board.px), round = (v) => [v.x, v.y, v.z].map((c) => toGrid(c / this.view.factor, step));
    if (upward) return round(new Vector3(0, 0, way.z / Math.max(1 - sight.z ** 2, FLAT)));
    return round(Math.abs(sight.z) > FLAT ? way.addScaledVector(sight, -way.z / sight.z) : way);
  }

  move(event) {
    if (!this.gesture) return;
    event.stopPropagation();
    const { scene, run } = this.gesture, offset = this.offset(this.pixel(event), event.shiftKey);
    if (!this.gesture.moved && offset.every((x) => x === 0)) return;
    this.gesture.moved = true;
    const names = this.board.parts.filter(({ id, kind }) => kind === "body" && this.doc.selection.has(id)).map(({ name }) => name);
    const points = groundOf(scene.value, names).filter((pointer) => this.board.goesAlong(scene, pointer, names));
    this.board.held = names;
    this.doc.change(`${names.join(", ")} moved`, { scene: movedBy(scene, { names, points, offset }, this.board.model.numbers), how: "drag", run });
  }

  up(event) {
    if (!this.gesture) return;
    event.stopPropagation();
    const { moved } = this.gesture;
    this.gesture = null;
    if (moved) this.dropped(() => `${[...this.doc.selection].map((id) => id.slice(5)).join(", ")} moved`);
  }
}

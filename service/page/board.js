// The picture as a drawing board: select, drag, place and connect by mouse, pen or finger.
import { attached } from "./attachments.js";
import { connect, placeBody, placeFace, standing } from "./building.js";
import { forceOf, handlesOf } from "./handles.js";
import { BODIES, CONNECTIONS, FACES } from "./new_parts.js";
import { bodyPart } from "./plane_drawing.js";
import { groundOf, moved, movedBy, tidy, withFace } from "./scene_changes.js";
import { SceneModel } from "./scene_model.js";
import { facePart, faceName, facesOf, partsOf } from "./scene_parts.js";
import { gridStep, ontoFace, snapped, toGrid } from "./snapping.js";
import { drawFace } from "./plane_kinds.js";
import { Drawing } from "./plane_drawing.js";
import { add, norm, sub } from "./vectors.js";

const SPACE_PIXEL = 0.01;
/** Metres by which lengths in space are rounded as those of a pixel are in the plane. */

const HANDLE = 14, MOVED = 4;
/** Pixels within which a handle is caught, and beyond which a press is a drag. */

export class Board {
  /**
   * `page` has the document and the view, and says what it does about them: `ready()` is false for scenes that cannot be edited here,
   * `start()` shows the start, `dropped(words)` takes what was let go.
   * @param {{doc: import("./scene_document.js").SceneDocument, view: import("./plane_view.js").PlaneView, say: (words: string) => void,
   *   ready: () => boolean, atStart: () => boolean, start: () => void, selected: () => void, dropped: (words: () => string) => void,
   *   rename: (id: string, event: MouseEvent) => void}} page
   */
  constructor({ doc, view, say, ready, atStart, start, selected, dropped, rename }) {
    this.doc = doc;
    this.view = view;
    this.say = say;
    this.ready = ready;
    this.atStart = atStart;
    this.start = start;
    this.selected = selected;
    this.dropped = dropped;
    this.rename = rename;
    /** @type {string | null} */
    this.tool = null;
    /** @type {any} What the pointer does from its press to its release. */
    this.gesture = null;
    /** @type {number[][]} */
    this.stops = [];
    /** @type {number[] | null} */
    this.hover = null;
    /** @type {string[]} Bodies that were moved last. */
    this.held = [];
    /** @type {any} The face on which a body was put. */
    this.touched = null;
    this.runs = 0;
    /** @type {(tool: string | null) => void} */
    this.toolChanged = () => {};
    const { canvas } = this.view;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("dblclick", (event) => this.double(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    // A finger on a part drags it, one beside all parts scrolls the page.
    canvas.addEventListener("touchstart", (event) => { if (this.tool || this.catches(this.pointOf(event.touches[0]))) event.preventDefault(); }, { passive: false });
    this.view.overlays.push(() => this.overlay());
  }

  /** The scene at its start, as it is described. */
  get model() {
    if (this.modelOf !== this.doc.scene) {
      this.modelOf = this.doc.scene;
      this.startModel = new SceneModel(this.doc.scene.value, null);
    }
    return this.startModel;
  }

  get parts() {
    return partsOf(this.doc.scene.value, this.doc.waiting);
  }

  /** Whether the scene is one in space. */
  get space() {
    const { value } = this.doc.scene;
    return value.gravity?.length === 3 || this.model.space;
  }

  /** Metres of a pixel; of a scene in space, which is seen from any side, a fixed length. */
  get px() {
    return this.space ? SPACE_PIXEL : this.view.px;
  }

  pointOf({ clientX, clientY }) {
    const box = this.view.canvas.getBoundingClientRect();
    return this.view.pointAt([clientX - box.left, clientY - box.top]);
  }

  handles() {
    if (this.doc.selection.size !== 1 || !this.ready()) return [];
    const part = this.parts.find(({ id }) => this.doc.selection.has(id));
    return part ? handlesOf(part, { scene: this.doc.scene, model: this.model, px: this.view.px }) : [];
  }

  handleAt(point) {
    return this.atStart() ? this.handles().find(({ at }) => norm(sub(at, point)) < HANDLE * this.view.px) : undefined;
  }

  catches(point) {
    return this.ready() && Boolean(this.handleAt(point) || this.view.partAt(point));
  }

  /** Choose a tool by its name in the palette, or none. */
  use(tool) {
    this.tool = tool;
    this.stops = [];
    this.view.canvas.style.cursor = tool ? "crosshair" : "";
    this.toolChanged(tool);
    this.view.render();
  }

  down(event) {
    if (event.button !== 0 || !this.ready()) return;
    const point = this.pointOf(event), { canvas } = this.view;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    this.hover = point;
    if (this.tool) this.gesture = this.connecting(point);
    else this.gesture = this.handling(point) ?? this.dragging(point, event) ?? { kind: event.shiftKey ? "band" : "pan", from: point, pixel: [event.clientX, event.clientY], middle: this.view.middle };
    Object.assign(this.gesture, { down: [event.clientX, event.clientY], far: false });
  }

  connecting(point) {
    this.start();
    return { kind: "tool", from: point };
  }

  handling(point) {
    const handle = this.handleAt(point);
    return handle && { kind: "handle", handle, run: `handle-${++this.runs}` };
  }

  dragging(point, event) {
    const id = this.view.partAt(point);
    if (!id) return null;
    const { selection } = this.doc, several = event.shiftKey || event.ctrlKey || event.metaKey;
    if (several) { if (selection.has(id)) selection.delete(id); else selection.add(id); } else if (!selection.has(id)) { selection.clear(); selection.add(id); }
    this.selected();
    this.start();
    return { kind: "move", id, from: point, scene: this.doc.scene, model: this.model, waiting: this.doc.waiting, run: `move-${++this.runs}` };
  }

  move(event) {
    const point = this.pointOf(event);
    this.hover = point;
    if (!this.gesture) {
      if (this.tool) this.view.render();
      return;
    }
    const { gesture } = this;
    gesture.far ||= Math.hypot(event.clientX - gesture.down[0], event.clientY - gesture.down[1]) > MOVED;
    if (!gesture.far) return;
    if (gesture.kind === "pan") return this.view.moveTo([0, 1].map((k) => gesture.middle[k] - (k ? -1 : 1) * ([event.clientX, event.clientY][k] - gesture.pixel[k]) * this.view.px));
    if (gesture.kind === "handle") return this.pull(gesture, point);
    if (gesture.kind === "move") return this.shift(gesture, point, event.altKey);
    this.view.render();
  }

  /** Drag a handle. */
  pull({ handle, run }, point) {
    const part = this.parts.find(({ id }) => this.doc.selection.has(id));
    if (part?.kind === "face") {
      const on = handle.face(point);
      const waiting = this.doc.waiting.map((other) => (other === part.on ? on : other));
      this.replaceFace(part, on, handle.drag(point), waiting, run);
    } else this.doc.change(handle.words, { scene: handle.drag(point), how: "drag", run });
  }

  replaceFace(part, on, scene, waiting, run) {
    this.doc.selection.clear();
    this.doc.selection.add(facePart(on));
    this.doc.change("face turned", { scene, waiting, how: "drag", run });
    this.selected();
  }

  /** Move what is selected along with the pointer; the first body snaps to grid and faces. */
  shift(gesture, point, free) {
    const { scene, model, waiting, run } = gesture, px = this.view.px, parts = partsOf(scene.value, waiting);
    gesture.ids ??= [...this.doc.selection];
    const chosen = parts.filter(({ id }) => gesture.ids.includes(id)), names = chosen.filter(({ kind }) => kind === "body").map(({ name }) => name);
    const connections = chosen.filter(({ kind }) => kind === "connection"), faces = chosen.filter(({ kind }) => kind === "face");
    let offset = sub(point, gesture.from);
    const step = gridStep(px);
    if (!free) {
      const anchor = names.length ? model.byName[names[0]].start : gesture.from;
      offset = names.length ? sub(snapped(model, add(anchor, offset), px, { except: names }).point, anchor) : offset.map((x) => toGrid(x, step));
      if (names.length) offset = sub(add(anchor, offset).map((x) => Number(x.toPrecision(12))), anchor);
    }
    const pinned = new Set(groundOf(scene.value, names).filter((pointer) => this.goesAlong(scene, pointer, names)));
    const points = [...pinned, ...connections.flatMap(({ pointer }) => ["a", "b", "at"].map((end) => `${pointer}/${end}`).filter((p) => Array.isArray(scene.at(p))))];
    // What the others have been moved to meanwhile stays: the branch of a linkage does not jump.
    const places = movedBy(scene, { names, points, offset }, model.numbers);
    let next = [...names.map((name) => `/bodies/${name}/at`), ...points].reduce((s, pointer) => s.withSource(pointer, places.source(pointer)), faces.length ? scene : this.doc.scene), faceless = waiting, touched = null;
    if (names.length === 1 && !free && !pinned.size) {
      const landed = ontoFace(model, scene.value, waiting, model.byName[names[0]], next.at(`/bodies/${names[0]}/at`), px);
      if (landed) {
        touched = landed.on;
        next = next.with(`/bodies/${names[0]}/at`, landed.at.map((x) => Number(x.toPrecision(15))));
        if (landed.turned) next = next.with(`/bodies/${names[0]}/angle`, { degrees: Number(((landed.angle * 180) / Math.PI).toPrecision(12)) });
      }
    }
    for (const face of faces) ({ scene: next, waiting: faceless } = this.withFaceMoved(next, faceless, face, offset));
    this.held = names;
    this.touched = touched;
    this.doc.change(`${chosen.map(({ name }) => name).join(", ")} moved`, { scene: next, waiting: faceless, how: "drag", run });
  }

  /** Everything on a face follows it; the face stays selected. */
  withFaceMoved(scene, waiting, face, offset) {
    const on = { ...face.on, at: moved(face.on.at ?? [0, 0], offset, this.model.numbers) };
    this.doc.selection.delete(face.id);
    for (const other of facesOf(this.doc.scene.value, this.doc.waiting)) if (other.members.join() === face.members.join() && face.members.length) this.doc.selection.delete(other.id);
    this.doc.selection.add(facePart(on));
    return { scene: withFace(scene, face.id, on), waiting: waiting.map((other) => (other === face.on ? on : other)) };
  }

  /** Where a part is put that has no place yet: in the middle of what is seen, beside what is there. */
  freePoint(below) {
    if (this.space) return this.freePlace(below);
    const { view } = this, step = gridStep(view.px), half = view.canvas.clientHeight / 2;
    const middle = view.pointAt([view.canvas.clientWidth / 2, below ? 1.7 * half : half]).map((x) => toGrid(x, step));
    const taken = (p) => this.model.bodies.some((body) => norm(sub(body.at, p)) < 40 * view.px);
    let point = middle;
    for (let k = 1; !below && taken(point); k++) point = [middle[0] + (k % 2 ? 1 : -1) * Math.ceil(k / 2) * toGrid(70 * view.px, step), middle[1]].map((x) => toGrid(x, step));
    return point;
  }

  /** In space: beside what is there, on the level of 0.5 m; a plane through the origin. */
  freePlace(below) {
    const taken = (p) => this.model.bodies.some((body) => body.at.length === 3 && norm(sub(body.at, p)) < 0.5);
    let k = 0;
    while (!below && taken([0.7 * k, 0, 0.5])) k = k > 0 ? -k : 1 - k;
    return below ? [0, 0, 0] : [Number((0.7 * k).toPrecision(6)), 0, 0.5];
  }

  /** Points of the ground that go along: the axle of a wheel, the rail of a slider; not the point that a rod hangs from. */
  goesAlong(scene, pointer, names) {
    const c = scene.at(pointer.slice(0, pointer.lastIndexOf("/")));
    return names.length > 1 || c.kind === "slider" || c.kind === "weld" || (c.kind === "pin" && names.includes(c.a));
  }

  up(event) {
    const { gesture } = this, point = this.pointOf(event);
    this.gesture = null;
    if (!gesture) return;
    if (gesture.kind === "tool") return this.useTool(gesture, point);
    if (gesture.kind === "band" && gesture.far) return this.selectWithin(gesture.from, point);
    if (gesture.kind === "pan" && !gesture.far) { this.doc.selection.clear(); this.selected(); }
    if ((gesture.kind === "move" || gesture.kind === "handle") && gesture.far) {
      if (gesture.kind === "move" && this.touched) this.doc.change("moved", { scene: standing(this.doc.scene, this.held[0], this.touched), waiting: this.doc.waiting.filter((on) => on !== this.touched), how: "drag", run: gesture.run });
      this.dropped(() => (gesture.kind === "handle" ? gesture.handle.say(this.doc.scene) : this.whereNow()));
    }
    this.view.render();
  }

  whereNow() {
    const [first] = this.doc.selection, part = this.parts.find(({ id }) => id === first);
    const at = part?.kind === "body" ? this.model.byName[part.name].at.map((x) => Number(x.toPrecision(4))).join(", ") : "";
    return `${part?.name ?? "part"} moved${at ? ` to ${at}` : ""}${this.touched ? `, on the ${typeof this.touched.at === "string" ? this.touched.at : faceName(this.touched)}` : ""}`;
  }

  cancel() {
    this.gesture = null;
    this.view.render();
  }

  selectWithin(a, b) {
    const low = [0, 1].map((k) => Math.min(a[k], b[k])), high = [0, 1].map((k) => Math.max(a[k], b[k]));
    for (const body of this.model.bodies) if (body.at.every((x, k) => x >= low[k] && x <= high[k])) this.doc.selection.add(bodyPart(body.name));
    this.selected();
  }

  /** Place or connect, by a press or by a drag from one place to another. */
  useTool(gesture, point) {
    const { tool } = this, px = this.view.px;
    if (BODIES[tool] || FACES[tool]) return this.place(tool, point);
    const options = { px, string: tool === "string", whole: CONNECTIONS[tool].rims };
    const from = this.stops.length ? null : attached(this.doc.scene, this.model, gesture.from, options);
    if (CONNECTIONS[tool].vector) return this.make([from.reference], from.scene, gesture.far ? forceOf(from.point, point, px) : null);
    if (CONNECTIONS[tool].ends === 1) return this.make([from.reference], from.scene);
    if (CONNECTIONS[tool].ends === "many") return this.extend(gesture, point, options);
    if (!gesture.far && CONNECTIONS[tool].alone) return this.alone(from, options);
    if (!gesture.far && !this.stops.length) {
      if (!from) return this.say("There is no body here: begin at one.");
      this.stops = [gesture.from];
      this.say("Now the other end.");
      return this.view.render();
    }
    const start = this.stops.length ? attached(this.doc.scene, this.model, this.stops[0], options) : from;
    if (!start) return this.say("There is no body here: begin at one.");
    const middle = new SceneModel(start.scene.value, null);
    const end = attached(start.scene, middle, point, { ...options, except: start.body ? [start.body.name] : [] });
    return end ? this.make([start.reference, end.reference], end.scene) : this.say("There is no body where the other end was let go.");
  }

  /** A string gets one stop after another; a drag from a place to a place that is no drum is a whole one. */
  extend(gesture, point, options) {
    const last = this.stops.at(-1), again = last && norm(sub(last, point)) < 8 * this.view.px;
    if (again && this.stops.length > 1) return this.finish();
    if (gesture.far && !this.stops.length) this.stops.push(gesture.from);
    this.stops.push(point);
    const end = attached(this.doc.scene, this.model, point, options);
    const drum = end.body?.radius && end.reference === end.body.name;
    if (gesture.far && this.stops.length === 2 && !drum) return this.finish();
    this.say(this.stops.length === 1 ? "String begun: now what it runs through." : "Go on to the next place, or press Enter where it ends.");
    this.view.render();
  }

  /** End a string at its last stop. */
  finish() {
    const stops = this.stops;
    this.stops = [];
    if (this.tool !== "string" || stops.length < 2) return;
    let { scene } = this.doc;
    const references = stops.map((point) => {
      const end = attached(scene, new SceneModel(scene.value, null), point, { px: this.view.px, string: true });
      scene = end.scene;
      return end.reference;
    });
    this.make(references, scene);
  }

  alone(from, { px }) {
    if (!from.body) return this.say("There is no body here: press on one.");
    const second = attached(from.scene, this.model, from.point, { px, except: [from.body.name] });
    this.make([from.reference, typeof second.reference === "string" ? second.reference : from.point.map(tidy)], second.scene);
  }

  make(references, scene, vector = null) {
    this.stops = [];
    this.made(connect(this.tool, this.doc, references, { scene, vector }));
  }

  /** Put a part of the palette at a point. */
  place(tool, point) {
    const { point: at } = this.space ? { point } : snapped(this.model, point, this.view.px);
    this.made((BODIES[tool] ? placeBody : placeFace)(tool, this.doc, at, this.view.px));
  }

  /** Take in what a tool has made. */
  made(result) {
    if (result.problem) {
      this.say(result.problem);
      this.stops = [];
      return this.view.render();
    }
    this.doc.selection.clear();
    for (const id of result.selected) this.doc.selection.add(id);
    this.doc.change(result.words, { scene: result.scene, waiting: result.waiting, how: "build" });
    this.say(`${result.words}.`);
    this.use(null);
    this.selected();
  }

  double(event) {
    if (this.tool === "string") return this.finish();
    const id = this.view.partAt(this.pointOf(event));
    if (id && this.ready()) this.rename(id, event);
  }

  wheel(event) {
    // Pages scroll by the wheel; with Ctrl, as browsers have it, the picture is brought closer.
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    this.view.zoom(Math.exp(-event.deltaY / 400), this.pointOf(event));
  }

  /** What is drawn above the scene: faces that nothing touches yet, handles, the stops of a string, the band of a selection. */
  overlay() {
    const { view, doc } = this, px = view.px, { clientWidth: w, clientHeight: h } = view.canvas;
    const d = new Drawing(px, { low: view.pointAt([0, h]), high: view.pointAt([w, 0]) });
    if (!doc.sound || !this.ready()) return d.items;
    for (const face of this.space ? [] : facesOf(doc.scene.value, doc.waiting)) {
      d.of(face.id, () => { if (!face.members.length || doc.selection.has(face.id)) drawFace(d, this.model, this.model.face(face.on), null); });
    }
    if (this.atStart()) {
      for (const { at, from, arrow } of this.handles()) {
        if (from) { if (arrow) d.arrow(from, at, "deep"); else d.line([from, at], "soft", 1, [3, 3]); }
        d.dot(at, 6, "panel", "deep", 2.5);
      }
    }
    if (this.tool && this.hover) this.preview(d);
    if (this.gesture?.kind === "band" && this.gesture.far) {
      const [a, b] = [this.gesture.from, this.hover];
      d.outline([a, [b[0], a[1]], b, [a[0], b[1]]], null, "deep", 1);
    }
    return d.items;
  }

  preview(d) {
    const points = [...this.stops, ...(this.gesture?.kind === "tool" && this.gesture.far && !this.stops.length ? [this.gesture.from] : []), this.hover];
    const near = snapped(this.model, this.hover, this.view.px);
    if (points.length > 1) d.line(points, "deep", 2, [6, 4]);
    d.dot(near.point, near.place ? 9 : 4, null, "deep", 2);
  }
}

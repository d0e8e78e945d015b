// A ruler and a protractor over the picture: their points are dragged or written, and go along with the places that they are put on.
import { make, written } from "./dom.js";
import { Drawing } from "./plane_drawing.js";
import { gridStep, nearestPlace, placesSeen, toGrid } from "./snapping.js";
import { add, dot, norm, quarter, scaled, sub, unit } from "./vectors.js";

const CAUGHT = 16, TICK = 6, ARC = 34, DIGITS = 4;
/** Pixels within which a point is caught, of a tick, of the arc of an angle; digits of what is read off a picture. */

const TOOLS = {
  ruler: { words: "Ruler", ends: ["from", "to"], start: [[-0.25, 0], [0.25, 0]], draw: drawRuler, read: ([a, b]) => `${written(norm(sub(b, a)), DIGITS)} m (${sub(b, a).map((x) => written(x, DIGITS)).join(", ")})` },
  protractor: { words: "Protractor", ends: ["corner", "one arm", "other arm"], start: [[-0.1, -0.2], [0.2, -0.2], [0.1, 0.2]], draw: drawProtractor, read: (points) => `${written((angleOf(points) * 180) / Math.PI, DIGITS)}°` },
};

/** The angle between the arms, between 0 and half a turn (rad). */
export function angleOf([corner, one, other]) {
  const [a, b] = [sub(one, corner), sub(other, corner)];
  return Math.abs(Math.atan2(dot(quarter(a), b), dot(a, b)));
}

function drawRuler(d, [a, b], words) {
  const along = unit(sub(b, a)), step = gridStep(2 * d.px), length = norm(sub(b, a));
  d.line([a, b], "third", 2);
  for (let k = 0; k * step <= length * (1 + 1e-9); k++) {
    const at = add(a, along, k * step), half = (k % 5 ? 0.5 : 1) * TICK * d.px;
    d.line([at, add(at, quarter(along), half)], "third", 1);
  }
  d.words(add(scaled(add(a, b), 0.5), quarter(along), -18 * d.px), words, "third");
}

function drawProtractor(d, points, words) {
  const [corner, one, other] = points, [x, y] = sub(one, corner), from = Math.atan2(y, x), angle = angleOf(points), sign = dot(quarter(sub(one, corner)), sub(other, corner)) < 0 ? -1 : 1;
  const at = (share, pixels) => add(corner, [Math.cos(from + sign * share * angle), Math.sin(from + sign * share * angle)], pixels * d.px);
  d.line([one, corner, other], "third", 2);
  d.line([...Array(25).keys()].map((k) => at(k / 24, ARC)), "third", 1.5);
  d.words(at(0.5, ARC + 14), words, "third");
}

export class Measures {
  /** `view` is the picture in the plane; `panel` gets the controls; `say` announces what was read. */
  constructor({ view, panel, say }) {
    this.view = view;
    this.say = say;
    /** @type {{tool: any, at: {place: string | null, point: number[]}[], inputs: any[], value: any, fields: any}[]} */
    this.shown = [];
    /** @type {any} */
    this.dragged = null;
    this.places = make("datalist", { id: "places-measured" });
    panel.append(this.places, ...Object.values(TOOLS).map((tool) => this.control(tool)));
    const { frame } = view;
    // Before the board, which would select what lies beneath.
    frame.addEventListener("pointerdown", (event) => this.down(event), true);
    frame.addEventListener("pointermove", (event) => this.move(event), true);
    frame.addEventListener("pointerup", (event) => this.up(event), true);
    frame.addEventListener("pointercancel", () => { this.dragged = null; }, true);
    frame.addEventListener("touchstart", (event) => { if (this.caught(event.touches[0])) event.preventDefault(); }, { capture: true, passive: false });
    view.overlays.push(() => this.overlay());
  }

  control(tool) {
    const box = make("input", { type: "checkbox" }), value = make("output", {});
    const one = { tool, at: [], value, fields: null, inputs: tool.ends.map((end) => make("input", { size: 10, autocomplete: "off", list: "places-measured", "aria-label": `${tool.words}, ${end}: a place, or x, y (m)` })) };
    one.fields = make("span", { hidden: true }, ...tool.ends.flatMap((end, k) => [` ${end} `, one.inputs[k]]), " ", value);
    one.inputs.forEach((input, k) => {
      input.onfocus = () => this.places.replaceChildren(...this.names().map((name) => make("option", { value: name })));
      input.onchange = () => this.write(one, k, input);
    });
    box.onchange = () => {
      one.fields.hidden = !box.checked;
      if (box.checked) { this.shown.push(one); one.at = this.start(tool); } else this.shown.splice(this.shown.indexOf(one), 1);
      this.view.render();
    };
    return make("span", {}, make("label", { className: "check" }, box, ` ${tool.words}`), one.fields);
  }

  /** Points in the middle of what is seen. */
  start({ start }) {
    const { canvas, px, middle } = this.view, size = Math.min(canvas.clientWidth, canvas.clientHeight) * px;
    return start.map((share) => ({ place: null, point: add(middle, share, size).map((x) => toGrid(x, gridStep(px))) }));
  }

  names() {
    return this.view.model ? placesSeen(this.view.model).map(({ reference }) => reference).filter((reference) => typeof reference === "string") : [];
  }

  write(one, k, input) {
    const numbers = input.value.split(",").map((x) => (x.trim() === "" ? NaN : Number(x))), place = this.names().includes(input.value.trim()) ? input.value.trim() : null;
    const fits = place !== null || (numbers.length === 2 && numbers.every(Number.isFinite));
    input.setAttribute("aria-invalid", String(!fits));
    if (!fits) return this.say("A point is a place of a body, or two numbers, as 0, 1.5.");
    one.at[k] = { place, point: place === null ? numbers : one.at[k].point };
    this.view.draw();
    return this.say(`${one.tool.words}: ${one.value.textContent}.`);
  }

  /** Where the points of a tool are now. */
  pointsOf({ at }) {
    const { model } = this.view, known = new Set(this.names());
    for (const end of at) if (end.place !== null && known.has(end.place)) end.point = model.place(end.place).point;
    return at.map(({ point }) => point);
  }

  pointAt({ clientX, clientY }) {
    const box = this.view.canvas.getBoundingClientRect();
    return this.view.pointAt([clientX - box.left, clientY - box.top]);
  }

  caught(event) {
    const point = this.pointAt(event), far = (other) => norm(sub(other, point)) / this.view.px;
    return this.shown.flatMap((one) => this.pointsOf(one).map((at, k) => ({ one, k, far: far(at) }))).filter((near) => near.far < CAUGHT).sort((p, q) => p.far - q.far)[0] ?? null;
  }

  down(event) {
    this.dragged = event.button === 0 && event.target === this.view.canvas ? this.caught(event) : null;
    if (!this.dragged) return;
    event.stopPropagation();
    this.view.canvas.setPointerCapture(event.pointerId);
  }

  move(event) {
    if (!this.dragged) return;
    event.stopPropagation();
    const point = this.pointAt(event), { one, k } = this.dragged, { model, px } = this.view;
    const near = !event.altKey && model ? nearestPlace(model, point, px) : null;
    one.at[k] = { place: typeof near?.reference === "string" ? near.reference : null, point: near?.point ?? (event.altKey ? point : point.map((x) => toGrid(x, gridStep(px)))) };
    this.view.render();
  }

  up(event) {
    if (!this.dragged) return;
    event.stopPropagation();
    const { one } = this.dragged;
    this.dragged = null;
    this.view.draw();
    this.say(`${one.tool.words}: ${one.value.textContent}.`);
  }

  overlay() {
    const d = new Drawing(this.view.px, null);
    for (const one of this.shown) {
      const points = this.pointsOf(one), words = one.tool.read(points);
      one.value.textContent = words;
      one.inputs.forEach((input, k) => { if (document.activeElement !== input) input.value = one.at[k].place ?? points[k].map((x) => written(x, DIGITS)).join(", "); });
      one.tool.draw(d, points, words);
      for (const point of points) d.dot(point, 6, "panel", "third", 2.5);
    }
    return d.items;
  }
}

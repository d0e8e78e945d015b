// The inspector: names, numbers and formulas of what is selected, with their units.
import { make } from "./dom.js";
import { mark } from "./number_fields.js";
import { shownNumber, typedNumber } from "./number_text.js";
import { BODY_FIELDS, CONNECTION_FIELDS, FACE_FIELDS, ON_FACE, SCENE_FIELDS, SPAN_FIELDS, TOUCH_FIELDS, WITHOUT_SPAN } from "./part_fields.js";
import { inline, pointerTo } from "./scene_text.js";
import { placesOf } from "./scene_parts.js";
import { described4, withCorners } from "./handles.js";
import { withFace } from "./scene_changes.js";

const AXES = ["x", "y", "z"], SIDES = ["left", "right", "above", "below"];
let ids = 0;

export class Inspector {
  /** `page` has `doc`, `board`, `edit(words, scene, run)` for a change, `rename(id, name)` which returns a problem in words or nothing. */
  constructor(panel, { doc, board, edit, rename }) {
    this.panel = panel;
    this.doc = doc;
    this.board = board;
    this.edit = edit;
    this.rename = rename;
  }

  /** Show what is selected; while a field of it is being edited, only what the field does not show changes. */
  show() {
    const { doc } = this;
    if (!doc.sound) return;
    const parts = this.board.parts.filter(({ id }) => doc.selection.has(id));
    const key = parts.map(({ id }) => id).join() + Object.keys(doc.scene.at(parts[0]?.pointer ?? "") ?? {}).join();
    const active = /** @type {HTMLElement | null} */ (document.activeElement), focused = this.panel.contains(active) && this.key === key ? active.dataset.pointer : null;
    this.key = key;
    this.panel.replaceChildren(...this.content(parts));
    if (focused) this.panel.querySelector(`[data-pointer="${CSS.escape(focused)}"]`)?.focus();
  }

  content(parts) {
    if (parts.length > 1) return [make("p", { textContent: `${parts.length} parts are selected: they move together, and are copied or deleted together.` })];
    const [part] = parts;
    if (!part) return this.ofScene();
    if (part.kind === "body") return this.ofBody(part);
    return part.kind === "face" ? this.ofFace(part) : this.ofConnection(part);
  }

  ofScene() {
    const names = Object.keys(this.doc.scene.value.let || {});
    return [
      make("p", { className: "soft", textContent: "Nothing is selected: these belong to the whole scene." }),
      ...SCENE_FIELDS.map((field) => this.field(field, "")),
      ...names.map((name) => this.number({ words: name, unit: "", open: true }, pointerTo("let", name))),
    ];
  }

  ofBody({ id, name, pointer }) {
    const body = this.doc.scene.at(pointer), space = this.doc.scene.value.gravity?.length === 3 || body.at?.length === 3;
    const rigid = ["inertia", "moments", "tensor", "body", "shape"].some((field) => body[field] !== undefined);
    const fields = BODY_FIELDS.filter((f) => (space ? !f.plane : !f.space) && (rigid || !f.turns) && (rigid || !["radius", "inertia"].includes(f.name) || body[f.name] !== undefined));
    const sized = (words, next, run) => {
      const { width, height, kind } = next.at(`${pointer}/shape`);
      this.edit(words, kind === "box" && described4(body) && typeof width === "number" && typeof height === "number" ? withCorners(next, pointer, width, height) : next, run);
    };
    const sizes = Object.keys(body.shape || {}).filter((name) => !["kind", "at", "corners", "semi_axes"].includes(name)).map((name) => this.number({ words: `${name} of the ${body.shape.kind}`.replace(/^./, (c) => c.toUpperCase()), unit: "m" }, `${pointer}/shape/${name}`, sized));
    const places = Object.keys(body.places || {}).map((place) => this.vector({ words: `Place ${place}`, unit: "m" }, `${pointer}${pointerTo("places", place)}`));
    return [this.name(id, name), ...fields.map((f) => this.field(f, pointer)), ...sizes, ...places];
  }

  ofFace(face) {
    if (!face.pointer) return [make("p", { textContent: `A ${face.name} that nothing touches yet. Bodies that you put above it will stand on it.` })];
    const set = (words, next) => {
      const on = next.at(face.pointer);
      this.doc.selection.clear();
      this.doc.selection.add(`face:${inline(on)}`);
      this.edit(words, withFace(this.doc.scene, face.id, on), `face-${words}`);
    };
    const fields = FACE_FIELDS.filter((f) => f.name !== "radius" || face.on.radius !== undefined).filter((f) => f.name !== "slope" || face.on.radius === undefined);
    const touches = face.members.map((index) => pointerTo("connections", index));
    const all = (f) => (words, next) => {
      const value = next.at(`${touches[0]}/${f.name}`);
      this.edit(words, touches.reduce((s, t) => (value === undefined ? s.without(`${t}/${f.name}`) : s.with(`${t}/${f.name}`, value)), this.doc.scene), `face-${f.name}`);
    };
    const contacts = face.members.every((index) => this.doc.scene.value.connections[index].kind === "contact");
    return [
      make("h3", { textContent: face.name }),
      ...fields.map((f) => this.field(f, face.pointer, set)),
      ...(contacts ? TOUCH_FIELDS.map((f) => this.field(f, touches[0], all(f))) : []),
    ];
  }

  ofConnection({ id, name, pointer, onFace }) {
    const c = this.doc.scene.at(pointer), fields = [...(CONNECTION_FIELDS[c.kind] ?? []), ...(WITHOUT_SPAN.includes(c.kind) ? [] : SPAN_FIELDS)];
    const present = fields.filter((f) => f.type !== "place" || c[f.name] !== undefined).filter((f) => f.type !== "sides" || c.sides);
    const kind = onFace && typeof c.place === "string" ? [this.choice({ words: "On the face it", options: ON_FACE }, `${pointer}/kind`)] : [make("p", { className: "soft", textContent: c.kind.replaceAll("-", " ") })];
    return [this.name(id, name), ...kind, ...present.map((f) => this.field(f, pointer))];
  }

  field(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const at = `${pointer}/${field.name}`;
    const makers = { number: this.number, vector: this.vector, place: this.place, choice: this.choice, check: this.check, through: this.through, sides: this.sides, text: this.words };
    return makers[field.type].call(this, field, at, set);
  }

  name(id, name) {
    const input = make("input", { value: name, autocomplete: "off", spellcheck: false, id: "part-name" }), fault = make("span", { className: "error", role: "alert" });
    input.onchange = () => {
      fault.textContent = this.rename(id, input.value.trim()) ?? "";
      mark(input, fault.textContent !== "");
    };
    return make("label", { className: "field" }, make("span", { textContent: "Name" }), input, fault);
  }

  number(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const { scene } = this.doc, input = make("input", { value: shownNumber(scene.at(pointer), scene.source(pointer)), autocomplete: "off", inputMode: "text", id: `field-${++ids}` });
    input.dataset.pointer = pointer;
    const fault = make("span", { className: "error", role: "alert" });
    input.onchange = () => {
      const text = input.value.trim(), now = this.doc.scene;
      const problem = text === "" ? (field.optional ? null : "A number is needed here") : (() => {
        const typed = typedNumber(text, { names: this.board.model.numbers.names, angle: field.angle, open: field.open });
        if (!typed.problem) set(`${field.words} set`, now.withSource(pointer, typed.source), pointer);
        return typed.problem ?? null;
      })();
      if (text === "" && field.optional) set(`${field.words} left out`, now.without(pointer), pointer);
      fault.textContent = problem ?? "";
      mark(input, problem !== null);
    };
    return make("label", { className: "field" }, make("span", { textContent: field.words }), input, " ", make("span", { className: "unit", textContent: field.unit }), fault);
  }

  /** One field for each component; a vector that is left out appears whole as soon as one is given. */
  vector(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const { scene } = this.doc, value = scene.at(pointer), size = scene.value.gravity?.length ?? 2;
    const components = Array.isArray(value) ? value : this.board.model.numbers.vector(value)?.map((x) => Number(x.toPrecision(12))) ?? Array(size).fill(undefined);
    const inputs = components.map((component, k) => {
      const exact = `${pointer}/${k}`, input = make("input", { value: shownNumber(component, Array.isArray(value) ? scene.source(exact) : null), autocomplete: "off", "aria-label": `${field.words} ${AXES[k]}` });
      input.dataset.pointer = exact;
      return input;
    });
    const fault = make("span", { className: "error", role: "alert" });
    const change = (input, k) => {
      const text = input.value.trim(), empty = inputs.every((other) => other.value.trim() === "");
      if (empty && field.optional) return set(`${field.words} left out`, this.doc.scene.without(pointer), pointer);
      const typed = typedNumber(text || "0", { names: this.board.model.numbers.names, open: field.open });
      fault.textContent = typed.problem ?? "";
      mark(input, Boolean(typed.problem));
      if (typed.problem) return null;
      const now = this.doc.scene, whole = Array.isArray(now.at(pointer)) ? now : now.with(pointer, components.map((x) => x ?? 0));
      return set(`${field.words} set`, whole.withSource(`${pointer}/${k}`, typed.source), pointer);
    };
    inputs.forEach((input, k) => { input.onchange = () => change(input, k); });
    return make("div", { className: "field vector", role: "group", "aria-label": field.words }, make("span", { textContent: field.words }), ...inputs, make("span", { className: "unit", textContent: field.unit }), fault);
  }

  /** A place of a body, or a point of the ground. */
  place(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const value = this.doc.scene.at(pointer), names = placesOf(this.doc.scene.value);
    if (typeof value === "string" && !names.includes(value)) names.push(value);
    const ground = typeof value !== "string";
    const select = make("select", {}, ...names.map((name) => make("option", { value: name, textContent: name, selected: name === value })), make("option", { value: "", textContent: "a point of the ground", selected: ground }));
    select.onchange = () => {
      const model = this.board.model, point = select.value || model.place(value).point.map((x) => Number(x.toPrecision(6)));
      set(`${field.words} ${select.value || "the ground"}`, this.doc.scene.with(pointer, point), pointer);
    };
    const label = make("label", { className: "field" }, make("span", { textContent: field.words }), select);
    return ground && Array.isArray(value) ? make("div", {}, label, this.vector({ words: `${field.words} point`, unit: "m" }, pointer, set)) : label;
  }

  choice(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const select = make("select", {}, ...field.options.map(([value, words]) => make("option", { value, textContent: words, selected: (this.doc.scene.at(pointer) ?? "") === value })));
    select.onchange = () => set(`${field.words} ${select.selectedOptions[0].textContent}`, select.value ? this.doc.scene.with(pointer, select.value) : this.doc.scene.without(pointer), pointer);
    return make("label", { className: "field" }, make("span", { textContent: field.words }), select);
  }

  check(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const box = make("input", { type: "checkbox", checked: this.doc.scene.at(pointer) === true });
    box.onchange = () => set(field.words, box.checked ? this.doc.scene.with(pointer, true) : this.doc.scene.without(pointer), pointer);
    return make("label", { className: "check" }, box, ` ${field.words}`);
  }

  through(field, pointer) {
    const stops = this.doc.scene.at(pointer) ?? [];
    return make("div", {}, ...stops.map((_, k) => this.place({ words: k === 0 ? "From" : k === stops.length - 1 ? "To" : "Through" }, `${pointer}/${k}`)));
  }

  sides(field, pointer) {
    const sides = this.doc.scene.at(pointer) ?? {};
    return make("div", {}, ...Object.entries(sides).flatMap(([drum, given]) => (Array.isArray(given) ? given.map((_, k) => [k, `${pointer}${pointerTo(drum, k)}`]) : [[null, `${pointer}${pointerTo(drum)}`]]).map(([k, at]) =>
      this.choice({ words: `Side of ${drum}${k === null ? "" : k ? ", leaving" : ", arriving"}`, options: SIDES.map((side) => [side, side]) }, at))));
  }

  words(field, pointer, set = (words, next, run) => this.edit(words, next, run)) {
    const input = make("input", { value: this.doc.scene.at(pointer) ?? "", autocomplete: "off" });
    input.onchange = () => set(`${field.words} set`, this.doc.scene.with(pointer, input.value), pointer);
    return make("label", { className: "field" }, make("span", { textContent: field.words }), input);
  }

  /** Put the cursor in the field of the name. */
  focusName() {
    const input = this.panel.querySelector("#part-name");
    input?.focus();
    input?.select();
  }
}

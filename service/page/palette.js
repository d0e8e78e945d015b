// The palette: parts to drag into the picture, or to choose and place by a press, by touch or by the keyboard.
import { make } from "./dom.js";
import { BODIES, FACES, CONNECTIONS, PALETTE, fits } from "./new_parts.js";
import { placesOf } from "./scene_parts.js";

const FAR = 6;
/** Pixels after which a press on a tool is a drag. */

export class Palette {
  /** `board` takes the tools; `form` is where a connection is made by names. */
  constructor(panel, form, { board, say }) {
    this.form = form;
    this.board = board;
    this.say = say;
    /** @type {Map<string, any>} */
    this.buttons = new Map();
    this.dragged = false;
    panel.append(...PALETTE.map(([title, tools]) => make("fieldset", {}, make("legend", { textContent: title }), make("div", { className: "tools" }, ...Object.entries(tools).map(([name, tool]) => this.button(name, tool))))));
    board.toolChanged = (tool) => this.chosen(tool);
  }

  /** Offer what scenes in space have, or those in the plane. */
  offer(space) {
    for (const [name, button] of this.buttons) button.hidden = !fits(BODIES[name] ?? FACES[name] ?? CONNECTIONS[name], space);
  }

  button(name, { words, hint }) {
    const button = make("button", { type: "button", textContent: words, title: `${words}: ${hint}`, "aria-pressed": "false" });
    button.dataset.tool = name;
    this.buttons.set(name, button);
    button.addEventListener("click", (event) => { if (!this.dragged) this.choose(name, event.detail === 0); });
    if (!CONNECTIONS[name]) button.addEventListener("pointerdown", (event) => this.drag(event, name));
    return button;
  }

  /** Drag a body or a face out of the palette. */
  drag(event, name) {
    if (this.board.space) return;
    const from = [event.clientX, event.clientY], button = event.currentTarget;
    this.dragged = false;
    if (event.pointerType !== "touch") button.setPointerCapture(event.pointerId);
    const move = (e) => {
      if (!this.dragged && Math.hypot(e.clientX - from[0], e.clientY - from[1]) > FAR) {
        this.dragged = true;
        this.board.use(name);
      }
      if (!this.dragged) return;
      this.board.hover = this.board.pointOf(e);
      this.board.view.render();
    };
    const end = (e) => {
      button.removeEventListener("pointermove", move);
      button.removeEventListener("pointerup", end);
      button.removeEventListener("pointercancel", end);
      if (!this.dragged) return;
      const box = this.board.view.canvas.getBoundingClientRect();
      const inside = e.clientX > box.left && e.clientX < box.right && e.clientY > box.top && e.clientY < box.bottom;
      if (e.type === "pointerup" && inside) this.board.place(name, this.board.pointOf(e));
      else this.board.use(null);
      // The click that follows belongs to the drag.
      setTimeout(() => { this.dragged = false; });
    };
    button.addEventListener("pointermove", move);
    button.addEventListener("pointerup", end);
    button.addEventListener("pointercancel", end);
  }

  /** Take a tool; by keyboard a body is placed at once, a connection asks for its places. */
  choose(name, byKeyboard) {
    if (!this.board.ready()) return this.say("This scene is changed by its sliders and its JSON.");
    if (this.board.tool === name) return this.board.use(null);
    // In space there is no one point under a pointer: a part is placed beside the others, and moved from there.
    if ((BODIES[name] || FACES[name]) && (byKeyboard || this.board.space)) {
      this.board.start();
      return this.board.place(name, this.board.freePoint(Boolean(FACES[name])));
    }
    this.board.start();
    this.board.use(name);
    const { words, hint } = BODIES[name] ?? FACES[name] ?? CONNECTIONS[name];
    this.say(CONNECTIONS[name] ? `${words}: ${hint}. Press on its places in the picture, or choose them by name.` : `${words}: press in the picture where it goes.`);
    if (byKeyboard) this.form.querySelector("select")?.focus();
    return null;
  }

  chosen(tool) {
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(name === tool));
    this.form.hidden = !CONNECTIONS[tool];
    if (CONNECTIONS[tool]) this.fillForm(tool);
  }

  /** Places to choose from by name, as many as the connection joins. */
  fillForm(tool) {
    const { words, ends } = CONNECTIONS[tool], names = placesOf(this.board.doc.scene.value);
    const count = ends === "many" ? 3 : ends;
    const select = (k) => {
      const label = count === 1 ? "At" : k === 0 ? "From" : k === count - 1 ? "To" : "Through";
      const options = names.map((name) => make("option", { value: name, textContent: name }));
      const ground = make("option", { value: "ground", textContent: k ? "the ground…" : "a point of the ground…" }), none = make("option", { value: "", textContent: "nothing" });
      const box = make("select", {}, ...(label === "Through" ? [none] : []), ...options, ...(count > 1 ? [ground] : []));
      if (k === count - 1 && count > 1) box.value = names.length > 1 ? names.at(-1) : "ground";
      const point = make("input", { "aria-label": `${label}: point ${this.board.space ? "x, y, z" : "x, y"} (m)`, value: this.board.space ? "0, 0, 0" : "0, 0", size: 8, hidden: box.value !== "ground" });
      box.onchange = () => { point.hidden = box.value !== "ground"; };
      return { element: make("label", {}, `${label} `, box, " ", point), read: () => (box.value === "ground" ? point.value.split(",").map(Number) : box.value || null) };
    };
    let fields = [...Array(count).keys()].map(select);
    const more = make("button", { type: "button", textContent: "One more place" }), go = make("button", { textContent: "Connect", className: "play" }), no = make("button", { type: "button", textContent: "Cancel" });
    const rows = make("div", { className: "row" }, ...fields.map(({ element }) => element));
    more.hidden = ends !== "many";
    more.onclick = () => {
      const field = select(1);
      fields = [...fields.slice(0, -1), field, fields.at(-1)];
      rows.insertBefore(field.element, fields.at(-1).element);
      field.element.querySelector("select").focus();
    };
    no.onclick = () => { this.board.use(null); this.buttons.get(tool).focus(); };
    this.form.onsubmit = (event) => {
      event.preventDefault();
      const references = fields.map(({ read }) => read()).filter((r) => r !== null);
      if (references.some((r) => Array.isArray(r) && (r.length !== (this.board.space ? 3 : 2) || !r.every(Number.isFinite)))) return this.say(`A point of the ground is ${this.board.space ? "three numbers, as 0, 0, 1.5" : "two numbers, as 0, 1.5"}`);
      this.board.make(references, this.board.doc.scene);
      return this.buttons.get(tool).focus();
    };
    this.form.replaceChildren(make("strong", { textContent: words }), rows, make("div", { className: "row" }, go, more, no));
  }
}


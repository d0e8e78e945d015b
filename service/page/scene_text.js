// The text of a scene, and its edits: what is not edited keeps every character, so numbers keep their digits.
import { placeOf, readJson } from "./json_places.js";

export const escaped = (name) => String(name).replaceAll("~", "~0").replaceAll("/", "~1");
export const pointerTo = (...names) => names.map((name) => `/${escaped(name)}`).join("");
export const namesIn = (pointer) => pointer.split("/").slice(1).map((p) => p.replaceAll("~1", "/").replaceAll("~0", "~"));
export const valueAt = (value, pointer) => namesIn(pointer).reduce((inner, name) => inner?.[name], value);

/** JSON on one line, as people write it. */
export const inline = (value) => {
  if (Array.isArray(value)) return `[${value.map(inline).join(", ")}]`;
  if (value && typeof value === "object") return `{${Object.entries(value).map(([name, inner]) => `${JSON.stringify(name)}: ${inline(inner)}`).join(", ")}}`;
  return JSON.stringify(value);
};

/** A text that is JSON; edits give new ones. Reading a text that is none throws `NotJson`. */
export class SceneText {
  constructor(text) {
    this.text = text;
    const { value, places } = readJson(text);
    this.value = value;
    this.places = places;
  }

  at(pointer) {
    return valueAt(this.value, pointer);
  }

  /** Text of the value at a pointer. */
  source(pointer) {
    return this.places.has(pointer) ? this.text.slice(...this.places.get(pointer)) : null;
  }

  spliced(start, end, next) {
    return new SceneText(this.text.slice(0, start) + next + this.text.slice(end));
  }

  /** With the value at `pointer` set; missing objects around it are made. `-` is the place behind a list's last item. */
  with(pointer, value) {
    return this.withSource(pointer, inline(value));
  }

  withSource(pointer, source) {
    if (this.places.has(pointer)) return this.spliced(...placeOf(this.places, pointer), source);
    const cut = pointer.lastIndexOf("/"), parent = pointer.slice(0, cut), name = namesIn(pointer).at(-1);
    if (!this.places.has(parent)) return this.withSource(parent, name === "-" ? `[${source}]` : `{${JSON.stringify(name)}: ${source}}`);
    return this.grown(parent, Array.isArray(this.at(parent)) ? source : `${JSON.stringify(name)}: ${source}`);
  }

  /** A list or object with one more member, on a line of its own where the others have theirs. */
  grown(pointer, member) {
    const [start, end] = this.places.get(pointer), body = this.text.slice(start + 1, end - 1);
    const indent = /\n([ \t]*)\S/.exec(body)?.[1], around = /(?:^|\n)([ \t]*)[^\n]*$/.exec(this.text.slice(0, start))[1];
    const empty = body.trim() === "";
    const lines = indent !== undefined || (empty && ["/bodies", "/connections"].includes(pointer));
    const own = indent ?? `${around}  `;
    const before = empty ? "" : `${body.trimEnd()},`;
    const next = lines ? `${before}\n${own}${member}\n${around}` : `${before}${empty ? "" : " "}${member}`;
    return this.spliced(start + 1, end - 1, next);
  }

  /** Without the member at `pointer`. */
  without(pointer) {
    if (!this.places.has(pointer)) return this;
    const cut = pointer.lastIndexOf("/"), parent = pointer.slice(0, cut);
    const [open] = this.places.get(parent);
    let [start, end] = this.places.get(pointer);
    // The name of a member stands before its value.
    if (!Array.isArray(this.at(parent))) start = this.text.lastIndexOf(JSON.stringify(namesIn(pointer).at(-1)), start);
    const before = /,\s*$/.exec(this.text.slice(open + 1, start)), after = /^\s*,\s*/.exec(this.text.slice(end));
    if (before) start -= before[0].length;
    else if (after) end += after[0].length;
    return this.spliced(start, end, "");
  }

  /** Without several members: those of one list are counted before any is gone. */
  withoutAll(pointers) {
    const order = [...pointers].filter((p) => this.places.has(p)).sort((p, q) => this.places.get(q)[0] - this.places.get(p)[0]);
    return order.reduce((scene, pointer) => scene.without(pointer), this);
  }

  /** With many values replaced, as `[pointer, source]`. */
  withSources(changes) {
    return changes.reduce((scene, [pointer, source]) => scene.withSource(pointer, source), this);
  }
}

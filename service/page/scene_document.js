// The scene that a reader works on: its text, what has been done to it, and what is selected.
import { NotJson } from "./json_places.js";
import { SceneText } from "./scene_text.js";

const MOST_STEPS = 200;
/** Changes that can be undone. */

export const NOTHING = `{
  "gravity": [0, -9.81],
  "bodies": {},
  "connections": [],
  "times": {"start": 0, "stop": 3, "count": 301}
}`;

export const NOTHING_IN_SPACE = NOTHING.replace("[0, -9.81]", "[0, 0, -9.81]");

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const missingOr = (test) => (value) => value === undefined || test(value);

/** Whether bodies, connections and names are where a description has them, whatever they say. */
function isDrawable({ bodies = {}, connections = [], let: names = {} }) {
  const body = (b) => isObject(b) && missingOr(isObject)(b.places) && missingOr((shape) => isObject(shape) && missingOr(Array.isArray)(shape.corners))(b.shape);
  const connection = (c) => isObject(c) && typeof c.kind === "string" && c.on !== null && (["string", "chain"].includes(c.kind) ? Array.isArray(c.through) : c.through === undefined);
  return isObject(names) && isObject(bodies) && Object.values(bodies).every(body) && Array.isArray(connections) && connections.every(connection);
}

export class SceneDocument {
  /** `changed(how)` is called after every change; `how` is `text`, `edit`, `drag`, `undo` or `open`. */
  constructor(changed) {
    this.changed = changed;
    this.past = [];
    this.future = [];
    this.selection = new Set();
    this.now = { text: NOTHING, waiting: [] };
    this.read();
  }

  get text() {
    return this.now.text;
  }

  /** Faces that nothing touches yet; no description has a place for them. */
  get waiting() {
    return this.now.waiting;
  }

  read() {
    this.fault = null;
    try {
      this.scene = new SceneText(this.now.text);
      const { value } = this.scene;
      if (value === null || typeof value !== "object" || Array.isArray(value)) this.fault = { detail: "a scene is an object in braces", place: [0, this.now.text.length] };
    } catch (error) {
      if (!(error instanceof NotJson)) throw error;
      const line = this.now.text.slice(0, error.offset).split("\n").length;
      this.fault = { detail: `this is not JSON yet, in line ${line}: ${error.message}`, place: [error.offset, error.offset + 1] };
    }
  }

  /** Whether there is something to draw and to work on; what else is wrong, the service says. */
  get sound() {
    return this.fault === null && isDrawable(this.scene.value);
  }

  open(text, waiting = []) {
    this.past = [];
    this.future = [];
    this.selection.clear();
    this.put({ text, waiting }, "open");
  }

  /** Change the scene; `words` say what was done. The same `run` as the last change is one change with it, as while one types or drags. */
  change(words, { scene = null, text = scene?.text ?? this.text, waiting = this.waiting, how = "edit", run = null }) {
    if (text === this.text && waiting === this.waiting) return;
    if (run === null || run !== this.run) {
      this.past = [...this.past, { ...this.now, words }].slice(-MOST_STEPS);
      this.future = [];
    }
    this.run = run;
    this.put({ text, waiting }, how);
  }

  /** The same change, with what the service has made of it. */
  complete(scene) {
    if (scene.text === this.text) return;
    this.now = { ...this.now, text: scene.text };
    this.read();
  }

  /** Undo the last change, or do it again; returns its words. */
  undo() {
    return this.step(this.past, this.future);
  }

  redo() {
    return this.step(this.future, this.past);
  }

  step(from, to) {
    const before = from.pop();
    if (!before) return null;
    to.push({ ...this.now, words: before.words });
    this.run = null;
    this.put({ text: before.text, waiting: before.waiting }, "undo");
    return before.words;
  }

  put(now, how) {
    this.now = now;
    this.read();
    this.changed(how);
  }
}

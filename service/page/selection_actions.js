// What can be done to the selection: by keys, by buttons, from the list of parts.
import { duplicated, movedBy, groundOf, renamed, tidy, turnedTo, withoutParts } from "./scene_changes.js";
import { bodyPart } from "./plane_drawing.js";
import { partsOf } from "./scene_parts.js";
import { pointerTo } from "./scene_text.js";
import { standing } from "./building.js";
import { gridStep, setDown } from "./snapping.js";

const NAME = /^[A-Za-z][\w-]*$/;

/** The actions, for a page that has the document, the board, `say(words)`, `start()` and `selected()`. */
export function selectionActions({ doc, board, say, start, selected }) {
  const chosen = () => board.parts.filter(({ id }) => doc.selection.has(id));
  const bodies = () => chosen().filter(({ kind }) => kind === "body").map(({ name }) => name);
  const names = (parts) => parts.map(({ name }) => name).join(", ");

  const select = (ids) => {
    doc.selection.clear();
    for (const id of ids) doc.selection.add(id);
    selected();
  };

  return {
    pick(id, several) {
      start();
      if (!several) select(doc.selection.has(id) && doc.selection.size === 1 ? [] : [id]);
      else { if (!doc.selection.delete(id)) doc.selection.add(id); selected(); }
    },
    next(by) {
      const { parts } = board, at = parts.findIndex(({ id }) => doc.selection.has(id));
      if (!parts.length) return say("There is no part yet.");
      const part = parts[(at + by + parts.length) % parts.length];
      select([part.id]);
      return say(`${part.name} selected.`);
    },
    selectAll: () => select(board.parts.filter(({ kind }) => kind === "body").map(({ id }) => id)),
    remove() {
      const parts = chosen();
      if (!parts.length || !board.ready()) return;
      const faces = new Set(parts.filter(({ kind }) => kind === "face").map(({ on }) => on)), scene = withoutParts(doc.scene, parts.map(({ id }) => id));
      start();
      doc.selection.clear();
      const lost = board.parts.length - partsOf(scene.value, doc.waiting).length;
      doc.change(`${names(parts)} deleted`, { scene, waiting: doc.waiting.filter((on) => !faces.has(on)), how: "build" });
      say(`${names(parts)} deleted${lost > parts.length ? ", with what was connected" : ""}.`);
    },
    duplicate() {
      const which = bodies();
      if (!which.length || !board.ready()) return say("Select a body first.");
      start();
      const step = 3 * gridStep(board.px), made = duplicated(doc.scene, which, [step, 0, 0].slice(0, board.space ? 3 : 2), board.model.numbers);
      doc.selection.clear();
      for (const name of made.names) doc.selection.add(bodyPart(name));
      board.held = made.names;
      doc.change(`${which.join(", ")} copied`, { scene: made.scene, how: "build" });
      return say(`Copied: ${made.names.join(", ")}.`);
    },
    shift(offset) {
      const which = bodies(), connections = chosen().filter(({ kind }) => kind === "connection"), faces = chosen().filter(({ kind }) => kind === "face" && kind);
      if (!board.ready()) return;
      if (!chosen().length) return board.space ? null : board.view.moveTo(board.view.middle.map((x, k) => x + 2 * offset[k]));
      start();
      const along = groundOf(doc.scene.value, which).filter((pointer) => board.goesAlong(doc.scene, pointer, which));
      const ends = connections.flatMap(({ pointer }) => ["a", "b", "at"].map((end) => `${pointer}/${end}`).filter((p) => Array.isArray(doc.scene.at(p))));
      const whole = board.space ? [...offset, 0, 0].slice(0, 3) : offset;
      let scene = movedBy(doc.scene, { names: which, points: [...along, ...ends], offset: whole }, board.model.numbers), { waiting } = doc;
      for (const face of faces) ({ scene, waiting } = board.withFaceMoved(scene, waiting, face, offset));
      board.held = which;
      doc.change(`${names(chosen())} moved`, { scene, waiting, how: "build", run: `keys ${[...doc.selection].join()}` });
      const where = which.length ? ` at ${(board.model.numbers.vector(doc.scene.at(pointerTo("bodies", which[0], "at"))) || []).map((x) => Number(x.toPrecision(4))).join(", ")}` : "";
      return say(`${names(chosen())} moved${where}.`);
    },
    /** Up or down, in space. */
    lift(height) {
      if (board.space) this.shift([0, 0, height]);
    },
    /** Onto the nearest face that it does not touch yet. */
    stand() {
      const [name] = bodies();
      if (!name || !board.ready() || board.space) return say("Select a body of the plane first.");
      start();
      const body = board.model.byName[name], landed = setDown(board.model, doc.scene.value, doc.waiting, body, body.at, board.px);
      if (!landed) return say("There is no face that it could stand on.");
      let scene = doc.scene.with(pointerTo("bodies", name, "at"), landed.at.map((x) => Number(x.toPrecision(15))));
      if (landed.turned) scene = turnedTo(scene, name, tidy((landed.angle * 180) / Math.PI), board.model);
      board.held = [name];
      doc.change(`${name} set down`, { scene: standing(scene, name, landed.on), waiting: doc.waiting.filter((on) => on !== landed.on), how: "build" });
      return say(`${name} stands at ${landed.at.map((x) => Number(x.toPrecision(4))).join(", ")}.`);
    },
    turn(by) {
      const which = bodies().filter((name) => board.model.byName[name]?.rigid);
      if (!which.length || board.model.space) return;
      start();
      board.held = which;
      const degrees = (name) => tidy((board.model.byName[name].angle * 180) / Math.PI + by);
      doc.change("turned", { scene: which.reduce((s, name) => turnedTo(s, name, degrees(name), board.model), doc.scene), how: "build", run: `turn ${which.join()}` });
      say(`${which[0]} turned to ${tidy((board.model.byName[which[0]].angle * 180) / Math.PI)} degrees.`);
    },
    /** Rename a part; returns what is wrong with the name, or nothing. */
    rename(id, name) {
      const old = id.slice(id.indexOf(":") + 1);
      if (name === old) return null;
      if (!NAME.test(name)) return "A name has letters, digits, - and _, and begins with a letter.";
      if (board.parts.some((part) => part.name === name && part.kind !== "face")) return `There is a ${name} already.`;
      const scene = renamed(doc.scene, id, name);
      doc.selection.delete(id);
      doc.selection.add(`${id.slice(0, id.indexOf(":"))}:${name}`);
      doc.change(`${old} renamed`, { scene, how: "edit" });
      return null;
    },
    undo() {
      const words = doc.undo();
      say(words ? `Undone: ${words}.` : "There is nothing to undo.");
    },
    redo() {
      const words = doc.redo();
      say(words ? `Done again: ${words}.` : "There is nothing to do again.");
    },
  };
}

// The keys of the picture: everything that a mouse can do to what is selected.
import { gridStep } from "./snapping.js";

const TURN = 15;
/** Degrees by which a key turns. */

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Listen at an element; `act` has a function for each thing that can be done. Keys in `except` are left to the element. */
export function listenForKeys(element, { act, px, except = [] }) {
  element.addEventListener("keydown", (event) => {
    if (except.includes(event.key)) return;
    const done = keyed(event, act, px);
    if (done) event.preventDefault();
  });
}

function keyed(event, act, px) {
  const { key } = event, command = event.ctrlKey || event.metaKey;
  if (command) {
    if (key === "d") return act.duplicate() ?? true;
    if (key === "a") return act.selectAll() ?? true;
    return false;
  }
  if (ARROWS[key]) {
    const step = gridStep(px()) * (event.shiftKey ? 10 : 1);
    return act.shift(ARROWS[key].map((x) => x * step)) ?? true;
  }
  if (event.key === "PageUp" || event.key === "PageDown") return act.lift((key === "PageUp" ? 1 : -1) * gridStep(px()) * (event.shiftKey ? 10 : 1)) ?? true;
  const plain = { Delete: act.remove, Backspace: act.remove, F2: act.rename, Escape: act.nothing, Enter: act.finish, "+": act.closer, "-": act.farther, "]": () => act.next(1), "[": () => act.next(-1), ".": () => act.turn(-TURN), ",": () => act.turn(TURN), v: act.stand, " ": act.play };
  return plain[key] ? plain[key]() ?? true : false;
}

/** Undo and redo wherever the cursor is, but in fields, which have their own. */
export function listenForUndo(act) {
  addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || /^(INPUT|TEXTAREA)$/.test(/** @type {Element} */ (event.target).tagName)) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) act.redo();
    else act.undo();
  });
}

// The parts as a list, by which they are selected without a picture.
import { make } from "./dom.js";
import { inWords } from "./scene_parts.js";

/** Fill `list` with a button for every part; `pick(id, several)` is called when one is pressed. */
export function showParts(list, parts, { value, selection, wrong, pick }) {
  const active = /** @type {HTMLElement | null} */ (document.activeElement), focused = list.contains(active) ? active.dataset.part : null;
  // What touches a face is listed while the face is selected.
  const open = new Set(parts.filter(({ kind, id }) => kind === "face" && selection.has(id)).flatMap(({ members }) => members));
  const listed = parts.filter(({ id, onFace, index }) => !onFace || open.has(index) || selection.has(id) || wrong.has(id));
  list.replaceChildren(...listed.map((part) => {
    const button = make("button", { type: "button", textContent: inWords(part, value), "aria-pressed": String(selection.has(part.id)) });
    button.dataset.part = part.id;
    if (wrong.has(part.id)) button.append(make("span", { className: "wrong", textContent: " does not fit" }));
    button.onclick = (event) => pick(part.id, event.shiftKey || event.ctrlKey || event.metaKey);
    return make("li", {}, button);
  }));
  if (focused) list.querySelector(`[data-part="${CSS.escape(focused)}"]`)?.focus();
}

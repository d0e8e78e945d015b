// Sliders for the numbers of a scene; each changes its number in the text and nothing else.
import { make, written } from "./dom.js";
import { namesIn, valueAt } from "./scene_text.js";

const PLACES = new Set(["at", "places", "axes", "through", "b", "a", "polar", "axis", "direction", "normal", "tensor"]);
const LEFT_OUT = new Set(["times", "accuracy", "input_uncertainty", "round", "outputs", "method"]);

/** Fill `panel` and `more` with sliders for the numbers in `places`; `change(pointer, text)` is called while one moves. */
export function sliders(panel, more, read, change) {
  const { value } = read;
  const made = numbersOf(read).map((pointer) => [isPlace(pointer) ? more : panel, slider(pointer, valueAt(value, pointer), value, change)]);
  for (const target of [panel, more]) target.replaceChildren(...made.filter(([to]) => to === target).map(([, element]) => element));
}

/** Pointers of the numbers of a scene. */
export const numbersOf = ({ value, places }) => [...places.keys()].filter((pointer) => typeof valueAt(value, pointer) === "number" && !LEFT_OUT.has(pointer.split("/")[1]));

const isPlace = (pointer) => namesIn(pointer).some((part) => PLACES.has(part)) && !pointer.endsWith("radius") && !pointer.endsWith("slope");

/** A pointer in words: "heavy: mass", "gravity y". */
export function inWords(pointer, value) {
  const [first, second, ...rest] = namesIn(pointer);
  const words = (list) => list.map((p, i) => (/^\d+$/.test(p) ? ["x", "y", "z"][p] && i === list.length - 1 ? ["x", "y", "z"][p] : String(Number(p) + 1) : p.replaceAll("_", " "))).join(" ");
  if (first === "bodies") return `${second}: ${words(rest)}`;
  if (first === "connections") {
    const connection = value.connections?.[second];
    return `${connection?.name || connection?.kind || second}: ${words(rest)}`;
  }
  return words([first, second, ...rest].filter((p) => p !== undefined));
}

function slider(pointer, value, whole, change) {
  const reach = value === 0 ? 1 : 3 * Math.abs(value);
  const positive = value > 0 && !isPlace(pointer);
  const input = make("input", { type: "range", min: positive ? 0 : -reach, max: reach, step: "any", value });
  const shown = make("output", { textContent: written(value, 4) });
  const fault = make("span", { className: "error", role: "alert" });
  const label = make("label", { className: "number" }, make("span", { textContent: inWords(pointer, whole) }), input, shown, fault);
  label.dataset.pointer = pointer;
  input.oninput = () => {
    const text = String(Number(Number(input.value).toPrecision(3)));
    shown.textContent = written(Number(text), 4);
    change(pointer, text);
  };
  return label;
}

/** Write each fault at its slider; returns those that have none. */
export function markFaults(panels, faults) {
  const labels = panels.flatMap((panel) => [...panel.querySelectorAll("label.number")]);
  for (const label of labels) label.querySelector(".error").textContent = "";
  return faults.filter(({ pointer, detail }) => {
    const label = pointer && labels.find((l) => l.dataset.pointer === pointer);
    if (label) label.querySelector(".error").textContent = detail;
    return !label;
  });
}

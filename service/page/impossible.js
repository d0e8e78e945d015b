// What does not fit, in words of the picture.
import { written } from "./dom.js";
import { namesIn } from "./scene_text.js";
import { connectionPart, bodyPart } from "./plane_drawing.js";
import { faceName, facePart, labelOf, onGround } from "./scene_parts.js";

const metres = (text) => `${written(Number(text), 3)} m`;

/** How the service says it, and what is seen: the second gets the connection, its name and what was caught. */
/** @type {[RegExp, (c: any, name: string, ...caught: string[]) => string][]} */
const SAID = [
  [/must agree with the positions: .* misses them by ([\d.e+-]+)/, (c, name, by) => `${name} misses: what it holds together is ${metres(by)} apart.`],
  [/must be ([\d.e+-]+) m, as the places are apart/, (c, name, apart) => (c?.kind === "string" ? `${name} is too short: its ends are ${metres(apart)} apart, and its length is ${c.length} m.` : `${name} has the length ${c?.length} m, and its ends are ${metres(apart)} apart.`)],
  [/must start with what cannot overlap apart: .* is missed by ([\d.e+-]+)/, (c, name, by) => `${overlapping(c)} overlap by ${metres(by)}.`],
  [/no places satisfy them all; where they do, .* stays open by about ([\d.e+-]+) m/, (c, name, by) => `${name} cannot reach: wherever the bodies are put, ${metres(by)} are missing.`],
  [/must name at least one body/, () => "There is no body in the picture yet."],
];

const overlapping = (c) => (c?.on ? `${c.place} and the ${onGround(c) ? faceName(c.on) : `face of ${c.on.at}`}` : c?.a ? `${c.a} and ${c.b}` : "Two bodies");

/** The part of the picture that a fault is about; null if it is about none. */
export function partOf(pointer, value) {
  const [group, key] = namesIn(pointer ?? "");
  if (group === "bodies" && key !== undefined) return bodyPart(key);
  const c = group === "connections" ? value.connections?.[key] : null;
  return c ? connectionPart(labelOf(c, Number(key))) : null;
}

/** Whether a place that is drawn belongs to the fault, too: the face that a contact is on. */
export const facesAt = (pointer, value) => {
  const [group, key] = namesIn(pointer ?? "");
  const c = group === "connections" ? value.connections?.[key] : null;
  return c && onGround(c) ? [facePart(c.on)] : [];
};

/** A fault as one sees it in the picture. */
export function faultInWords({ pointer, detail }, value) {
  const [group, key, ...rest] = namesIn(pointer ?? ""), c = group === "connections" ? value.connections?.[key] : null;
  const name = c ? labelOf(c, Number(key)) : key;
  for (const [pattern, say] of SAID) {
    const caught = pattern.exec(detail);
    if (caught) return say(c, name, ...caught.slice(1));
  }
  const field = rest.map((part) => (/^\d+$/.test(part) ? ["x", "y", "z"][part] ?? part : part.replaceAll("_", " "))).join(" ");
  const subject = name ? `${name}${field ? `, ${field}` : ""}: ` : group ? `${group.replaceAll("_", " ")}: ` : "";
  return `${subject}${detail}.`;
}

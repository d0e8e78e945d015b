// The parts of a scene, as a reader of its picture names them, and how they refer to one another.
import { bodyPart, connectionPart } from "./plane_drawing.js";
import { inline, pointerTo } from "./scene_text.js";

export const facePart = (on) => `face:${inline(on)}`;

/** What a connection names: `[pointer inside it, reference]`, bodies and places as text, points of the ground as they are. */
export function referencesOf(c) {
  const single = ["a", "b", "place", "body"].filter((name) => c[name] !== undefined).map((name) => [`/${name}`, c[name]]);
  const on = Array.isArray(c.on) ? c.on.map((name, k) => [`/on/${k}`, name]) : c.on?.at !== undefined ? [["/on/at", c.on.at]] : [];
  const through = (Array.isArray(c.through) ? c.through : []).map((stop, k) => [`/through/${k}`, stop]);
  return [...single, ...on, ...through];
}

export const bodyOf = (reference, bodies) => (typeof reference !== "string" ? null : reference in bodies ? reference : reference.slice(0, reference.lastIndexOf(".")));

export const labelOf = (c, index) => c.name || `${c.kind}-${index + 1}`;

/** Whether a connection touches a straight or round face of the ground. */
export const onGround = (c) => c.on && typeof c.on === "object" && !Array.isArray(c.on) && typeof c.on.at !== "string";

/** The faces of the ground that connections name, and those that nothing touches yet. */
export function facesOf(value, waiting = []) {
  const faces = new Map();
  (value.connections || []).forEach((c, index) => {
    if (!onGround(c)) return;
    const id = facePart(c.on);
    if (!faces.has(id)) faces.set(id, { id, on: c.on, members: [] });
    faces.get(id).members.push(index);
  });
  for (const on of waiting) if (!faces.has(facePart(on))) faces.set(facePart(on), { id: facePart(on), on, members: [] });
  return [...faces.values()];
}

/** All parts in the order of the text: `{id, kind, name, pointer}`; a face has the connections on it as `members`. */
export function partsOf(value, waiting = []) {
  const bodies = Object.keys(value.bodies || {}).map((name) => ({ id: bodyPart(name), kind: "body", name, pointer: pointerTo("bodies", name) }));
  const connections = (value.connections || []).map((c, index) => ({ id: connectionPart(labelOf(c, index)), kind: "connection", name: labelOf(c, index), index, pointer: pointerTo("connections", index), onFace: Boolean(onGround(c)) }));
  const faces = facesOf(value, waiting).map((face) => ({ ...face, kind: "face", name: faceName(face.on), pointer: face.members.length ? pointerTo("connections", face.members[0], "on") : null }));
  return [...bodies, ...faces, ...connections];
}

/** What people call a face of the ground. */
export function faceName(on) {
  if (on.radius !== undefined) return "round face";
  if (on.curvature !== undefined) return "curved face";
  if (on.curve !== undefined || on.surface !== undefined) return "curve";
  const slope = on.slope?.degrees ?? (typeof on.slope === "number" ? (on.slope * 180) / Math.PI : on.slope === undefined ? 0 : NaN);
  if (on.normal !== undefined) return "plane";
  if (slope === 0) return "floor";
  if (slope === 180 || slope === -180) return "ceiling";
  return Math.abs(slope) === 90 || slope === 270 ? "wall" : "ramp";
}

/** A part in words, for lists and announcements: "pin-1: pin of rod.top and the ground". */
export function inWords(part, value) {
  if (part.kind === "face") return part.name;
  if (part.kind === "body") return part.name;
  const c = value.connections[part.index], bodies = value.bodies || {};
  const ends = referencesOf(c).filter(([pointer]) => !pointer.startsWith("/on/")).map(([, r]) => (bodyOf(r, bodies) ? r : "the ground"));
  const face = typeof c.on?.at === "string" ? ` on ${c.on.at}` : part.onFace ? ` on the ${faceName(c.on)}` : "";
  return `${part.name}: ${c.kind.replaceAll("-", " ")} of ${ends.join(" and ") || "everything"}${face}`;
}

/** A name that is not taken yet: the base, then the base with a number. */
export function freeName(base, value) {
  const taken = new Set([...Object.keys(value.bodies || {}), ...(value.connections || []).map(labelOf), ...Object.keys(value.let || {})]);
  if (!taken.has(base) && !/-\d+$/.test(base) && base.length > 1) return base;
  const stem = base.replace(/-\d+$/, "");
  for (let k = 2; ; k++) if (!taken.has(`${stem}-${k}`)) return `${stem}-${k}`;
}

/** Every place that a connection may name: centres and places of bodies. */
export function placesOf(value) {
  return Object.entries(value.bodies || {}).flatMap(([name, body]) => [name, ...Object.keys(body.places || {}).map((place) => `${name}.${place}`)]);
}

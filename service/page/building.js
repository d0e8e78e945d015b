// What the tools do: each makes one change of the scene, from places of the picture or from a form.
import { BODIES, CONNECTIONS, FACES, NEW_CONTACT } from "./new_parts.js";
import { outlineOf } from "./outlines.js";
import { bodyPart, connectionPart } from "./plane_drawing.js";
import { tidy, withBody, withConnection } from "./scene_changes.js";
import { SceneModel } from "./scene_model.js";
import { bodyOf, faceName, facePart, facesOf, freeName, referencesOf } from "./scene_parts.js";
import { pointerTo } from "./scene_text.js";
import { ontoFace } from "./snapping.js";
import { sidesOf } from "./string_sides.js";
import { add, dot, sub, turned } from "./vectors.js";

const WIDE = 130;
/** Pixels of a metre at which new parts have their full size. */

/** The size of new parts at a scale of the picture: a round factor. */
export const sizeAt = (px) => {
  const factor = WIDE * px, power = 10 ** Math.floor(Math.log10(factor));
  return [1, 2, 5, 10].map((k) => k * power).reduce((best, k) => (Math.abs(Math.log(k / factor)) < Math.abs(Math.log(best / factor)) ? k : best));
};

/** The places of a body that touch faces: corners and ends by name, or the body itself. */
export function touchingPlaces(name, described, model) {
  const body = model.readBody(name, described);
  if (described.at?.length === 3) return body.radius || !body.rigid ? [name] : Object.keys(described.places || {}).map((place) => `${name}.${place}`);
  const outline = outlineOf(body, model.numbers);
  if (outline?.radius || !outline || !Object.keys(described.places || {}).length) return [name];
  return Object.keys(described.places).map((place) => `${name}.${place}`);
}

/** With contacts of a body on a face, where it has none yet. */
function touching(scene, name, on, model) {
  let next = scene;
  const met = new Set((scene.value.connections || []).filter((c) => c.on && facePart(c.on) === facePart(on)).map((c) => c.place));
  for (const place of touchingPlaces(name, scene.at(pointerTo("bodies", name)), model)) {
    if (met.has(place)) continue;
    const base = `${name}-on-${typeof on.at === "string" ? on.at.slice(0, on.at.lastIndexOf(".")) : faceName(on)}`;
    next = withConnection(next, { kind: "contact", name: freeName(base, next.value), place, on, ...NEW_CONTACT }).scene;
  }
  return next;
}

/** Whether nothing holds a body. */
const isFree = (value, name) => !(value.connections || []).some((c) => c.kind !== "contact" && c.kind !== "force" && referencesOf(c).some(([, r]) => bodyOf(r, value.bodies) === name));

const isStraight = (on) => on.radius === undefined && on.curvature === undefined && on.curve === undefined && on.surface === undefined;

/** Whether all of a body lies on the free side of a face, or on it. */
function above(model, name, on, slack) {
  if (model.space) {
    const { point, normal } = model.face(on), body = model.byName[name];
    return dot(sub(body.at, point), normal) - (body.radius ?? 0) > -slack;
  }
  const body = model.byName[name], { point, normal } = model.face(on), outline = outlineOf(body, model.numbers);
  const corners = outline?.corners ?? outline?.bar ?? [[0, 0]], rim = outline?.radius ?? 0;
  return corners.every((p) => dot(sub(add(body.at, turned(body.angle, p)), point), normal) - rim > -slack);
}

/** A new body at a point, standing on what is near: `{scene, selected, words, waiting}`. */
export function placeBody(kind, doc, point, px) {
  const tool = BODIES[kind], model = new SceneModel(doc.scene.value, null), size = sizeAt(px);
  const body = { ...tool.make(size), at: point.map(tidy) };
  const trial = model.readBody("new", body);
  const landed = model.space || point.length === 3 || (tool.held && kind !== "wedge") ? null : ontoFace(model, doc.scene.value, doc.waiting, { ...trial, angle: 0 }, point, px);
  if (landed) {
    body.at = landed.at.map((x) => Number(x.toPrecision(15)));
    if (Math.abs(landed.angle) > 1e-12) body.angle = { degrees: tidy((landed.angle * 180) / Math.PI) };
  }
  let { scene, name } = withBody(doc.scene, tool.base, body);
  for (const connection of tool.held?.(name, body.at) ?? []) scene = withConnection(scene, connection).scene;
  let waiting = doc.waiting;
  if (landed) scene = touching(scene, name, landed.on, model);
  if (!tool.held) ({ scene, waiting } = withAllFaces(scene, waiting, name, px));
  const on = landed ? `, on the ${faceWords(landed.on)}` : "";
  return { scene, waiting, selected: [bodyPart(name)], words: `${name} placed at ${body.at.join(", ")}${on}` };
}

const faceWords = (on) => (typeof on.at === "string" ? `face of ${on.at.slice(0, on.at.lastIndexOf("."))}` : faceName(on));

/** With what a body needs to stand on a face where it has been put. */
export const standing = (scene, name, on) => touching(scene, name, on, new SceneModel(scene.value, null));

/** A body may touch every straight face of the ground on whose free side it is. */
function withAllFaces(scene, waiting, name, px) {
  const model = new SceneModel(scene.value, null);
  let next = scene;
  for (const { on } of facesOf(scene.value, waiting)) if (isStraight(on) && above(model, name, on, 2 * px)) next = touching(next, name, on, model);
  const touched = new Set(facesOf(next.value).map(({ id }) => id));
  return { scene: next, waiting: waiting.filter((on) => !touched.has(facePart(on))) };
}

/** A new face at a point: what is free and above it may touch it. */
export function placeFace(kind, doc, point, px) {
  const model = new SceneModel(doc.scene.value, null), bodies = Object.keys(doc.scene.value.bodies || {});
  const middle = model.bodies.length ? model.bodies.reduce((sum, b) => sum + b.start[0], 0) / model.bodies.length : 0;
  const on = FACES[kind].make(point.map(tidy), point[0] >= middle ? "right" : "left");
  let next = doc.scene;
  for (const name of bodies) if (isFree(doc.scene.value, name) && above(model, name, on, 2 * px)) next = touching(next, name, on, model);
  const met = facesOf(next.value).some(({ id }) => id === facePart(on));
  const said = met ? "" : ". Bodies that you put above it will stand on it";
  return { scene: next, waiting: met ? doc.waiting : [...doc.waiting, on], selected: [facePart(on)], words: `${FACES[kind].words} placed at ${point.map(tidy).join(", ")}${said}` };
}

/** A new connection of references: `{scene, selected, words, waiting}`, or `{problem}` in words. */
export function connect(kind, doc, references, { scene = doc.scene, vector = null } = {}) {
  const tool = CONNECTIONS[kind], bodies = scene.value.bodies || {};
  const held = references.map((r) => bodyOf(r, bodies));
  if (!held.some(Boolean)) return { problem: `${article(tool.words)} holds at least one body: begin or end at one` };
  const [first, second] = references;
  if (tool.ends === 2 && held[0] !== null && held[0] === held[1]) return { problem: `${article(tool.words)} joins two different bodies, or a body and the ground` };
  if (tool.rims && held.some((h) => h === null)) return { problem: "A contact is of two bodies; a body touches the ground by a floor, wall or ramp" };
  // The ground comes second.
  const ordered = tool.ends === 2 && held[0] === null ? [second, first] : references;
  const rims = tool.rims ? ordered.map((r) => bodyOf(r, bodies)) : ordered;
  const connection = tool.make(rims, vector, scene.value.gravity?.length === 3);
  if (tool.rigid && bodies[held[0]] && isPoint(bodies[held[0]])) return { problem: `A motor turns a body that has a size; ${held[0]} is a point` };
  if (kind === "string") {
    const sides = sidesOf(new SceneModel(scene.value, null), references);
    if (sides) connection.sides = sides;
  }
  if (kind === "motor") connection.a = held[0];
  const made = withConnection(scene, connection);
  return { scene: made.scene, waiting: doc.waiting, selected: [connectionPart(made.name)], words: `${made.name} from ${references.map(said).join(" to ")}` };
}

const isPoint = (body) => ["inertia", "moments", "tensor", "body", "shape"].every((name) => body[name] === undefined);
const said = (reference) => (typeof reference === "string" ? reference : `the ground at ${reference.join(", ")}`);
const article = (words) => `${/^[AEIOU]/.test(words) ? "An" : "A"} ${words.toLowerCase()}`;

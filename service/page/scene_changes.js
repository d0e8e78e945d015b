// Changes of a scene as one makes them in its picture. Each takes a scene's text and gives a new one.
import { bodyPart, connectionPart } from "./plane_drawing.js";
import { bodyOf, facesOf, freeName, labelOf, referencesOf } from "./scene_parts.js";
import { inline, namesIn, pointerTo, valueAt } from "./scene_text.js";

/** A number as one would write it by hand: 12 significant digits, no trailing noise. */
export const tidy = (x) => Number(x.toPrecision(12)) + 0;

export function withBody(scene, base, body) {
  const name = freeName(base, scene.value);
  return { scene: scene.with(pointerTo("bodies", name), body), name };
}

/** With a connection; without a name of its own it is called after its kind. */
export function withConnection(scene, connection) {
  const { kind, name: given, ...fields } = connection, name = given ?? freeName(kind, scene.value);
  return { scene: scene.with("/connections/-", { kind, name, ...fields }), name };
}

/** Without parts, and without what was connected to bodies that are gone. */
export function withoutParts(scene, ids) {
  const { value } = scene, bodies = value.bodies || {}, gone = new Set(ids);
  const faces = facesOf(value).filter((face) => gone.has(face.id)).flatMap((face) => face.members);
  const connections = (value.connections || []).map((c, index) => [c, index]).filter(([c, index]) =>
    gone.has(connectionPart(labelOf(c, index))) || faces.includes(index) || referencesOf(c).some(([, r]) => gone.has(bodyPart(bodyOf(r, bodies)))));
  const pointers = [...Object.keys(bodies).filter((name) => gone.has(bodyPart(name))).map((name) => pointerTo("bodies", name)), ...connections.map(([, index]) => pointerTo("connections", index))];
  // Names that stay implied by a place in the list are written before the list gets shorter.
  return named(scene, connections.map(([, index]) => index)).withoutAll(pointers);
}

/** Connections whose label is their place in the list keep it by name. */
function named(scene, leaving) {
  if (!leaving.length) return scene;
  const first = Math.min(...leaving);
  return (scene.value.connections || []).reduce((next, c, index) => (index > first && !c.name ? next.with(pointerTo("connections", index, "name"), labelOf(c, index)) : next), scene);
}

/** With a body or connection under another name, wherever it is named. */
export function renamed(scene, id, to) {
  const { value } = scene, from = id.slice(id.indexOf(":") + 1), bodies = value.bodies || {};
  const swap = (text) => (text === from ? to : text.startsWith(`${from}.`) ? to + text.slice(from.length) : text);
  if (id.startsWith("connection:")) {
    const index = (value.connections || []).findIndex((c, i) => labelOf(c, i) === from);
    return scene.with(pointerTo("connections", index, "name"), to);
  }
  const references = (value.connections || []).flatMap((c, i) => referencesOf(c).filter(([, r]) => typeof r === "string" && bodyOf(r, bodies) === from).map(([inner, r]) => [`${pointerTo("connections", i)}${inner}`, inline(swap(r))]));
  const spoken = new RegExp(`(?<![\\w.-])${from.replace(/[-]/g, "\\$&")}\\.(?=[a-z])`, "g");
  const formulas = [...scene.places.keys()].filter((pointer) => isFormula(pointer, valueAt(value, pointer)) && valueAt(value, pointer).search(spoken) >= 0).map((pointer) => [pointer, inline(valueAt(value, pointer).replace(spoken, `${to}.`))]);
  const known = new Set(references.map(([pointer]) => pointer));
  let next = scene.withSources([...references, ...formulas.filter(([pointer]) => !known.has(pointer))]);
  (value.connections || []).forEach((c, i) => {
    if (c.sides?.[from] === undefined) return;
    const { [from]: side, ...others } = c.sides;
    next = next.with(pointerTo("connections", i, "sides"), { ...others, [to]: side });
  });
  return keyRenamed(next, pointerTo("bodies", from), to);
}

const isFormula = (pointer, value) => typeof value === "string" && !["name", "kind"].includes(namesIn(pointer).at(-1));

/** The name of a member of an object changed where it stands. */
function keyRenamed(scene, pointer, to) {
  const from = JSON.stringify(namesIn(pointer).at(-1)), [start] = scene.places.get(pointer);
  const at = scene.text.lastIndexOf(from, start);
  return scene.spliced(at, at + from.length, JSON.stringify(to));
}

/** With copies of bodies, of what connects them to one another, and of what holds them to the ground, moved by `offset`. */
export function duplicated(scene, names, offset, n) {
  const { value } = scene, bodies = value.bodies || {}, copies = new Map();
  let next = scene;
  for (const name of names) {
    const made = withBody(next, name, { ...bodies[name], at: moved(bodies[name].at, offset, n) });
    copies.set(name, made.name);
    next = made.scene;
  }
  const swap = (r) => {
    const body = bodyOf(r, bodies);
    return copies.has(body) ? copies.get(body) + r.slice(body.length) : typeof r === "string" ? r : moved(r, offset, n);
  };
  (value.connections || []).forEach((c) => {
    const named = referencesOf(c).map(([, r]) => bodyOf(r, bodies)).filter(Boolean);
    if (!named.length || !named.every((name) => copies.has(name))) return;
    const { name: _, ...copy } = structuredClone(c);
    for (const [inner, r] of referencesOf(c)) {
      const path = namesIn(inner), holder = path.slice(0, -1).reduce((o, p) => o[p], copy);
      // A face of the ground is the same for all.
      if (inner !== "/on/at" || typeof r === "string") holder[path.at(-1)] = swap(r);
    }
    if (copy.sides) copy.sides = Object.fromEntries(Object.entries(copy.sides).map(([name, side]) => [copies.get(name) ?? name, side]));
    next = withConnection(next, copy).scene;
  });
  return { scene: next, names: [...copies.values()] };
}

/** A point of the description moved by a vector; components that do not move keep how they are written. */
export function moved(at, offset, n) {
  const numbers = n.vector(at) || offset.map(() => 0);
  return numbers.map((x, k) => (offset[k] === 0 && Array.isArray(at) ? at[k] : tidy(x + offset[k])));
}

/** Points of the ground that go along when these bodies are moved: those of connections that hold nothing else. */
export function groundOf(value, names) {
  const bodies = value.bodies || {};
  return (value.connections || []).flatMap((c, index) => {
    const references = referencesOf(c), held = references.map(([, r]) => bodyOf(r, bodies)).filter(Boolean);
    if (!held.length || !held.every((name) => names.includes(name))) return [];
    return references.filter(([inner, r]) => typeof r !== "string" && inner !== "/on/at").map(([inner]) => `${pointerTo("connections", index)}${inner}`);
  });
}

/** With bodies, points of the ground and faces moved by a vector. */
export function movedBy(scene, { names = [], points = [], offset }, n) {
  const pointers = [...names.map((name) => pointerTo("bodies", name, "at")), ...points];
  return scene.withSources(pointers.map((pointer) => [pointer, inline(moved(scene.at(pointer) ?? [0, 0], offset, n))]));
}

/** With a body turned to an angle (degrees): about its centre, or about the point of the ground to which it is pinned. */
export function turnedTo(scene, name, degrees, model) {
  const body = model.byName[name], pointer = pointerTo("bodies", name), turned = scene.with(`${pointer}/angle`, { degrees });
  const pins = (scene.value.connections || []).filter((c) => c.kind === "pin" && typeof c.b !== "string" && bodyOf(c.a, scene.value.bodies) === name);
  if (pins.length !== 1 || pins[0].a === name) return turned;
  const { point } = model.place(pins[0].b), by = (degrees * Math.PI) / 180 - body.angle, [x, y] = [body.at[0] - point[0], body.at[1] - point[1]];
  return turned.with(`${pointer}/at`, [point[0] + x * Math.cos(by) - y * Math.sin(by), point[1] + x * Math.sin(by) + y * Math.cos(by)].map((v) => Number(v.toPrecision(15))));
}

/** With another face of the ground in place of `id`, for everything that touches it. */
export function withFace(scene, id, on) {
  const face = facesOf(scene.value).find((f) => f.id === id);
  return (face?.members ?? []).reduce((next, index) => next.with(pointerTo("connections", index, "on"), on), scene);
}

/** With the places that an assembly found for the bodies that it has moved. */
export function withAssembly(scene, assembly) {
  let next = scene;
  for (const [name, body] of Object.entries(assembly.bodies)) {
    if (!(body.moved > 0 || Math.abs(body.turned ?? 0) > 0)) continue;
    if (body.at) next = next.with(pointerTo("bodies", name, "at"), body.at);
    if (body.angle !== null && body.angle !== undefined && (body.turned || next.at(pointerTo("bodies", name, "angle")) !== undefined)) next = next.with(pointerTo("bodies", name, "angle"), body.angle);
    if (body.axes) next = next.with(pointerTo("bodies", name, "axes"), body.axes);
  }
  return next;
}


// The handles of what is selected: where they are, and what the scene becomes when one is dragged to a point.
import { corners } from "./new_parts.js";
import { outlineOf, homogeneousInertia } from "./outlines.js";
import { tidy, turnedTo, withFace } from "./scene_changes.js";
import { pointerTo } from "./scene_text.js";
import { gridStep, nearestPlace, toAngle, toGrid } from "./snapping.js";
import { add, norm, scaled, sub, turned } from "./vectors.js";

const ARROW = 60, TURN = 34;
/** Pixels of a unit of velocity or force; of the handle for turning beyond an outline. */

const degreesOf = (v) => (Math.atan2(v[1], v[0]) * 180) / Math.PI;
const onGrid = (v, step) => v.map((x) => toGrid(x, step));

/** A round number that vectors of this size are drawn by, so that they fit the picture. */
const roundScale = (size) => (size > 0 ? 10 ** Math.ceil(Math.log10(size / 3)) : 1);

/**
 * A handle: `from` is what it is tied to by a line, `drag` gives the scene that it makes, `say` what it has come to.
 * @typedef {{name: string, at: number[], from?: number[], arrow?: boolean, words: string, drag: (point: number[]) => any,
 *   face?: (point: number[]) => any, say: (scene: any) => string}} Handle
 */

/**
 * Handles of a body, connection or face.
 * @returns {Handle[]}
 */
export function handlesOf(part, { scene, model, px }) {
  if (part.kind === "body") return ofBody(part, scene, model, px);
  if (part.kind === "face") return ofFace(part, scene, model, px);
  return ofConnection(part, scene, model, px);
}

function ofBody({ name }, scene, model, px) {
  const body = model.byName[name];
  if (!body || model.space) return [];
  const pointer = pointerTo("bodies", name), outline = outlineOf(body, model.numbers), described = scene.at(pointer);
  const velocity = model.numbers.vector(described.velocity) || [0, 0], scale = roundScale(norm(velocity)), k = (ARROW * px) / scale;
  const velocityAt = norm(velocity) > 0 ? add(body.at, velocity, k) : add(body.at, [0, 46 * px]);
  const handles = [];
  if (body.mass) {
    handles.push({
      name: "velocity", at: velocityAt, from: body.at, arrow: norm(velocity) > 0, words: "velocity",
      drag(point) {
        const v = onGrid(scaled(sub(point, body.at), 1 / k), 0.1 * scale);
        return norm(v) ? scene.with(`${pointer}/velocity`, v) : scene.without(`${pointer}/velocity`);
      },
      say: (s) => `velocity ${(s.at(`${pointer}/velocity`) || [0, 0]).join(", ")} m/s`,
    });
  }
  if (!body.rigid) return handles;
  const reach = outline?.radius ?? Math.max(0, ...(outline?.corners ?? outline?.bar ?? outline?.spokes ?? []).map(norm));
  handles.push({
    name: "angle", at: add(body.at, turned(body.angle, [reach + TURN * px, 0])), from: body.at, words: "angle",
    drag: (point) => turnedTo(scene, name, toAngle(degreesOf(sub(point, body.at))), model),
    say: (s) => `angle ${s.at(`${pointer}/angle`)?.degrees ?? 0} degrees`,
  });
  return [...handles, ...sizes(name, body, outline, scene, model, px)];
}

/** Handles for the size of an outline; the moment of inertia stays that of a homogeneous body if it was. */
function sizes(name, body, outline, scene, model, px) {
  const pointer = pointerTo("bodies", name), step = gridStep(px);
  const homogeneous = isHomogeneous(scene, name, model);
  const resized = (next) => (homogeneous ? withHomogeneousInertia(next, name, model) : next);
  if (outline?.radius && scene.at(`${pointer}/radius`) !== undefined) {
    return [{
      name: "radius", at: add(body.at, turned(body.angle + 2.4, [outline.radius, 0])), words: "radius",
      drag: (point) => resized(scene.with(`${pointer}/radius`, Math.max(step / 2, toGrid(norm(sub(point, body.at)), step / 2)))),
      say: (s) => `radius ${s.at(`${pointer}/radius`)} m`,
    }];
  }
  if (outline?.corners && described4(scene.at(pointer))) {
    const [x, y] = model.numbers.vector(scene.at(`${pointer}/places/upper-right`));
    return [{
      name: "size", at: add(body.at, turned(body.angle, [x, y])), words: "size",
      drag(point) {
        const [w, h] = turned(-body.angle, sub(point, body.at)).map((d) => Math.max(step / 2, toGrid(Math.abs(d), step / 2)));
        const sized = scene.at(`${pointer}/shape`) ? scene.with(`${pointer}/shape/width`, tidy(2 * w)).with(`${pointer}/shape/height`, tidy(2 * h)) : scene;
        return resized(withCorners(sized, pointer, 2 * w, 2 * h));
      },
      say: (s) => { const [w, h] = s.at(`${pointer}/places/upper-right`); return `width ${tidy(2 * w)} m, height ${tidy(2 * h)} m`; },
    }];
  }
  return Object.entries(outline?.bar ? body.places : {}).map(([place, at]) => ({
    name: place, at: add(body.at, turned(body.angle, at)), words: place,
    // One end stays, the other is where one drags it; the centre is between them.
    drag(point) {
      const names = Object.keys(body.places), other = names.find((n) => n !== place);
      const end = onGrid(point, step), fixed = other ? add(body.at, turned(body.angle, body.places[other])) : body.at;
      const length = norm(sub(end, fixed));
      if (!other || !(length > 0)) return scene;
      const sign = Math.sign(body.places[place][0]) || 1, angle = degreesOf(scaled(sub(end, fixed), sign));
      const next = scene.with(`${pointer}/at`, scaled(add(end, fixed), 0.5).map(tidy)).with(`${pointer}/angle`, { degrees: tidy(angle) })
        .with(`${pointer}/places/${place}`, [tidy((sign * length) / 2), 0]).with(`${pointer}/places/${other}`, [tidy((-sign * length) / 2), 0]);
      return resized(next);
    },
    say: (s) => `length ${tidy(2 * norm(s.at(`${pointer}/places/${place}`)))} m`,
  }));
}

/** With the named corners of a box where its width and height have them. */
export const withCorners = (scene, pointer, width, height) => Object.entries(corners(width, height)).reduce((s, [place, at]) => s.with(`${pointer}/places/${place}`, at.map(tidy)), scene);

export const described4 = (body) => ["lower-left", "lower-right", "upper-right", "upper-left"].every((name) => body.places?.[name]);

/** Whether the inertia of a body is that of a homogeneous one of its outline. */
export function isHomogeneous(scene, name, model) {
  const body = scene.at(pointerTo("bodies", name)), n = model.numbers;
  if (typeof body?.inertia !== "number") return false;
  const expected = homogeneousInertia(n.number(body.mass), outlineOf(model.readBody(name, body), n));
  return expected !== null && Math.abs(expected - body.inertia) < 1e-5 * expected;
}

export function withHomogeneousInertia(scene, name, model) {
  const pointer = pointerTo("bodies", name), body = scene.at(pointer), n = model.numbers;
  const inertia = homogeneousInertia(n.number(body.mass), outlineOf(model.readBody(name, body), n));
  return inertia > 0 ? scene.with(`${pointer}/inertia`, Number(inertia.toPrecision(6))) : scene;
}

function ofFace(face, scene, model, px) {
  const { point, along, radius, curvature, curve } = model.face(face.on);
  if (model.space || curve || curvature !== null) return [];
  if (radius !== null) {
    return [{
      name: "radius", at: add(point, [Math.abs(radius), 0]), words: "radius",
      drag: (p) => withFace(scene, face.id, { ...face.on, radius: Math.sign(radius || 1) * toGrid(norm(sub(p, point)), gridStep(px)) }), face: (p) => ({ ...face.on, radius: Math.sign(radius || 1) * toGrid(norm(sub(p, point)), gridStep(px)) }),
      say: () => "radius of the face",
    }];
  }
  const turnedTo = (p) => {
    const slope = toAngle(degreesOf(sub(p, point)));
    return { at: face.on.at ?? [0, 0], ...(slope ? { slope: { degrees: slope } } : {}) };
  };
  return [{ name: "slope", at: add(point, along, 110 * px), words: "slope", drag: (p) => withFace(scene, face.id, turnedTo(p)), face: turnedTo, say: () => "slope of the face" }];
}

function ofConnection({ index, pointer }, scene, model, px) {
  const c = model.connections[index];
  if (!c || model.space) return [];
  const handles = [];
  const ends = c.through ? c.through.map((r, k) => [`/through/${k}`, r]) : ["a", "b", "at"].filter((name) => c[name] !== undefined).map((name) => [`/${name}`, c[name]]);
  for (const [inner, reference] of ends) {
    // An end at a body goes with the body; the inspector has where else it may be.
    if (typeof reference === "string") continue;
    handles.push({
      name: inner, at: model.place(reference).point, words: "end",
      drag(point) {
        const place = nearestPlace(model, point, px), step = gridStep(px);
        if (place && place.reference !== c.a) return scene.with(pointer + inner, place.reference);
        return inner === "/a" ? scene : scene.with(pointer + inner, onGrid(point, step));
      },
      say: (s) => { const r = s.at(pointer + inner); return `end at ${typeof r === "string" ? r : r.join(", ")}`; },
    });
  }
  if (c.kind === "force") {
    const at = model.place(c.place).point, force = model.numbers.vector(c.force) || [0, 0];
    if (force.every(Number.isFinite)) {
      const scale = roundScale(norm(force)), k = (ARROW * px) / scale;
      handles.push({
        name: "force", at: add(at, force, k), from: at, arrow: true, words: "force",
        drag: (point) => scene.with(`${pointer}/force`, onGrid(scaled(sub(point, at), 1 / k), 0.1 * scale)),
        say: (s) => `force ${s.at(`${pointer}/force`).join(", ")} N`,
      });
    }
  }
  if (c.kind === "slider") {
    const { at, tangent } = model.touching(c);
    handles.push({
      name: "slope", at: add(at, tangent, 90 * px), words: "slope",
      drag: (point) => scene.with(`${pointer}/slope`, { degrees: toAngle(degreesOf(sub(point, at))) }),
      say: (s) => `slope ${s.at(`${pointer}/slope`)?.degrees} degrees`,
    });
  }
  return handles;
}

/** A force as it is drawn by dragging from a place (N). */
export const forceOf = (from, to, px) => onGrid(scaled(sub(to, from), 1 / (ARROW * px)).map((x) => 5 * x), 0.5);

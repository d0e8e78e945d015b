// Where a thing lands that is let go near something: at places, on faces, on a grid of round numbers.
import { outlineOf, touchingPoints } from "./outlines.js";
import { bodyOf, facePart, facesOf } from "./scene_parts.js";
import { add, dot, norm, sub, turned } from "./vectors.js";

const NEAR = 12, GRID = 9;
/** Pixels within which a place or a face attracts; the least distance of two lines of the grid. */

/** The step of the grid at a length of a pixel: 1, 2 or 5 times a power of ten. */
export function gridStep(px) {
  const least = GRID * px, power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= least * (1 - 1e-9));
}

export const toGrid = (x, step) => Number((Math.round(x / step) * step).toPrecision(10)) + 0;

/** Round an angle to 15 degrees if it is near one (degrees); else to whole degrees. */
export function toAngle(degrees) {
  const near = 15 * Math.round(degrees / 15);
  return (Math.abs(degrees - near) < 4 ? near : Math.round(degrees)) + 0;
}

/** Points that a connection can hold: `{point, reference}`; references are text for bodies, and points for the ground. */
export function placesSeen(model) {
  const ofBodies = model.bodies.flatMap((body) => [
    ...Object.entries(body.places).map(([name, at]) => ({ reference: `${body.name}.${name}`, point: add(body.at, model.outward(body, at)), body: body.name })),
    { reference: body.name, point: body.at, body: body.name },
  ]);
  const ground = model.connections.flatMap((c) => [c.a, c.b, c.at, ...(Array.isArray(c.through) ? c.through : [])])
    .filter((r) => r && typeof r === "object").map((r) => ({ reference: r, point: model.place(r).point, body: null }));
  return [...ofBodies, ...ground];
}

/** The place nearest to a point, if one is near enough; `except` are bodies that do not count. */
export function nearestPlace(model, point, px, except = []) {
  const near = placesSeen(model).filter(({ body }) => !except.includes(body)).map((place) => ({ ...place, far: norm(sub(place.point, point)) })).filter(({ far }) => far <= NEAR * px);
  return near.sort((p, q) => p.far - q.far)[0] ?? null;
}

/** A point on the grid, or at a place that is near. */
export function snapped(model, point, px, { except = [], free = false } = {}) {
  if (free) return { point: point.map((x) => Number(x.toPrecision(6))), place: null };
  const place = nearestPlace(model, point, px, except), step = gridStep(px);
  if (place) return { point: place.point, place };
  // What is to hang from a drum hangs straight down from its rim.
  const rims = model.bodies.filter((body) => body.radius && !except.includes(body.name)).flatMap((body) => [body.at[0] - body.radius, body.at[0] + body.radius]);
  const rim = rims.find((x) => Math.abs(x - point[0]) < 0.75 * NEAR * px);
  return { point: point.map((x, k) => (k === 0 && rim !== undefined ? Number(rim.toPrecision(10)) : toGrid(x, step))), place: null };
}

/** The straight faces that a body can stand on: those of the ground, and the edges of other bodies, which end. */
function faces(model, value, waiting, name) {
  const ground = facesOf(value, waiting).map((face) => ({ on: face.on, ends: null }));
  const edges = model.bodies.filter((body) => body.name !== name).flatMap((body) => {
    const corners = outlineOf(body, model.numbers)?.corners ?? [], places = Object.entries(body.places);
    const at = (corner) => places.find(([, p]) => norm(sub(p, corner)) < 1e-12)?.[0];
    // Corners are counter-clockwise: looking from each to the one before, what is free lies to the left.
    return corners.map((corner, k) => [corner, corners.at(k - 1)]).filter(([from, to]) => at(from) && at(to)).map(([from, to]) => {
      const slope = (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI;
      return { on: { at: `${body.name}.${at(from)}`, ...(slope ? { slope: { degrees: Number(slope.toPrecision(15)) } } : {}) }, ends: norm(sub(to, from)) };
    });
  });
  return [...edges, ...ground];
}

/** Every face over or under a body, with the body moved onto it along its normal: `{at, angle, on, turned, gap, depth}`. */
function landings(model, value, waiting, body, at) {
  const outline = outlineOf(body, model.numbers), found = [];
  for (const { on, ends } of faces(model, value, waiting, body.name)) {
    const { point, along, normal, radius, curvature, curve } = model.face(on);
    if (radius !== null || curvature !== null || curve) continue;
    const slope = Math.atan2(along[1], along[0]), s = dot(sub(at, point), along);
    if (ends !== null && (s < 0 || s > ends)) continue;
    const angle = outline?.corners ? slope + Math.round((body.angle - slope) / (Math.PI / 2)) * (Math.PI / 2) : body.angle;
    const rim = outline?.radius ?? 0;
    const lowest = Math.min(...touchingPoints(outline).map((p) => dot(turned(angle, p), normal))) - rim;
    const gap = dot(sub(at, point), normal) + lowest;
    found.push({ at: add(at, normal, -gap), angle, on, turned: Math.abs(angle - body.angle) > 1e-12, gap, depth: 2 * lowest });
  }
  return found;
}

/**
 * A body moved so that it stands on a face that is near: `{at, angle, on}`, or null. What has corners is turned so that its lower
 * side lies on the face; a rod touches with an end.
 */
export const ontoFace = (model, value, waiting, body, at, px) => landings(model, value, waiting, body, at).find(({ gap, depth }) => Math.abs(gap) < NEAR * px || (gap < 0 && gap > depth)) ?? null;

/** The same for the nearest face on whose free side it is, however far, unless it lies there and has a contact for it. */
export function setDown(model, value, waiting, body, at, px) {
  const met = new Set((value.connections || []).filter((c) => c.kind === "contact" && c.on && bodyOf(c.place, value.bodies) === body.name).map((c) => facePart(c.on)));
  const apart = landings(model, value, waiting, body, at).filter(({ gap, on }) => gap > (met.has(facePart(on)) ? 1e-3 : -1e-3) * px);
  return apart.sort((p, q) => p.gap - q.gap)[0] ?? null;
}

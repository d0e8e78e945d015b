// What an end of a connection holds when it is let go at a point of the picture.
import { distanceTo, drawingOf } from "./plane_drawing.js";
import { tidy } from "./scene_changes.js";
import { pointerTo } from "./scene_text.js";
import { gridStep, nearestPlace, toGrid } from "./snapping.js";
import { norm, sub, turned } from "./vectors.js";

/** The body whose drawing covers a point. */
export function bodyUnder(model, point, px, except = []) {
  const items = drawingOf(model, { px, trails: false, view: { low: point, high: point } }).filter(({ part }) => part?.startsWith("body:"));
  const under = items.filter((item) => distanceTo(item, point) <= 4 * px && !except.includes(item.part.slice("body:".length))).at(-1);
  return under ? model.byName[under.part.slice("body:".length)] : null;
}

/**
 * The reference for an end at a point: a place that is near, the rim of a drum for a string, a new place of a body there, or a
 * point of the ground: `{scene, reference, point, body}`. The scene has the new place, if there is one.
 */
export function attached(scene, model, point, { px, string = false, whole = false, except = [] }) {
  const place = nearestPlace(model, point, px, except), body = place?.body ? model.byName[place.body] : bodyUnder(model, point, px, except);
  if (whole) return body ? { scene, reference: body.name, point: body.at, body } : null;
  if (body?.radius && string) {
    // Near its centre it is held there, elsewhere it is wound on.
    if (norm(sub(point, body.at)) > 0.6 * body.radius) return { scene, reference: body.name, point: body.at, body };
    return { scene, reference: `${body.name}.centre`, point: body.at, body };
  }
  if (place) return { scene, reference: place.reference, point: place.point, body };
  if (body?.rigid) {
    const own = turned(-body.angle, sub(point, body.at)), step = gridStep(px) / 2;
    const at = own.map((x) => toGrid(x, step)), taken = Object.keys(body.places);
    const name = [..."abcdefghijklmnopqrstuvwxyz"].find((letter) => !taken.includes(letter)) ?? `p${taken.length + 1}`;
    return { scene: scene.with(pointerTo("bodies", body.name, "places", name), at.map(tidy)), reference: `${body.name}.${name}`, point, body };
  }
  if (body) return { scene, reference: body.name, point: body.at, body };
  const step = gridStep(px), ground = point.map((x) => toGrid(x, step));
  return { scene, reference: ground, point: ground, body: null };
}

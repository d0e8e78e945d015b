// The outline of a body of the plane, in its own axes: what its shape, radius or places say of it.
import { dot, norm, sub } from "./vectors.js";

/** Corners around points of the plane, counter-clockwise; those on an edge are left out (Andrew's monotone chain). */
export function hullOf(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const turn = (o, p, q) => (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
  const half = (list) => list.reduce((chain, p) => {
    while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), p) <= 0) chain.pop();
    return [...chain, p];
  }, []).slice(0, -1);
  return [...half(sorted), ...half(sorted.reverse())];
}

const rectangle = (width, height) => [[-width / 2, -height / 2], [width / 2, -height / 2], [width / 2, height / 2], [-width / 2, height / 2]];

/** What a `shape` looks like, as `{radius}`, `{corners}` or `{bar, thickness}`; `n` reads its numbers. */
function ofShape(shape, n) {
  const at = n.vector(shape.at) || [0, 0], moved = (points) => points.map(([x, y]) => [x + at[0], y + at[1]]);
  const read = (name) => n.number(shape[name]);
  if (shape.kind === "box") return { corners: moved(rectangle(read("width"), read("height"))) };
  if (shape.kind === "polygon") return { corners: moved((shape.corners || []).map((c) => n.vector(c) || [0, 0])) };
  if (shape.kind === "capsule") return { bar: moved([[-read("length") / 2, 0], [read("length") / 2, 0]]), thickness: 2 * read("radius") };
  return { radius: read("radius") };
}

/**
 * The outline of a body: `{radius}` of a disc, `{corners}` of a solid, `{bar}` from end to end, or null for a point.
 * Two places at the same distance from the centre, not on one line with it, are the foot of a block about that centre.
 */
export function outlineOf(body, n) {
  if (body.shape?.kind) return ofShape(body.shape, n);
  if (body.radius) return { radius: body.radius };
  if (body.plank !== null && body.plank !== undefined && !Object.keys(body.places).length) return plank(body);
  const places = Object.values(body.places).filter((p) => norm(p) > 0);
  const size = Math.max(0, ...places.map(norm));
  if (places.length >= 3) {
    const corners = hullOf(places);
    if (corners.length >= 3) return { corners };
  }
  if (places.length === 2) {
    const [p, q] = places, across = p[0] * q[1] - p[1] * q[0];
    if (Math.abs(norm(p) - norm(q)) < 1e-9 * size && Math.abs(across) > 1e-9 * size * size) return { corners: hullOf([p, q, p.map((x) => -x), q.map((x) => -x)]) };
    // Both on one side of the centre, or on one line with it.
    return Math.abs(across) <= 1e-9 * size * size ? { bar: ends([...places, [0, 0]]) } : { spokes: places };
  }
  if (places.length === 1) return { bar: [[0, 0], places[0]] };
  return places.length > 2 ? { bar: ends(places) } : null;
}

/** A homogeneous rod with the moment of inertia of the body, along its face. */
function plank({ mass, inertia, plank: slope }) {
  const half = Math.sqrt((12 * inertia) / mass) / 2, end = [half * Math.cos(slope), half * Math.sin(slope)];
  return { bar: [end.map((x) => -x), end] };
}

/** The two points that are farthest apart. */
function ends(points) {
  let best = [points[0], points[0]];
  for (const p of points) for (const q of points) if (norm(sub(p, q)) > norm(sub(...best))) best = [q, p];
  return best;
}

/** Moment of inertia of the homogeneous body of a mass about its centre (kg m²); null where the outline has no area or length. */
export function homogeneousInertia(mass, outline) {
  if (!outline) return null;
  if (outline.radius) return (mass * outline.radius ** 2) / 2;
  if (outline.bar) {
    // About the centre of mass, from which the ends are measured.
    const [p, q] = outline.bar;
    return (mass * (dot(p, p) + dot(p, q) + dot(q, q))) / 3;
  }
  if (!outline.corners) return null;
  let area = 0, second = 0;
  outline.corners.forEach((p, i) => {
    const q = outline.corners[(i + 1) % outline.corners.length], cross = p[0] * q[1] - p[1] * q[0];
    area += cross / 2;
    second += (cross * (dot(p, p) + dot(p, q) + dot(q, q))) / 12;
  });
  return (mass * second) / area;
}

/** Points of an outline that can touch a face, by corner or end. */
export const touchingPoints = (outline) => outline?.corners ?? outline?.bar ?? [[0, 0]];

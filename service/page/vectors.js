// Vectors of two or three components.
export const add = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
export const sub = (a, b) => a.map((x, i) => x - b[i]);
export const scaled = (a, factor) => a.map((x) => x * factor);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const norm = (a) => Math.hypot(...a);
export const unit = (a) => scaled(a, 1 / (norm(a) || 1));
/**
 * A quarter turn counter-clockwise, in the plane.
 * @type {(vector: number[]) => number[]}
 */
export const quarter = ([x, y]) => [-y, x];
/** @type {(angle: number, vector: number[]) => number[]} */
export const turned = (angle, [x, y]) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
/** A vector turned by a unit quaternion [w, x, y, z]. */
export function rotated([w, x, y, z], v) {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
}
/** The shortest turn from one unit vector to another, as a quaternion. */
export function turnBetween(a, b) {
  const w = 1 + dot(a, b);
  if (w < 1e-9) return Math.abs(a[0]) < 0.9 ? [0, 1, 0, 0] : [0, 0, 1, 0];
  const c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const n = Math.hypot(w, ...c);
  return [w / n, c[0] / n, c[1] / n, c[2] / n];
}

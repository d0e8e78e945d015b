// What every kind of connection looks like in the plane: faces below the bodies, links between them, joints above them.
import { add, dot, norm, quarter, scaled, sub, turned, unit } from "./vectors.js";

const HATCH = 14, TEETH = 24;
/** Pixels between the strokes of a hatching; teeth of a gear. */

/** The face, curve or axis on which something slides or rolls. */
export function drawGround(d, model, c) {
  if (c.kind === "slider") {
    const at = model.place(c.b ?? [0, 0]), { tangent } = model.touching(c);
    return at.body ? d.line(reach(at.point, tangent, 60 * d.px), "soft", 2) : d.line(reach(at.point, tangent, lengthOfView(d)), "soft", 1.5, [8, 5]);
  }
  if (c.kind === "spinning-frame" && c.about !== "normal") {
    const x = model.numbers.vector(c.at)?.[0] || 0, y = (d.view.low[1] + d.view.high[1]) / 2;
    return d.line(reach([x, y], [0, 1], lengthOfView(d)), "soft", 1.5, [8, 6]);
  }
  if (!c.on || typeof c.on !== "object" || Array.isArray(c.on)) return;
  drawFace(d, model, model.face(c.on), c);
}

const lengthOfView = ({ view }) => norm(sub(view.high, view.low));
const reach = (point, along, length) => [add(point, along, -length), add(point, along, length)];

/** A face of the ground, or of a body; `c` is a connection on it, if there is one yet. */
export function drawFace(d, model, face, c) {
  if (face.curve) return d.line(face.curve, "soft", 2);
  if (face.radius === 0) return d.dot(face.point, 4, "soft", null);
  if (face.radius !== null) {
    d.disc(face.point, Math.abs(face.radius), null, "soft", 2);
    return;
  }
  if (face.curvature !== null) {
    const size = lengthOfView(d) / 2;
    const points = [...Array(81).keys()].map((i) => (i / 40 - 1) * size).map((s) => add(add(face.point, face.along, s), face.normal, (face.curvature * s * s) / 2));
    return d.line(points, "soft", 2);
  }
  if (face.body && c) return ofBody(d, model, face, c);
  const middle = add(face.point, face.along, dot(sub(scaled(add(d.view.low, d.view.high), 0.5), face.point), face.along));
  const length = lengthOfView(d), step = HATCH * d.px, down = scaled(add(quarter(face.along), face.along), -0.5 * step);
  // Strokes stand still while the middle of the view moves.
  const first = Math.floor((dot(sub(middle, face.point), face.along) - length) / step);
  d.line(reach(middle, face.along, length), "soft", 2);
  for (let k = first; k <= first + (2 * length) / step; k++) {
    const p = add(face.point, face.along, k * step);
    d.line([p, add(p, down)], "soft", 0.8);
  }
}

/** A face of a body without an outline: a wedge below it, as far as something moves on it; faces of one wedge have one foot. */
function ofBody(d, model, { point, along, body }, c) {
  if (model.hasOutline(body)) return;
  const end = (other) => { const face = model.face(other.on); return add(face.point, face.along, 1.15 * model.farthestOn(other) || 80 * d.px); };
  if (Math.abs(along[1]) < 0.05) {
    if (!model.carriesBlock(body)) d.line(reach(point, along, Math.max(60 * d.px, 1.15 * Math.abs(model.farthestOn(c)))), "ink", 4);
    return;
  }
  const others = model.connections.filter((o) => o.on?.at === c.on.at && o.on.radius === undefined);
  const far = end(c), low = Math.min(point[1], ...others.map((o) => end(o)[1]));
  d.outline([point, far, [far[0], low], [point[0], low]], "faceThree", "ink", 1.5, { fillAlpha: 0.45 });
}

/** What joins two places. */
export function drawConnection(d, model, c) {
  LINKS[c.kind]?.(d, model, c, (reference) => model.place(reference).point);
}

const LINKS = {
  rod: (d, model, c, at) => d.line([at(c.a), at(c.b ?? [0, 0])], "ink", 4),
  string,
  chain: string,
  spring: (d, model, c, at) => coil(d, at(c.a), at(c.b ?? [0, 0])),
  damper: (d, model, c, at) => { if (c.measure !== "turn") dashpot(d, at(c.a), at(c.b ?? [0, 0])); },
  "torsion-spring": (d, model, c, at) => d.line([...Array(60).keys()].map((i) => add(at(c.a), turned((i / 60) * 5 * Math.PI, [(22 * d.px * i) / 60, 0]))), "stable", 2),
  motor: (d, model, c, at) => turning(d, at(c.a), model.numbers.number(c.rate ?? 1) || 1),
  torque: (d, model, c, at) => turning(d, at(c.body), model.numbers.number(c.torque ?? 1) || 1),
  relation: gears,
  rolling: (d, model, c) => contactMark(d, model, c),
};

function string(d, model, c) {
  const { parts, arcs } = model.stringOf(c), slack = model.isSlack(c);
  const lanes = parts.map((part, i) => parts.slice(0, i).filter((other) => overlap(part, other)).length);
  parts.forEach((part, i) => {
    // Parts that run side by side, as in a tackle, are drawn beside each other.
    const aside = lanes[i] ? scaled(quarter(unit(sub(part[1], part[0]))), 7 * lanes[i] * d.px) : [0, 0];
    const heavy = c.kind === "chain";
    if (slack) d.line(sagging(part, d), "warm", 1.5, [3, 4]);
    else d.line(part.map((p) => add(p, aside)), "warm", heavy ? 5 : 2, heavy ? [3, 6] : []);
  });
  for (const { center, radius, from, to, sense } of arcs) {
    const start = Math.atan2(from[1] - center[1], from[0] - center[0]);
    let sweep = Math.atan2(to[1] - center[1], to[0] - center[0]) - start;
    while (sense * sweep < 0) sweep += sense * 2 * Math.PI;
    d.line([...Array(25).keys()].map((i) => add(center, turned(start + (sweep * i) / 24, [radius, 0]))), "warm", 2);
  }
  for (const peg of c.through.slice(1, -1)) if (typeof peg !== "string") d.dot(model.place(peg).point, 5, "panel", "soft", 2.5);
}

/** Whether two straight parts share more than a point. */
function overlap([a, b], [p, q]) {
  const along = unit(sub(b, a)), near = 1e-9 * (norm(sub(b, a)) + norm(sub(q, p)));
  if ([p, q].some((point) => Math.abs(dot(quarter(along), sub(point, a))) > near)) return false;
  const [from, to] = [dot(sub(p, a), along), dot(sub(q, a), along)].sort((x, y) => x - y);
  return Math.min(to, norm(sub(b, a))) - Math.max(from, 0) > near;
}

/** A slack part hangs through. */
function sagging([a, b], d) {
  const sag = Math.max(10 * d.px, 0.12 * norm(sub(b, a)));
  return [...Array(17).keys()].map((i) => i / 16).map((s) => add(add(a, sub(b, a), s), [0, -4 * sag * s * (1 - s)]));
}

function coil(d, a, b) {
  const v = sub(b, a), side = scaled(quarter(unit(v)), 9 * d.px);
  d.line([a, ...[...Array(17).keys()].map((i) => add(add(a, v, 0.12 + (0.76 * i) / 16), side, i === 0 || i === 16 ? 0 : i % 2 ? 1 : -1)), b], "stable", 2);
}

function dashpot(d, a, b) {
  const v = sub(b, a), side = scaled(quarter(unit(v)), 8 * d.px), p = add(a, v, 0.4), q = add(a, v, 0.65);
  d.line([a, p], "soft", 2);
  d.line([add(q, side), add(p, side), sub(p, side), sub(q, side)], "soft", 2);
  d.line([add(add(a, v, 0.55), side, 0.8), add(add(a, v, 0.55), side, -0.8)], "soft", 2);
  d.line([add(a, v, 0.55), b], "soft", 2);
}

/** An arrow around an axis, in the sense in which it turns. */
function turning(d, at, sign) {
  const sense = Math.sign(sign), points = [...Array(24).keys()].map((i) => add(at, turned(sense * (0.4 + (i / 23) * 4.6), [26 * d.px, 0])));
  d.line(points, "deep", 2.5);
  d.arrow(points[21], points[23], "deep");
}

/** Teeth on the rims of the wheels whose angles a relation ties. */
function gears(d, model, c) {
  for (const name of new Set(String(c.of).match(/[\w-]+(?=\.angle)/g) || [])) {
    const body = model.byName[name];
    if (!body?.radius) continue;
    const r = body.radius, tooth = Math.min(0.12 * r, 8 * d.px);
    const points = [...Array(4 * TEETH + 1).keys()].map((k) => add(body.at, turned(body.angle + (k / (4 * TEETH)) * 2 * Math.PI, [r + (k % 4 < 2 ? tooth : -tooth) / 2, 0])));
    d.line(points, "ink", 1.5);
  }
}

function contactMark(d, model, c) {
  d.dot(model.touching(c).at, 3, "soft", null);
}

/** What is seen above the bodies: pins, sliders, fixed ends. */
export function drawJoint(d, model, c) {
  const at = (reference) => model.place(reference).point, fixed = (reference) => Array.isArray(reference) || (reference && typeof reference === "object");
  if (c.kind === "pin" || c.kind === "weld") {
    const point = at(c.a), s = 13 * d.px;
    const small = model.place(c.a).body?.radius && model.place(c.a).body.radius < 2 * s;
    if (fixed(c.b ?? [0, 0]) && !small) d.outline([point, add(point, [-s, -1.5 * s]), add(point, [s, -1.5 * s])], "panel", "soft", 2);
    return c.kind === "weld" ? d.outline([[-1, -1], [1, -1], [1, 1], [-1, 1]].map((k) => add(point, k, 4 * d.px)), "ink", null) : d.dot(point, 4.5, "panel", "ink", 2);
  }
  if (c.kind === "slider") {
    const { tangent, normal } = model.touching(c), point = at(c.a), box = ([x, y]) => add(add(point, tangent, x * d.px), normal, y * d.px);
    // The block between guides that rub has its size.
    const [half, wide] = [model.numbers.number(c.length ?? 0) / 2 / d.px, model.numbers.number(c.width ?? 0) / 2 / d.px];
    if (half > 0 && wide > 0) d.outline([[-half, -wide], [half, -wide], [half, wide], [-half, wide]].map(box), "face", "ink", 1.5, { fillAlpha: 0.4 });
    return d.outline([[-13, -7], [13, -7], [13, 7], [-13, 7]].map(box), null, "soft", 2);
  }
  if (c.kind === "contact" && Array.isArray(c.place) && c.on) {
    // A point of the ground that holds a body up is the top of a support.
    const { tangent, normal } = model.touching(c), point = at(c.place), corner = (side) => add(add(point, normal, 26 * d.px), tangent, side * 14 * d.px);
    return d.outline([point, corner(-1), corner(1)], "line", "soft", 1.5);
  }
  if (c.kind === "force") return;
  for (const reference of [c.a, c.b, ...(c.through ? [c.through[0], c.through.at(-1)] : [])]) {
    if (fixed(reference)) d.dot(at(reference), 4, "panel", "soft", 2);
  }
}

// A scene of the plane as a list of lines, discs, outlines, arrows and words, each with the part of the scene that it shows.
import { drawConnection, drawGround, drawJoint } from "./plane_kinds.js";
import { outlineOf } from "./outlines.js";
import { add, norm, turned } from "./vectors.js";

/** Collects what is drawn; lengths are in metres, or in pixels where a name says so. `px` is the length of a pixel (m). */
export class Drawing {
  constructor(px, view) {
    this.px = px;
    this.view = view;
    /** @type {any[]} */
    this.items = [];
    /** @type {string | null} */
    this.part = null;
    this.alpha = 1;
  }

  push(item) {
    this.items.push({ part: this.part, alpha: this.alpha, ...item });
  }

  line(points, ink, width = 2, dash = []) {
    if (points.length > 1) this.push({ shape: "line", points, ink, width, dash });
  }

  outline(corners, fill, stroke = "ink", width = 1.5, more = {}) {
    this.push({ shape: "outline", points: corners, fill, stroke, width, ...more });
  }

  disc(center, radius, fill, stroke = "ink", width = 1.5, more = {}) {
    this.push({ shape: "disc", center, radius, fill, stroke, width, ...more });
  }

  dot(center, pixels, fill, stroke = "ink", width = 1.5) {
    this.disc(center, pixels * this.px, fill, stroke, width);
  }

  arrow(from, to, ink, words = "") {
    this.push({ shape: "arrow", from, to, ink });
    if (words) this.words(add(to, [6 * this.px, 6 * this.px]), words, ink);
  }

  words(at, text, ink = "soft") {
    this.push({ shape: "words", at, text, ink });
  }

  /** Draw with another part as the one that is shown. */
  of(part, draw) {
    const before = this.part;
    this.part = part;
    draw();
    this.part = before;
  }
}

export const bodyPart = (name) => `body:${name}`;
export const connectionPart = (label) => `connection:${label}`;

/**
 * Everything that is seen of `model` at its present time. `look` says what is shown beside bodies and connections: `forces`,
 * `velocities`, `accelerations`, `trails`, `ghosts` (how many), `values`, `names`; `px` and the corners of what is in view.
 */
export function drawingOf(model, look) {
  const d = new Drawing(look.px, look.view);
  const acting = model.connections.filter((c) => model.acts(c));
  if (look.trails !== false) trails(d, model);
  for (const c of acting) d.of(connectionPart(c.label), () => drawGround(d, model, c));
  if (look.ghosts) ghosts(d, model, look.ghosts);
  for (const c of acting) d.of(connectionPart(c.label), () => drawConnection(d, model, c));
  for (const body of model.bodies) d.of(bodyPart(body.name), () => drawBody(d, model, body));
  for (const c of acting) d.of(connectionPart(c.label), () => drawJoint(d, model, c));
  if (look.names) for (const body of model.bodies) d.words(add(body.at, [10 * d.px, 12 * d.px]), body.name, "ink");
  if (look.forces) arrows(d, model.arrows(), model.forceScale, "warm", look.values && "N");
  if (look.velocities) arrows(d, model.rates("velocity"), model.largestRate("velocity"), "deep", look.values && "m/s");
  if (look.accelerations) arrows(d, model.rates("acceleration"), model.largestRate("acceleration"), "third", look.values && "m/s²");
  return d.items;
}

function trails(d, model) {
  for (const body of model.bodies) {
    const path = model.column(`${body.name}.position`);
    if (!path) continue;
    d.line(path, "line", 1);
    d.line(path.slice(0, model.index + 1), "soft", 1.5);
  }
}

/** The bodies at equal times from the start to the end, pale. */
function ghosts(d, model, count) {
  const { now } = model, last = model.time.at(-1);
  d.alpha = 0.22;
  for (let k = 0; k <= count; k++) {
    model.seek((k / count) * last);
    for (const body of model.bodies) drawBody(d, model, body);
  }
  model.seek(now);
  d.alpha = 1;
}

const LONGEST_ARROW = 130;
/** Pixels of the largest vector of a kind. */

function arrows(d, list, largest, ink, unit) {
  if (!(largest > 0)) return;
  const factor = (LONGEST_ARROW * d.px) / largest;
  for (const { at, vector, label } of list) {
    if (norm(vector) * factor < 4 * d.px) continue;
    d.arrow(at, add(at, vector, factor), ink, unit ? `${label} ${Number(norm(vector).toPrecision(3))} ${unit}` : "");
  }
}

const SMALLEST = 6;
/** Pixels of the radius of a disc at least: smaller ones would not be seen. */

/** How large a point of a mass is drawn (pixels). */
const pointSize = (model, body) => (body.mass ? 5 + 6 * Math.cbrt(body.mass / model.heaviest()) : 3.5);

function drawBody(d, model, body) {
  const { at, angle } = body, out = (p) => add(at, turned(angle, p));
  const outline = outlineOf(body, model.numbers), places = Object.values(body.places).map(out);
  const lift = model.liftOf(body);
  if (lift?.round) return d.dot(add(at, lift.normal, pointSize(model, body) * d.px), pointSize(model, body), "deep");
  if (lift) return block(d, at, lift);
  if (outline?.radius) {
    const radius = Math.max(outline.radius, SMALLEST * d.px);
    d.disc(at, radius, "face", "ink", 2, { fillAlpha: 0.5 });
    d.line([at, out([radius, 0])], "ink", 2);
    for (const p of places) d.line([at, p], "ink", 1.5);
  } else if (outline?.corners) {
    d.outline(outline.corners.map(out), "face", "ink", 2, { fillAlpha: 0.6 });
    d.dot(at, 3, "ink", null);
  } else if (outline?.bar) {
    d.line(outline.bar.map(out), "face", outline.thickness ? outline.thickness / d.px : 8);
    d.dot(at, body.mass ? 4 : 2.5, "ink", null);
  } else if (outline?.spokes) {
    for (const p of outline.spokes) d.line([at, out(p)], "face", 7);
    d.dot(at, 4, "ink", null);
  } else if (body.rigid && body.mass) {
    const h = 14 * d.px;
    d.outline([[-h, -h / 1.6], [h, -h / 1.6], [h, h / 1.6], [-h, h / 1.6]].map(out), "face", "ink", 1.5);
  } else d.dot(at, pointSize(model, body), body.mass ? "deep" : "panel");
}

/** A point that slides on a face is a block that stands on it; one that carries it, below. */
function block(d, at, { along, normal, level, middle }) {
  const s = 26 * d.px, foot = add(at, normal, (middle ? -0.5 : level) * s);
  const corner = (x, y) => add(add(foot, along, x * s), normal, y * s);
  const half = 0.75 + 0.35 * (level === 0 ? 1 : 0);
  d.outline([corner(-half, 0), corner(half, 0), corner(half, 1), corner(-half, 1)], "face", "ink", 1.5, { fillAlpha: 0.75 });
  d.dot(at, 2.5, "ink", null);
}

/** The corners of everything in a drawing. */
export function extentOf(items) {
  const points = items.flatMap(({ shape, points: list, center, radius, from, to, at }) => {
    if (shape === "disc") return [add(center, [-radius, -radius]), add(center, [radius, radius])];
    return list ?? (from ? [from, to] : [at]);
  });
  return { low: [0, 1].map((k) => Math.min(...points.map((p) => p[k]))), high: [0, 1].map((k) => Math.max(...points.map((p) => p[k]))) };
}

/** Distance of a point from what an item shows (m); 0 inside. */
export function distanceTo(item, point) {
  if (item.shape === "disc") {
    const off = norm([point[0] - item.center[0], point[1] - item.center[1]]) - item.radius;
    return item.fill ? Math.max(0, off) : Math.abs(off);
  }
  if (item.shape === "words") return Infinity;
  const list = item.points ?? [item.from, item.to], closed = item.shape === "outline" ? [...list, list[0]] : list;
  if (item.shape === "outline" && inside(list, point)) return 0;
  let best = Infinity;
  for (let i = 0; i + 1 < closed.length; i++) best = Math.min(best, distanceToSegment(point, closed[i], closed[i + 1]));
  return best;
}

function distanceToSegment(p, a, b) {
  const d = [b[0] - a[0], b[1] - a[1]], w = [p[0] - a[0], p[1] - a[1]], length = d[0] ** 2 + d[1] ** 2;
  const s = length ? Math.max(0, Math.min(1, (w[0] * d[0] + w[1] * d[1]) / length)) : 0;
  return norm([w[0] - s * d[0], w[1] - s * d[1]]);
}

/** Whether a point lies in an outline (crossings of a ray). */
function inside(corners, [x, y]) {
  let odd = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    if (ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay)) odd = !odd;
  });
  return odd;
}


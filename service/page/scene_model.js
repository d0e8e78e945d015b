// A described scene at any time of its answer: places of bodies, and what is to be drawn of every connection.
import { Numbers } from "./formula.js";
import { outlineOf } from "./outlines.js";
import { stringPath } from "./string_path.js";
import { add, dot, norm, quarter, rotated, scaled, sub, turnBetween, turned, unit } from "./vectors.js";

export class SceneModel {
  /** `description` as sent; `trajectory` and `events` as answered, null for a scene without motion. */
  constructor(description, trajectory, events = []) {
    this.answered = trajectory !== null;
    this.changes = events.filter(({ kind }) => kind === "begin" || kind === "end");
    this.numbers = new Numbers(description.let);
    this.description = description;
    this.columns = trajectory?.columns || {};
    this.time = trajectory?.time || [0];
    this.bodies = Object.entries(description.bodies || {}).map(([name, body]) => this.readBody(name, body));
    this.space = this.bodies[0]?.start.length === 3;
    this.connections = (description.connections || []).map((connection, i) => ({ ...connection, label: connection.name || `${connection.kind}-${i + 1}` }));
    this.reaches = new Map();
    this.lifts = new Map();
    /** @type {number | undefined} */
    this.sizeOnce = undefined;
    this.seek(0);
    this.strings = this.connections.filter((c) => ["string", "chain"].includes(c.kind)).map((c) => [c, stringPath(this, c)]);
    this.forceScale = this.largestForce();
  }

  readBody(name, body) {
    const n = this.numbers, start = n.vector(body.at) || [0, 0];
    const moments = n.vector(body.moments), shape = body.shape && typeof body.shape === "object" ? body.shape : null;
    return {
      name, start, moments, shape, mass: n.number(body.mass ?? 0) || 0,
      radius: body.radius !== undefined ? n.number(body.radius) : shape?.radius !== undefined && shape.kind !== "capsule" ? n.number(shape.radius) : null,
      rigid: shape !== null || body.inertia !== undefined || body.moments !== undefined || body.tensor !== undefined || body.body !== undefined,
      inertia: n.number(body.inertia ?? 0) || 0, plank: this.plankSlope(name, body),
      angle0: n.number(body.angle ?? 0) || 0,
      axes: Array.isArray(body.axes) ? body.axes.map((row) => n.vector(row)) : null,
      places: Object.fromEntries(Object.entries(body.places || {}).map(([place, at]) => [place, n.vector(at)])),
    };
  }

  /** The slope of a straight face through the centre of a body without an outline, which then is a plank or a rod; null if there is none. */
  plankSlope(name, body) {
    const slopeOf = (slope) => this.numbers.number(slope ?? 0) || 0, connections = this.description.connections || [];
    const c = connections.find(({ on }) => on && on.at === name && ["radius", "curvature", "curve", "normal", "direction"].every((k) => on[k] === undefined));
    if (!c || !(this.numbers.number(body.inertia ?? 0) > 0) || !(this.numbers.number(body.mass) > 0)) return null;
    const rail = connections.find(({ kind, a }) => kind === "slider" && a === name);
    // What slides on a rail of another slope is a wedge.
    return rail && Math.abs(Math.sin(slopeOf(rail.slope) - slopeOf(c.on.slope))) > 1e-9 ? null : slopeOf(c.on.slope);
  }

  heaviest() {
    return Math.max(...this.bodies.map((body) => body.mass)) || 1;
  }

  hasOutline(body) {
    return outlineOf(body, this.numbers) !== null;
  }

  /**
   * How a point stands on a straight face: `{along, normal, level, round, middle}`, level being how many blocks lie below. What comes
   * through the air is `round`; what is guided, as in a mechanism, has its `middle` on the face. Null if it stands on none.
   */
  liftOf(body) {
    if (this.space || this.hasOutline(body) || body.rigid || !body.mass) return null;
    const c = this.standing(body.name);
    if (!c) return null;
    const { along, normal, body: below } = this.face(c.on);
    const under = below && this.liftOf(below), linked = this.connections.some(({ kind, a, b }) => kind === "rod" && (a === body.name || b === body.name));
    return { along, normal, level: under ? under.level + 1 : 0, round: c.kind === "contact" && this.startGap(c) > 1e-6 * this.size(), middle: c.kind === "track" && linked };
  }

  /** How far a place is from a straight face at the start. */
  startGap(c) {
    const { now } = this;
    this.seek(0);
    const { point, normal } = this.face(c.on), gap = dot(sub(this.place(c.place).point, point), normal);
    this.seek(now);
    return gap;
  }

  size() {
    this.sizeOnce ??= this.bounds().size;
    return this.sizeOnce;
  }

  /** The connection by which a point stands on a straight face. */
  standing(name) {
    if (!this.lifts.has(name)) this.lifts.set(name, this.connections.find((c) => ["contact", "track"].includes(c.kind) && c.place === name && c.on && typeof c.on === "object" && ["radius", "curvature", "curve"].every((k) => c.on[k] === undefined)) ?? null);
    return this.lifts.get(name);
  }

  /** Whether a point that stands on a face itself carries another. */
  carriesBlock(body) {
    return this.liftOf(body) !== null;
  }

  /** Velocities or accelerations of the bodies now: `{at, vector, label}`. */
  rates(what) {
    return this.bodies.map((body) => ({ at: body.at, vector: this.rate(body, what), label: body.name })).filter((a) => a.vector);
  }

  rate(body, what) {
    const velocity = this.column(`${body.name}.velocity`);
    if (!velocity) return null;
    if (what === "velocity") return this.value(`${body.name}.velocity`);
    // Of samples the slope between two neighbours.
    const i = Math.min(this.index, velocity.length - 2), step = this.time[i + 1] - this.time[i];
    return step > 0 && velocity[i] && velocity[i + 1] ? velocity[i + 1].map((x, k) => (x - velocity[i][k]) / step) : null;
  }

  /** The largest of them in the whole motion. */
  largestRate(what) {
    const { now } = this;
    let largest = 0;
    for (let k = 0; k <= 60; k++) {
      this.seek((k / 60) * this.time.at(-1));
      for (const { vector } of this.rates(what)) largest = Math.max(largest, norm(vector));
    }
    this.seek(now);
    return largest;
  }

  column(name) {
    return this.columns[name]?.values;
  }

  /** Value of a column at the present time; null if there is none. */
  value(name) {
    const values = this.column(name);
    if (!values) return null;
    const a = values[this.index], b = values[Math.min(this.index + 1, values.length - 1)];
    if (a === null || b === null) return a;
    return typeof a === "number" ? a + this.part * (b - a) : a.map((x, i) => x + this.part * (b[i] - x));
  }

  /** How far along the face of a body what is on it comes from the point of the face, with its sign. */
  farthestOn(connection) {
    if (!this.reaches.has(connection)) {
      const { now } = this;
      let far = 0;
      for (let k = 0; k <= 40; k++) {
        this.seek((k / 40) * this.time.at(-1));
        const { point, along } = this.face(connection.on);
        const s = dot(sub(this.place(connection.place).point, point), along);
        if (Math.abs(s) > Math.abs(far)) far = s;
      }
      this.reaches.set(connection, far);
      this.seek(now);
    }
    return this.reaches.get(connection);
  }

  /** Whether a connection acts now, between its beginning and its end; without an answer all are shown. */
  acts(c) {
    if (!this.answered) return true;
    const last = this.changes.filter(({ name, time }) => name === c.label && time <= this.now).at(-1);
    return last ? last.kind === "begin" : c.from === undefined;
  }

  /** Put the scene to a time. */
  seek(time) {
    this.now = time;
    const last = this.time.length - 1;
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.time[middle] <= time) low = middle; else high = middle;
    }
    this.index = low;
    this.part = last ? Math.max(0, Math.min(1, (time - this.time[low]) / (this.time[high] - this.time[low] || 1))) : 0;
    for (const body of this.bodies) {
      body.at = this.value(`${body.name}.position`) || body.start;
      body.angle = this.value(`${body.name}.angle`) ?? body.angle0;
      if (this.space) body.attitude = this.attitudeOf(body);
    }
    this.byName = Object.fromEntries(this.bodies.map((body) => [body.name, body]));
  }

  attitudeOf(body) {
    const attitude = this.value(`${body.name}.attitude`);
    if (attitude) return unit(attitude);
    const axis = this.value(`${body.name}.axis`) || body.axes?.[symmetryAxis(body.moments)];
    const own = [0, 0, 0];
    own[symmetryAxis(body.moments)] = 1;
    return axis ? turnBetween(own, unit(axis)) : [1, 0, 0, 0];
  }

  /** A vector of a body's axes in the axes of the scene. */
  outward(body, vector) {
    return this.space ? rotated(body.attitude, vector) : turned(body.angle, vector);
  }

  /** Where a place is now, and the body that it belongs to: `{point, body}`. */
  place(reference) {
    if (typeof reference !== "string") {
      // A support that moves is a formula of the time.
      const point = this.numbers.vector(reference, { t: this.now ?? 0 });
      return { point: point || (this.space ? [0, 0, 0] : [0, 0]), body: null };
    }
    const dotAt = reference.lastIndexOf(".");
    const body = this.byName[reference] || this.byName[reference.slice(0, dotAt)];
    if (!body) return { point: this.space ? [0, 0, 0] : [0, 0], body: null };
    const place = body.places[reference.slice(dotAt + 1)];
    return { point: place && reference !== body.name ? add(body.at, this.outward(body, place)) : body.at, body };
  }

  /** The face, curve or surface of `on`: its point, its directions and its shape. */
  face(on) {
    const n = this.numbers, { point, body } = this.place(on.at ?? [0, 0]);
    const angle = n.number(on.slope ?? 0) || 0;
    const outward = (v) => (body ? this.outward(body, v) : v);
    const along = this.space ? unit(outward(n.vector(on.direction) || [1, 0, 0])) : outward([Math.cos(angle), Math.sin(angle)]);
    const normal = this.space ? unit(outward(n.vector(on.normal) || [0, 0, 1])) : quarter(along);
    const radius = on.radius === undefined ? null : n.number(on.radius);
    const curvature = on.curvature === undefined ? null : n.number(on.curvature);
    return { point, body, along, normal, radius, curvature, plane: this.space && on.normal !== undefined };
  }

  /** Forces to be drawn: `{at, vector, label}` in newtons. */
  arrows() {
    return this.connections.flatMap((connection) => this.arrowsOf(connection)).filter((a) => a && norm(a.vector) > 1e-12);
  }

  arrowsOf(c) {
    const value = (suffix) => this.value(`${c.label}.${suffix}`);
    const vector = ["x", "y", "z"].slice(0, this.space ? 3 : 2).map(value);
    const at = (reference) => this.place(reference).point;
    if (vector.every((x) => x !== null)) return [{ at: at(c.a ?? c.place), vector, label: c.label }];
    if (c.kind === "string" || c.kind === "chain") return this.tensions(c);
    if (c.measure === "turn") return [];
    if (["rod", "spring", "damper", "gravitation", "inverse-square"].includes(c.kind)) return this.pulls(at(c.a), at(c.b), value("force"), c);
    const normal = value("normal"), friction = value("friction");
    if (normal === null) return c.kind === "force" ? [{ at: at(c.place), vector: this.numbers.vector(c.force), label: c.label }] : [];
    const touching = this.touching(c);
    return [
      { at: touching.at, vector: scaled(touching.normal, normal), label: `${c.label}.normal` },
      friction === null ? null : { at: touching.at, vector: scaled(touching.tangent, friction), label: `${c.label}.friction` },
    ];
  }

  pulls(a, b, force, c) {
    if (force === null) return [];
    const along = scaled(unit(sub(b, a)), force);
    const free = (reference) => this.place(reference).body;
    return [free(c.a) && { at: a, vector: along, label: c.label }, free(c.b) && { at: b, vector: scaled(along, -1), label: c.label }];
  }

  /** The way of a string now. */
  stringOf(connection) {
    return this.strings.find(([other]) => other === connection)[1]();
  }

  /** Whether a string is slack now: nothing pulls in it. */
  isSlack(connection) {
    const tensions = [this.value(`${connection.label}.tension`), this.value(`${connection.label}.1.tension`)].filter((t) => t !== null);
    return tensions.length > 0 && tensions.every((t) => t === 0);
  }

  tensions(c) {
    return this.stringOf(c).ends.map(({ at, toward, body, run }, k) => {
      // A heavy chain pulls at its two ends, which are the first and the last.
      const tension = c.kind === "chain" ? this.value(`${c.label}.${k < 2 ? 1 : 2}.tension`) : this.value(`${c.label}.tension`) ?? this.value(`${c.label}.${run + 1}.tension`);
      return body && tension !== null ? { at, vector: scaled(unit(sub(toward, at)), tension), label: c.label } : null;
    });
  }

  /** Where a connection touches, with the directions of its normal force and friction on the first body. */
  touching(c) {
    if (c.on) {
      const { point, body } = this.place(c.place), face = this.face(c.on), rim = c.kind === "track" ? 0 : body?.radius || 0;
      if (face.radius === null) return { at: add(point, face.normal, -rim), normal: face.normal, tangent: face.along };
      let out = sub(point, face.point);
      // A tube in space: across its direction.
      if (this.space && c.on.direction) out = add(out, face.along, -dot(out, face.along));
      const normal = scaled(unit(out), Math.sign(rim + face.radius) || 1);
      return { at: add(point, normal, -rim), normal, tangent: this.space ? normal : quarter(normal) };
    }
    const a = this.place(c.a), b = this.place(c.b ?? [0, 0]);
    if (c.kind === "slider") {
      const angle = this.numbers.number(c.slope ?? 0) || 0, along = turned(b.body?.angle || 0, [Math.cos(angle), Math.sin(angle)]);
      return { at: a.point, normal: quarter(along), tangent: along };
    }
    const out = unit(sub(a.point, b.point)), normal = c.inside ? scaled(out, -1) : out;
    return { at: add(a.point, normal, -(a.body?.radius || 0)), normal, tangent: this.space ? normal : quarter(normal) };
  }

  largestForce() {
    let largest = 0;
    for (const [name, { unit: u, values }] of Object.entries(this.columns)) {
      if (u === "N" && !name.includes("energy")) for (const v of values) if (Number.isFinite(v)) largest = Math.max(largest, Math.abs(v));
    }
    return largest;
  }

  /** Corners of a box around everything that moves or stands. */
  bounds() {
    const points = [];
    for (const body of this.bodies) {
      const solid = body.moments && body.mass ? Math.sqrt((3 * Math.max(...body.moments)) / body.mass) : 0;
      const outline = this.space ? null : outlineOf(body, this.numbers);
      const semiAxes = this.numbers.vector(body.shape?.semi_axes) || [];
      const reach = Math.max(body.radius || 0, solid, ...semiAxes, ...(outline?.corners ?? outline?.bar ?? []).map(norm), ...Object.values(body.places).map((p) => norm(p)), 0);
      const path = this.column(`${body.name}.position`) || [body.start];
      for (let i = 0; i < path.length; i += Math.max(1, Math.floor(path.length / 100))) {
        points.push(path[i].map((x) => x - reach), path[i].map((x) => x + reach));
      }
    }
    for (const c of this.connections) {
      for (const reference of [c.a, c.b, c.at, c.on?.at, ...(c.through || [])]) {
        if (reference && typeof reference !== "string") points.push(this.place(reference).point);
      }
      if (c.on?.radius !== undefined) {
        const { point, radius } = this.face(c.on);
        points.push(point.map((x) => x - Math.abs(radius)), point.map((x) => x + Math.abs(radius)));
      }
    }
    const low = points[0].map((_, k) => Math.min(...points.map((p) => p[k])));
    const high = points[0].map((_, k) => Math.max(...points.map((p) => p[k])));
    return { low, high, size: Math.max(...high.map((x, k) => x - low[k]), 1e-9) };
  }
}

/** The axis about which a body with these moments is symmetric; the third if it is none. */
export function symmetryAxis(moments) {
  if (!moments) return 2;
  const [a, b, c] = moments;
  return a === b ? 2 : b === c ? 0 : a === c ? 1 : 2;
}

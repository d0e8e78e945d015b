// A described scene of the plane, drawn on a canvas.
import { color, onTheme, oncePerFrame } from "./dom.js";
import { add, norm, quarter, scaled, sub, turned, unit } from "./vectors.js";

export class PlaneView {
  constructor(frame) {
    this.frame = frame;
    this.canvas = frame.querySelector("canvas");
    this.pen = this.canvas.getContext("2d");
    this.showForces = true;
    this.render = oncePerFrame(() => this.draw());
    new ResizeObserver(() => this.render()).observe(frame);
    onTheme(() => this.render());
  }

  show(model) {
    this.model = model;
    this.bounds = model.bounds();
    this.render();
  }

  /** Pixels of a point of the scene. */
  at([x, y]) {
    return [this.width / 2 + this.scale * (x - this.middle[0]), this.height / 2 - this.scale * (y - this.middle[1])];
  }

  draw() {
    const { pen, canvas, model } = this;
    if (!model || !canvas.clientWidth) return;
    const ratio = Math.min(2, devicePixelRatio);
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    canvas.width = this.width * ratio;
    canvas.height = this.height * ratio;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { low, high, size } = this.bounds, margin = 0.14 * size;
    this.size = size;
    this.middle = low.map((x, k) => (x + high[k]) / 2);
    this.scale = Math.min(this.width / (high[0] - low[0] + 2 * margin), this.height / (high[1] - low[1] + 2 * margin));
    this.unit = 1 / this.scale;
    pen.lineCap = pen.lineJoin = "round";
    this.inks = Object.fromEntries(["ink", "soft", "line", "deep", "warm", "face", "faceTwo", "faceThree", "panel", "stable"].map((name) => [name, color(name)]));
    this.trails();
    for (const c of model.connections) this.ground(c);
    for (const c of model.connections) this.connection(c);
    for (const body of model.bodies) this.body(body);
    for (const c of model.connections) {
      if (c.kind === "pin") this.pin(c);
      else if (c.kind !== "slider") this.pegs([c.a, c.b, ...(c.through || [])]);
    }
    if (this.showForces) this.arrows();
  }

  line(points, ink, width = 2, dash = []) {
    if (points.length < 2) return;
    const { pen } = this;
    pen.beginPath();
    points.forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...this.at(p)));
    pen.strokeStyle = this.inks[ink];
    pen.lineWidth = width;
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  disc(center, radius, fill, stroke = "ink", width = 1.5) {
    const { pen } = this;
    pen.beginPath();
    pen.arc(...this.at(center), Math.max(0.5, radius * this.scale), 0, 2 * Math.PI);
    if (fill) { pen.fillStyle = this.inks[fill]; pen.fill(); }
    if (stroke) { pen.strokeStyle = this.inks[stroke]; pen.lineWidth = width; pen.stroke(); }
  }

  trails() {
    for (const body of this.model.bodies) {
      const path = this.model.column(`${body.name}.position`);
      if (path) this.line(path.slice(0, this.model.index + 1), "soft", 1);
    }
  }

  /** The faces and curves on which something slides or rolls. */
  ground(c) {
    if (c.kind === "slider") {
      const a = this.model.place(c.b ?? [0, 0]).point, t = this.model.touching(c).tangent;
      this.face(a, t, null);
    }
    if (c.kind === "spinning-frame" && c.about !== "normal") {
      const x = this.model.numbers.vector(c.at)?.[0] || 0, reach = 2 * this.size;
      this.line([[x, this.middle[1] - reach], [x, this.middle[1] + reach]], "soft", 1.5, [8, 6]);
    }
    if (!c.on || typeof c.on !== "object") return;
    const face = this.model.face(c.on);
    if (face.radius === 0) return this.disc(face.point, 0.008 * this.size, "soft");
    if (face.radius !== null) return this.disc(face.point, Math.abs(face.radius), null, "soft", 2);
    if (face.curvature !== null) {
      const points = [...Array(81).keys()].map((i) => (i / 40 - 1) * this.size).map((s) => add(add(face.point, face.along, s), face.normal, (face.curvature * s * s) / 2));
      return this.line(points, "soft", 2);
    }
    this.face(face.point, face.along, face.body && c);
  }

  face(point, along, carried) {
    const reach = 2.2 * this.size;
    if (!carried) {
      this.line([add(point, along, -reach), add(point, along, reach)], "soft", 2);
      return this.hatch(point, along, reach);
    }
    // A face of a body is drawn as a wedge below it, as far as something moves on it; faces of one wedge have one foot.
    const endOf = (c) => { const face = this.model.face(c.on); return add(face.point, face.along, 1.15 * this.model.farthestOn(c) || 1.25 * this.size); };
    const end = endOf(carried), others = this.model.connections.filter((c) => c.on?.at === carried.on.at && c.on.radius === undefined);
    const low = Math.min(point[1], ...others.map((c) => endOf(c)[1]));
    const outline = [point, end, [end[0], low], [point[0], low]];
    const { pen } = this;
    if (Math.abs(along[1]) > 0.05) {
      pen.beginPath();
      outline.forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...this.at(p)));
      pen.closePath();
      pen.fillStyle = this.inks.faceThree;
      pen.globalAlpha = 0.45;
      pen.fill();
      pen.globalAlpha = 1;
      this.line([...outline, point], "ink", 1.5);
    } else this.line([add(point, along, -0.3 * this.size), add(point, along, 0.3 * this.size)], "ink", 2);
  }

  hatch(point, along, reach) {
    const step = 0.06 * this.size, down = scaled(quarter(along), -0.03 * this.size);
    for (let s = -reach; s < reach; s += step) {
      const p = add(point, along, s);
      this.line([p, add(add(p, down), along, -0.03 * this.size)], "line", 1);
    }
  }

  connection(c) {
    const { model } = this, at = (reference) => model.place(reference).point;
    if (c.kind === "rod") this.line([at(c.a), at(c.b)], "ink", 4);
    if (c.kind === "string" || c.kind === "chain") this.string(c);
    if (c.kind === "spring") this.spring(at(c.a), at(c.b));
    if (c.kind === "damper" && c.measure !== "turn") this.damper(at(c.a), at(c.b));
    if (c.kind === "torsion-spring") this.coil(at(c.a));
    if (c.kind === "motor") this.turning(at(c.a));
    if (c.kind === "torque") this.turning(at(c.body));
  }

  string(c) {
    const { parts, arcs } = this.model.stringOf(c);
    const slack = this.model.isSlack(c);
    for (const part of parts) this.line(part, "warm", slack ? 1.5 : 2, slack ? [3, 5] : []);
    for (const { center, radius, from, to, sense } of arcs) {
      const start = Math.atan2(from[1] - center[1], from[0] - center[0]);
      let sweep = Math.atan2(to[1] - center[1], to[0] - center[0]) - start;
      while (sense * sweep < 0) sweep += sense * 2 * Math.PI;
      this.line([...Array(25).keys()].map((i) => add(center, turned(start + (sweep * i) / 24, [radius, 0]))), "warm", 2);
    }
  }

  spring(a, b) {
    const d = sub(b, a), side = scaled(quarter(unit(d)), 0.025 * this.size);
    const points = [a, ...[...Array(15).keys()].map((i) => add(add(a, d, 0.12 + (0.76 * i) / 14), side, i === 0 || i === 14 ? 0 : i % 2 ? 1 : -1)), b];
    this.line(points, "stable", 2);
  }

  damper(a, b) {
    const d = sub(b, a), side = scaled(quarter(unit(d)), 0.025 * this.size);
    const p = add(a, d, 0.4), q = add(a, d, 0.65);
    this.line([a, p], "soft", 2);
    this.line([add(q, side), add(p, side), sub(p, side), sub(q, side)], "soft", 2);
    this.line([add(add(a, d, 0.55), side, 0.8), add(add(a, d, 0.55), side, -0.8)], "soft", 2);
    this.line([add(a, d, 0.55), b], "soft", 2);
  }

  coil(at) {
    this.line([...Array(60).keys()].map((i) => add(at, turned((i / 60) * 5 * Math.PI, [(0.045 * this.size * i) / 60, 0]))), "stable", 2);
  }

  turning(at) {
    const radius = 0.06 * this.size, points = [...Array(24).keys()].map((i) => add(at, turned(0.4 + (i / 23) * 4.6, [radius, 0])));
    this.line(points, "deep", 2);
    this.head(points[22], points[23], "deep");
  }

  body(body) {
    const { at, angle } = body, dotSize = (body.mass ? 0.022 * Math.cbrt(body.mass / this.heaviest()) : 0.008) * this.size;
    const places = Object.values(body.places).map((p) => add(at, turned(angle, p)));
    if (body.radius) {
      this.pen.globalAlpha = 0.5;
      this.disc(at, body.radius, "face", null);
      this.pen.globalAlpha = 1;
      this.disc(at, body.radius, null, "ink", 2);
      this.line([at, add(at, turned(angle, [body.radius, 0]))], "ink", 2);
      for (const p of places) this.line([at, p], "ink", 1.5);
      return;
    }
    if (places.length) {
      for (const p of places) this.line([at, p], "face", 7);
      this.disc(at, 0.6 * dotSize, "ink");
      return;
    }
    if (body.rigid && body.mass) {
      const h = 0.04 * this.size, corners = [[-h, -h / 1.6], [h, -h / 1.6], [h, h / 1.6], [-h, h / 1.6]].map((p) => add(at, turned(angle, p)));
      const { pen } = this;
      pen.beginPath();
      corners.forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...this.at(p)));
      pen.closePath();
      pen.fillStyle = this.inks.face;
      pen.fill();
      return;
    }
    if (body.mass) this.disc(at, dotSize, "deep");
    else this.disc(at, dotSize, "panel");
  }

  heaviest() {
    return Math.max(...this.model.bodies.map((body) => body.mass)) || 1;
  }

  /** Ends and pegs that are fixed to the ground. */
  pegs(references) {
    for (const reference of references) {
      if (reference && typeof reference !== "string") this.disc(this.model.place(reference).point, 0.009 * this.size, "panel", "soft", 2);
    }
  }

  pin(c) {
    const { point } = this.model.place(c.a);
    if (typeof c.b !== "string") {
      const s = 0.035 * this.size, corners = [point, add(point, [-s, -1.5 * s]), add(point, [s, -1.5 * s]), point];
      this.line(corners, "soft", 2);
    }
    this.disc(point, 0.011 * this.size, "panel");
  }

  arrows() {
    const { model } = this;
    if (!model.forceScale) return;
    const factor = (0.26 * this.size) / model.forceScale;
    for (const { at, vector } of model.arrows()) {
      const end = add(at, vector, factor);
      if (norm(vector) * factor < 0.008 * this.size) continue;
      this.line([at, end], "warm", 3);
      this.head(at, end, "warm");
    }
  }

  head(from, to, ink) {
    const { pen } = this, along = scaled(unit(sub(to, from)), 9 * this.unit), side = scaled(quarter(along), 0.5);
    pen.beginPath();
    [to, add(sub(to, along), side), sub(sub(to, along), side)].forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...this.at(p)));
    pen.closePath();
    pen.fillStyle = this.inks[ink];
    pen.fill();
  }
}



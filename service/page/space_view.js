// A described scene of space, drawn by three.js: sticks, balls, and for each rigid body one of the same moments.
import { cuboidOf } from "./bodies.js";
import { symmetryAxis } from "./scene_model.js";
import { Arrow, Curve, View, material } from "./view3d.js";
import { BoxGeometry, CylinderGeometry, DoubleSide, Group, Mesh, SphereGeometry, TorusGeometry, Vector3 } from "./vendor/three.js";
import { norm } from "./vectors.js";

const UP = new Vector3(0, 1, 0), AXIS = new Vector3(0, 0, 1), THIN = 0.04;
/** Along a cylinder as it is made; the axis of what is round in a description; the drawn thickness of a disc, in its radii. */

/** What is drawn of a shape that is no ball, in the axes of its body. */
const SHAPES = {
  disc: (view, { shape }) => view.drum(view.lengthOf(shape.radius), THIN * view.lengthOf(shape.radius)),
  cylinder: (view, { shape }) => view.drum(view.lengthOf(shape.radius), view.lengthOf(shape.height)),
  ellipsoid(view, { shape }) {
    const semiAxes = shape.semi_axes.map((x) => view.lengthOf(x)), parts = view.ball(1), whole = new Group();
    whole.add(...parts);
    whole.scale.set(...semiAxes);
    return [whole];
  },
};

export class SpaceView extends View {
  constructor(frame) {
    super(frame, "the scene");
    this.extent = 1.15;
    this.showForces = true;
    this.paints = Object.fromEntries(["face", "faceTwo", "faceThree", "deep", "warm", "soft", "ink", "stable"].map((name) => [name, material(this, name)]));
    this.glass = material(this, "surface", { transparent: true, opacity: 0.35, side: DoubleSide, depthWrite: false });
    this.content = new Group();
    this.scene.add(this.content);
    this.trails = [];
    this.lookFrom(new Vector3(0.9, -1.5, 0.8), new Vector3(0, 0, 1));
  }

  show(model) {
    const fresh = this.model?.description !== model.description;
    this.model = model;
    this.filled = true;
    const { low, high, size } = model.bounds();
    this.middle = low.map((x, k) => (x + high[k]) / 2);
    this.factor = 1.5 / Math.max(size, 1e-12);
    this.content.clear();
    this.parts = [];
    if (fresh) this.trails.forEach((curve) => curve.show([]));
    this.trails = model.bodies.map((body, i) => this.trails[i] || new Curve(this, "soft", 1.5, true));
    model.bodies.forEach((body, i) => {
      const path = model.column(`${body.name}.position`);
      if (path && path.some((p) => norm(p.map((x, k) => x - path[0][k])) > 1e-9 * size)) this.trails[i].show(path.map((p) => this.place(p)));
      else this.trails[i].show([]);
      this.bodyPart(body);
    });
    for (const c of model.connections) this.connectionPart(c);
    this.arrowPool = model.arrows().map(() => this.add(new Arrow(this, "warm", 0.012)));
    this.update();
  }

  /** Name what is selected where it is. */
  mark(selection) {
    this.marked = selection;
    for (const body of this.model?.bodies ?? []) this.label(body.name, selection.has(`body:${body.name}`) ? body.name : "", new Vector3(...this.place(body.at)), "deep");
    this.render();
  }

  /** A point of the scene in the coordinates of the picture. */
  place(point) {
    return point.map((x, k) => (x - this.middle[k]) * this.factor);
  }

  add(part) {
    this.content.add(part.group || part);
    return part;
  }

  bodyPart(body) {
    const group = new Group();
    const heaviest = Math.max(...this.model.bodies.map((b) => b.mass)) || 1;
    const described = SHAPES[body.shape?.kind]?.(this, body);
    if (described) group.add(...described);
    else if (body.radius) group.add(...this.ball(body.radius * this.factor));
    else if (body.moments && body.mass) group.add(this.solid(body));
    else group.add(new Mesh(new SphereGeometry(0.05 * Math.cbrt((body.mass || heaviest) / heaviest), 20, 14), this.paints.deep));
    const top = body.moments && this.isTop(body, symmetryAxis(body.moments));
    for (const place of Object.values(body.places)) {
      const stick = this.stick(top ? "ink" : "soft", top ? 0.02 : 0.014);
      // The stick of a top goes through its disc.
      stretch(stick, new Vector3(...place).multiplyScalar(top ? -0.6 * this.factor : 0), new Vector3(...place).multiplyScalar(this.factor));
      group.add(stick);
    }
    this.add(group);
    this.parts.push(() => {
      const now = this.model.byName[body.name], [w, x, y, z] = now.attitude;
      group.position.set(...this.place(now.at));
      group.quaternion.set(x, y, z, w);
    });
  }

  /** A length of the description in the picture. */
  lengthOf(length) {
    return (this.model.numbers.number(length) || 0) * this.factor;
  }

  /** A drum about the third axis, with a spoke on each end, so that its turning is seen. */
  drum(radius, height) {
    const { face, faceTwo } = this.paints, body = new Mesh(new CylinderGeometry(radius, radius, height, 60), [face, faceTwo, faceTwo]), spoke = this.stick("ink", 0.02 * radius);
    body.quaternion.setFromUnitVectors(UP, AXIS);
    const spokes = [1, -1].map((side) => {
      const one = side > 0 ? spoke : spoke.clone();
      stretch(one, new Vector3(0, 0, (side * height) / 2), new Vector3(radius, 0, (side * height) / 2));
      return one;
    });
    return [body, ...spokes];
  }

  /** A ball with two seams, so that its turning is seen. */
  ball(radius) {
    const seams = [this.paints.faceTwo, this.paints.faceThree].map((paint) => new Mesh(new TorusGeometry(radius, 0.03 * radius, 8, 48), paint));
    seams[1].rotateX(Math.PI / 2);
    return [new Mesh(new SphereGeometry(radius, 32, 24), this.paints.face), ...seams];
  }

  /** A cylinder or cuboid with the moments of the body. */
  solid(body) {
    const axis = symmetryAxis(body.moments), [along, across] = [body.moments[axis], body.moments[(axis + 1) % 3]];
    const flat = this.isTop(body, axis);
    const height = flat ? (0.3 ** 2 * 2 * along) / body.mass : (12 * (across - along / 2)) / body.mass, paints = [this.paints.face, this.paints.faceTwo, this.paints.faceThree];
    if (across === body.moments[(axis + 2) % 3] && height > -1e-12) {
      const radius = Math.sqrt((2 * along) / body.mass) * this.factor;
      const mesh = new Mesh(new CylinderGeometry(radius, radius, Math.max(0.02, Math.sqrt(Math.max(0, height)) * this.factor), 40), paints);
      const own = new Vector3().setComponent(axis, 1);
      mesh.quaternion.setFromUnitVectors(UP, own);
      return mesh;
    }
    const edges = cuboidOf(body.moments) || body.moments.map(() => Math.sqrt(along));
    const sizes = edges.map((e) => (e / Math.sqrt(body.mass)) * this.factor);
    const { face, faceTwo, faceThree } = this.paints;
    return new Mesh(new BoxGeometry(...sizes), [face, face, faceTwo, faceTwo, faceThree, faceThree]);
  }

  /** Whether a body is a top: symmetric, with its places on its axis. It is drawn as a disc on a stick. */
  isTop(body, axis) {
    const places = Object.values(body.places);
    return places.length > 0 && places.every((p) => p.every((x, k) => k === axis || Math.abs(x) < 1e-12) && norm(p) > 0);
  }

  stick(name, width) {
    return new Mesh(new CylinderGeometry(width, width, 1, 10), this.paints[name]);
  }

  connectionPart(c) {
    const at = (reference) => new Vector3(...this.place(this.model.place(reference).point));
    const looks = { rod: ["ink", 0.014], spring: ["stable", 0.02], damper: ["soft", 0.02] };
    if (looks[c.kind]) {
      const stick = this.add(this.stick(...looks[c.kind]));
      this.parts.push(() => {
        stick.visible = this.model.acts(c);
        stretch(stick, at(c.a), at(c.b));
      });
    }
    if (c.kind === "string") {
      const sticks = c.through.slice(1).map(() => this.add(this.stick("warm", 0.008)));
      this.parts.push(() => sticks.forEach((stick, i) => stretch(stick, at(c.through[i]), at(c.through[i + 1]))));
    }
    if (c.kind === "pin" || c.kind === "ball-joint") {
      const ball = this.add(new Mesh(new SphereGeometry(0.028, 16, 12), this.paints.ink));
      this.parts.push(() => ball.position.copy(at(c.a)));
    }
    if (c.on) this.facePart(c);
    for (const end of [c.a, c.b, ...(c.through ?? [])]) {
      if (!Array.isArray(end)) continue;
      const ball = this.add(new Mesh(new SphereGeometry(0.025, 16, 12), this.paints.soft));
      this.parts.push(() => ball.position.copy(at(end)));
    }
  }

  facePart(c) {
    const face = this.model.face(c.on), point = this.place(face.point);
    if (face.radius !== null && c.on.direction) {
      const radius = Math.abs(face.radius) * this.factor, tube = this.add(new Mesh(new CylinderGeometry(radius, radius, 3, 48, 1, true), this.glass));
      tube.position.set(...point);
      tube.quaternion.setFromUnitVectors(UP, new Vector3(...face.along));
    } else if (face.radius !== null) {
      const ball = this.add(new Mesh(new SphereGeometry(Math.abs(face.radius) * this.factor, 40, 28), this.glass));
      ball.position.set(...point);
    } else if (face.plane) {
      // As large as the scene, about the foot of its middle.
      const away = face.normal.reduce((sum, n, k) => sum + n * point[k], 0);
      const disc = this.add(new Mesh(new CylinderGeometry(1.25, 1.25, 0.004, 60), this.glass));
      disc.position.set(...face.normal.map((n) => n * away));
      disc.quaternion.setFromUnitVectors(UP, new Vector3(...face.normal));
    } else {
      const stick = this.add(this.stick("soft", 0.008)), along = new Vector3(...face.along);
      stretch(stick, new Vector3(...point).addScaledVector(along, -2), new Vector3(...point).addScaledVector(along, 2));
    }
  }

  /** Show the model at its present time. */
  update() {
    for (const part of this.parts) part();
    if (this.marked) this.mark(this.marked);
    const arrows = this.showForces && this.model.forceScale ? this.model.arrows() : [];
    this.arrowPool.forEach((arrow, i) => {
      const entry = arrows[i];
      if (!entry) { arrow.group.visible = false; return; }
      arrow.pointTo(new Vector3(...entry.vector).multiplyScalar(0.5 / this.model.forceScale), new Vector3(...this.place(entry.at)));
    });
    this.render();
  }
}

/** Stretch a cylinder of length 1 along y from a to b. */
function stretch(mesh, a, b) {
  const d = b.clone().sub(a), length = d.length();
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  mesh.scale.set(1, length, 1);
  mesh.position.copy(a).addScaledVector(d, 0.5);
  mesh.quaternion.setFromUnitVectors(UP, d.divideScalar(length));
}

// The energy ellipsoid with the polhode, the separatrix and what an integrator makes of them; the start can be dragged.
import { color, make } from "./dom.js";
import { Curve, View, material } from "./view3d.js";
import { CylinderGeometry, Matrix4, Mesh, MeshLambertMaterial, SphereGeometry, Vector3 } from "./vendor/three.js";

const STABILITY = { stable: "stable", unstable: "unstable", neutral: "neutral" };

export class EllipsoidView extends View {
  /** `onSpin(w)` is called with the angular velocity that the reader drags to. */
  constructor(frame, onSpin) {
    super(frame, "the ellipsoid");
    this.extent = 1.25;
    this.onSpin = onSpin;
    this.surface = new Mesh(new SphereGeometry(1, 64, 48), material(this, "surface"));
    this.surface.matrixAutoUpdate = false;
    this.scene.add(this.surface);
    this.polhode = new Curve(this, "deep", 3.5, true);
    this.separatrices = [0, 1].map(() => new Curve(this, "separatrix", 2.5, true, true));
    this.integrated = new Curve(this, "warm", 2, true);
    this.now = new Mesh(new SphereGeometry(0.035, 20, 14), material(this, "ink"));
    this.scene.add(this.now);
    this.axes = [0, 1, 2].map(() => {
      const bar = new Mesh(new CylinderGeometry(0.016, 0.016, 1, 10), new MeshLambertMaterial());
      this.scene.add(bar);
      return { bar, name: "neutral" };
    });
    this.painted(() => this.axes?.forEach((axis) => axis.bar.material.color.set(color(axis.name))));
    this.makeHandle();
  }

  /** Show the surface with semi-axes along the columns of `axes`; `stability` says of each axis what a spin about it is. */
  showSurface(semiAxes, axes, stability) {
    this.filled = true;
    this.semiAxes = semiAxes;
    this.scale = 1 / Math.max(...semiAxes);
    const columns = [0, 1, 2].map((k) => new Vector3(...axes.map((row) => row[k])));
    // The sphere must keep its orientation.
    if (columns[0].clone().cross(columns[1]).dot(columns[2]) < 0) columns[2].negate();
    this.columns = columns;
    const turned = new Matrix4().makeBasis(...columns);
    const sizes = semiAxes.map((a) => a * this.scale);
    this.surface.matrix.copy(turned).scale(new Vector3(...sizes));
    const names = ["I₁", "I₂", "I₃"];
    columns.forEach((direction, k) => {
      const axis = this.axes[k], length = 2 * sizes[k] + 0.34;
      axis.name = STABILITY[stability[k]];
      axis.bar.material.color.set(color(axis.name));
      axis.bar.scale.set(1, length, 1);
      axis.bar.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), direction);
      this.label(`axis${k}`, `${names[k]} ${stability[k]}`, direction.clone().multiplyScalar(sizes[k] + 0.19), stability[k]);
      this.label(`back${k}`, `${names[k]}`, direction.clone().multiplyScalar(-sizes[k] - 0.19), stability[k]);
    });
    this.render();
  }

  showCurves(polhode, separatrix) {
    // A little above the surface, whose triangles would hide parts of a curve on it.
    const above = 1.006 * this.scale;
    this.polhode.show(polhode, above);
    this.separatrices.forEach((curve, i) => curve.show(separatrix[i] || [], above));
    this.render();
  }

  /** Show where an integrator goes; none for an empty list. */
  showIntegrated(points) {
    this.integrated.show(points, 1.006 * (this.scale || 1));
    this.render();
  }

  setStart(w) {
    this.start = new Vector3(...w).multiplyScalar(this.scale);
    this.render();
  }

  setNow(w) {
    this.now.position.set(...w).multiplyScalar(this.scale);
    this.render();
  }

  /** Look at the start from the front, a little from the side, so that the curve through it is seen whole. */
  faceStart() {
    const normal = this.normal(this.start);
    const up = [...this.columns].sort((a, b) => Math.abs(a.dot(normal)) - Math.abs(b.dot(normal)))[0];
    this.lookFrom(normal, up);
    this.turn(0.5, 0.35);
  }

  normal(point) {
    const result = new Vector3();
    this.columns.forEach((direction, k) => {
      const size = this.semiAxes[k] * this.scale;
      result.addScaledVector(direction, point.dot(direction) / (size * size));
    });
    return result.normalize();
  }

  /** The angular velocity of the surface under a place on the frame, or nearest to it. */
  pick(x, y) {
    const { origin, direction } = this.ray(x, y);
    // One drag moves over one ellipsoid: the answers of the meantime are rounded.
    const { semiAxes, scale } = this.held || this, sizes = semiAxes.map((a) => a * scale);
    const inside = (v) => new Vector3(...this.columns.map((c, k) => v.dot(c) / sizes[k]));
    const o = inside(origin), d = inside(direction);
    const b = o.dot(d) / d.lengthSq();
    const gap = b * b - (o.lengthSq() - 1) / d.lengthSq();
    const u = o.addScaledVector(d, -b - Math.sqrt(Math.max(0, gap))).normalize();
    const w = new Vector3();
    this.columns.forEach((c, k) => w.addScaledVector(c, u.getComponent(k) * sizes[k]));
    return w.divideScalar(scale).toArray();
  }

  makeHandle() {
    const handle = make("button", {
      type: "button", className: "handle",
      "aria-label": "Angular velocity at the start. Drag it over the ellipsoid, or move it with the arrow keys; its energy stays the same.",
    });
    this.frame.append(handle);
    this.onView.push(() => {
      if (!this.start) return;
      const { x, y } = this.project(this.start);
      handle.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
      const behind = this.normal(this.start).dot(this.camera.position) < 0;
      handle.classList.toggle("behind", behind);
    });
    const place = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      this.held = { semiAxes: this.semiAxes, scale: this.scale };
    });
    handle.addEventListener("pointermove", (event) => {
      if (handle.hasPointerCapture(event.pointerId)) this.onSpin(this.pick(...place(event)));
    });
    handle.addEventListener("pointerup", (event) => {
      this.onSpin(this.pick(...place(event)));
      this.held = null;
    });
    handle.addEventListener("pointercancel", () => { this.held = null; });
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    handle.addEventListener("keydown", (event) => {
      if (!ways[event.key]) return;
      event.preventDefault();
      const { x, y } = this.project(this.start);
      const step = event.shiftKey ? 1 : 6;
      this.onSpin(this.pick(x + step * ways[event.key][0], y + step * ways[event.key][1]));
    });
  }
}

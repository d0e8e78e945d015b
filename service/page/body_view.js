// The body as it tumbles in space, its angular momentum upright and fixed.
import { color } from "./dom.js";
import { Arrow, View, material } from "./view3d.js";
import {
  BoxGeometry, Color, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Quaternion, SphereGeometry, TorusGeometry, Vector3,
} from "./vendor/three.js";

const UP = new Vector3(0, 1, 0);

export class BodyView extends View {
  constructor(frame) {
    super(frame, "the view of the body");
    this.extent = 1.35;
    this.space = new Group();
    this.body = new Group();
    this.space.add(this.body);
    this.momentum = new Arrow(this, "deep");
    this.omega = new Arrow(this, "warm", 0.018);
    this.scene.add(this.space, this.momentum.group, this.omega.group);
    this.faces = [material(this, "face"), material(this, "faceTwo"), material(this, "faceThree")];
    this.axes = [0, 1, 2].map(() => {
      const bar = new Mesh(new CylinderGeometry(0.014, 0.014, 2.1, 8), new MeshLambertMaterial());
      this.body.add(bar);
      return { bar, name: "neutral" };
    });
    this.painted(() => this.axes?.forEach((axis) => axis.bar.material.color.set(color(axis.name))));
    this.shapes = new Group();
    this.body.add(this.shapes);
    this.lookFrom(new Vector3(0.25, 0.3, 1), UP);
    this.momentum.pointTo(new Vector3(0, 1.15, 0));
    this.label("L", "L fixed", new Vector3(0, 1.17, 0), "deep");
  }

  /** Show shapes, moved so that `center` is the origin, beside principal `axes` (columns) coloured by stability. */
  showBody(shapes, center, axes, stability) {
    this.filled = true;
    this.shapes.clear();
    const reach = Math.max(...shapes.map((shape) => extentOf(shape, center)));
    for (const shape of shapes) this.shapes.add(this.meshOf(shape, center, reach));
    this.shapes.scale.setScalar(0.95 / reach);
    axes[0].forEach((_, k) => {
      const axis = this.axes[k];
      axis.name = stability[k];
      axis.bar.material.color.set(color(stability[k]));
      axis.bar.quaternion.setFromUnitVectors(UP, new Vector3(...axes.map((row) => row[k])));
    });
    this.render();
  }

  /** Turn space so that the angular momentum (in space axes) points upwards. */
  setMomentum(vector) {
    const length = Math.hypot(...vector);
    this.space.quaternion.setFromUnitVectors(UP, UP);
    if (length) this.space.quaternion.setFromUnitVectors(new Vector3(...vector).divideScalar(length), UP);
  }

  /** Show the attitude `[w, x, y, z]` and the angular velocity in body axes, as a part of the largest one. */
  setState(attitude, w, largest) {
    const [s, x, y, z] = attitude;
    this.body.quaternion.set(x, y, z, s).normalize();
    const turned = new Vector3(...w).divideScalar(largest || 1).applyQuaternion(new Quaternion().copy(this.space.quaternion).multiply(this.body.quaternion));
    this.omega.pointTo(turned.multiplyScalar(1.15));
    this.label("w", "ω", this.omega.group.visible ? turned.clone().multiplyScalar(1.02) : new Vector3(), "warm");
    this.render();
  }

  meshOf(shape, center, reach) {
    const group = new Group();
    const [face, second, third] = this.faces;
    if (shape.box) group.add(new Mesh(new BoxGeometry(...shape.box), [face, face, second, second, third, third]));
    if (shape.tube) group.add(new Mesh(new CylinderGeometry(shape.tube[0], shape.tube[0], shape.tube[1], 40), [face, second, third]));
    if (shape.torus) group.add(new Mesh(new TorusGeometry(...shape.torus, 14, 60), second));
    if (shape.disc) group.add(new Mesh(new CylinderGeometry(shape.disc[0], shape.disc[0], shape.disc[0] / 40, 50), face).rotateX(Math.PI / 2));
    if (shape.ellipsoid) {
      // A seam, so that the turning of a round body is seen.
      const ball = new Mesh(new SphereGeometry(1, 40, 30), face);
      const seam = new Mesh(new TorusGeometry(1, 0.02, 8, 60), second);
      const other = new Mesh(new TorusGeometry(1, 0.02, 8, 60), third).rotateX(Math.PI / 2);
      group.add(ball, seam, other);
      group.scale.set(...shape.ellipsoid);
    }
    if (shape.points) {
      const heaviest = Math.max(...shape.masses);
      shape.points.forEach((p, i) => {
        const ball = new Mesh(new SphereGeometry(0.09 * reach * Math.cbrt(shape.masses[i] / heaviest), 18, 12), face);
        ball.position.set(p[0] - center[0], p[1] - center[1], p[2] - center[2]);
        group.add(ball);
      });
      return group;
    }
    if (shape.axis === "z") group.rotateX(Math.PI / 2);
    if (shape.axis === "x") group.rotateZ(Math.PI / 2);
    if (shape.columns) group.quaternion.setFromRotationMatrix(shape.columns);
    const at = shape.at || [0, 0, 0];
    group.position.set(at[0] - center[0], at[1] - center[1], at[2] - center[2]);
    return group;
  }
}

function extentOf(shape, center) {
  const far = (at) => Math.hypot(at[0] - center[0], at[1] - center[1], at[2] - center[2]);
  if (shape.points) return 1.1 * Math.max(...shape.points.map(far));
  const own = shape.box ? Math.hypot(...shape.box) / 2
    : shape.tube ? Math.hypot(shape.tube[0], shape.tube[1] / 2)
    : shape.torus ? shape.torus[0] + shape.torus[1]
    : shape.disc ? shape.disc[0] : Math.max(...shape.ellipsoid);
  return own + far(shape.at || [0, 0, 0]);
}

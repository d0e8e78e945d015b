// A picture in space: canvas, camera, turning by pointer, touch and keys, labels on top.
import { color, make, oncePerFrame, onTheme } from "./dom.js";
import {
  AmbientLight, Color, ConeGeometry, CylinderGeometry, DirectionalLight, Group, Line2, LineGeometry, LineMaterial, Matrix4, Mesh,
  MeshLambertMaterial, OrthographicCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from "./vendor/three.js";

const UP = new Vector3(0, 1, 0);

/** Draws every picture of a page; null where the browser has no WebGL. Made once: contexts and their shaders are what takes time. */
let renderer;

function makeRenderer() {
  try {
    renderer = new WebGLRenderer({ canvas: new OffscreenCanvas(1, 1), antialias: true, alpha: true });
    // Asking whether a shader compiled waits until it has.
    renderer.debug.checkShaderErrors = false;
  } catch {
    renderer = null;
  }
}

export class View {
  /** `frame` is the element that holds the picture; `name` names it for the buttons that turn it. */
  constructor(frame, name) {
    this.frame = frame;
    this.canvas = frame.querySelector("canvas");
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0.01, 100);
    this.extent = 1.3;
    this.yaw = this.pitch = 0;
    this.basis = new Matrix4();
    this.labels = new Map();
    this.filled = false;
    this.painters = [];
    /** @type {any} */
    this.bitmap = null;
    this.onView = [];
    this.light = new DirectionalLight(0xffffff, 2.2);
    this.scene.add(new AmbientLight(0xffffff, 1.6), this.light);
    this.render = oncePerFrame(() => this.draw());
    this.turning(name);
    new ResizeObserver(() => this.render()).observe(frame);
    onTheme(() => this.repaint());
  }

  /** Look at the origin from `direction`, with `up` upwards; what the reader has turned is undone. */
  lookFrom(direction, up) {
    const toward = direction.clone().normalize();
    const right = new Vector3().crossVectors(up, toward).normalize();
    this.basis.makeBasis(right, new Vector3().crossVectors(toward, right), toward);
    this.yaw = this.pitch = 0;
    this.render();
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.max(-1.5, Math.min(1.5, this.pitch + pitch));
    this.render();
  }

  turning(name) {
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    // Then the keys turn the picture.
    canvas.addEventListener("click", () => group.focus({ preventScroll: true }));
    canvas.addEventListener("pointermove", (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) this.turn(-event.movementX / 120, event.movementY / 120);
    });
    const group = make("div", { className: "turn", role: "group", tabIndex: -1, "aria-label": `Turn ${name}` });
    const turns = { "◀": ["left", 0.2, 0], "▶": ["right", -0.2, 0], "▲": ["up", 0, -0.2], "▼": ["down", 0, 0.2] };
    for (const [sign, [way, yaw, pitch]] of Object.entries(turns)) {
      group.append(make("button", { type: "button", textContent: sign, "aria-label": `Turn ${name} ${way}`, onclick: () => this.turn(yaw, pitch) }));
    }
    const keys = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    group.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      this.turn(...keys[event.key]);
    });
    this.frame.append(group);
  }

  /** Add a function that colours something by the theme, and call it. */
  painted(paint) {
    this.painters.push(paint);
    paint();
  }

  repaint() {
    for (const paint of this.painters) paint();
    this.render();
  }

  /** Set the text at a point of the scene; it is removed if there is none. */
  label(key, text, point, name = "") {
    let entry = this.labels.get(key);
    if (!text) {
      entry?.element.remove();
      this.labels.delete(key);
      return;
    }
    if (!entry) {
      entry = { element: make("span", { className: "label", "aria-hidden": "true" }) };
      this.frame.append(entry.element);
      this.labels.set(key, entry);
    }
    if (entry.element.textContent !== text) {
      entry.element.textContent = text;
      entry.size = [entry.element.offsetWidth, entry.element.offsetHeight];
    }
    entry.element.className = `label ${name}`;
    entry.point = point;
  }

  /** Place on the frame, in pixels, and depth of a point of the scene. */
  project(point) {
    const p = point.clone().project(this.camera);
    return { x: ((p.x + 1) / 2) * this.width, y: ((1 - p.y) / 2) * this.height, z: p.z };
  }

  /** Line of sight through a place on the frame: origin and direction. */
  ray(x, y) {
    const origin = new Vector3((2 * x) / this.width - 1, 1 - (2 * y) / this.height, -1).unproject(this.camera);
    return { origin, direction: this.camera.getWorldDirection(new Vector3()) };
  }

  /** Draw the picture; the first one waits until the numbers that came with it are on the screen. */
  paint() {
    if (renderer === undefined) {
      if (this.waiting) return;
      this.waiting = true;
      setTimeout(() => {
        if (renderer === undefined) makeRenderer();
        this.render();
      });
    } else if (renderer) {
      renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      renderer.setSize(this.width, this.height, false);
      renderer.render(this.scene, this.camera);
      this.bitmap ??= this.canvas.getContext("bitmaprenderer");
      this.bitmap.transferFromImageBitmap(renderer.domElement.transferToImageBitmap());
    } else if (!this.frame.querySelector(".fallback")) {
      this.frame.append(make("p", { className: "soft fallback", textContent: "This browser draws no pictures in space (WebGL is off). Numbers and curves are below." }));
    }
  }

  draw() {
    if (!this.filled) return;
    this.width = this.canvas.clientWidth || 1;
    this.height = this.canvas.clientHeight || 1;
    const wide = Math.max(1, this.width / this.height), high = Math.max(1, this.height / this.width);
    Object.assign(this.camera, { left: -this.extent * wide, right: this.extent * wide, top: this.extent * high, bottom: -this.extent * high });
    const cos = Math.cos(this.pitch);
    this.camera.position.set(Math.sin(this.yaw) * cos, Math.sin(this.pitch), Math.cos(this.yaw) * cos).multiplyScalar(20).applyMatrix4(this.basis);
    this.camera.up.set(0, 1, 0).applyMatrix4(this.basis);
    this.camera.lookAt(0, 0, 0);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.light.position.copy(this.camera.position).addScaledVector(this.camera.up, 14);
    this.paint();
    this.placeLabels();
    for (const listener of this.onView) listener();
  }

  /** Put labels beyond their points, as seen from the origin, inside the frame and off one another. */
  placeLabels() {
    const origin = this.project(new Vector3()), placed = [];
    for (const { element, point, size: [wide, high] } of this.labels.values()) {
      const p = this.project(point), [dx, dy] = [p.x - origin.x, p.y - origin.y], away = Math.hypot(dx, dy) || 1;
      const within = (value, half, whole) => Math.max(half + 3, Math.min(whole - half - 3, value));
      const x = within(p.x + ((Math.abs(dx) * wide + Math.abs(dy) * high) / 2 / away) * (dx / away), wide / 2, this.width);
      let y = within(p.y + ((Math.abs(dx) * wide + Math.abs(dy) * high) / 2 / away) * (dy / away), high / 2, this.height);
      for (const other of placed) {
        const [gapX, gapY] = [(wide + other.wide) / 2, (high + other.high) / 2];
        if (Math.abs(x - other.x) < gapX && Math.abs(y - other.y) < gapY) y = other.y + (y < other.y ? -gapY : gapY);
      }
      placed.push({ x, y, wide, high });
      element.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    }
  }
}

/** A curve of even width in pixels; with `through` also what lies behind is drawn, faintly. */
export class Curve {
  constructor(view, name, width, through = false, dashed = false) {
    this.group = new Group();
    this.lines = [through ? 0.28 : null, 1].filter((o) => o !== null).map((opacity) => {
      const material = new LineMaterial({ linewidth: width, transparent: true, opacity, depthTest: opacity === 1, dashed, dashSize: 0.05, gapSize: 0.035 });
      const line = new Line2(new LineGeometry(), material);
      line.visible = false;
      line.renderOrder = opacity === 1 ? 2 : 3;
      this.group.add(line);
      return line;
    });
    view.painted(() => this.lines.forEach((line) => line.material.color.set(color(name))));
    view.scene.add(this.group);
  }

  /** Show a curve through points `[x, y, z]`, scaled; nothing for less than two. */
  show(points, scale = 1) {
    for (const line of this.lines) {
      line.visible = points.length > 1;
      if (!line.visible) continue;
      line.geometry.dispose();
      line.geometry = new LineGeometry();
      line.geometry.setPositions(points.flatMap((p) => [p[0] * scale, p[1] * scale, p[2] * scale]));
      line.computeLineDistances();
    }
  }
}

export function material(view, name, options = {}) {
  const result = new MeshLambertMaterial(options);
  view.painted(() => { result.color = new Color(color(name)); });
  return result;
}

/** An arrow from the origin along y, of length 1; `pointTo` turns and stretches it. */
export class Arrow {
  constructor(view, name, width = 0.022) {
    const paint = material(view, name);
    this.group = new Group();
    this.shaft = new Mesh(new CylinderGeometry(width, width, 1, 12), paint);
    this.tip = new Mesh(new ConeGeometry(3 * width, 7 * width, 16), paint);
    this.headLength = 7 * width;
    this.group.add(this.shaft, this.tip);
  }

  /** Reach from `from` to `from + vector`. */
  pointTo(vector, from = null) {
    const length = vector.length();
    this.group.visible = length > 1e-9;
    if (!this.group.visible) return;
    const shaft = Math.max(1e-3, length - this.headLength);
    this.shaft.scale.set(1, shaft, 1);
    this.shaft.position.set(0, shaft / 2, 0);
    this.tip.position.set(0, length - this.headLength / 2, 0);
    this.group.position.copy(from || new Vector3());
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(UP, vector.clone().divideScalar(length)));
  }
}

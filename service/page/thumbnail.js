// A small picture of a scene at its start, without asking the service.
import { paint } from "./canvas_paint.js";
import { color } from "./dom.js";
import { Drawing, drawingOf } from "./plane_drawing.js";
import { SceneModel } from "./scene_model.js";
import { add } from "./vectors.js";

const INKS = ["ink", "soft", "line", "deep", "warm", "face", "faceTwo", "faceThree", "panel", "stable", "unstable", "separatrix", "third"];
const LOOK = [0.9, 0.45];
/** From where a scene in space is seen: turns about the vertical and above the level (rad). */

/** A point of space on the paper. */
function onPaper([x, y, z]) {
  const [turn, up] = LOOK, across = x * Math.cos(turn) + y * Math.sin(turn), away = -x * Math.sin(turn) + y * Math.cos(turn);
  return [across, z * Math.cos(up) + away * Math.sin(up)];
}

/** A scene in space as lines and discs on the paper. */
function inSpace(model, px) {
  const d = new Drawing(px, null), at = (reference) => onPaper(model.place(reference).point);
  for (const c of model.connections) {
    if (c.on?.radius !== undefined) d.disc(onPaper(model.face(c.on).point), Math.abs(model.face(c.on).radius), null, "soft", 1.5);
    else if (c.on?.normal !== undefined) d.outline([[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => onPaper(add(model.face(c.on).point, [40 * px * x, 40 * px * y, 0]))), "line", "soft", 1, { fillAlpha: 0.4 });
    const ends = c.through ?? (c.a !== undefined && c.b !== undefined && !["pin", "ball-joint", "contact", "rolling"].includes(c.kind) ? [c.a, c.b] : []);
    d.line(ends.map(at), c.kind === "string" ? "warm" : c.kind === "spring" ? "stable" : "ink", 2);
  }
  for (const body of model.bodies) {
    const center = onPaper(body.at), places = Object.keys(body.places);
    for (const place of places) d.line([center, at(`${body.name}.${place}`)], "soft", 3);
    if (body.radius) d.disc(center, body.radius, "face", "ink", 1.5, { fillAlpha: 0.6 });
    else if (body.rigid) {
      const axis = model.outward(body, [0, 0, 1]), size = 16 * px;
      d.line([center, onPaper(add(body.at, axis, 2 * size))], "face", 7);
      d.dot(center, 7, "face", "ink");
    } else d.dot(center, 5, "deep", "ink", 1);
  }
  return d.items;
}

/** Draw a description on a canvas of this size (pixels). */
export function drawThumbnail(canvas, description, width, height) {
  const model = new SceneModel(description, null), ratio = Math.min(2, devicePixelRatio), pen = canvas.getContext("2d");
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  const { low, high } = model.space ? boxOnPaper(model.bounds()) : model.bounds();
  const middle = low.map((x, k) => (x + high[k]) / 2), size = Math.max(...high.map((x, k) => x - low[k]), 1e-9);
  const scale = Math.min(width, height) / (1.35 * size), at = ([x, y]) => [width / 2 + scale * (x - middle[0]), height / 2 - scale * (y - middle[1])];
  const back = ([x, y]) => [middle[0] + (x - width / 2) / scale, middle[1] - (y - height / 2) / scale];
  const items = model.space ? inSpace(model, 1 / scale) : drawingOf(model, { px: 1 / scale, trails: false, view: { low: back([0, height]), high: back([width, 0]) } });
  paint(pen, items, { at, scale, inks: Object.fromEntries(INKS.map((name) => [name, color(name)])) });
}

function boxOnPaper({ low, high }) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => onPaper(low.map((x, i) => ((k >> i) & 1 ? high[i] : x))));
  return { low: [0, 1].map((k) => Math.min(...corners.map((c) => c[k]))), high: [0, 1].map((k) => Math.max(...corners.map((c) => c[k]))) };
}

// Puts a drawing on a canvas.

const HEAD = 10, FONT = "13px system-ui, sans-serif";
/** Pixels of the head of an arrow. */

/** `at` gives the pixels of a point, `scale` pixels of a metre, `inks` colours by name; `lit` are parts that are marked. */
export function paint(pen, items, { at, scale, inks, lit = new Set(), wrong = new Set() }) {
  pen.lineCap = pen.lineJoin = "round";
  for (const item of items) {
    if (lit.has(item.part) || wrong.has(item.part)) halo(pen, item, at, scale, wrong.has(item.part) ? inks.unstable : inks.separatrix);
  }
  for (const item of items) PAINT[item.shape](pen, item, at, scale, inks);
  pen.globalAlpha = 1;
}

const PAINT = {
  line(pen, { points, ink, width, dash, alpha }, at, scale, inks) {
    path(pen, points, at);
    stroke(pen, inks[ink], width, alpha, dash);
  },
  outline(pen, { points, fill, stroke: edge, width, alpha, fillAlpha = 1 }, at, scale, inks) {
    path(pen, points, at);
    pen.closePath();
    filled(pen, fill && inks[fill], alpha * fillAlpha);
    if (edge) stroke(pen, inks[edge], width, alpha);
  },
  disc(pen, { center, radius, fill, stroke: edge, width, alpha, fillAlpha = 1 }, at, scale, inks) {
    pen.beginPath();
    pen.arc(...at(center), Math.max(0.5, radius * scale), 0, 2 * Math.PI);
    filled(pen, fill && inks[fill], alpha * fillAlpha);
    if (edge) stroke(pen, inks[edge], width, alpha);
  },
  arrow(pen, { from, to, ink, alpha }, at, scale, inks) {
    const [ax, ay] = at(from), [bx, by] = at(to), length = Math.hypot(bx - ax, by - ay);
    if (!(length > 0)) return;
    const [ux, uy] = [(bx - ax) / length, (by - ay) / length], head = Math.min(HEAD, length);
    path(pen, [[ax, ay], [bx - ux * head * 0.6, by - uy * head * 0.6]], (p) => p);
    stroke(pen, inks[ink], 3, alpha);
    path(pen, [[bx, by], [bx - ux * head - (uy * head) / 2, by - uy * head + (ux * head) / 2], [bx - ux * head + (uy * head) / 2, by - uy * head - (ux * head) / 2]], (p) => p);
    filled(pen, inks[ink], alpha);
  },
  words(pen, { at: place, text, ink, alpha }, at, scale, inks) {
    pen.font = FONT;
    pen.globalAlpha = alpha;
    pen.lineWidth = 3;
    pen.setLineDash([]);
    pen.strokeStyle = inks.panel;
    pen.strokeText(text, ...at(place));
    pen.fillStyle = inks[ink];
    pen.fillText(text, ...at(place));
  },
};

function path(pen, points, at) {
  pen.beginPath();
  points.forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...at(p)));
}

function stroke(pen, ink, width, alpha, dash = []) {
  pen.globalAlpha = alpha;
  pen.strokeStyle = ink;
  pen.lineWidth = width;
  pen.setLineDash(dash);
  pen.stroke();
}

function filled(pen, ink, alpha) {
  if (!ink) return;
  pen.globalAlpha = alpha;
  pen.fillStyle = ink;
  pen.fill();
}

/** A wide pale stroke around what is marked. */
function halo(pen, item, at, scale, ink) {
  if (item.shape === "words") return;
  if (item.shape === "disc") {
    pen.beginPath();
    pen.arc(...at(item.center), item.radius * scale + 3, 0, 2 * Math.PI);
  } else {
    path(pen, item.points ?? [item.from, item.to], at);
    if (item.shape === "outline") pen.closePath();
  }
  stroke(pen, ink, (item.width || 2) + 8, 0.55);
}

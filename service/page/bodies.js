// The bodies to choose from: what is sent to the service, a spin to begin with, and shapes to draw.

const circle = (count) => [...Array(count).keys()].map((i) => (2 * Math.PI * i) / (count - 1));
const levels = (start, stop, count) => [...Array(count).keys()].map((k) => start + ((stop - start) * k) / (count - 1));

/** 300 unit masses on two crossed tubes of radius 1, 20 to a circle, the first of them counted twice. */
function tHandle() {
  const bar = levels(-2.5, 2.5, 10).flatMap((z) => circle(20).map((t) => [Math.cos(t), Math.sin(t), z]));
  const handle = levels(0, 20 / 9, 5).flatMap((y) => circle(20).map((t) => [Math.cos(t), y, Math.sin(t)]));
  return { kind: "point-masses", masses: 1, positions: [...bar, ...handle] };
}

const RACKET = {
  kind: "composite",
  parts: [
    { body: { kind: "torus", ring_radius: 0.14, tube_radius: 0.01, mass: 0.18 }, position: [0, 0.3, 0] },
    { body: { kind: "cylinder", radius: 0.015, height: 0.32, mass: 0.15 }, attitude: [1, 1, 0, 0], position: [0, 0, 0] },
  ],
};

/** By name: label, body, spin (rad/s), shapes in the coordinates of `body`. A shape is drawn at `at`, along `axis`. */
export const BODIES = {
  "t-handle": {
    label: "T-handle",
    body: tHandle(),
    spin: [1, 10, 1],
    shapes: [{ tube: [1, 5], axis: "z" }, { tube: [1, 20 / 9], at: [0, 10 / 9, 0], axis: "y" }],
  },
  racket: {
    label: "Tennis racket",
    body: RACKET,
    spin: [8, 0.02, 0.05],
    shapes: [
      { torus: [0.14, 0.012], at: [0, 0.3, 0] },
      { disc: [0.14], at: [0, 0.3, 0] },
      { tube: [0.015, 0.32], axis: "y" },
    ],
  },
  coin: {
    label: "Coin",
    body: { kind: "cylinder", radius: 0.01163, height: 0.00233, mass: 0.0075 },
    spin: [3, 0, 15],
    shapes: [{ tube: [0.01163, 0.00233], axis: "z" }],
  },
  football: {
    label: "American football",
    body: { kind: "ellipsoid", semi_axes: [0.14, 0.085, 0.085], mass: 0.41 },
    spin: [50, 6, 0],
    shapes: [{ ellipsoid: [0.14, 0.085, 0.085] }],
  },
  cards: {
    label: "Deck of cards",
    body: { kind: "cuboid", edges: [0.063, 0.088, 0.017], mass: 0.095 },
    spin: [10, 0.1, 0.1],
    shapes: [{ box: [0.063, 0.088, 0.017] }],
  },
  phone: {
    label: "Phone",
    body: { kind: "cuboid", edges: [0.0715, 0.147, 0.008], mass: 0.17 },
    spin: [12, 0.1, 0.1],
    shapes: [{ box: [0.0715, 0.147, 0.008] }],
  },
  earth: {
    label: "Earth",
    body: { kind: "principal-moments", moments: [8.0101e37, 8.0103e37, 8.0365e37] },
    spin: [1.06e-10, 0, 7.292115e-5],
    shapes: [{ ellipsoid: [1, 1, 0.9966] }],
  },
  moments: { label: "Own moments", own: "moments", moments: [1, 2, 3], spin: [0.1, 2, 0.1] },
  points: { label: "Own points", own: "points", points: "2 1 0 0\n2 -1 0 0\n1 0 0.7 0\n1 0 -0.7 0\n0.5 0 0 0.5\n0.5 0 0 -0.5", spin: [0.05, 4, 0.05] },
};

/** A cuboid of unit mass that has these moments, or null where there is none. */
export function cuboidOf(moments) {
  const [a, b, c] = moments;
  const squares = [6 * (b + c - a), 6 * (c + a - b), 6 * (a + b - c)];
  const least = 1e-4 * Math.max(...squares);
  return squares.some((s) => s < -1e-9 * Math.max(a, b, c)) ? null : squares.map((s) => Math.sqrt(Math.max(s, least)));
}

/** Read lines "mass x y z"; throws an error that names the line. */
export function pointsOf(text) {
  const rows = text.split(/[\n;]/).map((line, i) => [line.trim(), i + 1]).filter(([line]) => line);
  const numbers = rows.map(([line, i]) => {
    const row = line.split(/[\s,]+/).map(Number);
    if (row.length !== 4 || row.some((x) => !Number.isFinite(x))) throw new Error(`line ${i}: four numbers are needed, mass x y z`);
    return row;
  });
  return { kind: "point-masses", masses: numbers.map((r) => r[0]), positions: numbers.map((r) => r.slice(1)) };
}

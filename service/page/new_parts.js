// The parts of the palette: what each is in a description when it is new.
import { homogeneousInertia } from "./outlines.js";

const LENGTH = 1, RADIUS = 0.2, SIDE = 0.4, SHORT = 0.3;
/** Sizes of new parts in a view 4 m wide (m); smaller views get smaller ones. */

const rounded = (x) => Number(x.toPrecision(6));
const inertiaOf = (mass, outline) => rounded(homogeneousInertia(mass, outline));
/** The corners of a box by name. */
export const corners = (w, h) => ({ "lower-left": [-w / 2, -h / 2], "lower-right": [w / 2, -h / 2], "upper-right": [w / 2, h / 2], "upper-left": [-w / 2, h / 2] });
// Corners by name, too: they are what a floor is asked about, and what connections hold.
const box = (mass, width, height) => ({ mass, shape: { kind: "box", width, height }, places: corners(width, height) });
const disc = (mass, radius) => ({ mass, radius, inertia: inertiaOf(mass, { radius }) });

const ball = (mass, radius) => ({ mass, radius, moments: [0.4, 0.4, 0.4].map((k) => rounded(k * mass * radius ** 2)) });

/**
 * Bodies, by their name in the palette: what they are, given a factor for their size; `held` are connections to the ground. What has
 * `space` is for scenes in space alone (true) or in the plane alone (false), as with faces and connections.
 */
export const BODIES = {
  point: { words: "Point", hint: "a small mass", base: "point", make: () => ({ mass: 1 }) },
  disc: { space: false, words: "Disc", hint: "a round body that rolls", base: "disc", make: (s) => disc(1, rounded(RADIUS * s)) },
  box: { space: false, words: "Box", hint: "a block with four corners", base: "box", make: (s) => box(1, rounded(SIDE * s), rounded(SHORT * s)) },
  rod: { space: false, words: "Rod", hint: "a thin bar with two ends", base: "rod", make: (s) => ({ mass: 1, inertia: inertiaOf(1, { bar: [[-LENGTH * s / 2, 0], [LENGTH * s / 2, 0]] }), places: { left: [rounded(-LENGTH * s / 2), 0], right: [rounded(LENGTH * s / 2), 0] } }) },
  wheel: { space: false, words: "Wheel", hint: "a disc on an axle", base: "wheel", make: (s) => disc(1, rounded(1.5 * RADIUS * s)), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  pulley: { space: false, words: "Pulley", hint: "a light wheel on an axle for strings", base: "pulley", make: (s) => disc(0.1, rounded(0.75 * RADIUS * s)), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  peg: { space: false, words: "Peg", hint: "a fixed point", base: "peg", make: () => ({ mass: 0 }), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  wedge: {
    space: false, words: "Wedge", hint: "a slope that slides on the ground", base: "wedge",
    make: (s) => ({ mass: 2, inertia: inertiaOf(2, { corners: [[-0.6 * s, -0.2 * s], [0.6 * s, -0.2 * s], [-0.6 * s, 0.4 * s]] }), places: { heel: [rounded(-0.6 * s), rounded(-0.2 * s)], toe: [rounded(0.6 * s), rounded(-0.2 * s)], top: [rounded(-0.6 * s), rounded(0.4 * s)] } }),
    held: (name, at) => [{ kind: "slider", a: name, b: at, slope: 0 }],
  },
  ball: { space: true, words: "Ball", hint: "a sphere that rolls", base: "ball", make: () => ball(1, RADIUS) },
  bar: { space: true, words: "Bar", hint: "a thin bar with two ends", base: "bar", make: () => ({ mass: 1, moments: [0.000417, 0.0835417, 0.0835417], places: { left: [-LENGTH / 2, 0, 0], right: [LENGTH / 2, 0, 0] } }) },
  brick: { space: true, words: "Brick", hint: "a block that tumbles", base: "brick", make: () => ({ mass: 1, moments: [0.00833333, 0.0170833, 0.0208333], angular_velocity: [0, 2, 0] }) },
  top: {
    space: true, words: "Top", hint: "a spinning top that stands on its tip", base: "top",
    make: () => ({ mass: 1, moments: [0.012, 0.012, 0.02], axes: [[0.96, 0, -0.28], [0, 1, 0], [0.28, 0, 0.96]], angular_velocity: [0, 0, 60], places: { tip: [0, 0, -0.25] } }),
    held: (name, [x, y, z]) => [{ kind: "ball-joint", a: `${name}.tip`, b: [x - 0.07, y, z - 0.24].map(rounded) }],
  },
};

/** Faces of the ground. */
export const FACES = {
  floor: { space: false, words: "Floor", hint: "bodies stand on it", make: (at) => ({ at }) },
  wall: { space: false, words: "Wall", hint: "bodies stop at it", make: (at, side) => ({ at, slope: { degrees: side === "right" ? 90 : -90 } }) },
  ramp: { space: false, words: "Ramp", hint: "a fixed slope", make: (at) => ({ at, slope: { degrees: 30 } }) },
  plane: { space: true, words: "Plane", hint: "a level floor; its direction is in the inspector", make: ([x, y]) => ({ at: [x, y, 0], normal: [0, 0, 1] }) },
};

/**
 * Connections: how many places they join (`ends`; `many` for strings), whether an end may be of the ground, and their fields when new.
 * `make(places)` gets references to bodies or points of the ground.
 */
export const CONNECTIONS = {
  pin: { space: false, words: "Pin", hint: "two places stay together and turn", ends: 2, alone: true, make: ([a, b]) => ({ kind: "pin", a, b }) },
  "ball-joint": { space: true, words: "Ball joint", hint: "two places stay together and turn every way", ends: 2, make: ([a, b]) => ({ kind: "ball-joint", a, b }) },
  weld: { words: "Weld", hint: "two bodies move as one", ends: 2, alone: true, bodies: true, make: ([a, b]) => ({ kind: "weld", a, b }) },
  slider: { space: false, words: "Slider", hint: "a body slides along a line without turning", ends: 2, alone: true, make: ([a, b]) => ({ kind: "slider", a, b, slope: 0 }) },
  link: { words: "Light rod", hint: "two places keep their distance", ends: 2, make: ([a, b]) => ({ kind: "rod", a, b }) },
  string: { words: "String", hint: "through places and over pulleys; press Enter at its end", ends: "many", make: (through) => ({ kind: "string", through }) },
  spring: { words: "Spring", hint: "pulls its ends together", ends: 2, make: ([a, b]) => ({ kind: "spring", a, b, stiffness: 20 }) },
  damper: { words: "Damper", hint: "resists its change of length", ends: 2, make: ([a, b]) => ({ kind: "damper", a, b, coefficient: 1 }) },
  contact: { space: false, words: "Contact", hint: "two bodies that touch and do not pass", ends: 2, rims: true, make: ([a, b]) => ({ kind: "contact", a, b }) },
  motor: { space: false, words: "Motor", hint: "turns a body", ends: 1, rigid: true, make: ([a]) => ({ kind: "motor", a, rate: 2 }) },
  force: { words: "Force", hint: "pulls at a place: drag from it", ends: 1, vector: true, make: ([place], vector, space) => ({ kind: "force", place, force: vector ?? (space ? [5, 0, 0] : [5, 0]) }) },
};

/** Everything in the palette, in its groups. */
export const PALETTE = [
  ["Bodies", BODIES],
  ["Faces", FACES],
  ["Connections", CONNECTIONS],
];


/** Whether a tool is for scenes in space, or in the plane. */
export const fits = (tool, space) => tool.space === undefined || tool.space === space;

/** How new contacts are. */
export const NEW_CONTACT = { friction: 0.3 };

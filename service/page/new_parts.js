// The parts of the palette: what each is in a description when it is new.
import { homogeneousInertia } from "./outlines.js";

const LENGTH = 1, RADIUS = 0.2, SIDE = 0.4, SHORT = 0.3;
/** Sizes of new parts in a view 4 m wide (m); smaller views get smaller ones. */

const rounded = (x) => Number(x.toPrecision(6));
const inertiaOf = (mass, outline) => rounded(homogeneousInertia(mass, outline));
const corners = (w, h) => ({ "lower-left": [-w / 2, -h / 2], "lower-right": [w / 2, -h / 2], "upper-right": [w / 2, h / 2], "upper-left": [-w / 2, h / 2] });
const box = (mass, w, h) => ({ mass, inertia: inertiaOf(mass, { corners: Object.values(corners(w, h)) }), places: corners(w, h) });
const disc = (mass, radius) => ({ mass, radius, inertia: inertiaOf(mass, { radius }) });

/** Bodies, by their name in the palette: what they are, given a factor for their size; `held` are connections to the ground. */
export const BODIES = {
  point: { words: "Point", hint: "a small mass", base: "point", make: () => ({ mass: 1 }) },
  disc: { words: "Disc", hint: "a round body that rolls", base: "disc", make: (s) => disc(1, rounded(RADIUS * s)) },
  box: { words: "Box", hint: "a block with four corners", base: "box", make: (s) => box(1, rounded(SIDE * s), rounded(SHORT * s)) },
  rod: { words: "Rod", hint: "a thin bar with two ends", base: "rod", make: (s) => ({ mass: 1, inertia: inertiaOf(1, { bar: [[-LENGTH * s / 2, 0], [LENGTH * s / 2, 0]] }), places: { left: [rounded(-LENGTH * s / 2), 0], right: [rounded(LENGTH * s / 2), 0] } }) },
  wheel: { words: "Wheel", hint: "a disc on an axle", base: "wheel", make: (s) => disc(1, rounded(1.5 * RADIUS * s)), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  pulley: { words: "Pulley", hint: "a light wheel on an axle for strings", base: "pulley", make: (s) => disc(0.1, rounded(0.75 * RADIUS * s)), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  peg: { words: "Peg", hint: "a fixed point", base: "peg", make: () => ({ mass: 0 }), held: (name, at) => [{ kind: "pin", a: name, b: at }] },
  wedge: {
    words: "Wedge", hint: "a slope that slides on the ground", base: "wedge",
    make: (s) => ({ mass: 2, inertia: inertiaOf(2, { corners: [[-0.6 * s, -0.2 * s], [0.6 * s, -0.2 * s], [-0.6 * s, 0.4 * s]] }), places: { heel: [rounded(-0.6 * s), rounded(-0.2 * s)], toe: [rounded(0.6 * s), rounded(-0.2 * s)], top: [rounded(-0.6 * s), rounded(0.4 * s)] } }),
    held: (name, at) => [{ kind: "slider", a: name, b: at, slope: 0 }],
  },
};

/** Faces of the ground. */
export const FACES = {
  floor: { words: "Floor", hint: "bodies stand on it", make: (at) => ({ at }) },
  wall: { words: "Wall", hint: "bodies stop at it", make: (at, side) => ({ at, slope: { degrees: side === "right" ? 90 : -90 } }) },
  ramp: { words: "Ramp", hint: "a fixed slope", make: (at) => ({ at, slope: { degrees: 30 } }) },
};

/**
 * Connections: how many places they join (`ends`; `many` for strings), whether an end may be of the ground, and their fields when new.
 * `make(places)` gets references to bodies or points of the ground.
 */
export const CONNECTIONS = {
  pin: { words: "Pin", hint: "two places stay together and turn", ends: 2, alone: true, make: ([a, b]) => ({ kind: "pin", a, b }) },
  weld: { words: "Weld", hint: "two bodies move as one", ends: 2, alone: true, bodies: true, make: ([a, b]) => ({ kind: "weld", a, b }) },
  slider: { words: "Slider", hint: "a body slides along a line without turning", ends: 2, alone: true, make: ([a, b]) => ({ kind: "slider", a, b, slope: 0 }) },
  link: { words: "Light rod", hint: "two places keep their distance", ends: 2, make: ([a, b]) => ({ kind: "rod", a, b }) },
  string: { words: "String", hint: "through places and over pulleys; press Enter at its end", ends: "many", make: (through) => ({ kind: "string", through }) },
  spring: { words: "Spring", hint: "pulls its ends together", ends: 2, make: ([a, b]) => ({ kind: "spring", a, b, stiffness: 20 }) },
  damper: { words: "Damper", hint: "resists its change of length", ends: 2, make: ([a, b]) => ({ kind: "damper", a, b, coefficient: 1 }) },
  contact: { words: "Contact", hint: "two bodies that touch and do not pass", ends: 2, rims: true, make: ([a, b]) => ({ kind: "contact", a, b }) },
  motor: { words: "Motor", hint: "turns a body", ends: 1, rigid: true, make: ([a]) => ({ kind: "motor", a, rate: 2 }) },
  force: { words: "Force", hint: "pulls at a place: drag from it", ends: 1, vector: true, make: ([place], vector) => ({ kind: "force", place, force: vector ?? [5, 0] }) },
};

/** Everything in the palette, in its groups. */
export const PALETTE = [
  ["Bodies", BODIES],
  ["Faces", FACES],
  ["Connections", CONNECTIONS],
];

export const toolNamed = (name) => BODIES[name] ?? FACES[name] ?? CONNECTIONS[name];

/** How new contacts are. */
export const NEW_CONTACT = { friction: 0.3 };

// The fields of every kind of part in the inspector: name in the description, what people call it, unit.

/**
 * A number or formula.
 * @returns {any}
 */
const number = (name, words, unit, more = {}) => ({ name, words, unit, type: "number", ...more });
const place = (name, words) => ({ name, words, type: "place" });
/**
 * A vector; `plane`, `space` and `turns` say of which bodies.
 * @returns {any}
 */
const vector = (name, words, unit, more = {}) => ({ name, words, unit, type: "vector", ...more });
const choice = (name, words, options) => ({ name, words, type: "choice", options });
const check = (name, words) => ({ name, words, type: "check" });

/** Of a body; those of a point are fewer. `space` are those of a scene in space. */
export const BODY_FIELDS = [
  number("mass", "Mass", "kg"),
  vector("at", "Place", "m"),
  vector("velocity", "Velocity", "m/s", { optional: true }),
  number("angle", "Angle", "° or rad", { optional: true, angle: true, turns: true, plane: true }),
  number("angular_velocity", "Angular velocity", "rad/s", { optional: true, turns: true, plane: true }),
  vector("angular_velocity", "Angular velocity", "rad/s, in the axes of the body", { optional: true, turns: true, space: true }),
  number("radius", "Radius", "m", { optional: true }),
  number("inertia", "Moment of inertia", "kg m²", { optional: true, plane: true }),
  vector("moments", "Principal moments", "kg m²", { optional: true, turns: true, space: true }),
];

const ENDS = [place("a", "Of"), place("b", "And")];
const SMOOTH = number("friction", "Friction coefficient", "", { optional: true, open: true });
const BOUNCE = number("restitution", "Restitution", "0 to 1", { optional: true });
const THROWN_BACK = number("tangential_restitution", "Share of the slip turned back", "0 to 1", { optional: true });

export const CONNECTION_FIELDS = {
  pin: ENDS,
  weld: ENDS,
  "ball-joint": ENDS,
  slider: [...ENDS, number("slope", "Slope", "° or rad", { angle: true, optional: true }), vector("direction", "Direction", "", { optional: true, space: true })],
  rod: [...ENDS, number("length", "Length", "m", { optional: true }), number("drive", "Length driven by t", "m", { optional: true, open: true })],
  string: [{ name: "through", words: "Through", type: "through" }, { name: "sides", words: "Sides of drums", type: "sides" }, number("length", "Length", "m", { optional: true }), SMOOTH, number("turns", "Whole turns around its pegs", "", { optional: true }), BOUNCE],
  chain: [{ name: "through", words: "Through", type: "through" }, number("density", "Mass per length", "kg/m"), number("length", "Length", "m", { optional: true })],
  spring: [...ENDS, number("stiffness", "Stiffness", "N/m", { optional: true }), number("rest_length", "Length at rest", "m", { optional: true }), number("law", "Pull by formula", "N", { optional: true, open: true })],
  "torsion-spring": [...ENDS, number("stiffness", "Stiffness", "N m/rad"), number("rest_angle", "Angle at rest", "° or rad", { angle: true, optional: true })],
  damper: [...ENDS, number("coefficient", "Coefficient", "N s/m", { optional: true }), number("law", "Force by formula", "N", { optional: true, open: true })],
  contact: [place("place", "Of"), ...ENDS, SMOOTH, BOUNCE, THROWN_BACK],
  track: [place("place", "Of")],
  rolling: [place("place", "Of"), ...ENDS, check("inside", "Inside the other")],
  motor: [place("a", "Turns"), number("rate", "Rate", "rad/s", { optional: true, open: true }), number("drive", "Angle driven by t", "rad", { optional: true, open: true })],
  force: [place("place", "At"), vector("force", "Force", "N", { open: true }), choice("in", "Along the axes of", [["", "the ground"], ["body", "the body"]])],
  torque: [place("body", "On"), number("torque", "Torque", "N m", { open: true })],
  gravitation: [...ENDS, number("constant", "Constant", "m³/(kg s²)", { optional: true })],
  "inverse-square": [...ENDS, number("strength", "Strength", "N m²")],
  relation: [{ name: "of", words: "Formula", type: "text" }, number("equals", "Equals", "", { optional: true, open: true })],
  "spinning-frame": [number("rate", "Rate", "rad/s")],
  field: [],
  impulse: [place("place", "On"), place("body", "Or turns"), vector("impulse", "Impulse", "N s"), number("at", "At", "s", { optional: true, open: true })],
};

/** Between which a connection acts: times, or occasions as the description has them. */
export const SPAN_FIELDS = [number("from", "Acts from", "s", { optional: true, open: true }), number("until", "Acts until", "s", { optional: true, open: true })];

/** What acts all the time, or at one time. */
export const WITHOUT_SPAN = ["spinning-frame", "chain", "impulse"];

/** Of a face: its own, and those of everything that touches it. */
export const FACE_FIELDS = [
  vector("at", "Point on it", "m"),
  number("slope", "Slope", "° or rad", { angle: true, optional: true }),
  number("radius", "Radius", "m", { optional: true }),
];
export const TOUCH_FIELDS = [SMOOTH, BOUNCE];

/** What a connection on a face of the ground may be instead. */
export const ON_FACE = [["contact", "pushes, with friction"], ["rolling", "rolls without slipping"], ["track", "stays on it, without friction"]];

/** Of the scene as a whole. */
export const SCENE_FIELDS = [vector("gravity", "Gravity", "m/s²")];

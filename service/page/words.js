// What an answer says, in sentences.
import { degrees, superscript, written } from "./dom.js";

const STEADY = "steady rotation";

/** Whether two angles are written alike. */
const same = (a, b) => degrees(a) === degrees(b);

/** One sentence on how the body moves. */
export function motionInWords(answer) {
  const regime = answer.model.regime;
  const [least, largest] = answer.middle_axis_tilt || [];
  if (answer.warnings.some((w) => w.code === "unstable-axis")) {
    return "It spins steadily, but about an unstable axis: the slightest disturbance grows exponentially and turns the body over.";
  }
  if (regime.includes("rest")) return "It is at rest.";
  if (answer.tumbles && answer.flip_interval) return `It turns over every ${written(answer.flip_interval)} s: the angle between its middle axis and the angular momentum swings from ${degrees(least)} to ${degrees(largest)}.`;
  if (answer.tumbles) return "It turns over once and then comes ever closer to the unstable middle axis: this is the separatrix.";
  if (regime.includes(STEADY)) return "It spins steadily and stays so: the axis is stable.";
  const between = same(least, largest) ? `at ${degrees(least)}` : `between ${degrees(least)} and ${degrees(largest)}`;
  const range = least === undefined ? "" : ` The angle between its middle axis and the angular momentum stays ${between}.`;
  return `It wobbles about a stable axis and does not flip.${range}`;
}

/** Rows `[name, text]` of what is known of the motion. */
export function rowsOf(answer) {
  const rows = [["Regime", answer.model.regime], ["Period of ω in the body", answer.period === null ? "none" : `${written(answer.period, 8)} s`]];
  if (answer.tumbles && answer.flip_interval) rows.push(["Flip interval", `${written(answer.flip_interval, 8)} s`]);
  if (answer.middle_axis_tilt) {
    const [least, largest] = answer.middle_axis_tilt;
    rows.push(["Middle axis from L", same(least, largest) ? degrees(least) : `${degrees(least)} to ${degrees(largest)}`]);
  }
  rows.push(["Energy", `${written(answer.energy)} J`], ["Angular momentum", `${written(answer.angular_momentum)} kg m²/s`]);
  return rows;
}

const HOW = {
  "measured against pairs": "measured against a computation with twice as many digits",
  "closed form": "a bound, from the closed form",
  "measured against closed form": "measured against the closed form",
  "estimate (finer run)": "an estimate from a finer run",
};

/** What a stated error rests on. */
export const howInWords = (how) => HOW[how] || how;

/** The stated error, with what it rests on. */
export function accuracyInWords({ error, how, inherited }) {
  const own = error === 0 ? "no rounding at all" : `below ${power(error)} of the largest rate`;
  const from = inherited ? `; rounding of the inputs adds at most ${power(inherited)}` : "";
  return `${own} (${howInWords(how)})${from}`;
}

export function power(value) {
  const [mantissa, exponent] = value.toExponential(1).split("e");
  return `${mantissa}·10${superscript(Number(exponent))}`;
}

/** Stability of a spin about each principal axis, by the moments in their order. */
export function stabilities(moments) {
  const [low, middle, high] = [...moments].sort((a, b) => a - b);
  const same = (a, b) => Math.abs(a - b) <= 1e-12 * high;
  return moments.map((moment) => {
    if (same(low, high)) return "neutral";
    if (same(low, middle)) return same(moment, high) ? "stable" : "neutral";
    if (same(middle, high)) return same(moment, low) ? "stable" : "neutral";
    return same(moment, middle) ? "unstable" : "stable";
  });
}

/** What an integrator did: its error and what it cost, in a sentence. */
export function tradeInWords(answer, milliseconds) {
  const { work, accuracy } = answer;
  const counted = work.evaluations ? `${work.evaluations.toLocaleString("en")} evaluations in ${work.steps.toLocaleString("en")} steps` : "no steps";
  const time = milliseconds === null ? "" : `, ${written(milliseconds, 3)} ms`;
  const off = accuracy.error > 0.1 ? "It has left the motion" : "It is off";
  const drift = accuracy.drifts.energy;
  const lost = drift === undefined ? "" : ` The energy changes by ${written(100 * drift, 2)} %.`;
  return `${off} by ${power(accuracy.error)} of the largest rate, for ${counted}${time}.${lost}`;
}

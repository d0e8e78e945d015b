// What is sent about a scene so that it can be seen: its text with times and outputs, and where wanted with places that fit.
import { isNamed, movingQuestion } from "./named_scenes.js";

export const LONGEST = 20;
/** Time shown where a scene names a longer one (s). */

const OUTPUTS = ["accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time"];
const SAMPLES = 801, SAMPLES_LIVE = 201;
/** Samples of a motion; fewer while something is dragged. */

/** How long a scene's own times are (s); 2 where it has none. */
export function stopOf(value) {
  const { times } = value, given = Array.isArray(times) ? Math.max(...times) : times?.stop;
  return given > 0 ? given : 2;
}

/** Whether places may be moved so that they fit: a chain has its lengths from them, and what a reader has written about it stays. */
export const canAssemble = (value) => value.assemble === undefined && Boolean(value.connections?.length) && value.connections.every((c) => c?.kind !== "chain");

/** The question as text; `stop` is the time shown, `assemble` what may move. Numbers stay as they are written. */
export function questionOf(scene, name, { stop, live = false, assemble = null }) {
  const times = { start: 0, stop, count: live ? SAMPLES_LIVE : SAMPLES };
  if (isNamed(name)) return "times" in scene.value ? scene.with("/times", times).text : scene.text;
  let asked = scene.with("/times", times).with("/outputs", OUTPUTS);
  if (assemble) asked = asked.with("/assemble", assemble);
  return asked.text;
}

/** The text of a scene of the catalogue as it is opened. */
export const exampleText = (name, example, readable) => readable(isNamed(name) ? movingQuestion(name, example) : example);


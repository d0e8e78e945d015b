// Asks the service about a scene; where its places do not fit and may be moved, for the nearest that do.
import { Refusal } from "./api.js";
import { withAssembly } from "./scene_changes.js";
import { canAssemble, LONGEST, questionOf, stopOf } from "./scene_questions.js";
import { SceneText } from "./scene_text.js";

const MOST_PERIODS = 12;
/** A fast motion over a longer time would be a blur. */

/** Whether a refusal is about places that other places would mend. */
const misfits = (refusal) => refusal.errors.some(({ remedy, detail }) => /assemble/.test(remedy ?? "") || /hold together|satisfy|misse[sd]|are apart at the start|overlap/.test(detail));

/** What may move, from what is to stay to everything; `null` asks as the scene is written. */
function attemptsFor(value, how, held) {
  if (!canAssemble(value) || how === "text" || how === "open" || how === "undo") return [null];
  const others = Object.keys(value.bodies || {}).filter((name) => !held.includes(name));
  const some = held.length && others.length ? [{ nearest: others }] : [];
  return how === "drag" ? [...(some.length ? some : [null]), "nearest"] : [null, ...some, "nearest"];
}

/**
 * Ask; returns `{answer, scene, text}`, the scene with the places that were found. `held` are bodies that stay where they are if
 * they can. `stop` is the time shown, or null for one that fits.
 */
export async function answerScene(send, path, { scene, name, how, held = [], stop = null }) {
  const { value } = scene, live = how === "drag";
  if (value === null || typeof value !== "object" || Array.isArray(value)) throw new Refusal({ detail: "a scene is an object" });
  const attempts = attemptsFor(value, how, held);
  for (const [k, assemble] of attempts.entries()) {
    const ask = async (seconds) => {
      const text = questionOf(scene, name, { stop: seconds, live, assemble });
      return { text, answer: (await send(path, text)).answer };
    };
    try {
      let asked = await ask(stop ?? Math.min(stopOf(value), LONGEST));
      const { period } = asked.answer;
      if (stop === null && !live && period && stopOf(value) > MOST_PERIODS * period) asked = await ask(Number((MOST_PERIODS * period).toPrecision(3)));
      const fitted = asked.answer.assembly ? withAssembly(scene, asked.answer.assembly) : scene;
      return { ...asked, scene: fitted, text: fitted === scene ? asked.text : new SceneText(questionOf(fitted, name, { stop: stop ?? stopOf(value), live })).text };
    } catch (error) {
      if (!(error instanceof Refusal) || k === attempts.length - 1 || !misfits(error)) throw error;
    }
  }
  return null;
}

// "What must it be?": the value of a number of the scene with which something holds, found by the service.
import { Refusal, ask } from "./api.js";
import { $, make, written } from "./dom.js";
import { numberOf } from "./number_fields.js";
import { inWords, numbersOf } from "./scene_sliders.js";
import { valueAt } from "./scene_text.js";

const TIMES = 3;
/** How many times larger than the value as it is written the range that is offered may reach. */

/**
 * What can be asked of an answer, in words, each with the condition for a value; events of the motion as it is are among them.
 * @returns {[string, (value?: number) => object][]}
 */
export function conditionsOf(answer) {
  /** @type {[string, (value?: number) => object][]} */
  const found = [];
  for (const { kind, name } of answer.events ?? []) {
    const event = { kind, name }, what = `${kind}${name ? ` of ${name}` : ""}`;
    found.push([`${what} begins or ceases to happen`, () => ({ event, happens: true })], [`the time of ${what} (s) is`, (value) => ({ figure: { event }, equals: value })]);
  }
  if (answer.period) found.push(["the period (s) is", (value) => ({ figure: "/period", equals: value })], ["the period is infinite", () => ({ figure: "/period", infinite: true })]);
  for (const [name, { unit, determined }] of Object.entries(answer.forces ?? {})) {
    if (determined) found.push([`${name} at the start (${unit}) is`, (value) => ({ figure: `/forces/${name}/value`, equals: value })]);
  }
  found.push(["the degrees of freedom change", () => ({ figure: "/model/degrees_of_freedom", changes: true })]);
  const unique = new Map(found);
  return [...unique];
}

/** A range about a value that does not change its sign. */
export function rangeAbout(value) {
  if (value === 0) return [-1, 1];
  const near = Number((value / TIMES).toPrecision(2)), far = Number((value * TIMES).toPrecision(2));
  return value > 0 ? [near, far] : [far, near];
}

/** What was found, in words; without solutions, what comes nearest. */
export function foundInWords({ solutions, not_determined: throughout, nearest, complete, resolution, evaluations }, words) {
  const many = solutions.length === 1 ? "One value" : `${solutions.length} values`;
  const missed = complete ? "and it is proven that there are no others" : resolution ? `others closer together than ${written(Object.values(resolution)[0], 2)} may have been missed` : "";
  const asked = `${evaluations} answers were asked for`;
  if (solutions.length) return `${many} of ${words}; ${[missed, asked].filter(Boolean).join("; ")}.`;
  if (throughout?.length) return `It holds with every value of ${words} in a range; ${asked}.`;
  const inputs = nearest ? Object.values(nearest.values ?? {}) : [];
  return `No value of ${words} in this range${inputs.length ? `; ${written(inputs[0], 8)} comes nearest, with ${written(nearest.figure, 6)}` : ""}; ${asked}.`;
}

/** The form; `page` has `scene()` (a `SceneText` or null), `answer()`, `stop()` (the time shown), `set(pointer, text)`. */
export class FindBox {
  constructor(page) {
    this.page = page;
    this.conditions = [];
    this.running = null;
    $("find-vary").onchange = () => this.offerRange();
    $("find-until").onchange = () => { $("find-value-line").hidden = !this.takesValue(); };
    $("find-go").onclick = () => (this.running ? this.running.abort() : this.find());
  }

  takesValue() {
    return this.conditions[$("find-until").selectedIndex]?.[1].length === 1;
  }

  /** Offer the numbers and figures of the scene as it is, with what was chosen kept where it still is. */
  offer() {
    const scene = this.page.scene(), answer = this.page.answer();
    $("find").hidden = scene === null || answer === null;
    if ($("find").hidden) return;
    const fill = (select, options) => {
      const { value } = select;
      select.replaceChildren(...options.map(([key, words]) => make("option", { value: key, textContent: words })));
      if (options.some(([key]) => key === value)) select.value = value;
      return select.value !== value;
    };
    if (fill($("find-vary"), numbersOf(scene).map((pointer) => [pointer, inWords(pointer, scene.value)]))) this.offerRange();
    this.conditions = conditionsOf(answer);
    fill($("find-until"), this.conditions.map(([words]) => [words, words]));
    $("find-value-line").hidden = !this.takesValue();
  }

  offerRange() {
    const value = valueAt(this.page.scene().value, $("find-vary").value);
    [$("find-low").value, $("find-high").value] = rangeAbout(value).map(String);
  }

  async find() {
    const between = [numberOf($("find-low").value), numberOf($("find-high").value)], value = numberOf($("find-value").value);
    const say = (text) => { $("find-said").textContent = text; };
    $("find-found").replaceChildren();
    if (between.includes(null) || !(between[0] < between[1])) return say("The range is two numbers, the smaller one first.");
    if (this.takesValue() && value === null) return say("Write the value that it is to have.");
    const pointer = $("find-vary").value, words = $("find-vary").selectedOptions[0].textContent;
    const request = this.page.scene().with("/times", [this.page.stop()]).with("/outputs", ["forces"]).value;
    const until = this.conditions[$("find-until").selectedIndex][1](value);
    this.running = new AbortController();
    $("find-go").textContent = "Cancel";
    say("The service is looking…");
    try {
      const { answer } = await ask("/v1/find", { question: { path: "/v1/scenes", request }, vary: { pointer, between }, until }, this.running.signal);
      say(foundInWords(answer, words));
      $("find-found").replaceChildren(...answer.solutions.map((one) => {
        const found = one.values[pointer], error = one.errors[pointer];
        const button = make("button", { type: "button", textContent: `${written(found, 12)} ± ${written(error, 1)}` });
        button.onclick = () => this.page.set(pointer, String(found));
        return make("li", {}, button, ` ${one.kind}`);
      }));
    } catch (error) {
      say(this.running.signal.aborted ? "Cancelled." : error instanceof Refusal ? `${error.errors.map(({ detail }) => detail).join("; ")}.` : `The service cannot be reached (${error.message}).`);
    } finally {
      this.running = null;
      $("find-go").textContent = "Find";
    }
  }
}

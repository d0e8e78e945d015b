// An exercise: a link to a scene that asks for one figure and shows no results until an answer has been given.
import { Refusal, ask } from "./api.js";
import { $, make } from "./dom.js";
import { numberOf } from "./number_fields.js";
import { namesIn, pointerTo } from "./scene_text.js";

/** The figures of an answer that can be asked for, as pointer and words with a unit. */
export function figuresOf(answer) {
  const forces = Object.entries(answer.forces ?? {}).filter(([, { determined }]) => determined).map(([name, { unit }]) => [pointerTo("forces", name, "value"), `${name} at the start`, unit]);
  return [...(answer.period ? [["/period", "the period", "s"]] : []), ...forces];
}

/** The address of a page as an exercise about a figure, without what else stands before the hash. */
export function exerciseLink(href, figure) {
  const address = new URL(href);
  address.search = new URLSearchParams({ exercise: figure }).toString();
  return address.href;
}

/** What a verdict says to the one who answered. */
export function verdictInWords(verdict) {
  if (verdict === "correct") return "Right.";
  if (verdict === "incorrect") return "Not right yet.";
  return `This cannot be judged (${verdict}).`;
}

/** `page` has `scene()` (a `SceneText` or null), `answer()`, `stop()`. */
export class Exercise {
  constructor(page) {
    this.page = page;
    this.figure = new URLSearchParams(location.search).get("exercise");
    this.unit = null;
    this.tried = false;
    if (this.figure !== null && $("forces").checked) $("forces").click();
    document.body.classList.toggle("exercise", this.figure !== null);
    $("exercise").hidden = this.figure === null;
    $("exercise").onsubmit = (event) => { event.preventDefault(); this.check(); };
    $("exercise-show").onclick = () => this.reveal();
  }

  /** Offer the figures of the scene as it is, to be asked for; and in an exercise say what is asked. */
  offer() {
    const answer = this.page.answer(), figures = answer === null || this.page.scene() === null ? [] : figuresOf(answer);
    $("exercise-figure").replaceChildren(...figures.map(([pointer, words]) => make("option", { value: pointer, textContent: words })));
    $("take-exercise").disabled = !figures.length;
    const asked = figures.find(([pointer]) => pointer === this.figure);
    if (this.figure === null) return;
    [, , this.unit] = asked ?? [null, null, null];
    $("exercise-question").textContent = asked ? `What is ${asked[1]} (${asked[2]})?` : `This scene has no figure ${namesIn(this.figure).join(" ")}.`;
    $("exercise-check").disabled = !asked;
  }

  async check() {
    const value = numberOf($("exercise-value").value), say = (words) => { $("exercise-said").textContent = words; };
    if (value === null) return say("Write a number.");
    const request = this.page.scene().with("/times", [this.page.stop()]).with("/outputs", ["forces"]).value;
    const question = { path: "/v1/scenes", request };
    try {
      const { answer } = await ask("/v1/assessments", { question, submissions: [{ [this.figure]: { value, unit: this.unit } }], reveal: false });
      const { verdict } = answer.results[0].tests[0];
      say(verdictInWords(verdict));
      this.tried = true;
      $("exercise-show").hidden = false;
      if (verdict === "correct") this.reveal();
    } catch (error) {
      say(error instanceof Refusal ? `${error.errors.map(({ detail }) => detail).join("; ")}.` : `The service cannot be reached (${error.message}).`);
    }
  }

  /** Show the results, which an answer has been given for. */
  reveal() {
    if (!this.tried) return;
    document.body.classList.remove("exercise");
    if (!$("forces").checked) $("forces").click();
    $("exercise-show").hidden = true;
    dispatchEvent(new Event("resize"));
  }
}

// The equations of motion of what is shown, in the notation of mathematics; asked for only while they are seen.
import { Refusal, ask } from "./api.js";
import { $, make, written } from "./dom.js";

/** A formula as the browser draws it, with its text for those that cannot. */
function drawnFormula({ mathml, plain }) {
  const math = new DOMParser().parseFromString(mathml, "text/html").body.firstElementChild;
  if (!math) return make("code", { textContent: plain });
  math.setAttribute("display", "block");
  return math;
}

const list = (title, items) => (items.length ? [make("h3", { textContent: title }), make("ul", { className: "equations" }, ...items.map((item) => make("li", {}, ...[item].flat())))] : []);
const named = (formulas) => Object.entries(formulas).map(([name, formula]) => [make("span", { textContent: `${name} = ` }), drawnFormula(formula)]);

/** What an answer says of its equations, as elements. */
export function equationElements(found) {
  const coordinates = Object.entries(found.coordinates).map(([name, column]) => make("code", { textContent: column === null || column === name ? name : `${name} = ${column}` }));
  const constants = Object.entries(found.constants).map(([name, value]) => make("code", { textContent: `${name} = ${written(value, 10)}` }));
  const conserved = found.conserved.map((one) => [make("span", { textContent: `${one.name}, ${written(one.value, 8)}: ` }), drawnFormula(one)]);
  return [
    ...list("Coordinates", coordinates),
    ...(found.why.length ? [make("p", { className: "soft", textContent: `${found.why.join("; ")}.` })] : []),
    ...list("Equations of motion", found.equations.map(drawnFormula)),
    ...list("Constraints", found.constraints.map(drawnFormula)),
    ...list("Forces", named(found.forces)),
    ...(found.lagrangian ? list("Lagrangian", [drawnFormula(found.lagrangian)]) : []),
    ...list("Conserved", conserved),
    ...list("In closed form", named(found.closed_form)),
    ...list("Constants", constants),
  ];
}

/** The panel; `question()` is the scene as a `SceneText`, or null where it has no equations to show. */
export class EquationsPanel {
  constructor(question) {
    this.question = question;
    this.shown = "";
    $("equations").addEventListener("toggle", () => this.refresh());
  }

  /** Ask again if the panel is open and the scene is another one. */
  async refresh() {
    const scene = this.question();
    $("equations").hidden = scene === null;
    if (!$("equations").open || scene === null) return;
    const asked = scene.without("/times").without("/method").with("/outputs", ["equations"]).text;
    if (asked === this.shown) return;
    this.shown = asked;
    try {
      const { answer } = await ask("/v1/scenes", asked);
      if (this.shown !== asked) return;
      const words = "Mechanics does not decide which motion begins here.";
      $("equations-shown").replaceChildren(...(answer.equations ? equationElements(answer.equations) : [make("p", { textContent: words })]));
    } catch (error) {
      if (this.shown !== asked) return;
      this.shown = "";
      const why = error instanceof Refusal ? error.errors.map(({ detail }) => detail).join("; ") : error.message;
      $("equations-shown").replaceChildren(make("p", { className: "error", textContent: `No equations: ${why}.` }));
    }
  }
}

// What the answer of a scene says of itself: how it was computed, and its events.
import { $, make, written } from "./dom.js";
import { sayEvent } from "./headline.js";
import { howInWords, power } from "./words.js";

const MOST_EVENTS = 12;

/** Fill the panel "how this was computed". */
export function showModel(answer) {
  const m = answer.model, { accuracy } = answer;
  const freedom = `${m.degrees_of_freedom} degree${m.degrees_of_freedom === 1 ? "" : "s"} of freedom`;
  const list = [["Model", `${m.name}, ${freedom}`], ["Why", m.why], ["Period", answer.period ? `${written(answer.period, 10)} s` : "none"]];
  if (m.noticed?.length) list.push(["Noticed", m.noticed.join("; ")]);
  if (accuracy) list.push(["Accuracy", accuracy.error === 0 ? "exact" : `below ${power(accuracy.error)} of the largest value (${howInWords(accuracy.how)})`]);
  for (const [name, f] of Object.entries(answer.forces || {})) list.push([`${name}, at the start`, f.determined ? `${written(f.value, 8)} ${f.unit}` : "not determined"]);
  $("answer").replaceChildren(...list.flatMap(([name, text]) => [make("dt", { textContent: name }), make("dd", { textContent: text })]));
  $("warnings").replaceChildren(...answer.warnings.map((w) => make("p", { className: "notice", textContent: w.detail })));
}

/** The events as buttons that go to their time. */
export function showEvents(events, go) {
  const shown = events.slice(0, MOST_EVENTS).map((e) => {
    const button = make("button", { type: "button", textContent: `${written(e.time, 8)} s: ${sayEvent(e)}` });
    button.onclick = () => go(e.time);
    return make("li", {}, button);
  });
  if (events.length > MOST_EVENTS) shown.push(make("li", { textContent: `and ${events.length - MOST_EVENTS} more` }));
  $("events").replaceChildren(...shown);
}

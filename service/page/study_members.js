// One member of a study: its inputs and figures, its own request, and what the service says of it.
import { Refusal, ask, get } from "./api.js";
import { $, make, written } from "./dom.js";
import { namesIn, valueAt } from "./scene_text.js";

/** Before the name of a study that this tab has started, whose state does not repeat its question. */
const KEPT = "polhode-study-";
/** Members of a page of results: as many as the service gives at once. */
export const PAGE = 10000;

export const keepQuestion = (id, study) => sessionStorage.setItem(KEPT + id, JSON.stringify(study));

/** The request of a member, or null where the question was not started in this tab. */
function requestOf({ jobID }, inputs) {
  const study = JSON.parse(sessionStorage.getItem(KEPT + jobID) ?? "null");
  if (study === null) return null;
  const { request } = study.question;
  for (const { pointer, also = [] } of study.vary) {
    for (const place of [pointer, ...also]) {
      const names = namesIn(place), inner = valueAt(request, place.slice(0, place.lastIndexOf("/")));
      if (inner) inner[names.at(-1)] = inputs[pointer];
    }
  }
  return request;
}

/** Show one member of a study: what went in, what came out, and its request to open or to ask again. */
export async function openMember(state, member) {
  const page = await get(`/v1/studies/${state.jobID}/results?start=${member}&count=1`);
  const of = (columns) => Object.fromEntries(Object.entries(columns).map(([pointer, [value]]) => [pointer, value]));
  const inputs = of(page.inputs), figures = of(page.figures), request = requestOf(state, inputs), units = new Map([...state.inputs, ...state.figures].map(({ pointer, unit }) => [pointer, unit && unit !== "1" ? ` ${unit}` : ""]));
  const rows = Object.entries({ ...inputs, ...figures }).flatMap(([pointer, value]) => [make("dt", { textContent: pointer }), make("dd", { textContent: (typeof value === "number" || value === null ? written(value, 12) : JSON.stringify(value)) + units.get(pointer) })]);
  const said = make("p", { role: "status" }), scene = state.path === "/v1/scenes" && request !== null;
  const text = request === null ? [make("p", { className: "soft", textContent: "This study was started elsewhere: its question is where it was written." })]
    : [make("details", {}, make("summary", { textContent: "Its request" }), make("pre", { tabIndex: 0, textContent: `POST ${state.path}\n${JSON.stringify(request, null, 2)}` }))];
  const link = scene ? [make("p", {}, make("a", { href: `/scenes#scene=own&json=${encodeURIComponent(JSON.stringify(request))}`, textContent: "Open it as a scene" }))] : [];
  $("member").hidden = false;
  $("member").replaceChildren(make("h3", { textContent: `Member ${member}` }), make("dl", {}, ...rows), said, ...link, ...text);
  if (page.failures.length === 0) return;
  said.textContent = `Refused: ${page.failures[0].code}.`;
  if (request === null) return;
  try {
    await ask(state.path, request);
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    said.textContent = `Refused (${page.failures[0].code}): ${error.errors.map(({ pointer, detail }) => `${pointer} ${detail}`).join("; ")}.`;
  }
}

/** Why members were refused: each reason with how many, and one of them to open. */
export async function showRefusals(state, counts) {
  const examples = new Map(), reasons = Object.entries(counts ?? {});
  for (let start = 0; examples.size < reasons.length && start < state.count; start += PAGE) {
    for (const { code, member } of (await get(`/v1/studies/${state.jobID}/results?start=${start}&count=${PAGE}`)).failures) if (!examples.has(code)) examples.set(code, member);
  }
  $("refusals").hidden = reasons.length === 0;
  $("refusals").replaceChildren(...reasons.map(([code, count]) => {
    const open = make("button", { type: "button", textContent: `for example member ${examples.get(code)}` });
    open.onclick = () => openMember(state, examples.get(code));
    return make("li", {}, `${count} refused: ${code}, `, open);
  }));
}

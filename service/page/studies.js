// Studies: their progress as it comes, and maps, histograms and links of those that are finished.
import { ask, fetched, get } from "./api.js";
import { $, make, written } from "./dom.js";
import { Histogram } from "./histogram.js";
import { StudyMap, axisOf } from "./study_map.js";
import { PAGE, keepQuestion, openMember, showRefusals } from "./study_members.js";

const STUDIES = "/v1/studies";
const LARGEST_MAP = 250000;
const NAMES = { "application/json": ["JSON", "json"], "application/x-npz": ["npz", "npz"], "application/vnd.apache.parquet": ["Parquet", "parquet"], "application/vnd.zarr+zip": ["Zarr", "zarr.zip"], "text/csv": ["CSV", "csv"], "image/svg+xml": ["SVG", "svg"] };
const START = {
  question: { path: "/v1/rotation/precession", request: { body: { kind: "principal-moments", moments: [0.5, 0.8, 1.0] }, angular_velocity: [0.01, 1.0, 0.01] } },
  vary: [{ pointer: "/body/moments/0", min: 0.35, max: 0.65, count: 80 }, { pointer: "/body/moments/1", min: 0.68, max: 0.98, count: 80 }],
  quantities: ["/flip_interval", "/middle_axis_tilt/0"],
};
const rows = new Map();
const map = new StudyMap($("map"), $("hovered"), (member) => openMember(shown.state, member).catch(tell)), histogram = new Histogram($("histogram"));
let shown = null;

/** What tells a study from others of the same question: what is varied, how often, and when it was submitted. */
function titleOf(state) {
  const axes = state.inputs.map((axis) => axis.pointer).join(", ");
  return `${state.path}, ${axes}, ${new Date(state.created).toLocaleString([], { dateStyle: "short", timeStyle: "medium" })}`;
}

/** Show the state of a study in its row, which is made where it is missing. */
function show(state) {
  let row = rows.get(state.jobID);
  if (!row) {
    const open = make("button", { type: "button", textContent: "Show", "aria-label": `Show ${titleOf(state)}` });
    const drop = make("button", { type: "button", textContent: "Remove" });
    row = { open, drop, bar: make("progress", { max: state.count }), text: make("span") };
    row.item = make("li", {}, titleOf(state), " ", open, " ", row.bar, " ", row.text, " ", drop);
    open.addEventListener("click", () => results(row.state).catch(tell));
    drop.addEventListener("click", () => remove(row.state).catch(tell));
    rows.set(state.jobID, row);
    $("list").append(row.item);
  }
  row.state = state;
  row.bar.value = state.done;
  row.bar.setAttribute("aria-label", `${state.done} of ${state.count} members`);
  const seconds = Math.round((Date.parse(state.predicted_end) - Date.now()) / 1000);
  // Before the first members are done, most of the time goes to the start of processes, which no price has.
  const left = !state.predicted_end ? "" : state.done ? `, about ${Math.max(0, seconds)} s left` : ", starting";
  row.text.textContent = `${state.status}, ${state.done} of ${state.count} members${state.failed ? `, ${state.failed} refused` : ""}${left} ${state.message}`;
  row.open.disabled = state.status !== "successful";
  row.drop.textContent = state.predicted_end ? "Stop" : "Remove";
  $("none").hidden = rows.size > 0;
}

/** Show a study until it is finished or removed; its events would need a key that an EventSource cannot send. */
async function follow(state) {
  show(state);
  while (state.predicted_end) {
    await new Promise((later) => setTimeout(later, 500));
    if (!rows.get(state.jobID)?.state.predicted_end) return;
    state = await get(`${STUDIES}/${state.jobID}`);
    if (rows.has(state.jobID)) show(state);
  }
}

async function remove(state) {
  const response = await fetched(`${STUDIES}/${state.jobID}`, { method: "DELETE" });
  if (state.predicted_end && response.ok) return show(await response.json());
  rows.get(state.jobID).item.remove();
  rows.delete(state.jobID);
  $("none").hidden = rows.size > 0;
  if (shown?.state.jobID === state.jobID) $("shown").hidden = true;
}

/** Fetch what is drawn of a study: statistics, and the members of a map. */
async function results(state) {
  const path = `${STUDIES}/${state.jobID}/results`;
  const drawn = state.shape.length === 2 && Math.min(...state.shape) > 1 && state.count <= LARGEST_MAP;
  const pages = [await get(`${path}?count=${drawn ? PAGE : 1}`)];
  while (drawn && pages.at(-1).next) pages.push(await get(pages.at(-1).next));
  const column = (of, name) => pages.flatMap((page) => page[of][name]);
  shown = { state, drawn, statistics: pages[0].statistics.figures, column };
  $("shown").hidden = false;
  $("member").hidden = true;
  $("shown-title").textContent = `${state.path}, ${state.count} members`;
  $("figure").replaceChildren(...state.figures.map((f) => make("option", { value: f.pointer, textContent: f.pointer })));
  const offered = state.links.filter((one) => one.rel === "results");
  $("links").replaceChildren(...offered.flatMap((one) => [link(one, state.jobID), " "]));
  draw();
  await showRefusals(state, pages[0].statistics.failures);
}

function link({ href, type }, id) {
  const [name, extension] = NAMES[type] ?? [type, "bin"];
  const button = make("button", { type: "button", textContent: name });
  button.addEventListener("click", async () => {
    const response = await fetched(href, { headers: { accept: type } });
    if (!response.ok) return tell(new Error((await response.json()).detail));
    const place = URL.createObjectURL(await response.blob());
    make("a", { href: place, download: `${id}.${extension}` }).click();
    URL.revokeObjectURL(place);
  });
  return button;
}

function draw() {
  const { state, drawn, statistics } = shown;
  const figure = state.figures.find((f) => f.pointer === $("figure").value);
  const found = statistics[figure.pointer];
  const unit = figure.unit && figure.unit !== "1" ? figure.unit : "";
  const said = [["mean", found.mean], ["standard deviation", found.std], ["smallest", found.min?.value], ["largest", found.max?.value]];
  $("numbers").textContent = `${found.present} members have this figure; ${said.filter(([, x]) => x != null).map(([name, x]) => `${name} ${written(x)}${unit && ` ${unit}`}`).join(", ")}`;
  $("map").hidden = $("hovered").hidden = !drawn;
  $("hovered").textContent = "Grey cells have no value. A press opens the member.";
  if (drawn) drawMap(shown, figure.pointer, found, unit);
  $("histogram").hidden = !found.histogram;
  if (found.histogram) histogram.show(found.histogram, figure.pointer, unit);
}

/** The levels of both axes are those of the members in their order, the second one fastest. */
function drawMap({ state, column }, figure, { min, max }, unit) {
  const [slow, fast] = state.inputs.map(({ pointer }) => column("inputs", pointer)), [n, m] = state.shape;
  const axes = { slow: axisOf(state.inputs[0], slow.filter((_, k) => k % m === 0).slice(0, n)), fast: axisOf(state.inputs[1], fast.slice(0, m)) };
  map.show({ ...axes, values: column("figures", figure), low: min?.value ?? 0, high: max?.value ?? 1, unit, name: figure });
}

function tell(error) {
  $("problem").textContent = error.errors?.map((fault) => `${fault.pointer} ${fault.detail}`).join("; ") || error.message;
}

async function send(work) {
  $("problem").textContent = $("told").textContent = "";
  await work($("editor").value).catch(tell);
}

$("editor").value = JSON.stringify(START, null, 2);
$("figure").addEventListener("change", draw);
$("price").addEventListener("click", () => send(async (text) => {
  const { answer } = await ask("/v1/plan", { path: STUDIES, request: JSON.parse(text) });
  // The study is the request of the plan.
  const errors = answer.errors?.map((fault) => ({ ...fault, pointer: fault.pointer.replace(/^\/request(?=\/|$)/, "") }));
  if (answer.answerable === false) throw Object.assign(new Error(), { errors });
  $("told").textContent = `${answer.cost.members} members; ${answer.why}`;
}));
$("start").addEventListener("click", () => send(async (text) => {
  const { answer } = await ask(STUDIES, text);
  follow(answer).catch(tell);
  keepQuestion(answer.jobID, JSON.parse(text));
}));
get(STUDIES).then(({ studies }) => studies.forEach((state) => follow(state).catch(tell)), tell).finally(() => { document.body.dataset.ready = "yes"; });

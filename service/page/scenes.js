// Scenes in motion: those of the catalogue, changed by sliders or as JSON.
import { Refusal, Worker, get } from "./api.js";
import { $, make, written } from "./dom.js";
import { NotJson, placeOf, readJson } from "./json_places.js";
import { drawn, isNamed, movingQuestion } from "./named_scenes.js";
import { mark, numberOf } from "./number_fields.js";
import { PlaneView } from "./plane_view.js";
import { Player } from "./player.js";
import { TimeChart } from "./plots.js";
import { readable, requestPanel } from "./request_panel.js";
import { SceneModel } from "./scene_model.js";
import { markFaults, replaced, sliders } from "./scene_sliders.js";
import { SpaceView } from "./space_view.js";
import { readState, writeState } from "./url_state.js";
import { howInWords, power } from "./words.js";

const sentence = (text) => text.replace(/^./, (c) => c.toUpperCase());
const titled = (name) => sentence(name.replaceAll("-", " "));

/** Under which heading a scene of the catalogue is listed. */
function kindOf({ name, example }) {
  if (isNamed(name)) return "With endpoints of their own";
  if (Object.values(example.bodies)[0].at?.length === 3) return "In space";
  return example.connections?.some((c) => c.kind === "contact") ? "In the plane, with contacts" : "In the plane";
}

const SAMPLES = 801, LONGEST = 20, MOST_EVENTS = 12;
const OUTPUTS = ["accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time"];
const state = { scene: "double-pendulum", text: "", own: false, window: null };
let catalogue = new Map(), model = null, answer = null, view = null, space = null, busy = false, again = false;

const plane = new PlaneView($("plane-view"));
const player = new Player($("player"));
const chart = new TimeChart($("chart"), player, "Curves", 190);
const worker = new Worker($("progress"));
const showRequests = requestPanel($("request"));

player.onTime((time) => {
  if (!model) return;
  model.seek(time);
  view === space ? view?.update() : plane.render();
});
$("scene").onchange = () => choose($("scene").value);
$("forces").onchange = () => { plane.showForces = $("forces").checked; if (space) space.showForces = plane.showForces; player.show(); };
$("curves").onchange = () => showCurves();
$("editor").oninput = () => { clearTimeout(state.timer); state.timer = setTimeout(() => edited($("editor").value, true), 300); };
$("window").onchange = () => {
  const value = numberOf($("window").value), wrong = $("window").value.trim() !== "" && !(value > 0);
  mark($("window"), wrong);
  $("window-error").textContent = wrong ? "A time above 0, or nothing for a time that fits the scene." : "";
  if (!wrong) { state.window = value; refresh(); }
};
document.querySelector("form").addEventListener("submit", (event) => event.preventDefault());

function choose(name, text = null) {
  const entry = catalogue.get(name);
  state.scene = name;
  state.window = null;
  $("window").value = "";
  $("scene").value = name;
  $("language").href = isNamed(name) ? "/docs" : "/docs#/scenes/described_scene";
  player.time = 0;
  const example = isNamed(name) ? movingQuestion(name, entry.example) : entry.example;
  edited(text ?? readable(example), text !== null);
  state.own = text !== null;
}

/** What is shown: the scene that was chosen, or what the reader has made of it. */
const titleNow = () => (state.own ? `Changed from “${titled(state.scene)}”` : sentence(catalogue.get(state.scene).summary));

/** Take a new text: sliders, picture and messages follow. */
function edited(text, own, rebuild = true) {
  state.text = text;
  state.own = own;
  $("about").textContent = `${titleNow()}.`;
  if ($("editor").value !== text) $("editor").value = text;
  try {
    state.read = readJson(text);
  } catch (error) {
    if (!(error instanceof NotJson)) throw error;
    const line = text.slice(0, error.offset).split("\n").length;
    return complain([{ pointer: null, detail: `this is not JSON yet, in line ${line}: ${error.message}`, place: [error.offset, error.offset + 1] }]);
  }
  if (rebuild) sliders($("sliders"), $("place-sliders"), state.read, (pointer, next) => edited(replaced(state.text, state.read.places, pointer, next), true, false));
  return refresh();
}

async function refresh() {
  if (busy) { again = true; return; }
  setBusy(true);
  do {
    again = false;
    save();
    try {
      await answerState();
    } catch (error) {
      complain(error instanceof Refusal ? error.errors : [{ pointer: "", detail: `The service cannot be reached (${error.message}).` }]);
    }
  } while (again);
  setBusy(false);
}

/** The text with what the picture needs in place of `times` and `outputs`; numbers stay as they are written. */
function questionText(stop) {
  const { value, places } = state.read;
  const times = `{"start": 0, "stop": ${stop}, "count": ${SAMPLES}}`;
  if (isNamed(state.scene)) return "times" in value ? replaced(state.text, places, "/times", times) : state.text;
  const outputs = JSON.stringify(OUTPUTS);
  const add = [["times", times], ["outputs", outputs]];
  let text = state.text;
  for (const [name, content] of add.filter(([name]) => name in value).sort((a, b) => placeOf(places, `/${b[0]}`)[0] - placeOf(places, `/${a[0]}`)[0])) text = replaced(text, places, `/${name}`, content);
  const missing = add.filter(([name]) => !(name in value)).map(([name, content]) => `"${name}": ${content}`);
  const end = text.lastIndexOf("}");
  return missing.length ? `${text.slice(0, end).trimEnd()}${Object.keys(value).length ? "," : ""}\n  ${missing.join(",\n  ")}\n}` : text;
}

function stopOf(value) {
  const { times } = value;
  const given = Array.isArray(times) ? Math.max(...times) : times?.stop;
  return given > 0 ? given : 2;
}

function setBusy(now) {
  busy = now;
  document.querySelector(".stage").setAttribute("aria-busy", String(now));
}

async function answerState() {
  const { value } = state.read, path = catalogue.get(state.scene).path;
  if (value === null || typeof value !== "object" || Array.isArray(value)) throw new Refusal({ detail: "a scene is an object" });
  const wanted = stopOf(value);
  const result = await worker.run(async (send) => {
    let stop = state.window ?? Math.min(wanted, LONGEST);
    let text = questionText(stop), asked = await send(path, text);
    const { period } = asked.answer;
    // A fast motion over a long time would be a blur: some periods are shown.
    if (state.window === null && period && stop > 12 * period) {
      stop = Number((12 * period).toPrecision(3));
      text = questionText(stop);
      asked = await send(path, text);
    }
    return { answer: asked.answer, text, path };
  });
  if (!result) return complain([{ pointer: "", detail: "Cancelled: the picture is of the answer before" }]);
  complain([]);
  show(result);
}

function show({ answer: next, text, path }) {
  answer = next;
  const value = JSON.parse(text);
  const { description, trajectory } = isNamed(state.scene) ? drawn(state.scene, value, answer) : { description: value, trajectory: answer.trajectory };
  answer.shown = trajectory;
  model = new SceneModel(description, trajectory);
  showView();
  const time = trajectory?.time || [0], events = (answer.events || []).map((e) => ({ ...e, label: sayEvent(e) }));
  const stop = Math.max(time.at(-1), ...events.map((e) => e.time || 0)), still = !(stop > 0);
  for (const name of ["player", "curves-line", "chart"]) $(name).hidden = still;
  player.setSpan(stop || 1, Math.max(4, Math.min(15, 3 * stop)), events);
  $("window").placeholder = still ? "" : written(stop, 4);
  tell(events);
  fillCurves();
  showRequests({ "the motion": [path, value] });
}

function showView() {
  $("plane-view").hidden = model.space;
  $("space-view").hidden = !model.space;
  if (model.space) {
    space ??= new SpaceView($("space-view"));
    space.showForces = $("forces").checked;
    view = space;
  } else view = plane;
  view.show(model);
  $("force-scale").textContent = model.forceScale ? `The longest is ${written(model.forceScale, 3)} N.` : "";
}

function tell(events) {
  const m = answer.model, accuracy = answer.accuracy, moving = model.bodies.map((b) => b.name).join(", ");
  const span = $("player").hidden ? "" : ` over ${written(player.stop, 4)} s`;
  const last = answer.ended && answer.ended !== "horizon" ? events.at(-1) : null;
  const ended = last ? ` It ends at ${written(last.time, 8)} s: ${sayEvent(last)}.` : events.length ? ` ${events.length} event${events.length === 1 ? "" : "s"} on the way.` : "";
  const words = `${moving}: ${m.name}, ${m.degrees_of_freedom} degree${m.degrees_of_freedom === 1 ? "" : "s"} of freedom${span}.${ended}`;
  $("summary").textContent = words;
  for (const canvas of [$("plane-canvas"), $("space-canvas")]) canvas.setAttribute("aria-label", `${titleNow()}. ${words}`);
  const list = [["Model", m.name], ["Why", m.why], ["Period", answer.period ? `${written(answer.period, 10)} s` : "none"]];
  if (m.noticed?.length) list.push(["Noticed", m.noticed.join("; ")]);
  if (accuracy) list.push(["Accuracy", accuracy.error === 0 ? "exact" : `below ${power(accuracy.error)} of the largest value (${howInWords(accuracy.how)})`]);
  for (const [name, f] of Object.entries(answer.forces || {})) list.push([`${name}, at the start`, f.determined ? `${written(f.value, 8)} ${f.unit}` : "not determined"]);
  $("answer").replaceChildren(...list.flatMap(([name, text]) => [make("dt", { textContent: name }), make("dd", { textContent: text })]));
  $("warnings").replaceChildren(...answer.warnings.map((w) => make("p", { className: "notice", textContent: w.detail })));
  const shown = events.slice(0, MOST_EVENTS).map((e) => {
    const button = make("button", { type: "button", textContent: `${written(e.time, 8)} s: ${sayEvent(e)}` });
    button.onclick = () => { player.pause(); player.seek(e.time); };
    return make("li", {}, button);
  });
  if (events.length > MOST_EVENTS) shown.push(make("li", { textContent: `and ${events.length - MOST_EVENTS} more` }));
  $("events").replaceChildren(...shown);
}

const EVENTS = {
  touch: "touches", "lift-off": "lifts off", slip: "begins to slip", stick: "sticks", roll: "rolls without slip", settle: "has come to rest after ever smaller bounces",
  taut: "becomes taut", slack: "goes slack", stop: "reaches its stop", release: "leaves its stop", singular: "has come to a length of zero",
  "no-motion": "has no possible motion", "several-motions": "has several possible motions", "end-of-chain": "has come to its end",
};

const sayEvent = (event) => `${event.name} ${EVENTS[event.kind] || event.kind.replaceAll("-", " ")}`.trim();

const varies = ({ data }) => data.some((x) => x !== data[0]);

/** Groups of columns of one unit, to choose from. */
function fillCurves() {
  const groups = new Map();
  for (const [name, { unit, values }] of Object.entries(answer.shown?.columns || {})) {
    const vector = Array.isArray(values[0]);
    const kind = { m: "Positions (m)", "m/s": "Velocities (m/s)", rad: "Angles (rad)", "rad/s": "Angular velocities (rad/s)", N: "Forces (N)", "N m": "Torques (N m)", J: "Energies (J)", 1: "Attitudes" }[unit] || unit;
    if (!groups.has(kind)) groups.set(kind, []);
    const list = groups.get(kind);
    if (vector) values[0].forEach((_, k) => list.push({ label: `${name.replace(".position", "").replace(".velocity", "")} ${unit === "1" && values[0].length === 4 ? "wxyz"[k] : "xyz"[k]}`, data: values.map((v) => v[k]) }));
    else list.push({ label: name, data: values });
  }
  answer.groups = groups;
  const before = $("curves").value;
  $("curves").replaceChildren(...[...groups.keys()].map((kind) => make("option", { textContent: kind })));
  if (groups.has(before)) $("curves").value = before;
  else $("curves").value = ["Angles (rad)", ...groups.keys()].find((kind) => groups.get(kind)?.some(varies)) ?? [...groups.keys()][0] ?? "";
  showCurves();
}

function showCurves() {
  const list = answer?.groups.get($("curves").value);
  if (!list) return chart.clear();
  const colors = ["deep", "warm", "third", "stable", "separatrix", "soft"];
  const series = list.slice(0, 12).map(({ label }, i) => ({ label, color: colors[i % 6], dash: i < 6 ? undefined : [6, 4] }));
  chart.show(series, [answer.shown.time, ...list.slice(0, 12).map((c) => c.data)]);
  $("chart").setAttribute("aria-label", `${$("curves").value} over time: ${series.map((s) => s.label).join(", ")}`);
}

/** Write every fault at its slider and above the text, where a press selects its place in the text. */
function complain(faults) {
  const places = state.read?.places || new Map();
  const rest = markFaults([$("sliders"), $("place-sliders")], faults);
  $("problem").textContent = rest.filter((f) => f.pointer === "").map((f) => `${f.detail}.`).join(" ");
  mark($("editor"), faults.length > 0);
  document.querySelector(".stage").classList.toggle("stale", faults.length > 0);
  $("faults").replaceChildren(...faults.map((fault) => {
    const button = make("button", { type: "button", className: "fault", textContent: `${fault.pointer || "scene"}: ${[fault.detail, fault.remedy].filter(Boolean).join("; ")}` });
    button.onclick = () => {
      const [start, end] = fault.place || placeOf(places, fault.pointer || "");
      $("editor").focus();
      $("editor").setSelectionRange(start, end);
    };
    return make("li", {}, button);
  }));
}

function save() {
  writeState({ scene: state.scene, window: state.window, json: state.own ? state.text : null });
}

function restore() {
  const given = readState();
  const name = catalogue.has(given.scene) ? given.scene : "double-pendulum";
  choose(name, given.json || null);
  if (Number(given.window) > 0) {
    state.window = Number(given.window);
    $("window").value = state.window;
  }
}

const { scenes } = await get("/v1/scenes");
catalogue = new Map(scenes.map((scene) => [scene.name, scene]));
$("scene").replaceChildren(...[...Map.groupBy(scenes, kindOf)].map(([label, entries]) => make("optgroup", { label }, ...entries.map(({ name }) => make("option", { value: name, textContent: titled(name) })))));
restore();
await new Promise((done) => { const wait = () => (model || $("problem").textContent ? done() : setTimeout(wait, 20)); wait(); });
player.begin();
await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
document.body.dataset.ready = "yes";
addEventListener("hashchange", restore);

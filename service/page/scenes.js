// Scenes in motion: built by hand, changed by handles, sliders or as JSON.
import { Refusal, Worker, ask, get } from "./api.js";
import { showEvents, showModel } from "./answer_words.js";
import { Board } from "./board.js";
import { CurveChoice } from "./curve_choice.js";
import { $, make, written } from "./dom.js";
import { EquationsPanel } from "./equations_panel.js";
import { Exercise } from "./exercise.js";
import { FindBox } from "./find_box.js";
import { facesAt, faultInWords, partOf } from "./impossible.js";
import { Gallery } from "./gallery.js";
import { headline, sayEvent } from "./headline.js";
import { Inspector } from "./inspector.js";
import { placeOf } from "./json_places.js";
import { Live } from "./live.js";
import { drawn, isNamed } from "./named_scenes.js";
import { Measures } from "./measures.js";
import { mark, numberOf } from "./number_fields.js";
import { Palette } from "./palette.js";
import { showParts } from "./parts_list.js";
import { PlaneView } from "./plane_view.js";
import { Player } from "./player.js";
import { TimeChart } from "./plots.js";
import { readable, requestPanel } from "./request_panel.js";
import { selectionActions } from "./selection_actions.js";
import { answerScene } from "./scene_answers.js";
import { NOTHING, NOTHING_IN_SPACE, SceneDocument } from "./scene_document.js";
import { listenForKeys, listenForUndo } from "./scene_keys.js";
import { SceneModel } from "./scene_model.js";
import { exampleText } from "./scene_questions.js";
import { markFaults, sliders } from "./scene_sliders.js";
import { SpaceBoard } from "./space_board.js";
import { SpaceView } from "./space_view.js";
import { takeAway } from "./take_away.js";
import { readState, writeState } from "./url_state.js";

const sentence = (text) => text.replace(/^./, (c) => c.toUpperCase());
const titled = (name) => catalogue.get(name).title;
const METHOD_STEPS = 1000;
/** Steps of a method beside the exact motion: few enough that its error is seen. */

const OWN = "own";
/** What the list calls a scene that is nobody's but the reader's. */

const state = { scene: "double-pendulum", changed: false, window: null };
let catalogue = new Map(), model = null, answer = null, view = null, space = null, timer = null;

const doc = new SceneDocument(changed);
const plane = new PlaneView($("plane-view"));
const player = new Player($("player"));
const chart = new TimeChart($("chart"), player, "Curves", 190);
const curves = new CurveChoice(chart, player);
const worker = new Worker($("progress"));
const live = new Live(refresh, () => worker.stop());
const showRequests = requestPanel($("request"));

const say = (words) => { $("said").textContent = words; };
const embedded = new URLSearchParams(location.search).get("embed") === "1";
const ready = () => doc.sound && !isNamed(state.scene) && !embedded;
const atStart = () => !player.playing && player.time === 0;
const board = new Board({ doc, view: plane, say, ready, atStart, start: toStart, selected: showSelection, dropped, rename: renameInPlace });
const inspector = new Inspector($("inspector"), { doc, board, edit, rename });
const palette = new Palette($("palette"), $("connect"), { board, say });
new Measures({ view: plane, panel: $("measures"), say });
const act = selectionActions({ doc, board, say, start: toStart, selected: showSelection });

player.onTime((time) => {
  if (!model) return;
  model.seek(time);
  view === space ? view?.update() : plane.render();
});

for (const name of ["forces", "velocities", "accelerations", "values", "trails", "ghosts", "names"]) {
  $(name).onchange = () => look();
}
function look() {
  const on = (name) => $(name).checked;
  plane.look = { forces: on("forces"), velocities: on("velocities"), accelerations: on("accelerations"), values: on("values"), trails: on("trails"), names: on("names"), ghosts: on("ghosts") ? 8 : 0 };
  if (space) space.showForces = on("forces");
  player.show();
}

const described = () => (doc.sound && !isNamed(state.scene) && Object.keys(doc.scene.value.bodies ?? {}).length ? doc.scene : null);
const equations = new EquationsPanel(described);
const asked = { scene: described, answer: () => answer, stop: () => player.stop };
const exercise = new Exercise(asked);
const findBox = new FindBox({
  ...asked,
  set: (pointer, text) => { edit("Value taken", doc.scene.withSource(pointer, text)); },
});

const gallery = new Gallery((name) => choose(name));
takeAway({
  player, say, name: () => (state.scene === OWN ? "scene" : state.scene), title: () => titleNow(), text: () => doc.text, trajectory: () => answer?.shown ?? null,
  canvas: () => $(model?.space ? "space-canvas" : "plane-canvas"), request: () => [state.scene === OWN ? "/v1/scenes" : catalogue.get(state.scene).path, doc.scene.value],
  svg: () => (model?.space ? null : plane.svg(titleNow())), render: () => (model?.space ? space.draw() : plane.draw()),
});
document.body.classList.toggle("embed", embedded);
$("browse").onclick = () => gallery.open();
$("scene").onchange = () => choose($("scene").value);
$("new").onclick = () => { choose(OWN); say("A new scene. Drag parts from the palette into the picture."); };
$("new-space").onclick = () => { choose(OWN, NOTHING_IN_SPACE); say("A new scene in space. Choose parts from the palette; drag them in the picture, with Shift up and down."); };
$("open-file").onclick = () => $("file").click();
$("file").onchange = () => { openFile($("file").files[0]); $("file").value = ""; };
$("undo").onclick = () => act.undo();
$("redo").onclick = () => act.redo();
$("delete").onclick = () => act.remove();
$("duplicate").onclick = () => act.duplicate();
$("stand").onclick = () => act.stand();
$("closer").onclick = () => plane.zoom(1.25);
$("farther").onclick = () => plane.zoom(0.8);
$("fit").onclick = () => plane.fit(model?.bodies.length ? model.bounds() : { low: [-2, -1.25], high: [2, 1.25] });
$("editor").oninput = () => { clearTimeout(timer); timer = setTimeout(() => doc.change("JSON edited", { text: $("editor").value, how: "text", run: "editor" }), 300); };
$("window").onchange = () => {
  const value = numberOf($("window").value), wrong = $("window").value.trim() !== "" && !(value > 0);
  mark($("window"), wrong);
  $("window-error").textContent = wrong ? "A time above 0, or nothing for a time that fits the scene." : "";
  if (!wrong) { state.window = value; live.ask("open"); }
};
for (const form of document.querySelectorAll("form")) form.addEventListener("submit", (event) => event.preventDefault());
listenForKeys($("plane-canvas"), { px: () => board.px, act: { ...act, rename: () => inspector.focusName(), nothing: escape, finish: () => board.finish(), closer: () => plane.zoom(1.25), farther: () => plane.zoom(0.8), play: () => player.button.click() } });
listenForKeys($("parts"), { px: () => board.px, act: { ...act, rename: () => inspector.focusName(), nothing: escape }, except: ["Enter", " ", "+", "-"] });
listenForUndo(act);
document.addEventListener("dragover", (event) => { event.preventDefault(); $("plane-view").classList.add("dropping"); });
document.addEventListener("dragleave", () => $("plane-view").classList.remove("dropping"));
document.addEventListener("drop", (event) => {
  event.preventDefault();
  $("plane-view").classList.remove("dropping");
  openFile(event.dataTransfer.files[0]);
});

function escape() {
  if (board.tool) board.use(null);
  else { doc.selection.clear(); showSelection(); }
}

async function openFile(file) {
  if (!file) return;
  choose(OWN, await file.text());
  say(`${file.name} opened.`);
}

/** Show a scene of the catalogue, or one of the reader's own. */
function choose(name, text = null, waiting = []) {
  const entry = catalogue.get(name);
  Object.assign(state, { scene: name, window: null, changed: text !== null && name !== OWN });
  $("window").value = "";
  $("scene").value = name;
  $("language").href = isNamed(name) ? "/docs" : "/docs#/scenes/described_scene";
  player.time = 0;
  board.use(null);
  doc.open(text ?? (name === OWN ? NOTHING : exampleText(name, entry.example, readable)), waiting);
}

/** What is shown: the scene that was chosen, or what the reader has made of it. */
const titleNow = () => (state.scene === OWN ? "A scene of your own" : state.changed ? `Changed from “${titled(state.scene)}”` : sentence(catalogue.get(state.scene).summary));

/** The document has changed: everything that shows it follows. */
function changed(how) {
  if (how !== "open") state.changed = true;
  $("about").textContent = `${titleNow()}.`;
  if ($("editor").value !== doc.text) $("editor").value = doc.text;
  $("undo").disabled = doc.past.length === 0;
  $("redo").disabled = doc.future.length === 0;
  if (doc.fault) return complain([{ pointer: null, ...doc.fault }]);
  if (!doc.sound) return live.ask(how);
  if (how !== "slider" && how !== "drag") sliders($("sliders"), $("place-sliders"), doc.scene, (pointer, next) => doc.change("slider moved", { scene: doc.scene.withSource(pointer, next), how: "slider", run: `slider ${pointer}` }));
  palette.offer(board.space);
  showSelection();
  return live.ask(how);
}

function edit(words, scene, run = null) {
  toStart();
  doc.change(words, { scene, how: "edit", run });
  say(`${words}.`);
}

/** Rename a part; returns what is wrong with the name. */
function rename(id, name) {
  const problem = act.rename(id, name);
  if (!problem) say(`Called ${name} now.`);
  return problem;
}

/** A field for the name where the part is. */
function renameInPlace(id, event) {
  const box = $("plane-view").getBoundingClientRect(), input = make("input", { className: "rename", value: id.slice(id.indexOf(":") + 1), "aria-label": "Name", autocomplete: "off" });
  if (id.startsWith("face:")) return;
  input.style.left = `${event.clientX - box.left}px`;
  input.style.top = `${event.clientY - box.top}px`;
  const done = (take) => {
    // Taking the field away takes the cursor from it, which would come here again.
    input.onblur = null;
    const problem = take ? rename(id, input.value.trim()) : null;
    if (problem) say(problem);
    input.remove();
  };
  input.onkeydown = (e) => { if (e.key === "Enter" || e.key === "Escape") done(e.key === "Enter"); e.stopPropagation(); };
  input.onblur = () => done(true);
  $("plane-view").append(input);
  input.focus();
  input.select();
}

/** Something was let go: it is asked about once more, exactly, and said where it has come to. */
async function dropped(words) {
  await live.ask("build");
  say(`${words()}.`);
}

function toStart() {
  player.pause();
  player.seek(0);
}

/** Mark what is selected, everywhere. */
function showSelection() {
  if (!doc.sound) return;
  const { parts } = board, known = new Set(parts.map(({ id }) => id));
  for (const id of [...doc.selection]) if (!known.has(id)) doc.selection.delete(id);
  plane.lit = new Set(doc.selection);
  for (const face of parts.filter(({ id, kind }) => kind === "face" && doc.selection.has(id))) for (const { id, index } of parts) if (face.members.includes(index)) plane.lit.add(id);
  $("delete").disabled = $("duplicate").disabled = $("stand").disabled = doc.selection.size === 0 || !ready();
  showParts($("parts"), parts, { value: doc.scene.value, selection: doc.selection, wrong: plane.wrong, pick: act.pick });
  inspector.show();
  plane.render();
  space?.mark(doc.selection);
}

/** Ask about the scene as it is now, and show the answer. */
async function refresh(how) {
  document.querySelector(".stage").setAttribute("aria-busy", "true");
  save();
  const { scene } = doc, { value } = scene;
  try {
    if (!isNamed(state.scene) && doc.sound && value.bodies && !Object.keys(value.bodies).length) showNothing();
    else {
      const held = board.gesture || how === "build" ? board.held ?? [] : [];
      const path = state.scene === OWN ? "/v1/scenes" : catalogue.get(state.scene).path;
      const result = await worker.run((send) => answerScene(send, path, { scene, name: state.scene, how, held, stop: state.window ?? (how === "drag" ? player.stop : null) }));
      if (result) take(result, how, scene, path);
      else if (live.next === null) complain([{ pointer: "", detail: "Cancelled: the picture is of the answer before" }]);
    }
  } catch (error) {
    if (live.next === null || how === "drag") complain(error instanceof Refusal ? error.errors : [{ pointer: "", detail: `The service cannot be reached (${error.message})` }]);
    if (how !== "text" && doc.sound) sketch(how);
  }
  document.querySelector(".stage").setAttribute("aria-busy", "false");
}

function take(result, how, asked, path) {
  if (doc.scene === asked && result.scene !== asked) {
    doc.complete(result.scene);
    $("editor").value = doc.text;
    if (how !== "drag") showSelection();
  }
  complain([]);
  show(result, how, path);
}

/** Where nothing can be computed, what is described is shown as it stands. */
function sketch(how) {
  if (isNamed(state.scene)) return;
  answer = null;
  model = new SceneModel(doc.scene.value, null);
  showView(how);
  player.setSpan(player.stop, 4);
}

function showNothing() {
  complain([]);
  answer = null;
  model = new SceneModel(doc.scene.value, null);
  showView("open");
  $("player").hidden = $("curves-line").hidden = true;
  curves.offer(null);
  $("summary").textContent = "Nothing here yet: drag a part from the palette into the picture.";
  for (const name of ["answer", "warnings", "events"]) $(name).replaceChildren();
  $("plane-canvas").setAttribute("aria-label", $("summary").textContent);
}

function show({ answer: next, text }, how, path) {
  answer = next;
  const value = JSON.parse(text);
  const { description, trajectory } = isNamed(state.scene) ? drawn(state.scene, value, answer) : { description: value, trajectory: answer.trajectory };
  answer.shown = trajectory;
  model = new SceneModel(description, trajectory, answer.events);
  const time = trajectory?.time || [0], events = (answer.events || []).map((e) => ({ ...e, label: sayEvent(e) }));
  const stop = Math.max(time.at(-1), ...events.map((e) => e.time || 0)), still = !(stop > 0);
  $("player").hidden = $("curves-line").hidden = still;
  showView(how);
  player.setSpan(stop || 1, Math.max(4, Math.min(15, 3 * stop)), events);
  $("window").placeholder = still ? "" : written(stop, 4);
  tell(events);
  curves.offer(still ? null : trajectory);
  if (how !== "drag") {
    compareByMethod();
    equations.refresh();
    findBox.offer();
    exercise.offer();
  }
  showRequests({ "the motion": [path, value] });
}

function showView(how) {
  $("plane-view").hidden = model.space;
  $("space-view").hidden = !model.space;
  $("measures").hidden = model.space;
  if (model.space) {
    if (!space) {
      space = new SpaceView($("space-view"));
      new SpaceBoard({ view: space, doc, board, ready, selected: showSelection, dropped, start: toStart });
    }
    space.showForces = $("forces").checked;
    view = space;
    space.show(model);
  } else {
    view = plane;
    plane.show(model, how === "open" || how === "text");
  }
  model.seek(player.time);
  $("force-scale").textContent = model.forceScale ? `The longest force is ${written(model.forceScale, 3)} N.` : "";
}

function tell(events) {
  const words = headline(answer, model, player.stop);
  $("summary").textContent = words;
  for (const canvas of [$("plane-canvas"), $("space-canvas")]) canvas.setAttribute("aria-label", `${titleNow()}. ${words}`);
  showModel(answer);
  showEvents(events, (time) => { player.pause(); player.seek(time); });
}

/** Show every fault where it is: in the picture, at its slider, and above the text, where a press selects its place. */
function complain(faults) {
  const places = doc.scene?.places || new Map(), value = doc.sound ? doc.scene.value : {};
  const rest = markFaults([$("sliders"), $("place-sliders")], faults);
  $("problem").textContent = rest.filter((f) => f.pointer === "").map((f) => `${f.detail}.`).join(" ");
  mark($("editor"), faults.length > 0);
  document.querySelector(".stage").classList.toggle("stale", faults.length > 0 && (!doc.sound || isNamed(state.scene)));
  plane.wrong = new Set(faults.flatMap((f) => [partOf(f.pointer, value), ...facesAt(f.pointer, value)]).filter(Boolean));
  $("misfits").replaceChildren(...faults.filter((f) => f.pointer).map((fault) => make("li", { textContent: faultInWords(fault, value) })));
  if (doc.sound) showParts($("parts"), board.parts, { value, selection: doc.selection, wrong: plane.wrong, pick: act.pick });
  plane.render();
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
  const own = state.changed || state.scene === OWN;
  writeState({ scene: state.scene, window: state.window, json: own ? doc.text : null, faces: own && doc.waiting.length ? JSON.stringify(doc.waiting) : null });
}

/** Faces from an address, which anyone may have written. */
function facesIn(text) {
  try {
    const faces = JSON.parse(text ?? "[]");
    return Array.isArray(faces) ? faces.filter((on) => on !== null && typeof on === "object" && Array.isArray(on.at)) : [];
  } catch {
    return [];
  }
}

function restore() {
  const given = readState(), name = catalogue.has(given.scene) || given.scene === OWN ? given.scene : given.json ? OWN : "double-pendulum";
  choose(name, given.json || null, facesIn(given.faces));
  if (Number(given.window) > 0) {
    state.window = Number(given.window);
    $("window").value = state.window;
  }
}

$("beside").onchange = () => {
  if ($("beside").value === "held" && answer?.shown) curves.compare({ trajectory: answer.shown, words: "before" });
  else if ($("beside").value === "") curves.compare(null);
  else compareByMethod();
};

/** Ask for the same motion by the method that is chosen, in steps that one sees; one that leaves all bounds is shown until then. */
async function compareByMethod(stop = player.stop) {
  const kind = $("beside").value;
  if (kind === "" || kind === "held" || !answer?.shown || isNamed(state.scene)) return;
  const method = { kind, step: Number((player.stop / METHOD_STEPS).toPrecision(2)) }, words = $("beside").selectedOptions[0].textContent;
  try {
    const { answer: other } = await ask("/v1/scenes", doc.scene.with("/times", { start: 0, stop, count: 801 }).with("/outputs", ["trajectory"]).with("/method", method).text);
    curves.compare({ trajectory: other.trajectory, words: `${words} in steps of ${written(method.step, 2)} s` });
  } catch (error) {
    const left = /before t = ([\d.]+)/.exec(error.message);
    if (left && stop === player.stop) return compareByMethod(0.8 * Number(left[1]));
    curves.compare(null);
    say(`${words}: ${error.errors?.[0]?.detail ?? error.message}.`);
  }
}

const { scenes } = await get("/v1/scenes");
catalogue = new Map(scenes.map((scene) => [scene.name, scene]));
gallery.fill(scenes);
const groups = [...Map.groupBy(scenes, ({ topic }) => topic)].map(([label, entries]) => make("optgroup", { label }, ...entries.map(({ name, title }) => make("option", { value: name, textContent: title }))));
$("scene").replaceChildren(make("option", { value: OWN, textContent: "A scene of your own" }), ...groups);
restore();
await live.running;
if (state.scene !== OWN) player.begin();
await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
document.body.dataset.ready = "yes";
addEventListener("hashchange", restore);

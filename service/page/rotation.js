// The start page: one body, one spin, two pictures, the curves and the words.
import { Refusal, Worker } from "./api.js";
import { BODIES, cuboidOf, pointsOf } from "./bodies.js";
import { BodyView } from "./body_view.js";
import { $, make, written } from "./dom.js";
import { EllipsoidView } from "./ellipsoid_view.js";
import { Integrator } from "./integrator.js";
import { VectorFields, mark, numberOf } from "./number_fields.js";
import { Player } from "./player.js";
import { TimeChart } from "./plots.js";
import { requestPanel } from "./request_panel.js";
import { interpolated, invariantsOf } from "./samples.js";
import { readState, writeState } from "./url_state.js";
import { Matrix4, Vector3 } from "./vendor/three.js";
import { accuracyInWords, motionInWords, rowsOf, stabilities } from "./words.js";

const SAMPLES = 901;
const state = { body: "t-handle", spin: [1, 10, 1], moments: [1, 2, 3], points: BODIES.points.points, window: null };
let motion = null, facing = true, busy = false, again = false;

const ellipsoid = new EllipsoidView($("ellipsoid-view"), (w) => {
  state.spin = w.map((x) => Number(x.toPrecision(6)));
  spin.set(state.spin);
  refresh();
});
const view = new BodyView($("body-view"));
const player = new Player($("player"));
const omega = new TimeChart($("omega"), player, "Angular velocity");
const invariants = new TimeChart($("invariants"), player, "Energy and angular momentum", 130);
const showRequests = requestPanel($("request"));
const worker = new Worker($("progress"));
const integrator = new Integrator((answer) => { motion && (motion.method = answer); showMethod(); }, () => save());
const spin = new VectorFields($("spin"), ["x", "y", "z"], "problem", (values) => changed("spin", values, "The angular velocity needs three numbers."));
const moments = new VectorFields($("moments"), ["I₁", "I₂", "I₃"], "problem", (values) => changed("moments", values, "The moments need three numbers."));

function changed(name, values, complaint) {
  if (!values) return complain([{ pointer: "", detail: complaint }]);
  state[name] = values;
  facing = true;
  return refresh();
}

for (const [name, { label }] of Object.entries(BODIES)) $("body").append(make("option", { value: name, textContent: label }));
$("body").onchange = () => {
  state.body = $("body").value;
  state.spin = [...BODIES[state.body].spin];
  state.window = null;
  facing = true;
  showFields();
  refresh();
};
$("points").onchange = () => { state.points = $("points").value; facing = true; refresh(); };
$("window").onchange = () => {
  const value = numberOf($("window").value);
  const wrong = $("window").value.trim() !== "" && !(value > 0);
  mark($("window"), wrong);
  $("window-error").textContent = wrong ? "A time above 0, or nothing for a time that fits the motion." : "";
  if (!wrong) { state.window = value; refresh(); }
};
document.querySelector("form").addEventListener("submit", (event) => event.preventDefault());

function bodyOf() {
  const choice = BODIES[state.body];
  if (choice.own === "moments") return { kind: "principal-moments", moments: state.moments };
  if (choice.own === "points") return pointsOf(state.points);
  return choice.body;
}

/** Ask the service about the state; while an answer is on its way, only the newest state waits. */
async function refresh() {
  if (busy) { again = true; return; }
  setBusy(true);
  do {
    again = false;
    save();
    try {
      await answerState();
    } catch (error) {
      if (error instanceof Refusal) complain(error.errors);
      else if (error.field) complain([{ pointer: error.field, detail: error.message }]);
      else complain([{ pointer: "", detail: `The service cannot be reached (${error.message}).` }]);
    }
  } while (again);
  setBusy(false);
}

function setBusy(now) {
  busy = now;
  document.querySelector(".stage").setAttribute("aria-busy", String(now));
}

async function answerState() {
  let body;
  try {
    body = bodyOf();
  } catch (error) {
    throw Object.assign(error, { field: "/body/points" });
  }
  const start = { body, angular_velocity: state.spin };
  const result = await worker.run(async (send) => {
    const surfaceQuestion = { ...start, separatrix: true, resolution: 1, points: 400 };
    const [surface, first, mass] = await Promise.all([
      send("/v1/rotation/energy-ellipsoid", surfaceQuestion),
      send("/v1/rotation/trajectory", { ...start, times: [0] }),
      BODIES[state.body].own === "moments" ? null : send("/v1/bodies/mass-properties", { body }),
    ]);
    const stop = state.window ?? windowOf(first.answer, start.angular_velocity);
    const question = { ...start, attitude: [1, 0, 0, 0], times: { start: 0, stop, count: SAMPLES } };
    const { answer } = await send("/v1/rotation/trajectory", question);
    return { surface: surface.answer, answer, question, surfaceQuestion, stop, center: mass?.answer.center_of_mass || [0, 0, 0] };
  });
  if (!result) return complain([{ pointer: "", detail: "Cancelled: the picture is of the answer before" }]);
  complain([]);
  show(result);
}

/** Time that shows the motion: two flips or a few turns. */
function windowOf({ period, tumbles }, w) {
  const turn = (2 * Math.PI) / (Math.hypot(...w) || 1);
  const wanted = period ? Math.max(tumbles ? 2 * period : period, 3 * turn) : 8 * turn;
  return Number(Math.min(wanted, 60 * turn).toPrecision(3));
}

function show(result) {
  const { surface, answer, question, stop } = result, start = question.angular_velocity;
  const principal = surface.semi_axes.map((a) => (2 * surface.energy) / (a * a));
  const stability = stabilities(principal);
  motion = { ...result, principal, axes: surface.axes, method: null };
  ellipsoid.showSurface(surface.semi_axes, surface.axes, stability);
  ellipsoid.showCurves(surface.polhodes[0].points, surface.separatrix.map((curve) => curve.points));
  ellipsoid.setStart(start);
  if (facing) { ellipsoid.faceStart(); facing = false; }
  view.showBody(shapesOf(question.body, principal, surface.axes), result.center, surface.axes, stability);
  view.setMomentum(momentumOf(start));
  const turns = (Math.hypot(...start) * stop) / (2 * Math.PI);
  player.setSpan(stop, Math.max(6, Math.min(40, turns / 0.8)));
  $("window").placeholder = String(stop);
  tell(answer, turns);
  showCurves();
  const { attitude: _, ...plain } = question;
  integrator.follow(plain);
  save();
}

function momentumOf(w) {
  const columns = [0, 1, 2].map((k) => motion.axes.map((row) => row[k]));
  const along = columns.map((c, k) => motion.principal[k] * c.reduce((sum, x, i) => sum + x * w[i], 0));
  return [0, 1, 2].map((i) => columns.reduce((sum, c, k) => sum + along[k] * c[i], 0));
}

function shapesOf(body, principal, axes) {
  const choice = BODIES[state.body];
  if (choice.shapes) return choice.shapes;
  if (choice.own === "points") {
    const masses = [].concat(body.masses);
    return [{ points: body.positions, masses: body.positions.map((_, i) => masses[i % masses.length]) }];
  }
  const columns = new Matrix4().makeBasis(...[0, 1, 2].map((k) => new Vector3(...axes.map((row) => row[k]))));
  const box = cuboidOf(principal);
  return box ? [{ box, columns }] : [{ ellipsoid: principal.map((m) => 1 / Math.sqrt(m)), columns }];
}

function tell(answer, turns) {
  const words = motionInWords(answer);
  $("summary").textContent = words;
  const rows = [...rowsOf(answer), ["Accuracy", accuracyInWords(answer.accuracy)]];
  $("answer").replaceChildren(...rows.flatMap(([name, text]) => [make("dt", { textContent: name }), make("dd", { textContent: text })]));
  const warnings = answer.warnings.map((w) => w.detail);
  if (turns > SAMPLES / 10) warnings.push(`The body turns ${written(turns, 3)} times in the time shown; the picture shows only some of its attitudes. Enter a shorter time to follow it.`);
  $("warnings").replaceChildren(...warnings.map((text) => make("p", { className: "notice", textContent: text })));
  $("ellipsoid-canvas").setAttribute("aria-label", `The energy ellipsoid with the polhode: ${answer.model.regime}. ${words}`);
  $("body-canvas").setAttribute("aria-label", `The body in space. ${words}`);
}

function showCurves() {
  const { answer, method } = motion;
  const columns = (rows) => [0, 1, 2].map((k) => rows.map((w) => w[k]));
  const largest = Math.max(...answer.angular_velocity.flat().map(Math.abs)) || 1;
  const names = ["ωx", "ωy", "ωz"], colors = ["deep", "warm", "third"];
  const series = names.map((label, k) => ({ label, color: colors[k] }));
  const data = [answer.time, ...columns(answer.angular_velocity)];
  const changes = invariantsOf(answer.angular_velocity, motion);
  const kept = [{ label: "energy", color: "deep" }, { label: "angular momentum", color: "warm" }];
  const drift = [answer.time, ...changes];
  if (method) {
    series.push(...names.map((label, k) => ({ label: `${label} integrated`, color: colors[k], dash: [6, 5], width: 1.5 })));
    data.push(...columns(method.angular_velocity));
    kept.push({ label: "energy, integrated", color: "deep", dash: [6, 5] }, { label: "angular momentum, integrated", color: "warm", dash: [6, 5] });
    drift.push(...invariantsOf(method.angular_velocity, motion));
  }
  const range = method ? [-1.7 * largest, 1.7 * largest] : undefined;
  omega.show(series, data, { range });
  const spread = Math.max(1e-14, ...drift.slice(1).flat().map(Math.abs));
  invariants.show(kept, drift, { range: [-1.1 * spread, 1.1 * spread] });
  showTime(player.time);
}

function showMethod() {
  if (!motion) return;
  const rows = motion.method?.angular_velocity || [];
  const limit = 2.5 / ellipsoid.scale;
  const end = rows.findIndex((w) => Math.hypot(...w) > limit);
  ellipsoid.showIntegrated(end < 0 ? rows : rows.slice(0, end));
  $("integrated-key").hidden = !rows.length;
  requests();
  showCurves();
}

function requests() {
  const { question, surfaceQuestion } = motion;
  const { attitude: _, ...plain } = question;
  const all = { "the motion": ["/v1/rotation/trajectory", question] };
  if (integrator.method) all["the integrator"] = ["/v1/rotation/trajectory", { ...plain, method: integrator.method }];
  all["ellipsoid, polhode, separatrix"] = ["/v1/rotation/energy-ellipsoid", surfaceQuestion];
  showRequests(all);
}

function showTime(time) {
  if (!motion) return;
  const { w, attitude } = interpolated(motion.answer, time);
  ellipsoid.setNow(w);
  view.setState(attitude, w, motion.answer.accuracy.largest_norm);
}
player.onTime(showTime);

/** Write every fault at its field. */
function complain(faults) {
  const at = (name) => faults.filter((f) => f.pointer.startsWith(name));
  const rest = faults.filter((f) => !f.pointer.startsWith("/times") && !(state.body === "points" && f.pointer.startsWith("/body")));
  spin.mark(at("/angular_velocity").length > 0);
  moments.mark(state.body === "moments" && at("/body").length > 0);
  const sentence = (f) => [f.detail, f.remedy].filter(Boolean).join("; ");
  $("window-error").textContent = at("/times").map(sentence).join(" ");
  $("points-error").textContent = state.body === "points" ? at("/body").map(sentence).join(" ") : "";
  mark($("points"), $("points-error").textContent !== "");
  $("problem").textContent = rest.map((f) => `${fieldName(f.pointer)}${sentence(f)}`.replace(/\.?$/, ".")).join(" ");
  document.querySelector(".stage").classList.toggle("stale", faults.length > 0);
}

function fieldName(pointer) {
  if (pointer.startsWith("/angular_velocity")) return "Angular velocity: ";
  if (pointer.startsWith("/body/moments")) return "Moments: ";
  return pointer ? `${pointer}: ` : "";
}

function showFields() {
  $("body").value = state.body;
  spin.set(state.spin);
  moments.set(state.moments);
  $("points").value = state.points;
  $("window").value = state.window ?? "";
  $("moments-fields").hidden = state.body !== "moments";
  $("points-field").hidden = state.body !== "points";
}

function save() {
  const own = BODIES[state.body].own;
  writeState({
    body: state.body,
    moments: own === "moments" ? state.moments.join(",") : null,
    points: own === "points" ? state.points.replaceAll("\n", ";") : null,
    spin: state.spin.join(","),
    window: state.window,
    method: integrator.kind === "closed-form" ? null : integrator.kind,
    setting: integrator.setting,
  });
}

function restore() {
  const given = readState();
  const vector = (text) => { const v = (text || "").split(",").map(Number); return v.length === 3 && v.every(Number.isFinite) ? v : null; };
  if (given.body in BODIES) state.body = given.body;
  state.spin = vector(given.spin) || [...BODIES[state.body].spin];
  state.moments = vector(given.moments) || state.moments;
  if (given.points) state.points = given.points.replaceAll(";", "\n");
  state.window = Number(given.window) > 0 ? Number(given.window) : null;
  facing = true;
  showFields();
  integrator.choose(given.method || "closed-form", Number(given.setting) > 0 ? Number(given.setting) : null);
}

await integrator.load();
restore();
await refresh();
player.begin();
await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
document.body.dataset.ready = "yes";
addEventListener("hashchange", () => { restore(); refresh(); });

// What happens in a scene, in one or two sentences; every number is from the answer.
import { written } from "./dom.js";
import { faceName } from "./scene_parts.js";
import { norm } from "./vectors.js";

const EVENTS = {
  touch: "touches", "lift-off": "lifts off", slip: "begins to slip", stick: "sticks", roll: "rolls without slipping", settle: "has come to rest after ever smaller bounces",
  taut: "becomes taut", slack: "goes slack", stop: "reaches its stop", release: "leaves its stop", singular: "has come to a length of zero",
  "no-motion": "has no possible motion", "several-motions": "has several possible motions", "end-of-chain": "has come to its end", switch: "changes its law",
  begin: "begins to act", end: "acts no more", impulse: "strikes", "cannot-begin": "cannot begin where it should",
};
const DIGITS = 3, SAME = 1e-9;
/** Digits of numbers in sentences; relative difference below which two are called equal. */

export const sayEvent = (event) => (event.kind === "singular" && !event.name ? "comes to a singular place" : `${event.name} ${EVENTS[event.kind] || event.kind.replaceAll("-", " ")}`.trim());

const seconds = (t) => `${written(t, DIGITS)} s`;
const listed = (names) => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`);
const subject = (names) => (names.length > 3 ? `${names.length} bodies` : listed(names));

/** Direction of a vector of the plane in words; in space only up and down have one. */
function direction(v) {
  const vertical = v.length === 3 ? v[2] : v[1], across = v.length === 3 ? Math.hypot(v[0], v[1]) : Math.abs(v[0]);
  if (Math.abs(vertical) <= 1e-9 * across) return v.length === 3 ? "level" : v[0] > 0 ? "to the right" : "to the left";
  if (across <= 1e-9 * Math.abs(vertical)) return vertical > 0 ? "upward" : "downward";
  return vertical > 0 ? "obliquely upward" : "obliquely downward";
}

/** Names of the bodies of a part, from its coordinates. */
const bodiesOf = (part, names) => names.filter((name) => part.coordinates.some((c) => c === name || c.startsWith(`${name}.`) || c.startsWith(`${name} `)));

/** How bodies move that are accelerated alike all the time. */
function constant(answer, names) {
  const all = names.map((name) => [name, answer.accelerations?.[name]?.linear]).filter(([, a]) => a), moving = all.filter(([, a]) => norm(a) > 0);
  const turning = names.map((name) => [name, answer.accelerations?.[name]?.angular]).filter(([, a]) => a && norm([a].flat()) > 0);
  if (moving.length) {
    const sizes = moving.map(([, a]) => norm(a)), alike = sizes.every((s) => Math.abs(s - sizes[0]) <= SAME * sizes[0]);
    if (alike && moving.length > 1) return `${subject(moving.map(([name]) => name))} are accelerated by ${written(sizes[0], DIGITS)} m/s²: ${moving.slice(0, 3).map(([name, a]) => `${name} ${direction(a)}`).join(", ")}.`;
    return `${sentence(listed(moving.slice(0, 3).map(([name, a]) => `${name} is accelerated ${direction(a)} by ${written(norm(a), DIGITS)} m/s²`)))}.`;
  }
  if (turning.length) return `${sentence(turning[0][0])} turns ever faster, by ${written(norm([turning[0][1]].flat()), DIGITS)} rad/s².`;
  return `${sentence(subject(names))} ${names.length > 1 ? "move" : "moves"} steadily.`;
}

const sentence = (text) => text.replace(/^./, (c) => c.toUpperCase());

/** Frequencies and rates of growth of a linear motion. */
function modesInWords(modes, names) {
  const swings = modes.filter((m) => m.frequency > 0), periods = [...new Set(swings.map((m) => written((2 * Math.PI) / m.frequency, DIGITS)))];
  const fading = swings.length && swings.every((m) => m.growth_rate < 0), growing = modes.some((m) => m.growth_rate > 0);
  if (!swings.length) return growing ? `${sentence(subject(names))} run${names.length > 1 ? "" : "s"} away from the equilibrium.` : `${sentence(subject(names))} come${names.length > 1 ? "" : "s"} to rest without swinging.`;
  const words = `${sentence(subject(names))} oscillate${names.length > 1 ? "" : "s"} with ${periods.length > 1 ? "the periods" : "a period of"} ${listed(periods.slice(0, 4))} s`;
  return `${words}${fading ? ", ever less" : growing ? ", ever more" : ""}.`;
}

/** One part that no other acts on. */
function partInWords(part, answer, names, hangs) {
  const many = names.length > 1;
  if (part.name === "rest") return `${sentence(subject(names))} stay${many ? "" : "s"} at rest.`;
  if (part.name === "constant acceleration") return constant(answer, names);
  if (part.modes?.length) return modesInWords(part.modes, names);
  if (part.name === "steady precession") return `${sentence(subject(names))} precess${many ? "" : "es"} steadily${part.period ? `, once in ${seconds(part.period)}` : ""}.`;
  if (part.name === "steady spin") return `${sentence(subject(names))} spin${many ? "" : "s"} steadily.`;
  if (part.degrees_of_freedom === 0) return `${sentence(subject(names))} move${many ? "" : "s"} as driven: no degree of freedom is left.`;
  if (part.period && part.precession) return `${sentence(subject(names))} swing${many ? "" : "s"} with a period of ${seconds(part.period)}, and go${many ? "" : "es"} round meanwhile.`;
  if (part.period) return `${sentence(subject(names))} ${hangs ? `swing${many ? "" : "s"} with a period of` : `repeat${many ? "" : "s"} the motion every`} ${seconds(part.period)}.`;
  if (part.name === "free rotation") return `${sentence(subject(names))} tumble${many ? "" : "s"} freely.`;
  const first = many ? null : answer.accelerations?.[names[0]]?.linear;
  if (first && norm(first) > 0 && part.degrees_of_freedom === 1) return `${sentence(names[0])} is accelerated ${direction(first)}, by ${written(norm(first), DIGITS)} m/s² at the start.`;
  return `${sentence(subject(names))} move${many ? "" : "s"} in ${part.degrees_of_freedom} degree${part.degrees_of_freedom === 1 ? "" : "s"} of freedom.`;
}

/** Whether a body hangs from the ground by a pin, rod, string or spring. */
const hanging = (names, model) => model.connections.some(({ kind, a, b, through }) => {
  const ends = through ? [through[0], through.at(-1)] : [a, b];
  return ["pin", "rod", "string", "ball-joint"].includes(kind) && ends.some((e) => e && typeof e !== "string") && ends.some((e) => typeof e === "string" && names.includes(e.split(".")[0]));
});

const ON_FACE = { touch: "touches", "lift-off": "leaves", slip: "begins to slip on", stick: "sticks to", roll: "rolls without slipping on", settle: "has come to rest on" };
const OF_TWO = { touch: "touch", "lift-off": "part", slip: "begin to slip on one another", stick: "stick together", roll: "roll on one another without slipping" };

/** An event with the bodies that it happens to, where it is one of a contact. */
function eventInWords(event, model) {
  const c = model.connections.find(({ label }) => label === event.name);
  if (c?.on && typeof c.place === "string" && ON_FACE[event.kind]) {
    const below = typeof c.on.at === "string" ? c.on.at.split(".")[0] : `the ${faceName(c.on)}`;
    return `${sentence(c.place.split(".")[0])} ${ON_FACE[event.kind]} ${below}`;
  }
  if (c?.kind === "contact" && typeof c.b === "string" && OF_TWO[event.kind]) return `${sentence(c.a.split(".")[0])} and ${c.b.split(".")[0]} ${OF_TWO[event.kind]}`;
  return event.name ? sentence(sayEvent(event)) : `The motion ${sayEvent(event)}`;
}

/** A body that rests on two corners at the start, of which one leaves at once. */
function tipsAtOnce(answer, model) {
  const states = answer.phases?.[0]?.states ?? {}, opened = Object.keys(states).find((name) => {
    const c = model.connections.find(({ label }) => label === name);
    return states[name] === "open" && c?.on && typeof c.place === "string" && !model.space && c.on.radius === undefined && Math.abs(model.startGap(c)) < 1e-9 * model.size();
  });
  return opened ? tipping({ kind: "lift-off", name: opened, time: 0 }, model) : null;
}

/** A body that stands on two contacts and leaves one tips about the other. */
function tipping(event, model) {
  if (event.kind !== "lift-off" || model.space) return null;
  const c = model.connections.find(({ label }) => label === event.name), body = c?.place && model.place(c.place).body;
  if (!body || !c.on || c.place === body.name) return null;
  const others = model.connections.filter((o) => o !== c && o.on && model.place(o.place).body === body && JSON.stringify(o.on) === JSON.stringify(c.on));
  if (others.length !== 1) return null;
  model.seek(event.time);
  const [mine, other] = [c, others[0]].map((o) => model.place(o.place).point), { along } = model.face(c.on);
  const side = (other[0] - mine[0]) * along[0] + (other[1] - mine[1]) * along[1] > 0 ? "right" : "left";
  return `${sentence(body.name)} tips about its ${side} edge ${event.time > 0 ? `after ${seconds(event.time)}` : "at once"}.`;
}

const MENTIONED = new Set(["touch", "lift-off", "slip", "stick", "roll", "settle", "taut", "slack", "stop", "release", "singular", "end-of-chain", "switch", "begin", "end", "impulse"]);

/** Headline of an answer; `model` is its scene, whose time may be moved. */
export function headline(answer, model, stop) {
  const names = model.bodies.map((b) => b.name), events = answer.events || [], { now } = model;
  if (answer.problem) return `${sentence(answer.problem.explanation ?? "What happens is not determined")}.`.replace(/\.\.$/, ".");
  const parts = answer.model.apart?.length > 1 ? answer.model.apart.map((part) => [part, bodiesOf(part, names)]).filter(([, own]) => own.length) : [[{ ...answer.model, period: answer.period, modes: answer.model.apart?.[0]?.modes ?? [], precession: answer.model.apart?.[0]?.precession }, names]];
  const moving = parts.filter(([part]) => part.name !== "rest");
  const sentences = (moving.length ? moving : parts).slice(0, 2).map(([part, own]) => partInWords(part, answer, own, hanging(own, model)));
  const first = events.find((e) => MENTIONED.has(e.kind));
  const tips = tipsAtOnce(answer, model);
  const words = tips ?? (first ? tipping(first, model) ?? `${eventInWords(first, model)} ${first.time > 0 ? `after ${seconds(first.time)}` : "at once"}.` : "");
  model.seek(now);
  const last = answer.ended && answer.ended !== "horizon" ? events.at(-1) : null;
  // What happens says more than how many ways there are to move.
  const motions = [...new Set(sentences)].filter((said) => !words || !/degrees? of freedom\.$/.test(said)).join(" ");
  const end = last && last !== first ? ` The motion ends at ${seconds(last.time)}: ${sayEvent(last)}.` : "";
  const more = events.length > 1 && !end ? ` ${events.length} events in ${seconds(stop)}.` : "";
  return [motions, words].filter(Boolean).join(" ") + end + more;
}

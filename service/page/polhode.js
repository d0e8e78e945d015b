"use strict";
// The curve comes from the service; only the ellipsoid, which is known without it, is computed here.
const $ = (id) => document.getElementById(id);
const canvas = $("picture"), pen = canvas.getContext("2d");
const state = { moments: [1, 2, 3], spin: [0.25, 2, 0.15] };
const view = { turn: 0.7, tilt: 0.45 };
let curve = [], asked = 0, timer = 0;

function slider(group, list, i, name, low, high) {
  const label = document.createElement("label"), input = document.createElement("input");
  const shown = document.createElement("output");
  Object.assign(input, { type: "range", min: low, max: high, step: 0.01, value: list[i] });
  input.setAttribute("aria-label", name);
  const show = () => { shown.textContent = list[i].toFixed(2); };
  input.oninput = () => { list[i] = Number(input.value); show(); draw(); clearTimeout(timer); timer = setTimeout(ask, 30); };
  label.append(name, input, shown);
  $(group).append(label);
  show();
}
["I₁", "I₂", "I₃"].forEach((name, i) => slider("moments", state.moments, i, name, 0.2, 5));
["ω₁", "ω₂", "ω₃"].forEach((name, i) => slider("spin", state.spin, i, name, -3, 3));

async function question(path, content) {
  const response = await fetch(path, {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(content),
  });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.detail);
  return answer;
}

async function ask() {
  const mine = ++asked;
  const body = { kind: "principal-moments", moments: state.moments };
  try {
    const trajectory = (stop, count) => question("/v1/rotation/trajectory",
      { body, angular_velocity: state.spin, times: { start: 0, stop, count } });
    let answer = await trajectory(60, 900);
    if (answer.period && answer.period < 3000) answer = await trajectory(answer.period, 900);
    if (mine !== asked) return;
    curve = answer.angular_velocity;
    tell(answer);
  } catch (error) {
    if (mine !== asked) return;
    curve = [];
    $("answer").replaceChildren();
    entry("refused", error.message, "bad");
  }
  draw();
}

function entry(name, value, style) {
  const term = document.createElement("dt"), text = document.createElement("dd");
  term.textContent = name; text.textContent = value;
  if (style) text.className = style;
  $("answer").append(term, text);
}

function tell(answer) {
  $("answer").replaceChildren();
  entry("model", answer.model.name);
  entry("regime", answer.model.regime);
  entry("period", answer.period ? answer.period.toPrecision(10) + " s" : "none");
  if (answer.tumbles && answer.flip_interval) entry("flips every", answer.flip_interval.toPrecision(10) + " s");
  entry("error", answer.accuracy.error.toExponential(1) + ", " + answer.accuracy.how);
  for (const warning of answer.warnings) entry("warning", warning.detail, "bad");
}

function draw() {
  const style = getComputedStyle(document.documentElement), color = (name) => style.getPropertyValue(name);
  const { moments: I, spin: w } = state;
  const twiceEnergy = I.reduce((sum, Ii, i) => sum + Ii * w[i] * w[i], 0);
  const axes = I.map((Ii) => Math.sqrt(twiceEnergy / Ii) || 1e-9);
  const { width, height } = canvas, scale = 0.43 * Math.min(width / Math.max(axes[0], axes[1]), height / Math.max(...axes));
  const [ct, st, cp, sp] = [Math.cos(view.turn), Math.sin(view.turn), Math.cos(view.tilt), Math.sin(view.tilt)];
  // Turn about the vertical, then look down on it by the tilt.
  const project = ([x, y, z]) => {
    const u = ct * x - st * y, v = st * x + ct * y;
    return [width / 2 + scale * u, height / 2 - scale * (cp * z + sp * v)];
  };
  // The half of the surface that faces the viewer: its normal there has a component towards the eye.
  const faces = (p) => {
    const n = p.map((x, i) => x / (axes[i] * axes[i]));
    return sp * n[2] >= cp * (st * n[0] + ct * n[1]);
  };
  const line = (points, front, back, width) => {
    for (const side of [false, true]) {
      pen.beginPath();
      for (let i = 1; i < points.length; i++) {
        if (faces(points[i]) !== side) continue;
        const a = project(points[i - 1]), b = project(points[i]);
        pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]);
      }
      pen.strokeStyle = side ? front : back; pen.lineWidth = side ? width : width * 0.6; pen.stroke();
    }
  };
  pen.clearRect(0, 0, width, height);
  pen.lineCap = "round";
  const at = (a, b) => [axes[0] * Math.cos(a) * Math.cos(b), axes[1] * Math.cos(a) * Math.sin(b), axes[2] * Math.sin(a)];
  const around = [...Array(97).keys()].map((i) => 2 * Math.PI * i / 96);
  pen.globalAlpha = 0.5;
  for (let k = 0; k < 12; k++) line(around.map((t) => at(t, Math.PI * k / 12)), color("--soft"), color("--line"), 1.2);
  for (let k = -5; k <= 5; k++) line(around.map((t) => at(Math.PI * k / 12, t)), color("--soft"), color("--line"), 1.2);
  pen.globalAlpha = 1;
  pen.font = "24px Georgia, serif"; pen.fillStyle = color("--ink");
  [0, 1, 2].forEach((i) => {
    const tip = [0, 0, 0]; tip[i] = axes[i] * 1.08;
    const [x, y] = project(tip); pen.fillText("e" + "₁₂₃"[i], x - 10, y + 8);
  });
  if (curve.length) line(curve, color("--deep"), color("--soft"), 4);
  const [x, y] = project(w);
  pen.beginPath(); pen.arc(x, y, 9, 0, 2 * Math.PI); pen.fillStyle = color("--warm");
  pen.globalAlpha = faces(w) ? 1 : 0.4; pen.fill(); pen.globalAlpha = 1;
}

canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
canvas.onpointermove = (event) => {
  if (!event.buttons) return;
  view.turn -= event.movementX / 150;
  view.tilt = Math.max(-1.5, Math.min(1.5, view.tilt + event.movementY / 150));
  draw();
};
draw();
ask();

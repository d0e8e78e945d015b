// The scenes with endpoints of their own, put as descriptions with columns, so that they are drawn like all others.

const rows = (list, make) => ({ values: list.map(make), unit: "m" });
const turns = (list, make) => ({ values: list.map(make), unit: "rad" });
const force = (list, pick) => ({ values: list.map(pick), unit: "N" });
const down = (slope, s, left) => [(left ? -1 : 1) * s * Math.cos(slope), -s * Math.sin(slope)];
/** The faces of a wedge whose apex is the origin. */
const faces = ([a, b]) => [a, -b].map((slope, i) => ({ kind: "track", name: `face-${i + 1}`, place: ["one", "two"][i], on: { at: [0, 0], slope } }));

const MADE = {
  "unwinding-shafts": {
    defaults: { positions: [2, 3], times: { start: 0, stop: 1.5, count: 301 } },
    make({ slopes, radii, masses }, { time, positions, spins, tension }) {
      const center = (i) => (p) => {
        const [x, y] = down(slopes[i], p[i], i === 0), n = [(i === 0 ? -1 : 1) * Math.sin(slopes[i]), Math.cos(slopes[i])];
        return [x + radii[i] * n[0], y + radii[i] * n[1]];
      };
      // The string unwinds: the turn is what has been unwound over the radius.
      const angles = [[0, 0]];
      for (let k = 1; k < time.length; k++) angles.push(angles[k - 1].map((a, i) => a + (i ? -1 : 1) * spins[k][i] * (time[k] - time[k - 1])));
      const bodies = Object.fromEntries(["one", "two"].map((name, i) => [name, { at: center(i)(positions[0]), mass: masses[i], radius: radii[i], inertia: 1 }]));
      const connections = [...faces(slopes), { kind: "string", name: "string", through: ["one", [0, 0], "two"], sides: { one: "below", two: "below" } }];
      const columns = {
        "one.position": rows(positions, center(0)), "two.position": rows(positions, center(1)),
        "one.angle": turns(angles, (a) => a[0]), "two.angle": turns(angles, (a) => a[1]), "string.tension": force(tension, (t) => t),
      };
      return { bodies, connections, columns };
    },
  },
  "rod-in-hole": {
    defaults: { times: { start: 0, stop: 4, count: 401 } },
    make({ hole_radius: R, length, mass }, { angle, forces }) {
      const h = Math.sqrt(R * R - (length * length) / 4);
      const center = (a) => [h * Math.sin(a), -h * Math.cos(a)];
      const bodies = { rod: { at: center(angle[0]), mass, inertia: 1, places: { A: [-length / 2, 0], B: [length / 2, 0] } } };
      const connections = ["A", "B"].map((end) => ({ kind: "track", name: end, place: `rod.${end}`, on: { at: [0, 0], radius: -R } }));
      const columns = {
        "rod.position": rows(angle, center), "rod.angle": turns(angle, (a) => a),
        "A.normal": force(forces || [], (f) => f[0]), "B.normal": force(forces || [], (f) => f[1]),
      };
      if (!forces) { delete columns["A.normal"]; delete columns["B.normal"]; }
      return { bodies, connections, columns };
    },
  },
  "chain-on-wedge": {
    defaults: { times: { start: 0, stop: 0.8, count: 301 } },
    make({ slopes, masses, length }, { position, apex_tension }) {
      const one = (x) => down(slopes[0], x, true), two = (x) => down(slopes[1], length - x, false);
      const bodies = { one: { at: one(position[0]), mass: masses[0] }, two: { at: two(position[0]), mass: masses[1] } };
      const connections = [...faces(slopes), { kind: "string", name: "chain", through: ["one", [0, 0], "two"] }];
      const columns = { "one.position": rows(position, one), "two.position": rows(position, two), "chain.tension": force(apex_tension || [], (t) => t) };
      if (!apex_tension) delete columns["chain.tension"];
      return { bodies, connections, columns };
    },
  },
};

export const isNamed = (name) => name in MADE;

/** What is sent about a named scene to see it move. */
export function movingQuestion(name, example) {
  const { outputs: _, ...rest } = example;
  return { ...MADE[name].defaults, ...rest, times: MADE[name].defaults.times };
}

/** Description and trajectory for drawing, from a question and its answer. */
export function drawn(name, question, answer) {
  const { bodies, connections, columns } = MADE[name].make(question, answer.trajectory);
  return { description: { bodies, connections }, trajectory: { time: answer.trajectory.time, columns } };
}

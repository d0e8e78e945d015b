// The way of a string through places and round drums, in the plane; in space through places alone.
import { add, dot, quarter, sub } from "./vectors.js";

const SIDES = { left: [-1, 0], right: [1, 0], below: [0, -1], above: [0, 1] };

/** Straight part from a to b with rims of radius ra, rb and senses of winding ka, kb: its two ends. */
function tangent(a, ra, ka, b, rb, kb) {
  const d = sub(b, a), offset = ka * ra - kb * rb;
  const length = Math.sqrt(Math.max(0, dot(d, d) - offset * offset));
  const angle = Math.atan2(d[1], d[0]) - Math.atan2(offset, length);
  const w = quarter([Math.cos(angle), Math.sin(angle)]);
  return [add(a, w, ka * ra), add(b, w, kb * rb)];
}

/** A function that returns the string now: `{parts, arcs, ends}`; `model` must be at its start. */
export function stringPath(model, connection) {
  const stops = connection.through.map((reference) => {
    const { body } = model.place(reference);
    return { reference, drum: !model.space && body?.radius && reference === body.name ? body : null, senses: [1, 1] };
  });
  const sideOf = (stop, which) => {
    const given = stop.drum && connection.sides?.[stop.reference];
    const name = Array.isArray(given) ? given[Math.min(which, given.length - 1)] : given;
    return SIDES[name] || [0, 0];
  };
  const center = (stop) => model.place(stop.reference).point;
  const part = (i, ka, kb) => {
    const [a, b] = [stops[i], stops[i + 1]];
    if (!a.drum && !b.drum) return [center(a), center(b)];
    return tangent(center(a), a.drum?.radius || 0, ka, center(b), b.drum?.radius || 0, kb);
  };
  // The sense of winding at each end is the one whose tangent point is on the side that is named.
  for (let i = 0; i + 1 < stops.length; i++) {
    const [a, b] = [stops[i], stops[i + 1]];
    let best = -Infinity;
    for (const ka of a.drum ? [1, -1] : [1]) {
      for (const kb of b.drum ? [1, -1] : [1]) {
        const [p, q] = part(i, ka, kb);
        const last = a.drum && i > 0 ? 1 : 0;
        const score = dot(sub(p, center(a)), sideOf(a, last)) / (a.drum?.radius || 1) + dot(sub(q, center(b)), sideOf(b, 0)) / (b.drum?.radius || 1);
        if (score > best + 1e-9) { best = score; a.senses[1] = ka; b.senses[0] = kb; }
      }
    }
  }
  return () => {
    const parts = stops.slice(1).map((_, i) => part(i, stops[i].senses[1], stops[i + 1].senses[0]));
    const arcs = stops.slice(1, -1).flatMap((stop, i) => (stop.drum ? [{ center: center(stop), radius: stop.drum.radius, from: parts[i][1], to: parts[i + 1][0], sense: -stop.senses[0] }] : []));
    const ends = parts.flatMap(([p, q], run) => [
      { at: p, toward: q, body: model.place(stops[run].reference).body, run },
      { at: q, toward: p, body: model.place(stops[run + 1].reference).body, run },
    ]);
    return { parts, arcs, ends: runsOf(stops, ends) };
  };
}

/** Number the runs between drums that do not slip: only there the tension changes. */
function runsOf(stops, ends) {
  let run = 0;
  return ends.map((end, k) => {
    if (k % 2 === 0 && k > 0 && stops[k / 2].drum) run++;
    return { ...end, run };
  });
}

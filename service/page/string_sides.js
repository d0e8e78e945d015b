// On which sides a new string passes the drums on its way: so that each drum pushes it away from its neighbours.
import { dot, quarter, scaled, sub, unit } from "./vectors.js";

const SIDES = { left: [-1, 0], right: [1, 0], below: [0, -1], above: [0, 1] };

/** The side whose name tells one direction from its opposite best. */
const sideOf = (direction) => Object.entries(SIDES).sort(([, p], [, q]) => dot(q, direction) - dot(p, direction))[0][0];

/** `sides` of a string through these references, or null where it passes no drum. */
export function sidesOf(model, through) {
  const stops = through.map((reference) => model.place(reference)), sides = {};
  stops.forEach(({ point, body }, k) => {
    const drum = typeof through[k] === "string" && body?.radius && through[k] === body.name;
    if (!drum) return;
    const before = stops[k - 1]?.point, after = stops[k + 1]?.point;
    if (!before || !after) {
      // One that ends on a drum leaves it along its rim.
      sides[body.name] = Math.abs(unit(sub(before ?? after, point))[0]) > 0.9 ? "above" : "right";
      return;
    }
    const outward = sub(point, scaled([before[0] + after[0], before[1] + after[1]], 0.5));
    const across = (other) => {
      const normal = quarter(unit(sub(other, point)));
      return sideOf(dot(normal, outward) >= 0 ? normal : scaled(normal, -1));
    };
    const pair = [across(before), across(after)];
    sides[body.name] = pair[0] === pair[1] ? pair[0] : pair;
  });
  return Object.keys(sides).length ? sides : null;
}

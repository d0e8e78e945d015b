// Between the samples of an answer.

/** Angular velocity and attitude at a time; attitudes are turned on a great circle if samples are close, else the nearest is taken. */
export function interpolated({ time, angular_velocity, attitude }, t) {
  const last = time.length - 1;
  const place = Math.min(last - 1e-9, Math.max(0, (t / time[last]) * last));
  const i = Math.min(last - 1, Math.floor(place)), part = place - i;
  const w = angular_velocity[i].map((x, k) => x + part * (angular_velocity[i + 1][k] - x));
  const a = attitude[i], b = attitude[i + 1];
  const dot = a.reduce((sum, x, k) => sum + x * b[k], 0);
  if (Math.abs(dot) < 0.8) return { w, attitude: part < 0.5 ? a : b };
  const sign = Math.sign(dot);
  const mixed = a.map((x, k) => x * (1 - part) + sign * b[k] * part);
  const norm = Math.hypot(...mixed);
  return { w, attitude: mixed.map((x) => x / norm) };
}

/** Relative changes of the energy and of the magnitude of the angular momentum, from the angular velocities alone. */
export function invariantsOf(rows, { principal, axes }) {
  const columns = [0, 1, 2].map((k) => axes.map((row) => row[k]));
  const both = rows.map((w) => {
    const along = columns.map((c) => c[0] * w[0] + c[1] * w[1] + c[2] * w[2]);
    const energy = along.reduce((sum, x, k) => sum + principal[k] * x * x, 0);
    const momentum = Math.hypot(...along.map((x, k) => principal[k] * x));
    return [energy, momentum];
  });
  return [0, 1].map((k) => both.map((row) => (both[0][k] ? row[k] / both[0][k] - 1 : 0)));
}

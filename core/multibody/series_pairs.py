"""The Taylor series of `core.multibody.series` in pairs of doubles: the judge of the doubles, and the finer answer.

Every array of numbers has a last axis (value, tail); the steps are the same. Friction, the part X of the force of a
multiplier that is no gradient, is known here alone.
"""

from __future__ import annotations

import numpy as np

from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_div_d, dd_mul
from core.multibody.packed import Floats, Integers, Packed
from core.multibody.pair_arrays import gathered, invert_pairs, settled
from core.multibody.series import DONE, FULL, LOST, SHORTEST, SINGULAR, step_size


@kernel()
def entries_of_lines_pairs(table: Packed, q: Floats, lines: Floats) -> None:
    """Fill in the entries of W at a place q of shape (n, 2), shape (e, 2)."""
    for e in range(lines.shape[0]):
        lines[e, 0], lines[e, 1] = table.lines[e, 0], table.lines[e, 1]
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        ph, pl = dd_mul(table.slopes[p, 0], table.slopes[p, 1], q[i, 0], q[i, 1])
        lines[e, 0], lines[e, 1] = dd_add(lines[e, 0], lines[e, 1], ph, pl)


@kernel()
def saddle_inverse_pairs(table: Packed, lines: Floats, work: Floats, inverse: Floats) -> bool:
    """Fill in the inverse of [M -(W + X)^T; W 0]; return whether there is one."""
    n = table.load.shape[0]
    work[:] = 0.0
    for i in range(n):
        for j in range(n):
            work[i, j, 0], work[i, j, 1] = table.mass[i, j, 0], table.mass[i, j, 1]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        if table.binds[e] == 1:
            work[n + r, j, 0], work[n + r, j, 1] = lines[e, 0], lines[e, 1]
        work[j, n + r, 0], work[j, n + r, 1] = dd_add(work[j, n + r, 0], work[j, n + r, 1], -lines[e, 0], -lines[e, 1])
    return invert_pairs(work, inverse)


@kernel()
def coefficients_pairs(table: Packed, inverse: Floats, order: int, q: Floats, multipliers: Floats) -> None:
    """Fill in the Taylor coefficients q[:, 2:] of shape (n, order + 1, 2) and those of the multipliers."""
    n, m = table.load.shape[0], table.rate.shape[0]
    count = table.lines.shape[0]
    u = np.zeros((n, order + 1, 2))
    w = np.zeros((count, order + 1, 2))
    right = np.empty((n + m, 2))
    varying = np.zeros(count, dtype=np.bool_)
    for i in range(n):
        u[i, 0, 0], u[i, 0, 1] = q[i, 1, 0], q[i, 1, 1]
    for e in range(count):
        w[e, 0, 0], w[e, 0, 1] = table.lines[e, 0], table.lines[e, 1]
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        varying[e] = True
        for a in range(2):
            ph, pl = dd_mul(table.slopes[p, 0], table.slopes[p, 1], q[i, a, 0], q[i, a, 1])
            w[e, a, 0], w[e, a, 1] = dd_add(w[e, a, 0], w[e, a, 1], ph, pl)
    for k in range(order - 1):
        for i in range(n + m):
            right[i, 0], right[i, 1] = 0.0, 0.0
            if k == 0 and i < n:
                right[i, 0], right[i, 1] = table.load[i, 0], table.load[i, 1]
        for p in range(table.stiff.shape[0]):
            i, j = table.stiff_at[p, 0], table.stiff_at[p, 1]
            right[i, 0], right[i, 1] = gathered(
                right[i, 0], right[i, 1], -table.stiff[p, 0], -table.stiff[p, 1], q[j, k, 0], q[j, k, 1]
            )
        for p in range(table.damp.shape[0]):
            i, j = table.damp_at[p, 0], table.damp_at[p, 1]
            right[i, 0], right[i, 1] = gathered(
                right[i, 0], right[i, 1], -table.damp[p, 0], -table.damp[p, 1], u[j, k, 0], u[j, k, 1]
            )
        for p in range(table.gyre.shape[0]):
            i, j, l = table.gyre_at[p, 0], table.gyre_at[p, 1], table.gyre_at[p, 2]  # noqa: E741
            sh, sl = 0.0, 0.0
            for a in range(k + 1):
                sh, sl = gathered(sh, sl, q[j, a, 0], q[j, a, 1], u[l, k - a, 0], u[l, k - a, 1])
            sh, sl = settled(sh, sl)
            right[i, 0], right[i, 1] = gathered(right[i, 0], right[i, 1], table.gyre[p, 0], table.gyre[p, 1], sh, sl)
        for e in range(count):
            if not varying[e]:
                continue
            r, j = table.lines_at[e, 0], table.lines_at[e, 1]
            sh, sl = right[j, 0], right[j, 1]
            for a in range(k):
                sh, sl = gathered(sh, sl, multipliers[r, a, 0], multipliers[r, a, 1], w[e, k - a, 0], w[e, k - a, 1])
            right[j, 0], right[j, 1] = sh, sl
            if table.binds[e] == 0:
                continue
            sh, sl = 0.0, 0.0
            for a in range(1, k + 2):
                sh, sl = gathered(sh, sl, w[e, a, 0], w[e, a, 1], u[j, k + 1 - a, 0], u[j, k + 1 - a, 1])
            sh, sl = settled(sh, sl)
            right[n + r, 0], right[n + r, 1] = gathered(right[n + r, 0], right[n + r, 1], -(k + 1.0), 0.0, sh, sl)
        for i in range(n + m):
            right[i, 0], right[i, 1] = settled(right[i, 0], right[i, 1])
        for i in range(n + m):
            sh, sl = 0.0, 0.0
            for j in range(n + m):
                sh, sl = gathered(sh, sl, inverse[i, j, 0], inverse[i, j, 1], right[j, 0], right[j, 1])
            sh, sl = settled(sh, sl)
            if i < n:
                # The factors of a derivative are formed in pairs: they are not powers of two.
                u[i, k + 1, 0], u[i, k + 1, 1] = dd_div_d(sh, sl, k + 1.0)
                q[i, k + 2, 0], q[i, k + 2, 1] = dd_div_d(u[i, k + 1, 0], u[i, k + 1, 1], k + 2.0)
            else:
                multipliers[i - n, k, 0], multipliers[i - n, k, 1] = sh, sl
        if k + 2 < order:
            for p in range(table.slopes.shape[0]):
                e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
                ph, pl = dd_mul(table.slopes[p, 0], table.slopes[p, 1], q[i, k + 2, 0], q[i, k + 2, 1])
                w[e, k + 2, 0], w[e, k + 2, 1] = dd_add(w[e, k + 2, 0], w[e, k + 2, 1], ph, pl)


@kernel()
def correct_pairs(table: Packed, inverse: Floats, lines: Floats, q: Floats, v: Floats) -> None:
    """Put a place back on the measures, and the rates onto the rows there; q and v of shape (n, 2)."""
    n, m = table.load.shape[0], table.rate.shape[0]
    residual = np.zeros((m, 2))
    for r in range(m):
        residual[r, 0], residual[r, 1] = -table.offset[r, 0], -table.offset[r, 1]
    for e in range(lines.shape[0]):
        if table.binds[e] == 0:
            continue
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        sh, sl = dd_add(lines[e, 0], lines[e, 1], table.lines[e, 0], table.lines[e, 1])
        residual[r, 0], residual[r, 1] = gathered(
            residual[r, 0], residual[r, 1], -0.5 * sh, -0.5 * sl, q[j, 0], q[j, 1]
        )
    for r in range(m):
        residual[r, 0], residual[r, 1] = settled(residual[r, 0], residual[r, 1])
    for i in range(n):
        sh, sl = 0.0, 0.0
        for r in range(m):
            if table.held[r] == 1:
                sh, sl = gathered(sh, sl, inverse[i, n + r, 0], inverse[i, n + r, 1], residual[r, 0], residual[r, 1])
        q[i, 0], q[i, 1] = dd_add(q[i, 0], q[i, 1], sh, sl)
    entries_of_lines_pairs(table, q, lines)
    for r in range(m):
        residual[r, 0], residual[r, 1] = table.rate[r, 0], table.rate[r, 1]
    for e in range(lines.shape[0]):
        if table.binds[e] == 0:
            continue
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        residual[r, 0], residual[r, 1] = gathered(
            residual[r, 0], residual[r, 1], -lines[e, 0], -lines[e, 1], v[j, 0], v[j, 1]
        )
    for r in range(m):
        residual[r, 0], residual[r, 1] = settled(residual[r, 0], residual[r, 1])
    for i in range(n):
        sh, sl = 0.0, 0.0
        for r in range(m):
            sh, sl = gathered(sh, sl, inverse[i, n + r, 0], inverse[i, n + r, 1], residual[r, 0], residual[r, 1])
        v[i, 0], v[i, 1] = dd_add(v[i, 0], v[i, 1], sh, sl)


@kernel()
def moved_pairs(c: Floats, hh: float, hl: float, q: Floats, v: Floats) -> None:
    """Evaluate a series c of shape (n, order + 1, 2) a pair of time later, into q and v of shape (n, 2)."""
    n, order = c.shape[0], c.shape[1] - 1
    for i in range(n):
        sh, sl = 0.0, 0.0
        rh, rl = 0.0, 0.0
        for k in range(order, 0, -1):
            # Horner's rule for the sum s and its derivative r at once: r becomes r h + s, then s becomes s h + c.
            rh, rl = dd_mul(rh, rl, hh, hl)
            sh, sl = dd_add(sh, sl, c[i, k, 0], c[i, k, 1])
            rh, rl = dd_add(rh, rl, sh, sl)
            sh, sl = dd_mul(sh, sl, hh, hl)
        q[i, 0], q[i, 1] = dd_add(c[i, 0, 0], c[i, 0, 1], sh, sl)
        v[i, 0], v[i, 1] = rh, rl


@kernel()
def advance_pairs(
    table: Packed,
    q: Floats,
    v: Floats,
    clock: Floats,
    end: float,
    tolerance: float,
    starts: Floats,
    series: Floats,
) -> tuple[int, int]:
    """Take steps until the time `end` or until the arrays are full: `advance` in pairs.

    Parameters
    ----------
    q, v : (n, 2)
        State, moved along.
    clock : (2,)
    starts : (s + 1, 2)
    series : (s, n, order + 1, 2)
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    order = series.shape[2] - 1
    lines = np.empty((table.lines.shape[0], 2))
    work = np.empty((n + m, n + m, 2))
    inverse = np.empty((n + m, n + m, 2))
    multipliers = np.empty((m, order - 1, 2))
    entries_of_lines_pairs(table, q, lines)
    if not saddle_inverse_pairs(table, lines, work, inverse):
        return SINGULAR, 0
    way = 1.0 if end >= clock[0] else -1.0
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left * way <= 0.0:
            return DONE, step
        c = series[step]
        for i in range(n):
            c[i, 0, 0], c[i, 0, 1] = q[i, 0], q[i, 1]
            c[i, 1, 0], c[i, 1, 1] = v[i, 0], v[i, 1]
        coefficients_pairs(table, inverse, order, c, multipliers)
        h = way * step_size(c[:, :, 0], table.group, tolerance)
        if not abs(h) > SHORTEST * max(1.0, abs(clock[0])):
            return (SINGULAR if abs(h) >= 0.0 else LOST), step
        if abs(h) >= abs(left):
            h = left
        moved_pairs(c, h, 0.0, q, v)
        for i in range(n):
            if not (abs(q[i, 0]) < 1e150 and abs(v[i, 0]) < 1e150):
                return LOST, step
        entries_of_lines_pairs(table, q, lines)
        if not saddle_inverse_pairs(table, lines, work, inverse):
            return SINGULAR, step
        if m > 0:
            correct_pairs(table, inverse, lines, q, v)
        clock[0], clock[1] = dd_add_d(clock[0], clock[1], h)
        starts[step + 1, 0], starts[step + 1, 1] = clock[0], clock[1]
        if h == left:
            return DONE, step + 1
    return FULL, series.shape[0]


@kernel()
def sampled_pairs(starts: Floats, series: Floats, times: Floats, which: Integers, q: Floats, v: Floats) -> None:
    """Evaluate the series of the steps `which` at the times, pairs of shape (t, 2), into q and v of shape (t, n, 2)."""
    for s in range(times.shape[0]):
        step = which[s]
        hh, hl = dd_add(times[s, 0], times[s, 1], -starts[step, 0], -starts[step, 1])
        moved_pairs(series[step], hh, hl, q[s], v[s])


@kernel()
def multipliers_pairs(table: Packed, q: Floats, v: Floats, acceleration: Floats, multipliers: Floats) -> int:
    """Fill in accelerations and multipliers at many states; return the number of states done before a singular one.

    Parameters
    ----------
    q, v, acceleration : (t, n, 2)
    multipliers : (t, m, 2)
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    lines = np.empty((table.lines.shape[0], 2))
    work = np.empty((n + m, n + m, 2))
    inverse = np.empty((n + m, n + m, 2))
    right = np.empty((n + m, 2))
    for s in range(q.shape[0]):
        entries_of_lines_pairs(table, q[s], lines)
        if not saddle_inverse_pairs(table, lines, work, inverse):
            return s
        for i in range(n + m):
            right[i, 0], right[i, 1] = 0.0, 0.0
            if i < n:
                right[i, 0], right[i, 1] = table.load[i, 0], table.load[i, 1]
        for p in range(table.stiff.shape[0]):
            i, j = table.stiff_at[p, 0], table.stiff_at[p, 1]
            right[i, 0], right[i, 1] = gathered(
                right[i, 0], right[i, 1], -table.stiff[p, 0], -table.stiff[p, 1], q[s, j, 0], q[s, j, 1]
            )
        for p in range(table.damp.shape[0]):
            i, j = table.damp_at[p, 0], table.damp_at[p, 1]
            right[i, 0], right[i, 1] = gathered(
                right[i, 0], right[i, 1], -table.damp[p, 0], -table.damp[p, 1], v[s, j, 0], v[s, j, 1]
            )
        for p in range(table.gyre.shape[0]):
            i, j, l = table.gyre_at[p, 0], table.gyre_at[p, 1], table.gyre_at[p, 2]  # noqa: E741
            ph, pl = dd_mul(q[s, j, 0], q[s, j, 1], v[s, l, 0], v[s, l, 1])
            right[i, 0], right[i, 1] = gathered(right[i, 0], right[i, 1], table.gyre[p, 0], table.gyre[p, 1], ph, pl)
        for p in range(table.slopes.shape[0]):
            e, l = table.slopes_at[p, 0], table.slopes_at[p, 1]  # noqa: E741
            if table.binds[e] == 0:
                continue
            r, j = n + table.lines_at[e, 0], table.lines_at[e, 1]
            ph, pl = dd_mul(v[s, l, 0], v[s, l, 1], v[s, j, 0], v[s, j, 1])
            right[r, 0], right[r, 1] = gathered(
                right[r, 0], right[r, 1], -table.slopes[p, 0], -table.slopes[p, 1], ph, pl
            )
        for i in range(n + m):
            right[i, 0], right[i, 1] = settled(right[i, 0], right[i, 1])
        for i in range(n + m):
            sh, sl = 0.0, 0.0
            for j in range(n + m):
                sh, sl = gathered(sh, sl, inverse[i, j, 0], inverse[i, j, 1], right[j, 0], right[j, 1])
            sh, sl = settled(sh, sl)
            if i < n:
                acceleration[s, i, 0], acceleration[s, i, 1] = sh, sl
            else:
                multipliers[s, i - n, 0], multipliers[s, i - n, 1] = sh, sl
    return len(q)

"""The Taylor series of a table's motion, step by step, in doubles: the kernel.

At order k the unknowns x = (k+1)(k+2) q_{k+2} and the multipliers' coefficient solve

    [M  -W_0^T; W_0  0] (x, lambda_k) = (F_k + sum_{a<k} lambda_a W_{k-a},  -(k+1) sum_{a>=1} W_a u_{k+1-a}),

with u_k = (k+1) q_{k+1}: one product with one inverse a step, and no reduction of the index. At the end of a step the
place is put back on the measures by one weighted Newton correction, then the rates at the corrected place.

References
----------
J. D. Pryce, N. S. Nedialkov, "Multibody dynamics in natural coordinates through automatic differentiation and
high-index DAE solving", Acta Cybernetica 24 (2020).
"""

from __future__ import annotations

import numpy as np

from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_mul, two_prod, two_sum
from core.multibody.packed import Floats, Integers, Packed
from core.multibody.pair_arrays import gathered

SHORTEST = 1e-12
"""Shortest step, in the table's own unit of time or of the time reached: below it a place is singular."""


DONE, FULL, SINGULAR, LOST = 0, 1, 2, 3
"""How a run of steps ended: at its time, at the end of its arrays, at a singular place, out of the range of doubles."""


@kernel()
def entries_of_lines(table: Packed, q: Floats, lines: Floats) -> None:
    """Fill in the entries of W at a place, shape (e,)."""
    for e in range(lines.shape[0]):
        lines[e] = table.lines[e, 0]
    for p in range(table.slopes.shape[0]):
        lines[table.slopes_at[p, 0]] += table.slopes[p, 0] * q[table.slopes_at[p, 1]]


@kernel()
def invert(a: Floats, out: Floats) -> bool:
    """Invert a matrix by Gauss-Jordan elimination with scaled pivots; `a` is used up. Return whether it could be."""
    n = a.shape[0]
    scale = np.empty(n)
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[i, j]))
            out[i, j] = 1.0 if i == j else 0.0
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            size = abs(a[i, k]) * scale[i]
            if size > best:
                pivot, best = i, size
        if not best > 1e-14:
            return False
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
                out[k, j], out[pivot, j] = out[pivot, j], out[k, j]
            scale[pivot] = scale[k]
        factor = 1.0 / a[k, k]
        for j in range(n):
            a[k, j] *= factor
            out[k, j] *= factor
        for i in range(n):
            if i != k and a[i, k] != 0.0:
                factor = a[i, k]
                for j in range(n):
                    a[i, j] -= factor * a[k, j]
                    out[i, j] -= factor * out[k, j]
    return True


@kernel()
def saddle_inverse(table: Packed, lines: Floats, work: Floats, inverse: Floats) -> bool:
    """Fill in the inverse of [M -W^T; W 0]; return whether there is one."""
    n = table.load.shape[0]
    work[:] = 0.0
    for i in range(n):
        for j in range(n):
            work[i, j] = table.mass[i, j, 0]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        work[j, n + r] = -lines[e]
        work[n + r, j] = lines[e]
    return invert(work, inverse)


@kernel()
def coefficients(table: Packed, inverse: Floats, order: int, q: Floats, multipliers: Floats) -> None:
    """Fill in the Taylor coefficients q[:, 2:] and those of the multipliers, q[:, 0:2] being given.

    Parameters
    ----------
    q : (n, order + 1)
    multipliers : (m, order - 1)
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    count = table.lines.shape[0]
    u = np.zeros((n, order + 1))
    w = np.zeros((count, order + 1))
    right = np.empty(n + m)
    varying = np.zeros(count, dtype=np.bool_)
    for p in range(table.slopes.shape[0]):
        varying[table.slopes_at[p, 0]] = True
    for i in range(n):
        u[i, 0] = q[i, 1]
    for a in range(2):
        for e in range(count):
            w[e, a] = table.lines[e, 0] if a == 0 else 0.0
        for p in range(table.slopes.shape[0]):
            w[table.slopes_at[p, 0], a] += table.slopes[p, 0] * q[table.slopes_at[p, 1], a]
    for k in range(order - 1):
        for i in range(n):
            right[i] = table.load[i, 0] if k == 0 else 0.0
        for r in range(m):
            right[n + r] = 0.0
        for p in range(table.stiff.shape[0]):
            right[table.stiff_at[p, 0]] -= table.stiff[p, 0] * q[table.stiff_at[p, 1], k]
        for p in range(table.damp.shape[0]):
            right[table.damp_at[p, 0]] -= table.damp[p, 0] * u[table.damp_at[p, 1], k]
        for p in range(table.gyre.shape[0]):
            j, l = table.gyre_at[p, 1], table.gyre_at[p, 2]  # noqa: E741
            total = 0.0
            for a in range(k + 1):
                total += q[j, a] * u[l, k - a]
            right[table.gyre_at[p, 0]] += table.gyre[p, 0] * total
        for e in range(count):
            if not varying[e]:
                continue
            r, j = table.lines_at[e, 0], table.lines_at[e, 1]
            total = 0.0
            for a in range(k):
                total += multipliers[r, a] * w[e, k - a]
            right[j] += total
            total = 0.0
            for a in range(1, k + 2):
                total += w[e, a] * u[j, k + 1 - a]
            right[n + r] -= (k + 1) * total
        for i in range(n):
            total = 0.0
            for j in range(n + m):
                total += inverse[i, j] * right[j]
            q[i, k + 2] = total / ((k + 1) * (k + 2))
            u[i, k + 1] = total / (k + 1)
        for r in range(m):
            total = 0.0
            for j in range(n + m):
                total += inverse[n + r, j] * right[j]
            multipliers[r, k] = total
        if k + 2 < order:
            for p in range(table.slopes.shape[0]):
                w[table.slopes_at[p, 0], k + 2] += table.slopes[p, 0] * q[table.slopes_at[p, 1], k + 2]


@kernel()
def step_size(q: Floats, group: Integers, tolerance: float) -> float:
    """Return the step at which the last terms of the series are `tolerance` of what they are added to."""
    n, order = q.shape[0], q.shape[1] - 1
    best = np.inf
    for g in range(4):
        last, before, first, second, zeroth = 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(n):
            if group[i] == g:
                last = max(last, abs(q[i, order]))
                before = max(before, abs(q[i, order - 1]))
                zeroth = max(zeroth, abs(q[i, 0]))
                first = max(first, abs(q[i, 1]))
                second = max(second, abs(q[i, 2]))
        for power, size in ((order, last), (order - 1, before)):
            if size > 0.0:
                scale = 1.0 if g == 2 else zeroth
                # What starts at zero is measured by how far it comes within the radius of convergence.
                if second > 0.0:
                    radius = (second / size) ** (1.0 / (power - 2))
                    scale = max(scale, second * radius * radius)
                if first > 0.0:
                    scale = max(scale, first * (first / size) ** (1.0 / (power - 1)))
                best = min(best, (tolerance * scale / size) ** (1.0 / power))
    return best


@kernel()
def correct(table: Packed, inverse: Floats, lines: Floats, q: Floats, v: Floats) -> None:
    """Put a place back on the measures, and the rates onto the rows there.

    Residuals are formed with the tails of the state and of the table, or their rounding would be the error of a step.

    Parameters
    ----------
    lines : (e,)
        Entries of W at the place; brought up to date.
    q, v : (n, 2)
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    residual = np.zeros((m, 2))
    for r in range(m):
        residual[r, 0], residual[r, 1] = -table.offset[r, 0], -table.offset[r, 1]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        residual[r, 0], residual[r, 1] = gathered(
            residual[r, 0], residual[r, 1], -table.lines[e, 0], -table.lines[e, 1], q[j, 0], q[j, 1]
        )
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        if table.held[r] == 1:
            ph, pl = dd_mul(q[i, 0], q[i, 1], q[j, 0], q[j, 1])
            residual[r, 0], residual[r, 1] = gathered(
                residual[r, 0], residual[r, 1], -0.5 * table.slopes[p, 0], -0.5 * table.slopes[p, 1], ph, pl
            )
    for i in range(n):
        total = 0.0
        for r in range(m):
            if table.held[r] == 1:
                total += inverse[i, n + r] * (residual[r, 0] + residual[r, 1])
        q[i, 0], q[i, 1] = dd_add_d(q[i, 0], q[i, 1], total)
    entries_of_lines(table, q[:, 0], lines)
    for r in range(m):
        residual[r, 0], residual[r, 1] = table.rate[r, 0], table.rate[r, 1]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        residual[r, 0], residual[r, 1] = gathered(
            residual[r, 0], residual[r, 1], -table.lines[e, 0], -table.lines[e, 1], v[j, 0], v[j, 1]
        )
    for p in range(table.slopes.shape[0]):
        e, i = table.slopes_at[p, 0], table.slopes_at[p, 1]
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        ph, pl = dd_mul(q[i, 0], q[i, 1], v[j, 0], v[j, 1])
        residual[r, 0], residual[r, 1] = gathered(
            residual[r, 0], residual[r, 1], -table.slopes[p, 0], -table.slopes[p, 1], ph, pl
        )
    for i in range(n):
        total = 0.0
        for r in range(m):
            total += inverse[i, n + r] * (residual[r, 0] + residual[r, 1])
        v[i, 0], v[i, 1] = dd_add_d(v[i, 0], v[i, 1], total)


@kernel()
def advance(
    table: Packed,
    q: Floats,
    v: Floats,
    clock: Floats,
    end: float,
    tolerance: float,
    starts: Floats,
    series: Floats,
) -> tuple[int, int]:
    """Take steps until the time `end` or until the arrays are full.

    Parameters
    ----------
    q, v : (n, 2)
        State and what its compensated sums left; moved along.
    clock : (2,)
        Time as a pair; moved along.
    starts : (s + 1, 2)
        Filled with the times at which steps start, and the last one's end.
    series : (s, n, order + 1)
        Filled with their coefficients.

    Returns
    -------
    tuple of int
        How it ended, and the number of steps.
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    order = series.shape[2] - 1
    lines = np.empty(table.lines.shape[0])
    work = np.empty((n + m, n + m))
    inverse = np.empty((n + m, n + m))
    multipliers = np.empty((m, order - 1))
    place = q[:, 0].copy()
    entries_of_lines(table, place, lines)
    if not saddle_inverse(table, lines, work, inverse):
        return SINGULAR, 0
    way = 1.0 if end >= clock[0] else -1.0
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left * way <= 0.0:
            return DONE, step
        c = series[step]
        for i in range(n):
            c[i, 0], c[i, 1] = q[i, 0], v[i, 0]
        coefficients(table, inverse, order, c, multipliers)
        h = way * step_size(c, table.group, tolerance)
        if not abs(h) > SHORTEST * max(1.0, abs(clock[0])):
            return (SINGULAR if abs(h) >= 0.0 else LOST), step
        if abs(h) >= abs(left):
            h = left
        for i in range(n):
            moved, rate = 0.0, 0.0
            for k in range(order, 1, -1):
                moved = (moved + c[i, k]) * h
            for k in range(order, 2, -1):
                rate = (rate + k * c[i, k]) * h
            # The largest terms, rate times step, are formed exactly; the rest is as much smaller as the step is short.
            ph, pl = two_prod(v[i, 0], h)
            pl += moved * h + v[i, 1] * h
            q[i, 0], q[i, 1] = dd_add(q[i, 0], q[i, 1], ph, pl)
            ph, pl = two_prod(2.0 * c[i, 2], h)
            v[i, 0], v[i, 1] = dd_add(v[i, 0], v[i, 1], ph, pl + rate * h)
            place[i] = q[i, 0]
            if not (abs(q[i, 0]) < 1e150 and abs(v[i, 0]) < 1e150):
                return LOST, step
        entries_of_lines(table, place, lines)
        if not saddle_inverse(table, lines, work, inverse):
            return SINGULAR, step
        if m > 0:
            correct(table, inverse, lines, q, v)
        sh, sl = two_sum(clock[0], h)
        clock[0], clock[1] = two_sum(sh, sl + clock[1])
        starts[step + 1, 0], starts[step + 1, 1] = clock[0], clock[1]
        if h == left:
            return DONE, step + 1
    return FULL, series.shape[0]


@kernel()
def sampled(starts: Floats, series: Floats, times: Floats, which: Integers, q: Floats, v: Floats) -> None:
    """Evaluate the series of the steps `which` at the times, into q and v of shape (t, n)."""
    n, order = series.shape[1], series.shape[2] - 1
    for s in range(times.shape[0]):
        h = (times[s] - starts[which[s], 0]) - starts[which[s], 1]
        c = series[which[s]]
        for i in range(n):
            moved, rate = 0.0, 0.0
            for k in range(order, 0, -1):
                moved = (moved + c[i, k]) * h
            for k in range(order, 1, -1):
                rate = (rate + k * c[i, k]) * h
            q[s, i] = c[i, 0] + moved
            v[s, i] = c[i, 1] + rate

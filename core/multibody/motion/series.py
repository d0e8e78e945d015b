"""The Taylor series of a table's motion, step by step, in doubles: the kernel.

At order k the unknowns x = (k+1)(k+2) q_{k+2} and the multipliers' coefficient solve

    [M  -W_0^T; W_0  0] (x, lambda_k) = (F_k + sum_{a<k} lambda_a W_{k-a},  -(k+1) sum_{a>=1} W_a u_{k+1-a}),

with u_k = (k+1) q_{k+1}: one inverse a step, and no reduction of the index. At the end of a step the
place is put back on the measures by one weighted Newton correction, then the rates at the corrected place.

References
----------
J. D. Pryce, N. S. Nedialkov, "Multibody dynamics in natural coordinates through automatic differentiation and
high-index DAE solving", Acta Cybernetica 24 (2020).
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import Pair, dd_add, dd_add_d, dd_mul, two_prod, two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered
from core.multibody.equations.packed import Packed
from core.multibody.equations.saddle import Saddle, inverted, saddle_space
from core.multibody.laws.corners import until_corner
from core.multibody.laws.kernel import values_of_laws
from core.multibody.motion.products import ROW, Products, products_of, spread, started, summed
from core.multibody.motion.step_sizes import lowest_bound, step_size
from core.multibody.motion.turning_friction import add_turning

SHORTEST = 1e-12
"""Shortest step, in the table's own unit of time or of the time reached: below it a place is singular."""

FARTHEST = 1e150
"""Size of coordinates and rates beyond which a motion leaves the range of doubles."""

DONE, FULL, SINGULAR, LOST, STUCK, SLOWED = 0, 1, 2, 3, 4, 5
"""How a run of steps ended: at its time, at the end of its arrays, at a singular place, out of the range of doubles,
where a formula does not say how the motion goes on, or where the units of time no longer fit a slip that ends."""


@kernel()
def entries_of_lines(table: Packed, q: Floats, lines: Floats) -> None:
    """Fill in the entries of W at a place, shape (e,)."""
    for e in range(lines.shape[0]):
        lines[e] = table.lines[e, 0]
    for p in range(table.slopes.shape[0]):
        lines[table.slopes_at[p, 0]] += table.slopes[p, 0] * q[table.slopes_at[p, 1]]


@kernel()
def coefficients(table: Packed, space: Saddle, products: Products, since: int) -> None:
    """Fill in the Taylor coefficients of the path from since + 2 on, in doubles, the earlier ones being taken up."""
    n, m = table.load.shape[0], table.rate.shape[0]
    at, factor, sums, columns = products.at, products.factor, products.sums[0], space.columns[0]
    path, right, now, size = products.path[0], products.right[0], products.now[0], products.right.shape[1]
    last = products.inverses.shape[0] - 3
    for k in range(since, last + 1):
        for b in range(0, size, WIDTH):
            put_lanes(right, b, alike(0.0))
        if k == 0:
            for i in range(n):
                right[i] = table.load[i, 0]
        for p in range(table.stiff.shape[0]):
            right[table.stiff_at[p, 0]] -= table.stiff[p, 0] * path[k * size + table.stiff_at[p, 1]]
        for p in range(table.damp.shape[0]):
            right[table.damp_at[p, 0]] -= table.damp[p, 0] * (k + 1) * path[(k + 1) * size + table.damp_at[p, 1]]
        if table.laws.push.shape[0] > 0:
            values_of_laws(table.laws, products.path, size, k, products.way[0], products.laws)
        for p in range(table.laws.push.shape[0]):
            right[table.laws.push_at[p, 0]] += table.laws.push[p, 0] * products.laws[table.laws.push_at[p, 1], k, 0]
        if table.slides.at.shape[0] > 0:
            add_turning(table, products, k)
        summed(products, k)
        for p in range(at.shape[0]):
            row = np.uintp(at[p, ROW])
            right[row] = fma(factor[p, 0], sums[p], right[row])
        for i in range(n, n + m):
            right[i] *= -(k + 1.0)
        for b in range(0, size, WIDTH):
            total = alike(0.0)
            for j in range(n + m):
                if right[j] != 0.0:
                    total = fma(lanes_at(columns, j * size + b), alike(right[j]), total)
            second = total / alike((k + 1.0) * (k + 2.0))
            put_lanes(now, b, second)
            put_lanes(now, size + b, total / alike(k + 1.0))
            put_lanes(now, 2 * size + b, total)
            put_lanes(path, (k + 2) * size + b, second)
        if k < last:
            spread(table, products, k)


@kernel()
def correct(table: Packed, space: Saddle, lines: Floats, q: Floats, v: Floats) -> None:
    """Put a place back on the measures, and the rates onto the rows there.

    Residuals are formed with the tails of the state and of the table, or their rounding would be the error of a step.

    Parameters
    ----------
    lines : (e,)
        Entries of W at the place; brought up to date.
    q, v : (n, 2)
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    columns = space.columns[0]
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
                total += columns[n + r, i] * (residual[r, 0] + residual[r, 1])
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
            total += columns[n + r, i] * (residual[r, 0] + residual[r, 1])
        v[i, 0], v[i, 1] = dd_add_d(v[i, 0], v[i, 1], total)


@kernel(forceinline=True)
def changes_of(path: Floats, at: int, of_power: int, order: int, by: float) -> Pair:
    """Return by how much eight series change in a time, and their rates, but for the terms of v and the second power.

    Parameters
    ----------
    path : ndarray
        Coefficient k of the eight from `at` + k `of_power` on.
    by : float
        Eight times.
    """
    moved, rate = alike(0.0), alike(0.0)
    for k in range(order, 2, -1):
        own = lanes_at(path, k * of_power + at)
        moved = (moved + own) * by
        rate = fma(own, alike(float(k)), rate) * by
    return ((moved + lanes_at(path, 2 * of_power + at)) * by) * by, rate * by


@kernel(forceinline=True)
def moved_state(
    q: float, q_tail: float, v: float, v_tail: float, second: float, moved: float, rate: float, h: float
) -> tuple[float, float, float, float]:
    """Return a place and a rate a time h later, as compensated sums; of a number or of eight.

    Parameters
    ----------
    second : float
        The second coefficient of the place.
    moved, rate : float
        By `changes_of`.
    """
    # The largest terms, rate times step, are formed exactly; the rest is as much smaller as the step is short.
    ph, pl = two_prod(v, h)
    qh, ql = dd_add(q, q_tail, ph, pl + moved + v_tail * h)
    ph, pl = two_prod(second + second, h)
    vh, vl = dd_add(v, v_tail, ph, pl + rate)
    return qh, ql, vh, vl


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
    space, products = saddle_space(table, 1), products_of(table, order, 1)
    path, size = products.path[0], products.right.shape[1]
    changes = np.empty((2, size))
    place = q[:, 0].copy()
    entries_of_lines(table, place, lines)
    if not inverted(table, lines, space):
        return SINGULAR, 0
    way = 1.0 if end >= clock[0] else -1.0
    products.way[0] = way
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left * way <= 0.0:
            return DONE, step
        for i in range(n):
            path[i], path[size + i] = q[i, 0], v[i, 0]
        started(table, products)
        coefficients(table, space, products, 0)
        c = series[step]
        for k in range(order + 1):
            for i in range(n):
                c[i, k] = path[k * size + i]
        h = way * step_size(c, table.group, tolerance, lowest_bound(table.laws.gaps, order))
        if not abs(h) > SHORTEST * max(1.0, abs(clock[0])):
            # Where a formula loses its value, that of its series is no number.
            return (SINGULAR if abs(h) >= 0.0 or table.laws.operations.shape[0] > 0 else LOST), step
        if abs(h) >= abs(left):
            h = left
        if table.laws.operations.shape[0] > 0:
            h = until_corner(table.laws, products.laws, h)
            if not abs(h) >= 0.0:
                return STUCK, step
        for b in range(0, n, WIDTH):
            moved, rate = changes_of(path, b, size, order, alike(h))
            put_lanes(changes, b, moved)
            put_lanes(changes, size + b, rate)
        for i in range(n):
            q[i, 0], q[i, 1], v[i, 0], v[i, 1] = moved_state(
                q[i, 0], q[i, 1], v[i, 0], v[i, 1], c[i, 2], changes[0, i], changes[1, i], h
            )
            place[i] = q[i, 0]
            if not (abs(q[i, 0]) < FARTHEST and abs(v[i, 0]) < FARTHEST):
                formed = math.isfinite(q[i, 0]) and math.isfinite(v[i, 0])
                return (LOST if formed or table.laws.operations.shape[0] == 0 else SINGULAR), step
        entries_of_lines(table, place, lines)
        if not inverted(table, lines, space):
            return SINGULAR, step
        if m > 0:
            correct(table, space, lines, q, v)
        sh, sl = two_sum(clock[0], h)
        clock[0], clock[1] = two_sum(sh, sl + clock[1])
        starts[step + 1, 0], starts[step + 1, 1] = clock[0], clock[1]
        if h == left:
            return DONE, step + 1
    return FULL, series.shape[0]


@kernel(forceinline=True)
def moved_by(c: Floats, h: float, q: Floats, v: Floats) -> None:
    """Evaluate a series c of shape (n, order + 1) a time later, into q and v of shape (n,)."""
    for i in range(c.shape[0]):
        moved, rate = 0.0, 0.0
        for k in range(c.shape[1] - 1, 0, -1):
            moved = (moved + c[i, k]) * h
        for k in range(c.shape[1] - 1, 1, -1):
            rate = (rate + k * c[i, k]) * h
        q[i] = c[i, 0] + moved
        v[i] = c[i, 1] + rate


@kernel()
def sampled(starts: Floats, series: Floats, times: Floats, which: Integers, q: Floats, v: Floats) -> None:
    """Evaluate the series of the steps `which` at the times, into q and v of shape (t, n)."""
    for s in range(times.shape[0]):
        h = (times[s] - starts[which[s], 0]) - starts[which[s], 1]
        moved_by(series[which[s]], h, q[s], v[s])


@kernel()
def placed(starts: Floats, series: Floats, times: Floats, which: Integers, q: Floats) -> None:
    """Evaluate the places alone, into q of shape (t, n)."""
    n, order = series.shape[1], series.shape[2] - 1
    for s in range(times.shape[0]):
        h = (times[s] - starts[which[s], 0]) - starts[which[s], 1]
        c = series[which[s]]
        for i in range(n):
            moved = c[i, order]
            for k in range(order - 1, -1, -1):
                moved = fma(moved, h, c[i, k])
            q[s, i] = moved

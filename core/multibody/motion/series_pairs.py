"""The Taylor series of `motion.series` in pairs of doubles: the reference of the doubles, and the finer answer.

Every array of numbers has a last axis (value, tail), or a first one where eight numbers are handled at once; the steps
are the same. Coefficient k changes a step by about tolerance^(k/N) of its size, so that the last digits of those of
high order have no effect: they are formed in doubles, from the high parts. Friction, the part X of the force of a
multiplier that is no gradient, is known here alone.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import fma, kernel
from core.double_double import Pair, dd_add, dd_add_d, dd_mul, dd_mul_d, fast_two_sum, two_prod, two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.algebra.square_inverse import padded
from core.multibody.equations.packed import Packed
from core.multibody.equations.saddle import CORRECTED, FAILED, Saddle, inverted_pairs, saddle_space
from core.multibody.laws.corners import until_corner
from core.multibody.laws.kernel import PackedLaws, values_of_laws
from core.multibody.motion.products import ROW, Products, products_of, spread_pairs, started, summed_pairs
from core.multibody.motion.series import (
    DONE,
    FARTHEST,
    FULL,
    LOST,
    SHORTEST,
    SINGULAR,
    SLOWED,
    STUCK,
    coefficients,
)
from core.multibody.motion.step_sizes import lowest_bound, step_size
from core.multibody.motion.turning_friction import add_turning, least_reach, longest_step, put_friction

SOON, LATE = 2.0**-20, 2.0**20
"""Times in the units of a table between which a slip could end: below, coefficients of its direction leave the range of
doubles, and above, in units that were chosen for such a time, those of all else vanish."""
TURNING = 2.0**20
"""How much more than that of places the tolerance of rates is that turn with a slip: steps beside its end are short."""

LAST_DIGITS = 43.0
"""Bits of the coefficients of highest order for which doubles suffice: ten less than they have."""


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
def at_state(table: Packed, q: Floats, v: Floats, rates: Floats, lines: Floats) -> None:
    """Fill in the entries of W and X at a state of shapes (n, 2), with space for the rates of shape (2, n)."""
    entries_of_lines_pairs(table, q, lines)
    if table.slides.at.shape[0] > 0:
        for i in range(v.shape[0]):
            rates[0, i], rates[1, i] = v[i, 0], v[i, 1]
        put_friction(table, rates, 0, lines)


@kernel()
def coefficients_pairs(table: Packed, space: Saddle, products: Products, until: int, known: Floats) -> None:
    """Fill in the Taylor coefficients of the path up to until + 1 in pairs, and the others in doubles.

    Parameters
    ----------
    known : (planes, orders * size)
        The path where it is known otherwise, so that multipliers alone are wanted; of no columns where it is not.
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    at, factor, high, low, columns = products.at, products.factor, products.sums[0], products.sums[1], space.columns
    path, right, size = products.path, products.right, products.right.shape[1]
    last = products.inverses.shape[0] - 3
    path[1, 2 * size :] = 0.0
    for k in range(until):
        right[:] = 0.0
        if k == 0:
            for i in range(n):
                right[0, i], right[1, i] = table.load[i, 0], table.load[i, 1]
        for p in range(table.stiff.shape[0]):
            i, j = table.stiff_at[p, 0], k * size + table.stiff_at[p, 1]
            right[0, i], right[1, i] = gathered(
                right[0, i], right[1, i], -table.stiff[p, 0], -table.stiff[p, 1], path[0, j], path[1, j]
            )
        for p in range(table.damp.shape[0]):
            i, j = table.damp_at[p, 0], (k + 1) * size + table.damp_at[p, 1]
            ph, pl = dd_mul_d(path[0, j], path[1, j], k + 1.0)
            right[0, i], right[1, i] = gathered(right[0, i], right[1, i], -table.damp[p, 0], -table.damp[p, 1], ph, pl)
        if table.laws.push.shape[0] > 0:
            values_of_laws(table.laws, path, size, k, products.way[0], products.laws)
        _pushed(table.laws, products.laws, k, right)
        if table.slides.at.shape[0] > 0:
            add_turning(table, products, k)
        summed_pairs(products, k)
        for p in range(at.shape[0]):
            row = np.uintp(at[p, ROW])
            rh, rl = right[0, row], right[1, row]
            right[0, row], right[1, row] = gathered(rh, rl, factor[p, 0], factor[p, 1], high[p], low[p])
        for i in range(n + m):
            sh, sl = settled(right[0, i], right[1, i])
            right[0, i], right[1, i] = (sh, sl) if i < n else dd_mul_d(sh, sl, -(k + 1.0))
        for b in range(0, size, WIDTH):
            sh, sl = _multiplied(columns, right, n + m, b)
            # The factors of a derivative are formed in pairs: they are not powers of two.
            uh, ul = dd_mul(sh, sl, alike(products.inverses[k + 1, 0]), alike(products.inverses[k + 1, 1]))
            qh, ql = dd_mul(uh, ul, alike(products.inverses[k + 2, 0]), alike(products.inverses[k + 2, 1]))
            for plane in range(2):
                now = products.now[plane]
                put_lanes(now, b, ql if plane else qh)
                put_lanes(now, size + b, ul if plane else uh)
                put_lanes(now, 2 * size + b, sl if plane else sh)
                put_lanes(path[plane], (k + 2) * size + b, ql if plane else qh)
        if known.shape[1] > 0:
            for i in range(n):
                qh, ql = known[0, (k + 2) * size + i], known[1, (k + 2) * size + i]
                uh, ul = dd_mul_d(qh, ql, k + 2.0)
                path[0, (k + 2) * size + i], path[1, (k + 2) * size + i] = qh, ql
                products.now[0, i], products.now[1, i] = qh, ql
                products.now[0, size + i], products.now[1, size + i] = uh, ul
        if k < last:
            spread_pairs(table, products, k)
    coefficients(table, space, products, until)


@kernel()
def _pushed(laws: PackedLaws, values: Floats, k: int, right: Floats) -> None:
    """Add coefficient k of the forces of laws to a right-hand side of shape (2, s)."""
    for p in range(laws.push.shape[0]):
        i, o = laws.push_at[p, 0], laws.push_at[p, 1]
        right[0, i], right[1, i] = gathered(
            right[0, i], right[1, i], laws.push[p, 0], laws.push[p, 1], values[o, k, 0], values[o, k, 1]
        )


@kernel(forceinline=True)
def _multiplied(columns: Floats, right: Floats, count: int, b: int) -> Pair:
    """Return eight entries of the product of a matrix, by its columns, with a vector, from entry b on."""
    size = right.shape[1]
    sh, sl = alike(0.0), alike(0.0)
    for j in range(count):
        if right[0, j] != 0.0:
            sh, sl = gathered(
                sh,
                sl,
                lanes_at(columns[0], j * size + b),
                lanes_at(columns[1], j * size + b),
                alike(right[0, j]),
                alike(right[1, j]),
            )
    return settled(sh, sl)


@kernel()
def correct_pairs(table: Packed, space: Saddle, lines: Floats, q: Floats, v: Floats) -> None:
    """Put a place back on the measures, and the rates onto the rows there; q and v of shape (n, 2).

    Residuals are formed in pairs; what they change is so small that doubles suffice for it.
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    columns = space.columns[0]
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
    for i in range(n):
        total = 0.0
        for r in range(m):
            if table.held[r] == 1:
                total += columns[n + r, i] * (residual[r, 0] + residual[r, 1])
        q[i, 0], q[i, 1] = dd_add_d(q[i, 0], q[i, 1], total)
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
    for i in range(n):
        total = 0.0
        for r in range(m):
            total += columns[n + r, i] * (residual[r, 0] + residual[r, 1])
        v[i, 0], v[i, 1] = dd_add_d(v[i, 0], v[i, 1], total)


@kernel(forceinline=True)
def moved_lanes(high: Floats, low: Floats, at: int, of_power: int, order: int, by: float, q: Floats, v: Floats) -> None:
    """Evaluate eight series a time later, into places and rates of shape (2, s), from `at` on.

    By Horner's rule for the sum and its derivative at once, the tails summed in doubles.

    Parameters
    ----------
    high, low : ndarray
        Coefficient k of the eight from `at` + k `of_power` on.
    by : float
        Eight times.
    """
    last, tail = order * of_power + at, q.size // 2 + at
    sh, sl = lanes_at(high, last), lanes_at(low, last)
    rh, rl = alike(0.0), alike(0.0)
    for k in range(last - of_power, at - of_power, -of_power):
        ph, pl = two_prod(rh, by)
        rh, e = two_sum(ph, sh)
        rl = fma(rl, by, pl + (e + sl))
        ph, pl = two_prod(sh, by)
        sh, e = two_sum(ph, lanes_at(high, k))
        sl = fma(sl, by, pl + (e + lanes_at(low, k)))
    sh, sl = fast_two_sum(sh, sl)
    rh, rl = fast_two_sum(rh, rl)
    put_lanes(q, at, sh)
    put_lanes(q, tail, sl)
    put_lanes(v, at, rh)
    put_lanes(v, tail, rl)


@kernel()
def moved_pairs(c: Floats, hh: float, hl: float, q: Floats, v: Floats) -> None:
    """Evaluate a series c of shape (n, order + 1, 2) a pair of time later, into q and v of shape (n, 2)."""
    n, order = c.shape[0], c.shape[1] - 1
    for i in range(n):
        # Horner's rule for the sum s and its derivative r at once, the tails summed in doubles.
        sh, sl = c[i, order, 0], c[i, order, 1]
        rh, rl = 0.0, 0.0
        for k in range(order - 1, -1, -1):
            ph, pl = two_prod(rh, hh)
            pl = fma(rl, hh, fma(rh, hl, pl + sl))
            rh, e = two_sum(ph, sh)
            rl = pl + e
            ph, pl = two_prod(sh, hh)
            pl = fma(sl, hh, fma(sh, hl, pl + c[i, k, 1]))
            sh, e = two_sum(ph, c[i, k, 0])
            sl = pl + e
        q[i, 0], q[i, 1] = fast_two_sum(sh, sl)
        v[i, 0], v[i, 1] = fast_two_sum(rh, rl)


@kernel()
def paired_coefficients(order: int, tolerance: float) -> int:
    """Return up to which order coefficients are formed in pairs.

    Coefficient k is to about tolerance^(k / order) of the first ones: doubles do for those of the last digits.
    """
    return min(max(int(order * (1.0 + LAST_DIGITS / math.log2(tolerance))), 1), order - 1)


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
    space, products = saddle_space(table, 2), products_of(table, order, 2)
    path, size = products.path, products.right.shape[1]
    moved = np.empty((2, 2, size))
    paired = paired_coefficients(order, tolerance)
    nothing_known = np.zeros((2, 0))
    moving = np.empty((2, n))
    at_state(table, q, v, moving, lines)
    found = inverted_pairs(table, lines, space)
    if found == FAILED:
        return SINGULAR, 0
    way = 1.0 if end >= clock[0] else -1.0
    products.way[0] = way
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left * way <= 0.0:
            return DONE, step
        for i in range(n):
            path[0, i], path[1, i] = q[i, 0], q[i, 1]
            path[0, size + i], path[1, size + i] = v[i, 0], v[i, 1]
        started(table, products)
        # Where doubles do not invert the matrix, they do not do for any coefficient.
        coefficients_pairs(table, space, products, paired if found == CORRECTED else order - 1, nothing_known)
        c = series[step]
        for i in range(n):
            for k in range(order + 1):
                c[i, k, 0], c[i, k, 1] = path[0, k * size + i], path[1, k * size + i]
        if not np.all(np.isfinite(c[:, order, 0])):
            # Beside a collision the last coefficients overflow before the step is too short; a formula has no value.
            known = np.all(np.isfinite(c[:, 2, 0])) or table.laws.operations.shape[0] > 0
            return (SINGULAR if known else LOST), step
        h = way * step_size(c[:, :, 0], table.group, tolerance, lowest_bound(table.laws.gaps, order))
        if table.slides.at.shape[0] > 0:
            reach = least_reach(table, products)
            if reach < SOON or (reach > LATE and table.slides.finer > 0):
                return SLOWED, step
            h = way * min(abs(h), longest_step(table, products, TURNING * tolerance))
        if not abs(h) > SHORTEST * max(1.0, abs(clock[0])):
            return (SINGULAR if abs(h) >= 0.0 or table.laws.operations.shape[0] > 0 else LOST), step
        if abs(h) >= abs(left):
            h = left
        if table.laws.operations.shape[0] > 0:
            h = until_corner(table.laws, products.laws, h)
            if not abs(h) >= 0.0:
                return STUCK, step
        for b in range(0, size, WIDTH):
            moved_lanes(path[0], path[1], b, size, order, alike(h), moved[0], moved[1])
        for i in range(n):
            q[i, 0], q[i, 1] = moved[0, 0, i], moved[0, 1, i]
            v[i, 0], v[i, 1] = moved[1, 0, i], moved[1, 1, i]
            if not (abs(q[i, 0]) < FARTHEST and abs(v[i, 0]) < FARTHEST):
                formed = math.isfinite(q[i, 0]) and math.isfinite(v[i, 0])
                return (LOST if formed or table.laws.operations.shape[0] == 0 else SINGULAR), step
        at_state(table, q, v, moving, lines)
        found = inverted_pairs(table, lines, space)
        if found == FAILED:
            return SINGULAR, step
        if m > 0:
            correct_pairs(table, space, lines, q, v)
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
    space = saddle_space(table, 2)
    right, found = np.zeros((2, padded(n + m))), np.empty((2, padded(n + m)))
    path, laws = np.empty((2, 2 * n)), np.zeros((table.laws.operations.shape[0], 1, 2))
    rates = np.empty((2, n))
    for s in range(q.shape[0]):
        at_state(table, q[s], v[s], rates, lines)
        if inverted_pairs(table, lines, space) == FAILED:
            return s
        right[:] = 0.0
        for i in range(n):
            right[0, i], right[1, i] = table.load[i, 0], table.load[i, 1]
        for p in range(table.stiff.shape[0]):
            i, j = table.stiff_at[p, 0], table.stiff_at[p, 1]
            right[0, i], right[1, i] = gathered(
                right[0, i], right[1, i], -table.stiff[p, 0], -table.stiff[p, 1], q[s, j, 0], q[s, j, 1]
            )
        for p in range(table.damp.shape[0]):
            i, j = table.damp_at[p, 0], table.damp_at[p, 1]
            right[0, i], right[1, i] = gathered(
                right[0, i], right[1, i], -table.damp[p, 0], -table.damp[p, 1], v[s, j, 0], v[s, j, 1]
            )
        for p in range(table.gyre.shape[0]):
            i, j, l = table.gyre_at[p, 0], table.gyre_at[p, 1], table.gyre_at[p, 2]  # noqa: E741
            ph, pl = dd_mul(q[s, j, 0], q[s, j, 1], v[s, l, 0], v[s, l, 1])
            right[0, i], right[1, i] = gathered(right[0, i], right[1, i], table.gyre[p, 0], table.gyre[p, 1], ph, pl)
        for p in range(table.slopes.shape[0]):
            e, l = table.slopes_at[p, 0], table.slopes_at[p, 1]  # noqa: E741
            if table.binds[e] == 0:
                continue
            r, j = n + table.lines_at[e, 0], table.lines_at[e, 1]
            ph, pl = dd_mul(v[s, l, 0], v[s, l, 1], v[s, j, 0], v[s, j, 1])
            right[0, r], right[1, r] = gathered(
                right[0, r], right[1, r], -table.slopes[p, 0], -table.slopes[p, 1], ph, pl
            )
        if table.laws.push.shape[0] > 0:
            for i in range(n):
                path[0, i], path[1, i] = q[s, i, 0], q[s, i, 1]
                path[0, n + i], path[1, n + i] = v[s, i, 0], v[s, i, 1]
            values_of_laws(table.laws, path, n, 0, 1.0, laws)
            _pushed(table.laws, laws, 0, right)
        for i in range(n + m):
            right[0, i], right[1, i] = settled(right[0, i], right[1, i])
        for b in range(0, right.shape[1], WIDTH):
            sh, sl = _multiplied(space.columns, right, n + m, b)
            put_lanes(found[0], b, sh)
            put_lanes(found[1], b, sl)
        for i in range(n):
            acceleration[s, i, 0], acceleration[s, i, 1] = found[0, i], found[1, i]
        for r in range(m):
            multipliers[s, r, 0], multipliers[s, r, 1] = found[0, n + r], found[1, n + r]
    return len(q)

"""Steps of a stiff motion by collocation in pairs of doubles: the kernel.

The unknowns of a step are accelerations and multipliers at the nodes of a Radau IIA method, where the equation holds.
They are found by Newton's method with the derivatives at the middle of the step: in the eigenvectors of the method's
matrix, whose eigenvalues are g, the systems of the stages fall apart into

    (M~ + h g D~ + h^2 g^2 K~) x = r,

one for each conjugate pair. Residuals are formed in pairs, so that what derivatives in doubles miss costs iterations
alone. Accelerations of a step are a polynomial, whose last Legendre coefficients choose the step; the coordinates are
its integrals, so that a step is a series in time as those of `motion.series_pairs` are. At the end the place is put
back on the measures.

References
----------
E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.8.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_add_d, dd_div_d, dd_mul, dd_mul_d
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.equations.saddle import Saddle, inverted, saddle_space
from core.multibody.motion.linearised import Linearised, linearise, linearised_space, residual
from core.multibody.motion.radau import Complexes, Radau
from core.multibody.motion.series import DONE, FULL, LOST, SHORTEST, SINGULAR
from core.multibody.motion.series_pairs import correct_pairs, entries_of_lines_pairs

MOST_ITERATIONS = 40
"""Iterations for a step; more are taken by the two steps of half the length together."""
SLOWEST = 0.7
"""Contraction of an iteration above which a shorter step, whose derivatives change less, is better."""
REACHED = 2.0**-6
"""Share of the tolerance that may be left of the iteration's last change."""
ROUNDED = 2.0**-40
"""Share of the motion below which changes that do not become smaller are rounding: an iteration that does not contract
shows by larger ones, and rounding is 2^-100 of forces that may be far larger than what they leave."""
NOISE = 16.0
"""Last coefficients, in units of the changes that rounding makes at the nodes, that may be rounding: they are sums."""
LONGER, SHORTER, MARGIN = 4.0, 0.1, 0.85
"""How much longer than the last a step may be, how much shorter at once, and the share of what the last coefficients
allow that is taken."""
BEFORE_LAST = 2.0**-4
"""Share of the last coefficient but one that the last one is taken to be at least: of what is even about the middle of
a step every other one vanishes."""


class Stages(NamedTuple):
    """Space for a step of s stages.

    Attributes
    ----------
    unknowns, missed : (s, n + m, 2)
    places, rates : (s, n, 2)
    modes : (p, n + m)
    matrices : (p, n + m, n + m)
        Factored.
    pivots : (p, n + m)
    """

    unknowns: Floats
    missed: Floats
    places: Floats
    rates: Floats
    modes: Complexes
    matrices: Complexes
    pivots: Floats


@kernel()
def _stages(method: Radau, n: int, size: int) -> Stages:
    s, p = method.values.shape[0], method.eigenvalues.shape[0]
    return Stages(
        np.zeros((s, size, 2)),
        np.zeros((s, size, 2)),
        np.zeros((s, n, 2)),
        np.zeros((s, n, 2)),
        np.zeros((p, size), np.complex128),
        np.zeros((p, size, size), np.complex128),
        np.zeros((p, size)),
    )


@kernel()
def factored(a: Complexes, pivots: Floats) -> bool:
    """Factor a matrix in place with scaled pivots; return whether it is regular."""
    n = a.shape[0]
    scale = np.empty(n)
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[i, j].real) + abs(a[i, j].imag))
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            size = (abs(a[i, k].real) + abs(a[i, k].imag)) * scale[i]
            if size > best:
                pivot, best = i, size
        if not best > 0.0:
            return False
        pivots[k] = pivot
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            scale[pivot] = scale[k]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                factor = a[i, k] * inverse
                a[i, k] = factor
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
    return True


@kernel()
def solved(a: Complexes, pivots: Floats, x: Complexes) -> None:
    """Replace a right side by the solution of the factored system."""
    n = a.shape[0]
    for k in range(n):
        pivot = int(pivots[k])
        x[k], x[pivot] = x[pivot], x[k]
    for k in range(n):
        for j in range(k):
            x[k] -= a[k, j] * x[j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= a[k, j] * x[j]
        x[k] /= a[k, k]


@kernel()
def _at_nodes(method: Radau, q: Floats, v: Floats, h: float, stages: Stages) -> None:
    """Fill in places and rates at the nodes from the accelerations there."""
    s, n = stages.places.shape[0], stages.places.shape[1]
    x = stages.unknowns
    for k in range(s):
        ch, cl = dd_mul_d(method.nodes[k, 0], method.nodes[k, 1], h)
        for i in range(n):
            sh, sl, rh, rl = 0.0, 0.0, 0.0, 0.0
            for j in range(s):
                ah, al = x[j, i, 0], x[j, i, 1]
                sh, sl = gathered(sh, sl, method.places[k, j, 0], method.places[k, j, 1], ah, al)
                rh, rl = gathered(rh, rl, method.rates[k, j, 0], method.rates[k, j, 1], ah, al)
            sh, sl = settled(sh, sl)
            rh, rl = settled(rh, rl)
            sh, sl = dd_mul_d(sh, sl, h)
            sh, sl = dd_mul_d(sh, sl, h)
            rh, rl = dd_mul_d(rh, rl, h)
            ph, pl = dd_mul(ch, cl, v[i, 0], v[i, 1])
            ph, pl = dd_add(ph, pl, q[i, 0], q[i, 1])
            stages.places[k, i, 0], stages.places[k, i, 1] = dd_add(ph, pl, sh, sl)
            stages.rates[k, i, 0], stages.rates[k, i, 1] = dd_add(v[i, 0], v[i, 1], rh, rl)


@kernel()
def _factored_at(method: Radau, h: float, at: Linearised, stages: Stages) -> bool:
    """Factor the systems of a step of length h; return whether all are regular."""
    size, n = at.damping.shape
    for p in range(method.eigenvalues.shape[0]):
        a, g = stages.matrices[p], h * method.eigenvalues[p]
        for i in range(size):
            for j in range(size):
                a[i, j] = at.mass[i, j]
            for j in range(n):
                a[i, j] += g * (at.damping[i, j] + g * at.stiffness[i, j])
        if not factored(a, stages.pivots[p]):
            return False
    return True


@kernel()
def _iterate(
    table: Packed, method: Radau, h: float, bounds: Floats, tolerance: float, q: Floats, v: Floats, stages: Stages
) -> float:
    """Find the unknowns of a step from a guess; return how large their rounding is, infinite if they are not found.

    Parameters
    ----------
    bounds : (n, 2)
        Sizes of places and rates, of which `tolerance` is a share.
    """
    s, size, n = stages.unknowns.shape[0], stages.unknowns.shape[1], stages.places.shape[1]
    p = method.eigenvalues.shape[0]
    lines = np.empty((table.lines.shape[0], 2))
    path, values = np.empty((2, 2 * n)), np.zeros((table.laws.operations.shape[0], 1, 2))
    before, last = np.inf, np.inf
    for turn in range(MOST_ITERATIONS):
        _at_nodes(method, q, v, h, stages)
        for k in range(s):
            entries_of_lines_pairs(table, stages.places[k], lines)
            residual(
                table, stages.places[k], stages.rates[k], stages.unknowns[k], lines, path, values, stages.missed[k]
            )
        for a in range(p):
            for i in range(size):
                total = 0.0j
                for k in range(s):
                    total += method.to_modes[a, k] * stages.missed[k, i, 0]
                stages.modes[a, i] = total
            solved(stages.matrices[a], stages.pivots[a], stages.modes[a])
        change = 0.0
        for k in range(s):
            for i in range(size):
                total = 0.0
                for a in range(p):
                    factor, mode = method.from_modes[k, a], stages.modes[a, i]
                    total += factor.real * mode.real - factor.imag * mode.imag
                x = stages.unknowns[k, i]
                x[0], x[1] = dd_add_d(x[0], x[1], -total)
                if i < n:
                    moved = h * abs(total)
                    if not moved < np.inf:
                        return np.inf
                    change = max(change, moved / bounds[i, 1], h * moved / bounds[i, 0])
        if change <= REACHED * tolerance:
            _at_nodes(method, q, v, h, stages)
            return 0.0
        # Of two iterations in a row, as the first may come closer by chance.
        if turn > 1 and change > SLOWEST**2 * before:
            if change > ROUNDED:
                return np.inf
            _at_nodes(method, q, v, h, stages)
            return change
        before, last = last, change
    return np.inf


@kernel()
def _last_terms(method: Radau, h: float, bounds: Floats, stages: Stages) -> float:
    """Return how large the last terms of the accelerations make places and rates, in units of their bounds."""
    s, n = stages.places.shape[0], stages.places.shape[1]
    largest = 0.0
    for i in range(n):
        one, other, rest, tail = 0.0, 0.0, 0.0, 0.0
        for k in range(s):
            x = stages.unknowns[k, i]
            one, rest = gathered(one, rest, method.last[0, k, 0], method.last[0, k, 1], x[0], x[1])
            other, tail = gathered(other, tail, method.last[1, k, 0], method.last[1, k, 1], x[0], x[1])
        one, other = one + rest, other + tail
        # The integral of the polynomial of degree s - 1 is at most 1/(2 s) of it.
        moved = h * max(abs(other), BEFORE_LAST * abs(one)) / (2.0 * s)
        largest = max(largest, moved / bounds[i, 1], h * moved / (2.0 * s * bounds[i, 0]))
    return largest


@kernel()
def _bounded(table: Packed, q: Floats, v: Floats, largest: Floats) -> None:
    """Take up the sizes of places and rates so far, shape (groups, 2)."""
    for i in range(len(q)):
        g = table.group[i]
        largest[g, 0] = max(largest[g, 0], abs(q[i, 0]))
        largest[g, 1] = max(largest[g, 1], abs(v[i, 0]))


@kernel()
def _bounds(table: Packed, largest: Floats, h: float, x: Floats, bounds: Floats) -> None:
    """Fill in what places and rates are measured by: the largest so far, or what the step makes of them."""
    n = len(bounds)
    gained = np.zeros(len(largest))
    for i in range(n):
        gained[table.group[i]] = max(gained[table.group[i]], abs(x[i, 0]) * h)
    for i in range(n):
        g = table.group[i]
        bounds[i, 1] = max(largest[g, 1], gained[g], 2.0**-900)
        bounds[i, 0] = max(largest[g, 0], h * bounds[i, 1])


@kernel()
def _guess(method: Radau, ratio: float, before: Floats, stages: Stages) -> None:
    """Continue the accelerations and multipliers of the last step, shape (s, n + m, 2), to the nodes of the next."""
    s, size = stages.unknowns.shape[0], stages.unknowns.shape[1]
    weights = np.empty(s)
    stages.unknowns[:] = 0.0
    for k in range(s):
        share = 1.0 + ratio * method.nodes[k, 0]
        for j in range(s):
            total = 0.0
            for power in range(s - 1, -1, -1):
                total = total * share + method.values[power, j]
            weights[j] = total
        for i in range(size):
            total = 0.0
            for j in range(s):
                total += weights[j] * before[j, i, 0]
            stages.unknowns[k, i, 0] = total


@kernel()
def _filled(method: Radau, h: float, q: Floats, v: Floats, stages: Stages, c: Floats) -> None:
    """Fill in the coefficients of the coordinates in powers of time, shape (n, s + 2, 2)."""
    s = stages.places.shape[0]
    for i in range(len(q)):
        c[i, 0, 0], c[i, 0, 1], c[i, 1, 0], c[i, 1, 1] = q[i, 0], q[i, 1], v[i, 0], v[i, 1]
        for k in range(s):
            sh, sl = 0.0, 0.0
            for j in range(s):
                x = stages.unknowns[j, i]
                sh, sl = gathered(sh, sl, method.powers[k, j, 0], method.powers[k, j, 1], x[0], x[1])
            sh, sl = settled(sh, sl)
            for _ in range(k):
                sh, sl = dd_div_d(sh, sl, h)
            c[i, k + 2, 0], c[i, k + 2, 1] = sh, sl


@kernel()
def _unknowns_at(table: Packed, space: Saddle, q: Floats, v: Floats, x: Floats) -> bool:
    """Fill in accelerations and multipliers at a state, shape (n + m, 2), in doubles; return whether they are known."""
    size, n = len(x), len(q)
    lines, missed = np.empty((table.lines.shape[0], 2)), np.empty((size, 2))
    path, values = np.empty((2, 2 * n)), np.zeros((table.laws.operations.shape[0], 1, 2))
    entries_of_lines_pairs(table, q, lines)
    if not inverted(table, lines[:, 0].copy(), space):
        return False
    x[:] = 0.0
    residual(table, q, v, x, lines, path, values, missed)
    for i in range(size):
        for j in range(size):
            x[i, 0] -= space.columns[0, j, i] * missed[j, 0]
    return True


@kernel()
def linearised_at(table: Packed, q: Floats, v: Floats) -> Linearised:
    """Return the derivatives of the equation at a state; no numbers where accelerations are not determined."""
    at, x = linearised_space(table), np.zeros((table.load.shape[0] + table.rate.shape[0], 2))
    if not _unknowns_at(table, saddle_space(table, 1), q, v, x):
        x[:] = np.nan
    linearise(table, q, v, x, at)
    return at


@kernel()
def advance_collocated(
    table: Packed,
    method: Radau,
    q: Floats,
    v: Floats,
    clock: Floats,
    end: float,
    tolerance: float,
    largest: Floats,
    first: float,
    starts: Floats,
    series: Floats,
) -> tuple[int, int, float]:
    """Take steps forwards until the time `end` or until the arrays are full.

    Parameters
    ----------
    q, v : (n, 2)
        State, moved along.
    clock : (2,)
        Time as a pair; moved along.
    tolerance : float
        Share of the largest place and rate of their group so far that the last terms of a step may be.
    largest : (groups, 2)
        These sizes; brought up to date.
    first : float
        Length of the first step that is tried.
    starts : (c + 1, 2)
    series : (c, n, s + 2, 2)

    Returns
    -------
    tuple of int, int and float
        How it ended, the number of steps, and the length of the next one.
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    size = n + m
    stages, at, space = _stages(method, n, size), linearised_space(table), saddle_space(table, 1)
    bounds, before = np.empty((n, 2)), np.empty((method.values.shape[0], size, 2))
    lines = np.empty((table.lines.shape[0], 2))
    middle = method.values.shape[0] // 2
    h, length, known = first, 0.0, False
    _bounded(table, q, v, largest)
    for step in range(series.shape[0]):
        starts[step, 0], starts[step, 1] = clock[0], clock[1]
        left = (end - clock[0]) - clock[1]
        if left <= 0.0:
            return DONE, step, h
        while True:
            if not h > SHORTEST * max(1.0, abs(clock[0])) * 2.0**-20:
                return SINGULAR, step, h
            taken = min(h, left)
            if known:
                _guess(method, taken / length, before, stages)
            elif not _unknowns_at(table, space, q, v, before[0]):
                return SINGULAR, step, h
            else:
                for k in range(before.shape[0]):
                    stages.unknowns[k] = before[0]
            _bounds(table, largest, taken, stages.unknowns[middle], bounds)
            _at_nodes(method, q, v, taken, stages)
            linearise(table, stages.places[middle], stages.rates[middle], stages.unknowns[middle], at)
            rounding = np.inf
            if _factored_at(method, taken, at, stages):
                rounding = _iterate(table, method, taken, bounds, tolerance, q, v, stages)
            if not rounding < np.inf:
                h = 0.25 * taken
                continue
            wrong = max(_last_terms(method, taken, bounds, stages) - NOISE * rounding, 0.0) / tolerance
            share = MARGIN * wrong ** (-1.0 / stages.places.shape[0]) if wrong > 0.0 else LONGER
            if wrong <= 1.0:
                break
            h = taken * max(share, SHORTER)
        _filled(method, taken, q, v, stages, series[step])
        last = stages.places.shape[0] - 1
        q[:], v[:] = stages.places[last], stages.rates[last]
        before[:], length, known = stages.unknowns, taken, True
        for i in range(n):
            if not (abs(q[i, 0]) < 1e150 and abs(v[i, 0]) < 1e150):
                return LOST, step, h
        if m > 0:
            entries_of_lines_pairs(table, q, lines)
            if not inverted(table, lines[:, 0].copy(), space):
                return SINGULAR, step, h
            correct_pairs(table, space, lines, q, v)
        _bounded(table, q, v, largest)
        clock[0], clock[1] = dd_add_d(clock[0], clock[1], taken)
        starts[step + 1, 0], starts[step + 1, 1] = clock[0], clock[1]
        if taken == left:
            return DONE, step + 1, h
        h = taken * min(max(share, SHORTER), LONGER)
    return FULL, series.shape[0], h

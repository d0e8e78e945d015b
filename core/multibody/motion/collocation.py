"""Steps of a stiff motion by collocation in pairs of doubles: the kernel.

The unknowns of a step are accelerations and multipliers at the nodes of a Radau IIA method (`motion.stages`).
Accelerations of a step are a polynomial, whose last Legendre coefficients choose the step; the coordinates are its
integrals, so that a step is a series in time as those of `motion.series_pairs` are. At the end the place is put back on
the measures.
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add_d, dd_div_d
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.equations.packed import Packed
from core.multibody.equations.saddle import inverted, saddle_space
from core.multibody.motion.linearised import linearise, linearised_space, unknowns_at
from core.multibody.motion.radau import Radau
from core.multibody.motion.series import DONE, FULL, LOST, SHORTEST, SINGULAR
from core.multibody.motion.series_pairs import correct_pairs, entries_of_lines_pairs
from core.multibody.motion.stages import Stages, at_nodes, factored_at, guess, iterate, stages_of

NOISE = 16.0
"""Last coefficients, in units of the changes that rounding makes at the nodes, that may be rounding: they are sums."""
LONGER, SHORTER, MARGIN = 4.0, 0.1, 0.85
"""How much longer than the last a step may be, how much shorter at once, and the share of what the last coefficients
allow that is taken."""
BEFORE_LAST = 2.0**-4
"""Share of the last coefficient but one that the last one is taken to be at least: of what is even about the middle of
a step every other one vanishes."""


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
    stages, at, space = stages_of(method, n, size), linearised_space(table), saddle_space(table, 1)
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
                guess(method, taken / length, before, stages)
            elif not unknowns_at(table, space, q, v, before[0]):
                return SINGULAR, step, h
            else:
                for k in range(before.shape[0]):
                    stages.unknowns[k] = before[0]
            _bounds(table, largest, taken, stages.unknowns[middle], bounds)
            at_nodes(method, q, v, taken, stages)
            linearise(table, stages.places[middle], stages.rates[middle], stages.unknowns[middle], at)
            rounding = np.inf
            if factored_at(method, taken, at, stages):
                rounding = iterate(table, method, taken, bounds, tolerance, q, v, stages)
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

"""The Taylor series of a table's motion about many states at once, in pairs of doubles: the kernel.

It forms the coefficients as the steps of `motion.series_pairs` do, multipliers included, and says over which time their
last ones are small. The states are known otherwise than by steps, and no error grows from one to the next.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import dd_mul_d
from core.multibody.equations.packed import FORCES, Packed
from core.multibody.equations.saddle import FAILED, Saddle, inverted_pairs, saddle_space
from core.multibody.laws.corners import until_corner
from core.multibody.motion.products import Products, products_of, started
from core.multibody.motion.series_pairs import at_state, coefficients_pairs
from core.multibody.motion.step_sizes import lowest_bound, step_size
from core.multibody.motion.turning_friction import longest_step

ORDER = 22
"""Highest power of the coordinates; multipliers have two less."""
NEAR = 2.0**-44
"""Share of a step within which a corner is taken to be at its start."""
TOLERANCE = 2.0**-50
"""Share of the motion that the last powers are over a piece: a third of the radius of convergence."""


@kernel()
def _step(table: Packed, products: Products, own: Floats, group: Integers) -> float:
    """Return the step over which a path holds, whose coefficients are taken up into `own`.

    What rests under a formula has forces whose series alone bound it.
    """
    path, size, n = products.path, products.right.shape[1], table.load.shape[0]
    for k in range(own.shape[1]):
        for i in range(own.shape[0]):
            own[i, k] = path[0, k * size + i] if i < n or k > 1 else 0.0
    return step_size(own, group, TOLERANCE, lowest_bound(table.laws.gaps, own.shape[1] - 1))


@kernel()
def _to_corner(
    table: Packed, space: Saddle, products: Products, own: Floats, group: Integers, step: float, longest: float
) -> tuple[float, float]:
    """Return a step, and its part up to a corner of a formula; the series is that beyond a corner that is near."""
    way, order = products.way[0], own.shape[1] - 1
    within = min(step, longest)
    found = abs(until_corner(table.laws, products.laws, way * within))
    if found < NEAR * within:
        started(table, products)
        coefficients_pairs(table, space, products, order - 1, np.zeros((2, 0)))
        step = _step(table, products, own, group)
        within = min(step, longest)
        found = abs(until_corner(table.laws, products.laws, way * within))
    return step, found if found < within else step


@kernel()
def expand(
    table: Packed,
    q: Floats,
    v: Floats,
    reach: Floats,
    up: Floats,
    time: int,
    lengths: Floats,
    steps: Floats,
    series: Floats,
    sizes: Floats,
    known: Floats,
) -> int:
    """Fill in the series about some states; return how many were done before one where the connections lose their rank.

    Parameters
    ----------
    q, v : (t, n, 2)
        In the units of the table.
    reach : (t,)
        The longest times that are of interest (s), all of one sign.
    up, time : (n,) and int
        Units of the coordinates, and the exponent of that of time.
    lengths : (t,)
        Filled with the lengths of the pieces (s): powers of two, no longer than the least ones that cover the reach.
    steps : (t,)
        Times over which the last coefficients are small, or up to a corner of a formula (s): filled in unless known.
    series : (t, n + m, order + 1, 2)
        Filled with coefficients of powers of time as a share of the length, those of coordinates in SI units;
        multipliers have two less.
    sizes : (t, n + m, order + 1)
        Filled with the largest coefficient of the same group and power, to which rounding is in proportion.
    known : (t, 2, orders * s)
        The paths where they are known otherwise, over given steps, so that multipliers alone are wanted; else of none.
    """
    n, m = table.load.shape[0], table.rate.shape[0]
    order = series.shape[2] - 1
    lines = np.empty((table.lines.shape[0], 2))
    space, products = saddle_space(table, 2), products_of(table, order, 2)
    path, size = products.path, products.right.shape[1]
    rates = np.empty((2, n))
    own = np.empty((n + m if table.laws.gaps > 0 else n, order + 1))
    group = np.full(len(own), FORCES)
    group[:n] = table.group
    nothing = np.zeros((2, 0))
    way = 1.0 if reach[0] > 0.0 else -1.0
    products.way[0] = way
    for s in range(q.shape[0]):
        at_state(table, q[s], v[s], rates, lines)
        if inverted_pairs(table, lines, space) == FAILED:
            return s
        for i in range(n):
            path[0, i], path[1, i] = q[s, i, 0], q[s, i, 1]
            path[0, size + i], path[1, size + i] = v[s, i, 0], v[s, i, 1]
        started(table, products)
        coefficients_pairs(table, space, products, order - 1, known[s] if len(known) > 0 else nothing)
        mantissa, exponent = math.frexp(abs(reach[s]))
        exponent -= time + (mantissa == 0.5)
        longest = math.ldexp(1.0, min(exponent, 1000))
        step = math.ldexp(steps[s], -time)
        if len(known) == 0:
            step = min(_step(table, products, own, group), longest_step(table, products, TOLERANCE))
        corner = step
        if table.laws.operations.shape[0] > 0 and len(known) == 0:
            step, corner = _to_corner(table, space, products, own, group, step, longest)
        if not corner > 0.0:
            return s
        steps[s] = math.ldexp(corner, time)
        if corner < longest:
            exponent = math.floor(math.log2(step)) if corner >= step else math.ceil(math.log2(corner))
        lengths[s] = math.ldexp(way, exponent + time)
        for k in range(order + 1):
            # The powers of what does not change are zero, whatever the length.
            power = min(exponent * k, 1000)
            for i in range(n):
                series[s, i, k, 0] = math.ldexp(path[0, k * size + i], power)
                series[s, i, k, 1] = math.ldexp(path[1, k * size + i], power)
            largest = 0.0
            for r in range(m):
                high, low = 0.0, 0.0
                if k <= order - 2:
                    at = (k + 2) * size + n + r
                    high, low = dd_mul_d(path[0, at], path[1, at], (k + 1.0) * (k + 2.0))
                    # What presses together with others has their rounding, and that of the masses they move.
                    largest = max(largest, abs(high))
                series[s, n + r, k, 0] = math.ldexp(high, power)
                series[s, n + r, k, 1] = math.ldexp(low, power)
            if k <= order - 2:
                for i in range(n):
                    largest = max(largest, (k + 1.0) * (k + 2.0) * abs(path[0, (k + 2) * size + i]))
            for r in range(m):
                sizes[s, n + r, k] = math.ldexp(largest, power)
        # Motions that are even in time have odd powers of rounding alone: a power is at least as large as later ones.
        for k in range(order - 1, -1, -1):
            for r in range(m):
                sizes[s, n + r, k] = max(sizes[s, n + r, k], sizes[s, n + r, k + 1])
        for k in range(order, -1, -1):
            for i in range(n):
                most = sizes[s, i, k + 1] if k < order else 0.0
                for j in range(n):
                    if table.group[j] == table.group[i]:
                        most = max(most, abs(series[s, j, k, 0]))
                sizes[s, i, k] = most
        for k in range(order + 1):
            sign = way if k % 2 == 1 else 1.0
            for i in range(n + m):
                unit = up[i] if i < n else 1.0
                series[s, i, k, 0] *= sign * unit
                series[s, i, k, 1] *= sign * unit
                sizes[s, i, k] *= unit
    return len(q)

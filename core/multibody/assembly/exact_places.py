"""The nearest places in balls: the equations of Lagrange's method, solved to the digits of the set-up.

    G (q - q_0) + W^T lambda = 0,     g(q) = 0,

with the metric G, the sketch q_0 and the independent ones of the measures g. Doubles have found the solution to some
twelve digits; every step with their matrix finds as many again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import NotApplicable
from core.multibody.algebra.pivoting import pivoted
from core.multibody.algebra.polynomials import ZERO, Ball, Poly, evaluated, gradient, is_zero, size
from core.multibody.assembly.quadratics import Quadratics
from core.multibody.table.table import Table

STEPS = 130
"""Steps with one matrix: 34 of twelve digits each reach `DIGITS`; ill-conditioned ones gain three."""

DIGITS = 400
"""Decimal digits beside the size of the scene to which places are found: more than the 385 of the highest precision of
a set-up, so that what holds exactly is found to."""

GUARD = 7
"""Digits beyond these to which the equations are solved, so that rounding to `DIGITS` finds what is exact."""

BITS = 1440
"""Working precision: `DIGITS`, `GUARD` and 88 bits for what cancels."""

INDEPENDENT = 2.0**-24
"""Share of the largest pivot from which on doubles take a row to be redundant; balls check what is left of it."""


def sizes_of(table: Table, measures: Sequence[Poly], extent: float) -> Floats:
    """Return the sizes of the terms of measures in a scene of a size (m), shape (m,)."""
    least = {"m": extent, "1": 1.0, "1/m": 1.0 / extent}
    bounds = [abs(x).max(arb(least.get(unit, 0.0))) for x, unit in zip(table.q, table.units, strict=True)]
    return np.array([float(size(measure, bounds)) or 1.0 for measure in measures])


def exact_places(
    table: Table,
    measures: Sequence[Poly],
    metric: Mapping[tuple[int, int], Ball],
    movable: Sequence[int],
    found: Floats,
    extent: float,
) -> list[Ball]:
    """Return the coordinates of the nearest places, to `DIGITS`; the precision of balls is the caller's.

    Parameters
    ----------
    table : Table
        With the sketch as its places.
    metric : mapping
        Entries of G by two coordinates, both triangles.
    movable : sequence of int
        Coordinates that may change.
    found : ndarray, shape (n,)
        The places in doubles.
    extent : float
        Size of the scene (m).

    Raises
    ------
    NotApplicable
        Where the nearest places are not isolated, or singular.
    """
    sizes = sizes_of(table, measures, extent)
    in_doubles = Quadratics.of(measures, sizes, len(found))
    lines = in_doubles.jacobian(found)[:, movable]
    order, pivots = pivoted(lines.T)
    chosen = np.sort(order[: int(np.sum(pivots > INDEPENDENT * pivots.max(initial=0.0)))])
    place = {j: k for k, j in enumerate(movable)}
    weights = np.zeros((len(movable), len(movable)))
    for (i, j), value in metric.items():
        if i in place and j in place:
            weights[place[i], place[j]] = float(value)
    own = lines[chosen]
    away = weights @ (found - np.array([float(x) for x in table.q]))[movable]
    multipliers = np.linalg.lstsq(own.T, -away, rcond=None)[0]
    every = np.zeros(len(measures))
    every[chosen] = multipliers
    curved = weights + in_doubles.curvature(every)[np.ix_(movable, movable)]
    _require_isolated(curved, own)
    matrix = np.block([[curved, own.T], [own, np.zeros((len(chosen), len(chosen)))]])
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        raise _none_is_nearest() from None
    q = [arb(float(x)) if j in place else table.q[j] for j, x in enumerate(found)]
    pulls = [arb(float(x)) for x in multipliers]
    slopes = [gradient(measures[k]) for k in chosen]
    least = arb(10) ** -(DIGITS + GUARD) * min(extent, 1.0)
    for _ in range(STEPS):
        left = _left_over(table, [measures[k] for k in chosen], slopes, metric, movable, q, pulls, sizes[chosen])
        # What is left is below the range of doubles in the end: they see it over the largest.
        largest = max(abs(x.mid()) for x in left)
        shares = [0.0 if largest == 0 else float(x.mid() / largest) for x in left]
        step = inverse @ shares
        if not np.isfinite(step).all():
            break
        for j, change in zip(movable, step, strict=False):
            q[j] = (q[j] - largest * float(change)).mid()
        own_step = step[len(movable) :]
        pulls = [(x - largest * float(change)).mid() for x, change in zip(pulls, own_step, strict=True)]
        if largest * float(np.abs(step[: len(movable)]).max(initial=0.0)) <= least:
            _require_all(measures, q, sizes)
            return q
    raise _none_is_nearest()


def _require_isolated(curved: Floats, lines: Floats) -> None:
    """Raise `NotApplicable` where the displacement does not grow to second order in every direction that is free."""
    _, values, directions = np.linalg.svd(lines)
    free = directions[int(np.sum(values > INDEPENDENT * values.max(initial=0.0))) :].T
    bends = np.linalg.eigvalsh(free.T @ curved @ free)
    if bends.size and not bends[0] > INDEPENDENT * bends[-1]:
        raise _none_is_nearest()


def _none_is_nearest() -> NotApplicable:
    return NotApplicable(
        "several places are as near to the sketch, or the connections meet in a singular place: none is the nearest",
        path=("assemble",),
        remedy="move the sketch to one side",
    )


def _left_over(
    table: Table,
    measures: Sequence[Poly],
    slopes: Sequence[Mapping[int, Poly]],
    metric: Mapping[tuple[int, int], Ball],
    movable: Sequence[int],
    q: Sequence[Ball],
    pulls: Sequence[Ball],
    sizes: Floats,
) -> list[Ball]:
    """Return what is left over of the equations: of the movable coordinates, then of the measures."""
    total: dict[int, Ball] = {}
    for (i, j), value in metric.items():
        total[i] = total.get(i, ZERO) + value * (q[j] - table.q[j])
    for slope, pull, scale in zip(slopes, pulls, sizes, strict=True):
        for i, poly in slope.items():
            total[i] = total.get(i, ZERO) + pull / arb(float(scale)) * evaluated(poly, q)
    return [
        *(total.get(i, ZERO) for i in movable),
        *(evaluated(measure, q) / arb(float(scale)) for measure, scale in zip(measures, sizes, strict=True)),
    ]


def _require_all(measures: Sequence[Poly], q: Sequence[Ball], sizes: Floats) -> None:
    """Raise `NotApplicable` where a row that doubles took to be redundant does not hold."""
    for measure, scale in zip(measures, sizes, strict=True):
        left = evaluated(measure, q)
        if not is_zero(left) and not abs(left) < arb(10) ** -(DIGITS - 5) * float(scale):
            raise NotApplicable(
                "the connections meet in a singular place, where they lose their hold",
                path=("assemble",),
                remedy="change a length",
            )

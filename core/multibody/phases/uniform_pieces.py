"""A motion with constant accelerations: what is watched is a polynomial in time, its coefficients in balls.

Bounces in turn become shorter than pairs of doubles resolve beside the places at which they happen. The coefficients of
a gap, however small, are known to all their digits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, is_zero
from core.multibody.equations.expansion import Expansion, Series, expansion, product, slope
from core.multibody.equations.packed import pair, two_to
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import COEFFICIENTS, Pieces
from core.multibody.table.table import Table


def uniform_motion(table: Table, accelerations: Sequence[Ball]) -> Expansion:
    """Return a motion with constant accelerations, and the forces at its start, as an exact expansion."""
    places = [[q, v, a / 2, ZERO, ZERO] for q, v, a in zip(table.q, table.v, accelerations, strict=True)]
    # What is free has no multipliers to be found.
    multipliers = expansion(table, 2).multipliers if table.rows else []
    return Expansion(places, [[x[0], ZERO, ZERO] for x in multipliers])


def keeps_its_forces(table: Table, motion: Expansion) -> bool:
    """Return whether the forces at the start of a motion with constant accelerations move it at all times.

    They may change all the same: where their arms do, or a formula of what moves acts on what rests. The equations of
    motion with the multipliers of the start are polynomials in time, and hold at all times where every coefficient
    vanishes.
    """
    order, rates = motion.order, [slope(series) for series in motion.places]
    read = [(one, key[0]) for law in table.acting for one in law.inputs.values() for key in one.form if key]
    if any(not is_zero(x) for one, i in read for x in (rates if one.rate else motion.places)[i][1:]):
        return False
    left = [[ZERO] * order for _ in table.names]

    def add(i: int, factor: Ball, series: Sequence[Ball]) -> None:
        left[i] = [x + factor * y for x, y in zip(left[i], series[:order], strict=True)]

    for (i, j), stiffness in table.stiffness.items():
        add(i, stiffness, motion.places[j])
    for (i, j), damping in table.damping.items():
        add(i, damping, rates[j])
    for (i, j, k), gyration in table.gyration.items():
        add(i, -gyration, product(motion.places[j][:order], rates[k]))
    for row, multiplier in zip(table.rows, motion.multipliers, strict=True):
        for line in (row.rates, row.drag):
            for j, poly in line.items():
                add(j, -multiplier[0], motion.of(poly))
    return all(is_zero(x) for series in left for x in series[1:])


@dataclass(frozen=True)
class UniformPieces(Pieces):
    """A motion with constant accelerations on some intervals.

    Attributes
    ----------
    motions : list of Expansion
        From the start of each.
    """

    motions: tuple[Expansion, ...] = ()

    def place(self, i: int) -> Curve:
        """Return a coordinate."""
        return self.curve([motion.places[i] for motion in self.motions])

    def rate(self, i: int) -> Curve:
        """Return its rate."""
        return self.curve([slope(motion.places[i]) for motion in self.motions])

    def multiplier(self, row: int) -> Curve:
        """Return the multiplier of a row."""
        return self.curve([motion.multipliers[row] for motion in self.motions])

    def of(self, poly: Poly) -> Curve:
        """Return a polynomial of the coordinates."""
        return self.curve([motion.of(poly) for motion in self.motions])

    def of_rates(self, line: LinearForm) -> Curve:
        """Return a linear form in the rates."""
        return self.curve([motion.of_rates(line) for motion in self.motions])

    def curve(self, each: Sequence[Series]) -> Curve:
        """Return a quantity from its coefficients on every piece."""
        values = np.zeros((*self.shape, 2))
        for p, (series, length) in enumerate(zip(each, self.lengths, strict=True)):
            _, exponent = math.frexp(abs(length))
            for k, x in enumerate(series):
                if not is_zero(x):
                    values[p, k] = pair(x * (-1) ** (k * (length < 0.0)), k * (exponent - 1))
        return Curve(values, np.abs(values[..., 0]))


@dataclass(frozen=True)
class ExpandedUniform:
    """A motion with constant accelerations, from its exact expansion at time zero."""

    motion: Expansion

    def __call__(self, times: Floats, reach: Floats) -> UniformPieces:
        """Return the pieces, each as long as is of interest."""
        lengths = np.array([math.copysign(two_to(math.ceil(math.log2(abs(x)))), x) for x in reach])
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        sizes = nothing[..., 0]
        motions = tuple(self._from(float(t)) for t in times)
        return UniformPieces(lengths, np.full(len(times), np.inf), nothing, sizes, nothing, sizes, motions)

    def _from(self, time: float) -> Expansion:
        if time == 0.0:
            return self.motion
        q, v = self.motion.state(arb(time))
        places = [[a, b, *own[2:]] for a, b, own in zip(q, v, self.motion.places, strict=True)]
        return Expansion(places, self.motion.multipliers)

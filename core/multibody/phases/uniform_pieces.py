"""Pieces of a motion with constant accelerations: what is watched is a polynomial in time, its coefficients in balls.

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
from core.multibody.algebra.polynomials import is_zero
from core.multibody.equations.expansion import Expansion, Series, slope
from core.multibody.equations.packed import pair, two_to
from core.multibody.phases.crossings import state_of
from core.multibody.phases.watches import Watch
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import COEFFICIENTS, Pieces


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

    def curve(self, each: Sequence[Series]) -> Curve:
        """Return a quantity from its coefficients on every piece."""
        values = np.zeros((*self.shape, 2))
        for p, (series, length) in enumerate(zip(each, self.lengths, strict=True)):
            _, exponent = math.frexp(length)
            for k, x in enumerate(series):
                if not is_zero(x):
                    values[p, k] = pair(x, k * (exponent - 1))
        return Curve(values, np.abs(values[..., 0]))


@dataclass(frozen=True)
class ExpandedUniform:
    """A motion with constant accelerations, from its exact expansion at time zero."""

    motion: Expansion

    def __call__(self, times: Floats, reach: Floats) -> UniformPieces:
        """Return the pieces, each as long as is of interest."""
        lengths = np.array([two_to(math.ceil(math.log2(x))) for x in reach])
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        sizes = nothing[..., 0]
        motions = tuple(self._from(float(t)) for t in times)
        return UniformPieces(lengths, np.full(len(times), np.inf), nothing, sizes, nothing, sizes, motions)

    def _from(self, time: float) -> Expansion:
        if time == 0.0:
            return self.motion
        q, v = state_of(self.motion, arb(time))
        places = [[a, b, *own[2:]] for a, b, own in zip(q, v, self.motion.places, strict=True)]
        return Expansion(places, self.motion.multipliers)


def along_uniform(watch: Watch, pieces: Pieces) -> Curve:
    """Return what is watched along a motion with constant accelerations."""
    assert isinstance(pieces, UniformPieces)
    return pieces.curve([watch.series(motion) for motion in pieces.motions])

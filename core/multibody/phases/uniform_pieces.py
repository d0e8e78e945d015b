"""Pieces of a motion with constant accelerations: what is watched is a polynomial in time, its coefficients in balls.

Bounces in turn become shorter than pairs of doubles resolve beside the places at which they happen. The coefficients of
a gap, however small, are known to all their digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.polynomials import is_zero
from core.multibody.equations.expansion import Expansion
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
    values = np.zeros((*pieces.shape, 2))
    for p, (motion, length) in enumerate(zip(pieces.motions, pieces.lengths, strict=True)):
        _, exponent = math.frexp(length)
        for k, x in enumerate(watch.series(motion)):
            if not is_zero(x):
                values[p, k] = pair(x, k * (exponent - 1))
    return Curve(values, np.abs(values[..., 0]))

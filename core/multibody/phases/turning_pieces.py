"""Pieces of a motion while friction turns with the slip: those of its steps, about any time in them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.multibody.equations.packed import GROUPS, pair, two_to
from core.multibody.motion.series import lowest_bound, step_size
from core.multibody.motion.whole import Whole
from core.multibody.phases.turning_slip import TurningSlip
from core.multibody.search.pieces import COEFFICIENTS, Pieces
from core.multibody.search.taylor import ORDER, TOLERANCE


@dataclass(frozen=True)
class ExpandedInBalls:
    """The motion of a whole scene, from its states in pairs.

    Attributes
    ----------
    whole : Whole
    kind : {"fine", "check"}
    """

    whole: Whole
    kind: str

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        """Return the pieces, none of which is longer than the step of the motion in which it begins."""
        table = self.whole.measures.table
        group = np.array([GROUPS[unit] for unit in table.units], dtype=np.int64)
        n, rows = len(table.names), len(table.rows)
        lengths, natural = np.zeros(len(times)), np.zeros(len(times))
        places, multipliers = np.zeros((len(times), n, ORDER + 1, 2)), np.zeros((len(times), rows, COEFFICIENTS, 2))
        sizes, others = np.zeros(places.shape[:-1]), np.zeros(multipliers.shape[:-1])
        (_, turning), *_ = self.whole.parts
        assert isinstance(turning, TurningSlip)
        lowest = lowest_bound(self.whole.arrays[0].laws.gaps, ORDER)
        for s, time in enumerate(times.tolist()):
            motion, rest = turning.about(self.kind, time)
            coefficients = np.array([[float(x) for x in series[: ORDER + 1]] for series in motion.places])
            step = step_size(coefficients, group, TOLERANCE, lowest)
            natural[s], exponent = min(step, rest), math.ceil(math.log2(min(rest, reach[s])))
            if step < min(rest, reach[s]):
                exponent = math.floor(math.log2(step))
            lengths[s] = two_to(exponent)
            for i, series in enumerate(motion.places):
                places[s, i] = [pair(x, k * exponent) for k, x in enumerate(series[: ORDER + 1])]
            for i, series in enumerate(motion.multipliers):
                multipliers[s, i] = [pair(x, k * exponent) for k, x in enumerate(series[:COEFFICIENTS])]
            for i in range(n):
                sizes[s, i] = _falling(np.max(np.abs(places[s, group == group[i], :, 0]), axis=0))
            others[s] = _falling(np.max(np.abs(multipliers[s, :, :, 0]), axis=0, initial=0.0))
        return Pieces(lengths, natural, places, sizes, multipliers, others)


def _falling(sizes: Floats) -> Floats:
    """Return the sizes of coefficients, each at least as large as those that follow it."""
    found: Floats = np.maximum.accumulate(sizes[::-1])[::-1]
    return found

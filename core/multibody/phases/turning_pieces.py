"""Pieces of a motion while friction turns with the slip, in units of time that fit what is left of the slip."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.equations.packed import GROUPS, pair, two_to
from core.multibody.motion.step_sizes import lowest_bound, step_size
from core.multibody.motion.whole import Whole
from core.multibody.phases.turning_slip import TurningSlip
from core.multibody.search.pieces import COEFFICIENTS, Pieces, expanded_from
from core.multibody.search.taylor import ORDER, TOLERANCE


@dataclass(frozen=True)
class ExpandedTurning:
    """The motion of a whole scene, from its states in pairs.

    Attributes
    ----------
    whole : Whole
    kind : {"fine", "check"}
    """

    whole: Whole
    kind: str

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        """Return the pieces; in the step from rest they are those of that step."""
        (_, turning), *_ = self.whole.parts
        assert isinstance(turning, TurningSlip)
        run = turning.run(self.kind, math.nextafter(float(times.max()), math.inf))
        where: dict[int, list[int]] = {}
        for s, time in enumerate(times.tolist()):
            where.setdefault(run.leg_at(arb(time)), []).append(s)
        parts = {}
        for k, own in where.items():
            if k < 0:
                parts[k] = self._from_rest(turning, times[own], reach[own])
            else:
                leg, rows = run.legs[k], len(self.whole.measures.table.rows)
                states = turning.by(self.kind, times[own])
                parts[k] = expanded_from(leg.arrays, leg.units, turning.chosen, rows, states, reach[own])
        if len(parts) == 1:
            return parts[next(iter(parts))]
        return _joined([(where[k], parts[k]) for k in where], len(times))

    def _from_rest(self, turning: TurningSlip, times: Floats, reach: Floats) -> Pieces:
        """Return the pieces of the step from rest, none of which is longer than what is left of it."""
        table = self.whole.measures.table
        group = np.array([GROUPS[unit] for unit in table.units], dtype=np.int64)
        n, rows = len(table.names), len(table.rows)
        lengths, natural = np.zeros(len(times)), np.zeros(len(times))
        places, multipliers = np.zeros((len(times), n, ORDER + 1, 2)), np.zeros((len(times), rows, COEFFICIENTS, 2))
        sizes, others = np.zeros(places.shape[:-1]), np.zeros(multipliers.shape[:-1])
        lowest = lowest_bound(self.whole.arrays[0].laws.gaps, ORDER)
        for s, time in enumerate(times.tolist()):
            motion, rest = turning.about_rest(self.kind, time)
            coefficients = np.array([[float(x) for x in series[: ORDER + 1]] for series in motion.places])
            step = step_size(coefficients, group, TOLERANCE, lowest)
            natural[s], power = min(step, rest), math.ceil(math.log2(min(rest, reach[s])))
            if step < min(rest, reach[s]):
                power = math.floor(math.log2(step))
            lengths[s] = two_to(power)
            for i, series in enumerate(motion.places):
                places[s, i] = [pair(x, k * power) for k, x in enumerate(series[: ORDER + 1])]
            for i, series in enumerate(motion.multipliers):
                multipliers[s, i] = [pair(x, k * power) for k, x in enumerate(series[:COEFFICIENTS])]
            for i in range(n):
                sizes[s, i] = _falling(np.max(np.abs(places[s, group == group[i], :, 0]), axis=0))
            others[s] = _falling(np.max(np.abs(multipliers[s, :, :, 0]), axis=0, initial=0.0))
        return Pieces(lengths, natural, places, sizes, multipliers, others)


def _joined(parts: list[tuple[list[int], Pieces]], count: int) -> Pieces:
    """Return pieces in the order of their times, from those of each leg."""
    order = np.argsort([s for own, _ in parts for s in own], kind="stable")
    assert len(order) == count, "every time is in one leg"
    fields = ("lengths", "natural", "places", "place_sizes", "multipliers", "multiplier_sizes")
    return Pieces(*(np.concatenate([getattr(piece, name) for _, piece in parts])[order] for name in fields))


def _falling(sizes: Floats) -> Floats:
    """Return the sizes of coefficients, each at least as large as those that follow it."""
    found: Floats = np.maximum.accumulate(sizes[::-1])[::-1]
    return found

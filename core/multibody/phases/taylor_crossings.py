"""An event next to a known time, to the last bit: the Taylor series of the motion about that time, in balls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import ZERO, Ball
from core.multibody.equations.expansion import Expansion, expansion, slope, value
from core.multibody.motion.whole import Whole
from core.multibody.phases.crossings import Crossing, state_of
from core.multibody.phases.watches import Watch
from core.multibody.table.table import Table

ORDER = 8
"""Highest power of the Taylor series by which roots are located."""
_EXACT = 2.0**-112
"""Share of a series' terms by which its last one may count where an event is located by it."""
_ROUNDS = 12


def located(table: Table, whole: Whole, watch: Watch, time: float, kind: str) -> Crossing:
    """Return the crossing next to a time of a phase, by Newton's method on Taylor series about it.

    Parameters
    ----------
    table : Table
        Of the phase.
    whole : Whole
        Its motion.
    kind : {"fine", "check"}
        Which run of the motion is taken.

    Raises
    ------
    AccuracyUnreachable
        If no series about a time near by reaches the crossing.
    """
    for _ in range(_ROUNDS):
        motion = _expanded(table, whole, time, kind)
        series = watch.series(motion)
        derivative = slope(series)
        step: Ball = ZERO
        for _ in range(_ROUNDS):
            change = value(series, step) / value(derivative, step)
            step = arb((step - change).mid()) if change.is_finite() else ZERO
        moved = float(step)
        if not math.isfinite(moved):
            break
        if _cut_off(motion, table.units, moved) < _EXACT:
            q, v = state_of(motion, step)
            return Crossing(arb(time) + step, watch, q, v)
        time = max(time + moved, 0.5 * time)
    raise AccuracyUnreachable(
        None,
        1.0,
        f'the event of "{watch.one.name}" near {time:.6g} s of its phase cannot be located',
        path=("times",),
    )


def _expanded(table: Table, whole: Whole, time: float, kind: str) -> Expansion:
    """Return the Taylor series about a time of the phase."""
    q, v = ([arb(float(x[0])) + arb(float(x[1])) for x in pairs[0]] for pairs in whole.in_pairs(np.array([time]), kind))
    return expansion(replace(table, q=q, v=v), ORDER)


def _cut_off(motion: Expansion, units: Sequence[str], step: float) -> float:
    """Return the last term of every series at a step, relative to the largest term of its unit."""
    last: dict[str, arb] = {}
    largest: dict[str, arb] = {}
    for unit, series in zip(units, motion.places, strict=True):
        # Powers of a step that is much too long are beyond doubles, not beyond balls.
        terms = [abs(x.mid()) * arb(abs(step)) ** k for k, x in enumerate(series)]
        last[unit] = max(last.get(unit, arb(0)), terms[-1])
        largest[unit] = max(largest.get(unit, arb(0)), *terms)
    return max((float(last[unit] / x) for unit, x in largest.items() if x > 0), default=0.0)

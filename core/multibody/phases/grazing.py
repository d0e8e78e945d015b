"""Contacts that are only just reached: a gap that turns back at zero, as far as it is known.

In closed form a gap that turns back at zero touches at rest, and nothing comes of it. Where the state is known to an
error, the gap may as well reach zero at a rate of the root of that error, and bounce: what follows is not known any
more, and both outcomes are told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import ZERO, Ball, size
from core.multibody.equations.expansion import Expansion, expansion, slope, value
from core.multibody.equations.polynomial_roots import changes
from core.multibody.phases.crossings import uniform_motion
from core.multibody.phases.phase import Phase
from core.multibody.phases.sampled_crossings import Sampled
from core.multibody.phases.tracks import FLOOR, SAFETY_FACTOR
from core.multibody.phases.watches import Watch

_NEAR = 2.0**14
"""How many times the noise of doubles the lowest value of a gap may be that is looked at in balls."""
_CLOSER, _ROUNDS = 33, 6
_RISEN = 2.0**-40
"""Share of its terms that a gap is to have had before it turns back."""
_SOONEST: Ball = arb(2.0**-60)
_HALVINGS = 60
_DOUBLINGS = 1200
"""More than would leave the range of doubles."""
_ORDER = 8
_NEWTON = 60
"""Rounds of Newton's method: a gap may turn back as slowly as the fourth power of time."""


@dataclass(frozen=True)
class Graze:
    """A gap that turns back at zero.

    Attributes
    ----------
    time : ball
        Since the start of the phase.
    watch : Watch
    closes : bool
        Whether it is known to be below zero there, by less than samples in doubles show: then it closed just before.
    """

    time: Ball
    watch: Watch
    closes: bool = False


def grazed(phase: Phase, watched: Sequence[Watch], until: float) -> Graze | None:
    """Return the first gap before a time of a phase of which it is not known whether it reaches zero."""
    gaps = [watch for watch in watched if watch.what == "gap"]
    if not gaps or not until > 0.0:
        return None
    if phase.uniform:
        found = [] if len(phase.tracks) == 1 else _in_closed_form(phase, gaps, until)
    else:
        found = _sampled(phase, gaps, until)
    return min(found, key=lambda one: float(one.time), default=None)


def _in_closed_form(phase: Phase, gaps: Sequence[Watch], until: float) -> list[Graze]:
    motions = [uniform_motion(table.table, model) for table, model in zip(phase.tables, phase.models, strict=True)]
    found = []
    for watch in gaps:
        both = [watch.series(motion) for motion in motions]
        for turn, sign in changes(slope(both[0]), arb(until)):
            # What opens at the start of the phase has been at zero: it is to have risen before it turns back.
            risen = float(value(both[0], turn / 2)) > _RISEN * float(_terms(watch, motions[0], turn))
            width = _width(watch, motions[0], both, turn)
            if sign > 0 and risen and abs(float(value(both[0], turn))) <= width:
                found.append(Graze(_lasting(both[0], turn, width), watch))
    return found


def _width(watch: Watch, motion: Expansion, gaps: Sequence[Sequence[Ball]], late: Ball) -> float:
    """Return to what error a gap is known of which there are two series."""
    apart = value(gaps[0], late) - value(gaps[1], late)
    return SAFETY_FACTOR * abs(float(apart)) + FLOOR * float(_terms(watch, motion, late))


def _lasting(series: Sequence[Ball], late: Ball, width: float) -> Ball:
    """Return the time at which a gap turns back, as wide as the gap stays below what is known of it."""
    reach = float(_SOONEST)
    while abs(float(value(series, late + reach))) <= 2.0 * width:
        reach *= 2.0
    return arb(late.mid(), reach)


def _terms(watch: Watch, motion: Expansion, late: Ball) -> Ball:
    """Return the sum of the magnitudes of what a gap consists of."""
    return size(watch.one.gap, [value(series, late) for series in motion.places])


def _sampled(phase: Phase, gaps: Sequence[Watch], until: float) -> list[Graze]:
    found = []
    for watch in gaps:
        sampled = Sampled(phase.tables[0].table, phase.models[0].whole, [watch])
        times, _ = sampled.grid(until)
        if len(times) < 3:
            continue
        curve, noise = (x[0] for x in sampled.curves(times))
        for low, high in _turns(times, curve, _NEAR * noise):
            turn = _lowest(sampled, low, high)
            if turn is None:
                continue
            motion, other = (_expanded(phase, k, turn) for k in range(2))
            series, late = watch.series(motion), _turn_of(watch.series(motion))
            width = _width(watch, motion, [series, watch.series(other)], _turn_of(watch.series(other)))
            gap = value(series, late)
            if abs(float(gap)) <= width:
                found.append(Graze(arb(turn) + _lasting(series, late, width), watch))
                break
            if gap < 0:
                found.append(Graze(arb(turn) + _closing(series, late), watch, closes=True))
                break
    return found


def _turns(times: Floats, curve: Floats, near: Floats) -> list[tuple[float, float]]:
    """Return the intervals in which a curve turns from falling to rising and comes far down."""
    found = []
    for i in range(1, len(curve) - 1):
        left, middle, right = curve[i - 1 : i + 2]
        if middle <= left and middle <= right and left > near[i - 1] and middle < 0.5 * max(left, right):
            found.append((float(times[i - 1]), float(times[i + 1])))
    return found


def _lowest(sampled: Sampled, low: float, high: float) -> float | None:
    """Return about when a gap is lowest, None if that is far from zero."""
    for _ in range(_ROUNDS):
        times = np.linspace(low, high, _CLOSER)
        curve, noise = (x[0] for x in sampled.curves(times))
        i = int(np.argmin(curve))
        near = float(noise[i]) * _NEAR
        if curve[i] > near and float(curve.max() - curve[i]) < 0.5 * abs(float(curve[i])):
            return None
        low, high = float(times[max(i - 1, 0)]), float(times[min(i + 1, _CLOSER - 1)])
    return None if curve[i] > near else 0.5 * (low + high)


def _closing(series: Sequence[Ball], late: Ball) -> Ball:
    """Return about when before its lowest value a gap closes."""
    before = _SOONEST
    for _ in range(_DOUBLINGS):
        if value(series, late - before) > 0:
            break
        before = before * 2
    else:
        raise AccuracyUnreachable(
            None, math.inf, "a gap closes near its lowest value, and when is not known", path=("times",)
        )
    low, high = before / 2, before
    for _ in range(_HALVINGS):
        middle = arb(((low + high) / 2).mid())
        low, high = (low, middle) if value(series, late - middle) > 0 else (middle, high)
    return arb((late - high).mid())


def _expanded(phase: Phase, k: int, time: float) -> Expansion:
    """Return the Taylor series about a time of a phase, on one track or by one run."""
    track = min(k, len(phase.tables) - 1)
    pairs = phase.models[track].whole.in_pairs(np.array([time]), ("fine", "check")[k])
    q, v = ([arb(float(x[0])) + arb(float(x[1])) for x in vector[0]] for vector in pairs)
    return expansion(replace(phase.tables[track].table, q=q, v=v), _ORDER)


def _turn_of(series: Sequence[Ball]) -> Ball:
    """Return when a gap turns back."""
    rate, bend = slope(series), slope(slope(series))
    late: Ball = ZERO
    for _ in range(_NEWTON):
        change = value(rate, late) / value(bend, late)
        late = arb((late - change).mid()) if change.is_finite() else late
    return late

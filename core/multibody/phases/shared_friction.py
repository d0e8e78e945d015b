"""When what shares a load in space lets go: no share is within all round cones any more.

A sum of forces without the share that is negative says that there is none. Such a sum holds back the best share at one
time; it is watched, and where it vanishes the best share is looked for again, which gives a sharper one (Kelley's
method, in time). A time in between at which there is no share is looked for at samples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from core.arrays import Floats
from core.multibody.contacts.admissible_forces import SharedCones, shared_cones
from core.multibody.contacts.shares_in_space import MARGINAL
from core.multibody.phases.phase import Phase
from core.multibody.phases.watches import Crossing, Watch

_SAMPLES = 16
"""Times at which a share is looked for, evenly until an event or the end."""
_MISSED = 2.0**-40
"""Share of the time of an event by which it may be late: the least sum is known to some 1e-13 of the forces."""
_ROUNDS = 20
"""Sharper sums: the time of the event gains digits as Newton's method does."""


def first_without_share(
    phase: Phase, watched: Sequence[Watch], left: float, search: Callable[[Sequence[Watch], float], list[Crossing]]
) -> list[Crossing]:
    """Return the first crossing of a phase, also of sums that hold back the best share of a load.

    Parameters
    ----------
    search : callable
        Returns the first crossing of what is watched within a time.
    """
    closed = [i for i, row in enumerate(phase.tables[0].normal) if row is not None]
    cones = shared_cones(phase.unilateral, closed, phase.tables[0])
    found = search(watched, left)
    if cones is None or not phase.models[0].whole.parts:
        return found
    watched = list(watched)
    samples = _SAMPLES
    for _ in range(_ROUNDS):
        end = float(found[0].time) if found else left
        sharper = _sums_that_are_negative(phase, cones, end * np.arange(1, samples + 1) / samples)
        if not sharper:
            break
        watched.extend(sharper)
        found, samples = search(watched, left), 1
    if not found or found[0].watch.what != "grip":
        return found
    # By how much the time is missed shows on the second track, also on its clock.
    last, missed = found[-1], _MISSED * found[-1].time
    units = phase.tables[0].table.units
    places = [x + missed if unit == "s" else x for x, unit in zip(last.q, units, strict=True)]
    return [found[0], replace(last, time=last.time + missed, q=places)]


def _sums_that_are_negative(phase: Phase, cones: SharedCones, times: Floats) -> list[Watch]:
    """Return what holds back the best share at the first of times at which there is none."""
    whole = phase.models[0].whole
    q, v = whole.in_pairs(times)
    for multipliers in whole.multipliers(q, v):
        margin, held = cones.certificate(multipliers)
        if margin < -MARGINAL:
            return [Watch(held.number, "grip", phase.unilateral[held.number], admissible=held)]
    return []

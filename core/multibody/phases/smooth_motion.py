"""The motion of a scene in which nothing is unilateral: one phase, between the events that end it on either side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from core.arrays import Floats
from core.errors import MechanicsError
from core.multibody.algebra.polynomials import ZERO
from core.multibody.contacts.contact_states import PhaseTable
from core.multibody.motion.modelling import Modelled
from core.multibody.phases.formula_ends import what_ends
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phase_ends import expansions_of
from core.multibody.phases.tracks import Track
from core.multibody.phases.uniform_pieces import steady_forces
from core.multibody.start import lost_at_start
from core.multibody.table.connection_effects import Limit
from core.multibody.trajectory.events import End, end_of, first_event


def smooth_motion(found: Modelled, times: Floats) -> PhaseMotion:
    """Return the motion of a scene with the models of its parts, as far as some times reach.

    Without times only what ends it at the start is found.

    Raises
    ------
    NotApplicable
        Where a force that is watched leaves the range of doubles before any event.
    """
    table = found.described.measures.table
    phase = Phase([Track(ZERO, table.q, table.v)], [found], [PhaseTable(table, [], [], [])], [], [])
    motion = PhaseMotion(found.described, [], [phase])
    watched = _watched(phase)
    if not len(times):
        motion.events = list(lost_at_start(found, phase.start_forces[1]))
        motion.ended = next(iter(motion.events), None)
        return motion
    expansions = partial(expansions_of, phase)
    with np.errstate(over="ignore", invalid="ignore"):
        first, last = float(times.min(initial=0.0)), float(times.max(initial=0.0))
        motion.before = first_event(found.whole, watched, first, expansions) if first < 0.0 else None
        ended = first_event(found.whole, watched, last, expansions) if last > 0.0 else None
        if ended is not None and ended.kind == "singular" and not ended.name:
            motion.problem = what_ends(phase, ended.time)
            if motion.problem is not None:
                ended = replace(ended, kind=motion.problem.code, name=", ".join(motion.problem.contacts))
    motion.events = [event for event in (motion.before, ended) if event is not None]
    motion.ended = next((event for event in motion.events if event.time >= 0.0), None)
    return motion


def ends_within(motion: PhaseMotion, time: float, searched: float) -> bool:
    """Return whether the first phase of a motion ends before a time, or whether it does is not known.

    Parameters
    ----------
    searched : float
        Time up to which a smooth motion is known (s).
    """
    if motion.smooth and time <= searched:
        return motion.ended is not None and motion.ended.time <= time
    phase = motion.phases[0]
    watched = _watched(phase)
    if not watched:
        return False
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            return first_event(phase.models[0].whole, watched, time, partial(expansions_of, phase)) is not None
    except MechanicsError:
        return True


def not_watched(phase: Phase) -> list[str]:
    """Return the connections that might end a phase by forces that the scene does not determine."""
    limits = phase.models[0].whole.limits
    return list(dict.fromkeys(limit.name for limit in limits if not _is_watched(phase, limit)))


def _watched(phase: Phase) -> Sequence[End]:
    whole = phase.models[0].whole
    limits = [limit for limit in whole.limits if _is_watched(phase, limit)]
    pulling = [limit.force for limit in limits if limit.force is not None and phase.pulls(limit.force)]
    if whole.uniform and pulling:
        # What pulls at the start and does not change pulls for ever.
        own = [whole.measures.forces[force] for force in pulling]
        steady = steady_forces(phase.tables[0].table, phase.exact_motions[0], own)
        kept = {force for force, keeps in zip(pulling, steady, strict=True) if keeps}
        limits = [limit for limit in limits if limit.force not in kept]
    return [end_of(whole, limit) for limit in limits]


def _is_watched(phase: Phase, limit: Limit) -> bool:
    return limit.force is None or phase.determined[limit.force]

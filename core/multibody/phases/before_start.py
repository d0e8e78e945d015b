"""The time before the start of a scene with unilateral measures: its first phase, followed backwards.

What the description gives is the state at the start. The first phase is its motion before as well, back to the first
event: where a gap closes, a force changes its sign, or a slip vanishes. What was before that is not determined, because
an impact and friction are not reversible.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from core.arrays import Floats
from core.balls import precision
from core.errors import InvalidParameter, NotApplicable
from core.multibody.algebra.polynomials import BITS
from core.multibody.contacts.contact_states import State, change_of
from core.multibody.phases.phase import Phase, PhaseMotion
from core.multibody.phases.phase_ends import expansions_of
from core.multibody.phases.watches import Watch, lengths, switches, watches
from core.multibody.trajectory.events import End, first_event


def follow_backwards(motion: PhaseMotion, times: Floats) -> None:
    """Find the event up to which the first phase of a motion is followed backwards, as far as some times reach.

    Raises
    ------
    InvalidParameter
        For times before a start at which an impact happens, or a state of a contact changes.
    NotApplicable
        Where friction turns with the slip from the start on.
    """
    before, phase = np.flatnonzero(times < 0.0), motion.phases[0]
    if not len(before):
        return
    if phase.turning:
        raise NotApplicable(
            "times before the start are not answered where the direction of friction turns with the slip",
            path=("times",),
            remedy="ask for times from the start on",
        )
    if any(one.facets for one in phase.unilateral):
        raise NotApplicable(
            "times before the start are not answered where edges and corners of shapes may meet",
            path=("times",),
            remedy="ask for times from the start on",
        )
    # The velocities that are given are those before an impact, and the first phase has those after it.
    names = [name for number, name, _ in motion.impacts if number == 0]
    event = None
    if not names:
        watched = [
            *watches(phase.unilateral, phase.states, phase.tables[0], phase.openings),
            *switches(phase.arguments, phase.tables[0].table),
            *lengths(phase.models[0].whole.limits),
        ]
        with precision(BITS):
            ends = [_end(phase, watch) for watch in watched]
            event = first_event(phase.models[0].whole, ends, float(np.min(times)), partial(expansions_of, phase))
        names = [event.name] if event is not None and event.time >= 0.0 else []
    if names:
        raise InvalidParameter(
            ("times", int(before[0])),
            f"be at least 0: the state of {names[0]} changes at the start, and what was before is not determined",
        )
    if event is not None:
        motion.before = event
        motion.events.insert(0, event)


def _end(phase: Phase, watch: Watch) -> End:
    if watch.what == "length":
        return End("singular", watch.one.name, watch.watched, watch.one.gap)
    if watch.what == "switch":
        return End("switch", watch.one.name, watch.watched)
    if watch.what == "gap":
        return End(watch.one.closes, watch.one.name, watch.watched)
    new = {"push": State.OPEN, "slip": State.STICK, "grip": State.FORWARD}[watch.what]
    return End(change_of(watch.one, phase.states[watch.number], new), watch.one.name, watch.watched)

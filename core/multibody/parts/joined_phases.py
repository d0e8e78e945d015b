"""The phases of a scene from those of its independent parts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.multibody.answer import MotionPhase, SceneSolution
from core.multibody.start import name_of_parts


@dataclass(frozen=True)
class _Model:
    name: str
    why: str


def joined_phases(solutions: Sequence[SceneSolution], end: float) -> tuple[MotionPhase, ...] | None:
    """Return the phases between any two events of any part, up to the end of the motion.

    None where no part has phases. A part without phases is in the same phase throughout.
    """
    if all(solution.phases is None for solution in solutions):
        return None
    if any(not phases for phases in (solution.phases for solution in solutions) if phases is not None):
        # What is undecided from the start on has no phases, and ends the motion.
        return ()
    each = [list(_phases_of(solution)) for solution in solutions]
    # Several parts may have events at one time, each known as well as its part is followed.
    late: dict[float, float] = {}
    for solution in solutions:
        for event in solution.events:
            late[event.time] = max(late.get(event.time, 0.0), event.error)
    found: list[MotionPhase] = []
    start = 0.0
    while True:
        now = [phases[0] for phases in each]
        ends = min(math.inf if phase.end is None else phase.end for phase in now)
        found.append(_joined(now, start, min(ends, end), late))
        over = [k for k, phases in enumerate(each) if phases[0].end == ends and len(phases) > 1]
        if ends > end or not over:
            return tuple(found)
        each = [phases[1:] if k in over else phases for k, phases in enumerate(each)]
        start = ends


def _phases_of(solution: SceneSolution) -> Sequence[MotionPhase]:
    model = solution.model
    if solution.phases is not None:
        return solution.phases
    return [MotionPhase(0.0, None, model.name, model.why, model.degrees_of_freedom, model.coordinates, {}, {})]


def _joined(phases: Sequence[MotionPhase], start: float, end: float, late: Mapping[float, float]) -> MotionPhase:
    name, why = name_of_parts([_Model(phase.model, phase.why) for phase in phases])
    return MotionPhase(
        start,
        end if math.isfinite(end) else None,
        name,
        why,
        sum(phase.degrees_of_freedom for phase in phases),
        sum(phase.coordinates for phase in phases),
        {name: state for phase in phases for name, state in phase.states.items()},
        {"start": late.get(start, 0.0), "end": late.get(end)},
    )

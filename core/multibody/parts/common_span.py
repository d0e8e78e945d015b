"""The answers of independent parts over the time in which all of them can be followed.

The motion of a scene ends where that of its first part ends. The other parts are then answered up to that time, so that
their events, errors and searches are those of the time that is answered.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from core.arrays import Integers
from core.errors import InvalidParameter, MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.scene import Scene
from core.multibody.trajectory.scene_request import SceneRequest


class Span(NamedTuple):
    """Times between which a motion is followed (s)."""

    begin: float
    end: float

    def covers(self, other: Span) -> bool:
        """Return whether another span is inside this one, and is not all of it."""
        return self != other and self.begin <= other.begin and other.end <= self.end


UNLIMITED = Span(-math.inf, math.inf)


@dataclass(frozen=True)
class PartAnswer:
    """What is answered about a part.

    Attributes
    ----------
    solution : SceneSolution
    rows : ndarray of int, shape (n,)
        The number in the question of every time at which the part is sampled; one beyond them is the end of a span.
    span : Span
        Between which times the part can be followed, as far as that was requested.
    """

    solution: SceneSolution
    rows: Integers
    span: Span


def answers_in_common(
    parts: Sequence[Scene], requests: Sequence[SceneRequest], answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> tuple[list[PartAnswer], Span]:
    """Return the answers of all parts over the time in which all of them can be followed, and that time.

    Raises
    ------
    InvalidParameter
        With the faults of all parts.
    MechanicsError
        For the first part that is refused over the time in which the others can be followed.
    """
    span = UNLIMITED
    answers: list[PartAnswer | MechanicsError] = _each(parts, requests, answered, span)
    while True:
        spans = [answer.span for answer in answers if isinstance(answer, PartAnswer)]
        common = Span(
            max((one.begin for one in spans), default=span.begin), min((one.end for one in spans), default=span.end)
        )
        refused = [answer for answer in answers if isinstance(answer, MechanicsError)]
        if refused and common == span:
            raise refused[0]
        longer = [
            k
            for k, answer in enumerate(answers)
            if len(requests[k].times) and (isinstance(answer, MechanicsError) or answer.span.covers(common))
        ]
        if not longer:
            return [answer for answer in answers if isinstance(answer, PartAnswer)], common
        again = _each([parts[k] for k in longer], [requests[k] for k in longer], answered, common)
        for k, answer in zip(longer, again, strict=True):
            answers[k] = answer
        span = common


def _each(
    parts: Sequence[Scene],
    requests: Sequence[SceneRequest],
    answered: Callable[[Scene, SceneRequest], SceneSolution],
    span: Span,
) -> list[PartAnswer | MechanicsError]:
    """Return the answer of every part within a span, or why it is refused."""
    found: list[PartAnswer | MechanicsError] = []
    faults = FaultsOfParts()
    for part, request in zip(parts, requests, strict=True):
        with faults.part():
            try:
                found.append(_within(span, part, request, answered))
            except InvalidParameter:
                raise
            except MechanicsError as refused:
                found.append(refused)
    faults.raised()
    return found


def _within(
    span: Span, part: Scene, request: SceneRequest, answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> PartAnswer:
    times = request.times
    rows = np.flatnonzero((times >= span.begin) & (times <= span.end))
    ends = [end for end in span if math.isfinite(end) and end not in times]
    solution = answered(part, replace(request, times=np.concatenate([times[rows], ends])))
    rows = np.concatenate([rows, len(times) + np.arange(len(ends))])
    trajectory = solution.trajectory
    if trajectory is not None and trajectory.rows is not None:
        rows = rows[trajectory.rows]
    begin = max((event.time for event in solution.events if event.time < 0.0), default=span.begin)
    return PartAnswer(solution, rows, Span(begin, span.end if solution.ended is None else solution.ended.time))

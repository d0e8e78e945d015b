"""Figures of the motions of many scenes that differ in numbers alone, for studies."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from pydantic import ValidationError

from core.arrays import Floats
from core.assessment.propagation import at
from core.errors import MechanicsError, Path
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.members.many import AnsweredTogether, ManyScenes
from core.multibody.members.recorded_balls import NotRecorded, Varied, recording
from core.multibody.solve import DEFAULT_OUTPUTS
from core.systems.budget import Budget
from service.requests.described_scene import DescribedSceneRequest
from service.routing import Columns, ManyFigures
from service.schemas import sample_times

KEPT = 4
"""Questions of which set-ups are kept: those of the studies on which a process works."""


class _Question(NamedTuple):
    """What members of a question share: how they are answered, when, and how accurately."""

    many: ManyScenes
    times: Floats
    accuracy: float


def many_scenes(request: Any, columns: Columns, figures: Sequence[Path]) -> ManyFigures | None:
    """Return figures of many questions to /v1/scenes; parameters as in `PostRoute.many`.

    Those of the motion of smooth scenes, of one part and without formulas, that nothing ends.
    """
    if not columns or not all(_known(path) for path in figures):
        return None
    places = tuple(columns)
    question = _question(json.dumps(request), places)
    if question is None:
        return None
    numbers = np.stack([columns[place] for place in places], axis=1)
    answered = np.zeros(len(numbers), dtype=bool)
    found = np.full((len(numbers), len(figures)), np.nan)
    finite = np.flatnonzero(np.isfinite(numbers).all(axis=1))
    for some in question.many.answered(numbers[finite], question.times, question.accuracy):
        values = [value for path in figures if (value := _figure(some, path)) is not None]
        if len(values) < len(figures):
            # What the answer does not have, one by one tells why.
            return None
        answered[finite[some.members]] = True
        found[finite[some.members]] = np.stack(values, axis=1)
    return ManyFigures(answered, found, {})


@lru_cache(maxsize=KEPT)
def _question(request: str, places: tuple[Path, ...]) -> _Question | None:
    """Return how members are answered together that have numbers of their own at some places; None where they are not.

    What is learned of their set-ups is kept for members that are asked for later.
    """
    try:
        form = DescribedSceneRequest.model_validate(json.loads(request))
        outputs = DEFAULT_OUTPUTS if form.outputs is None else form.outputs
        if form.times is None or "trajectory" not in outputs or not {*map(str, outputs)} <= {*DEFAULT_OUTPUTS}:
            return None
        if form.method is not None or form.input_uncertainty is not None or form.round is not None:
            return None
        times, description = sample_times(form.times, Budget()), json.dumps(form.description())
        if not all(_is_number(at(json.loads(description), place)) for place in places):
            return None

        def scene_of(numbers: Sequence[Any]) -> Scene:
            return scene_from(_with(json.loads(description), places, numbers))

        with recording():
            many = ManyScenes(scene_of([Varied() for _ in places]), places, scene_of)
            return _Question(many, times, form.accuracy) if many.can_follow(times) else None
    except (MechanicsError, ValidationError, NotRecorded):
        # What cannot be read so is refused, or answered, by itself.
        return None


def _with(document: Any, places: Sequence[Path], numbers: Sequence[Any]) -> Any:
    """Return a document with other numbers at some places."""
    for place, number in zip(places, numbers, strict=True):
        inner = document
        for step in place[:-1]:
            inner = inner[step]
        inner[place[-1]] = number
    return document


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _known(path: Path) -> bool:
    """Return whether a figure is one of the motion."""
    if path == ("accuracy", "error"):
        return True
    if len(path) < 4 or path[:2] != ("trajectory", "columns"):
        return False
    return (path[3] == "error" and len(path) == 4) or (
        path[3] == "values" and len(path) in (5, 6) and all(isinstance(step, int) for step in path[4:])
    )


def _figure(some: AnsweredTogether, path: Path) -> Floats | None:
    """Return a figure of members, None where their answers have none."""
    if path[0] == "accuracy":
        return some.motion.error[some.rows]
    column = some.motion.columns.get(str(path[2]))
    if column is None:
        return None
    if path[3] == "error":
        return column.error[some.rows]
    place = tuple(int(step) for step in path[4:])
    if len(place) != column.values.ndim - 1 or any(k >= n for k, n in zip(place, column.values.shape[1:], strict=True)):
        return None
    found: Floats = column.values[(some.rows, *place)]
    return found

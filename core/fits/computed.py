"""The figures that a question computes for the rows of data, as functions of some of its numbers."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.figures import inside, value_at
from core.assessment.graded_question import ANSWERING, IN_TIME, GradedQuestion
from core.assessment.propagation import at, changed, unrounded
from core.assessment.question_source import Source
from core.errors import InvalidParameter, NotApplicable, Path, inside_field, pointer_of
from core.near_names import did_you_mean
from core.sensitivities.figure import Figure, figure_of
from core.work import spend

TRAJECTORY = "trajectory"
COLUMNS: tuple[Path, ...] = ((TRAJECTORY, "columns"), (TRAJECTORY,), ())
"""Where answers have columns of samples: of described scenes, named scenes and free bodies."""

QUESTION: Path = ("question", "request")
FIGURES: Path = ("data", "figures")
"""Where a request for a fit has what is computed, for faults."""

COMPONENT = "take a component of a vector, such as ball.position.x"

HELD = 8
"""Answers that are held, so that none is computed twice for residuals and their slopes."""


@dataclass(frozen=True)
class RowsOf:
    """A figure of an answer for every row of data.

    Attributes
    ----------
    figure : Figure
    part : int or None
        Component of a vector at each time.
    """

    figure: Figure
    part: int | None = None

    def rows(self, answer: Any, count: int) -> Floats | None:
        """Return the figure by row, shape (count,); None where the answer has it not for each."""
        value = self.figure.value(answer)
        if value is None or isinstance(value, (str, bool)):
            return None
        array = np.asarray(value, dtype=np.float64)
        if array.ndim == 2 and self.part is not None:
            array = array[:, self.part]
        if array.ndim == 0:
            return np.full(count, float(array))
        return array if array.shape == (count,) else None


class Computed:
    """Figures of a question at the times of data, by some of its numbers.

    Parameters
    ----------
    source : Source
    request : Any
        As it was sent.
    paths : sequence of path
        Of the numbers.
    figures : mapping of str to Any
        By column of the data: the name of a column of the answer or of a component of one, or a figure as requests name
        it.
    times : ndarray, shape (n,), or None
    count : int
        Rows of data.

    Raises
    ------
    MechanicsError
        Where the question is refused with the numbers that it has, or has no such figures; with the path of these in a
        request for a fit.
    """

    def __init__(
        self,
        source: Source,
        request: Any,
        paths: Sequence[Path],
        figures: Mapping[str, Any],
        times: Floats | None,
        count: int,
    ) -> None:
        self._source, self._paths, self._times, self._count = source, tuple(paths), times, count
        self._request = dict(unrounded(request))
        self.evaluations = 0
        self._held = lru_cache(HELD)(self._computed)
        self._rows: list[RowsOf] = []
        self._find(figures)

    def start(self, path: Path) -> Any:
        """Return what the request has at a path."""
        return at(self._request, path)

    def __call__(self, numbers: Floats, shift: float = 0.0) -> Floats:
        """Return the figures with other numbers and, by `shift`, later times; shape (n, m).

        Raises
        ------
        MechanicsError
            Where the question has no answer with them, or the motion does not reach all of the times.
        """
        return self._held(tuple(map(float, numbers)), float(shift))

    def stated(self, numbers: Floats, source: Source) -> list[tuple[str, float]]:
        """Return unit and bound of the error of the figures of every column, with some numbers, as a source answers."""
        question = GradedQuestion(source, self._asked(tuple(map(float, numbers)), 0.0), {})
        found = []
        for one in self._rows:
            place = one.figure.place(question.answer)
            reference = None if place is None else question.reference(place)
            if reference is None:
                raise NotApplicable("a figure that the data have is not computed with these numbers")
            found.append((reference.unit, reference.error))
        return found

    def _asked(self, numbers: tuple[float, ...], shift: float) -> dict[str, Any]:
        request: dict[str, Any] = changed(self._request, dict(zip(self._paths, numbers, strict=True)))
        return request if self._times is None else request | {"times": (self._times + shift).tolist()}

    def _computed(self, numbers: tuple[float, ...], shift: float) -> Floats:
        spend(ANSWERING)
        self.evaluations += 1
        answer = self._source.answer(json.dumps(self._asked(numbers, shift)))
        found = [one.rows(answer, self._count) for one in self._rows]
        if any(one is None for one in found):
            ended = inside(answer, "ended")
            raise NotApplicable(
                f"the motion does not reach the times of all rows: it ends with {ended}"
                if self._times is not None and isinstance(ended, str)
                else "a figure that the data have is not computed with these numbers"
            )
        return np.column_stack([one for one in found if one is not None])

    def _find(self, figures: Mapping[str, Any]) -> None:
        """Find where answers have the figures, and what the question has to be asked for."""
        numbers = tuple(float(self.start(path)) for path in self._paths)
        own, offered = self._request.get("outputs"), self._source.outputs
        asked: list[Any] = list(own or ())
        if self._times is not None and TRAJECTORY in offered:
            asked = [*asked, *({TRAJECTORY} - {one for one in asked if isinstance(one, str)})]
        in_time = sorted(output for output in offered if output.endswith(IN_TIME))
        for outputs in (asked, [*asked, *(output for output in in_time if output not in asked)]):
            if outputs:
                self._request["outputs"] = outputs
            with inside_field(*QUESTION):
                answer = self._source.answer(json.dumps(self._asked(numbers, 0.0)))
            found = {name: _rows_of(answer, written, name) for name, written in figures.items()}
            if None not in found.values():
                break
        for name, one in found.items():
            if one is None or one.rows(answer, self._count) is None:
                raise _unknown(name, figures[name], answer, one, self._times is not None)
            self._rows.append(one)


def _rows_of(answer: Any, written: Any, column: str) -> RowsOf | None:
    """Return where an answer has a figure, None where it has it not."""
    if not isinstance(written, str) or written.startswith("/"):
        figure = figure_of(written, (*FIGURES, column))
        return None if figure.value(answer) is None else RowsOf(figure)
    name, _, part = written.rpartition(".")
    for where in COLUMNS:
        for own, component in ((written, None), (name, part)):
            path: Path = (*where, own, "values") if where == COLUMNS[0] else (*where, own)
            value = value_at(answer, path) if own else None
            if isinstance(value, np.ndarray) and component is None and value.ndim == 1:
                return RowsOf(Figure(path))
            if isinstance(value, np.ndarray) and component and value.ndim == 2 and len(component) == 1:
                letters = "wxyz" if value.shape[1] == 4 else "xyz"[: value.shape[1]]
                if component in letters:
                    return RowsOf(Figure(path), letters.index(component))
    return None


def _unknown(column: str, written: Any, answer: Any, found: RowsOf | None, timed: bool) -> InvalidParameter:
    path: Path = (*FIGURES, column)
    if found is not None:
        if not timed:
            remedy = "give times, or a figure that is one number"
            return InvalidParameter(path, "be one number where the data have no times", remedy=remedy)
        if inside(answer, "ended") not in (None, "horizon"):
            ends = f"the motion ends with {inside(answer, 'ended')} before the last of the times"
            return InvalidParameter(path, f"be known at the times of all rows, and {ends}")
        return InvalidParameter(path, "be one number for each row", remedy=COMPONENT)
    names: list[str] = []
    for where in COLUMNS[:2] if value_at(answer, (TRAJECTORY,)) is None else COLUMNS:
        inner = answer
        for step in where:
            inner = inside(inner, step)
        names = names or [str(name) for name in (inner if isinstance(inner, Mapping) else ())]
    wanted = written if isinstance(written, str) else pointer_of((column,))
    near = did_you_mean(wanted.rpartition(".")[0] or wanted, names) if names else None
    if wanted in names:
        return InvalidParameter(path, "be one number for each row", remedy=COMPONENT)
    listed = f"; its columns are {', '.join(names[:20])}" if names else ""
    return InvalidParameter(path, f"name a figure of the answer{listed}"[:400], remedy=near)

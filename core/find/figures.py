"""What a condition is about beside the figures of an answer: whether an event happens, and which figures there are."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, is_dataclass
from typing import Any

import numpy as np

from core.assessment.figures import inside
from core.assessment.graded_question import GradedQuestion
from core.errors import Path, pointer_of
from core.sensitivities.figure import EVENTS, EventTime, Figure

Value = float | bool | str
"""Of a figure: a number, or a word or a truth value that says which case holds."""

MOST_NEAR = 2000
"""Figures among which the one that was meant is looked for."""

MOST_EVENTS_LISTED = 20
"""Kinds and names of events that are listed."""


@dataclass(frozen=True)
class Happens(EventTime):
    """Whether an event happens."""

    @property
    def continuous(self) -> bool:
        """Whether it may change by as little as one likes: never."""
        return False

    def value(self, answer: Any) -> bool:
        """Return whether it happens."""
        return self.place(answer) is not None


def value_of(figure: Figure, answer: Any) -> Value | None:
    """Return the single value that an answer has for a figure; None for arrays, and without it."""
    found = figure.value(answer)
    return found if isinstance(found, (bool, float, str)) else float(found) if isinstance(found, int) else None


def error_of(figure: Figure, question: GradedQuestion) -> float:
    """Return a bound, or an estimate, of the error of a figure of a question's answer; 0 for what is counted."""
    place = figure.place(question.answer) if figure.continuous else None
    reference = None if place is None else question.reference(place)
    return 0.0 if reference is None else reference.error


def single_figures(answer: Any) -> list[str]:
    """Return the pointers of the first numbers, words and truth values within an answer."""
    return _pointers(answer, lambda value: isinstance(value, (bool, int, float, str, np.generic)))


def lists_within(answer: Any) -> list[str]:
    """Return the pointers of the lists within an answer, those inside of lists left out."""
    return _pointers(answer, lambda value: isinstance(value, (list, tuple, np.ndarray)))


def events_within(answer: Any) -> list[str]:
    """Return the kinds and names of the events of an answer."""
    events = inside(answer, EVENTS[0]) or ()
    named = dict.fromkeys(f"{inside(one, 'kind')} {inside(one, 'name') or ''}".strip() for one in events)
    return [*named][:MOST_EVENTS_LISTED]


def names_nothing(answer: Any, path: Path) -> bool:
    """Return whether a path has a name that no answer to the question has, whatever its numbers.

    Fields of an answer, and what lists hold, may come and go; names within its fields are those of the request.
    """
    found = answer
    for k, step in enumerate(path):
        if isinstance(step, int) or found is None:
            return False
        inner = inside(found, step)
        if inner is None and k:
            known = step in found if isinstance(found, Mapping) else hasattr(found, step)
            return not known and (isinstance(found, Mapping) or is_dataclass(found))
        found = inner
    return False


def _pointers(document: Any, wanted: Callable[[Any], bool]) -> list[str]:
    found: list[str] = []
    rest: list[tuple[Path, Any]] = [((), document)]
    while rest and len(found) < MOST_NEAR:
        path, value = rest.pop(0)
        if wanted(value):
            found.append(pointer_of(path))
        else:
            rest.extend(((*path, step), entry) for step, entry in _entries(value))
    return found


def _entries(document: Any) -> Iterator[tuple[str | int, Any]]:
    if hasattr(document, "_asdict"):
        document = document._asdict()
    elif hasattr(document, "__dataclass_fields__"):
        document = {name: getattr(document, name) for name in document.__dataclass_fields__}
    if isinstance(document, Mapping):
        yield from document.items()
    elif isinstance(document, (list, tuple, np.ndarray)):
        yield from enumerate(document)

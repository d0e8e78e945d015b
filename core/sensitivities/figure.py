"""What is read off an answer: a figure by its pointer, the time of an event, or how many entries a list has.

The same figure is read off the answers to a question with other numbers. An event is the n-th of its kind and name, and
not what stands at a place in the list.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from core.assessment.figures import inside, steps_of, value_at
from core.errors import InvalidParameter, Path, pointer_of

EVENTS: Path = ("events",)
"""Where answers have what happens."""

LONGEST_POINTER = 300

FORM = 'be a JSON pointer into the answer, {"event": {"kind", "name", "nth"}} or {"count": pointer}'


@dataclass(frozen=True)
class Figure:
    """A number or an array at a place of the answer."""

    path: Path

    @property
    def continuous(self) -> bool:
        """Whether it may change by as little as one likes."""
        return True

    def place(self, answer: Any) -> Path | None:
        """Return where the figure stands in an answer, None where it does not stand in it."""
        return None if value_at(answer, self.path) is None else self.path

    def value(self, answer: Any) -> Any:
        """Return the figure of an answer as `core.assessment.figures.value_at` does, None without it."""
        place = self.place(answer)
        return None if place is None else value_at(answer, place)

    def history(self, answer: Any) -> list[tuple[Any, Any]]:
        """Return kinds and names of the events of an answer on which the figure may depend."""
        return [(inside(event, "kind"), inside(event, "name")) for event in inside(answer, EVENTS[0]) or ()]

    @property
    def words(self) -> str:
        """The figure in a sentence."""
        return pointer_of(self.path)


@dataclass(frozen=True)
class EventTime(Figure):
    """The time of the n-th event, counted from 1, of a kind; of one connection, if a name is given."""

    kind: str = ""
    name: str | None = None
    nth: int = 1

    def place(self, answer: Any) -> Path | None:
        """Return where the time of the event stands in an answer."""
        left = self.nth
        for k, event in enumerate(inside(answer, EVENTS[0]) or ()):
            if inside(event, "kind") == self.kind and self.name in (None, inside(event, "name")):
                left -= 1
                if not left:
                    return (*EVENTS, k, "time")
        return None

    def history(self, answer: Any) -> list[tuple[Any, Any]]:
        """Return kinds and names of the events up to this one."""
        place = self.place(answer)
        return super().history(answer)[: None if place is None else int(place[1]) + 1]

    @property
    def words(self) -> str:
        """The figure in a sentence."""
        of = "" if self.name is None else f" of {self.name}"
        return f"the time of event {self.nth} of the kind {self.kind}{of}"


@dataclass(frozen=True)
class Count(Figure):
    """How many entries the list at a place of the answer has."""

    @property
    def continuous(self) -> bool:
        """Whether it may change by as little as one likes: never."""
        return False

    def place(self, answer: Any) -> Path | None:
        """Return where the list stands in an answer."""
        return None if self._length(answer) is None else self.path

    def value(self, answer: Any) -> float | None:
        """Return the number of entries, None where no list stands."""
        return self._length(answer)

    def _length(self, answer: Any) -> float | None:
        found = answer
        for step in self.path:
            found = inside(found, step)
        return (
            None if found is None or isinstance(found, (str, Mapping)) or not hasattr(found, "__len__") else len(found)
        )

    @property
    def words(self) -> str:
        """The figure in a sentence."""
        return f"the number of entries of {pointer_of(self.path)}"


def figure_of(given: Any, path: Path) -> Figure:
    """Return the figure that a request names.

    Parameters
    ----------
    given : str or mapping
        A JSON pointer into the answer, ``{"event": {kind, name, nth}}`` or ``{"count": pointer}``.
    path : tuple
        Where it stands in the request, for faults.

    Raises
    ------
    InvalidParameter
        For anything else.
    """
    if isinstance(given, str):
        return Figure(_steps(given, path))
    if not isinstance(given, Mapping) or len(given) != 1 or next(iter(given)) not in ("event", "count"):
        raise InvalidParameter(path, FORM)
    ((key, inner),) = given.items()
    if key == "count":
        return Count(_steps(inner, (*path, key)))
    if not isinstance(inner, Mapping) or set(inner) - {"kind", "name", "nth"} or not isinstance(inner.get("kind"), str):
        raise InvalidParameter((*path, key), 'be an object with "kind", and "name" and "nth" if wanted')
    name, nth = inner.get("name"), inner.get("nth", 1)
    if name is not None and not isinstance(name, str):
        raise InvalidParameter((*path, key, "name"), "be a name")
    if type(nth) is not int or nth < 1:
        raise InvalidParameter((*path, key, "nth"), "be a whole number from 1 on")
    return EventTime(EVENTS, inner["kind"], name, nth)


def _steps(pointer: Any, path: Path) -> Path:
    if not isinstance(pointer, str):
        raise InvalidParameter(path, FORM)
    if len(pointer) > LONGEST_POINTER:
        raise InvalidParameter(path, f"have at most {LONGEST_POINTER} characters")
    try:
        return steps_of(pointer)
    except InvalidParameter as fault:
        raise InvalidParameter(path, fault.rule, remedy=fault.remedy) from None

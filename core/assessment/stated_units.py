"""The unit of a figure: the one that is declared for its field, or the one that the declaration refers to.

What is declared is a unit, or one of the phrases here, which say where an answer states it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from core.assessment.figures import inside, value_at
from core.errors import Path

BESIDE = "as in the field unit"
"""In `unit` of the object that holds the field, or of the nearest around it."""

OF_THAT_NAME = "as in the field of that name"
"""An error: that of the field whose name it has, beside `errors`."""

OF_THE_INPUT = "as in the request at that pointer"
"""By pointer in `units` of the answer."""

OF_THE_FIGURE = "as in the figure of the answer"
"""By condition in `figure_units` of the answer."""


def unit_of(answer: Mapping[str, Any], path: Path, declared: Callable[[Path], str | None]) -> str:
    """Return the unit of the number, or of the array of numbers, at a path of an answer; "1" where none is stated.

    Parameters
    ----------
    answer : mapping
    path : path
    declared : callable
        From a path to what is declared of it, None if nothing is.
    """
    found = declared(path)
    if "errors" in path and found in (None, OF_THAT_NAME):
        k = path.index("errors")
        return unit_of(answer, (*path[:k], *path[k + 1 :]), declared)
    if found is None or found == BESIDE:
        return _beside(answer, path) or "1"
    if found == OF_THE_INPUT:
        return _of_the_input(inside(answer, "units"), path) or "1"
    if found == OF_THE_FIGURE:
        units = inside(answer, "figure_units") or ()
        # Of several figures there is an array, and of one its number alone.
        which = path[-1] if isinstance(path[-1], int) and len(units) > 1 else 0
        return (units[which] if which < len(units) else None) or "1"
    return found


def _beside(answer: Mapping[str, Any], path: Path) -> str | None:
    """Return the unit that the nearest object around a field states."""
    # An entry of an array has the unit that stands beside the array.
    stated = (value_at(answer, (*path[:k], "unit")) for k in range(len(path) - 1, 0, -1))
    return next((unit for unit in stated if isinstance(unit, str)), None)


def _of_the_input(units: Mapping[str, str | None] | None, path: Path) -> str | None:
    """Return the unit of the input whose pointer is in the path; of the only one, if none is."""
    units = units or {}
    named = [step for step in path if step in units] or [*units][: 1 if len(units) == 1 else 0]
    return units[str(named[0])] if named else None

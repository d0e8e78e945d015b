"""What a textbook asks backwards: a problem, what is varied in it, what is to hold, and the right values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

Body = dict[str, Any]

SCENES = "/v1/scenes"


@dataclass(frozen=True)
class Asked:
    """One question with its solution.

    Attributes
    ----------
    name : str
        What a course calls it.
    path : str
    request : dict
    vary : dict or list
    until : dict or list
    expected : sequence of float, or of tuples of several inputs
        In ascending order, from a closed form or from mpmath.
    how : str
        The formula or the integral.
    quick : bool
        Whether it belongs to the part that every run of the tests asks.
    """

    name: str
    path: str
    request: Body
    vary: Any
    until: Any
    expected: Sequence[Any]
    how: str
    quick: bool = False


def let(name: str, least: float, most: float) -> Body:
    """Return what varies a named number of a scene."""
    return {"pointer": f"/let/{name}", "between": [least, most]}


def equals(figure: Any, value: Any) -> Body:
    """Return the condition that a figure has a value."""
    return {"figure": figure, "equals": value}


def changes(figure: Any) -> Body:
    """Return the condition that a figure changes."""
    return {"figure": figure, "changes": True}

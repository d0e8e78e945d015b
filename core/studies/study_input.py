"""One varied input of a study: values, levels of a range, or a distribution."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from statistics import NormalDist
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.assessment.varied_input import LONGEST_WORD, MOST_TOGETHER, End, VariedInput
from core.errors import InvalidParameter
from core.quantities import Quantity, check

MOST_LEVELS = 1_000_000

LARGEST = sys.float_info.max

SMALLEST_CHANCE = 2.0**-54
"""In place of a chance of 0, of which a normal distribution has no number."""

FARTHEST = 8.5
"""Deviations beyond which no number of a normal distribution is: 8.3 belong to the smallest chance."""

_STANDARD = NormalDist()

Levels = Annotated[int, Quantity("1", at_least=1, at_most=MOST_LEVELS)]
Deviation = Annotated[float, Quantity("1", above=0)]


class Value:
    """Any JSON value; each member is read as a question, which checks it."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "any"}

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: Any) -> dict[str, Any]:
        vector = {"type": "array", "items": {"type": "number", "x-unit": "1"}}
        plain = ({"type": "number", "x-unit": "1"}, {"type": "string"}, {"type": "boolean"})
        # Such as a whole method.
        composed = {"type": "object", "title": "ComposedValue"}
        return {"anyOf": [*plain, composed, vector]}


@dataclass(frozen=True)
class StudyInput(VariedInput):
    """An input that varies: a range from `min` to `max`, `values`, or a normal distribution.

    Attributes
    ----------
    pointer : str
        JSON pointer into the request of the question, which has a value there.
    values : tuple, optional
        Any JSON values that the place may hold, such as a number, a word or a whole method.
    distribution : {"uniform", "log-uniform", "normal"}
        Of drawn numbers; the levels of a range are evenly spaced in it.
    mean, deviation : float, optional
        Of a normal distribution, in the unit of the input.
    count : int, optional
        Number of levels from min to max, both included, for designs of levels. The levels of a normal distribution
        are its quantiles at (k + 1/2)/count.
    """

    pointer: str = ""
    values: tuple[Annotated[Any, Value()], ...] | None = None
    distribution: Literal["uniform", "log-uniform", "normal"] = "uniform"  # type: ignore[assignment]
    mean: End | None = None
    deviation: Deviation | None = None
    count: Levels | None = None

    def __post_init__(self) -> None:
        if not self.pointer.startswith("/") or len(self.pointer) > LONGEST_WORD:
            remedy = 'such as "/angular_velocity/0"'
            raise InvalidParameter("pointer", "be a JSON pointer into the request", remedy=remedy)
        if self.values is not None:
            self._check_listed(self.values)
        elif self.distribution == "normal":
            self._check_normal()
        else:
            for name in ("mean", "deviation"):
                if getattr(self, name) is not None:
                    raise InvalidParameter(name, "be left out unless the distribution is normal")
            super().__post_init__()

    def _check_listed(self, values: tuple[Any, ...]) -> None:
        for name in ("min", "max", "step", "digits", "mean", "deviation", "count"):
            if getattr(self, name) is not None:
                raise InvalidParameter(name, "be left out beside values")
        if not 1 <= len(values) <= MOST_LEVELS:
            raise InvalidParameter("values", f"have 1 to {MOST_LEVELS} entries")
        for k, value in enumerate(values):
            if not _has_doubles(value):
                raise InvalidParameter(("values", k), "be finite", remedy="numbers beyond 1.8e308 are not read")
        if len(self.also) > MOST_TOGETHER:
            raise InvalidParameter("also", f"have at most {MOST_TOGETHER} pointers")

    def _check_normal(self) -> None:
        check(self)
        for name in ("min", "max", "step", "digits"):
            if getattr(self, name) is not None:
                raise InvalidParameter(name, "be left out where the distribution is normal")
        for name in ("mean", "deviation"):
            if getattr(self, name) is None:
                raise InvalidParameter(name, "be given for a normal distribution")
        assert self.mean is not None
        assert self.deviation is not None
        if not isfinite(abs(self.mean) + FARTHEST * self.deviation):
            raise InvalidParameter(
                "deviation", f"leave {FARTHEST} deviations from the mean within the range of doubles"
            )
        if len(self.also) > MOST_TOGETHER:
            raise InvalidParameter("also", f"have at most {MOST_TOGETHER} pointers")

    @property
    def levels(self) -> int | None:
        """How many levels a design of levels has along this input, None where none are stated."""
        return self.count if self.values is None else len(self.values)

    def chances_of_levels(self, which: NDArray[np.int64]) -> Floats:
        """Return where levels, by their numbers from 0, stand in the distribution: from 0 to 1."""
        count = self.levels or 1
        if self.values is not None or self.distribution == "normal":
            return (which + 0.5) / count
        return which / max(count - 1, 1)

    def numbers(self, chances: Floats) -> Floats:
        """Return what belongs to numbers from 0 to 1: numbers of the distribution, or places in `values`.

        Element by element the numbers that `draw` gives; a chance of 1 is the upper end of a range.
        """
        if self.values is not None:
            return np.minimum(np.floor(chances * len(self.values)), len(self.values) - 1.0)
        if self.distribution == "normal":
            assert self.mean is not None
            assert self.deviation is not None
            within = np.maximum(chances, SMALLEST_CHANCE).tolist()
            return self.mean + self.deviation * np.array([_STANDARD.inv_cdf(chance) for chance in within])
        if self.distribution == "uniform" and self.step is None and self.digits is None:
            assert self.min is not None
            assert self.max is not None
            drawn: Floats = self.min * (1.0 - chances) + self.max * chances
            return np.minimum(self.max, np.maximum(self.min, drawn))
        # exp and log of numpy are not those of the C library to the last bit, nor the same on every machine.
        below = np.minimum(chances, np.nextafter(1.0, 0.0)) if self.step is not None else chances
        return np.array([self.draw(chance) for chance in below.tolist()], dtype=np.float64)

    def value(self, number: float) -> Any:
        """Return the JSON value that an entry of `numbers` stands for."""
        return number if self.values is None else self.values[int(number)]


def _has_doubles(value: Any) -> bool:
    """Return whether all numbers of a JSON value are finite doubles."""
    if isinstance(value, (int, float)):
        return abs(value) <= LARGEST
    if isinstance(value, Mapping):
        return all(map(_has_doubles, value.values()))
    return not isinstance(value, (list, tuple)) or all(map(_has_doubles, value))

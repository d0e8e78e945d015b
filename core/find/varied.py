"""An input that is varied: a number of the request, and the range in which it is looked for."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from math import exp, isfinite, log, nextafter, sqrt, ulp
from typing import Literal

from core.errors import InvalidParameter, Path
from core.formulas import is_formula

Scale = Literal["linear", "log"]

LARGEST = 1.7e308
"""Largest width of a range, so that no difference within it overflows, and largest size of what a figure equals."""

FEWEST = 1000
"""Roundings that a range is wide at least, so that samples are different doubles: a search takes up to 600."""


def can_vary(present: object, names: Collection[str]) -> bool:
    """Return whether what stands in a request is a number, or a formula over names."""
    return is_formula(present, names) if isinstance(present, str) else type(present) in (int, float)


@dataclass(frozen=True)
class Varied:
    """A number of a request that is varied.

    Attributes
    ----------
    pointer : str
        JSON pointer into the request.
    path : path
        The same in steps.
    least, most : float
        Ends of the range, both possible, in the unit of the number as it stands in the request.
    scale : {"linear", "log"}
        In which samples are evenly spaced.
    unit : str or None
        Of the number as it stands in the request, None where it is not known.
    """

    pointer: str
    path: Path
    least: float
    most: float
    scale: Scale = "linear"
    unit: str | None = None

    def __post_init__(self) -> None:
        for i, end in enumerate((self.least, self.most)):
            if not isfinite(end):
                raise InvalidParameter(("between", i), "be finite")
        if not self.least < self.most:
            swapped = self.most < self.least
            remedy = "write the smaller one first" if swapped else "a single value is the question itself"
            raise InvalidParameter(("between", 1), "be greater than the first", remedy=remedy)
        if self.most - self.least < FEWEST * ulp(max(abs(self.least), abs(self.most))):
            rule = f"be greater than the first by at least {FEWEST} roundings of doubles"
            raise InvalidParameter(("between", 1), rule, remedy="a range so narrow is a single value: ask the question")
        if self.scale == "log" and self.least <= 0.0:
            rule = "be greater than 0 on a log scale"
            raise InvalidParameter(("between", 0), rule, remedy='take the scale "linear"')
        if not self.most - self.least < LARGEST:
            raise InvalidParameter(("between", 1), f"lie within {LARGEST:g} of the first")

    def coordinate(self, value: float) -> float:
        """Return where a value stands on the scale."""
        return log(value) if self.scale == "log" else value

    def value(self, coordinate: float) -> float:
        """Return the value at a place of the scale, inside of the range."""
        value = exp(min(coordinate, log(self.most))) if self.scale == "log" else coordinate
        return min(self.most, max(self.least, value))

    def at_share(self, share: float) -> float:
        """Return the value at a share of the range, from 0 to 1; the ends exactly."""
        if share in (0.0, 1.0):
            return self.most if share else self.least
        first, last = self.coordinate(self.least), self.coordinate(self.most)
        return self.value(first + (last - first) * share)

    def width(self, first: float, second: float) -> float:
        """Return the distance of two values as a share of the range."""
        whole = self.coordinate(self.most) - self.coordinate(self.least)
        return abs(self.coordinate(second) - self.coordinate(first)) / whole

    def middle(self, first: float, second: float) -> float:
        """Return a value halfway between two; one of them where there is no double between."""
        if self.scale == "log" and second / first > 2.0:
            return sqrt(first) * sqrt(second)
        if first < 0.0 < second:
            return 0.5 * (first + second)
        # Of numbers of very different size the double halfway down the exponents is reached sooner than by halving.
        small, large = sorted((abs(first), abs(second)))
        if small > 0.0 and large / small > 16.0:
            between = sqrt(small) * sqrt(large)
            return between if first > 0.0 else -between
        return first + 0.5 * (second - first)


def beside(value: float, distance: float) -> tuple[float, float]:
    """Return the doubles at a distance on either side, at least the neighbours."""
    return min(value - distance, nextafter(value, -1e400)), max(value + distance, nextafter(value, 1e400))


def neighbours(first: float, second: float) -> bool:
    """Return whether no double is between two."""
    return nextafter(first, second) in (first, second) or first == second


def rounding(value: float) -> float:
    """Return what the spacing of doubles leaves open about a value."""
    return ulp(value)

"""What a question will cost, before it is answered: counts that the question tells, times measured costs per count.

The costs are read from a table that `benchmarks.calibration` measures and writes. Times are the measuring machine's;
counts hold on every machine.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib import resources
from math import exp, floor, hypot, inf, isfinite, log, sqrt
from sys import float_info
from typing import Any

import numpy as np

from core.elliptic.functions import LARGEST_QUARTER
from core.errors import LARGEST_COUNT
from core.systems.budget import Budget

Counts = Mapping[str, float]

UNCOUNTABLE = float(LARGEST_COUNT)
"""What is more than this is counted as this: infinite counts, times nothing, would leave a question without a price."""

EXACT_IN_DOUBLES = 1e15
"""Steps from which on doubles do not tell whole numbers of them from others."""

ROUNDED_TIME = 4 * 2.0**-52
"""By how much of itself a time may miss a grid point of a fixed step and count as that."""


@dataclass(frozen=True)
class Calibration:
    """The measured table.

    Attributes
    ----------
    seconds : mapping of str to mapping of str to float
        By operation, cost per count of computing the answer; zero for a count whose cost does not stand out.
    writing : float
        Time per byte of writing an answer (s).
    methods : mapping of str to mapping of str to float
        By kind of method: ``evaluations`` per step, or logarithms of ``evaluations`` per radian turned at tolerance one
        and their ``exponent``; ``error`` and ``error_exponent``, per radian turned, likewise.
    """

    seconds: Mapping[str, Counts]
    writing: float
    methods: Mapping[str, Mapping[str, float]]


@cache
def calibration() -> Calibration:
    """Return the committed table."""
    table = json.loads(resources.files("service.execution").joinpath("calibration.json").read_text(encoding="utf-8"))
    return Calibration(**{name: table[name] for name in ("seconds", "writing", "methods")})


@dataclass(frozen=True)
class CalibratedCost:
    """A route's price: the operation's name in the table, and what is counted of a question.

    Attributes
    ----------
    counts : callable
        Refuses what exceeds the budget.
    unmeasured : mapping of str to float, optional
        Costs that the table does not have for the operation.
    """

    operation: str
    counts: Callable[[Any, Budget], Counts]
    unmeasured: Counts = field(default_factory=dict)

    @cached_property
    def costs(self) -> Counts:
        """Cost of each count (s)."""
        seconds = calibration().seconds
        # A body is looked at in the same way for every question, and where it is small that does not stand out.
        points = seconds["mass_properties"]["points"]
        judging = seconds["rotation_trajectory"]["evaluations of dormand-prince-853"]
        return {"points": points, "judging evaluations": judging, **self.unmeasured, **seconds.get(self.operation, {})}

    def __call__(self, question: Any, budget: Budget) -> float:
        """Return the predicted time of computing an answer (s)."""
        costs = self.costs
        return sum((costs.get(name, 0.0) * count for name, count in self.counts(question, budget).items()), 0.0)


def one(question: Any, budget: Budget) -> Counts:
    """Return what is counted of a question that always costs the same."""
    return {"question": 1.0}


def in_closed_form(method: Any) -> bool:
    """Return whether nothing is to be integrated."""
    return method is None or bool(method.kind == "closed-form")


def setting(method: Any) -> tuple[str, float]:
    """Return the name and the value of a method's setting."""
    name = "step" if hasattr(method, "step") else "tolerance"
    return name, getattr(method, name)


def evaluations(method: Any, times: Sequence[float] | Any, speed: float) -> float:
    """Return how often a method is predicted to evaluate the equation of a rotation with `speed` (rad/s)."""
    if in_closed_form(method):
        return 0.0
    name, value = setting(method)
    costs = calibration().methods[method.kind]
    if name == "step":
        return costs["evaluations"] * steps(times, value)
    turned = speed * extent(times) if speed else 0.0
    return min(UNCOUNTABLE, _power(costs["evaluations"] + costs["exponent"] * log(value)) * (turned + 1.0))


def speed_of(rates: Sequence[float]) -> float:
    """Return the magnitude of an angular velocity, at most the largest double (rad/s)."""
    return min(hypot(*rates), float_info.max)


def quickest(speed: float, moments: Sequence[float] | None) -> float:
    """Return the angular speed (rad/s) that a method has to follow on a free motion with a speed at its start.

    Parameters
    ----------
    speed : float
        rad/s.
    moments : sequence of 3 floats, optional
        Principal moments, ascending (kg m^2); without, those of matter.
    """
    return speed_of([speed * _quickening(*moments)]) if speed and moments else speed


def _quickening(a: float, b: float, c: float) -> float:
    """Return how many times faster than it turns a body with such moments may swing about the axis of the largest.

    By Euler's equations, made linear about that axis: sqrt((c - a) (c - b) / (a b)), of all three axes the most. It is
    more than one where c > a + b, which no matter has, and then no such body comes to turn faster by a larger factor.
    """
    if c <= a + b:
        return 1.0
    # The least moment of a needle may have come out below zero.
    return max(1.0, sqrt((c - a) / b) * sqrt((c - b) / abs(a))) if a and b else inf


def _power(logarithm: float) -> float:
    return exp(min(700.0, logarithm))


def effort(method: Any, times: Any, speed: float, samples: float, members: int = 1) -> dict[str, float]:
    """Return what is counted of a method that is run."""
    if in_closed_form(method):
        return {}
    kind = method.kind
    return {
        f"runs of {kind}": members,
        f"samples of {kind}": samples * members,
        f"evaluations of {kind}": evaluations(method, times, speed) * members,
    }


def judged(method: Any, times: Any, speed: float, budget: Budget, members: int = 1) -> dict[str, float]:
    """Return what is counted of judging the error of a method where the closed form is out of reach.

    No method can follow such a motion: each member spends the budget of evaluations on a finer one in vain.
    """
    if in_closed_form(method) or speed * farthest(times) <= LARGEST_QUARTER:
        return {}
    return {"judging evaluations": float(budget.evaluations) * members}


def steps(times: Any, step: float) -> float:
    """Return the steps of a length from the start to either side, and one more for each time between two of them."""
    if not isfinite(extent(times)):
        return UNCOUNTABLE
    instants = np.unique(times if isinstance(times, list) else times.values())
    # Beyond the range of doubles they are uncountable.
    with np.errstate(over="ignore", invalid="ignore"):
        reached = np.abs(instants) / step
        between = (reached < EXACT_IN_DOUBLES) & (np.abs(reached - np.rint(reached)) > ROUNDED_TIME * reached)
    sides = (_whole(max(0.0, float(end)) / step) for end in (instants[-1], -instants[0]))
    return min(UNCOUNTABLE, sum(sides) + float(np.count_nonzero(between)))


def _whole(number: float) -> float:
    """Return how many whole steps a number of them has, up to the rounding of a quotient of times."""
    return float(floor(number * (1.0 + ROUNDED_TIME))) if number < EXACT_IN_DOUBLES else min(number, UNCOUNTABLE)


def extent(times: Any) -> float:
    """Return how far a method marches, to both sides of the start (s)."""
    ends = ends_of(times)
    return max(0.0, *ends) - min(0.0, *ends)


def farthest(times: Any) -> float:
    """Return the largest distance from the start (s)."""
    return max(map(abs, ends_of(times)))


def ends_of(times: Any) -> list[float]:
    """Return times among which are the least and the largest (s)."""
    if isinstance(times, list):
        return times
    # A single time is the start, wherever the stop is.
    return [times.start, times.stop] if times.count > 1 else [times.start]


def numbers(count: float, digits: Any) -> dict[str, float]:
    """Return what is counted of the numbers in an answer: how many, or the digits if fewer are wanted."""
    return {"digits": count * digits} if isinstance(digits, int) else {"numbers": count}

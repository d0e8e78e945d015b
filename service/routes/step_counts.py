"""How many steps a method with a fixed step takes to the times of a question, counted without running it."""

from __future__ import annotations

from math import floor, isfinite
from typing import Any

import numpy as np

from core.errors import LARGEST_COUNT
from core.systems.methods import ExplicitEuler, RungeKutta4
from core.systems.methods.fixed_step import FixedStep
from service.schemas import ends_of

UNCOUNTABLE = float(LARGEST_COUNT)
"""What is more than this is counted as this."""

EXACT_IN_DOUBLES = 1e15
"""Steps from which on doubles do not tell whole numbers of them from others."""

ROUNDED_TIME = 4 * 2.0**-52
"""By how much of itself a time may miss a grid point of a fixed step and count as that."""

EXPLICIT = (ExplicitEuler, RungeKutta4)
"""Methods of which every step takes the same evaluations; others iterate, or depend on the system."""


def least_evaluations(method: FixedStep, times: Any) -> int:
    """Return how often a method evaluates the equation of motion at least; it is exact for `EXPLICIT` methods."""
    return round(method.evaluations * steps(times, method.step))


def steps(times: Any, step: float) -> float:
    """Return the steps of a length from the start to either side, and one more for each time between two of them."""
    ends = [0.0, *ends_of(times)]
    if not isfinite(max(ends) - min(ends)):
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

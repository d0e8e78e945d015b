"""Derivatives of functions that are known, and those that do not exist."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, exp, inf, sin, sqrt

import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable
from core.sensitivities.derivative import Derivative, Known, derivative


def of(
    function: Callable[[float], float], at: float, scale: float = 1.0, error: float = 0.0, **more: float
) -> Derivative:
    return derivative(lambda x: Known(np.array(function(x)), error), at, scale, **more)


@pytest.mark.parametrize(
    ("function", "at", "scale", "true"),
    [
        (sin, 1.0, 1.0, cos(1.0)),
        (exp, 30.0, 30.0, exp(30.0)),
        (lambda x: sin(1e4 * x), 1.0, 1.0, 1e4 * cos(1e4)),
        (lambda x: 1.0 / (x - 1.001), 1.0, 1.0, -1e6),
        (lambda x: x**5, 0.0, 1.0, 0.0),
        (lambda x: 7.0, 1.0, 1.0, 0.0),
        (lambda x: x * x, 1e150, 1e150, 2e150),
        (lambda x: x * x, -1e-150, 1e-150, -2e-150),
        (lambda x: float(x > 1.001), 1.0, 1.0, 0.0),
    ],
)
def test_known_derivatives_are_met_within_the_stated_error(
    function: Callable[[float], float], at: float, scale: float, true: float
) -> None:
    found = of(function, at, scale)
    assert abs(found.value - true) <= found.error + 1e-15 * abs(true)
    assert found.error <= 1e-9 * max(abs(true), 1e-300) or true == 0.0


def test_the_errors_of_the_figure_count_in() -> None:
    noise = np.random.default_rng(1)
    found = of(lambda x: sin(x) + 1e-8 * noise.uniform(-1.0, 1.0), 1.0, error=1e-8)
    assert abs(found.value - cos(1.0)) <= found.error
    assert 1e-8 < found.error < 1e-5


@pytest.mark.parametrize(
    ("function", "at"),
    [
        (abs, 0.0),
        (lambda x: max(x - 1.0, 0.0), 1.0),
        (lambda x: float(x > 1.0), 1.0),
        (lambda x: float(x >= 1.0), 1.0),
        (lambda x: sqrt(abs(x)), 0.0),
    ],
)
def test_corners_and_jumps_have_none(function: Callable[[float], float], at: float) -> None:
    with pytest.raises(NotApplicable, match="corner or jumps"):
        of(function, at)


def test_what_is_refused_far_away_is_found_close_by_and_what_is_refused_everywhere_says_why() -> None:
    def within(width: float) -> Callable[[float], float]:
        def function(x: float) -> float:
            if abs(x - 1.0) > width:
                raise InvalidParameter("x", "be near 1")
            return x * x

        return function

    assert of(within(1e-4), 1.0).value == pytest.approx(2.0, rel=1e-10)
    with pytest.raises(NotApplicable, match="be near 1"):
        of(within(0.0), 1.0)


def test_few_evaluations_where_little_is_wanted() -> None:
    count = 0

    def function(x: float) -> float:
        nonlocal count
        count += 1
        return sin(x)

    assert of(function, 1.0, tolerance=1e-3).value == pytest.approx(cos(1.0), rel=1e-3)
    assert count == 5


def test_beyond_the_range_of_doubles() -> None:
    with pytest.raises(NotApplicable, match="range of doubles"):
        of(lambda x: 1.0 / x, 1e-300, 1e-300)
    with pytest.raises(NotApplicable, match="range of doubles"):
        of(lambda x: x, 1.0, inf)

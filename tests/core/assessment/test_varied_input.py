"""Numbers that are drawn for variants: in the range, on the grid, of few digits, as they are distributed."""

from __future__ import annotations

from decimal import Decimal
from math import inf, log, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from core.assessment.varied_input import VariedInput, rounded
from core.errors import InvalidParameter

FINITE = st.floats(-1e308, 1e308, allow_subnormal=False)
CHANCE = st.floats(0.0, 1.0, exclude_max=True)


def significant_digits(number: float) -> int:
    return len(Decimal(repr(number)).normalize().as_tuple().digits)


@given(FINITE, FINITE, CHANCE)
def test_a_range_contains_what_is_drawn_from_it(one: float, other: float, chance: float) -> None:
    low, high = sorted((one, other))
    assume(low < high)
    assert low <= VariedInput(min=low, max=high).draw(chance) <= high


@given(st.floats(1e-300, 1e300), st.floats(1.001, 1e5), CHANCE)
def test_a_logarithmic_range_too(low: float, ratio: float, chance: float) -> None:
    drawn = VariedInput(min=low, max=low * ratio, distribution="log-uniform").draw(chance)
    assert low <= drawn <= low * ratio


@given(st.integers(1, 6), st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), CHANCE)
def test_few_digits_are_few_and_in_the_range(digits: int, low: float, width: float, chance: float) -> None:
    assume(rounded(low, digits, "ROUND_CEILING") <= low + width)
    varied = VariedInput(min=low, max=low + width, digits=digits)
    drawn = varied.draw(chance)
    assert low <= drawn <= low + width
    assert significant_digits(drawn) <= digits


@given(st.integers(-50, 50), st.integers(1, 60), CHANCE, st.sampled_from(["uniform", "log-uniform"]))
def test_a_grid_is_met_exactly_as_decimals_are_written(first: int, steps: int, chance: float, kind: Any) -> None:
    assume(kind == "uniform" or first > 0)
    low, high = float(Decimal(first) / 10), float(Decimal(first + steps) / 10)
    drawn = VariedInput(min=low, max=high, step=0.1, distribution=kind).draw(chance)
    assert 10 * Decimal(repr(drawn)) == int(10 * Decimal(repr(drawn)))
    assert low <= drawn <= high


def test_three_steps_of_a_tenth_are_three_tenths() -> None:
    assert VariedInput(min=0.0, max=0.3, step=0.1).draw(0.99) == 0.3
    # The last point of the grid is the last that is in the range.
    assert VariedInput(min=0.0, max=0.35, step=0.1).draw(0.999) == 0.3


def test_draws_are_distributed_as_they_are_said_to_be() -> None:
    chances = (np.arange(1000) + 0.5) / 1000
    uniform = VariedInput(min=1.0, max=100.0)
    logarithmic = VariedInput(min=1.0, max=100.0, distribution="log-uniform")
    assert np.mean([uniform.draw(c) for c in chances]) == pytest.approx(50.5)
    assert np.mean([log(logarithmic.draw(c)) for c in chances]) == pytest.approx(log(10.0))
    grid = VariedInput(min=1.0, max=4.0, step=1.0)
    assert [sum(grid.draw(c) == k for c in chances) for k in (1, 2, 3, 4)] == [250] * 4
    choice = VariedInput(values=("a", "b"))
    assert sum(choice.draw(c) == "a" for c in chances) == 500


@pytest.mark.parametrize(
    ("fields", "path", "rule"),
    [
        ({}, ("min",), "be given"),
        ({"min": 1.0}, ("max",), "be given"),
        ({"min": 1.0, "max": 1.0}, ("max",), "greater than min"),
        ({"min": 2.0, "max": 1.0}, ("max",), "greater than min"),
        ({"min": nan, "max": 1.0}, ("min",), "finite"),
        ({"min": 0.0, "max": inf}, ("max",), "finite"),
        ({"min": 0.0, "max": 1.0, "distribution": "log-uniform"}, ("min",), "greater than 0"),
        ({"min": 0.0, "max": 1.0, "step": 2.0}, ("step",), "fit into the range"),
        ({"min": 0.0, "max": 1.0, "step": 0.0}, ("step",), "greater than 0"),
        ({"min": 0.0, "max": 1e308, "step": 1e-308}, ("step",), "fit into the range"),
        ({"min": 0.0, "max": 1.0, "step": 0.1, "digits": 2}, ("digits",), "left out"),
        ({"min": 0.11, "max": 0.19, "digits": 1}, ("digits",), "leave a number"),
        ({"min": 0.0, "max": 1.0, "digits": 0}, ("digits",), "at least 1"),
        ({"values": (1.0, 2.0), "min": 1.0}, ("min",), "left out beside values"),
        ({"values": (1.0,)}, ("values",), "2 to 1000"),
        ({"values": (1.0, None)}, ("values", 1), "be a number, a string"),
        ({"values": (1.0, nan)}, ("values", 1), "be finite"),
        ({"values": (1.0, 10**400)}, ("values", 1), "be finite"),
        ({"values": ("a", "b" * 201)}, ("values", 1), "at most 200 characters"),
        ({"min": 0.0, "max": 1.0, "also": ("/a",) * 21}, ("also",), "at most 20"),
    ],
)
def test_what_cannot_be_drawn_from_is_refused(fields: Any, path: Any, rule: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as caught:
        VariedInput(**fields)
    assert caught.value.path == path


def test_zero_has_any_number_of_digits() -> None:
    assert rounded(0.0, 3) == 0.0
    assert VariedInput(min=-0.0004, max=0.0004, digits=1).draw(0.5) == 0.0

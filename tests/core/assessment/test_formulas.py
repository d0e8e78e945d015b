"""Values of students' formulas where there are none, and dimensions by hand."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from core.assessment.formulas import DimensionFault, Undefined, dimensions, value_in_doubles
from core.formulas import Formula

NAMES = {"M": 2.0}


@pytest.mark.parametrize(
    "text", ["1/0", "1/(M-2)", "sqrt(-M)", "(-M)^0.5", "9^9^9", "exp(1e6)", "log(0)", "acos(M)", "0^-1"]
)
def test_what_has_no_value_is_undefined(text: str) -> None:
    with pytest.raises(Undefined):
        value_in_doubles(Formula.read(text, NAMES), NAMES)


UNITS: dict[str, Any] = {
    "M": {"kg": Fraction(1)},
    "g": {"m": Fraction(1), "s": Fraction(-2)},
    "l": {"m": Fraction(1)},
    "alpha": {},
}


@pytest.mark.parametrize(
    ("text", "powers"),
    [
        ("M*g*sin(alpha)", {"kg": 1, "m": 1, "s": -2}),
        ("sqrt(2*g/l)", {"s": -1}),
        ("(g*l)^(3/2)", {"m": 3, "s": -3}),
        ("l/l", {}),
        ("l^0", {}),
        ("abs(-l) + 2*l", {"m": 1}),
    ],
)
def test_dimensions_follow_from_those_of_the_parameters(text: str, powers: dict[str, int]) -> None:
    assert dimensions(Formula.read(text, UNITS), UNITS) == powers


@pytest.mark.parametrize("text", ["1 + l", "l - M", "sin(l)", "l^alpha", "2^l", "1 - sqrt(l^2 - 1)", "l^1e9"])
def test_unequal_dimensions_are_faults(text: str) -> None:
    with pytest.raises(DimensionFault):
        dimensions(Formula.read(text, UNITS), UNITS)

"""Numbers as clients write them, against rational and mpmath arithmetic."""

from __future__ import annotations

from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from flint import arb, fmpq
from hypothesis import given
from hypothesis import strategies as st

from core.balls import precision
from core.errors import InvalidParameter
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.numerals import Numerals


def ball(value: Any, let: Any = None, numbers: Any = "decimals") -> Any:
    with precision(BITS):
        return Numerals.of(let or {}, numbers).number(value, ("x",))


def exactly(value: Any) -> Any:
    with precision(BITS):
        fraction = Fraction(value)
        return arb(fmpq(fraction.numerator, fraction.denominator))


READ = st.just(0.0) | st.floats(1e-300, 1e300) | st.floats(-1e300, -1e-300)


@given(READ)
def test_a_double_is_its_shortest_decimal(number: float) -> None:
    assert ball(number).overlaps(exactly(repr(number)))
    assert ball(np.float64(number)).overlaps(exactly(repr(number)))
    assert float(ball(number)) == number
    assert ball(number, numbers="doubles") == Fraction(number) or ball(number, numbers="doubles").overlaps(
        exactly(number)
    )


@pytest.mark.parametrize(
    "number", [1.1e300, -1e301, 9e-301, 5e-324, "1e200*1e101", "1e-150^3", 10**301, Decimal("1e-301")]
)
def test_numbers_near_and_beyond_the_ends_of_the_doubles_are_refused(number: Any) -> None:
    with pytest.raises(InvalidParameter, match="between 1e-300 and 1e300"):
        ball(number)


def test_tenths_add_up() -> None:
    with precision(BITS):
        assert 0 in ball(0.9) + ball("0.1") - 1
        assert 0 not in ball(0.9, numbers="doubles") + ball(0.1, numbers="doubles") - 1
        assert 0 not in ball(0.3, numbers="doubles") - 3 * ball(0.1, numbers="doubles")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", 7),
        ("-(2-5)/4", 0.75),
        ("2*-3", -6),
        (" 1e-3 * 2E3 ", 2),
        (".5 + 1.", 1.5),
        ("sqrt(2)*sqrt(2)", 2),
        ("sin(pi/6)", 0.5),
        ("cos(0)", 1),
        ("h*h", 2.25),
        ("8/4/2", 1),
        ("tan(pi/4)", 1),
        ("h^2 - 2**-2", 2),
        ("acos(cos(pi))/pi + asin(sin(pi/2))/pi", 1.5),
        ("4^0.5", 2),
    ],
)
def test_formulas(text: str, value: float) -> None:
    assert ball(text, {"g": 3, "h": "g/2"}).overlaps(exactly(value))


def test_formulas_agree_with_mpmath() -> None:
    with mpmath.workdps(80):
        expected = mpmath.sqrt(3) * mpmath.sin(mpmath.mpf("0.7")) / (1 - mpmath.pi)
        with precision(BITS):
            assert abs(ball("sqrt(3)*sin(0.7)/(1-pi)") - arb(mpmath.nstr(expected, 75))) < 1e-70


def test_angles_in_degrees_are_exact_where_they_can_be() -> None:
    with precision(BITS):
        cosine, sine = Numerals.of({}).angle({"degrees": 90}, ("x",))
        assert (cosine, sine) == (0, 1)
        assert 0 in Numerals.of({}).angle({"degrees": 60}, ("x",))[0] - arb(1) / 2
        x, y = Numerals.of({}).vector({"polar": [2, {"degrees": 30}]}, ("x",), 2)
        assert 0 in y - 1
        assert 0 in x * x - 3


@pytest.mark.parametrize(
    "text",
    ["", "1+", "(1", "1)", "1 2", "x", "sin 1", "sin", "1//2", "2^101", "0^-1", "tan(pi/2)", "log(0)", "asin(2)",
     "9^9^9", "__import__('os')", "1e99999", "1/0", "sqrt(-1)",
     "(" * 100 + "1" + ")" * 100, "-" * 100 + "1", "1" * 301, "nan", "inf", "0x10", "1_000", "1;2", "π"],
)  # fmt: skip
def test_what_is_no_number_is_refused(text: str) -> None:
    with pytest.raises(InvalidParameter) as refused:
        ball(text)
    assert refused.value.path == ("x",)


@pytest.mark.parametrize(
    "value", [None, True, [], float("nan"), float("-inf"), Decimal("nan"), Decimal("1e999"), 10**2000, {"degrees": {}},
              {"radians": 1}, object(), 1j],
)  # fmt: skip
def test_what_is_of_another_type_is_refused(value: Any) -> None:
    with pytest.raises(InvalidParameter):
        ball(value)


@pytest.mark.parametrize("let", [{"sin": 1}, {"pi": 3}, {"a b": 1}, {"a": "b", "b": 1}, {"": 1}, {3: 1}])
def test_names_that_cannot_be(let: Any) -> None:
    with precision(BITS), pytest.raises(InvalidParameter) as refused:
        Numerals.of(let)
    assert refused.value.path[0] == "let"


@given(st.text(max_size=40))
def test_no_text_does_anything_but_mean_a_number_or_be_refused(text: str) -> None:
    with suppress(InvalidParameter):
        assert ball(text).is_finite()


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("acos(0.3 - 0.3)", mpmath.pi / 2),
        ("asin(0.3 - 0.3)", 0),
        ("acos(0.1 + 0.2 - 0.3)", mpmath.pi / 2),
        ("asin(1 - 0.9 - 0.1)", 0),
        ("acos(0.7 + 0.3)", 0),
        ("asin(-0.7 - 0.3)", -mpmath.pi / 2),
        ("(0.3 - 0.3)^0.5", 0),
        ("(0.1 + 0.2 - 0.3)^1.5", 0),
        ("sqrt(0.3 - 0.3)", 0),
    ],
)
def test_functions_of_what_cancels(text: str, value: Any) -> None:
    """Differences of decimals that are zero are so in balls up to their width, also where functions end there."""
    found = ball(text)
    assert found.is_finite()
    assert abs(float(found) - float(value)) < 1e-90 or float(found) == float(value)


@pytest.mark.parametrize("angle", [1e100, {"degrees": 1e100}, {"value": 1e30, "unit": "deg"}, "-10^16"])
def test_angles_whose_direction_no_double_holds_are_refused(angle: Any) -> None:
    with precision(BITS), pytest.raises(InvalidParameter, match="an angle of at most"):
        Numerals.of({}).angle(angle, ("x",))


def test_large_angles_are_reduced_exactly() -> None:
    with precision(BITS):
        cosine, sine = Numerals.of({}).angle({"degrees": 3.6e14 + 30}, ("x",))
        assert 0 in sine - arb(1) / 2
        assert 0 in cosine * cosine - arb(3) / 4

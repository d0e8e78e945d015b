"""Formulas against Python's own evaluation of the same expressions, and hostile texts against their limits."""

from __future__ import annotations

import math
from contextlib import suppress
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.assessment.formulas import DEEPEST, LONGEST_FORMULA, Formula, Undefined
from core.errors import InvalidParameter

NAMES = {"M": 2.0, "g": 9.81, "alpha": 0.5, "a_1": 3.0, "pi_2": 7.0}


def value(text: str) -> float:
    return Formula.read(text, NAMES).value(NAMES)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("M*g*sin(alpha)/3", 2.0 * 9.81 * math.sin(0.5) / 3),
        ("-M^2", -4.0),
        ("(-M)^2", 4.0),
        ("2^3^2", 512.0),
        ("2**-1", 0.5),
        ("M^-a_1^2", 2.0**-9),
        ("1 - 2 - 3", -4.0),
        ("12 / 3 / 2", 2.0),
        ("2 * -M", -4.0),
        (" sqrt( M )*1.5e1 ", 15 * math.sqrt(2)),
        (".5*pi + 1.", 0.5 * math.pi + 1),
        ("atan(tan(alpha))+ln(exp(1))", 1.5),
        ("pi_2", 7.0),
        ("+M", 2.0),
    ],
)
def test_precedence_is_that_of_mathematics(text: str, expected: float) -> None:
    assert value(text) == pytest.approx(expected, rel=1e-15)


trees = st.recursive(
    st.sampled_from(["M", "g", "alpha", "2.5", "1e-1", "3"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        inner.map(lambda t: f"-({t})"),
        inner.map(lambda t: f"sin({t})"),
    ),
    max_leaves=8,
)


@given(text=trees)
def test_expressions_are_worth_what_python_says(text: str) -> None:
    try:
        # The text is one that this test has made.
        expected = eval(text, {"__builtins__": {}}, {**NAMES, "sin": math.sin})
    except ZeroDivisionError:
        with pytest.raises(Undefined):
            value(text)
        return
    assert value(text) == pytest.approx(expected, rel=1e-14, abs=1e-300)


@pytest.mark.parametrize(
    "text",
    [
        *("", " ", "(", ")", "M g", "M)", "(M", "2M", "M +", "* M", "sin", "sin M", "sin()", "M()", "1e", "1.2.3", "x"),
        *("M.real", "M[0]", "lambda: 1", "M;g", "M=2", "0x10", "1_000", "M if g else 1", "'a'", "𝟏", "é", "M\x00"),
        *("__import__('os')", "1e9999", "9" * (LONGEST_FORMULA + 1), "M+" * LONGEST_FORMULA, "2^" * DEEPEST + "2"),
        *("(" * (DEEPEST + 1) + "M" + ")" * (DEEPEST + 1), "-" * (DEEPEST + 1) + "M", "sin(" * 50 + "M" + ")" * 50),
    ],
)
def test_hostile_texts_are_refused(text: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        Formula.read(text, NAMES)
    assert fault.value.rule


@given(text=st.text(alphabet="Mg()+-*/^.0123456789e sqrt", max_size=60))
def test_any_text_is_a_formula_or_refused(text: str) -> None:
    try:
        formula = Formula.read(text, NAMES)
    except InvalidParameter:
        return
    with suppress(Undefined):
        assert math.isfinite(formula.value(NAMES))


@pytest.mark.parametrize(
    "text", ["1/0", "1/(M-2)", "sqrt(-M)", "(-M)^0.5", "9^9^9", "exp(1e6)", "log(0)", "acos(M)", "1e999", "0^-1"]
)
def test_what_has_no_value_is_undefined(text: str) -> None:
    with pytest.raises(Undefined):
        value(text)


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
    assert Formula.read(text, UNITS).dimensions(UNITS) == powers


@pytest.mark.parametrize("text", ["1 + l", "l - M", "sin(l)", "l^alpha", "2^l", "1 - sqrt(l^2 - 1)", "l^1e9"])
def test_unequal_dimensions_are_faults(text: str) -> None:
    with pytest.raises(InvalidParameter):
        Formula.read(text, UNITS).dimensions(UNITS)

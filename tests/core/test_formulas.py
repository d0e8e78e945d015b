"""Formulas against Python's own evaluation of the same expressions, and hostile texts against their limits."""

from __future__ import annotations

import math
from contextlib import suppress

import mpmath
import pytest
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from core.assessment.formulas import Undefined, value_in_doubles
from core.balls import precision
from core.errors import InvalidParameter
from core.formulas import DEEPEST, FUNCTIONS, LONGEST_FORMULA, Formula, UnknownName
from core.formulas_in_doubles import DOUBLES
from core.multibody.language.numerals import BALLS

NAMES = {"M": 2.0, "g": 9.81, "alpha": 0.5, "a_1": 3.0, "pi_2": 7.0}


def value(text: str) -> float:
    return value_in_doubles(Formula.read(text, NAMES), NAMES)


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
        *(
            "__import__('os')",
            "1e401",
            "1e-401",
            "1e9999",
            "9" * (LONGEST_FORMULA + 1),
            "M+" * LONGEST_FORMULA,
            "2^" * DEEPEST + "2",
        ),
        *("(" * (DEEPEST + 1) + "M" + ")" * (DEEPEST + 1), "-" * (DEEPEST + 1) + "M", "sin(" * 50 + "M" + ")" * 50),
    ],
)
def test_hostile_texts_are_refused(text: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        Formula.read(text, NAMES)
    assert fault.value.rule


@pytest.mark.parametrize(("text", "mark"), [("-9,81", "9,81"), ("M*1,5", "1,5"), ("1,5*M", "1,5")])
def test_a_decimal_comma_is_named(text: str, mark: str) -> None:
    with pytest.raises(InvalidParameter, match=f'decimal points, unlike "{mark}"') as fault:
        Formula.read(text, NAMES)
    assert fault.value.remedy == f"write {mark.replace(',', '.')}"


@pytest.mark.parametrize("text", ["M, g", "1,", "1.5,5", ",5"])
def test_another_comma_is_not(text: str) -> None:
    with pytest.raises(InvalidParameter, match="complete formula"):
        Formula.read(text, NAMES)


@given(text=st.text(alphabet="Mg()+-*/^.0123456789e sqrt", max_size=60))
def test_any_text_is_a_formula_or_refused(text: str) -> None:
    try:
        formula = Formula.read(text, NAMES)
    except InvalidParameter:
        return
    with suppress(Undefined):
        assert math.isfinite(value_in_doubles(formula, NAMES))


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("at", ["0.3", "0.7", "1"])
def test_both_arithmetics_have_every_function(name: str, at: str) -> None:
    formula = Formula.read(f"{name}({at}) - 2^-3/pi", ())
    with mpmath.workdps(60), precision(200):
        function = {"abs": abs, "log": mpmath.log}.get(name) or getattr(mpmath, name)
        expected = function(mpmath.mpf(at)) - 1 / (8 * mpmath.pi)
        assert abs(formula.value({}, BALLS) - arb(mpmath.nstr(expected, 55))) < 1e-50
    assert formula.value({}, DOUBLES) == pytest.approx(float(expected), rel=1e-14)


def test_a_formula_that_was_read_is_refused_where_its_names_are_not_known() -> None:
    assert Formula.read("2*a", ["a"]).names == {"a"}
    with pytest.raises(UnknownName):
        Formula.read("2*a", ["b"])
    assert Formula.read("2*a", ["a"], ("sin",)) == Formula.read("2*a", ["a"])

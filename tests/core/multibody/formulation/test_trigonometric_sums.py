"""Sums against the functions that they stand for, by numbers."""

from __future__ import annotations

from collections.abc import Mapping

import mpmath
import pytest
from flint import arb

from core.multibody.algebra.polynomials import ONE
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Variable, added

VALUES = {"x": 0.7, "y": -1.3, "z": 0.6, "a": 0.4, "b": 2.1, TIME: 0.25}
RATES = {"x": 0.3, "y": 1.1, "z": 0.2, "a": -0.6, "b": 0.9, TIME: 1.0}


def value(total: Sum, values: Mapping[str, float] = VALUES) -> float:
    """Return the value of a sum by its terms."""
    found = mpmath.mpf(0)
    for term, factor in total.terms.items():
        part = mpmath.mpf(float(factor))
        for variable, power in term.factors:
            part *= (values, RATES)[variable.order][variable.name] ** power
        angle = mpmath.fsum(x * values[name] for name, x in term.wave)
        found += part * {"": mpmath.mpf(1), "cos": mpmath.cos(angle), "sin": mpmath.sin(angle)}[term.function]
    return float(found)


X, Y = Sum.variable("x"), Sum.variable("y")
CA, SA, CB, SB = Sum.cosine("a"), Sum.sine("a"), Sum.cosine("b"), Sum.sine("b")


@pytest.mark.parametrize("first", [CA, SA, CB * SA, X * CA])
@pytest.mark.parametrize("second", [CA, SA, CB, SB, Y + SB])
def test_products_have_the_product_of_the_values(first: Sum, second: Sum) -> None:
    assert value(first * second) == pytest.approx(value(first) * value(second), rel=1e-14)
    assert first * second == second * first


def test_squares_of_sine_and_cosine_are_one() -> None:
    assert (CA * CA + SA * SA).constant() == 1
    assert not CA * SA - SA * CA


def test_rates_are_the_derivatives_by_time() -> None:
    total = X * X * SA + Y * CA * SB + Sum.variable("x", power=-1) + Sum.variable(TIME) * CB
    step = 1e-6
    before = dict(VALUES)
    ends = []
    for sign in (1, -1):
        VALUES.update({name: before[name] + sign * step * RATES[name] for name in before})
        ends.append(value(total))
    VALUES.update(before)
    assert value(total.rate()) == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-8)


def test_a_variable_inside_of_sines_is_replaced_by_what_is_affine() -> None:
    moved = added([X.times(arb(2)), Y.times(-ONE), Sum.number(arb("0.3"))])
    angle = 2 * VALUES["x"] - VALUES["y"] + 0.3
    for total, function in ((SA, mpmath.sin), (CA, mpmath.cos)):
        assert value(total.replaced("a", moved)) == pytest.approx(float(function(angle)), rel=1e-14)
    assert value((X * X + SA).replaced("x", Y)) == pytest.approx(VALUES["y"] ** 2 + value(SA), rel=1e-14)


INVERSE, CUBED = Sum.variable("x", power=-1), Sum.variable("x", power=-3)


@pytest.mark.parametrize("total", [INVERSE, CUBED * Y + X * X, CUBED * SA + INVERSE, INVERSE * Y * Y])
@pytest.mark.parametrize("new", [Y, Y * Y, (Y * Sum.variable("z", power=-2)).times(arb("-1.5")), Sum.number(arb(4))])
def test_a_divisor_is_replaced_by_a_product_of_powers(total: Sum, new: Sum) -> None:
    inside = {**VALUES, "x": value(new)}
    assert total.admits("x", new)
    assert value(total.replaced("x", new)) == pytest.approx(value(total, inside), rel=1e-14)


@pytest.mark.parametrize("new", [Y + Sum.number(ONE), SA, Y * CB, Sum()])
def test_a_divisor_admits_nothing_else(new: Sum) -> None:
    assert new.inverse() is None
    assert not INVERSE.admits("x", new)
    assert X.admits("x", new)
    with pytest.raises(AssertionError, match="divisor"):
        INVERSE.replaced("x", new)


def test_what_turns_admits_affine_sums_alone() -> None:
    assert SA.admits("a", X + Sum.number(ONE))
    assert not SA.admits("a", X * X)
    assert SA.admits("b", X * X)


def test_inverses() -> None:
    product = (X * X * INVERSE * Y).times(arb(-4))
    inverse = product.inverse()
    assert inverse is not None
    assert (product * inverse).constant() == 1


def test_values_are_those_of_the_terms() -> None:
    total = X * X * SA + INVERSE * CB * Sum.variable("y", 1) + Sum.variable(TIME) * CA + Sum.variable("x", 2)
    places, rates = ({name: arb(x) for name, x in known.items()} for known in (VALUES, RATES))
    assert float(total.value(places, rates, {"x": arb(7)})) == pytest.approx(value(total - Sum.variable("x", 2)) + 7)
    at_rest = total - INVERSE * CB * Sum.variable("y", 1) - Sum.variable("x", 2)
    assert float(total.value(places)) == pytest.approx(value(at_rest), rel=1e-14)


@pytest.mark.parametrize("total", [X, SA, Sum.variable("x", 1), INVERSE * CB])
def test_what_has_no_value_has_none_in_a_sum(total: Sum) -> None:
    with pytest.raises(KeyError):
        total.value({"c": ONE}, {"c": ONE})


def test_partial_derivatives() -> None:
    total = X * X * SA
    assert total.derivative(Variable("x")) == X * SA + X * SA
    assert total.derivative(Variable("a")) == X * X * CA
    assert not total.derivative(Variable("y"))

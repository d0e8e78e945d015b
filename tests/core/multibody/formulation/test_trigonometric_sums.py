"""Sums against the functions that they stand for, by numbers."""

from __future__ import annotations

import mpmath
import pytest
from flint import arb

from core.multibody.algebra.polynomials import ONE
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Variable, added

VALUES = {"x": 0.7, "y": -1.3, "a": 0.4, "b": 2.1, TIME: 0.25}
RATES = {"x": 0.3, "y": 1.1, "a": -0.6, "b": 0.9, TIME: 1.0}


def value(total: Sum) -> float:
    """Return the value of a sum by its terms."""
    found = mpmath.mpf(0)
    for term, factor in total.terms.items():
        part = mpmath.mpf(float(factor))
        for variable, power in term.factors:
            part *= (VALUES, RATES)[variable.order][variable.name] ** power
        angle = mpmath.fsum(x * VALUES[name] for name, x in term.wave)
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


def test_partial_derivatives() -> None:
    total = X * X * SA
    assert total.derivative(Variable("x")) == X * SA + X * SA
    assert total.derivative(Variable("a")) == X * X * CA
    assert not total.derivative(Variable("y"))

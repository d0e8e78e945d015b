"""Wrong formulas are found out, also such as have the right values at the start."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flint import arb

from core.balls import precision
from core.errors import SelfCheckFailed
from core.multibody.algebra.polynomials import BITS, ONE
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.self_check import check_chart, check_formula
from core.multibody.formulation.trigonometric_sums import Sum
from core.multibody.table.table import Row, Table
from tests.core.multibody.formulation.test_scene_equations import answer_of, scene_of
from tests.core.multibody.relations.sources import catalogue
from tests.core.multibody.relations.writing import in_units

X, ANGLE = Sum.variable("x"), Sum.cosine("a")
PLACES, RATES = {"x": arb(2), "a": arb(1000)}, {"x": arb(-3)}


@pytest.mark.parametrize("share", [0.0, 1e-15, -1e-15])
def test_formulas_are_known_to_their_digits(share: float) -> None:
    product = X * X * Sum.variable("x", 1)
    check_formula("place", "p.x", product, arb(-12) * (1 + arb(share)), PLACES, RATES)
    check_formula("place", "p.x", ANGLE, (1000 * (1 + arb(share))).cos(), PLACES, RATES)


@pytest.mark.parametrize(("formula", "value"), [(X, 2 + 1e-12), (X.times(arb("0.5")), 2.0), (Sum(), 1e-30)])
def test_other_values_are_withheld(formula: Sum, value: float) -> None:
    with pytest.raises(SelfCheckFailed, match=r'place of "p\.x"'):
        check_formula("place", "p.x", formula, arb(value), PLACES, RATES)


def table() -> Table:
    """Return coordinates x, y, z at 1 that rest: x y = 1 and x = z^2."""
    found = Table()
    for name in "xyz":
        found.coordinate(name, "m", ONE)
    found.rows += [Row.held("inverse", {(0, 1): ONE, (): -ONE}), Row.held("square", {(0,): ONE, (2, 2): -ONE})]
    return found


@pytest.mark.parametrize("turned_round", [False, True])
def test_charts_satisfy_the_rows_that_they_solve(turned_round: bool) -> None:
    with precision(BITS):
        own = table()
        check_chart(Chart.of(replace(own, rows=own.rows[::-1] if turned_round else own.rows), ["x", "y", "z"]))


def test_a_chart_that_is_right_at_the_start_alone_is_withheld() -> None:
    """At rest at x = y = z = 1 the formula y = 1 has the value and the rate of y = 1/z^2."""
    with precision(BITS):
        chart = Chart.of(table(), ["x", "y", "z"])
        chart.places[1] = Sum.number(ONE)
        with pytest.raises(SelfCheckFailed, match="inverse"):
            check_chart(chart)


@pytest.mark.parametrize("name", ["crank-slider", "kapitza-pendulum"])
def test_factors_of_fifteen_digits_inside_of_sines_are_allowed_for(name: str) -> None:
    """In units of three the rates of the cranks have no end of digits."""
    made = in_units(catalogue()[name], 3, 3, 3)
    assert made is not None
    assert answer_of(scene_of(made.request)).equations is not None


def test_a_wrong_formula_is_never_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(
        {
            "gravity": [0, -10],
            "bodies": {"p": {"mass": 1, "at": [0.6, -0.8]}},
            "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}],
        }
    )
    assert answer_of(scene).equations is not None
    turned = Sum.sine
    monkeypatch.setattr(Sum, "sine", lambda name: turned(name).times(arb(2)))
    with pytest.raises(SelfCheckFailed):
        answer_of(scene)

"""Formulas of a scene held against its numbers before they are answered.

What a chart has solved a row to satisfy, it satisfies everywhere: beside the start, too, where a wrong formula with the
right value is found out.
"""

from __future__ import annotations

from collections.abc import Mapping

from flint import arb

from core.errors import SelfCheckFailed
from core.multibody.algebra.polynomials import ONE, Ball, evaluated, is_zero
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.trigonometric_sums import Sum

ROUNDING = arb(1, 2.0**-46)
"""What numbers of formulas are known to: those in sines have fifteen digits, of a few operations each."""

ASIDE = 3
"""Coordinates and rates are moved by a third, a fourth, ... (SI units): to a place that is no particular one."""


def check_formula(
    law: str, of: str, formula: Sum, value: Ball, places: Mapping[str, Ball], rates: Mapping[str, Ball]
) -> None:
    """Check that a formula has a value at a state.

    Parameters
    ----------
    law, of : str
        What is checked, and of what.
    formula : Sum
    value : ball
    places, rates : mapping of str to ball
        Of the variables.

    Raises
    ------
    SelfCheckFailed
        If they differ by more than the digits of formulas.
    """
    _require(law, of, _enclosed(formula, places, rates) - value)


def check_chart(chart: Chart) -> None:
    """Check that the places of a chart satisfy every row that it has solved, beside the start, too.

    Raises
    ------
    SelfCheckFailed
        If they do not.
    """
    state = chart.start, chart.rates
    beside = [{name: x + ONE / (ASIDE + k) for k, (name, x) in enumerate(one.items())} for one in state]
    q = [_enclosed(place, *beside) for place in chart.places]
    v = [_enclosed(place.rate(), *beside) for place in chart.places]
    for row in chart.table.rows:
        if any(row is left for left in chart.rows):
            continue
        # By numbers: in a sum of formulas what nearly cancels has lost the size of its terms.
        rates = sum((evaluated(poly, q) * v[j] for j, poly in row.rates.items()), -row.rate)
        _require("constraint", row.name, rates if row.measure is None else evaluated(row.measure, q))


def _enclosed(formula: Sum, places: Mapping[str, Ball], rates: Mapping[str, Ball]) -> Ball:
    """Return the value of a formula of which every number is known to its digits."""
    known = {name: x * ROUNDING for name, x in places.items()}
    return Sum({term: x * ROUNDING for term, x in formula.terms.items()}).value(known, rates)


def _require(law: str, of: str, off: Ball) -> None:
    if not is_zero(off):
        raise SelfCheckFailed(f"the formula of the {law}", of, 0.0, float(abs(off.mid())), float(off.rad()))

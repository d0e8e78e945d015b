"""Coordinates as functions of the time, of motions that are elementary ones, and of pendulums."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.formulas import Node
from core.multibody.algebra.polynomials import is_zero
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.elliptic_forms import elliptic_form
from core.multibody.formulation.formula_nodes import Terms, call, node_of_terms
from core.multibody.formulation.sides import constant_accelerations
from core.multibody.formulation.trigonometric_sums import TIME, Sum
from core.multibody.motion.motion import ElementaryTerm, Motion

_TIME = Node("name", TIME)


def closed_forms(chart: Chart, motion: Motion, equations: Mapping[str, Sum]) -> dict[str, Node]:
    """Return the variables of a chart as formulas of the time, where these are elementary, or a pendulum's.

    Parameters
    ----------
    chart : Chart
    motion : Motion
        Of its table.
    equations : mapping of str to Sum
        What is zero, by the variable whose equation it is.
    """
    constant = constant_accelerations(equations)
    if constant is not None:
        return {
            name: _formula(
                [ElementaryTerm(chart.start[name]), ElementaryTerm(chart.rates[name], 1), ElementaryTerm(gain / 2, 2)]
            )
            for name, gain in constant.items()
        }
    terms = motion.elementary()
    if terms is None:
        found = {
            name: elliptic_form(name, one, chart.start[name], chart.rates[name]) for name, one in equations.items()
        }
        return {name: node for name, node in found.items() if node is not None}
    return {name: _formula(own) for name, own in zip(chart.symbols, terms, strict=True) if name in chart.variables}


def _formula(terms: Sequence[ElementaryTerm]) -> Node:
    # The sine of a term that does not swing is nothing.
    shown: Terms = [
        (term.value, _factors(term))
        for term in terms
        if not (is_zero(term.value) or (term.sine and is_zero(term.frequency)))
    ]
    return node_of_terms(shown)


def _factors(term: ElementaryTerm) -> list[Node]:
    found = []
    if term.power:
        found.append(_TIME if term.power == 1 else Node("^", inner=(_TIME, Node("number", str(term.power)))))
    if not is_zero(term.growth):
        found.append(call("exp", node_of_terms([(term.growth, [_TIME])])))
    if not is_zero(term.frequency):
        found.append(call("sin" if term.sine else "cos", node_of_terms([(term.frequency, [_TIME])])))
    return found

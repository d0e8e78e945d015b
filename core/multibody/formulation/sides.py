"""Equations of motion as two sides: accelerations on the left, as far as they can be alone there."""

from __future__ import annotations

from collections.abc import Mapping

from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, Ball
from core.multibody.algebra.rank import Elimination
from core.multibody.formulation.formula_nodes import Terms, node_of_sum, node_of_terms, variable_node
from core.multibody.formulation.trigonometric_sums import Sum, Variable, added

Sides = tuple[Node, Node]
"""The two sides of an equation."""


def equation_sides(equations: Mapping[str, Sum], order: int = 2) -> list[Sides]:
    """Return equations as they are written.

    Parameters
    ----------
    equations : mapping of str to Sum
        What is zero, by the variable whose equation it is.
    order : int
        Of the derivatives that are on the left.
    """
    constant = constant_accelerations(equations) if order == 2 else None
    if constant is not None:
        return [(variable_node(Variable(name, 2)), node_of_sum(Sum.number(value))) for name, value in constant.items()]
    return [_sides(name, one, order) for name, one in equations.items()]


def constant_accelerations(equations: Mapping[str, Sum]) -> dict[str, Ball] | None:
    """Return the accelerations that equations with constant coefficients alone have, None of others."""
    elimination, names = Elimination(), list(equations)
    for one in equations.values():
        known = one.affine(order=2)
        if known is None:
            return None
        factors, constant = known
        elimination.add({names.index(name): x for name, x in factors.items()}, -constant)
    if set(elimination.pivots) != set(range(len(names))):
        return None
    return dict(zip(names, elimination.solution(range(len(names))), strict=True))


def _sides(name: str, equation: Sum, order: int) -> Sides:
    leading = _leading(equation, name, order)
    if len(leading) == 1:
        # What multiplies the only acceleration divides the rest, if it is a power.
        inverse = leading[0][1].inverse()
        if inverse is not None:
            equation = equation * inverse
            leading = _leading(equation, name, order)
    rest = equation - added(factor * Sum.variable(*variable) for variable, factor in leading)
    terms: Terms = []
    for variable, factor in leading:
        value = next(iter(factor.terms.values())) if len(factor.terms) == 1 else ONE
        shape = factor.times(1 / value)
        shown = [] if shape.constant() is not None else [node_of_sum(shape)]
        terms.append((value, [*shown, variable_node(variable)]))
    return node_of_terms(terms), node_of_sum(rest.times(-ONE))


def _leading(equation: Sum, name: str, order: int) -> list[tuple[Variable, Sum]]:
    """Return the derivatives of an order with what multiplies them, those of the equation's own variable first."""
    every = {variable for term in equation.terms for variable, _ in term.factors if variable.order == order}
    found = sorted(every, key=lambda one: (one.name != name, one.name))
    return [(variable, equation.derivative(variable)) for variable in found]

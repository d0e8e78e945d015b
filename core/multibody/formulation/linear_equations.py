"""The matrices of equations that are linear in coordinates, rates and accelerations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.multibody.algebra.doubles import in_doubles
from core.multibody.algebra.polynomials import ZERO, Ball
from core.multibody.equations_answer import LinearEquations
from core.multibody.formulation.trigonometric_sums import Sum, Term, Variable


def linear_equations(names: Sequence[str], equations: Sequence[Sum]) -> Iterator[LinearEquations]:
    """Yield the matrices of some equations of zero, if they are linear with constant coefficients."""
    size = len(names)
    matrices = [[[ZERO] * size for _ in range(size)] for _ in range(3)]
    load = [ZERO] * size
    for i, equation in enumerate(equations):
        for term, value in equation.terms.items():
            if term == Term():
                load[i] = -value
                continue
            variable = _alone(term)
            if variable is None or variable.name not in names:
                return
            matrices[variable.order][i][names.index(variable.name)] = value
    stiffness, damping, mass = (_doubles(matrix) for matrix in matrices)
    yield LinearEquations(tuple(names), mass, damping, stiffness, tuple(map(in_doubles, load)))


def _alone(term: Term) -> Variable | None:
    """Return the variable that a term is, None of another term."""
    if term.function or len(term.factors) != 1 or term.factors[0][1] != 1:
        return None
    return term.factors[0][0]


def _doubles(matrix: Sequence[Sequence[Ball]]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(map(in_doubles, row)) for row in matrix)

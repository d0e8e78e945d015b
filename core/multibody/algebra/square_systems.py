"""Square systems of linear equations in balls, which may be recorded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb_mat

from core.multibody.algebra.polynomials import Ball, recorded_among

Lines = Sequence[Sequence[Ball]]


def solved(matrix: Lines, right: Sequence[Ball]) -> Sequence[Ball]:
    """Return the solution of a system.

    Raises
    ------
    ZeroDivisionError
        Where it is not known to have one.
    """
    recorded = recorded_among(x for line in (*matrix, right) for x in line)
    if recorded is not None:
        of_all: Sequence[Ball] = recorded.applied(solved, matrix, right)
        return of_all
    found: Sequence[Ball] = arb_mat(matrix).solve(arb_mat([[x] for x in right])).entries()
    return found


def inverse(matrix: Lines) -> Any:
    """Return the inverse of a matrix, for `times_inverse`; it raises as `solved` does."""
    recorded = recorded_among(x for line in matrix for x in line)
    return arb_mat(matrix).inv() if recorded is None else recorded.applied(inverse, matrix)


def times_inverse(matrix: Any, right: Sequence[Ball]) -> Sequence[Ball]:
    """Return the product of an inverse with a vector."""
    recorded = recorded_among(right if type(matrix) is arb_mat else [matrix])
    if recorded is not None:
        of_all: Sequence[Ball] = recorded.applied(times_inverse, matrix, right)
        return of_all
    found: Sequence[Ball] = (matrix * arb_mat([[x] for x in right])).entries()
    return found

"""Square systems of linear equations in balls, which may be recorded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb_mat

from core.multibody.algebra.polynomials import Ball
from core.multibody.algebra.recordable import recordable

Lines = Sequence[Sequence[Ball]]


@recordable
def solved(matrix: Lines, right: Sequence[Ball]) -> Sequence[Ball]:
    """Return the solution of a system.

    Raises
    ------
    ZeroDivisionError
        Where it is not known to have one.
    """
    found: Sequence[Ball] = arb_mat(matrix).solve(arb_mat([[x] for x in right])).entries()
    return found


@recordable
def inverse(matrix: Lines) -> Any:
    """Return the inverse of a matrix, for `times_inverse`; it raises as `solved` does."""
    return arb_mat(matrix).inv()


@recordable
def times_inverse(matrix: Any, right: Sequence[Ball]) -> Sequence[Ball]:
    """Return the product of an inverse with a vector."""
    found: Sequence[Ball] = (matrix * arb_mat([[x] for x in right])).entries()
    return found

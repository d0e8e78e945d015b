"""Roots of polynomials that are products of known factors, by their companion matrices."""

from __future__ import annotations

import pytest
from flint import acb_mat, arb, arb_poly

from core.balls import precision
from core.multibody.algebra.characteristic_roots import roots_but_zero
from core.multibody.algebra.polynomials import BITS


def companion(roots: list[str]) -> acb_mat:
    """Return a matrix with these real characteristic roots."""
    polynomial = arb_poly([1])
    for root in roots:
        polynomial *= arb_poly([-arb(root), 1])
    size, coefficients = len(roots), polynomial.coeffs()
    return acb_mat([[-coefficients[i] if j == size - 1 else arb(i == j + 1) for j in range(size)] for i in range(size)])


@pytest.mark.parametrize(
    "roots", [["2"], ["0.1", "0.1"], ["0.1"] * 4 + ["-3"], ["0.1", "0.1", "-3", "-3", "7"], ["1e-9", "1e-9", "1e9"]]
)
def test_roots_come_as_often_as_they_occur(roots: list[str]) -> None:
    with precision(BITS):
        found = sorted((root.real for root in roots_but_zero(companion(roots))), key=float)
        expected = sorted((arb(root) for root in roots), key=float)
        assert len(found) == len(expected)
        assert all(a.overlaps(b) and a.rad() < 1e-25 * abs(b) for a, b in zip(found, expected, strict=True))


def test_zero_is_left_out() -> None:
    with precision(BITS):
        (root,) = roots_but_zero(companion(["0", "0", "0.3"]))
        assert root.real.overlaps(arb("0.3"))

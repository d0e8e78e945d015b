"""Roots of a characteristic polynomial that may coincide, in balls."""

from __future__ import annotations

from typing import Any

from flint import acb, acb_poly

from core.multibody.algebra.polynomials import is_zero


def roots_but_zero(matrix: Any) -> list[Any]:
    """Return the characteristic roots, each as often as it occurs, without zero, which is that of what moves freely.

    Roots that coincide are those of the greatest common divisor of the polynomial and its derivative. As everywhere in
    the set-up, coefficients that contain zero are zero.

    Raises
    ------
    ValueError
        Where different roots are too close to be told apart.
    """
    coefficients = matrix.charpoly().coeffs()
    while coefficients and _is_nothing(coefficients[0]):
        del coefficients[0]
    found: list[Any] = []
    rest = acb_poly(coefficients)
    while rest.degree() > 0:
        common = _common_divisor(rest, rest.derivative())
        simple = rest if common.degree() == 0 else divmod(rest, common)[0]
        size = min((float(abs(root)) for root in simple.roots()), default=1.0)
        found.extend(simple.roots(tol=size * 2.0**-100))
        rest = common
    return found


def _common_divisor(first: Any, second: Any) -> Any:
    """Return the greatest common divisor of two polynomials by Euclid's algorithm."""
    while second.degree() >= 0:
        remainder = (first % second).coeffs()
        while remainder and _is_nothing(remainder[-1]):
            del remainder[-1]
        lead = remainder[-1] if remainder else acb(1)
        first, second = second, acb_poly([x / lead for x in remainder])
    return first


def _is_nothing(number: Any) -> bool:
    return is_zero(number.real) and is_zero(number.imag)

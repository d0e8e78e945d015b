"""Arithmetic of Taylor polynomials in pairs of doubles, with the sizes of what they consist of.

A polynomial is one of time as a share of the length of a piece, so that its coefficients fall; the sizes are those of
the terms that were added, which say how much of a coefficient is rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_mul, dd_mul_d
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair


@dataclass(frozen=True)
class Curve:
    """A quantity on consecutive pieces.

    Attributes
    ----------
    values : ndarray, shape (p, order + 1, 2)
        Coefficients as pairs.
    sizes : ndarray, shape (p, order + 1)
    """

    values: Floats
    sizes: Floats

    @classmethod
    def constant(cls, number: Ball, like: tuple[int, int]) -> Curve:
        """Return a constant on so many pieces, of so many coefficients."""
        values, sizes = np.zeros((*like, 2)), np.zeros(like)
        values[:, 0] = pair(number, 0)
        sizes[:, 0] = np.abs(values[:, 0, 0])
        return cls(values, sizes)

    def plus(self, factor: Ball, other: Curve) -> Curve:
        """Return the sum with a multiple of another one."""
        high, low = pair(factor, 0)
        values = self.values.copy()
        _add_multiple(values, high, low, other.values)
        return Curve(values, self.sizes + abs(high) * other.sizes)

    def times(self, other: Curve) -> Curve:
        """Return the product, up to the same order."""
        values, sizes = np.empty_like(self.values), np.empty_like(self.sizes)
        _multiply(self.values, other.values, values)
        _multiply_sizes(self.sizes, other.sizes, sizes)
        return Curve(values, sizes)

    def derivative(self, lengths: Floats) -> Curve:
        """Return the derivative with respect to time, of one power less, on pieces of lengths of shape (p,) (s)."""
        count = self.sizes.shape[1] - 1
        values = np.empty((len(lengths), count, 2))
        differentiate(self.values, lengths, values)
        sizes = np.arange(1.0, count + 1.0) * self.sizes[:, 1:] / np.abs(lengths)[:, None]
        return Curve(values, sizes)


@kernel()
def _multiply(first: Floats, second: Floats, found: Floats) -> None:
    """Fill in products of polynomials up to their order, pairs of shape (p, order + 1, 2)."""
    for p in range(first.shape[0]):
        for k in range(first.shape[1]):
            sh, sl = 0.0, 0.0
            for i in range(k + 1):
                ph, pl = dd_mul(first[p, i, 0], first[p, i, 1], second[p, k - i, 0], second[p, k - i, 1])
                sh, sl = dd_add(sh, sl, ph, pl)
            found[p, k, 0], found[p, k, 1] = sh, sl


@kernel()
def _multiply_sizes(first: Floats, second: Floats, found: Floats) -> None:
    """Fill in the products of the sizes of coefficients, shape (p, order + 1)."""
    for p in range(first.shape[0]):
        for k in range(first.shape[1]):
            total = 0.0
            for i in range(k + 1):
                total += first[p, i] * second[p, k - i]
            found[p, k] = total


@kernel()
def _add_multiple(total: Floats, factor_high: float, factor_low: float, more: Floats) -> None:
    """Add a multiple of polynomials, pairs of shape (p, order + 1, 2), to others."""
    for p in range(total.shape[0]):
        for k in range(total.shape[1]):
            if more[p, k, 0] != 0.0:
                ph, pl = dd_mul(factor_high, factor_low, more[p, k, 0], more[p, k, 1])
                total[p, k, 0], total[p, k, 1] = dd_add(total[p, k, 0], total[p, k, 1], ph, pl)


@kernel()
def differentiate(places: Floats, lengths: Floats, found: Floats) -> None:
    """Fill in the derivatives of polynomials of shape (p, order + 2, 2); times are shares of lengths of shape (p,)."""
    for p in range(places.shape[0]):
        for k in range(found.shape[1]):
            sh, sl = dd_mul_d(places[p, k + 1, 0], places[p, k + 1, 1], k + 1.0)
            found[p, k, 0], found[p, k, 1] = sh / lengths[p], sl / lengths[p]

"""Large systems of linear equations in balls, from an inverse in doubles.

Elimination of n unknowns in balls takes n^3/3 products of many digits. With an inverse Y in doubles every step of
x <- x + Y (b - A x) gains the digits that Y has right, for n^2 products. If q bounds the sums of the rows of |1 - Y A|
and is less than one, A is regular, and with the last residual r the solution differs from x by at most

    |Y| |r| + q/(1 - q) max(|Y| |r|)

in units in which the rows and columns of A are of the order of one (S. M. Rump, "Verification methods: rigorous
results using floating-point arithmetic", Acta Numerica 19 (2010), 10.2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from flint import arb, arb_mat

from core.arrays import Floats
from core.multibody.algebra.polynomials import ZERO, Ball, entry

LARGE = 128
"""Unknowns from which on this is faster than elimination."""

_UNIT = 2.0**-53
_REGULAR = 2.0**-6
"""Largest q with which it is used: every step then gains six bits at least."""
_STEPS = 60
"""Steps of six bits that are more than the precision of balls has."""
_RANGE = 1e-140, 1e140
"""Sizes of numbers whose products with others of this kind doubles hold."""
_SCALINGS = 4
"""Each halves the logarithms of the sizes of rows and columns (D. Ruiz, 2001)."""


def solved_from_doubles(entries: Mapping[tuple[int, int], Ball], right: Sequence[Ball]) -> list[Ball] | None:
    """Return the solution of A x = b, None where an inverse in doubles does not do.

    Parameters
    ----------
    entries : mapping
        The entries of A that are not zero, by row and column.
    right : sequence of balls
        b.
    """
    size = len(right)
    middles, widths = _doubles([x.mid() for x in entries.values()]), _doubles([x.rad() for x in entries.values()])
    if middles is None or widths is None:
        return None
    matrix, wide = np.zeros((size, size)), np.zeros((size, size))
    for at, middle, width in zip(entries, middles, widths, strict=True):
        matrix[at], wide[at] = middle, width
    rows, columns = _scales(matrix)
    if rows is None or columns is None:
        return None
    scales = rows[:, None] * columns
    try:
        inverse = np.linalg.inv(matrix * scales).astype(np.float64)
    except np.linalg.LinAlgError:
        return None
    rest = _rest(matrix * scales, wide * scales, inverse)
    if not rest < _REGULAR:
        return None
    exact = arb_mat([[entry(entries, (i, j)) for j in range(size)] for i in range(size)])
    given, found = arb_mat([[x] for x in right]), arb_mat([[ZERO] for _ in right])
    residual, least = given, np.inf
    for _ in range(_STEPS):
        left = _doubles([x.mid() for x in residual.entries()])
        largest = np.inf if left is None else float(np.max(np.abs(left * rows), initial=0.0))
        if left is None or not largest < least / 2:
            break
        least = largest
        found = (found + arb_mat([[arb(x)] for x in columns * (inverse @ (rows * left))])).mid()
        residual = given - exact * found
    sizes = _doubles([x.abs_upper() for x in residual.entries()])
    if sizes is None:
        return None
    # The margin is for the rounding of these sums, and of the sizes.
    off = (np.abs(inverse) @ (rows * sizes)) * (1.0 + 8.0 * (size + 4) * _UNIT)
    off += 2.0 * rest * np.max(off, initial=0.0)
    return [x + arb(0, float(radius)) for x, radius in zip(found.entries(), columns * off, strict=True)]


def _doubles(numbers: Sequence[Ball]) -> Floats | None:
    """Return exact numbers as doubles, None where one that is not zero is out of range."""
    found = np.array([float(x) for x in numbers])
    sizes = np.abs(found)
    inside = (sizes > _RANGE[0]) & (sizes < _RANGE[1])
    return found if all(inside[k] or numbers[k] == 0 for k in range(len(numbers))) else None


def _scales(matrix: Floats) -> tuple[Floats | None, Floats | None]:
    """Return powers of two by which rows and columns are multiplied to be of the order of one, None of a zero one.

    Coordinates and multipliers have units of their own; without scales q would depend on them.
    """
    rows, columns = np.ones(len(matrix)), np.ones(len(matrix))
    for _ in range(_SCALINGS):
        sizes = np.abs(matrix) * (rows[:, None] * columns)
        largest = np.max(sizes, axis=1), np.max(sizes, axis=0)
        if not (np.all(largest[0]) and np.all(largest[1])):
            return None, None
        rows *= np.exp2(-np.round(np.log2(largest[0]) / 2.0))
        columns *= np.exp2(-np.round(np.log2(largest[1]) / 2.0))
    return rows, columns


def _rest(matrix: Floats, wide: Floats, inverse: Floats) -> float:
    """Return a bound of the sums of the rows of |1 - Y A|, A being within `wide` and a rounding of its doubles."""
    sizes = np.abs(inverse) @ np.abs(matrix)
    found = np.abs(np.eye(len(matrix)) - inverse @ matrix) + (len(matrix) + 4) * 2.0 * _UNIT * (1.0 + sizes)
    found += 2.0 * (np.abs(inverse) @ (wide + 2.0 * _UNIT * np.abs(matrix)))
    return float(np.max(np.sum(found, axis=1))) * (1.0 + (len(matrix) + 4) * 2.0 * _UNIT)

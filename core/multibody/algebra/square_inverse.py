"""Inverses of square matrices in doubles and in pairs of doubles, eight entries at a time.

The inverse in doubles is by Gauss and Jordan's elimination. That in pairs starts from it: with R = 1 - Y A in pairs for
the inverse Y in doubles, the inverse is Y + R Y + R^2 Y + ..., and all but the first term are needed in doubles only.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import fma, kernel
from core.double_double import fast_two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered

SUMMED_BELOW = 2.0**-10
"""Largest sum of a row of R for which the series is summed; it then takes at most six terms."""


class Square(NamedTuple):
    """Space for the inverse of a matrix of n rows; s is n up to a multiple of the width of lanes.

    Attributes
    ----------
    columns : (planes, n, s)
        Column j of the inverse at [:, j], with zeros behind it; planes are (value, tail).
    rows, inverse, scale : (n, s), (n, s) and (n,)
        The matrix, and space of the elimination.
    matrix : (n, n, 2)
        The matrix in pairs; empty for an inverse in doubles.
    """

    columns: Floats
    rows: Floats
    inverse: Floats
    scale: Floats
    matrix: Floats


@kernel()
def padded(n: int) -> int:
    """Return the next multiple of the width of lanes."""
    return (n + WIDTH - 1) // WIDTH * WIDTH


@kernel()
def square_space(size: int, planes: int) -> Square:
    """Return space for an inverse in doubles (one plane) or in pairs (two)."""
    paired = size if planes == 2 else 0
    return Square(
        np.zeros((planes, size, padded(size))),
        np.zeros((size, padded(size))),
        np.zeros((size, padded(size))),
        np.zeros(size),
        np.zeros((paired, paired, 2)),
    )


@kernel()
def _eliminated(a: Floats, out: Floats, scale: Floats) -> bool:
    """Invert a matrix with padded rows by Gauss-Jordan elimination with scaled pivots; `a` is used up."""
    n, s = a.shape
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[i, j]))
            out[i, j] = 1.0 if i == j else 0.0
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            size = abs(a[i, k]) * scale[i]
            if size > best:
                pivot, best = i, size
        if not best > 1e-14:
            return False
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
                out[k, j], out[pivot, j] = out[pivot, j], out[k, j]
            scale[pivot] = scale[k]
        factor = alike(1.0 / a[k, k])
        for b in range(k * s, (k + 1) * s, WIDTH):
            put_lanes(a, b, lanes_at(a, b) * factor)
            put_lanes(out, b, lanes_at(out, b) * factor)
        for i in range(n):
            if i != k and a[i, k] != 0.0:
                factor = alike(-a[i, k])
                for b in range(0, s, WIDTH):
                    put_lanes(a, i * s + b, fma(factor, lanes_at(a, k * s + b), lanes_at(a, i * s + b)))
                    put_lanes(out, i * s + b, fma(factor, lanes_at(out, k * s + b), lanes_at(out, i * s + b)))
    return True


@kernel()
def invert(square: Square) -> bool:
    """Fill in the columns of the inverse of the rows, which are used up, in doubles; return whether there is one."""
    if not _eliminated(square.rows, square.inverse, square.scale):
        return False
    for i in range(square.rows.shape[0]):
        for j in range(square.rows.shape[0]):
            square.columns[0, j, i] = square.inverse[i, j]
    return True


@kernel()
def correct_inverse(square: Square) -> bool:
    """Bring the columns of an inverse in doubles to pairs; return whether R is as small a matrix as that needs."""
    a, columns, rest, whole = square.matrix, square.columns, square.rows, square.inverse
    size, s = rest.shape
    # Columns of R, which is of the order of the condition number times 2^-53, into `rest`.
    largest = 0.0
    for j in range(size):
        for b in range(0, s, WIDTH):
            sh, sl = alike(0.0), alike(0.0)
            if b <= j < b + WIDTH:
                for i in range(WIDTH):
                    rest[j, b + i] = 1.0 if b + i == j else 0.0
                sh = lanes_at(rest, j * s + b)
            for k in range(size):
                if a[k, j, 0] != 0.0:
                    column = lanes_at(columns[0], k * s + b)
                    sh, sl = gathered(sh, sl, column, alike(0.0), alike(-a[k, j, 0]), alike(-a[k, j, 1]))
            put_lanes(rest, j * s + b, sh + sl)
        for i in range(size):
            largest = max(largest, abs(rest[j, i]))
    largest *= size
    if not largest < SUMMED_BELOW:
        return False
    terms = 1 + int(53.0 / max(1.0, -math.log2(max(largest, 2.0**-60))))
    columns[1] = 0.0
    for _ in range(terms):
        # The sum Z of the terms after the first is R (Y + Z).
        for j in range(size):
            for k in range(size):
                whole[j, k] = columns[0, j, k] + columns[1, j, k]
        for j in range(size):
            for b in range(0, s, WIDTH):
                total = alike(0.0)
                for k in range(size):
                    if whole[j, k] != 0.0:
                        total = fma(lanes_at(rest, k * s + b), alike(whole[j, k]), total)
                put_lanes(columns[1], j * s + b, total)
    for b in range(0, size * s, WIDTH):
        high, low = fast_two_sum(lanes_at(columns[0], b), lanes_at(columns[1], b))
        put_lanes(columns[0], b, high)
        put_lanes(columns[1], b, low)
    return True

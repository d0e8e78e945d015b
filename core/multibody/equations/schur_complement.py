"""The inverse of a large saddle matrix [M -(W + X)^T; W 0] by blocks.

M is the same at every place, so that its inverse is formed once. With Y = M^-1 (W + X)^T, Z = M^-1 W^T and the Schur
complement S = W Y, whose inverse is that of a matrix of m rows only, the columns of the inverse are

    [Y; 1] S^-1  for the multipliers, and  [M^-1; 0] - [Y; 1] S^-1 Z^T  for the coordinates.

The lines of W have few entries, so that Y, Z and S cost little, and the rest m (n + m)^2 products in place of the
2 (n + m)^3 of an elimination.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import fma, kernel
from core.double_double import fast_two_sum
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.algebra.square_inverse import Square, correct_inverse, invert, padded, square_space
from core.multibody.equations.packed import Packed

LARGE = 32
"""Rows from which on a matrix is inverted by blocks: below, both ways take about as long."""


class Blocks(NamedTuple):
    """Space for the blocks; s is n + m, and t is n, up to a multiple of the width of lanes.

    Attributes
    ----------
    weights : (planes, n, t)
        The inverse of M, by its columns; of no columns where the matrix is small or M has no inverse.
    pushed : (planes, m, s)
        [Y; 1], by its columns.
    pulled : (planes, m, t)
        Z, by its columns.
    inner : Square
        S and its inverse.
    """

    weights: Floats
    pushed: Floats
    pulled: Floats
    inner: Square


@kernel()
def blocks_of(table: Packed, planes: int) -> Blocks:
    """Return the inverse of M, and space for the blocks that vary."""
    n, m = table.load.shape[0], table.rate.shape[0]
    if n + m < LARGE or m == 0:
        return _no_blocks(planes)
    square = square_space(n, 2)
    for i in range(n):
        for j in range(n):
            square.rows[i, j] = table.mass[i, j, 0]
            square.matrix[i, j, 0], square.matrix[i, j, 1] = table.mass[i, j, 0], table.mass[i, j, 1]
    # In pairs also for doubles: an error of what is the same at every step would add up.
    if not invert(square) or not correct_inverse(square):
        return _no_blocks(planes)
    pushed, pulled = np.zeros((planes, m, padded(n + m))), np.zeros((planes, m, padded(n)))
    return Blocks(square.columns[:planes].copy(), pushed, pulled, square_space(m, planes))


@kernel()
def _no_blocks(planes: int) -> Blocks:
    none = np.zeros((planes, 0, 0))
    return Blocks(none, none, none, square_space(0, planes))


@kernel()
def join_blocks(table: Packed, lines: Floats, blocks: Blocks, columns: Floats) -> bool:
    """Fill in the columns of the inverse in doubles; return whether S has one.

    Parameters
    ----------
    lines : (e,)
    columns : (n + m, s)
    """
    n, m, s, t = table.load.shape[0], table.rate.shape[0], columns.shape[1], blocks.weights.shape[2]
    weights, pushed, pulled, inner = blocks.weights[0], blocks.pushed[0], blocks.pulled[0], blocks.inner
    for b in range(0, m * s, WIDTH):
        put_lanes(pushed, b, alike(0.0))
    for b in range(0, m * t, WIDTH):
        put_lanes(pulled, b, alike(0.0))
    for e in range(lines.shape[0]):
        r, j, factor = table.lines_at[e, 0], table.lines_at[e, 1], alike(lines[e])
        for b in range(0, t, WIDTH):
            weight = lanes_at(weights, j * t + b)
            put_lanes(pushed, r * s + b, fma(factor, weight, lanes_at(pushed, r * s + b)))
            if table.binds[e] == 1:
                put_lanes(pulled, r * t + b, fma(factor, weight, lanes_at(pulled, r * t + b)))
    inner.rows[:] = 0.0
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        if table.binds[e] == 1:
            for c in range(m):
                inner.rows[r, c] += lines[e] * pushed[c, j]
    if not invert(inner):
        return False
    for c in range(m):
        pushed[c, n + c] = 1.0
    for b in range(0, s, WIDTH):
        for r in range(m):
            total = alike(0.0)
            for c in range(m):
                total = fma(alike(inner.columns[0, r, c]), lanes_at(pushed, c * s + b), total)
            put_lanes(columns, (n + r) * s + b, total)
        for j in range(n):
            total = lanes_at(weights, j * t + b) if b < t else alike(0.0)
            for r in range(m):
                total = fma(alike(-pulled[r, j]), lanes_at(columns, (n + r) * s + b), total)
            put_lanes(columns, j * s + b, total)
    return True


@kernel()
def join_blocks_in_pairs(table: Packed, lines: Floats, blocks: Blocks, columns: Floats) -> bool:
    """Do as `join_blocks` in pairs.

    Parameters
    ----------
    lines : (e, 2)
    columns : (2, n + m, s)
    """
    n, m, s, t = table.load.shape[0], table.rate.shape[0], columns.shape[2], blocks.weights.shape[2]
    weights, pushed, pulled, inner = blocks.weights, blocks.pushed, blocks.pulled, blocks.inner
    for plane in range(2):
        for b in range(0, m * s, WIDTH):
            put_lanes(pushed[plane], b, alike(0.0))
        for b in range(0, m * t, WIDTH):
            put_lanes(pulled[plane], b, alike(0.0))
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        for b in range(0, t, WIDTH):
            _add_multiple(pushed, r * s + b, lines[e, 0], lines[e, 1], weights, j * t + b)
            if table.binds[e] == 1:
                _add_multiple(pulled, r * t + b, lines[e, 0], lines[e, 1], weights, j * t + b)
    for b in range(0, m * s, WIDTH):
        _settle(pushed, b)
    for b in range(0, m * t, WIDTH):
        _settle(pulled, b)
    a = inner.matrix
    a[:] = 0.0
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        if table.binds[e] == 1:
            for c in range(m):
                a[r, c, 0], a[r, c, 1] = gathered(
                    a[r, c, 0], a[r, c, 1], lines[e, 0], lines[e, 1], pushed[0, c, j], pushed[1, c, j]
                )
    for r in range(m):
        for c in range(m):
            a[r, c, 0], a[r, c, 1] = settled(a[r, c, 0], a[r, c, 1])
            inner.rows[r, c] = a[r, c, 0]
    if not invert(inner) or not correct_inverse(inner):
        return False
    for c in range(m):
        pushed[0, c, n + c] = 1.0
    for b in range(0, s, WIDTH):
        for r in range(m):
            sh, sl = alike(0.0), alike(0.0)
            for c in range(m):
                fh, fl = alike(inner.columns[0, r, c]), alike(inner.columns[1, r, c])
                sh, sl = gathered(sh, sl, fh, fl, lanes_at(pushed[0], c * s + b), lanes_at(pushed[1], c * s + b))
            sh, sl = fast_two_sum(sh, sl)
            put_lanes(columns[0], (n + r) * s + b, sh)
            put_lanes(columns[1], (n + r) * s + b, sl)
        for j in range(n):
            sh, sl = alike(0.0), alike(0.0)
            if b < t:
                sh, sl = lanes_at(weights[0], j * t + b), lanes_at(weights[1], j * t + b)
            for r in range(m):
                fh, fl = alike(-pulled[0, r, j]), alike(-pulled[1, r, j])
                k = (n + r) * s + b
                sh, sl = gathered(sh, sl, fh, fl, lanes_at(columns[0], k), lanes_at(columns[1], k))
            sh, sl = fast_two_sum(sh, sl)
            put_lanes(columns[0], j * s + b, sh)
            put_lanes(columns[1], j * s + b, sl)
    return True


@kernel(forceinline=True)
def _add_multiple(into: Floats, at: int, high: float, low: float, vectors: Floats, b: int) -> None:
    """Add a multiple of eight entries of vectors in planes to others, whose tails are summed in doubles."""
    sh, sl = gathered(
        lanes_at(into[0], at),
        lanes_at(into[1], at),
        alike(high),
        alike(low),
        lanes_at(vectors[0], b),
        lanes_at(vectors[1], b),
    )
    put_lanes(into[0], at, sh)
    put_lanes(into[1], at, sl)


@kernel(forceinline=True)
def _settle(vectors: Floats, b: int) -> None:
    sh, sl = fast_two_sum(lanes_at(vectors[0], b), lanes_at(vectors[1], b))
    put_lanes(vectors[0], b, sh)
    put_lanes(vectors[1], b, sl)

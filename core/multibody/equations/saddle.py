"""The matrix [M -(W + X)^T; W 0] of a table at a place, and its inverse in doubles and in pairs of doubles.

Small ones are inverted as any matrix is, large ones by blocks, because M is the same at every place. Where the inverse
in doubles does not do for that in pairs, the elimination runs in pairs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add
from core.multibody.algebra.pair_arrays import invert_pairs
from core.multibody.algebra.square_inverse import Square, correct_inverse, invert, square_space
from core.multibody.equations.packed import Packed
from core.multibody.equations.schur_complement import Blocks, blocks_of, join_blocks, join_blocks_in_pairs

FAILED, DIRECT, CORRECTED = 0, 1, 2
"""How the inverse was found in pairs: not at all, by elimination in pairs, from one in doubles."""


class Saddle(NamedTuple):
    """Space for the inverse.

    Attributes
    ----------
    columns : (planes, n + m, s)
        Of the inverse, those of `square`.
    square : Square
    full : (n + m, n + m, 2)
        Of the elimination in pairs.
    blocks : Blocks
        Empty where the matrix is inverted as a whole.
    """

    columns: Floats
    square: Square
    full: Floats
    blocks: Blocks


@kernel()
def saddle_space(table: Packed, planes: int) -> Saddle:
    """Return space for the inverse in doubles (one plane) or in pairs (two)."""
    size = table.load.shape[0] + table.rate.shape[0]
    paired = size if planes == 2 else 0
    square = square_space(size, planes)
    return Saddle(square.columns, square, np.zeros((paired, paired, 2)), blocks_of(table, planes))


@kernel()
def inverted(table: Packed, lines: Floats, space: Saddle) -> bool:
    """Fill in the columns of the inverse in doubles; return whether there is one.

    Parameters
    ----------
    lines : (e,)
    """
    if space.blocks.weights.shape[1] > 0 and join_blocks(table, lines, space.blocks, space.columns[0]):
        return True
    return _inverted_as_a_whole(table, lines, space)


@kernel()
def _inverted_as_a_whole(table: Packed, lines: Floats, space: Saddle) -> bool:
    n, rows = table.load.shape[0], space.square.rows
    rows[:] = 0.0
    for i in range(n):
        for j in range(n):
            rows[i, j] = table.mass[i, j, 0]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        rows[j, n + r] -= lines[e]
        if table.binds[e] == 1:
            rows[n + r, j] = lines[e]
    return invert(space.square)


@kernel()
def inverted_pairs(table: Packed, lines: Floats, space: Saddle) -> int:
    """Fill in the columns of the inverse in pairs; return how it was found.

    Parameters
    ----------
    lines : (e, 2)
    """
    if space.blocks.weights.shape[1] > 0 and join_blocks_in_pairs(table, lines, space.blocks, space.columns):
        return CORRECTED
    n, a, columns = table.load.shape[0], space.square.matrix, space.columns
    size = a.shape[0]
    a[:] = 0.0
    for i in range(n):
        for j in range(n):
            a[i, j, 0], a[i, j, 1] = table.mass[i, j, 0], table.mass[i, j, 1]
    for e in range(lines.shape[0]):
        r, j = table.lines_at[e, 0], table.lines_at[e, 1]
        if table.binds[e] == 1:
            a[n + r, j, 0], a[n + r, j, 1] = lines[e, 0], lines[e, 1]
        a[j, n + r, 0], a[j, n + r, 1] = dd_add(a[j, n + r, 0], a[j, n + r, 1], -lines[e, 0], -lines[e, 1])
    if _inverted_as_a_whole(table, lines[:, 0], space) and correct_inverse(space.square):
        return CORRECTED
    if not invert_pairs(a, space.full):
        return FAILED
    for i in range(size):
        for j in range(size):
            columns[0, j, i], columns[1, j, i] = space.full[i, j, 0], space.full[i, j, 1]
    return DIRECT

"""Small linear systems by elimination; one that is nearly singular by the shortest of its least squares.

The shortest solution is found by a complete orthogonal decomposition: reflections with the columns in the order of
their sizes, then reflections of the rows that are left; see Golub and Van Loan, Matrix Computations, 4th ed., section
5.5.2.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import kernel

NEARLY_SINGULAR = 1e-9
"""A pivot below this share of the largest entry leaves a system to least squares."""

_CUT = 1e-13
"""Share of the largest column below which what remains of the others counts as zero."""


@kernel()
def solve(system: Floats, x: Floats) -> bool:
    """Put the solution in place of the right side `x`, in compiled code; return whether the system is nearly singular.

    Parameters
    ----------
    system : ndarray, shape (k, k)
    x : ndarray, shape (k,)
    """
    y = x.copy()
    regular = _eliminated(system.copy(), y)
    if not regular:
        y = x.copy()
        _shortest(system.copy(), y)
    for i in range(len(x)):
        x[i] = y[i]
    return not regular


@kernel()
def _eliminated(a: Floats, x: Floats) -> bool:
    """Solve in place, and return whether all pivots are large enough; `a` is used up."""
    n = len(a)
    least = 0.0
    for i in range(n):
        for j in range(n):
            least = max(least, NEARLY_SINGULAR * abs(a[i, j]))
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            if abs(a[i, k]) > best:
                pivot, best = i, abs(a[i, k])
        if not best > least:
            return False
        if pivot != k:
            for j in range(k, n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            x[k], x[pivot] = x[pivot], x[k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                factor = a[i, k] / a[k, k]
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
                x[i] -= factor * x[k]
    for i in range(n - 1, -1, -1):
        total = x[i]
        for j in range(i + 1, n):
            total -= a[i, j] * x[j]
        x[i] = total / a[i, i]
    return True


@kernel()
def _shortest(a: Floats, x: Floats) -> None:
    """Put the shortest least-squares solution in place of the right side; `a` is used up."""
    n = len(a)
    order, rank, largest = np.arange(n), n, 0.0
    mirror, heads, weights, y = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    for k in range(n):
        size, chosen = -1.0, k
        for j in range(k, n):
            total = 0.0
            for i in range(k, n):
                total += a[i, j] ** 2
            if math.sqrt(total) > size:
                size, chosen = math.sqrt(total), j
        largest = max(largest, size)
        if not size > _CUT * largest:
            rank = k
            break
        order[k], order[chosen] = order[chosen], order[k]
        for i in range(n):
            a[i, k], a[i, chosen] = a[i, chosen], a[i, k]
        # The reflection that takes the column to the k-th axis, applied to the other columns and to the right side.
        for i in range(k, n):
            mirror[i] = a[i, k]
        a[k, k] = -math.copysign(size, mirror[k])
        mirror[k] -= a[k, k]
        weight = 1.0 / (size * abs(mirror[k]))
        for j in range(k + 1, n):
            total = 0.0
            for i in range(k, n):
                total += mirror[i] * a[i, j]
            for i in range(k, n):
                a[i, j] -= weight * total * mirror[i]
        total = 0.0
        for i in range(k, n):
            total += mirror[i] * x[i]
        for i in range(k, n):
            x[i] -= weight * total * mirror[i]
    # Rows that reach beyond the square of the rank: reflections of the unknowns, from the last row on.
    for k in range(rank - 1, -1, -1):
        total = a[k, k] ** 2
        for j in range(rank, n):
            total += a[k, j] ** 2
        size = math.sqrt(total)
        diagonal = -math.copysign(size, a[k, k])
        heads[k] = a[k, k] - diagonal
        weights[k] = 1.0 / (size * abs(heads[k]))
        for i in range(k):
            total = heads[k] * a[i, k]
            for j in range(rank, n):
                total += a[k, j] * a[i, j]
            a[i, k] -= weights[k] * total * heads[k]
            for j in range(rank, n):
                a[i, j] -= weights[k] * total * a[k, j]
        a[k, k] = diagonal
    for i in range(rank - 1, -1, -1):
        total = x[i]
        for j in range(i + 1, rank):
            total -= a[i, j] * y[j]
        y[i] = total / a[i, i]
    for k in range(rank):
        total = heads[k] * y[k]
        for j in range(rank, n):
            total += a[k, j] * y[j]
        y[k] -= weights[k] * total * heads[k]
        for j in range(rank, n):
            y[j] -= weights[k] * total * a[k, j]
    for j in range(n):
        x[order[j]] = y[j]

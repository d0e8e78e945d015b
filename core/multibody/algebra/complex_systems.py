"""Linear equations with complex coefficients, for compiled code: factored once, and solved for several right sides."""

from __future__ import annotations

import numpy as np

from core.arrays import Complexes, Floats
from core.compiled import kernel


@kernel()
def factored(a: Complexes, pivots: Floats) -> bool:
    """Factor a matrix in place with scaled pivots; return whether it is regular."""
    n = a.shape[0]
    scale = np.empty(n)
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(a[i, j].real) + abs(a[i, j].imag))
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, best = k, -1.0
        for i in range(k, n):
            size = (abs(a[i, k].real) + abs(a[i, k].imag)) * scale[i]
            if size > best:
                pivot, best = i, size
        if not best > 0.0:
            return False
        pivots[k] = pivot
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            scale[pivot] = scale[k]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                factor = a[i, k] * inverse
                a[i, k] = factor
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
    return True


@kernel()
def solved(a: Complexes, pivots: Floats, x: Complexes) -> None:
    """Replace a right side by the solution of the factored system."""
    n = a.shape[0]
    for k in range(n):
        pivot = int(pivots[k])
        x[k], x[pivot] = x[pivot], x[k]
    for k in range(n):
        for j in range(k):
            x[k] -= a[k, j] * x[j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= a[k, j] * x[j]
        x[k] /= a[k, k]

"""Many small linear systems at once, by elimination: what singular values decide is left to those that are singular."""

from __future__ import annotations

import numpy as np

from core.compiled import kernel
from core.multibody.packed import Floats

NEARLY_SINGULAR = 1e-9
"""A pivot below this share of its row's largest entry leaves a system to its singular values."""

_CUT = 1e-13
"""Share of the largest singular value below which another counts as zero."""


def solutions(systems: Floats, right: Floats) -> Floats:
    """Return the solution of every system; where there is not one alone, the shortest of least squares.

    Parameters
    ----------
    systems : ndarray, shape (c, k, k)
    right : ndarray, shape (c, k)
        Finite, as the systems.
    """
    found = right.copy()
    singular = ~_eliminated(systems.copy(), found)
    if np.any(singular):
        inverse = np.linalg.pinv(systems[singular], rcond=_CUT)
        found[singular] = np.einsum("cij,cj->ci", inverse, right[singular])
    return found


@kernel()
def _eliminated(a: Floats, x: Floats) -> np.ndarray:
    """Solve in place with scaled pivots; `a` is used up. Return which systems could be solved, shape (c,)."""
    n = a.shape[1]
    good = np.ones(a.shape[0], dtype=np.bool_)
    scale = np.empty(n)
    for s in range(a.shape[0]):
        for i in range(n):
            largest = 0.0
            for j in range(n):
                largest = max(largest, abs(a[s, i, j]))
            scale[i] = 1.0 / largest if largest > 0.0 else 0.0
        for k in range(n):
            pivot, best = k, -1.0
            for i in range(k, n):
                size = abs(a[s, i, k]) * scale[i]
                if size > best:
                    pivot, best = i, size
            if not best > NEARLY_SINGULAR:
                good[s] = False
                break
            if pivot != k:
                for j in range(k, n):
                    a[s, k, j], a[s, pivot, j] = a[s, pivot, j], a[s, k, j]
                x[s, k], x[s, pivot] = x[s, pivot], x[s, k]
                scale[pivot] = scale[k]
            for i in range(k + 1, n):
                if a[s, i, k] != 0.0:
                    factor = a[s, i, k] / a[s, k, k]
                    for j in range(k + 1, n):
                        a[s, i, j] -= factor * a[s, k, j]
                    x[s, i] -= factor * x[s, k]
        if good[s]:
            for i in range(n - 1, -1, -1):
                total = x[s, i]
                for j in range(i + 1, n):
                    total -= a[s, i, j] * x[s, j]
                x[s, i] = total / a[s, i, i]
    return good

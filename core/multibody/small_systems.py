"""Many small linear systems at once, by elimination: what singular values decide is left to those that are singular."""

from __future__ import annotations

import numpy as np
from scipy.linalg import lstsq

from core.compiled import kernel
from core.multibody.packed import Floats

NEARLY_SINGULAR = 1e-9
"""A pivot below this share of the largest entry leaves a system to its singular values."""

_CUT = 1e-13
"""Share of the largest singular value below which another counts as zero."""


def solutions(systems: Floats, right: Floats) -> tuple[Floats, np.ndarray]:
    """Return the solution of every system, and which are nearly singular: there it is the shortest of least squares.

    Parameters
    ----------
    systems : ndarray, shape (c, k, k)
    right : ndarray, shape (c, k)
        Finite, as the systems.
    """
    found = right.copy()
    singular = ~_eliminated(systems.copy(), found)
    if np.any(singular):
        try:
            inverse = np.linalg.pinv(systems[singular], rcond=_CUT)
            found[singular] = np.einsum("cij,cj->ci", inverse, right[singular])
        except np.linalg.LinAlgError:
            # Singular values are found by iteration, which rarely does not end; an orthogonal factorisation does.
            for s in np.flatnonzero(singular):
                found[s] = lstsq(systems[s], right[s], cond=_CUT, lapack_driver="gelsy")[0]
    return found, singular


@kernel()
def _eliminated(a: Floats, x: Floats) -> np.ndarray:
    """Solve in place; `a` is used up. Return which systems have large enough pivots, shape (c,)."""
    n = a.shape[1]
    good = np.ones(a.shape[0], dtype=np.bool_)
    for s in range(a.shape[0]):
        least = 0.0
        for i in range(n):
            for j in range(n):
                least = max(least, NEARLY_SINGULAR * abs(a[s, i, j]))
        for k in range(n):
            pivot, best = k, -1.0
            for i in range(k, n):
                if abs(a[s, i, k]) > best:
                    pivot, best = i, abs(a[s, i, k])
            if not best > least:
                good[s] = False
                break
            if pivot != k:
                for j in range(k, n):
                    a[s, k, j], a[s, pivot, j] = a[s, pivot, j], a[s, k, j]
                x[s, k], x[s, pivot] = x[s, pivot], x[s, k]
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

"""Whether the force that holds a scene beside a place of rest keeps its sign, in doubles with a bound of the error."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.multibody.algebra.small_systems import solve
from core.multibody.statics.static_equations import StaticArrays, linearised

_STEPS = 8
"""Newton steps at a distance: from the one before, 1.4 times as near, quadratic convergence takes five."""
_CONVERGED = 1e-10
"""Largest last step, relative to the size: what is left is its square."""
_ROUNDED = 2.0**-42
"""Share of the terms of an equation that rounding leaves of it: a few dozen terms, with a margin of ten."""


@kernel()
def force_keeps_sign(arrays: StaticArrays, start: Floats, along: Floats, distances: Floats) -> bool:
    """Return whether the force mu along a direction t surely has one sign at all of some growing distances.

    The scene is held by F = mu t, g = 0 and t.(q - start) = distance. By the last row y of the inverse of these
    equations' derivatives, mu is wrong by y times what rounding leaves of them.

    Parameters
    ----------
    start : ndarray, shape (n + m,)
        Places and multipliers at rest.
    along : ndarray, shape (n,)
        The direction t, of length one.
    """
    n, last = len(along), len(start)
    x, force, first = start.copy(), 0.0, 0.0
    inner, rest = np.empty((last, last)), np.empty(last)
    system, right = np.zeros((last + 1, last + 1)), np.zeros(last + 1)
    if len(arrays.tie_rows) > 0:
        # Angles that are held to directions count whole turns, which a bound of this kind does not see.
        return False
    for distance in distances:
        terms, step = 0.0, np.inf
        for _ in range(_STEPS):
            terms = linearised(arrays, x[:n], x[n:], inner, rest)[1]
            right[last] = distance
            for i in range(last):
                right[i] = rest[i]
                for j in range(last):
                    system[i, j] = inner[i, j]
            for i in range(n):
                right[i] -= force * along[i]
                right[last] -= along[i] * (x[i] - start[i])
                system[i, last] = system[last, i] = along[i]
            if solve(system, right):
                return False
            step = 0.0
            for i in range(last):
                x[i] += right[i]
                step = max(step, abs(right[i]) / (1.0 + abs(x[i])))
            force += right[last]
        far, held = 0.0, 0.0
        for i in range(last):
            far, held = (max(far, abs(x[i])), held) if i < n else (far, max(held, abs(x[i])))
        right[:] = 0.0
        right[last] = 1.0
        if not step < _CONVERGED or solve(system.T.copy(), right):
            return False
        known = 0.0
        for i in range(last):
            size = terms + abs(force) + (last - n) * held * (1.0 + far) if i < n else (1.0 + far) ** 2
            known += _ROUNDED * n * size * abs(right[i])
        first = force if first == 0.0 else first
        if not abs(force) > known or force * first < 0.0:
            return False
    return True

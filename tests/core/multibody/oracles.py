"""An independent integrator in arbitrary precision: extrapolated midpoint steps on equations derived by hand.

References
----------
E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.9 (Gragg's method).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath

ORDER = 10
"""Half the order: the numbers of substeps are 2, 4, ..., 2 ORDER."""


def integrated(rate: Callable[..., Sequence[Any]], start: Sequence[Any], time: Any, steps: int = 80) -> list[Any]:
    """Return the state at a time, from `rate(*state)`; some 20 digits where the steps are short."""
    y = [mpmath.mpf(x) for x in start]
    h = mpmath.mpf(time) / steps
    for _ in range(steps):
        table: list[list[Any]] = []
        for k in range(1, ORDER + 1):
            row = [_midpoints(rate, y, h, 2 * k)]
            for j in range(1, k):
                ratio = (mpmath.mpf(k) / (k - j)) ** 2 - 1
                row.append([a + (a - b) / ratio for a, b in zip(row[j - 1], table[-1][j - 1], strict=True)])
            table.append(row)
        y = table[-1][-1]
    return y


def _midpoints(rate: Callable[..., Sequence[Any]], y: list[Any], h: Any, count: int) -> list[Any]:
    s = h / count
    before, now = y, [a + s * b for a, b in zip(y, rate(*y), strict=True)]
    for _ in range(count - 1):
        before, now = now, [a + 2 * s * b for a, b in zip(before, rate(*now), strict=True)]
    return [(a + b + s * c) / 2 for a, b, c in zip(before, now, rate(*now), strict=True)]

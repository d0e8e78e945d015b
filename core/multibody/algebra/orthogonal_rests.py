"""How far lines are from depending on one another, in doubles: what is left of each beside the span of others."""

from __future__ import annotations

import math

from core.arrays import Floats
from core.compiled import kernel


@kernel()
def least_rest(lines: Floats) -> float:
    """Return the least share of a line that is left beside those before it, 0 where one is zero or no number.

    By Gram and Schmidt's modified method, always with the line next of which the most is left. The lines, of shape
    (r, n), are used up; their lengths do not matter.
    """
    count, n = lines.shape
    if count > n:
        return 0.0
    for i in range(count):
        size, length = 0.0, 0.0
        for j in range(n):
            size = max(size, abs(lines[i, j]))
        for j in range(n):
            lines[i, j] /= size
            length += lines[i, j] * lines[i, j]
        for j in range(n):
            lines[i, j] /= math.sqrt(length)
    least = 1.0
    for k in range(count):
        chosen, most = k, 0.0
        for i in range(k, count):
            length = 0.0
            for j in range(n):
                length += lines[i, j] * lines[i, j]
            if not length <= most:
                chosen, most = i, length
        if not most > 0.0:
            return 0.0
        least = math.sqrt(most)
        for j in range(n):
            lines[k, j], lines[chosen, j] = lines[chosen, j], lines[k, j]
            lines[k, j] /= least
        for i in range(k + 1, count):
            along = 0.0
            for j in range(n):
                along += lines[i, j] * lines[k, j]
            for j in range(n):
                lines[i, j] -= along * lines[k, j]
    return least

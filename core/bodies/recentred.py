"""Points relative to the middle of their bounding box, without rounding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from core.arrays import Floats


@dataclass(frozen=True, eq=False)
class Recentred:
    """Points whose coordinates are reference + unit (high + low), |high| < 1, unit a power of two for each axis.

    Points far from the origin lose no digits in a sum of products, and neither a needle nor a thin plate leaves the
    range of doubles. A coordinate that all points share is exactly zero.

    Attributes
    ----------
    high, low : ndarray, shape (n, 3)
        Values and tails.
    unit, reference : sequence of 3 Fraction
        m.
    """

    high: Floats
    low: Floats
    unit: Sequence[Fraction]
    reference: Sequence[Fraction]

    @classmethod
    def on(cls, points: Floats) -> Recentred:
        """Return points, shape (n, 3), relative to the middle of their bounding box."""
        outer = np.frexp(np.abs(points).max(axis=0))[1].astype(np.int64)
        x = np.ldexp(points, -outer)
        middle = 0.5 * (x.min(axis=0) + x.max(axis=0))
        # The difference as an exact sum of two doubles: D. E. Knuth, "The Art of Computer Programming" 2, 4.2.2,
        # theorem B.
        high = x - middle
        back = high - x
        low = (x - (high - back)) + (-middle - back)
        inner = np.frexp(np.abs(high).max(axis=0))[1].astype(np.int64)
        return cls(
            np.ldexp(high, -inner),
            np.ldexp(low, -inner),
            [Fraction(2) ** int(e) for e in outer + inner],
            [Fraction(float(m)) * Fraction(2) ** int(e) for m, e in zip(middle, outer, strict=True)],
        )

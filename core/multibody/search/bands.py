"""How well a quantity is known on pieces of a motion, and sums of times that pass nothing over."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from core.arrays import Floats
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import Pieces

Quantity = Callable[[Pieces], Curve]
"""What is watched, along a motion."""

SAFETY_FACTOR = 16.0
"""The difference of two computations, times this, is what a state is taken to be wrong by."""
FLOOR = 2.0**-96
"""Share of its terms, or of the largest coordinate of its unit, that a quantity or a state is wrong by at least, unless
it is exact: a thousand roundings of pairs."""
_LEFT_OUT = 2.0
"""Sum of what is left out, as a multiple of the last coefficients: they fall by two or more."""


def with_band(quantity: Quantity, pieces: Sequence[Pieces]) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the coefficients of a quantity on some pieces, the sizes of their terms, their errors, what is left out.

    The errors are rounding, and the difference of two computations of the motion.
    """
    own = quantity(pieces[0])
    band = FLOOR * own.sizes
    for other in pieces[1:]:
        curve = quantity(other).values
        # Both in powers of the same time.
        ratio = (pieces[0].lengths / other.lengths)[:, None] ** np.arange(curve.shape[1])
        apart = (own.values[..., 0] - ratio * curve[..., 0]) + (own.values[..., 1] - ratio * curve[..., 1])
        band = band + SAFETY_FACTOR * np.abs(apart)
    return own.values, own.sizes, band, _LEFT_OUT * np.max(own.sizes[:, -3:], axis=1)


def later(start: float, more: float) -> float:
    """Return a sum, rounded towards its first term: no time is passed over."""
    total = start + more
    part = total - start
    rounded = (start - (total - part)) + (more - part)
    return math.nextafter(total, start) if rounded < 0.0 else total

"""What the rounding of a motion's constants comes to along the motion, to first order, compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

from core.compiled import kernel
from core.elliptic.integrals import one_less_e_over_k

SMALL = 2.0**-16
"""Rates are multiplied by it, so that those of the largest doubles do not overflow."""


class ConditionBounds(NamedTuple):
    """The bound start + rate t/SMALL at the time t >= 0, in units of the rounding, relative to the largest rate."""

    start: float
    rate: float

    def at(self, uncertainty: float, horizon: float) -> float:
        """Return what a relative uncertainty has grown to; infinite beyond a tenth, where the first order ends."""
        grown = uncertainty * self.start + uncertainty / SMALL * horizon * self.rate
        return grown if grown < 0.1 else math.inf


NONE = ConditionBounds(0.0, 0.0)


@kernel()
def _e_minus_m1_k(m: float, m1: float, K: float) -> float:
    """Return (E - m1 K)/m, where 0 <= m <= 1, to a few digits."""
    if m < 1e-4:
        return 0.25 * math.pi * (1.0 + 0.125 * m)
    if m1 < 1e-12:
        return 1.0
    return (K * (1.0 - one_less_e_over_k(m, math.sqrt(m1))) - m1 * K) / m


@kernel()
def rounding_bounds(
    am: float, bm: float, cm: float, m: float, m1: float, p: float, K: float, sn: float, cn: float, dn: float,
    u0: float, cancellation: float, largest: float,
) -> ConditionBounds:  # fmt: skip
    """ConditionBounds to the rounding with which the constants themselves are formed from exact inputs.

    Here c is the circled axis, a the other extreme, b the middle. Every constant is a product or a sum of positive
    terms, within a few units, but D_B, which carries `cancellation`. Amplitudes are in units in which `largest` is of
    order one; p is in rad/s.
    """
    slope = math.sqrt(max(am * am, bm * bm) + 0.25 * (m * cm) ** 2) / largest
    if K == 0.0:
        # Away from u = 0 the slope falls as sech u, faster than the error of u grows.
        return ConditionBounds(8.0 * slope * (1.0 + 2.0 * abs(u0)) + 4.0, 0.0)
    relative = 8.0 * (min(m / m1, cancellation) if m1 > 0.0 else cancellation)
    shift = 0.5 * _e_minus_m1_k(m, m1, K) * relative
    start = slope * (8.0 * abs(sn * cn) / dn + 8.0 * abs(u0) + shift) + 4.0
    return ConditionBounds(start, slope * (SMALL * p) * (8.0 + shift / K))

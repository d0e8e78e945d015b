"""Unit vectors along axes, with a defined sign."""

from __future__ import annotations

from core.balls import Undetermined
from core.digits.adaptive_precision import working_bits
from core.digits.decimals import FLOOR_IN_DIGITS
from core.rotation.exact_start import Balls

TIE_BITS = 320
"""Components that this precision does not distinguish count as equal."""


def oriented(axis: Balls) -> Balls:
    """Return a vector or its opposite, whichever points along the positive direction of the nearest body axis.

    If several body axes are equally near, the first is used.

    Raises
    ------
    Undetermined
        If the precision does not determine it.
    """
    largest = 0
    for k in (1, 2):
        margin = abs(axis[k]) - abs(axis[largest])
        if margin > 0:
            largest = k
        elif not margin <= 0 and working_bits() < TIE_BITS:
            raise Undetermined
    if axis[largest] > 0:
        return axis
    if not axis[largest] < 0:
        raise Undetermined
    x, y, z = (-entry for entry in axis)
    return x, y, z


def floor_of_directions(digits: int) -> int:
    """Return the last printed place of the components of a unit vector."""
    return -FLOOR_IN_DIGITS * digits

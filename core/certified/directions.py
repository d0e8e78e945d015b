"""Axes without a sense, told by unit vectors."""

from __future__ import annotations

from core.certified.adaptive_precision import working_bits
from core.certified.decimals import FLOOR_IN_DIGITS, Undetermined
from core.certified.exact_start import Balls

TIE_BITS = 320
"""Components that so many bits do not tell apart are taken as equal."""


def oriented(axis: Balls) -> Balls:
    """Return a vector or its opposite: the one along the positive side of the body axis that it is nearest to.

    Of body axes that are equally near the first counts.

    Raises
    ------
    Undetermined
        If that is in doubt.
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
    """Return the last place that is printed of the components of a unit vector."""
    return -FLOOR_IN_DIGITS * digits

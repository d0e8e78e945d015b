"""How far the figures of a wobble, which are doubles, are from the true ones: proven by ball arithmetic."""

from __future__ import annotations

from fractions import Fraction
from math import inf, nextafter
from typing import Any

from flint import arb

from core.balls import precision
from core.digits.exact_inputs import enclosed
from core.rotation.wobble import Wobble, length_of

BITS = 256
"""More than enough: nothing is subtracted from what is near it."""


def wobble_errors(wobble: Wobble, rotations: Fraction) -> dict[str, Any]:
    """Return bounds of the errors of a wobble's figures, under their names.

    Parameters
    ----------
    wobble : Wobble
    rotations : Fraction
        The period in rotations that it was computed from, exactly.
    """
    asymmetry = 1 / rotations
    with precision(BITS):
        # a/c = sqrt((1 + e)/(1 - e)) and (a - c)/a = (1 - c^2/a^2)/(1 + c/a), with c^2/a^2 = (1 - e)/(1 + e).
        ratio = enclosed((1 + asymmetry) / (1 - asymmetry)).sqrt()
        flattening = enclosed(2 * asymmetry / (1 + asymmetry)) / (1 + 1 / ratio)
        return {
            "period": _error(wobble.period, enclosed(rotations / length_of(wobble.day))),
            "rotations": _error(wobble.rotations, enclosed(rotations)),
            "asymmetry": _error(wobble.asymmetry, enclosed(asymmetry)),
            "ellipticity": _error(wobble.ellipticity, ratio),
            "flattening": _error(wobble.flattening, flattening),
        }


def _error(figure: float, true: arb) -> float:
    """Return an upper bound of the distance."""
    # The nearest double may be just below.
    return nextafter(float(abs(true - arb(figure)).upper()), inf)

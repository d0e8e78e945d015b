"""What samples lose to numbers below the normal doubles, and until when the start itself is the better answer."""

from __future__ import annotations

import math

from core.arrays import Floats
from core.rotation.closed_form.circulation import SEPARATRIX
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion

UNDERFLOW = 2.0**-1070
"""What samples, and the tails of moments and components, lose in all where they are below the normal doubles."""

UNMOVED = 2.0**-60
"""A relative change of the angular velocity that is less than its rounding."""


def unmoved_until(moments: Floats, largest_norm: float) -> float:
    """Return the time up to which the angular velocity moves by no more than `UNMOVED` of its largest norm (s).

    By Euler's equations no faster than by its square times the largest of their coefficients; `moments`, shape (3,),
    are ascending.
    """
    a, b, c = moments.tolist()
    steepest = max((c - b) / a, (c - a) / b, (b - a) / c) * largest_norm
    return UNMOVED / steepest if steepest > 0.0 else math.inf


def underflow_of(motion: ConstantsOfMotion, largest_norm: float) -> float:
    """Return what a sample may be wrong by, relative, because a factor of it is below the normal doubles."""
    if motion.regime == SEPARATRIX:
        return UNDERFLOW / largest_norm
    # Near the separatrix some constants are as small as k', and what they are multiplied by as large as 1/k'. What
    # one of them loses is at most the spacing of subnormal doubles.
    k, spacing = motion.weights, 2.0**-1074
    products = (
        (motion.A_c, k.c_even),
        (motion.A_c, k.c_odd),
        (motion.A_b, k.b_even),
        (motion.A_b, k.b_odd),
        (motion.A_d, k.d_even),
        (motion.A_d, k.d_odd),
    )
    most = max(abs(amplitude) / max(spacing, abs(constant)) for amplitude, constant in products)
    return UNDERFLOW * max(1.0, most) / largest_norm

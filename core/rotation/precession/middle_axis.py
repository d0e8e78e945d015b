"""How far the middle axis of a free body leans from its angular momentum, and whether it turns over, compiled.

The cosine of the angle is I_b w_b/L, and w_b swings between A_b and -A_b. Where it is largest w_c vanishes, so that

    tan(least) = I_d A_d k'/(I_b A_b) = sqrt(I_d |D_B|/(I_b X)),   largest = pi - least,

with the symbols of `core.rotation.closed_form.circulation`: |D_B| and X carry no cancellation. The body tumbles where
the least angle is below 45 degrees: the middle axis then swings from near the angular momentum to near its opposite and
back in every period, and on the separatrix once in all time. A component that merely changes its sign about a stable
axis, 90 degrees away from both, is no tumbling.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.bodies.principal_inertia import PrincipalInertia
from core.compiled import kernel
from core.double_double import Scaled, sc_abs, sc_add, sc_mul, sc_neg, sc_sqrt
from core.rotation.closed_form.circulation import UNDECIDED, circulation, decision, exact_difference
from core.rotation.closed_form.principal_frame import Resolved
from core.rotation.precession.figures import angle_of_tangent, oriented


class MiddleAxisTilt(NamedTuple):
    """The range of the angle between the middle axis and the angular momentum in the whole motion.

    Attributes
    ----------
    least, largest : float
        From 0 to pi (rad); on the separatrix the limits 0 and pi. The middle axis points along the positive side of the
        body axis that it is nearest to. `least` is infinite where it is too small for a normal double.
    tumbles : bool
        Whether the middle axis turns over, from within 45 degrees of the angular momentum to within 45 degrees of its
        opposite.
    """

    least: float
    largest: float
    tumbles: bool

    @property
    def range(self) -> tuple[float, float]:
        """Both angles (rad)."""
        return self.least, self.largest


@kernel()
def swing(
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    decided: bool,
    exact: Scaled,
) -> tuple[int, float, float, bool]:
    """Return regime, both angles and whether the body tumbles; parameters as in `constants_of_motion`."""
    found = decision(i, it, w, wt, decided, exact)
    if found.regime == UNDECIDED:
        return UNDECIDED, 0.0, 0.0, False
    c = circulation(i, it, w, wt, 2 if found.D.high >= 0.0 else 0)
    across, along = sc_mul(c.I_d, sc_abs(found.D)), sc_mul(c.I_b, c.X)
    a, b = sc_sqrt(across), sc_sqrt(along)
    tumbles = sc_add(along, sc_neg(across)).high > 0.0
    return found.regime, angle_of_tangent(a, b, False), angle_of_tangent(a, b, True), tumbles


def middle_axis_tilt(resolved: Resolved, inertia: PrincipalInertia) -> MiddleAxisTilt | None:
    """Return the range of the angle between middle axis and angular momentum.

    Parameters
    ----------
    resolved : Resolved
        Moments and start along ascending principal axes.
    inertia : PrincipalInertia
        Of the body, which says which of the moments differ.

    Returns
    -------
    MiddleAxisTilt or None
        None at rest and where two moments are equal, so that there is no middle axis.
    """
    i, it, w, wt = resolved.numbers
    turning = [k for k, x in enumerate(w.tolist()) if x != 0.0]
    if not all(inertia.apart) or not turning:
        return None
    if len(turning) == 1:
        if turning != [1]:
            return MiddleAxisTilt(0.5 * math.pi, 0.5 * math.pi, False)
        angle = 0.0 if oriented(inertia.axes, 1)[3] * w[1] > 0.0 else math.pi
        return MiddleAxisTilt(angle, angle, False)
    regime, least, largest, tumbles = swing(i, it, w, wt, False, Scaled(0.0, 0.0, 0))
    if regime == UNDECIDED:
        _, least, largest, tumbles = swing(i, it, w, wt, True, exact_difference(resolved))
    return MiddleAxisTilt(least, largest, tumbles)

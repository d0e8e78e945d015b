"""The impulse of one contact of the plane by the laws of Poisson and Stronge, along the line of its slip.

The rates of gap and slip, as functions of the normal impulse p, change by W (1, f), with the friction f a unit of p
takes. They are followed from bend to bend: where the slip stops, where the gap ceases to close, where the law ends it.

References
----------
W. J. Stronge, "Impact Mechanics" (2000), sections 3.3 and 5.2-5.3: the coefficients by impulses and by works.
"""

from __future__ import annotations

import math

import numpy as np

from core.multibody.audit.definition import Touch
from tests.oracles.plain_engine.coordinates import Floats

STOPPED = 1e-13
"""Share of the rates below which a slip has stopped."""
BENDS = 8
"""Parts of an impulse, of which there are four at most: the slip stops once, and compression ends once."""


def impulses(response: Floats, rates: Floats, touch: Touch) -> Floats | None:
    """Return the impulses along gap and slip; None where friction presses on without end.

    Parameters
    ----------
    response : ndarray, shape (2, 2)
        Change of the rates of gap and slip by unit impulses along them.
    rates : ndarray, shape (2,)
        Those before.
    """
    size, total, now = float(np.abs(rates).max()), np.zeros(2), rates.copy()
    work, compression = 0.0, 0.0
    compressing = True
    for _ in range(BENDS):
        friction = _friction(response, now[1] if abs(now[1]) > STOPPED * size else 0.0, touch)
        along = np.array([1.0, friction])
        gain = response @ along
        # Impulses until the slip stops, and until the gap or the law says so.
        turn = -now[1] / gain[1] if now[1] * gain[1] < 0.0 and abs(now[1]) > STOPPED * size else math.inf
        if compressing:
            last = -now[0] / gain[0] if gain[0] > 0.0 else math.inf
        elif touch.law == "poisson":
            last = (1.0 + touch.restitution) * compression - total[0]
        else:
            left = (1.0 - touch.restitution**2) * compression - work
            root = now[0] ** 2 + 2.0 * gain[0] * left
            last = (math.sqrt(root) - now[0]) / gain[0] if root >= 0.0 and gain[0] > 0.0 else math.inf
        step = min(turn, last)
        if not math.isfinite(step):
            return None
        work += step * (now[0] + 0.5 * gain[0] * step)
        total, now = total + step * along, now + step * gain
        if turn < last:
            now[1] = 0.0
        elif compressing:
            compressing, compression, now[0] = False, total[0] if touch.law == "poisson" else work, 0.0
        else:
            return total
    return None


def _friction(response: Floats, slip: float, touch: Touch) -> float:
    """Return the impulse of friction for a unit along the gap."""
    if slip != 0.0:
        return -math.copysign(touch.kinetic, slip)
    holding = -response[1, 0] / response[1, 1]
    return holding if abs(holding) <= touch.static else math.copysign(touch.kinetic, holding)

"""How long a step is in which a Taylor series is as exact as a tolerance asks, by the sizes of its coefficients."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.multibody.equations.packed import ANGLES, FORCES

EARLY = 6
"""Highest power by which a motion that begins with it is measured though lower ones are there by rounding: what begins
to slip under a force that grows begins with the third."""

GAP = 10
"""Powers of which one at least is of full size: the square of what passes through zero moves it by every third."""
SMALLER = 2.0**10
"""How much smaller a coefficient may be than others of a series tell: those of a sine are within this."""


@kernel()
def lowest_bound(gaps: int, order: int) -> int:
    """Return the lowest power by which a step is bounded: some formulas leave gaps between the powers.

    Without them a series whose last coefficients vanish is a polynomial, which bounds no step.
    """
    return 3 if gaps > 0 else order


@kernel()
def step_size(q: Floats, group: Integers, tolerance: float, lowest: int) -> float:
    """Return the step at which the last terms of the series are `tolerance` of what they are added to.

    Parameters
    ----------
    q : (n, order + 1)
    group : (n,)
        Coordinates of one group are measured by the largest of them.
    lowest : int
        As `least_step` takes it.
    """
    order = q.shape[1] - 1
    sizes = np.zeros((FORCES + 1, order + 1))
    for i in range(q.shape[0]):
        if group[i] <= FORCES:
            for k in range(order + 1):
                sizes[group[i], k] = max(sizes[group[i], k], abs(q[i, k]))
    best = np.inf
    for g in range(FORCES + 1):
        best = least_step(sizes[g], g, math.log(tolerance), lowest, best)
    return math.exp(best)


@kernel()
def least_step(sizes: Floats, group: int, share: float, lowest: int, best: float) -> float:
    """Return the lesser of the logarithm of a step and of that which the coefficients of a group allow.

    Where the last two coefficients vanish, the highest one that does not tells the radius of convergence, down to the
    power `lowest`: what is left out begins beyond the order all the same. Where powers may be missing, the last two may
    be there by rounding alone, and some before them bound the step, too.

    Parameters
    ----------
    sizes : (order + 1,)
        The largest coefficient of each power.
    share : float
        The logarithm of the tolerance.
    """
    order = sizes.shape[0] - 1
    top = order
    if sizes[order - 1] == 0.0:
        while sizes[top] == 0.0 and top > lowest:
            top -= 1
    # The logarithms of sizes and scales; that of zero is minus infinity.
    nearest = 0.0 if group == ANGLES else math.log(sizes[0])
    rate, gain = math.log(sizes[1]), math.log(sizes[2])
    for back in range(max(GAP, 2) if lowest < order else 2):
        power = top if back == 0 else order - back
        if sizes[power] > 0.0 and power > 2:
            size = math.log(sizes[power])
            # What starts at zero is measured by how far it comes within the radius of convergence.
            scale = max(nearest, gain + 2.0 * (gain - size) / (power - 2))
            scale = max(scale, rate + (rate - size) / (power - 1))
            beyond = order if power < order - 1 else power
            step = (scale - size) / power + share / beyond
            for k in range(3, power):
                if k > EARLY and step > -np.inf:
                    break
                step = max(step, (math.log(sizes[k]) - size) / (power - k) + share / (beyond - k))
            if back > 1:
                # Powers that follow are usually smaller than those before tell.
                step += math.log(SMALLER) / power
            # What has no other coefficient moves by rounding alone, or is a polynomial.
            if step > -np.inf:
                best = min(best, step)
    return best

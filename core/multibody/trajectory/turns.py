"""Where curves that are known by samples turn back, and where velocities do.

Between two times at which a motion proposes to be looked at a curve turns once at most; it may do so soon after the
start, or just before the end.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats

HALVINGS = 48
"""How often the intervals at both ends are halved: what is thrown may turn in much less time than it takes to swing."""

_ROUNDS = 60
_SETTLED = 2.0**-50


def closer_at_ends(times: Floats, halvings: int = HALVINGS) -> Floats:
    """Return times with others between the first two, that halve towards the first, and the last two likewise.

    Parameters
    ----------
    times : ndarray, shape (t,)
        Growing or falling.
    """
    if len(times) < 2:
        return times
    shares = 2.0 ** -np.arange(halvings, 0.0, -1.0)
    early = times[0] + (times[1] - times[0]) * shares
    late = times[-1] - (times[-1] - times[-2]) * shares[::-1]
    found = np.concatenate([times[:1], early, times[1:-1], late, times[-1:]])
    ordered = np.unique(found)
    return ordered if times[-1] > times[0] else ordered[::-1]


def dips(times: Floats, curve: Floats) -> Floats:
    """Return how low a parabola through each value and its neighbours comes; infinity where the value is not lowest."""
    found = np.full(len(curve), np.inf)
    if len(curve) > 2:
        left, middle, right = curve[:-2], curve[1:-1], curve[2:]
        before, after = np.diff(times)[:-1], np.diff(times)[1:]
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            bend = ((right - middle) / after - (middle - left) / before) / (before + after)
            slope = (middle - left) / before + bend * before
            lowest = middle - slope**2 / (4 * bend)
        found[1:-1] = np.where((middle <= left) & (middle <= right) & (bend > 0), lowest, np.inf)
    return found


def reversals(velocity: Callable[[Floats], Floats], times: Floats) -> Floats:
    """Return times at which a velocity turns against what it was at the last of some times: its length has a corner.

    Parameters
    ----------
    velocity : callable
        From times of shape (t,) to velocities of shape (t, k).
    times : ndarray, shape (t,)
        Between two of which it turns against itself once at most.
    """
    found = velocity(times)
    against = np.flatnonzero(np.einsum("ti,ti->t", found[:-1], found[1:]) < 0.0)
    if not len(against):
        return np.zeros(0)
    # The Illinois variant of the false position.
    way = found[against]
    low: Floats = times[against]
    high: Floats = times[against + 1]
    middle = low
    below, above = (np.einsum("ti,ti->t", way, found[against + k]) for k in range(2))
    last = np.zeros(len(against))
    for _ in range(_ROUNDS):
        middle = np.clip(high - above * (high - low) / (above - below), np.minimum(low, high), np.maximum(low, high))
        value = np.einsum("ti,ti->t", way, velocity(middle))
        side = np.sign(value)
        low, high = np.where(side > 0, middle, low), np.where(side > 0, high, middle)
        above = np.where(side > 0, np.where(last > 0, 0.5 * above, above), value)
        below = np.where(side > 0, value, np.where(last < 0, 0.5 * below, below))
        last = side
        if np.all((np.abs(high - low) <= _SETTLED * np.abs(high)) | (side == 0.0)):
            break
    return middle

"""A zero to the last digits of pairs: Newton's method on the motion expanded about the nearest double."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from flint import arb

from core.arrays import Floats
from core.double_double import dd_add, dd_div_d, dd_mul_d
from core.errors import AccuracyUnreachable
from core.multibody.algebra.bernstein import horner, slope_at
from core.multibody.algebra.polynomials import Ball
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import Expanded, Pieces

_ROUNDS = 12
"""Expansions: from one double near a zero to the next; a zero that is a double away is reached in two."""
_NEWTON = 60
"""Rounds on one expansion: they halve the distance to a double zero only."""
_NEAR = 2.0**-6
"""Share of a piece within which its polynomials are right to pairs: what is left out is 2^-126 of what it was."""
_SETTLED = 2.0**-104
"""Share of a time to which a zero is settled: four units in the last place of pairs."""


class NotLocated(Exception):
    """No zero is near a time."""


class Located:
    """The state at a zero.

    Attributes
    ----------
    time : ball
    q, v : list of ball
    width : float
        Sum of the terms of the quantity over its slope (s): by this times their relative error the time is wrong.
    """

    def __init__(self, time: Ball, q: list[Ball], v: list[Ball], width: float) -> None:
        self.time, self.q, self.v, self.width = time, q, v, width


def located(motion: Expanded, quantity: Callable[[Pieces], Curve], time: float, rest: float, reach: float) -> Located:
    """Return the zero of a quantity next to a pair of time.

    Parameters
    ----------
    reach : float
        Longest time (s) that is of interest.

    Raises
    ------
    NotLocated
        If Newton's method does not settle, or comes to a place where the motion has no series.
    """
    for _ in range(_ROUNDS):
        try:
            pieces = motion(np.array([time]), np.array([reach]))
        except AccuracyUnreachable:
            # As where a length is zero by whose inverse a force has its direction.
            break
        length = float(pieces.lengths[0])
        own = quantity(pieces)
        curve = own.values[0]
        th, tl = _newton(curve, rest / length)
        if not math.isfinite(th):
            break
        if abs(th) <= _NEAR or abs(th * length) <= 2.0**-50 * abs(time):
            slope = abs(slope_at(curve, th) / length)
            width = float(own.sizes[0, 0]) / slope if slope > 0.0 else abs(time)
            return _state(pieces, time, th, tl, width)
        moved = time + th * length
        time, rest = (moved if moved * reach > 0.0 else 0.5 * time), 0.0
    raise NotLocated


def state_at(motion: Expanded, time: float, reach: float) -> tuple[list[Ball], list[Ball]]:
    """Return coordinates and rates at a double."""
    found = _state(motion(np.array([time]), np.array([reach])), time, 0.0, 0.0, 0.0)
    return found.q, found.v


def state_after(motion: Expanded, time: Ball) -> tuple[list[Ball], list[Ball]]:
    """Return coordinates and rates at a time that no double need be."""
    near = float(time)
    pieces = motion(np.array([near]), np.array([near]))
    high = float((time - near).mid()) / float(pieces.lengths[0])
    found = _state(pieces, near, high, 0.0, 0.0)
    return found.q, found.v


def _newton(curve: Floats, share: float) -> tuple[float, float]:
    th, tl = share, 0.0
    size = float(np.max(np.abs(curve[:, 0])))
    for _ in range(_NEWTON):
        slope = slope_at(curve, th)
        vh, vl = horner(curve, th, tl)
        if slope == 0.0 or abs(vh) <= _SETTLED * 2.0**-10 * size:
            break
        dh, dl = dd_div_d(vh, vl, -slope)
        # What is far away is approached from the next expansion.
        dh, dl = (dh, dl) if abs(dh) < 1.0 else (math.copysign(1.0, dh), 0.0)
        th, tl = dd_add(th, tl, dh, dl)
        if abs(dh) <= _SETTLED * max(abs(th), 2.0**-1000) or abs(th) > 1.0:
            break
    return th, tl


def _state(pieces: Pieces, time: float, th: float, tl: float, width: float) -> Located:
    """Return the state at a share of a piece that begins at a time."""
    q, v = [], []
    for i in range(pieces.places.shape[1]):
        q.append(_ball(*horner(np.ascontiguousarray(pieces.places[0, i]), th, tl)))
        v.append(_ball(*horner(pieces.rate(i).values[0], th, tl)))
    high, low = dd_mul_d(th, tl, float(pieces.lengths[0]))
    return Located(arb(time) + arb(high) + arb(low), q, v, width)


def _ball(high: float, low: float) -> Ball:
    return arb(high) + arb(low)

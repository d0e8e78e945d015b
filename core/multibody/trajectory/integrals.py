"""Integrals along a motion: lengths of paths, and the work of what takes or brings energy.

Gauss's rule of ten points on pieces of the motion's own steps, compared with two halves; a piece on which they differ
is halved again, as beside a place where a body turns back and its speed has a corner.

References
----------
P. J. Davis, P. Rabinowitz, Methods of Numerical Integration (1984), chapter 6.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats
from core.errors import BudgetExceeded

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(10)
_DEPTH = 60
"""Halvings of an interval: there are no more doubles between its ends then."""

MOST_POINTS = 400_000
"""Times at which an integrand is evaluated."""
POINTS_OF_INTERVAL = 3 * len(_POINTS)
"""At least: each interval is compared with its halves."""
_FINE = 2.0**-50
"""Share of a piece up to which two sums of ten rounded terms differ by rounding alone."""

Integrand = Callable[[Floats], tuple[Floats, Floats, Floats]]
"""From times of shape (t,) to the integrand by the answer, by its reference, and how large its terms are, each (t,)."""


def integrated(integrand: Integrand, nodes: Floats, times: Floats) -> tuple[Floats, Floats]:
    """Return integrals from zero to times of one sign, and bounds of their errors, each of shape (t,).

    Parameters
    ----------
    nodes : ndarray, shape (k,)
        Times from zero up to the farthest or beyond it, between which the integrand is smooth.
    times : ndarray, shape (t,)

    Raises
    ------
    BudgetExceeded
        Where the integrand would have to be evaluated too often.
    """
    ends = np.unique(
        np.concatenate([np.zeros(1), np.abs(times), np.abs(nodes)[np.abs(nodes) <= np.abs(times).max(initial=0.0)]])
    )
    way = -1.0 if np.any(times < 0.0) else 1.0
    if len(ends) < 2:
        return np.zeros(len(times)), np.zeros(len(times))
    low, high = way * ends[:-1], way * ends[1:]
    piece, error = np.zeros(len(low)), np.zeros(len(low))
    owner = np.arange(len(low))
    whole, _, size, _ = _gauss(integrand, low, high)
    largest = float(size.max(initial=0.0))
    points = len(low) * len(_POINTS)
    for depth in range(_DEPTH):
        points += 2 * len(low) * len(_POINTS)
        require_few_points(points)
        middle = 0.5 * (low + high)
        halves = _gauss(integrand, np.concatenate([low, middle]), np.concatenate([middle, high]))
        (first, finer), (_, by_reference), (_, finer_size), (_, apart) = (
            (x[: len(low)], x[: len(low)] + x[len(low) :]) for x in halves
        )
        off = np.abs(finer - whole)
        # What the integrand itself is wrong by, shorter intervals do not make smaller.
        least = np.maximum(_FINE * np.maximum(finer_size, 2.0**-8 * largest), apart)
        settled = (off <= least) | (middle == low) | (depth == _DEPTH - 1)
        np.add.at(piece, owner[settled], finer[settled])
        np.add.at(error, owner[settled], (off + 4.0 * np.abs(finer - by_reference) + _FINE * finer_size)[settled])
        go = ~settled
        if not np.any(go):
            break
        owner = np.concatenate([owner[go], owner[go]])
        whole = np.concatenate([first[go], (halves[0][len(low) :])[go]])
        low, high = np.concatenate([low[go], middle[go]]), np.concatenate([middle[go], high[go]])
    total = np.concatenate([np.zeros(1), np.cumsum(piece)])
    bound = np.concatenate([np.zeros(1), np.cumsum(error)])
    at = np.searchsorted(ends, np.abs(times))
    return total[at], bound[at]


def require_few_points(points: int) -> None:
    """Raise `BudgetExceeded` where an integrand would have to be evaluated too often."""
    if points > MOST_POINTS:
        what = "times at which what is summed up along the motion is evaluated"
        remedy = "ask for earlier times, or without paths and works"
        raise BudgetExceeded(what, points, MOST_POINTS, path=("outputs",), remedy=remedy)


def _gauss(integrand: Integrand, low: Floats, high: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the integral over each interval, that of the reference, of the terms, and of how far both are apart."""
    half = 0.5 * (high - low)
    times = (0.5 * (low + high))[:, None] + half[:, None] * _POINTS
    own, by_reference, size = (values.reshape(times.shape) for values in integrand(times.ravel()))
    terms, apart = (np.abs(half) * (x @ _WEIGHTS) for x in (size, np.abs(own - by_reference)))
    return half * (own @ _WEIGHTS), half * (by_reference @ _WEIGHTS), terms, apart

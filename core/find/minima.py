"""The least value of a function of one variable between three places."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

Three = tuple[float, float, float]

SHARPNESS = 1e-9
"""Share of its place to which a minimum is located: a smooth function says no more than the root of its rounding."""

SHARP = 1e-13
"""Share of a function's change by which it must rise within that share of its place not to be smooth there."""

GOLDEN = 0.3819660112501051
"""Share of an interval behind which golden sections try the next place: (3 - sqrt(5))/2."""

MOST_STEPS = 100
"""Steps: golden sections alone reach neighbouring doubles in 80."""


class UndefinedBetween(Exception):
    """The figure does not exist everywhere between two samples."""


def least_of(size: Callable[[float], float], bracket: Three) -> float:
    """Return where a function is least inside of a bracket of three places."""
    low, middle, high = bracket
    ends = size(low), size(middle), size(high)
    best = _parabolic(size, bracket)
    near = 4.0 * SHARPNESS * max(abs(best), high - low)
    below, above = max(low, best - near), min(high, best + near)
    if min(size(below), size(above)) - size(best) > SHARP * max(ends):
        # A corner, or the foot of a step, is known to the last digit.
        return _golden(size, (below, best, above))
    return best


def _parabolic(size: Callable[[float], float], bracket: Three) -> float:
    """Return where a smooth function is least: by parabolas, every third step by a golden section.

    References
    ----------
    R. P. Brent, "Algorithms for Minimization without Derivatives", Prentice-Hall, 1973, chapter 5.
    """
    low, middle, high = bracket
    for step in range(MOST_STEPS):
        tolerance = SHARPNESS * max(abs(middle), bracket[2] - bracket[0])
        if high - low <= 4.0 * tolerance:
            break
        above = high - middle > middle - low
        x = _vertex((low, middle, high), (size(low), size(middle), size(high)))
        if step % 3 == 2 or not low < x < high:
            x = middle + GOLDEN * ((high - middle) if above else (low - middle))
        elif abs(x - middle) < tolerance:
            # From both sides the bracket closes in on a place that the parabola has found.
            x = middle + (tolerance if above else -tolerance)
        low, middle, high = _narrowed(size, low, middle, high, x)
    return middle


def _narrowed(size: Callable[[float], float], low: float, middle: float, high: float, x: float) -> Three:
    """Return the bracket with another place."""
    if size(x) < size(middle):
        return (middle, x, high) if x > middle else (low, x, middle)
    return (low, middle, x) if x > middle else (x, middle, high)


def _vertex(places: Three, sizes: Three) -> float:
    """Return the place of the vertex of the parabola through three points; infinite where they are on a line."""
    (a, b, c), (fa, fb, fc) = places, sizes
    left, right = (fb - fa) / (b - a), (fc - fb) / (c - b)
    curvature = (right - left) / (c - a)
    return inf if curvature <= 0.0 else b - 0.5 * (left / curvature + b - a)


def _golden(size: Callable[[float], float], bracket: Three) -> float:
    """Return where a function is least, to neighbouring doubles."""
    low, middle, high = bracket
    for _ in range(MOST_STEPS):
        above = high - middle > middle - low
        x = middle + GOLDEN * ((high - middle) if above else (low - middle))
        if x in (low, middle, high):
            break
        low, middle, high = _narrowed(size, low, middle, high, x)
    return middle


def drop_to_vertex(places: Three, sizes: Three) -> float:
    """Return how far the vertex of the parabola through three points is below the middle one."""
    (a, b, c), (fa, fb, fc) = places, sizes
    left, right = (fb - fa) / (b - a), (fc - fb) / (c - b)
    curvature = (right - left) / (c - a)
    if curvature <= 0.0:
        return 0.0
    slope = left + curvature * (b - a)
    return slope * slope / (4.0 * curvature)


def reaches_zero(places: Three, sizes: Three) -> bool:
    """Return whether one of the lines through two of three points is zero beside the middle one: for a corner."""
    (a, b, c), (fa, fb, fc) = places, sizes
    falls = (fa - fb) / (b - a) * (c - b), (fc - fb) / (c - b) * (b - a)
    return max(falls) >= fb

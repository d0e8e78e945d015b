"""Where a polynomial in time becomes negative, with its roots in balls."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.equations.expansion import slope, value

_HALVINGS = 60
"""Halvings of an interval, after which Newton's method has the last digits of a double right from its start."""
_SHARP = 2.0**-290
"""Share of a root by which it may be wrong that was begun in doubles."""
_NEWTON_STEPS_OF_A_ROOT = 12
"""Of Newton's method: digits double in each, from those of a double to beyond those of balls."""


def first_negative(series: Sequence[Ball], end: Ball) -> tuple[Ball | None, list[Ball]]:
    """Return the first positive time up to `end` at which a polynomial becomes negative, and where it touches zero.

    It is not negative just after zero; leading coefficients that are zero are.
    """
    rest = [ZERO if is_zero(x) else x for x in series]
    while rest and rest[-1] == 0:
        rest.pop()
    while rest and rest[0] == 0:
        rest.pop(0)
    if len(rest) < 2:
        return None, []
    touched: list[Ball] = []
    for root, sign in changes(rest, end, touched):
        if sign < 0:
            return root, [t for t in touched if t < root]
    return None, touched


def changes(p: Sequence[Ball], end: Ball, touched: list[Ball] | None = None) -> list[tuple[Ball, int]]:
    """Return the roots in (0, end] at which a polynomial changes its sign, with the sign that follows."""
    while p and is_zero(p[-1]):
        p = p[:-1]
    if len(p) < 2:
        return []
    if len(p) == 2:
        root = -p[0] / p[1]
        return [(root, 1 if p[1] > 0 else -1)] if root > 0 and not root > end else []
    if len(p) == 3:
        c, b, a = p
        discriminant = b * b - 4 * a * c
        if is_zero(discriminant):
            if touched is not None and -b / (2 * a) > 0 and not -b / (2 * a) > end:
                touched.append(-b / (2 * a))
            return []
        if discriminant < 0:
            return []
        # The larger root by a sum of equal signs, the other by the product of both.
        s = -(b + discriminant.sqrt()) / 2 if b > 0 else (discriminant.sqrt() - b) / 2
        pairs = [x for x in (s / a, c / s if not is_zero(s) else ZERO) if x > 0 and not x > end]
        return [(x, 1 if 2 * a * x + b > 0 else -1) for x in sorted(pairs, key=float)]
    turns = [t for t, _ in changes(slope(p), end)]
    found = []
    low, sign = ZERO, _sign(p[0])
    for t in [*turns, end]:
        here = _sign(value(p, t))
        if here == 0 and t is not end and touched is not None:
            touched.append(t)
        if here and sign and here != sign:
            found.append((_between(p, low, t), here))
        if here:
            sign, low = here, t
    return found


def _sign(x: Ball) -> int:
    return 0 if is_zero(x) else 1 if x > 0 else -1


def _between(p: Sequence[Ball], low: Ball, high: Ball) -> Ball:
    """Return the only root between two times: bisected, in doubles where those see it, then by Newton's method."""
    about = _in_doubles(p, float(low), float(high))
    if about is not None:
        root = sharpened(p, arb(about))
        if root > low and root < high and float(root.rad()) <= _SHARP * float(root):
            return root
    a, b, rising = arb(low.mid()), arb(high.mid()), value(p, high) > 0
    for _ in range(_HALVINGS):
        middle = (a + b) / 2
        middle = arb(middle.mid())
        if (value(p, middle) > 0) == rising:
            b = middle
        else:
            a = middle
    return sharpened(p, arb(((a + b) / 2).mid()))


def _in_doubles(p: Sequence[Ball], low: float, high: float) -> float | None:
    """Return about where a polynomial changes its sign between two times, None where doubles do not show that."""
    coefficients = [float(x.mid()) for x in reversed(p)]

    def at(time: float) -> float:
        total = 0.0
        for x in coefficients:
            total = total * time + x
        return total

    first, last = at(low), at(high)
    if not (first < 0.0 < last or last < 0.0 < first):
        return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if (at(middle) > 0.0) == (last > 0.0):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def sharpened(p: Sequence[Ball], root: Ball) -> Ball:
    """Return a root as a ball, by Newton's method from a start that is near enough."""
    derivative = slope(p)
    for _ in range(_NEWTON_STEPS_OF_A_ROOT):
        step = value(p, root) / value(derivative, root)
        if is_zero(step) or not step.is_finite():
            break
        root = arb((root - step).mid())
    off = abs(value(p, root) / value(derivative, root))
    return arb(root.mid(), 2 * float(off.upper()) + 2.0**-300 * abs(float(root)))

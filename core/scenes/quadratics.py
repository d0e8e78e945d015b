"""Roots of quadratics in ball arithmetic, in the forms that do not cancel."""

from __future__ import annotations

from core.scenes.enclosure import ZERO, Ball, sign, square_root


def real_roots(a: Ball, b: Ball, c: Ball) -> list[Ball]:
    """Return the real roots of a x^2 + b x + c, any of the coefficients possibly zero; [] if all are."""
    if sign(a) == 0:
        return [-c / b] if sign(b) != 0 else []
    discriminant = b * b - 4 * a * c
    if sign(discriminant) < 0:
        return []
    root = square_root(discriminant)
    # The larger root first, by a sum of equal signs; the other by the product of both.
    q = -(b + root) / 2 if sign(b) >= 0 else (root - b) / 2
    return [q / a, c / q] if sign(q) != 0 else [ZERO]


def exit_time(value: Ball, rate: Ball, acceleration: Ball) -> Ball | None:
    """Return the first time t >= 0 at which value + rate t + acceleration t^2/2, not negative at first, turns negative.

    None if it never does; touching zero is not turning negative.
    """
    starts, moves, bends = sign(value), sign(rate), sign(acceleration)
    if starts <= 0:
        if moves < 0 or (moves == 0 and bends < 0) or starts < 0:
            return ZERO
        return -2 * rate / acceleration if bends < 0 else None
    if bends == 0:
        return -value / rate if moves < 0 else None
    if moves >= 0 and bends > 0:
        return None
    discriminant = rate * rate - 2 * acceleration * value
    if bends > 0 and sign(discriminant) <= 0:
        return None
    root = discriminant.sqrt()
    return 2 * value / (root - rate) if moves < 0 else -(rate + root) / acceleration


def advanced(value: Ball, rate: Ball, acceleration: Ball, time: Ball) -> Ball:
    """Return value + rate t + acceleration t^2/2."""
    return value + time * (rate + acceleration * time / 2)

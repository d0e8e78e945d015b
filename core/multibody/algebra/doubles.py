"""Balls as the doubles that are answered, with bounds of their errors."""

from __future__ import annotations

from core.balls import distance_bound
from core.multibody.algebra.polynomials import Ball, is_zero


def in_doubles(ball: Ball) -> float:
    """Return a number as a double; what cannot be told from zero is zero."""
    return 0.0 if is_zero(ball) else float(ball)


def error_in_doubles(ball: Ball) -> float | None:
    """Return a bound of the error of the double that `in_doubles` returns; None beyond the range of doubles."""
    return distance_bound(ball, in_doubles(ball))

"""From an exact rational figure to the double that states it, or to nothing where no double can."""

from __future__ import annotations

import math
from fractions import Fraction

LARGEST = Fraction(2) ** 1024 - Fraction(2) ** 970
"""From here on numbers round to infinity."""
SMALLEST = Fraction(2) ** -1022
"""Below this doubles have fewer than 53 bits."""


def double(number: Fraction) -> float | None:
    """Return the nearest double; None outside the normal range, where it would lose digits."""
    return float(number) if number == 0 or SMALLEST <= abs(number) < LARGEST else None


def square_root(square: Fraction) -> Fraction:
    """Return the root of a number that is not negative, right to 2^-120 of itself."""
    if square == 0:
        return square
    top, bottom = square.numerator, square.denominator
    shift = max(0, 256 - top.bit_length() + bottom.bit_length())
    shift += shift & 1
    return Fraction(math.isqrt((top << shift) // bottom), 1 << (shift // 2))


def angle(across_squared: Fraction, along_squared: Fraction, direction: int = 1) -> float | None:
    """Return the angle in [0, pi] whose tangent squared is `across_squared / along_squared` (rad).

    It is obtuse where `direction` is negative; None where it is too small for a double.
    """
    if along_squared == 0:
        return 0.5 * math.pi if across_squared else 0.0
    tangent_squared = across_squared / along_squared
    if tangent_squared > 1:
        # The small complement, so that no tangent leaves the range of doubles.
        rest = double(square_root(1 / tangent_squared))
        return 0.5 * math.pi + math.copysign(math.atan(rest or 0.0), -direction)
    tangent = double(square_root(tangent_squared))
    if direction < 0:
        return math.pi - math.atan(tangent or 0.0)
    return None if tangent is None else math.atan(tangent)

"""Conversion of an enclosure to a decimal numeral with proven digits."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

from flint import arb, fmpz

from core.balls import Undetermined

FEWEST_DIGITS, MOST_DIGITS = 16, 1000

SPARE_DIGITS = 4
"""Extra digits of the decimal expansion of a ball, beyond the printed ones."""

SHARE = 100
"""The radius of an enclosure may be at most one unit of the last printed digit divided by this number."""

FLOOR_IN_DIGITS = 2
"""Components are printed down to this multiple of the digits below the largest norm."""

DEEPEST = 2000
"""Decimal places below the largest norm down to which components known not to be zero are printed."""

_TEN = [fmpz(10) ** k for k in range(64)]


def decimal(ball: arb, digits: int, floor: int | None = None) -> str:
    """Return `digits` significant digits of the number in a ball.

    The numeral differs from the number by at most 0.51 units of its last digit: half a unit by rounding to nearest, the
    rest by the radius of the ball.

    Parameters
    ----------
    ball : arb
    digits : int
    floor : int, optional
        No digit is printed below the place ``10**floor``. Without it, a number that is zero but not known to be zero
        could not be printed; with it, the number reads ``"0e-60"``. A ball that is exactly zero reads ``"0"``.

    Raises
    ------
    Undetermined
        If the ball does not determine the digits.
    """
    if ball.is_zero():
        return "0"
    if not ball.is_finite():
        raise Undetermined
    if floor is not None and abs(ball) < _far_below(floor):
        # Without a decimal expansion, which for a number like exp(-10^9) would have 10^9 digits.
        return f"0e{floor}"
    mid, rad, exponent = ball.mid_rad_10exp(digits + SPARE_DIGITS)
    negative = mid < 0
    size = -mid if negative else mid
    written = str(size)
    place = len(written) - digits + int(exponent)
    if floor is not None and place < floor:
        place = floor
    drop = place - int(exponent)
    if drop < 0 or (size == 0 and floor is None):
        raise Undetermined
    unit = _power_of_ten(drop)
    if SHARE * rad > unit:
        raise Undetermined
    return numeral(int((size + unit // 2) // unit), place, digits, negative)


def decimals(row: Sequence[arb], digits: int, floor: int | None = None) -> list[str]:
    """Return `decimal` of every entry."""
    return [decimal(ball, digits, floor) for ball in row]


def decimal_of_fraction(number: Fraction, digits: int) -> str:
    """Return a rational number rounded to `digits` significant digits."""
    if number == 0:
        return "0"
    size = abs(number)
    # 30103/100000 is log10(2) to five digits, which is accurate to one place; the loop corrects it.
    place = (size.numerator.bit_length() - size.denominator.bit_length()) * 30103 // 100000 - digits
    while True:
        top, bottom = size.numerator * 10 ** max(0, -place), size.denominator * 10 ** max(0, place)
        if top < bottom * 10**digits:
            break
        place += 1
    whole, rest = divmod(top, bottom)
    if 2 * rest > bottom or (2 * rest == bottom and whole % 2):
        whole += 1
    return numeral(whole, place, digits, number < 0)


def numeral(whole: int, place: int, digits: int, negative: bool) -> str:
    """Write ``whole * 10**place``, without an exponent if this needs few zeros, otherwise with one."""
    if whole == 0:
        return f"0e{place}"
    written = str(whole)
    if len(written) > digits:
        # Rounding has carried into a new digit, so the last digit is zero.
        written, place = written[:-1], place + 1
    sign = "-" if negative else ""
    exponent = len(written) - 1 + place
    if -5 < exponent < 0:
        return f"{sign}0.{'0' * (-exponent - 1)}{written}"
    if place <= 0 <= exponent:
        point = exponent + 1
        return f"{sign}{written[:point]}.{written[point:]}" if place else sign + written
    fraction = f".{written[1:]}" if len(written) > 1 else ""
    return f"{sign}{written[0]}{fraction}e{exponent}"


@lru_cache(maxsize=64)
def _far_below(floor: int) -> arb:
    """Return an exact number that is a hundredth of the last place or slightly less."""
    return (arb(10) ** (floor - 2)).lower()


def place_of(size: arb) -> int:
    """Return the decimal exponent of a positive number, to within one."""
    mid, _, exponent = size.mid_rad_10exp(3)
    return len(str(mid)) - 1 + int(exponent)


def floor_below(size: arb, digits: int) -> int:
    """Return the last printed place of the components of a vector whose largest norm is `size`."""
    return place_of(size) - FLOOR_IN_DIGITS * digits


def _power_of_ten(exponent: int) -> fmpz:
    return _TEN[exponent] if exponent < len(_TEN) else fmpz(10) ** exponent

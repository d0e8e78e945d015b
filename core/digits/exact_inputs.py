"""Exact inputs: a double is the rational number that it represents, "0.1" is one tenth."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from math import inf, isfinite
from numbers import Real

from flint import arb, fmpq

from core.errors import InvalidParameter, Path

LONGEST_NUMERAL = 1100
"""Largest length of a decimal string: a thousand digits, a point and an exponent."""

LARGEST_EXPONENT = 1000
"""Largest exponent of ten: the memory for the power is proportional to it."""

NUMERAL = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE]([+-]?[0-9]{1,5}))?"
"""A decimal string, as a regular expression."""
_NUMERAL = re.compile(NUMERAL)

Number = float | int | str | Fraction


def exact(number: Number, path: str | Path) -> Fraction:
    """Return a double, an integer, a fraction or a decimal string as a rational number, without rounding.

    Raises
    ------
    InvalidParameter
        For infinities and NaN, for strings that are not plain decimal numerals or that are too long.
    """
    if isinstance(number, Fraction):
        return number
    if isinstance(number, str):
        return _read(number, path)
    if isinstance(number, bool) or not isinstance(number, Real):
        raise InvalidParameter(path, "be a number or a decimal string")
    if not isfinite(number):
        raise InvalidParameter(path, "be finite")
    return Fraction(number)


def exact_numbers(numbers: Sequence[Number], path: Path, count: int | None = None) -> tuple[Fraction, ...]:
    """Return every entry of a list as a rational number.

    Raises
    ------
    InvalidParameter
        If an entry is not a number, or the list does not have `count` entries.
    """
    if isinstance(numbers, str) or not isinstance(numbers, Sequence):
        raise InvalidParameter(path, "be a list")
    if count is not None and len(numbers) != count:
        raise InvalidParameter(path, f"have {count} entries, not {len(numbers)}")
    return tuple(exact(number, (*path, i)) for i, number in enumerate(numbers))


def evenly_spaced(start: Fraction, stop: Fraction, count: int) -> tuple[Fraction, ...]:
    """Return `count` numbers at exactly equal distances, both ends included; if it is 1, the start."""
    if count == 1:
        return (start,)
    step = (stop - start) / (count - 1)
    return tuple(start + i * step for i in range(count))


def enclosed(number: Fraction) -> arb:
    """Return a ball of the current precision around a rational number, of radius zero where it is dyadic and short."""
    return arb(fmpq(number.numerator, number.denominator))


def nearest(number: Fraction) -> float:
    """Return the nearest double, infinite beyond the largest."""
    try:
        return float(number)
    except OverflowError:
        return inf if number > 0 else -inf


def _read(numeral: str, path: str | Path) -> Fraction:
    if len(numeral) > LONGEST_NUMERAL:
        raise InvalidParameter(path, f"have at most {LONGEST_NUMERAL} characters, not {len(numeral)}")
    matched = _NUMERAL.fullmatch(numeral)
    if matched is None:
        raise InvalidParameter(path, "be a decimal number", remedy='for example "0.1", "-12.5" or "6.02e23"')
    if matched[1] is not None and abs(int(matched[1])) > LARGEST_EXPONENT:
        raise InvalidParameter(path, f"have an exponent between -{LARGEST_EXPONENT} and {LARGEST_EXPONENT}")
    return Fraction(numeral)

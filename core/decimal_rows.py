"""Rows of decimal numbers read from text, correctly rounded, without an object per number; compiled.

A number of at most 19 significant digits is an integer of 64 bits times a power of ten. Their product is formed with
106 bits; where those leave open which double is nearest (the number lies at or very near to the middle between two
doubles, or has more digits, or an exponent far from zero), Python's own conversion decides.

References
----------
The grammar is that of RFC 8259, sections 5 and 6. The test by which a rounding is known to be right although its
operand is not exact is that of A. Ziv, "Fast evaluation of elementary mathematical functions with correctly rounded
last bit", ACM Transactions on Mathematical Software 17 (1991) 410-423.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import dd_mul

FARTHEST = 250
"""Powers of ten up to this, and their inverses: no low part of a product leaves the normal range."""

MOST_DIGITS = 19
"""Significant digits that fit into 64 bits."""

LONGEST = 1000
"""Characters of a number; longer ones are nothing that a measurement or a program wrote."""

MOST_OPEN = 16
"""Characters of text per number that may be left to Python; numbers of many digits have more."""

MARGIN = 2.0**-100
"""More than the relative error of a product: 2^-106 of the power of ten and 2^-104 of the multiplication."""

WHOLE = 2**53
"""Integers up to this are doubles."""

_INVALID, _WHOLE, _REAL, _OPEN = -1, 0, 1, 2
_MINUS, _PLUS, _POINT, _ZERO, _NINE = ord("-"), ord("+"), ord("."), ord("0"), ord("9")
_OPENING, _CLOSING, _COMMA = ord("["), ord("]"), ord(",")


def _powers() -> NDArray[np.float64]:
    """Return 10^k, k from -FARTHEST to FARTHEST, as pairs of doubles, shape (n, 2)."""
    table = np.empty((2 * FARTHEST + 1, 2))
    for k in range(-FARTHEST, FARTHEST + 1):
        power = Fraction(10) ** k
        high = float(power)
        table[k + FARTHEST] = high, float(power - Fraction(high))
    return table


POWERS = _powers()


@kernel()
def _blank(text: NDArray[np.uint8], i: int) -> int:
    """Return the place of the next character that is no white space."""
    while i < text.size and (text[i] == 32 or text[i] == 10 or text[i] == 13 or text[i] == 9):
        i += 1
    return i


@kernel()
def _number(text: NDArray[np.uint8], i: int, powers: NDArray[np.float64]) -> tuple[int, int, float]:
    """Return the place after the number that begins at `i`, what it is, and its value unless that is open."""
    end, start = text.size, i
    negative = text[i] == _MINUS
    if negative:
        i += 1
    if i >= end or text[i] < _ZERO or text[i] > _NINE:
        return i, _INVALID, 0.0
    mantissa, digits, exponent, what = np.uint64(0), 0, 0, _WHOLE
    if text[i] == _ZERO:
        i += 1
    else:
        while i < end and _ZERO <= text[i] <= _NINE:
            mantissa = mantissa * np.uint64(10) + np.uint64(text[i] - _ZERO)
            digits += 1
            i += 1
    if i < end and text[i] == _POINT:
        what = _REAL
        i += 1
        first = i
        while i < end and _ZERO <= text[i] <= _NINE:
            mantissa = mantissa * np.uint64(10) + np.uint64(text[i] - _ZERO)
            if mantissa != 0 or digits:
                digits += 1
            i += 1
        if i == first:
            return i, _INVALID, 0.0
        exponent = first - i
    if i < end and (text[i] | 32) == 101:
        what = _REAL
        i += 1
        below = i < end and text[i] == _MINUS
        if i < end and (text[i] == _MINUS or text[i] == _PLUS):
            i += 1
        first, power = i, 0
        while i < end and _ZERO <= text[i] <= _NINE:
            power = min(10 * power + (text[i] - _ZERO), 1_000_000)
            i += 1
        if i == first:
            return i, _INVALID, 0.0
        exponent += -power if below else power
    if i - start > LONGEST:
        return i, _INVALID, 0.0
    if digits > MOST_DIGITS:
        return i, _OPEN, 0.0
    if mantissa == 0:
        # An integer has no negative zero.
        return i, what, -0.0 if negative and what == _REAL else 0.0
    if what == _WHOLE and mantissa > WHOLE:
        what = _REAL
    if abs(exponent) > FARTHEST:
        return i, _OPEN, 0.0
    near = float(mantissa)
    rest = float(np.int64(mantissa - np.uint64(near)))
    high, low = dd_mul(near, rest, powers[exponent + FARTHEST, 0], powers[exponent + FARTHEST, 1])
    least, most = high + (low - MARGIN * high), high + (low + MARGIN * high)
    if least != most:
        return i, _OPEN, 0.0
    return i, what, -least if negative else least


@kernel("Tuple((int64, int64, int64, int64, boolean))(Array(uint8, 1, 'C', readonly=True), int64, float64[::1], "
        "int64[:, ::1], float64[:, ::1])")  # fmt: skip
def _read(
    text: NDArray[np.uint8],
    i: int,
    values: NDArray[np.float64],
    still_open: NDArray[np.int64],
    powers: NDArray[np.float64],
) -> tuple[int, int, int, int, bool]:
    """Fill `values` from the array that begins at `i`.

    Returns the place after it, or -1 if it is anything but numbers or rows of equally many; how many numbers it has;
    how many are in a row, 0 for a plain list; of how many the value is still open, their place among the values and in
    the text in `still_open`; and whether all are integers that doubles hold.
    """
    failed = (-1, 0, 0, 0, False)
    end, count, width, opened, whole = text.size, 0, 0, 0, True
    i = _blank(text, i + 1)
    if i >= end:
        return failed
    nested = text[i] == _OPENING
    in_row = 0
    if nested:
        i = _blank(text, i + 1)
    while i < end:
        if count == values.size:
            return failed
        start = i
        i, what, value = _number(text, i, powers)
        if what == _INVALID:
            return failed
        if what == _OPEN:
            if opened == len(still_open):
                return failed
            still_open[opened, 0], still_open[opened, 1], still_open[opened, 2] = count, start, i
            opened += 1
        whole = whole and what == _WHOLE
        values[count] = value
        count += 1
        in_row += 1
        i = _blank(text, i)
        if i >= end:
            return failed
        if nested and text[i] == _CLOSING:
            if width == 0:
                width = in_row
            if in_row != width:
                return failed
            in_row = 0
            i = _blank(text, i + 1)
            if i >= end:
                return failed
            if text[i] == _CLOSING:
                return i + 1, count, width, opened, whole
            if text[i] != _COMMA:
                return failed
            i = _blank(text, i + 1)
            if i >= end or text[i] != _OPENING:
                return failed
        elif text[i] == _CLOSING:
            return i + 1, count, 0, opened, whole
        elif text[i] != _COMMA:
            return failed
        i = _blank(text, i + 1)
    return failed


@dataclass(frozen=True)
class DecimalRows:
    """An array that was read.

    Attributes
    ----------
    values : ndarray, shape (n, k) or (n,)
        int64 if every number was written as an integer and doubles hold it, otherwise float64.
    end : int
        Place after it in the text.
    """

    values: NDArray[Any]
    end: int


def read_rows(text: bytes, start: int) -> DecimalRows | None:
    """Read the array of numbers, or of rows of equally many numbers, whose opening bracket is at `start`.

    Returns None where the text has anything else, so that it must be looked at in another way to know what is wrong.
    """
    codes = np.frombuffer(text, np.uint8)
    # Of this only what is filled takes memory.
    values = np.empty((len(text) - start) // 2 + 1)
    still_open = np.empty(((len(text) - start) // MOST_OPEN + 16, 3), np.int64)
    end, count, width, opened, whole = _read(codes, start, values, still_open, POWERS)
    if end < 0:
        return None
    for place, first, after in still_open[:opened].tolist():
        values[place] = float(text[first:after])
    found = values[:count].astype(np.int64 if whole else np.float64)
    return DecimalRows(found.reshape(-1, width) if width else found, end)

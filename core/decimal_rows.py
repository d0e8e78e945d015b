"""Rows of decimal numbers read from text, correctly rounded, without an object per number; compiled.

The first 19 significant digits of a number are an integer of 64 bits, to be multiplied by a power of ten. The product
is formed with 106 bits; where those leave open which double is nearest (the number lies at or very near to the middle
between two doubles, or its exponent is far from zero), Python's own conversion decides.

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

MOST_OPEN = 64
"""Characters of text for each number that may be left to Python, which takes ten times as long."""

MARGIN = 2.0**-100
"""More than the relative error of a product: 2^-106 of the power of ten and 2^-104 of the multiplication."""

WHOLE = 2**53
"""Integers up to this are doubles."""

_INVALID, _WHOLE, _REAL, _OPEN, _LARGE = -1, 0, 1, 2, 3
_MINUS, _PLUS, _POINT, _ZERO, _NINE = ord("-"), ord("+"), ord("."), ord("0"), ord("9")
_OPENING, _CLOSING, _BRACE, _COMMA, _QUOTE = ord("["), ord("]"), ord("{"), ord(","), ord('"')


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
def _times_power(mantissa: np.uint64, powers: NDArray[np.float64], exponent: int) -> tuple[float, float]:
    """Return an integer of 64 bits times 10^exponent, as a pair."""
    near = float(mantissa)
    rest = float(np.int64(mantissa - np.uint64(near)))
    return dd_mul(near, rest, powers[exponent + FARTHEST, 0], powers[exponent + FARTHEST, 1])


@kernel()
def _number(text: NDArray[np.uint8], i: int, powers: NDArray[np.float64]) -> tuple[int, int, float]:
    """Return the place after the number that begins at `i`, what it is, and its value unless that is open."""
    end, start = text.size, i
    negative = text[i] == _MINUS
    if negative:
        i += 1
    if i >= end or text[i] < _ZERO or text[i] > _NINE:
        return i, _INVALID, 0.0
    mantissa, digits, exponent, what, longer = np.uint64(0), 0, 0, _WHOLE, False
    if text[i] == _ZERO:
        i += 1
    else:
        while i < end and _ZERO <= text[i] <= _NINE:
            if digits < MOST_DIGITS:
                mantissa = mantissa * np.uint64(10) + np.uint64(text[i] - _ZERO)
                digits += 1
            else:
                longer = longer or text[i] != _ZERO
                exponent += 1
            i += 1
    if i < end and text[i] == _POINT:
        what = _REAL
        i += 1
        first = i
        while i < end and _ZERO <= text[i] <= _NINE:
            if digits < MOST_DIGITS:
                mantissa = mantissa * np.uint64(10) + np.uint64(text[i] - _ZERO)
                digits += mantissa != 0
                exponent -= 1
            else:
                longer = longer or text[i] != _ZERO
            i += 1
        if i == first:
            return i, _INVALID, 0.0
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
    if mantissa == 0:
        # An integer has no negative zero.
        return i, what, -0.0 if negative and what == _REAL else 0.0
    if what == _WHOLE and (mantissa > WHOLE or exponent):
        what = _LARGE
    if abs(exponent) > FARTHEST:
        return i, _OPEN, 0.0
    high, low = _times_power(mantissa, powers, exponent)
    least, most = high + (low - MARGIN * high), high + (low + MARGIN * high)
    if longer:
        # The digits left out make it anything up to the next integer.
        high, low = _times_power(mantissa + np.uint64(1), powers, exponent)
        most = high + (low + MARGIN * high)
    if least != most:
        return i, _OPEN, 0.0
    return i, what, -most if negative else most


@kernel("int64(Array(uint8, 1, 'C', readonly=True), int64)")
def _after(text: NDArray[np.uint8], i: int) -> int:
    """Return the place after the value that begins at `i`, in a text without escapes; -1 if it does not end."""
    depth, quoted = 0, False
    while i < text.size:
        code = text[i]
        if code == _QUOTE:
            quoted = not quoted
        elif not quoted:
            if code in (_OPENING, _BRACE):
                depth += 1
            elif code == _CLOSING or code == _BRACE + 2:
                if depth == 0:
                    return i
                depth -= 1
                if depth == 0:
                    return i + 1
            elif code == _COMMA and depth == 0:
                return i
        i += 1
    return -1


@kernel("Tuple((int64, int64, int64, int64, boolean))(Array(uint8, 1, 'C', readonly=True), int64, boolean, "
        "float64[::1], int64[:, ::1], float64[:, ::1])")  # fmt: skip
def _read(
    text: NDArray[np.uint8],
    i: int,
    whole: bool,
    values: NDArray[np.float64],
    still_open: NDArray[np.int64],
    powers: NDArray[np.float64],
) -> tuple[int, int, int, int, bool]:
    """Fill `values` from the array that begins at `i`.

    Returns the place after it; how many numbers it has; how many are in a row, 0 for a plain list; of how many the
    value is still open, their place among the values and in the text in `still_open`; and whether all are integers.
    The place is -1 if the array has anything else, and -2 - k if it is the row or entry at k that is wrong in a way
    that no continuation can mend: no number, or rows of unequal length. The numbers are then those before it.
    """
    failed = (-1, 0, 0, 0, False)
    end, count, width, opened, integers = text.size, 0, 0, 0, True
    i = _blank(text, i + 1)
    if i >= end:
        return failed
    nested = text[i] == _OPENING
    row, in_row = i, 0
    if nested:
        i = _blank(text, i + 1)
    while i < end:
        if count == values.size:
            return failed
        start = i
        if not nested:
            row = i
        code = text[i]
        if code in (_QUOTE, _OPENING, _BRACE) or code == 110 or code == 116 or code == 102:
            return -2 - row, count - in_row if nested else count, width, opened, integers
        i, what, value = _number(text, i, powers)
        if what == _INVALID or (whole and what != _WHOLE and what != _REAL):
            return failed
        if whole and what == _REAL:
            return -2 - row, count - in_row if nested else count, width, opened, integers
        if what == _OPEN:
            if opened == len(still_open):
                return failed
            still_open[opened, 0], still_open[opened, 1], still_open[opened, 2] = count, start, i
            opened += 1
        integers = integers and what == _WHOLE
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
                return -2 - row, count - in_row, width, opened, integers
            in_row = 0
            i = _blank(text, i + 1)
            if i >= end:
                return failed
            if text[i] == _CLOSING:
                return i + 1, count, width, opened, integers
            if text[i] != _COMMA:
                return failed
            i = row = _blank(text, i + 1)
            if i >= end or text[i] == _CLOSING:
                return failed
            if text[i] != _OPENING:
                return -2 - row, count, width, opened, integers
        elif text[i] == _CLOSING:
            return i + 1, count, 0, opened, integers
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
    wrong : bytes or None
        Text of the first row or entry that no array of such numbers can have; the values are then those before it.
    """

    values: NDArray[Any]
    end: int
    wrong: bytes | None = None


def read_rows(text: bytes, start: int, *, whole: bool = False) -> DecimalRows | None:
    """Read the array of numbers, or of rows of equally many numbers, whose opening bracket is at `start`.

    Returns None where the text has to be looked at in another way: where it is no JSON, or has numbers of unusual form.

    Parameters
    ----------
    text : bytes
        Without a backslash.
    whole : bool
        Whether a number with a point or an exponent is wrong.
    """
    codes = np.frombuffer(text, np.uint8)
    # Of this only what is filled takes memory.
    values = np.empty((len(text) - start) // 2 + 1)
    still_open = np.empty(((len(text) - start) // MOST_OPEN + 16, 3), np.int64)
    end, count, width, opened, integers = _read(codes, start, whole, values, still_open, POWERS)
    wrong = None
    if end < -1:
        first, end = -2 - end, _after(codes, start)
        after = _after(codes, first)
        wrong = text[first:after]
        if not start < first < after < end:
            return None
    if end < 0:
        return None
    for place, first, after in still_open[:opened].tolist():
        if place < count:
            values[place] = float(text[first:after])
    found = values[:count].astype(np.int64 if integers else np.float64)
    return DecimalRows(found.reshape(-1, width) if width else found, end, wrong)

"""Where a step of a series ends at a corner of a formula: a zero of a length or root."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import dd_mul, dd_mul_d
from core.multibody.algebra.bernstein import (
    FALLING,
    MOST_SEGMENTS,
    NEGATIVE,
    POSITIVE,
    RISING,
    decided,
    horner,
    slope_at,
    zero_between,
)
from core.multibody.laws.kernel import AT_ZERO, LENGTH, MULTIPLY, POWER, ROOT, PackedLaws, leading_power

KNOWN = 2.0**-50
"""Share of its largest term to which a series is known in doubles."""


@kernel()
def _along_a_line(values: Floats, operation: Integers) -> int:
    """Return the only component of a vector that is not zero for good, -1 where there are more or none."""
    found = -1
    for part in operation[1:4]:
        for k in range(values.shape[1]):
            if values[part, k, 0] != 0.0:
                if found >= 0 and found != part:
                    return -1
                found = part
                break
    return found


@kernel()
def _vanishes(values: Floats, o: int) -> bool:
    """Return whether all coefficients of an operation are zero."""
    k, known = 0, values.shape[1] - 2
    while k < known and values[o, k, 0] == 0.0:
        k += 1
    return bool(k == known)


@kernel()
def _begins_later(values: Floats, o: int, a: int, b: int) -> bool:
    """Return whether a product of two series that do not vanish has no coefficient yet."""
    return _vanishes(values, o) and not _vanishes(values, a) and not _vanishes(values, b)


@kernel()
def _changes(values: Floats, part: int, sign: float, h: float, times: Floats) -> int:
    """Fill in the times in a step at which a series, which has a sign, changes it; return how many.

    What is shallower than its rounding is no change. A series that is on the other side at first has to pass to this
    one before: a step begins at a corner to rounding.
    """
    count = values.shape[1]
    scaled, ph, pl = np.empty((count, 2)), sign, 0.0
    for k in range(count):
        scaled[k, 0], scaled[k, 1] = dd_mul(values[part, k, 0], values[part, k, 1], ph, pl)
        ph, pl = dd_mul_d(ph, pl, h)
    largest = np.max(np.abs(scaled))
    if not 0.0 < largest < math.inf:
        return 0
    ends, signs, band = np.empty(MOST_SEGMENTS), np.empty(MOST_SEGMENTS, dtype=np.int64), KNOWN * np.abs(scaled[:, 0])
    band[0] = KNOWN * largest
    segments = decided(scaled, band, 0.0, count, 1.0, ends, signs, False)
    found, side, low, since = 0, 0 if signs[0] in (NEGATIVE, RISING) else 1, 0.0, 0.0
    for segment in range(segments):
        one = signs[segment]
        begins = -1 if one in (NEGATIVE, RISING) else 1 if one in (POSITIVE, FALLING) else 0
        if begins != 0:
            if side * begins < 0:
                th, tl = zero_between(scaled, since, low)
                times[found], found = h * (th + tl), found + 1
            side = begins if side != 0 or begins > 0 else 0
            if one in (FALLING, RISING):
                if side != 0:
                    th, tl = zero_between(scaled, low, ends[segment])
                    times[found], found = h * (th + tl), found + 1
                side = 1 if one == RISING else -1
            since = ends[segment]
        low = ends[segment]
    return found


@kernel()
def _first_change(values: Floats, part: int, sign: float, h: float) -> float:
    """Return the first time in a step at which a series no longer has a sign; beyond the step where it keeps it."""
    times = np.empty(2 * MOST_SEGMENTS)
    return float(times[0]) if _changes(values, part, sign, h, times) > 0 else 2.0 * h


@kernel()
def _side(values: Floats, part: int, leading: int, way: float) -> float:
    """Return the sign that a series takes after its start, where powers below `leading` are rounding."""
    for k in range(leading, values.shape[1]):
        if values[part, k, 0] != 0.0:
            return math.copysign(1.0, values[part, k, 0] * (way if k % 2 == 1 else 1.0))
    return 0.0


@kernel()
def _first_return(values: Floats, operation: Integers, h: float, leading: int) -> float:
    """Return the first time in a step at which a vector turns back at zero, to rounding; beyond the step for none.

    A component at least changes its sign there.
    """
    best, times = 2.0 * h, np.empty(2 * MOST_SEGMENTS)
    for part in operation[1:4]:
        sign = _side(values, part, leading, math.copysign(1.0, h))
        for found in times[: _changes(values, part, sign, h, times)]:
            square, change = 0.0, 0.0
            for other in operation[1:4]:
                # Beside another zero it rises so little that doubles do not tell it from its rounding.
                value, rate = horner(values[other], found, 0.0)[0], slope_at(values[other], found)
                square, change = square + value**2, change + rate**2
            if abs(found) < abs(best) and square <= AT_ZERO**2 * change:
                best = found
    return best


@kernel()
def until_corner(laws: PackedLaws, values: Floats, h: float) -> float:
    """Return the part of a step up to the first corner of a formula, a zero of a length or root; else the step.

    It is not a number where a product begins beyond the order of the series, which then says nothing of it.
    """
    best = h
    for o in range(laws.operations.shape[0]):
        operation = laws.operations[o]
        code = operation[0]
        if code == MULTIPLY and _begins_later(values, o, operation[1], operation[2]):
            return math.nan
        if code in (ROOT, POWER):
            # Beyond a double zero of its argument the series is that of the other branch, which is negative.
            found = _first_change(values, o, 1.0, h)
        elif code == LENGTH:
            part = _along_a_line(values, operation)
            leading = leading_power(values, operation, values.shape[1] - 3)
            if part < 0:
                found = _first_return(values, operation, h, leading)
            else:
                found = _first_change(values, part, values[o, leading, 0] * values[part, leading, 0], h)
        else:
            continue
        if abs(found) < abs(best):
            best = found
    return best

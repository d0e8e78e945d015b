"""Where a step of a series ends before a corner of a formula: a zero of a length or root, or of what a sign sees."""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import Pair
from core.multibody.laws.kernel import AT_ZERO, LENGTH, MULTIPLY, POWER, ROOT, SIGN, PackedLaws, leading_power

PROBES, HALVINGS = 16, 54
"""Times in a step at which a corner is sought first, and halvings of the time between two: those of doubles."""

DEEPEST = 40
"""Halvings of a step down to which a sign is sought: what changes twice within less is below the resolution of time."""

ROUNDED = 2.0**-47
"""Share of its largest coefficient to which a series is known in doubles after its terms are summed up."""

SHORT_OF, NEARBY = 2.0**-46, 2.0**-42
"""Share by which a step ends before the change of a sign, and share of a step from which on a change is that near."""

TRUNCATED = 2.0**-56
"""Share of its largest term that the last term of an argument may be: a change of its sign is then seen in time."""

TOGETHER = 2.0**-48
"""Share of a step within which corners are one: what they are apart by rounding."""


@kernel()
def _value(values: Floats, part: int, time: float) -> float:
    """Return a series at a time, in doubles."""
    total = 0.0
    for k in range(values.shape[1] - 1, -1, -1):
        total = total * time + values[part, k, 0]
    return total


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
def _bernstein(values: Floats, part: int, sign: float, h: float) -> Floats:
    """Return the coefficients of a series on a step in Bernstein's form, between which its values lie."""
    n = values.shape[1] - 1
    found = np.empty(n + 1)
    scale, ways = sign, 1.0
    for k in range(n + 1):
        found[k] = values[part, k, 0] * scale / ways
        scale *= h
        ways *= (n - k) / (k + 1.0)
    for i in range(1, n + 1):
        for j in range(n, i - 1, -1):
            found[j] += found[j - 1]
    return found


@kernel()
def _split(left: Floats, right: Floats) -> None:
    """Split coefficients in `left` into those of the two halves (de Casteljau)."""
    n = len(left) - 1
    right[n] = left[n]
    for i in range(1, n + 1):
        for j in range(n, i - 1, -1):
            left[j] = 0.5 * (left[j - 1] + left[j])
        right[n - i] = left[n]


@kernel()
def _first_seen(values: Floats, part: int, sign: float, h: float) -> float:
    """Return the first of some times in a step up to which a series has changed its sign, at its zero."""
    low = 0.0
    for j in range(1, PROBES + 1):
        high = h * j / PROBES
        if sign * _value(values, part, high) < 0.0:
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                if sign * _value(values, part, middle) < 0.0:
                    high = middle
                else:
                    low = middle
            return high
        low = high
    return 2.0 * h


@kernel()
def _first_proven(values: Floats, part: int, sign: float, h: float) -> float:
    """Return the first time in a step at which a series no longer has a sign; beyond the step where it keeps it.

    What is shallower than its rounding is not seen. A series that begins on the other side has passed to this one
    first: its step began short of a corner.
    """
    n = values.shape[1] - 1
    stack, depths = np.empty((DEEPEST + 2, n + 1)), np.zeros(DEEPEST + 2, dtype=np.int64)
    stack[0] = _bernstein(values, part, sign, h)
    band = ROUNDED * np.max(np.abs(stack[0]))
    if not math.isfinite(band):
        return 2.0 * h
    begun = stack[0, 0] >= -band
    top, low = 0, 0.0
    while top >= 0:
        own, width = stack[top], h * 0.5 ** depths[top]
        on_one_side = np.min(own) >= -band if begun else np.max(own) < 0.0
        if not on_one_side and begun and own[n] < -band:
            high = low + width
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                if sign * _value(values, part, middle) < 0.0:
                    high = middle
                else:
                    low = middle
            return float(high)
        if on_one_side or depths[top] == DEEPEST:
            begun = begun or own[n] >= 0.0
            low += width
            top -= 1
            continue
        depths[top] += 1
        stack[top + 1], depths[top + 1] = own, depths[top]
        _split(stack[top + 1], stack[top])
        top += 1
    return 2.0 * h


@kernel()
def _first_change(values: Floats, part: int, sign: float, h: float) -> float:
    """Return the first time in a step at which a series no longer has a sign; beyond the step where it keeps it.

    Two changes may lie between the times at which it is seen.
    """
    seen, proven = _first_seen(values, part, sign, h), _first_proven(values, part, sign, h)
    return proven if abs(proven) < abs(seen) - TOGETHER * abs(h) else seen


@kernel()
def _value_and_rate(values: Floats, part: int, time: float) -> Pair:
    """Return a series and its derivative at a time, in doubles."""
    value, rate = 0.0, 0.0
    for k in range(values.shape[1] - 1, -1, -1):
        rate = rate * time + value
        value = value * time + values[part, k, 0]
    return value, rate


@kernel()
def _growth(values: Floats, operation: Integers, time: float) -> float:
    """Return how the square of a vector changes at a time: half its rate."""
    total = 0.0
    for part in operation[1:4]:
        value, rate = _value_and_rate(values, part, time)
        total += value * rate
    return total


@kernel()
def _first_return(values: Floats, operation: Integers, h: float, leading: int) -> float:
    """Return the first time in a step at which a vector is zero, to rounding; beyond the step where it is not."""
    low, way = 0.0, math.copysign(1.0, h)
    before = -1.0
    for j in range(1, PROBES + 1):
        high = h * j / PROBES
        now = way * _growth(values, operation, high)
        if before < 0.0 <= now and (j > 1 or (leading == 0 and way * _growth(values, operation, 0.0) < 0.0)):
            first, last = low, high
            for _ in range(HALVINGS):
                middle = 0.5 * (first + last)
                if way * _growth(values, operation, middle) < 0.0:
                    first = middle
                else:
                    last = middle
            square, change = 0.0, 0.0
            for part in operation[1:4]:
                value, rate = _value_and_rate(values, part, last)
                square, change = square + value**2, change + rate**2
            if square <= AT_ZERO**2 * change:
                return last
        low, before = high, now
    return 2.0 * h


@kernel()
def _resolved(values: Floats, part: int, h: float) -> float:
    """Return the part of a step over which the last coefficients of a series are small beside its largest term."""
    last = values.shape[1] - 3
    for _ in range(3):
        largest, power = 0.0, 1.0
        for k in range(last + 1):
            largest = max(largest, abs(values[part, k, 0]) * power)
            power *= abs(h)
        for k in (last, last - 1):
            term = abs(values[part, k, 0]) * abs(h) ** k
            if term > TRUNCATED * largest:
                h *= (TRUNCATED * largest / term) ** (1.0 / k)
    return h


@kernel()
def until_corner(laws: PackedLaws, values: Floats, h: float, course: Floats, since: float) -> float:
    """Return the part of a step up to the first corner of a formula; else the step.

    A length or root has a corner where it is zero, and so has what depends on a sign. It is not a number where a
    product begins beyond the order of the series, which then says nothing of it, or where a sign changes back at once.

    Of a sign that changes at the end of that part there is a mark in `course`: the sign that follows.

    Parameters
    ----------
    since : float
        Time of the start of the step, which is known to its last digits in pairs alone.
    """
    for o in range(laws.operations.shape[0]):
        if laws.operations[o, 0] == SIGN:
            h = _resolved(values, laws.operations[o, 1], h)
    best = h
    for o in range(laws.operations.shape[0]):
        operation, mark = laws.operations[o], course[1 + o]
        code = operation[0]
        if code == MULTIPLY and _begins_later(values, o, operation[1], operation[2]):
            return math.nan
        course[1 + o] = 0.0
        if code == SIGN:
            sign = values[o, 0, 0]
            if sign == 0.0:
                continue
            if mark != 0.0 and _turns_back(values, operation[1], sign, course[0]):
                return math.nan
            found, next_mark = _first_change(values, operation[1], sign, h), -sign
            if abs(found) > NEARBY * max(abs(h), abs(since)):
                # The rest of the way is short, and its end known to as many digits of it.
                found, next_mark = found * (1.0 - SHORT_OF), 0.0
        elif code in (ROOT, POWER):
            # Beyond a double zero of its argument the series is that of the other branch, which is negative.
            found, next_mark = _first_change(values, o, 1.0, h), 0.0
        elif code == LENGTH:
            part, next_mark = _along_a_line(values, operation), 0.0
            leading = leading_power(values, operation, values.shape[1] - 3)
            if part < 0:
                found = _first_return(values, operation, h, leading)
            else:
                found = _first_change(values, part, values[o, leading, 0] * values[part, leading, 0], h)
        else:
            continue
        if abs(found) > abs(h) or abs(found) > abs(best) + TOGETHER * abs(h):
            continue
        if abs(found) < abs(best) - TOGETHER * abs(h):
            course[1 : 1 + o] = 0.0
        course[1 + o] = next_mark
        best = found if abs(found) < abs(best) else best
    return best


@kernel()
def _turns_back(values: Floats, part: int, sign: float, way: float) -> bool:
    """Return whether what has just passed through zero goes back: its rate has the sign that it had before."""
    for k in range(1, values.shape[1]):
        if values[part, k, 0] != 0.0:
            return bool(sign * values[part, k, 0] * (way if k % 2 == 1 else 1.0) < 0.0)
    return False

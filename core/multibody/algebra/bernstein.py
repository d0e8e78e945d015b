"""Where a polynomial with a band of error is positive, negative, or zero: by its Bernstein coefficients, halved.

On an interval a polynomial lies between the least and the largest of its Bernstein coefficients, and it has exactly one
zero where they change their sign once. A polynomial that is known to an error e is above zero where all of them are
above e. Where that leaves it open the interval is halved by de Casteljau's scheme, until everything is decided, or
within a few times the band: there a zero cannot be told from a near miss.

References
----------
G. E. Collins, A. G. Akritas, "Polynomial real root isolation using Descartes' rule of signs", SYMSAC 1976.
J. M. Lane, R. F. Riesenfeld, "Bounds on a polynomial", BIT 21 (1981).
"""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_div_d, dd_mul

HALVINGS = 400
"""Deepest halving: a return to zero after 1e-100 of an interval is found, beside what began at its start."""
MOST_SEGMENTS = 200
"""Segments into which one polynomial may fall; what is left then is decided on a shorter interval."""
MOST_NODES = 20_000
"""Intervals on which one polynomial is looked at; twenty are halved towards each of its zeros a hundred times."""
WIDER = 4.0
"""Within this many times the band everything counts as undecided: above once it as decided, so that halving ends."""
_FILTER = 2.0**-44
"""Share of the terms by which doubles may be wrong: the sum of 400 roundings of 2^-53."""
_ROUNDED = 2.0**-101
"""Rounding of a Bernstein coefficient as a share of the terms, for each power: eight of pairs, as halves of halves."""
_BISECTIONS = 60
"""Halvings of the bracket of a zero: after them Newton's method starts with every digit of a double."""
_NEWTON = 3
"""Rounds of Newton's method in pairs, with the slope in doubles: each adds fifty bits."""


class Sign(IntEnum):
    """What is known of a polynomial on a segment."""

    NEGATIVE = -1
    UNDECIDED = 0
    """Within the band of what is known of the motion."""
    POSITIVE = 1
    FALLING = 2
    """From above zero to below it, once."""
    RISING = 3
    OPEN = 4
    """Within the band of what is left out of the polynomial: to be decided on a shorter interval."""


NEGATIVE, UNDECIDED, POSITIVE = int(Sign.NEGATIVE), int(Sign.UNDECIDED), int(Sign.POSITIVE)
FALLING, RISING, OPEN = int(Sign.FALLING), int(Sign.RISING), int(Sign.OPEN)
"""The same as whole numbers, for compiled code."""


@kernel()
def one_sign(coefficients: Floats, known: float, size: float) -> int:
    """Return POSITIVE or NEGATIVE where doubles show that a polynomial is beyond an error from 0 to 1, else UNDECIDED.

    Parameters
    ----------
    coefficients : (order + 1,)
        Of powers of time, lowest first.
    known : float
        Its error.
    size : float
        Sum of the terms, of which doubles round a share.
    """
    last = coefficients.shape[0] - 1
    found = np.empty(last + 1)
    share = 1.0
    for k in range(last + 1):
        # Divided by binomial coefficients, whose sums by Pascal's scheme are the Bernstein coefficients.
        found[k] = coefficients[k] / share
        share = share * (last - k) / (k + 1.0)
    for r in range(1, last + 1):
        for j in range(last, r - 1, -1):
            found[j] += found[j - 1]
    lowest, highest = found[0], found[0]
    for j in range(1, last + 1):
        lowest, highest = min(lowest, found[j]), max(highest, found[j])
    known += _FILTER * size
    if lowest > known:
        return POSITIVE
    return NEGATIVE if highest < -known else UNDECIDED


@kernel()
def bernstein(coefficients: Floats, found: Floats) -> None:
    """Fill in the Bernstein coefficients on [0, 1] of a polynomial, pairs of shape (order + 1, 2)."""
    last = coefficients.shape[0] - 1
    share = 1.0
    for k in range(last + 1):
        found[k, 0], found[k, 1] = dd_div_d(coefficients[k, 0], coefficients[k, 1], share)
        # Products of up to 25 bits and quotients without a rest: exact.
        share = share * (last - k) / (k + 1.0)
    for r in range(1, last + 1):
        for j in range(last, r - 1, -1):
            found[j, 0], found[j, 1] = dd_add(found[j, 0], found[j, 1], found[j - 1, 0], found[j - 1, 1])


@kernel()
def _halved(whole: Floats, right: Floats) -> None:
    """Replace Bernstein coefficients by those of the left half, and fill in those of the right one."""
    last = whole.shape[0] - 1
    right[last, 0], right[last, 1] = whole[last, 0], whole[last, 1]
    for r in range(1, last + 1):
        for j in range(last, r - 1, -1):
            sh, sl = dd_add(whole[j, 0], whole[j, 1], whole[j - 1, 0], whole[j - 1, 1])
            whole[j, 0], whole[j, 1] = 0.5 * sh, 0.5 * sl
        right[last - r, 0], right[last - r, 1] = whole[last, 0], whole[last, 1]


@kernel()
def _sign(own: Floats, band: float, steep: float, left_out: float) -> int:
    """Return what Bernstein coefficients say; MOST_SEGMENTS where they leave it open and halves may not.

    Parameters
    ----------
    band, steep : float
        Error of the coefficients, and of their differences.
    left_out : float
        Part of the band that is smaller on shorter intervals.
    """
    last = own.shape[0] - 1
    low, high = own[0, 0], own[0, 0]
    for j in range(1, last + 1):
        low, high = min(low, own[j, 0]), max(high, own[j, 0])
    if low > band:
        return POSITIVE
    if high < -band:
        return NEGATIVE
    if max(-low, high) <= WIDER * band:
        return OPEN if 2.0 * left_out > band else UNDECIDED
    if (own[0, 0] > band and own[last, 0] < -band) or (own[0, 0] < -band and own[last, 0] > band):
        sense = 1.0 if own[last, 0] > 0.0 else -1.0
        for j in range(last):
            step, _ = dd_add(own[j + 1, 0], own[j + 1, 1], -own[j, 0], -own[j, 1])
            if not sense * step > steep:
                return MOST_SEGMENTS
        return RISING if sense > 0.0 else FALLING
    return MOST_SEGMENTS


@kernel()
def decided(
    coefficients: Floats,
    band: Floats,
    left_out: float,
    power: int,
    reach: float,
    ends: Floats,
    signs: Integers,
    first: bool,
) -> int:
    """Fill in the segments of [0, 1] on which the sign of a polynomial is known, or known not to be; return how many.

    Parameters
    ----------
    coefficients : (order + 1, 2)
        Of powers of time, lowest first, as pairs.
    band : (order + 1,)
        Their errors.
    left_out : float
        Bound of the powers that are left out, at 1, and `power` the lowest of these.
    reach : float
        Where what is of interest ends.
    ends : (MOST_SEGMENTS,)
        Filled with the end of every segment; the next one begins there.
    signs : (MOST_SEGMENTS,)
    first : bool
        Whether nothing is wanted after the first segment that ends below zero.
    """
    count = coefficients.shape[0]
    whole = one_sign(coefficients[:, 0], left_out + np.sum(band), np.sum(np.abs(coefficients[:, 0])))
    if whole != UNDECIDED:
        ends[0], signs[0] = 1.0, whole
        return 1
    stack = np.empty((HALVINGS + 2, count, 2))
    ahead = np.empty((HALVINGS + 2, 2))
    bernstein(coefficients, stack[0])
    ahead[0, 0], ahead[0, 1] = 0.0, 1.0
    top, found, looked = 0, 0, 0
    while top >= 0:
        looked += 1
        low, high = ahead[top, 0], ahead[top, 1]
        if low >= reach:
            break
        width = high - low
        rest = left_out * high**power
        known, steep = rest, power * left_out * high ** (power - 1)
        size, at = 0.0, 1.0
        for k in range(count):
            known += band[k] * at
            size += abs(coefficients[k, 0]) * at
            at *= high
        at = 1.0
        for k in range(1, count):
            steep += k * band[k] * at
            at *= high
        rounded = _ROUNDED * count * size
        known += rounded
        own = stack[top]
        sign = _sign(own, known, steep * width / (count - 1.0) + 2.0 * rounded, rest)
        if sign == MOST_SEGMENTS:
            middle = 0.5 * (low + high)
            if looked < MOST_NODES and top < HALVINGS and low < middle < high:
                for j in range(count):
                    stack[top + 1, j, 0], stack[top + 1, j, 1] = own[j, 0], own[j, 1]
                _halved(stack[top + 1], stack[top])
                ahead[top, 0], ahead[top, 1] = middle, high
                ahead[top + 1, 0], ahead[top + 1, 1] = low, middle
                top += 1
                continue
            # A zero at the very end of an interval is in the band of both of its sides, however short these are.
            sign = UNDECIDED if looked < MOST_NODES and 2.0 * rest <= known else OPEN
        top -= 1
        crosses = sign in (FALLING, RISING)
        if found > 0 and signs[found - 1] == sign and not crosses:
            ends[found - 1] = high
        elif found == MOST_SEGMENTS - 1:
            ends[found], signs[found] = 1.0, OPEN
            return found + 1
        else:
            ends[found], signs[found] = high, sign
            found += 1
        if first and sign in (FALLING, NEGATIVE):
            break
    return found


@kernel()
def decided_each(
    coefficients: Floats,
    band: Floats,
    left_out: Floats,
    power: int,
    reach: Floats,
    first: bool,
    counts: Integers,
    ends: Floats,
    signs: Integers,
) -> None:
    """Do so for polynomials of shape (p, order + 1, 2): fill in counts, ends and signs, with a first axis p."""
    for p in range(coefficients.shape[0]):
        counts[p] = decided(coefficients[p], band[p], left_out[p], power, reach[p], ends[p], signs[p], first)


@kernel()
def horner(coefficients: Floats, th: float, tl: float) -> Pair:
    """Return a polynomial at a pair of time."""
    last = coefficients.shape[0] - 1
    sh, sl = coefficients[last, 0], coefficients[last, 1]
    for k in range(last - 1, -1, -1):
        sh, sl = dd_mul(sh, sl, th, tl)
        sh, sl = dd_add(sh, sl, coefficients[k, 0], coefficients[k, 1])
    return sh, sl


@kernel()
def slope_at(coefficients: Floats, time: float) -> float:
    """Return the derivative of a polynomial at a time, in doubles."""
    slope = 0.0
    for k in range(coefficients.shape[0] - 1, 0, -1):
        slope = slope * time + k * coefficients[k, 0]
    return slope


@kernel()
def zero_between(coefficients: Floats, low: float, high: float) -> Pair:
    """Return a zero of a polynomial between two times at which its signs differ: bisection, then Newton's method."""
    before = horner(coefficients, low, 0.0)[0]
    if before == 0.0:
        return low, 0.0
    left, right, size, at = low, high, 0.0, 1.0
    for k in range(coefficients.shape[0]):
        size += abs(coefficients[k, 0]) * at
        at *= max(1.0, abs(high))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (left + right)
        if not left < middle < right:
            break
        here = 0.0
        for k in range(coefficients.shape[0] - 1, -1, -1):
            here = here * middle + coefficients[k, 0]
        if abs(here) <= _FILTER * size:
            here = horner(coefficients, middle, 0.0)[0]
        if here * math.copysign(1.0, before) > 0.0:
            left = middle
        else:
            right = middle
    th, tl = 0.5 * (left + right), 0.0
    for _ in range(_NEWTON):
        slope = slope_at(coefficients, th)
        if slope == 0.0:
            break
        vh, vl = horner(coefficients, th, tl)
        dh, dl = dd_div_d(vh, vl, -slope)
        nh, nl = dd_add(th, tl, dh, dl)
        # A zero of several powers has no slope to speak of: bisection has found it as well as it is known.
        if not (low <= nh <= high and abs(dh) <= 4.0 * (right - left) + 2.0**-50 * abs(th)):
            break
        th, tl = nh, nl
    return th, tl

"""The Taylor coefficients of the values of formulas in pairs of doubles: one kernel, which interprets their tape.

It serves the series in doubles, too: there the low parts of the path are zero. Nothing is compiled for a scene.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import (
    Pair,
    dd_add,
    dd_div,
    dd_div_d,
    dd_exp,
    dd_mul,
    dd_mul_d,
    dd_sqrt,
)
from core.double_double_functions import MOST_EXPONENT, dd_asin, dd_atan2, dd_log, dd_sin_cos, dd_sinh_cosh
from core.multibody.algebra.pair_arrays import gathered, settled
from core.multibody.laws.tape import Op

NUMBER, PLACE, RATE, ADD, SUBTRACT, MULTIPLY, DIVIDE = map(
    int, (Op.NUMBER, Op.PLACE, Op.RATE, Op.ADD, Op.SUBTRACT, Op.MULTIPLY, Op.DIVIDE)
)
ROOT, EXP, SINE, COSINE, SINH, COSH = map(int, (Op.ROOT, Op.EXP, Op.SINE, Op.COSINE, Op.SINH, Op.COSH))
LOG, ASIN, ATAN, ATAN2, POWER, LENGTH = map(int, (Op.LOG, Op.ASIN, Op.ATAN, Op.ATAN2, Op.POWER, Op.LENGTH))
TANH, TANH_SLOPE = int(Op.TANH), int(Op.TANH_SLOPE)

LARGEST_TANGENT = 40.0
"""Argument from which on a hyperbolic tangent is one to pairs of doubles: it differs by 2 exp(-80)."""


AT_ZERO = 2.0**-44
"""Time in the units of a table within which a vector is at its zero. As the length is as small there, a force differs
by the square of this."""


class PackedLaws(NamedTuple):
    """The laws of a table for the kernels; the last axis of arrays of numbers is (value, tail).

    Attributes
    ----------
    operations : (o, 5)
    numbers : (c, 2)
    terms, terms_at : (t, 2) and (t,)
        Slopes of inputs and their coordinates.
    push, push_at : (p, 2) and (p, 2)
        Forces on a coordinate where an operation is one.
    gaps : int
        1 where powers of time may be missing between others of their series, 0 for polynomials in time.
    """

    operations: Integers
    numbers: Floats
    terms: Floats
    terms_at: Integers
    push: Floats
    push_at: Integers
    gaps: int


@kernel()
def _convolved(values: Floats, a: int, first: int, b: int, second: int, count: int) -> Pair:
    """Return the sum of `count` products of coefficients, upwards of the one series and downwards of the other."""
    sh, sl = 0.0, 0.0
    for j in range(count):
        sh, sl = gathered(
            sh, sl, values[a, first + j, 0], values[a, first + j, 1], values[b, second - j, 0], values[b, second - j, 1]
        )
    return settled(sh, sl)


@kernel()
def _integrated(values: Floats, a: int, b: int, k: int) -> Pair:
    """Return coefficient k of what changes by b times the change of a."""
    sh, sl = 0.0, 0.0
    for j in range(1, k + 1):
        ph, pl = dd_mul_d(values[a, j, 0], values[a, j, 1], float(j))
        sh, sl = gathered(sh, sl, ph, pl, values[b, k - j, 0], values[b, k - j, 1])
    sh, sl = settled(sh, sl)
    return dd_div_d(sh, sl, float(k))


@kernel()
def _root(values: Floats, own: int, leading: int, square: Pair, k: int) -> Pair:
    """Return coefficient k of a root whose first one that is not zero is that of power `leading`."""
    ph, pl = _convolved(values, own, leading + 1, own, k - 1, k - 1 - leading)
    sh, sl = dd_add(square[0], square[1], -ph, -pl)
    return dd_div(sh, sl, 2.0 * values[own, leading, 0], 2.0 * values[own, leading, 1])


@kernel()
def _square(values: Floats, operation: Integers, k: int) -> float:
    """Return the square of coefficient k of a vector."""
    a, b, c = values[operation[1], k, 0], values[operation[2], k, 0], values[operation[3], k, 0]
    return float(a * a + b * b + c * c)


@kernel()
def leading_power(values: Floats, operation: Integers, k: int) -> int:
    """Return the power up to k with which a vector begins to grow, one more where it does not."""
    leading = 0
    while leading <= k and _square(values, operation, leading) == 0.0:
        leading += 1
    # What has been followed to its zero has the rounding of it as its first coefficient.
    if leading == 0 < k and _square(values, operation, 0) < AT_ZERO**2 * _square(values, operation, 1):
        return 1
    return leading


@kernel()
def _length(values: Floats, own: int, operation: Integers, k: int, way: float) -> Pair:
    """Return coefficient k of the length of a vector, which may grow from zero: then as |t|^m with a power of time."""
    a, b, c = operation[1], operation[2], operation[3]
    leading = leading_power(values, operation, k)
    if leading > k:
        return 0.0, 0.0
    sh, sl = _convolved(values, a, leading, a, k, k - leading + 1)
    for part in (b, c):
        ph, pl = _convolved(values, part, leading, part, k, k - leading + 1)
        sh, sl = dd_add(sh, sl, ph, pl)
    if k > leading:
        return _root(values, own, leading, (sh, sl), k)
    sh, sl = dd_sqrt(sh, sl)
    return (-sh, -sl) if way < 0.0 and leading % 2 == 1 else (sh, sl)


@kernel()
def _power(values: Floats, laws: PackedLaws, own: int, a: int, b: int, k: int) -> Pair:
    """Return coefficient k of a constant power of a positive number."""
    eh, el = laws.numbers[b, 0], laws.numbers[b, 1]
    if k == 0:
        if not values[a, 0, 0] > 0.0:
            return math.nan, 0.0
        lh, ll = dd_log(values[a, 0, 0], values[a, 0, 1])
        lh, ll = dd_mul(lh, ll, eh, el)
        return dd_exp(lh, ll) if abs(lh) < MOST_EXPONENT else (0.0 if lh < 0.0 else math.nan, 0.0)
    sh, sl = 0.0, 0.0
    for j in range(1, k + 1):
        fh, fl = dd_mul_d(eh, el, float(j))
        fh, fl = dd_add(fh, fl, -float(k - j), 0.0)
        fh, fl = dd_mul(fh, fl, values[a, j, 0], values[a, j, 1])
        sh, sl = gathered(sh, sl, fh, fl, values[own, k - j, 0], values[own, k - j, 1])
    sh, sl = settled(sh, sl)
    dh, dl = dd_mul_d(values[a, 0, 0], values[a, 0, 1], float(k))
    return dd_div(sh, sl, dh, dl)


@kernel()
def _first(values: Floats, code: int, a: int, b: int) -> Pair:
    """Return the value of a function."""
    high, low = values[a, 0, 0], values[a, 0, 1]
    if code == ROOT:
        return dd_sqrt(high, low) if high > 0.0 else (0.0 if high == 0.0 else math.nan, 0.0)
    if code == EXP:
        # Below 1e-304 an exponential vanishes beside every number of a description.
        return dd_exp(high, low) if abs(high) < MOST_EXPONENT else (0.0 if high < 0.0 else math.nan, 0.0)
    if code == TANH:
        if abs(high) > LARGEST_TANGENT:
            return math.copysign(1.0, high), 0.0
        sh, sl, ch, cl = dd_sinh_cosh(high, low)
        return dd_div(sh, sl, ch, cl)
    if code == LOG:
        return dd_log(high, low) if high > 0.0 else (math.nan, 0.0)
    if code == ASIN:
        return dd_asin(high, low)
    if code == ATAN:
        return dd_atan2(high, low, 1.0, 0.0)
    return dd_atan2(high, low, values[b, 0, 0], values[b, 0, 1])


@kernel()
def _input(laws: PackedLaws, path: Floats, size: int, operation: Integers, k: int) -> Pair:
    """Return coefficient k of an input."""
    code, first, last = operation[0], operation[2], operation[3]
    sh, sl = 0.0, 0.0
    if code == PLACE and k == 0:
        sh, sl = laws.numbers[operation[1], 0], laws.numbers[operation[1], 1]
    power = k if code == PLACE else k + 1
    for t in range(first, last):
        at = power * size + laws.terms_at[t]
        high, low = path[0, at], path[1, at] if path.shape[0] == 2 else 0.0
        if code == RATE:
            high, low = dd_mul_d(high, low, k + 1.0)
        ph, pl = dd_mul(laws.terms[t, 0], laws.terms[t, 1], high, low)
        sh, sl = dd_add(sh, sl, ph, pl)
    return sh, sl


@kernel()
def values_of_laws(laws: PackedLaws, path: Floats, size: int, k: int, way: float, values: Floats) -> None:
    """Fill in coefficient k of every operation, the earlier ones being known.

    Parameters
    ----------
    path : (planes, orders * size)
        Coefficients of the coordinates, each order at k size, known up to k + 1.
    way : float
        Sign of the times that follow.
    values : (o, orders, 2)
    """
    for o in range(laws.operations.shape[0]):
        operation = laws.operations[o]
        code, a, b, c, d = operation[0], operation[1], operation[2], operation[3], operation[4]
        sh, sl = 0.0, 0.0
        if code == NUMBER:
            if k == 0:
                sh, sl = laws.numbers[a, 0], laws.numbers[a, 1]
        elif code <= RATE:
            sh, sl = _input(laws, path, size, operation, k)
        elif code == ADD:
            sh, sl = dd_add(values[a, k, 0], values[a, k, 1], values[b, k, 0], values[b, k, 1])
        elif code == SUBTRACT:
            sh, sl = dd_add(values[a, k, 0], values[a, k, 1], -values[b, k, 0], -values[b, k, 1])
        elif code == MULTIPLY:
            sh, sl = _convolved(values, a, 0, b, k, k + 1)
        elif code == DIVIDE:
            ph, pl = _convolved(values, b, 1, o, k - 1, k)
            sh, sl = dd_add(values[a, k, 0], values[a, k, 1], -ph, -pl)
            sh, sl = dd_div(sh, sl, values[b, 0, 0], values[b, 0, 1])
        elif code == TANH_SLOPE:
            ph, pl = _convolved(values, o - 1, 0, o - 1, k, k + 1)
            sh, sl = dd_add(1.0 if k == 0 else 0.0, 0.0, -ph, -pl)
        elif code == LENGTH:
            sh, sl = _length(values, o, operation, k, way)
        elif code == POWER:
            sh, sl = _power(values, laws, o, a, b, k)
        elif code in (SINE, SINH):
            if k == 0:
                high, low = values[a, 0, 0], values[a, 0, 1]
                four = dd_sin_cos(high, low) if code == SINE else dd_sinh_cosh(high, low)
                sh, sl, values[o + 1, 0, 0], values[o + 1, 0, 1] = four
            else:
                sh, sl = _integrated(values, a, o + 1, k)
        elif code in (COSINE, COSH):
            if k == 0:
                continue
            sh, sl = _integrated(values, a, o - 1, k)
            if code == COSINE:
                sh, sl = -sh, -sl
        elif k == 0:
            sh, sl = _first(values, code, a, b)
        elif code == ROOT:
            sh, sl = _root(values, o, 0, (values[a, k, 0], values[a, k, 1]), k)
        elif code == EXP:
            sh, sl = _integrated(values, a, o, k)
        elif code == TANH:
            sh, sl = _integrated(values, a, o + 1, k)
        elif code == ATAN2:
            sh, sl = _integrated(values, a, c, k)
            ph, pl = _integrated(values, b, d, k)
            sh, sl = dd_add(sh, sl, ph, pl)
        else:
            sh, sl = _integrated(values, a, b, k)
        values[o, k, 0], values[o, k, 1] = sh, sl

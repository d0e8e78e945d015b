"""Numbers of 106 bits as unevaluated sums of two doubles, compiled.

A number is a pair (h, l) with h = fl(h + l). Every operation takes and returns such pairs, flattened, and has a
relative error of a few 2^-106 unless a low part falls below the normal range (so |h| between about 1e-290 and 1e290).

References
----------
M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
arithmetic", ACM Transactions on Mathematical Software 44 (2017), algorithms 3 to 18.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from core.compiled import bits_of, double_from_bits, fma, kernel

Pair = tuple[float, float]

PI: Pair = (3.141592653589793, 1.2246467991473532e-16)
LN2: Pair = (0.6931471805599453, 2.3190468138462996e-17)


@kernel()
def two_sum(a: float, b: float) -> Pair:
    """Return a + b exactly, as a pair."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


@kernel()
def fast_two_sum(a: float, b: float) -> Pair:
    """Return a + b exactly, as a pair; |a| >= |b| or a = 0."""
    s = a + b
    return s, b - (s - a)


@kernel()
def two_prod(a: float, b: float) -> Pair:
    """Return a * b exactly, as a pair."""
    p = a * b
    return p, fma(a, b, -p)


@kernel()
def dd_add(ah: float, al: float, bh: float, bl: float) -> Pair:
    """Return a + b."""
    sh, sl = two_sum(ah, bh)
    th, tl = two_sum(al, bl)
    vh, vl = fast_two_sum(sh, sl + th)
    return fast_two_sum(vh, tl + vl)


@kernel()
def dd_sub(ah: float, al: float, bh: float, bl: float) -> Pair:
    """Return a - b."""
    return dd_add(ah, al, -bh, -bl)


@kernel()
def dd_add_d(ah: float, al: float, b: float) -> Pair:
    """Return a + b for a double b."""
    sh, sl = two_sum(ah, b)
    return fast_two_sum(sh, al + sl)


@kernel()
def dd_mul(ah: float, al: float, bh: float, bl: float) -> Pair:
    """Return a * b."""
    ch, cl = two_prod(ah, bh)
    t = fma(al, bh, fma(ah, bl, al * bl))
    return fast_two_sum(ch, cl + t)


@kernel()
def dd_mul_d(ah: float, al: float, b: float) -> Pair:
    """Return a * b for a double b."""
    ch, cl = two_prod(ah, b)
    return fast_two_sum(ch, fma(al, b, cl))


@kernel()
def dd_sqr(ah: float, al: float) -> Pair:
    """Return a squared."""
    return dd_mul(ah, al, ah, al)


@kernel()
def dd_div(ah: float, al: float, bh: float, bl: float) -> Pair:
    """Return a / b."""
    q = ah / bh
    rh, rl = dd_mul_d(bh, bl, q)
    dh, dl = dd_add(ah, al, -rh, -rl)
    q2 = dh / bh
    rh, rl = dd_mul_d(bh, bl, q2)
    dh, dl = dd_add(dh, dl, -rh, -rl)
    s, e = fast_two_sum(q, q2)
    return fast_two_sum(s, e + dh / bh)


@kernel()
def dd_div_d(ah: float, al: float, b: float) -> Pair:
    """Return a / b for a double b."""
    q = ah / b
    return fast_two_sum(q, (fma(-q, b, ah) + al) / b)


@kernel()
def dd_sqrt(ah: float, al: float) -> Pair:
    """Return the square root of a >= 0."""
    if ah <= 0.0:
        return 0.0, 0.0
    s = math.sqrt(ah)
    # Corrections are multiplied by the inverse: division is slower, and the last digit of a correction has no effect.
    inverse = 0.5 / s
    rho = fma(-s, s, ah) + al
    sh, sl = fast_two_sum(s, rho * inverse)
    # One Newton step in pairs reduces the error of the step above (about 2^-104) below the rounding of a pair.
    ph, pl = dd_mul(sh, sl, sh, sl)
    dh, _ = dd_add(ah, al, -ph, -pl)
    return dd_add_d(sh, sl, dh * inverse)


@kernel()
def dd_exp(ah: float, al: float) -> Pair:
    """Return exp(a) for |a| < 700, to 8 + |a| units of 2^-106.

    The argument is reduced to |r| < ln(2)/512, and the Taylor series is summed to the twelfth power.
    """
    k = math.floor(ah / LN2[0] + 0.5)
    kh, kl = dd_mul_d(LN2[0], LN2[1], k)
    # With the third word of ln 2 the reduction is accurate to 2^-106 for k up to a thousand.
    rh, rl = dd_add(ah, al, -kh, -kl)
    rh, rl = dd_add_d(rh, rl, -k * 5.707708438416212e-34)
    rh, rl = rh / 256.0, rl / 256.0
    # s <- r/n (1 + s), so that s ends as exp(r) - 1. The terms from the sixth power on are multiplied by r^5/5!, so
    # doubles suffice for them.
    sh, sl = 0.0, 0.0
    for n in range(12, 5, -1):
        sh = rh / n * (1.0 + sh)
    for n in range(5, 0, -1):
        th, tl = dd_add_d(sh, sl, 1.0)
        th, tl = dd_mul(th, tl, rh, rl)
        sh, sl = dd_div_d(th, tl, float(n))
    for _ in range(8):
        # (1 + s)^2 - 1 = s (2 + s): squaring without cancellation.
        th, tl = dd_add_d(sh, sl, 2.0)
        sh, sl = dd_mul(th, tl, sh, sl)
    sh, sl = dd_add_d(sh, sl, 1.0)
    # In two steps, because 2^k may be outside the normal range although the product is not.
    half = int(k) // 2
    first, second = math.ldexp(1.0, half), math.ldexp(1.0, int(k) - half)
    return sh * first * second, sl * first * second


class Scaled(NamedTuple):
    """The number (high + low) 2^exponent, with 1/2 <= |high| < 1 or high = 0: no overflow, no underflow."""

    high: float
    low: float
    exponent: int


@kernel()
def _power(e: int) -> float:
    """Return 2^e for -1022 <= e <= 1023."""
    return double_from_bits((e + 1023) << 52)


@kernel()
def scaled(h: float, low: float, exponent: int) -> Scaled:
    """Return (h + low) 2^exponent, normalised."""
    if h == 0.0:
        return Scaled(0.0, 0.0, 0)
    e = ((bits_of(h) >> 52) & 0x7FF) - 1022
    if -1000 < e < 1000:
        f = _power(-e)
        return Scaled(h * f, low * f, exponent + e)
    # Near the ends of the range, 2^-e or h itself may be subnormal or overflow.
    m, e = math.frexp(h)
    return Scaled(m, math.ldexp(low, -e), exponent + e)


@kernel()
def sc_mul(a: Scaled, b: Scaled) -> Scaled:
    """Return a * b."""
    h, low = dd_mul(a.high, a.low, b.high, b.low)
    return scaled(h, low, a.exponent + b.exponent)


@kernel()
def sc_div(a: Scaled, b: Scaled) -> Scaled:
    """Return a / b."""
    h, low = dd_div(a.high, a.low, b.high, b.low)
    return scaled(h, low, a.exponent - b.exponent)


@kernel()
def sc_add(a: Scaled, b: Scaled) -> Scaled:
    """Return a + b."""
    if a.high == 0.0:
        return b
    if b.high == 0.0:
        return a
    if a.exponent < b.exponent:
        a, b = b, a
    shift = b.exponent - a.exponent
    if shift < -300:
        return a
    f = _power(shift)
    h, low = dd_add(a.high, a.low, b.high * f, b.low * f)
    return scaled(h, low, a.exponent)


@kernel()
def sc_neg(a: Scaled) -> Scaled:
    """Return -a."""
    return Scaled(-a.high, -a.low, a.exponent)


@kernel()
def sc_abs(a: Scaled) -> Scaled:
    """Return |a|."""
    return sc_neg(a) if a.high < 0.0 else a


@kernel()
def sc_sqrt(a: Scaled) -> Scaled:
    """Return the square root of a >= 0."""
    odd = a.exponent & 1
    f = 2.0 if odd else 1.0
    h, low = dd_sqrt(a.high * f, a.low * f)
    return scaled(h, low, (a.exponent - odd) >> 1)


@kernel()
def sc_pair(a: Scaled) -> Pair:
    """Return a as a pair of doubles; exact unless it is outside their range."""
    e = a.exponent
    if e < -1000 or e > 1000:
        half = e >> 1
        f, g = math.ldexp(1.0, max(half, -1074)), math.ldexp(1.0, max(e - half, -1074))
        return a.high * f * g, a.low * f * g
    f = _power(e)
    return a.high * f, a.low * f

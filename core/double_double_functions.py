"""Logarithm, circular and hyperbolic functions of pairs of doubles (106 bits), compiled.

Values are correct to some units of 2^-104 of the larger of the value and one, those of inverse functions by one
Newton step from that of doubles.

References
----------
T. J. Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik 18 (1971).
"""

from __future__ import annotations

import math

from core.compiled import kernel
from core.double_double import Pair, dd_add, dd_add_d, dd_div, dd_div_d, dd_exp, dd_mul, dd_mul_d, dd_sqr, dd_sqrt

_QUARTER = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591698e-33)
"""A quarter of a turn in three words."""
_TERMS = 27
"""Highest power of the series of sine and cosine: the next one of pi/4 is below 2^-106."""
MOST_EXPONENT = 700.0
"""Largest exponent of which the power of e is formed: those of doubles end at 709."""


@kernel()
def dd_log(ah: float, al: float) -> Pair:
    """Return log(a) of a positive number."""
    start = math.log(ah)
    # log(a) = y + (a e^-y - 1), to the square of the error of y in doubles.
    eh, el = dd_exp(-start, 0.0)
    ph, pl = dd_mul(ah, al, eh, el)
    rh, rl = dd_add_d(ph, pl, -1.0)
    # The next term of the logarithm of what is left, of which doubles suffice.
    return dd_add(start, 0.0, rh, rl - 0.5 * rh * rh)


@kernel()
def dd_sin_cos(ah: float, al: float) -> tuple[float, float, float, float]:
    """Return sin(a) and cos(a), each as a pair."""
    turns = math.floor(ah / _QUARTER[0] + 0.5)
    kh, kl = dd_mul_d(_QUARTER[0], _QUARTER[1], turns)
    rh, rl = dd_add(ah, al, -kh, -kl)
    rh, rl = dd_add_d(rh, rl, -turns * _QUARTER[2])
    square, square_low = dd_sqr(rh, rl)
    # Both series by Horner's rule: 1 - r^2/((n - 1) n) (1 - ...).
    sh, sl, ch, cl = 1.0, 0.0, 1.0, 0.0
    for n in range(_TERMS, 1, -2):
        sh, sl = dd_mul(sh, sl, square, square_low)
        sh, sl = dd_div_d(sh, sl, -float(n * (n - 1)))
        sh, sl = dd_add_d(sh, sl, 1.0)
        ch, cl = dd_mul(ch, cl, square, square_low)
        ch, cl = dd_div_d(ch, cl, -float((n - 1) * (n - 2)))
        ch, cl = dd_add_d(ch, cl, 1.0)
    sh, sl = dd_mul(sh, sl, rh, rl)
    which = int(turns) & 3
    if which == 1:
        return ch, cl, -sh, -sl
    if which == 2:
        return -sh, -sl, -ch, -cl
    if which == 3:
        return -ch, -cl, sh, sl
    return sh, sl, ch, cl


@kernel()
def dd_sinh_cosh(ah: float, al: float) -> tuple[float, float, float, float]:
    """Return sinh(a) and cosh(a), each as a pair; sinh to units of 2^-104 of one where it is small."""
    if not abs(ah) < MOST_EXPONENT:
        return math.nan, 0.0, math.nan, 0.0
    eh, el = dd_exp(ah, al)
    ih, il = dd_div(1.0, 0.0, eh, el)
    sh, sl = dd_add(eh, el, -ih, -il)
    ch, cl = dd_add(eh, el, ih, il)
    return 0.5 * sh, 0.5 * sl, 0.5 * ch, 0.5 * cl


@kernel()
def dd_atan2(yh: float, yl: float, xh: float, xl: float) -> Pair:
    """Return the angle of the vector (x, y), between -pi and pi."""
    start = math.atan2(yh, xh)
    sh, sl, ch, cl = dd_sin_cos(start, 0.0)
    # The vector turned back by that angle, which is then small.
    ph, pl = dd_mul(yh, yl, ch, cl)
    qh, ql = dd_mul(xh, xl, sh, sl)
    uh, ul = dd_add(ph, pl, -qh, -ql)
    ph, pl = dd_mul(xh, xl, ch, cl)
    qh, ql = dd_mul(yh, yl, sh, sl)
    wh, wl = dd_add(ph, pl, qh, ql)
    dh, dl = dd_div(uh, ul, wh, wl)
    return dd_add(start, 0.0, dh, dl)


@kernel()
def dd_asin(ah: float, al: float) -> Pair:
    """Return the angle between -pi/2 and pi/2 whose sine is a."""
    ph, pl = dd_sqr(ah, al)
    rh, rl = dd_add_d(-ph, -pl, 1.0)
    if rh < 0.0:
        return math.nan, 0.0
    rh, rl = dd_sqrt(rh, rl)
    return dd_atan2(ah, al, rh, rl)

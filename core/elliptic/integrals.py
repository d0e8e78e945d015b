"""Elliptic integrals by the arithmetic-geometric mean and by Carlson's duplication, compiled.

All functions take both the parameter m and its complement m1 = 1 - m, because near m = 1 the complement contains all
the information and cannot be computed from m.

References
----------
NIST Digital Library of Mathematical Functions, 19.8, 19.25, 19.36 (Carlson's integrals).
"""

from __future__ import annotations

import math

from core.compiled import kernel
from core.double_double import (
    Pair,
    dd_add,
    dd_add_d,
    dd_div,
    dd_div_d,
    dd_mul,
    dd_sqr,
    dd_sqrt,
    dd_sub,
)


@kernel()
def agm_dd(kh: float, kl: float) -> Pair:
    """Return the arithmetic-geometric mean of 1 and k, for k > 0."""
    ah, al, gh, gl = 1.0, 0.0, kh, kl
    for _ in range(40):
        dh = ah - gh
        ph, pl = dd_mul(ah, al, gh, gl)
        sh, sl = dd_add(ah, al, gh, gl)
        ah, al = 0.5 * sh, 0.5 * sl
        # The next difference is dh^2/8a: below 2^-106 the mean has converged.
        if abs(dh) < 1e-16 * ah:
            break
        gh, gl = dd_sqrt(ph, pl)
    return ah, al


@kernel()
def rf_of_roots(ah: float, al: float, bh: float, bl: float, ch: float, cl: float) -> Pair:
    """Return Carlson's R_F(a^2, b^2, c^2), given the roots a, b, c >= 0, at most one of them 0.

    With roots as inputs, the arguments may be as small as the square of the smallest double. Duplication is repeated
    until the relative spread is below 5e-5; then follows the series of degree seven (DLMF 19.36.1).
    """
    xh, xl = dd_sqr(ah, al)
    yh, yl = dd_sqr(bh, bl)
    zh, zl = dd_sqr(ch, cl)
    for n in range(60):
        # In the first step the roots are inputs.
        if n > 0:
            ah, al = dd_sqrt(xh, xl)
            bh, bl = dd_sqrt(yh, yl)
            ch, cl = dd_sqrt(zh, zl)
        # lambda = ab + (a + b) c
        ph, pl = dd_mul(ah, al, bh, bl)
        sh, sl = dd_add(ah, al, bh, bl)
        sh, sl = dd_mul(sh, sl, ch, cl)
        lh, ll = dd_add(ph, pl, sh, sl)
        xh, xl = dd_add(xh, xl, lh, ll)
        yh, yl = dd_add(yh, yl, lh, ll)
        zh, zl = dd_add(zh, zl, lh, ll)
        xh, xl, yh, yl, zh, zl = 0.25 * xh, 0.25 * xl, 0.25 * yh, 0.25 * yl, 0.25 * zh, 0.25 * zl
        mean = (xh + yh + zh) / 3.0
        if max(abs(xh - mean), abs(yh - mean), abs(zh - mean)) < 5e-5 * mean:
            break
    sh, sl = dd_add(xh, xl, yh, yl)
    sh, sl = dd_add(sh, sl, zh, zl)
    mh, ml = dd_div_d(sh, sl, 3.0)
    dh, dl = dd_sub(mh, ml, xh, xl)
    Xh, Xl = dd_div(dh, dl, mh, ml)
    dh, dl = dd_sub(mh, ml, yh, yl)
    Yh, Yl = dd_div(dh, dl, mh, ml)
    Zh, Zl = dd_add(Xh, Xl, Yh, Yl)
    Zh, Zl = -Zh, -Zl
    ph, pl = dd_mul(Xh, Xl, Yh, Yl)
    zzh, zzl = dd_sqr(Zh, Zl)
    e2h, e2l = dd_sub(ph, pl, zzh, zzl)
    e3h, e3l = dd_mul(ph, pl, Zh, Zl)
    # Terms of the fourth and higher degrees are below 1e-16: double precision is enough for their coefficients.
    high = e2h * e2h / 24.0 - 3.0 * e2h * e3h / 44.0 - 5.0 * e2h**3 / 208.0 + 3.0 * e3h * e3h / 104.0
    high += e2h * e2h * e3h / 16.0
    th, tl = dd_div_d(e3h, e3l, 14.0)
    uh, ul = dd_div_d(e2h, e2l, 10.0)
    th, tl = dd_sub(th, tl, uh, ul)
    th, tl = dd_add_d(th, tl, high)
    th, tl = dd_add_d(th, tl, 1.0)
    rh, rl = dd_sqrt(mh, ml)
    return dd_div(th, tl, rh, rl)


@kernel()
def one_less_e_over_k(m: float, k1: float) -> float:
    """Return 1 - E(m)/K(m) to a few digits, k1 the complementary modulus.

    Source: E = K (1 - sum 2^(n-1) c_n^2), c_n the differences of the arithmetic-geometric mean, DLMF 19.8.6.
    """
    a, g, c, factor, total = 1.0, k1, math.sqrt(m), 1.0, 0.5 * m
    for _ in range(12):
        a, g, c = 0.5 * (a + g), math.sqrt(a * g), 0.5 * (a - g)
        total += factor * c * c
        factor *= 2.0
        if c < 1e-9:
            break
    return total

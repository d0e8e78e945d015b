"""The Jacobian elliptic functions as quotients of theta functions, compiled.

The argument is measured in quarter periods from the nearest one, so four terms of each theta series suffice. With
y = 2 q cos 2z (or 2 q' cosh 2x, see `core.elliptic.lattice`) all four theta functions share two polynomials of
degree three in y:

    theta3, theta4 ~ C(+y), C(-y)          theta1, theta2 ~ sin z P(+y), cos z P(-y)

References
----------
NIST Digital Library of Mathematical Functions, 20.2 (theta functions), 22.2.
"""

from __future__ import annotations

import math

from core.compiled import bits_of, double_from_bits, fma, kernel
from core.double_double import Pair, two_prod, two_sum
from core.elliptic.lattice import Lattice

LARGEST_QUARTER = 2.0**50
"""Beyond this many quarter periods the rounding of a phase is no longer small compared with a period."""


@kernel()
def split_phase(
    rate: float, rate_tail: float, time: float, start: float, start_tail: float
) -> tuple[float, float, float]:
    """Return n, r, r_tail with rate time + start = n + r, n the nearest integer and r accurate to its last bit."""
    ph, pl = two_prod(rate, time)
    pl = fma(rate_tail, time, pl)
    sh, sl = two_sum(ph, start)
    low = pl + sl + start_tail
    # Adding and subtracting 1.5 2^52 rounds to the nearest integer without a branch.
    n = (sh + 6755399441055744.0) - 6755399441055744.0
    r, r_tail = two_sum(sh - n, low)
    # Beyond 2^46 the last place of the sum is no longer small compared with one, and the nearest integer may be the
    # next.
    beyond = (r + 6755399441055744.0) - 6755399441055744.0
    return n + beyond, r - beyond, r_tail


@kernel()
def half_parity(n: float) -> tuple[bool, float]:
    """Return whether n is odd, and the sign (-1)^floor(n/2)."""
    # n/4 less its nearest integer is 0, 1/4, +-1/2, -1/4 for n = 0, 1, 2, 3 modulo 4.
    quarter = 0.25 * n
    rest = quarter - ((quarter + 6755399441055744.0) - 6755399441055744.0)
    return abs(rest) == 0.25, 1.0 if 0.0 <= rest < 0.375 else -1.0


@kernel()
def sin_cos_quarter(r: float, r_tail: float) -> Pair:
    """Return sin and cos of (pi/2) r for |r| <= 1/2, or slightly more.

    Polynomials in (pi r/2)^2 through the Chebyshev points of the interval, remainders below 2^-55, with the leading
    terms in extended precision.
    """
    zh = r * 1.5707963267948966
    zl = fma(r, 1.5707963267948966, -zh) + fma(r, 6.123233995736766e-17, r_tail * 1.5707963267948966)
    w = zh * zh
    p = fma(w, 1.591798150140412e-10, -2.5051129792549024e-08)
    p = fma(w, p, 2.7557316092699366e-06)
    p = fma(w, p, -0.0001984126983673957)
    p = fma(w, p, 0.008333333333330936)
    p = fma(w, p, -0.16666666666666666)
    sine = zh + fma(zh * w, p, zl)
    p = fma(w, -1.1382539967177458e-11, 2.0876144984413913e-09)
    p = fma(w, p, -2.755731726556589e-07)
    p = fma(w, p, 2.48015872987538e-05)
    p = fma(w, p, -0.0013888888888887389)
    p = fma(w, p, 0.041666666666666664)
    half = 0.5 * w
    lead = 1.0 - half
    # The rounding of 1 - w/2 is (1 - lead) - w/2, and that of w is fma(zh, zh, -w).
    lost = (1.0 - lead) - half - 0.5 * fma(zh, zh, -w)
    cosine = lead + fma(w * w, p, fma(-zh, zl, lost))
    return sine, cosine


@kernel()
def sinh_cosh(xh: float, xl: float) -> Pair:
    """Return sinh and cosh of xh + xl for |xh| < 700, both with full relative precision.

    x = n ln 2 + r; polynomials in r^2 through the Chebyshev points of the interval, remainders below 2^-56.
    """
    # The sum with 1.5 2^52 is rounded to an integer, which is then in the lowest bits of its pattern.
    shifted = fma(xh, 1.4426950408889634, 6755399441055744.0)
    n = shifted - 6755399441055744.0
    # The first difference is exact: a multiple of 2^-54 below 0.35.
    near = fma(-n, 0.6931471805599453, xh)
    tail = fma(-n, 2.3190468138462996e-17, xl)
    r = near + tail
    tail += near - r
    w = r * r
    p = fma(w, 2.5100450946427397e-08, 2.755726832230253e-06)
    p = fma(w, p, 0.00019841269863142295)
    p = fma(w, p, 0.008333333333330044)
    p = fma(w, p, 0.16666666666666669)
    # sinh r = r + s, cosh r = 1 + c
    s = fma(r * w, p, tail)
    p = fma(w, 2.762017355595474e-07, 2.4801521116900806e-05)
    p = fma(w, p, 0.0013888888917329028)
    p = fma(w, p, 0.0416666666666239)
    p = fma(w, p, 0.5000000000000001)
    c = fma(w, p, r * tail)
    k = bits_of(shifted)
    # 2^n/2 and 2^-n/2; the bits above the lowest twelve are shifted out.
    up = double_from_bits((k + 1022) << 52)
    down = double_from_bits((1022 - k) << 52)
    sn, cn = up - down, up + down
    return sn + fma(cn, r, fma(sn, c, cn * s)), cn + fma(sn, r, fma(cn, c, sn * s))


@kernel()
def theta_parts(circular: bool, nome: float, root_nome: float, s: float, c: float) -> tuple[float, float, float, float]:
    """Return S = s P(y), C = c P(-y), C(y) and C(-y) for s, c the sine and cosine (or sinh and cosh)."""
    q = nome
    if circular:
        y = 2.0 * q * fma(-2.0 * s, s, 1.0)
    else:
        t = root_nome * s
        y = fma(4.0 * t, t, 2.0 * q)
    q2 = q * q
    q4 = q2 * q2
    w = y * y
    # Each series is 1 + a small term, so there is one rounding of full size.
    p_even = fma(w, fma(-q4 * q4, q2, q4), -fma(q4, q2, q2))
    p_odd = y * fma(-q4 * q4 * q, w, fma(2.0 * q4 * q4, q2 * q, q4 * q - q))
    c_even = fma(w, q2, -2.0 * q4)
    c_odd = y * fma(w, q4 * q2, fma(-3.0 * q4, q4, 1.0))
    return fma(s, p_even + p_odd, s), fma(c, p_even - p_odd, c), 1.0 + (c_even + c_odd), 1.0 + (c_even - c_odd)


@kernel()
def jacobi_at(lat: Lattice, n: float, r: float, r_tail: float) -> tuple[float, float, float]:
    """Return sn, cn, dn at n + r quarter periods, |r| <= 1/2."""
    odd, sign = half_parity(n)
    if lat.circular:
        s, c = sin_cos_quarter(r, r_tail)
        S, C, D3, D4 = theta_parts(True, lat.nome, lat.root_nome, s, c)
        if odd:
            over = 1.0 / D3
            return sign * lat.odd_sn[0] * C * over, sign * lat.odd_cn[0] * S * over, lat.odd_dn[0] * D4 * over
        over = 1.0 / D4
        return sign * lat.even_sn[0] * S * over, sign * lat.even_cn[0] * C * over, lat.even_dn[0] * D3 * over
    xh, xl = two_prod(r, lat.scale)
    s, c = sinh_cosh(xh, xl + fma(r, lat.scale_tail, r_tail * lat.scale))
    S, C, D3, D4 = theta_parts(False, lat.nome, lat.root_nome, s, c)
    if odd:
        over = 1.0 / D3
        return sign * lat.odd_sn[0] * D4 * over, sign * lat.odd_cn[0] * S * over, lat.odd_dn[0] * C * over
    over = 1.0 / C
    return sign * lat.even_sn[0] * S * over, sign * lat.even_cn[0] * D4 * over, lat.even_dn[0] * D3 * over


@kernel()
def separatrix_at(xh: float, xl: float) -> tuple[float, float]:
    """Return tanh x and sech x for any x, without overflow."""
    a, b = (xh, xl) if xh >= 0.0 else (-xh, -xl)
    if a > 350.0:
        # sech^2 is below 1e-303: tanh is 1, and sech is 2 exp(-a), down to underflow.
        sech = 2.0 * math.exp(-a)
        tanh = 1.0
    else:
        s, c = sinh_cosh(a, b)
        sech = 1.0 / c
        tanh = s * sech
    return tanh if xh >= 0.0 else -tanh, sech

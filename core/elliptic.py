"""Elliptic integrals and Jacobian functions to full precision, compiled: the ground floor of every closed form.

The parameter m and its complement m1 = 1 - m are both arguments everywhere, because near m = 1 the complement carries
all the information and cannot be had from m. Set-ups run in double-double; evaluation is by quotients of theta
functions:

* m1 >= 1/2 ("circular"): nome q = exp(-pi K'/K) <= 0.0433, argument z = pi u/2K, trigonometric theta series;
* m1 < 1/2 ("hyperbolic"): Jacobi's imaginary transformation, nome q' = exp(-pi K/K'), argument x = pi u/2K'.

In both, u is measured in quarter periods from the nearest one, so that four terms of each series suffice, and with
y = 2 q cos 2z (or 2 q' cosh 2x) all four theta functions share two polynomials of degree three in y:

    theta3, theta4 ~ C(+y), C(-y)          theta1, theta2 ~ sin z P(+y), cos z P(-y)

References
----------
NIST Digital Library of Mathematical Functions, 19.25, 19.36 (Carlson's integrals), 20.2, 20.7 (theta functions), 22.2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from core.compiled import bits_of, double_from_bits, fma, kernel
from core.double_double import (
    PI,
    Pair,
    dd_add,
    dd_add_d,
    dd_div,
    dd_div_d,
    dd_exp,
    dd_mul,
    dd_sqr,
    dd_sqrt,
    dd_sub,
    two_prod,
    two_sum,
)
from core.errors import AccuracyUnreachable, InvalidParameter

LARGEST_QUARTER = 2.0**50
"""Beyond this many quarter periods a phase no longer has the digits that its place in the period needs."""

SMALLEST_COMPLEMENT = 1e-285
"""Smallest complementary modulus k' (so m1 about 1e-570) whose low part is still a normal number."""


@kernel()
def agm_dd(kh: float, kl: float) -> Pair:
    """Return the arithmetic-geometric mean of 1 and k, for k > 0."""
    ah, al, gh, gl = 1.0, 0.0, kh, kl
    for _ in range(40):
        dh = ah - gh
        ph, pl = dd_mul(ah, al, gh, gl)
        sh, sl = dd_add(ah, al, gh, gl)
        ah, al = 0.5 * sh, 0.5 * sl
        # The next difference is dh^2/8a: below 2^-106 the mean is there.
        if abs(dh) < 1e-16 * ah:
            break
        gh, gl = dd_sqrt(ph, pl)
    return ah, al


@kernel()
def rf_of_roots(ah: float, al: float, bh: float, bl: float, ch: float, cl: float) -> Pair:
    """Return Carlson's R_F(a^2, b^2, c^2), given the roots a, b, c >= 0, at most one of them 0.

    Taking roots lets arguments be as small as the square of the smallest double. Duplication until the spread is
    below 5e-5, then the series of degree seven (DLMF 19.36.1).
    """
    xh, xl = dd_sqr(ah, al)
    yh, yl = dd_sqr(bh, bl)
    zh, zl = dd_sqr(ch, cl)
    for _ in range(60):
        if _ > 0:
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


class Lattice(NamedTuple):
    """The periods of one modulus, with what evaluation needs of them."""

    circular: bool
    K: float
    """Quarter period."""
    K_tail: float
    nome: float
    """q if circular, else q'."""
    root_nome: float
    scale: float
    """What a quarter period is in the argument of the theta functions: pi/2, or pi K/2K'."""
    scale_tail: float
    even_sn: Pair
    even_cn: Pair
    even_dn: Pair
    odd_sn: Pair
    odd_cn: Pair
    odd_dn: Pair
    """Constants in front of the quotients near even and odd quarter periods."""


@kernel()
def theta_constants(qh: float, ql: float) -> tuple[float, float, float, float, float, float]:
    """Return theta3(0), theta4(0) and theta2(0)/2q^(1/4) for the nome q <= 0.05, each as a pair."""
    q2h, q2l = dd_sqr(qh, ql)
    q4h, q4l = dd_sqr(q2h, q2l)
    q8 = q4h * q4h
    # 1 + 2(q^4 + q^16) and 2(q + q^9 + q^25): the parts that keep and that change sign.
    eh, el = dd_add_d(2.0 * q4h, 2.0 * q4l, 2.0 * q8 * q8)
    eh, el = dd_add_d(eh, el, 1.0)
    oh, ol = dd_add_d(qh, ql, q8 * qh + q8 * q8 * q8 * qh)
    oh, ol = 2.0 * oh, 2.0 * ol
    t3h, t3l = dd_add(eh, el, oh, ol)
    t4h, t4l = dd_sub(eh, el, oh, ol)
    ph, pl = dd_add_d(q2h, q2l, q4h * q2h + q8 * q4h + q8 * q8 * q4h)
    ph, pl = dd_add_d(ph, pl, 1.0)
    return t3h, t3l, t4h, t4l, ph, pl


class Periods(NamedTuple):
    """The quarter periods of one modulus."""

    circular: bool
    K: float
    """Quarter period."""
    K_tail: float
    scale: float
    """What a quarter period is in the argument of the theta functions: pi/2, or pi K/2K'."""
    scale_tail: float
    mean: float
    """Arithmetic-geometric mean of 1 and k, so that K' = pi/2 mean; 0 where k is too small to matter."""
    mean_tail: float
    complementary_mean: float
    """The same of 1 and k'."""
    complementary_mean_tail: float


@kernel()
def periods(kh: float, kl: float, ch: float, cl: float) -> Periods:
    """Return the periods of modulus k = (kh, kl) and complementary modulus k' = (ch, cl) > 0."""
    gh, gl = agm_dd(ch, cl)
    halfpi_h, halfpi_l = 0.5 * PI[0], 0.5 * PI[1]
    Kh, Kl = dd_div(halfpi_h, halfpi_l, gh, gl)
    circular = ch * ch >= 0.5
    if circular and kh < 1e-40:
        # q = m/16 is below the last bit of everything it is added to.
        return Periods(True, Kh, Kl, halfpi_h, halfpi_l, 0.0, 0.0, gh, gl)
    ah, al = agm_dd(kh, kl)
    if circular:
        return Periods(True, Kh, Kl, halfpi_h, halfpi_l, ah, al, gh, gl)
    rh, rl = dd_div(ah, al, gh, gl)
    lh, ll = dd_mul(rh, rl, halfpi_h, halfpi_l)
    return Periods(False, Kh, Kl, lh, ll, ah, al, gh, gl)


@kernel()
def lattice(kh: float, kl: float, ch: float, cl: float) -> Lattice:
    """Return the lattice of modulus k = (kh, kl) and complementary modulus k' = (ch, cl) > 0."""
    of = periods(kh, kl, ch, cl)
    Kh, Kl, lh, ll = of.K, of.K_tail, of.scale, of.scale_tail
    if of.circular:
        if of.mean == 0.0:
            one = (1.0, 0.0)
            return Lattice(True, Kh, Kl, 0.0, 0.0, lh, ll, one, one, one, one, (-1.0, 0.0), one)
        # pi K'/K = pi agm(1, k')/agm(1, k)
        rh, rl = dd_div(of.complementary_mean, of.complementary_mean_tail, of.mean, of.mean_tail)
        rh, rl = dd_mul(rh, rl, PI[0], PI[1])
        qh, ql = dd_exp(-rh, -rl)
        t3h, t3l, t4h, t4l, ph, pl = theta_constants(qh, ql)
        s = dd_div(t3h, t3l, ph, pl)
        c = dd_div(t4h, t4l, ph, pl)
        d = dd_div(t4h, t4l, t3h, t3l)
        return Lattice(True, Kh, Kl, qh, math.sqrt(qh), lh, ll, s, c, d, s, (-c[0], -c[1]), d)
    qh, ql = 0.0, 0.0
    if lh < 300.0:
        qh, ql = dd_exp(-2.0 * lh, -2.0 * ll)
    root, _ = dd_exp(-lh, -ll)
    t3h, t3l, t4h, t4l, ph, pl = theta_constants(qh, ql)
    sn = dd_div(t3h, t3l, t4h, t4l)
    cn = dd_div(ph, pl, t4h, t4l)
    dn = dd_div(ph, pl, t3h, t3l)
    # Near odd quarter periods: sn = cd, cn = -k' sd, dn = k' nd of the distance.
    th, tl = dd_div(t3h, t3l, ph, pl)
    th, tl = dd_mul(th, tl, ch, cl)
    odd_cn = dd_mul(-th, -tl, sn[0], sn[1])
    return Lattice(False, Kh, Kl, qh, root, lh, ll, sn, cn, dn, sn, odd_cn, (th, tl))


@kernel()
def split_phase(
    rate: float, rate_tail: float, time: float, start: float, start_tail: float
) -> tuple[float, float, float]:
    """Return n, r, r_tail with rate time + start = n + r, n the nearest integer and r right to its last bit."""
    ph, pl = two_prod(rate, time)
    pl = fma(rate_tail, time, pl)
    sh, sl = two_sum(ph, start)
    low = pl + sl + start_tail
    # Adding and subtracting 1.5 2^52 rounds to the nearest integer without a branch.
    n = (sh + 6755399441055744.0) - 6755399441055744.0
    r, r_tail = two_sum(sh - n, low)
    return n, r, r_tail


@kernel()
def half_parity(n: float) -> tuple[bool, float]:
    """Return whether n is odd, and the sign (-1)^floor(n/2)."""
    # n/4 less its nearest integer is 0, 1/4, +-1/2, -1/4 for n = 0, 1, 2, 3 modulo 4.
    quarter = 0.25 * n
    rest = quarter - ((quarter + 6755399441055744.0) - 6755399441055744.0)
    return abs(rest) == 0.25, 1.0 if 0.0 <= rest < 0.375 else -1.0


@kernel()
def sin_cos_quarter(r: float, r_tail: float) -> Pair:
    """Return sin and cos of (pi/2) r for |r| <= 1/2 (a hair more does no harm).

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
    # 1 - w/2 loses (1 - lead) - w/2, and w itself fma(zh, zh, -w).
    lost = (1.0 - lead) - half - 0.5 * fma(zh, zh, -w)
    cosine = lead + fma(w * w, p, fma(-zh, zl, lost))
    return sine, cosine


@kernel()
def sinh_cosh(xh: float, xl: float) -> Pair:
    """Return sinh and cosh of xh + xl for |xh| < 700, both with full relative precision.

    x = n ln 2 + r; polynomials in r^2 through the Chebyshev points of the interval, remainders below 2^-56.
    """
    # The sum with 1.5 2^52 is rounded to a whole number, which then stands in the lowest bits of its pattern.
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
    # 2^n/2 and 2^-n/2; what stands above the lowest twelve bits is shifted out.
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
    # Each series is 1 + (what is small): one rounding of full size.
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
        # sech^2 is below 1e-303: tanh is 1, and sech follows down to nothing by its exponential.
        sech = 2.0 * math.exp(-a)
        tanh = 1.0
    else:
        s, c = sinh_cosh(a, b)
        sech = 1.0 / c
        tanh = s * sech
    return tanh if xh >= 0.0 else -tanh, sech


@kernel()
def moduli(m: float, m1: float) -> tuple[float, float, float, float]:
    """Return k and k' as pairs; the smaller of m and m1 is taken as exact and the other as its complement."""
    if m1 < m:
        ch, cl = dd_sqrt(m1, 0.0)
        h, low = two_sum(1.0, -m1)
        kh, kl = dd_sqrt(h, low)
    else:
        kh, kl = dd_sqrt(m, 0.0)
        h, low = two_sum(1.0, -m)
        ch, cl = dd_sqrt(h, low)
    return kh, kl, ch, cl


@kernel()
def _complete_k(m: float, m1: float) -> float:
    _, _, ch, cl = moduli(m, m1)
    gh, gl = agm_dd(ch, cl)
    return dd_div(0.5 * PI[0], 0.5 * PI[1], gh, gl)[0]


@kernel()
def _carlson_rf(x: float, y: float, z: float) -> float:
    ah, al = dd_sqrt(x, 0.0)
    bh, bl = dd_sqrt(y, 0.0)
    ch, cl = dd_sqrt(z, 0.0)
    return rf_of_roots(ah, al, bh, bl, ch, cl)[0]


@kernel("void(float64[::1], float64, float64, float64[:, ::1])")
def _jacobi(u: NDArray[np.float64], m: float, m1: float, out: NDArray[np.float64]) -> None:
    if m1 == 0.0:
        for i in range(u.size):
            out[0, i], out[1, i] = separatrix_at(u[i], 0.0)
            out[2, i] = out[1, i]
        return
    kh, kl, ch, cl = moduli(m, m1)
    lat = lattice(kh, kl, ch, cl)
    rate, rate_tail = dd_div(1.0, 0.0, lat.K, lat.K_tail)
    for i in range(u.size):
        n, r, r_tail = split_phase(rate, rate_tail, u[i], 0.0, 0.0)
        out[0, i], out[1, i], out[2, i] = jacobi_at(lat, n, r, r_tail)


def _check_parameter(m: float, m1: float) -> None:
    if not (0.0 <= m <= 1.0 and 0.0 <= m1 <= 1.0 and abs(m + m1 - 1.0) <= 1e-15):
        raise InvalidParameter("m", "lie in [0, 1] with m + m1 = 1")
    if 0.0 < m1 < SMALLEST_COMPLEMENT**2:
        raise AccuracyUnreachable(2.0**-53, 1.0, f"the complementary parameter {m1:g} is too small", path=("m1",))


def complete_k(m: float, m1: float) -> float:
    """Return the complete elliptic integral of the first kind, K(m), with m1 = 1 - m > 0 given too.

    Source: K = pi / (2 agm(1, sqrt(m1))), DLMF 19.8.5.
    """
    _check_parameter(m, m1)
    if m1 == 0.0:
        raise InvalidParameter("m1", "be greater than 0: K(1) is infinite")
    return float(_complete_k(m, m1))


def carlson_rf(x: float, y: float, z: float) -> float:
    """Return Carlson's symmetric integral R_F(x, y, z), arguments finite and >= 0, at most one of them 0.

    Source: duplication theorem, DLMF 19.36(i).
    """
    for name, value in zip("xyz", (x, y, z), strict=True):
        if not (math.isfinite(value) and value >= 0.0):
            raise InvalidParameter(name, "be finite and at least 0")
    if (x, y, z).count(0.0) > 1:
        raise InvalidParameter("x", "not be 0 together with another argument: the integral diverges")
    return float(_carlson_rf(x, y, z))


def jacobi(u: ArrayLike, m: float, m1: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return sn, cn and dn of `u` for parameter m with complement m1 = 1 - m.

    The smaller of m and m1 is taken as exact. Right to a few units in the last place at any `u`, also near m = 1,
    because whole quarter periods are removed in double-double and the nearest one is the origin of the series.

    Parameters
    ----------
    u : array_like
        Real arguments, any shape.
    m, m1 : float
        Parameter and complementary parameter, both in [0, 1].

    Returns
    -------
    sn, cn, dn : ndarray
        Of the shape of `u`.

    Raises
    ------
    AccuracyUnreachable
        Where `u` is more than 2^50 quarter periods away, or m1 is below about 1e-570 and not 0.
    """
    _check_parameter(m, m1)
    arguments = np.asarray(u, dtype=np.float64)
    flat = np.ascontiguousarray(arguments).reshape(-1)
    largest = float(np.max(np.abs(flat), initial=0.0))
    if not math.isfinite(largest):
        raise InvalidParameter("u", "be finite")
    if m1 > 0.0 and largest / complete_k(m, m1) > LARGEST_QUARTER:
        raise AccuracyUnreachable(2.0**-53, 1.0, "the argument lies beyond 2^50 quarter periods", path=("u",))
    out = np.empty((3, flat.size))
    _jacobi(flat, float(m), float(m1), out)
    shape = arguments.shape
    return out[0].reshape(shape), out[1].reshape(shape), out[2].reshape(shape)

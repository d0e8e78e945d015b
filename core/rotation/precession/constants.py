"""The constants of the rotation angle of a free body about its angular momentum, compiled.

With axes x' = e_c, z' = e_d (in the directions of the initial components of w) and y' completing them, m = M/L has
m_z' > 0 always, and

    R = Rz(psi) P(m),   P the shortest rotation from m to z',   psi' = (2E + L w_z')/(L + M_z').

psi = kappa u + 2 eta arg theta4(z - i xi | q^2), where z = pi u/2K, xi = pi x/2K, eta = +1 about the largest moment
and -1 about the smallest, and sc(x|m1)^2 = I_c|I_d-I_b| / (I_d|I_b-I_c|) depends on the moments alone. Near the
separatrix theta4 is taken by Jacobi's imaginary transformation: with eta_x = pi x/4K' and w = eta_x + i (scale/2) r,

    arg theta4 = r eta_x + arg theta2(w | q'^(1/2))   at r quarter periods from an even one, theta3 from an odd one.

References
----------
C. G. J. Jacobi, "Sur la rotation d'un corps", Journal für die reine und angewandte Mathematik 39 (1849) 293.
E. T. Whittaker, "Analytical Dynamics", section 69. NIST Digital Library of Mathematical Functions, 20.7(viii).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import (
    PI,
    Pair,
    Scaled,
    dd_add,
    dd_add_d,
    dd_div,
    dd_div_d,
    dd_exp,
    dd_mul,
    dd_mul_d,
    dd_sqr,
    dd_sqrt,
    dd_sub,
    sc_add,
    sc_div,
    sc_mul,
    sc_pair,
    sc_sqrt,
)
from core.elliptic.integrals import agm_dd, rf_of_roots
from core.elliptic.lattice import Periods
from core.rotation.closed_form.circulation import SEPARATRIX, Circulation, amplitudes, circulation
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion

CIRCULAR, HYPERBOLIC, LIMIT = range(3)


class Quarter(NamedTuple):
    """The change of psi/2 in a quarter period, and the constants of its periodic part."""

    per_quarter: float
    per_quarter_tail: float
    """Radians of psi/2 per quarter period, periodic part included (it closes over two quarters); 0 without a period."""
    eta_x: float
    cos_x: float
    sin_x: float
    """eta_x with its cosine and sine."""
    theta_c1: float
    theta_s1: float
    theta_c2: float
    theta_s2: float
    """2 q^2 cosh 2xi, 2 q^2 sinh 2xi, 2 q^8 cosh 4xi, 2 q^8 sinh 4xi."""


class PrecessionConstants(NamedTuple):
    """Constants of the angle psi about the angular momentum, and of P."""

    branch: int
    eta: float
    a_x: float
    a_y: float
    a_z: float
    """Amplitudes of m along x', y', z'."""
    turn: float
    turn_tail: float
    """Quarter turns of psi/2 per unit of scaled time, without the periodic part."""
    quarter: Quarter


@kernel()
def _sin_cos_dd(ah: float, al: float) -> tuple[float, float, float, float]:
    """Return sin a and cos a as pairs, for 0 <= a <= pi/4, by their Taylor series."""
    wh, wl = dd_sqr(ah, al)
    # sin a/a = 1 - w/(2 3) (1 - w/(4 5) (...)),  cos a = 1 - w/(1 2) (1 - w/(3 4) (...)). The terms from w^10 on are
    # multiplied by w^10/20! < 2^-65, so doubles suffice for them.
    sh, sl, ch, cl = 0.0, 0.0, 0.0, 0.0
    for n in range(27, 19, -2):
        sh = wh / ((n + 1) * (n + 2)) * (1.0 - sh)
        ch = wh / (n * (n + 1)) * (1.0 - ch)
    for n in range(19, 0, -2):
        th, tl = dd_add_d(-sh, -sl, 1.0)
        th, tl = dd_mul(th, tl, wh, wl)
        sh, sl = dd_div_d(th, tl, float((n + 1) * (n + 2)))
        th, tl = dd_add_d(-ch, -cl, 1.0)
        th, tl = dd_mul(th, tl, wh, wl)
        ch, cl = dd_div_d(th, tl, float(n * (n + 1)))
    th, tl = dd_add_d(-sh, -sl, 1.0)
    sh, sl = dd_mul(th, tl, ah, al)
    ch, cl = dd_add_d(-ch, -cl, 1.0)
    return sh, sl, ch, cl


@kernel()
def _theta2_slope(sh: float, sl: float, ch: float, cl: float, qh: float, ql: float) -> Pair:
    """Return -(d/da) log theta2(a | q^(1/2)) = sum (2n+1) q^(n(n+1)/2) sin(2n+1)a / sum q^(n(n+1)/2) cos(2n+1)a."""
    # Angles advance by 2a; factors q^1, q^3, q^6, ... advance by q^n.
    s2h, s2l = dd_mul(sh, sl, ch, cl)
    s2h, s2l = 2.0 * s2h, 2.0 * s2l
    c2h, c2l = dd_sqr(sh, sl)
    c2h, c2l = dd_add_d(-2.0 * c2h, -2.0 * c2l, 1.0)
    uh, ul, vh, vl = sh, sl, ch, cl
    nh, nl, mh, ml = sh, sl, ch, cl
    fh, fl, gh, gl = 1.0, 0.0, 1.0, 0.0
    for n in range(1, 8):
        ah, al = dd_mul(uh, ul, c2h, c2l)
        bh, bl = dd_mul(vh, vl, s2h, s2l)
        xh, xl = dd_add(ah, al, bh, bl)
        ah, al = dd_mul(vh, vl, c2h, c2l)
        bh, bl = dd_mul(uh, ul, s2h, s2l)
        vh, vl = dd_sub(ah, al, bh, bl)
        uh, ul = xh, xl
        gh, gl = dd_mul(gh, gl, qh, ql)
        fh, fl = dd_mul(fh, fl, gh, gl)
        if fh < 1e-34:
            break
        ah, al = dd_mul(uh, ul, fh, fl)
        ah, al = dd_mul_d(ah, al, 2.0 * n + 1.0)
        nh, nl = dd_add(nh, nl, ah, al)
        ah, al = dd_mul(vh, vl, fh, fl)
        mh, ml = dd_add(mh, ml, ah, al)
    return dd_div(nh, nl, mh, ml)


@kernel()
def _theta4_slope(xh: float, xl: float, qh: float, ql: float) -> tuple[float, float, float, float, float, float]:
    """Return sum 2n Q^(n^2) sinh 2n xi .../theta4(-i xi | Q), Q = q^2, as a pair; and the four constants for sampling.

    The pair is -(d/dz) arg theta4(z - i xi) at z = 0.
    """
    Qh, Ql = dd_sqr(qh, ql)
    eh, el = dd_exp(2.0 * xh, 2.0 * xl)
    ih, il = dd_div(1.0, 0.0, eh, el)
    # Terms Q^(n^2) e^(+-2n xi); the growing ones are bounded by q^(n(2n-1)).
    uh, ul = dd_mul(Qh, Ql, eh, el)
    vh, vl = dd_mul(Qh, Ql, ih, il)
    nh, nl, mh, ml = 0.0, 0.0, 1.0, 0.0
    ah, al, bh, bl = uh, ul, vh, vl
    Q2h, Q2l = dd_sqr(Qh, Ql)
    sign = -1.0
    c1, s1, c2, s2 = 0.0, 0.0, 0.0, 0.0
    for n in range(1, 6):
        dh, dl = dd_sub(ah, al, bh, bl)
        sh, sl = dd_add(ah, al, bh, bl)
        if n == 1:
            c1, s1 = sh, dh
        elif n == 2:
            c2, s2 = sh, dh
        dh, dl = dd_mul_d(dh, dl, -sign * 2.0 * n)
        nh, nl = dd_add(nh, nl, dh, dl)
        mh, ml = dd_add(mh, ml, sign * sh, sign * sl)
        # Q^((n+1)^2) e^(2(n+1)xi) = Q^(n^2) e^(2n xi) Q^(2n) (Q e^(2 xi))
        ah, al = dd_mul(ah, al, uh, ul)
        bh, bl = dd_mul(bh, bl, vh, vl)
        for _ in range(n):
            ah, al = dd_mul(ah, al, Q2h, Q2l)
            bh, bl = dd_mul(bh, bl, Q2h, Q2l)
        sign = -sign
        if ah < 1e-36:
            break
    oh, ol = dd_div(nh, nl, mh, ml)
    return oh, ol, c1, s1, c2, s2


class Turning(NamedTuple):
    """The rotation about the angular momentum at u = 0, where w = (A_c, 0, A_d) in x', y', z'."""

    L: Scaled
    M_c: Scaled
    M_d: Scaled
    """Angular momentum, and its components along c and d."""
    kappa: float
    """Half of psi' there, per unit of u."""
    kappa_tail: float
    sine: float
    """Sine and cosine of the amplitude of x: I_c|I_d-I_b|/(I_b|I_d-I_c|) and I_d|I_b-I_c|/(I_b|I_d-I_c|), roots."""
    sine_tail: float
    cosine: float
    cosine_tail: float


@kernel()
def turning(c: Circulation, far_c: Scaled, far_d: Scaled) -> Turning:
    """Return the rotation about the angular momentum at u = 0, for amplitudes `far_c` and `far_d`."""
    M_c, M_d = sc_mul(c.I_c, far_c), sc_mul(c.I_d, far_d)
    L = sc_sqrt(sc_add(sc_mul(M_c, M_c), sc_mul(M_d, M_d)))
    top = sc_add(sc_add(sc_mul(M_c, far_c), sc_mul(M_d, far_d)), sc_mul(L, far_d))
    slope = sc_div(top, sc_add(L, M_d))
    kh, kl = sc_pair(sc_div(slope, c.p))
    base = sc_mul(c.I_b, c.cd)
    sh, sl = sc_pair(sc_sqrt(sc_div(sc_mul(c.I_c, c.bd), base)))
    ch, cl = sc_pair(sc_sqrt(sc_div(sc_mul(c.I_d, c.bc), base)))
    return Turning(L, M_c, M_d, 0.5 * kh, 0.5 * kl, sh, sl, ch, cl)


@kernel()
def quarter_turn(c: Circulation, t: Turning, of: Periods) -> Quarter:
    """Return the change of psi/2 in a quarter period, for the rotation `t` at u = 0."""
    eta = 1.0 if c.circled == 2 else -1.0
    ah, al = dd_mul(t.kappa, t.kappa_tail, of.K, of.K_tail)
    kh, kl = sc_pair(c.k)
    if of.circular and kh < 1e-33:
        return Quarter(ah, al, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    # dn-like root cos^2 + m sin^2
    mh, ml = dd_mul(kh, kl, t.sine, t.sine_tail)
    ch, cl = dd_sqr(t.cosine, t.cosine_tail)
    mh, ml = dd_sqr(mh, ml)
    dh, dl = dd_add(ch, cl, mh, ml)
    dh, dl = dd_sqrt(dh, dl)
    xh, xl = rf_of_roots(t.cosine, t.cosine_tail, dh, dl, 1.0, 0.0)
    xh, xl = dd_mul(xh, xl, t.sine, t.sine_tail)
    if of.circular:
        # xi = pi x/2K; q = exp(-pi K'/K) with K' = pi/2 agm(1, k').
        zh, zl = dd_div(xh, xl, of.K, of.K_tail)
        zh, zl = dd_mul(zh, zl, 0.5 * PI[0], 0.5 * PI[1])
        gh, gl = dd_mul(of.mean, of.mean_tail, of.K, of.K_tail)
        qh, ql = dd_div(-0.5 * PI[0], -0.5 * PI[1], gh, gl)
        qh, ql = dd_mul(qh, ql, PI[0], PI[1])
        qh, ql = dd_exp(qh, ql)
        nh, nl, c1, s1, c2, s2 = _theta4_slope(zh, zl, qh, ql)
        nh, nl = dd_mul(nh, nl, 0.5 * PI[0], 0.5 * PI[1])
        ah, al = dd_add(ah, al, eta * nh, eta * nl)
        return Quarter(ah, al, 0.0, 1.0, 0.0, c1, s1, c2, s2)
    # eta_x = pi x/4K' = x agm(1, k)/2.
    zh, zl = dd_mul(xh, xl, of.mean, of.mean_tail)
    zh, zl = 0.5 * zh, 0.5 * zl
    qh, ql = 0.0, 0.0
    if of.scale < 300.0:
        qh, ql = dd_exp(-2.0 * of.scale, -2.0 * of.scale_tail)
    sh, sl, ch, cl = _sin_cos_dd(zh, zl)
    nh, nl = _theta2_slope(sh, sl, ch, cl, qh, ql)
    nh, nl = dd_mul(nh, nl, 0.5 * of.scale, 0.5 * of.scale_tail)
    nh, nl = dd_sub(zh, zl, nh, nl)
    ah, al = dd_add(ah, al, -eta * nh, -eta * nl)
    return Quarter(ah, al, zh, ch, sh, 0.0, 0.0, 0.0, 0.0)


@kernel()
def angle_per_period(quarter: Quarter, eta: float) -> Pair:
    """Return the rotation angle of the circled axis about the angular momentum in a period, not reduced (rad)."""
    # Rz(psi) rotates by 8 quarters of psi/2. It differs from Euler's angle of the circled axis by one turn, which the
    # shortest rotation P makes with m.
    h, low = dd_mul_d(quarter.per_quarter, quarter.per_quarter_tail, 8.0)
    return dd_add(h, low, 2.0 * eta * PI[0], 2.0 * eta * PI[1])


@kernel()
def precession_constants(
    motion: ConstantsOfMotion,
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
) -> PrecessionConstants:
    """Return the constants of the attitude of a periodic motion, or one on the separatrix.

    Parameters
    ----------
    i, it, w, wt : ndarray, shape (3,)
        As in `constants_of_motion`.
    """
    c = circulation(i, it, w, wt, motion.circled)
    eta = 1.0 if motion.circled == 2 else -1.0
    far = amplitudes(c)
    t = turning(c, far.c, far.d)
    M_b = sc_mul(c.I_b, far.b)
    a_x, a_y, a_z = sc_pair(sc_div(t.M_c, t.L))[0], sc_pair(sc_div(M_b, t.L))[0], sc_pair(sc_div(t.M_d, t.L))[0]
    lat = motion.lattice
    if motion.regime == SEPARATRIX:
        # m = 1: x is the angle itself, and K' = pi/2.
        xh, xl = rf_of_roots(t.cosine, t.cosine_tail, 1.0, 0.0, 1.0, 0.0)
        xh, xl = dd_mul(xh, xl, t.sine, t.sine_tail)
        xh, xl = 0.5 * xh, 0.5 * xl
        sh, sl, ch, cl = _sin_cos_dd(xh, xl)
        nh, nl = dd_div(sh, sl, ch, cl)
        th, tl = dd_add(t.kappa, t.kappa_tail, 0.5 * eta * nh, 0.5 * eta * nl)
        # u per scaled time is the rate; quarter turns are pi/2.
        rh, rl = dd_mul(th, tl, motion.rate, motion.rate_tail)
        rh, rl = dd_div(rh, rl, 0.5 * PI[0], 0.5 * PI[1])
        quarter = Quarter(0.0, 0.0, xh, ch, sh, 0.0, 0.0, 0.0, 0.0)
        return PrecessionConstants(LIMIT, eta, a_x, eta * a_y, a_z, rh, rl, quarter)
    mean = 0.0, 0.0
    kh, kl = sc_pair(c.k)
    if kh > 0.0:
        mean = agm_dd(kh, kl)
    of = Periods(lat.circular, lat.K, lat.K_tail, lat.scale, lat.scale_tail, mean[0], mean[1], 0.0, 0.0)
    quarter = quarter_turn(c, t, of)
    rh, rl = dd_mul(quarter.per_quarter, quarter.per_quarter_tail, motion.rate, motion.rate_tail)
    rh, rl = dd_div(rh, rl, 0.5 * PI[0], 0.5 * PI[1])
    branch = CIRCULAR if lat.circular else HYPERBOLIC
    return PrecessionConstants(branch, eta, a_x, eta * a_y, a_z, rh, rl, quarter)

"""The attitude of a free rigid body in closed form: a quaternion without sign jumps, in every regime, at any horizon.

With axes x' = e_c, z' = e_d (each pointing where w starts) and y' completing them, m = M/L has m_z' > 0 always, and

    R = Rz(psi) P(m),      P the shortest arc that takes m to z',      psi' = (2E + L w_z')/(L + M_z').

psi = kappa u + 2 eta arg theta4(z - i xi | q^2) with z = pi u/2K, xi = pi x/2K, sc(x|m1)^2 = I_c|I_d-I_b| / (I_d|I_b-I_c|), and
eta = +1 about the largest moment, -1 about the smallest. Near the separatrix theta4 is taken by Jacobi's imaginary
transformation: near even quarter periods arg theta4 = r eta_x + arg theta2(w | q'^(1/2)), near odd ones with theta3, where
w = eta_x + i (scale/2) r and eta_x = pi x/4K'. The half angle psi/2 enters the quaternion itself, so its sign never jumps.

References
----------
C. G. J. Jacobi, "Sur la rotation d'un corps", Journal für die reine und angewandte Mathematik 39 (1849) 293.
E. T. Whittaker, "Analytical Dynamics", section 69. NIST Digital Library of Mathematical Functions, 20.7(viii).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import fma, kernel
from core.double_double import (
    PI,
    Pair,
    Scaled,
    dd_add,
    dd_add_d,
    dd_div,
    dd_exp,
    dd_mul,
    dd_mul_d,
    dd_sqr,
    dd_sqrt,
    dd_sub,
    sc_abs,
    sc_add,
    sc_div,
    sc_mul,
    sc_pair,
    sc_sqrt,
    scaled,
    two_prod,
)
from core.elliptic import (
    agm_dd,
    half_parity,
    rf_of_roots,
    separatrix_at,
    sin_cos_quarter,
    sinh_cosh,
    split_phase,
    theta_parts,
)
from core.errors import InvalidParameter
from core.integration.system import Floats
from core.rotation.closed_form import DERIVED_ROUNDING, SET_UP_ROUNDING, UNIT_ROUNDOFF, FreeRotation, growth
from core.rotation.constants_of_motion import PERIODIC, REST, SEPARATRIX, STEADY, Motion

ATTITUDE_ERROR = 12.0 * UNIT_ROUNDOFF
"""Bound of the error of one attitude, as the largest change of a unit vector that it turns."""

CIRCULAR, HYPERBOLIC, LIMIT = range(3)


class Precession(NamedTuple):
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
    per_quarter: float
    per_quarter_tail: float
    """Radians of psi/2 per quarter period, periodic part included (it closes over two quarters)."""
    eta_x: float
    cos_x: float
    sin_x: float
    """eta_x with its cosine and sine."""
    theta_c1: float
    theta_s1: float
    theta_c2: float
    theta_s2: float
    """2 q^2 cosh 2xi, 2 q^2 sinh 2xi, 2 q^8 cosh 4xi, 2 q^8 sinh 4xi."""


@kernel()
def _sin_cos_dd(ah: float, al: float) -> tuple[float, float, float, float]:
    """Return sin a and cos a as pairs, for 0 <= a <= pi/4, by their Taylor series."""
    wh, wl = dd_sqr(ah, al)
    sh, sl, ch, cl = 0.0, 0.0, 0.0, 0.0
    for n in range(27, 0, -2):
        # sin a/a = 1 - w/(2 3) (1 - w/(4 5) (...)),  cos a = 1 - w/(1 2) (1 - w/(3 4) (...))
        th, tl = dd_add_d(-sh, -sl, 1.0)
        th, tl = dd_mul(th, tl, wh, wl)
        sh, sl = dd_div(th, tl, float((n + 1) * (n + 2)), 0.0)
        th, tl = dd_add_d(-ch, -cl, 1.0)
        th, tl = dd_mul(th, tl, wh, wl)
        ch, cl = dd_div(th, tl, float(n * (n + 1)), 0.0)
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


@kernel()
def precession_constants(
    motion: Motion, i: NDArray[np.float64], it: NDArray[np.float64], w: NDArray[np.float64], wt: NDArray[np.float64]
) -> Precession:
    """Return the constants of the attitude of a motion that turns (periodic or on the separatrix).

    Parameters
    ----------
    i, it, w, wt : ndarray, shape (3,)
        As in `constants_of_motion`.
    """
    IA, IB, IC = scaled(i[0], it[0], 0), scaled(i[1], it[1], 0), scaled(i[2], it[2], 0)
    WA, WB, WC = sc_abs(scaled(w[0], wt[0], 0)), sc_abs(scaled(w[1], wt[1], 0)), sc_abs(scaled(w[2], wt[2], 0))
    bc, bl = dd_sub(i[1], it[1], i[0], it[0])
    AB = scaled(bc, bl, 0)
    bc, bl = dd_sub(i[2], it[2], i[1], it[1])
    BC = scaled(bc, bl, 0)
    bc, bl = dd_sub(i[2], it[2], i[0], it[0])
    AC = scaled(bc, bl, 0)
    TA, TB, TC = sc_mul(WA, WA), sc_mul(WB, WB), sc_mul(WC, WC)
    if motion.circled == 2:
        eta, I_d, I_c, db, cb = 1.0, IC, IA, BC, AB
        X = sc_add(sc_mul(sc_mul(IA, AC), TA), sc_mul(sc_mul(IB, BC), TB))
        Y = sc_add(sc_mul(sc_mul(IC, AC), TC), sc_mul(sc_mul(IB, AB), TB))
    else:
        eta, I_d, I_c, db, cb = -1.0, IA, IC, AB, BC
        X = sc_add(sc_mul(sc_mul(IC, AC), TC), sc_mul(sc_mul(IB, AB), TB))
        Y = sc_add(sc_mul(sc_mul(IA, AC), TA), sc_mul(sc_mul(IB, BC), TB))
    Ac = sc_sqrt(sc_div(X, sc_mul(I_c, AC)))
    Ab = sc_sqrt(sc_div(X, sc_mul(IB, db)))
    Ad = sc_sqrt(sc_div(Y, sc_mul(I_d, AC)))
    Mc, Mb, Md = sc_mul(I_c, Ac), sc_mul(IB, Ab), sc_mul(I_d, Ad)
    L = sc_sqrt(sc_add(sc_mul(Mc, Mc), sc_mul(Md, Md)))
    a_x, a_y, a_z = sc_pair(sc_div(Mc, L))[0], sc_pair(sc_div(Mb, L))[0], sc_pair(sc_div(Md, L))[0]
    # psi' at u = 0, where w = (A_c, 0, A_d) in x', y', z'.
    top = sc_add(sc_add(sc_mul(Mc, Ac), sc_mul(Md, Ad)), sc_mul(L, Ad))
    slope = sc_div(top, sc_add(L, Md))
    p = sc_sqrt(sc_div(sc_mul(db, Y), sc_mul(IA, sc_mul(IB, IC))))
    kh, kl = sc_pair(sc_div(slope, p))
    kh, kl = 0.5 * kh, 0.5 * kl
    # x by R_F; sin^2 = I_c|I_d-I_b|/(I_b|I_d-I_c|), cos^2 = I_d|I_b-I_c|/(I_b|I_d-I_c|).
    base = sc_mul(IB, AC)
    sinh_, sinl = sc_pair(sc_sqrt(sc_div(sc_mul(I_c, db), base)))
    cosh_, cosl = sc_pair(sc_sqrt(sc_div(sc_mul(I_d, cb), base)))
    lat = motion.lattice
    if motion.regime == SEPARATRIX:
        # m = 1: x is the angle itself, and K' = pi/2.
        xh, xl = rf_of_roots(cosh_, cosl, 1.0, 0.0, 1.0, 0.0)
        xh, xl = dd_mul(xh, xl, sinh_, sinl)
        xh, xl = 0.5 * xh, 0.5 * xl
        sh, sl, ch, cl = _sin_cos_dd(xh, xl)
        nh, nl = dd_div(sh, sl, ch, cl)
        th, tl = dd_add(kh, kl, 0.5 * eta * nh, 0.5 * eta * nl)
        # u per scaled time is the rate; quarter turns are pi/2.
        rh, rl = dd_mul(th, tl, motion.rate, motion.rate_tail)
        rh, rl = dd_div(rh, rl, 0.5 * PI[0], 0.5 * PI[1])
        return Precession(LIMIT, eta, a_x, eta * a_y, a_z, rh, rl, 0.0, 0.0, xh, ch, sh, 0.0, 0.0, 0.0, 0.0)
    ah, al = dd_mul(kh, kl, lat.K, lat.K_tail)
    k1h, k1l = sc_pair(sc_sqrt(sc_div(sc_mul(cb, X), sc_mul(db, Y))))
    eta_x, cos_x, sin_x, c1, s1, c2, s2 = 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if not (lat.circular and k1h < 1e-33):
        # dn-like root cos^2 + m sin^2
        mh, ml = dd_mul(k1h, k1l, sinh_, sinl)
        ch, cl = dd_sqr(cosh_, cosl)
        mh, ml = dd_sqr(mh, ml)
        dh, dl = dd_add(ch, cl, mh, ml)
        dh, dl = dd_sqrt(dh, dl)
        xh, xl = rf_of_roots(cosh_, cosl, dh, dl, 1.0, 0.0)
        xh, xl = dd_mul(xh, xl, sinh_, sinl)
        gh, gl = agm_dd(k1h, k1l)
        if lat.circular:
            # xi = pi x/2K; q = exp(-pi K'/K) with K' = pi/2 agm(1, k).
            zh, zl = dd_div(xh, xl, lat.K, lat.K_tail)
            zh, zl = dd_mul(zh, zl, 0.5 * PI[0], 0.5 * PI[1])
            gh, gl = dd_mul(gh, gl, lat.K, lat.K_tail)
            qh, ql = dd_div(-0.5 * PI[0], -0.5 * PI[1], gh, gl)
            qh, ql = dd_mul(qh, ql, PI[0], PI[1])
            qh, ql = dd_exp(qh, ql)
            nh, nl, c1, s1, c2, s2 = _theta4_slope(zh, zl, qh, ql)
            nh, nl = dd_mul(nh, nl, 0.5 * PI[0], 0.5 * PI[1])
            ah, al = dd_add(ah, al, eta * nh, eta * nl)
        else:
            # eta_x = pi x/4K' = x agm(1, k)/2.
            zh, zl = dd_mul(xh, xl, gh, gl)
            zh, zl = 0.5 * zh, 0.5 * zl
            qh, ql = 0.0, 0.0
            if lat.scale < 300.0:
                qh, ql = dd_exp(-2.0 * lat.scale, -2.0 * lat.scale_tail)
            sh, sl, ch, cl = _sin_cos_dd(zh, zl)
            nh, nl = _theta2_slope(sh, sl, ch, cl, qh, ql)
            nh, nl = dd_mul(nh, nl, 0.5 * lat.scale, 0.5 * lat.scale_tail)
            nh, nl = dd_sub(zh, zl, nh, nl)
            ah, al = dd_add(ah, al, -eta * nh, -eta * nl)
            eta_x, cos_x, sin_x = zh, ch, sh
    rh, rl = dd_mul(ah, al, motion.rate, motion.rate_tail)
    rh, rl = dd_div(rh, rl, 0.5 * PI[0], 0.5 * PI[1])
    branch = CIRCULAR if lat.circular else HYPERBOLIC
    return Precession(branch, eta, a_x, eta * a_y, a_z, rh, rl, ah, al, eta_x, cos_x, sin_x, c1, s1, c2, s2)


@kernel()
def _theta_phase(pre: Precession, q: float, root: float, odd: bool, s1: float, c1: float) -> tuple[float, float]:
    """Return a multiple of theta2 (near even quarters) or theta3 (odd) of eta_x + i y, given sinh y and cosh y."""
    # cos w and cos 2w for w = eta_x + i y
    wr, wi = pre.cos_x * c1, -pre.sin_x * s1
    zr, zi = 2.0 * (wr * wr - wi * wi) - 1.0, 4.0 * wr * wi
    if odd:
        # b_n = Q^(n^2) cos 2nw, Q = q^(1/2): b_{n+1} = 2 Q^(2n+1) cos 2w b_n - Q^(4n) b_{n-1}
        br, bi, ar, ai = root * zr, root * zi, 1.0, 0.0
        tr, ti = 1.0 + 2.0 * br, 2.0 * bi
        step, back = 2.0 * root * q, q * q
        for _ in range(4):
            nr = step * (zr * br - zi * bi) - back * ar
            ni = step * (zr * bi + zi * br) - back * ai
            ar, ai, br, bi = br, bi, nr, ni
            tr, ti = tr + 2.0 * br, ti + 2.0 * bi
            step, back = step * q, back * q * q
        return tr, ti
    # b_n = Q^(n(n+1)) cos(2n+1)w: b_{n+1} = 2 Q^(2n+2) cos 2w b_n - Q^(4n+2) b_{n-1}, b_{-1} = b_0
    br, bi, ar, ai = wr, wi, wr, wi
    tr, ti = wr, wi
    step, back = 2.0 * q, q
    for _ in range(4):
        nr = step * (zr * br - zi * bi) - back * ar
        ni = step * (zr * bi + zi * br) - back * ai
        ar, ai, br, bi = br, bi, nr, ni
        tr, ti = tr + br, ti + bi
        step, back = step * q, back * q * q
    return tr, ti


@kernel()
def _attitude_at(motion: Motion, pre: Precession, time: float) -> tuple[float, float, float, float]:
    """Return the quaternion Rz(psi) P at one time."""
    t = motion.time_scale * time
    if pre.branch == LIMIT:
        xh, xl = two_prod(motion.rate, t)
        yh, yl = dd_add(xh, xl + motion.rate_tail * t, motion.start, motion.start_tail)
        sn, cn = separatrix_at(yh, yl)
        dn = cn
        half, _ = separatrix_at(0.5 * yh, 0.5 * yl)
        tr, ti = pre.cos_x, -pre.sin_x * half
        extra = 0.0
    else:
        lat = motion.lattice
        n, r, r_tail = split_phase(motion.rate, motion.rate_tail, t, motion.start, motion.start_tail)
        odd, sign = half_parity(n + motion.start_quarter)
        if pre.branch == CIRCULAR:
            s, c = sin_cos_quarter(r, r_tail)
            S, C, D3, D4 = theta_parts(True, lat.nome, lat.root_nome, s, c)
            # cos 2z and sin 2z of the whole argument
            parity = -1.0 if odd else 1.0
            c2, s2 = parity * fma(-2.0 * s, s, 1.0), parity * 2.0 * s * c
            tr = 1.0 - pre.theta_c1 * c2 + pre.theta_c2 * (2.0 * c2 * c2 - 1.0)
            ti = -pre.theta_s1 * s2 + pre.theta_s2 * 2.0 * s2 * c2
            extra = 0.0
            if odd:
                sn, cn, dn = sign * lat.odd_sn * C / D3, sign * lat.odd_cn * S / D3, lat.odd_dn * D4 / D3
            else:
                sn, cn, dn = sign * lat.even_sn * S / D4, sign * lat.even_cn * C / D4, lat.even_dn * D3 / D4
        else:
            xh, xl = two_prod(r, lat.scale)
            xl += fma(r, lat.scale_tail, r_tail * lat.scale)
            s1, c1 = sinh_cosh(0.5 * xh, 0.5 * xl)
            S, C, D3, D4 = theta_parts(False, lat.nome, lat.root_nome, 2.0 * s1 * c1, fma(2.0 * s1, s1, 1.0))
            if odd:
                sn, cn, dn = sign * lat.odd_sn * D4 / D3, sign * lat.odd_cn * S / D3, lat.odd_dn * C / D3
            else:
                sn, cn, dn = sign * lat.even_sn * S / C, sign * lat.even_cn * D4 / C, lat.even_dn * D3 / C
            tr, ti = _theta_phase(pre, lat.nome, lat.root_nome, odd, s1, c1)
            extra = pre.eta * r * pre.eta_x * 0.6366197723675814
    n, r, r_tail = split_phase(pre.turn, pre.turn_tail, t, extra, 0.0)
    s, c = sin_cos_quarter(r, r_tail)
    odd, sign = half_parity(n)
    if odd:
        s, c = c, -s
    s, c = sign * s, sign * c
    ti *= pre.eta
    m_x, m_y, m_z = pre.a_x * cn, pre.a_y * sn, pre.a_z * dn
    lift = 1.0 + m_z
    over = 1.0 / math.sqrt((tr * tr + ti * ti) * (lift * lift + m_x * m_x + m_y * m_y))
    zr, zi = (c * tr - s * ti) * over, (s * tr + c * ti) * over
    return zr * lift, zr * m_y + zi * m_x, zi * m_y - zr * m_x, zi * lift


@kernel()
def phase_at_start(motion: Motion, pre: Precession) -> tuple[float, float]:
    """Return cosine and sine, times a positive factor, of the periodic part of psi/2 at t = 0."""
    if pre.branch == LIMIT:
        half, _ = separatrix_at(0.5 * motion.start, 0.5 * motion.start_tail)
        return pre.cos_x, -pre.eta * pre.sin_x * half
    lat = motion.lattice
    odd, _ = half_parity(motion.start_quarter)
    if pre.branch == CIRCULAR:
        s, c = sin_cos_quarter(motion.start, motion.start_tail)
        parity = -1.0 if odd else 1.0
        c2, s2 = parity * fma(-2.0 * s, s, 1.0), parity * 2.0 * s * c
        tr = 1.0 - pre.theta_c1 * c2 + pre.theta_c2 * (2.0 * c2 * c2 - 1.0)
        return tr, pre.eta * (pre.theta_s2 * 2.0 * s2 * c2 - pre.theta_s1 * s2)
    xh, xl = two_prod(motion.start, 0.5 * lat.scale)
    s1, c1 = sinh_cosh(xh, xl + 0.5 * fma(motion.start, lat.scale_tail, motion.start_tail * lat.scale))
    tr, ti = _theta_phase(pre, lat.nome, lat.root_nome, odd, s1, c1)
    ti *= pre.eta
    angle = pre.eta * motion.start * pre.eta_x
    s, c = math.sin(angle), math.cos(angle)
    return tr * c - ti * s, tr * s + ti * c


@kernel()
def sample_attitude(
    motion: Motion, pre: Precession, times: NDArray[np.float64], turn: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """Fill `out`, shape (4, n), with `turn`, shape (4, 4), applied to the quaternions Rz(psi) P."""
    for i in range(times.size):
        w, x, y, z = _attitude_at(motion, pre, times[i])
        for k in range(4):
            out[k, i] = fma(turn[k, 0], w, fma(turn[k, 1], x, fma(turn[k, 2], y, turn[k, 3] * z)))


@kernel()
def _steady(
    rate: float,
    tail: float,
    axis: NDArray[np.float64],
    scale: float,
    times: NDArray[np.float64],
    turn: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` with `turn` applied to the quaternions of a rotation about `axis` by `rate` quarter turns of half angle."""
    for i in range(times.size):
        n, r, r_tail = split_phase(rate, tail, scale * times[i], 0.0, 0.0)
        s, c = sin_cos_quarter(r, r_tail)
        odd, sign = half_parity(n)
        if odd:
            s, c = c, -s
        s, c = sign * s, sign * c
        for k in range(4):
            out[k, i] = turn[k, 0] * c + s * (turn[k, 1] * axis[0] + turn[k, 2] * axis[1] + turn[k, 3] * axis[2])


@kernel()
def _spin(v: NDArray[np.float64]) -> tuple[float, float, float]:
    """Return |v|/pi, quarter turns of half angle per unit time: mantissa as a pair and a power of two."""
    total = Scaled(0.0, 0.0, 0)
    for k in range(3):
        x = scaled(v[k], 0.0, 0)
        total = sc_add(total, sc_mul(x, x))
    norm = sc_sqrt(total)
    h, low = dd_div(norm.high, norm.low, PI[0], PI[1])
    return h, low, float(norm.exponent)


Extended = NDArray[np.longdouble]
"""What is formed once per motion and multiplies every sample is formed with the longest floats at hand, then rounded."""


def left(q: Extended) -> Extended:
    """Return the matrix L(q), shape (4, 4), of q p = L(q) p."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])


def right(q: Extended) -> Extended:
    """Return the matrix R(q), shape (4, 4), of p q = R(q) p."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, z, -y], [y, -z, w, x], [z, y, -x, w]])


def unit(q: Extended) -> Extended:
    """Return q/|q|."""
    shortened = q / np.max(np.abs(q))
    return shortened / np.sqrt(np.sum(shortened * shortened))


def quaternion_of(m: Extended) -> Extended:
    """Return the quaternion of a rotation matrix, shape (3, 3), by its largest component (S. W. Shepperd, 1978)."""
    diagonal = [
        1 + m[0, 0] + m[1, 1] + m[2, 2],
        1 + m[0, 0] - m[1, 1] - m[2, 2],
        1 - m[0, 0] + m[1, 1] - m[2, 2],
        1 - m[0, 0] - m[1, 1] + m[2, 2],
    ]
    a, b, c = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    d, e, f = m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] + m[1, 2]
    s = diagonal
    rows = [[s[0], a, b, c], [a, s[1], d, e], [b, d, s[2], f], [c, e, f, s[3]]]
    return unit(np.array(rows[int(np.argmax(diagonal))]))


@dataclass(frozen=True, eq=False)
class FreeAttitude:
    """The attitude of a free rotation, body to space: v_space = R v_body.

    Attributes
    ----------
    rotation : FreeRotation
    attitude : ndarray, shape (4,)
        Quaternion [w, x, y, z] at t = 0; any length but zero, normalised here.
    """

    rotation: FreeRotation
    attitude: Floats

    def __post_init__(self) -> None:
        if not np.any(self.attitude):
            raise InvalidParameter(
                "attitude", "not be zero", remedy="give a unit quaternion [w, x, y, z]; [1, 0, 0, 0] is no turn"
            )

    @cached_property
    def constants(self) -> Precession:
        """Constants of the precession about the angular momentum, where the angular velocity changes."""
        i = self.rotation.inertia
        w, wt = self.rotation.start
        constants: Precession = precession_constants(self.rotation.motion, i.moments, i.moments_tail, w, wt)
        return constants

    @property
    def precession_per_period(self) -> float | None:
        """Angle by which the circled axis turns about the angular momentum in one period, not reduced (rad)."""
        if self.rotation.motion.regime != PERIODIC:
            return None
        # Rz(psi) turns by 8 quarters of psi/2; it differs from Euler's angle of the circled axis by the one turn that
        # the shortest arc P makes with m.
        c = self.constants
        h, low = dd_mul_d(c.per_quarter, c.per_quarter_tail, 8.0)
        return float(dd_add(h, low, 2.0 * c.eta * PI[0], 2.0 * c.eta * PI[1])[0])

    def sample(self, times: Floats) -> Floats:
        """Return unit quaternions [w, x, y, z], shape (n, 4), continuous in time from the one at t = 0."""
        times = np.ascontiguousarray(times, dtype=np.float64)
        self.rotation.horizon(times)
        motion = self.rotation.motion
        start = unit(self.attitude.astype(np.longdouble))
        out = np.empty((4, times.size))
        if motion.regime == REST:
            out[:] = start.astype(np.float64)[:, None]
        elif motion.regime == STEADY:
            v = np.ascontiguousarray(self.rotation.angular_velocity, dtype=np.float64)
            h, low, exponent = _spin(v)
            axis = unit(v.astype(np.longdouble)).astype(np.float64)
            _steady(h, low, axis, math.ldexp(1.0, int(exponent)), times, left(start).astype(np.float64), out)
        else:
            sample_attitude(motion, self.constants, times, self._onto(start), out)
        return out.T

    def error(self, times: Floats) -> float:
        """Return a bound of the error of `sample`: how far it may turn a unit vector wrongly, inputs taken as exact."""
        motion, horizon = self.rotation.motion, self.rotation.horizon(times)
        if motion.regime == REST:
            return UNIT_ROUNDOFF
        if motion.regime == STEADY:
            return ATTITUDE_ERROR
        turned = abs(self.constants.turn) * motion.time_scale * horizon * math.pi
        set_up = SET_UP_ROUNDING if self.rotation.exact_inputs else DERIVED_ROUNDING
        sensitivity = motion.computed if self.rotation.exact_inputs else motion.inherited
        return ATTITUDE_ERROR + min(2.0, 8.0 * set_up * turned) + 4.0 * growth(sensitivity, set_up, horizon)

    def _onto(self, start: Extended) -> Floats:
        """Return what turns Rz(psi) P, which starts where it may, into the attitude, which starts at `start`."""
        rotation, motion = self.rotation, self.rotation.motion
        principal = rotation.inertia.axes.astype(np.longdouble) + rotation.inertia.axes_tail
        i = rotation.inertia.moments.astype(np.longdouble) + rotation.inertia.moments_tail
        w = rotation.start[0].astype(np.longdouble) + rotation.start[1]
        c, d = (0, 2) if motion.circled == 2 else (2, 0)
        towards_c = math.copysign(1.0, motion.A_c) if motion.regime == SEPARATRIX else 1.0
        x, z = np.zeros(3, np.longdouble), np.zeros(3, np.longdouble)
        x[c], z[d] = towards_c, math.copysign(1.0, motion.A_d)
        axes = np.column_stack([x, np.cross(z, x), z])
        m = unit(axes.T @ (i / np.max(i) * (w / np.max(np.abs(w)))))
        arc = unit(np.array([1 + m[2], m[1], -m[0], 0], np.longdouble))
        tr, ti = phase_at_start(motion, self.constants)
        first = left(unit(np.array([tr, 0, 0, ti], np.longdouble))) @ arc
        q = quaternion_of(principal @ axes)
        conjugate = np.array([1, -1, -1, -1], np.longdouble)
        before = left(start) @ left(q) @ (first * conjugate)
        onto: Floats = np.ascontiguousarray(left(before) @ right(q * conjugate), dtype=np.float64)
        return onto

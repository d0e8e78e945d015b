"""Quaternions along a torque-free motion at any times, compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from core.compiled import fma, kernel
from core.double_double import dd_add, two_prod
from core.elliptic.functions import half_parity, separatrix_at, sin_cos_quarter, sinh_cosh, split_phase, theta_parts
from core.rotation.constants_of_motion import Motion
from core.rotation.precession_constants import CIRCULAR, LIMIT, Precession


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
                sn, cn, dn = sign * lat.odd_sn[0] * C / D3, sign * lat.odd_cn[0] * S / D3, lat.odd_dn[0] * D4 / D3
            else:
                sn, cn, dn = sign * lat.even_sn[0] * S / D4, sign * lat.even_cn[0] * C / D4, lat.even_dn[0] * D3 / D4
        else:
            xh, xl = two_prod(r, lat.scale)
            xl += fma(r, lat.scale_tail, r_tail * lat.scale)
            s1, c1 = sinh_cosh(0.5 * xh, 0.5 * xl)
            S, C, D3, D4 = theta_parts(False, lat.nome, lat.root_nome, 2.0 * s1 * c1, fma(2.0 * s1, s1, 1.0))
            if odd:
                sn, cn, dn = sign * lat.odd_sn[0] * D4 / D3, sign * lat.odd_cn[0] * S / D3, lat.odd_dn[0] * C / D3
            else:
                sn, cn, dn = sign * lat.even_sn[0] * S / C, sign * lat.even_cn[0] * D4 / C, lat.even_dn[0] * D3 / C
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
def sample_steady(
    rate: float,
    tail: float,
    axis: NDArray[np.float64],
    scale: float,
    times: NDArray[np.float64],
    turn: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` with `turn` applied to a rotation about `axis`; `rate` counts quarter turns of the half angle."""
    for i in range(times.size):
        n, r, r_tail = split_phase(rate, tail, scale * times[i], 0.0, 0.0)
        s, c = sin_cos_quarter(r, r_tail)
        odd, sign = half_parity(n)
        if odd:
            s, c = c, -s
        s, c = sign * s, sign * c
        for k in range(4):
            out[k, i] = turn[k, 0] * c + s * (turn[k, 1] * axis[0] + turn[k, 2] * axis[1] + turn[k, 3] * axis[2])

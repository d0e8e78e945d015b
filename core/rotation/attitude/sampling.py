"""Quaternions along a torque-free motion at any times, compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import fma, kernel
from core.double_double import dd_add, two_prod
from core.elliptic.functions import half_parity, separatrix_at, sin_cos_quarter, sinh_cosh, split_phase, theta_parts
from core.elliptic.lattice import Lattice
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion, Weights
from core.rotation.closed_form.sampling import about_quarter
from core.rotation.precession.constants import CIRCULAR, LIMIT, PrecessionConstants, Quarter


class _Term(NamedTuple):
    """Two terms of a theta series one after the other, and their sum, complex."""

    before_r: float
    before_i: float
    r: float
    i: float
    sum_r: float
    sum_i: float


@kernel()
def _next(t: _Term, zr: float, zi: float, step: float, back: float, weight: float) -> _Term:
    nr = step * (zr * t.r - zi * t.i) - back * t.before_r
    ni = step * (zr * t.i + zi * t.r) - back * t.before_i
    return _Term(t.r, t.i, nr, ni, t.sum_r + weight * nr, t.sum_i + weight * ni)


@kernel()
def _theta23_phase(
    pre: PrecessionConstants, q: float, root: float, odd: bool, s1: float, c1: float
) -> tuple[float, float]:
    """Return a multiple of theta2 (near even quarters) or theta3 (odd) of eta_x + i y, given sinh y and cosh y.

    With w = eta_x + i y, Q = q^(1/2): theta3 ~ 1 + 2 sum b_n, b_n = Q^(n^2) cos 2nw, b_{n+1} = 2 Q^(2n+1) cos 2w b_n -
    Q^(4n) b_{n-1}; theta2 ~ sum b_n, b_n = Q^(n(n+1)) cos(2n+1)w, b_{n+1} = 2 Q^(2n+2) cos 2w b_n - Q^(4n+2) b_{n-1}
    with b_{-1} = b_0. Both use the same recurrence with different initial values, without branches.
    """
    wr, wi = pre.quarter.cos_x * c1, -pre.quarter.sin_x * s1
    # cos 2w
    zr, zi = 2.0 * (wr * wr - wi * wi) - 1.0, 4.0 * wr * wi
    weight = 2.0 if odd else 1.0
    rate = root if odd else 1.0
    more = q if odd else 1.0
    first_r, first_i = root * zr, root * zi
    br = first_r if odd else wr
    bi = first_i if odd else wi
    ar = 1.0 if odd else wr
    ai = 0.0 if odd else wi
    constant = 1.0 if odd else 0.0
    q2 = q * q
    step, back = 2.0 * q * rate, q * more
    t = _Term(ar, ai, br, bi, constant + weight * br, weight * bi)
    t = _next(t, zr, zi, step, back, weight)
    t = _next(t, zr, zi, step * q, back * q2, weight)
    t = _next(t, zr, zi, step * q2, back * q2 * q2, weight)
    t = _next(t, zr, zi, step * q2 * q, back * q2 * q2 * q2, weight)
    return t.sum_r, t.sum_i


@kernel(inline="always")
def _theta4_phase(quarter: Quarter, odd: bool, s: float, c: float) -> tuple[float, float]:
    """Return theta4 of z - i xi and the nome q^2, s and c the sine and cosine of z less the nearest quarter period."""
    # cos 2z and sin 2z of the whole argument
    parity = -1.0 if odd else 1.0
    c2, s2 = parity * fma(-2.0 * s, s, 1.0), parity * 2.0 * s * c
    tr = 1.0 - quarter.theta_c1 * c2 + quarter.theta_c2 * (2.0 * c2 * c2 - 1.0)
    return tr, quarter.theta_s2 * 2.0 * s2 * c2 - quarter.theta_s1 * s2


class _Instant(NamedTuple):
    """The constituents of a quaternion Rz(psi) P: the unit vector m of the angular momentum in the body, and psi/2.

    psi/2 is a rate times time, plus `extra` quarters, plus the argument of `phase_r` + i `phase_i`.
    """

    sn: float
    cn: float
    dn: float
    phase_r: float
    phase_i: float
    extra: float


@kernel(inline="always")
def _unweighted(lat: Lattice) -> Weights:
    """Return the constants of the theta quotients without amplitudes."""
    return Weights(lat.even_cn[0], lat.even_sn[0], lat.even_dn[0], lat.odd_cn[0], lat.odd_sn[0], lat.odd_dn[0])


# Inlined before loop optimisation: as calls they would be too long to be vectorised by four samples.
@kernel(inline="always")
def _near_circular(motion: ConstantsOfMotion, pre: PrecessionConstants, t: float) -> _Instant:
    lat = motion.lattice
    n, r, r_tail = split_phase(motion.rate, motion.rate_tail, t, motion.start, motion.start_tail)
    odd, sign = half_parity(n + motion.start_quarter)
    s, c = sin_cos_quarter(r, r_tail)
    S, C, D3, D4 = theta_parts(True, lat.nome, 0.0, s, c)
    cn, sn, dn = about_quarter(odd, sign, S, C, D3, D4, _unweighted(lat))
    tr, ti = _theta4_phase(pre.quarter, odd, s, c)
    return _Instant(sn, cn, dn, tr, ti, 0.0)


@kernel(inline="always")
def _near_the_separatrix(motion: ConstantsOfMotion, pre: PrecessionConstants, t: float) -> _Instant:
    lat = motion.lattice
    n, r, r_tail = split_phase(motion.rate, motion.rate_tail, t, motion.start, motion.start_tail)
    odd, sign = half_parity(n + motion.start_quarter)
    xh, xl = two_prod(r, lat.scale)
    xl += fma(r, lat.scale_tail, r_tail * lat.scale)
    s1, c1 = sinh_cosh(0.5 * xh, 0.5 * xl)
    S, C, D3, D4 = theta_parts(False, lat.nome, lat.root_nome, 2.0 * s1 * c1, fma(2.0 * s1, s1, 1.0))
    cn, sn, dn = about_quarter(odd, sign, S, D4, D3, C, _unweighted(lat))
    tr, ti = _theta23_phase(pre, lat.nome, lat.root_nome, odd, s1, c1)
    return _Instant(sn, cn, dn, tr, ti, pre.eta * r * pre.quarter.eta_x * 0.6366197723675814)


@kernel()
def _on_the_separatrix(motion: ConstantsOfMotion, pre: PrecessionConstants, t: float) -> _Instant:
    xh, xl = two_prod(motion.rate, t)
    yh, yl = dd_add(xh, xl + motion.rate_tail * t, motion.start, motion.start_tail)
    tanh, sech = separatrix_at(yh, yl)
    half, _ = separatrix_at(0.5 * yh, 0.5 * yl)
    return _Instant(tanh, sech, sech, pre.quarter.cos_x, -pre.quarter.sin_x * half, 0.0)


@kernel(inline="always")
def _quaternion(pre: PrecessionConstants, t: float, at: _Instant) -> tuple[float, float, float, float]:
    """Return Rz(psi) P."""
    n, r, r_tail = split_phase(pre.turn, pre.turn_tail, t, at.extra, 0.0)
    sine, cosine = sin_cos_quarter(r, r_tail)
    odd, sign = half_parity(n)
    s, c = sign * (cosine if odd else sine), sign * (-sine if odd else cosine)
    tr, ti = at.phase_r, pre.eta * at.phase_i
    m_x, m_y, m_z = pre.a_x * at.cn, pre.a_y * at.sn, pre.a_z * at.dn
    lift = 1.0 + m_z
    over = 1.0 / math.sqrt((tr * tr + ti * ti) * (lift * lift + m_x * m_x + m_y * m_y))
    zr, zi = (c * tr - s * ti) * over, (s * tr + c * ti) * over
    return zr * lift, zr * m_y + zi * m_x, zi * m_y - zr * m_x, zi * lift


@kernel()
def phase_at_start(motion: ConstantsOfMotion, pre: PrecessionConstants) -> tuple[float, float]:
    """Return cosine and sine, times a positive factor, of the periodic part of psi/2 at t = 0."""
    if pre.branch == LIMIT:
        half, _ = separatrix_at(0.5 * motion.start, 0.5 * motion.start_tail)
        return pre.quarter.cos_x, -pre.eta * pre.quarter.sin_x * half
    lat = motion.lattice
    odd, _ = half_parity(motion.start_quarter)
    if pre.branch == CIRCULAR:
        s, c = sin_cos_quarter(motion.start, motion.start_tail)
        tr, ti = _theta4_phase(pre.quarter, odd, s, c)
        return tr, pre.eta * ti
    xh, xl = two_prod(motion.start, 0.5 * lat.scale)
    s1, c1 = sinh_cosh(xh, xl + 0.5 * fma(motion.start, lat.scale_tail, motion.start_tail * lat.scale))
    tr, ti = _theta23_phase(pre, lat.nome, lat.root_nome, odd, s1, c1)
    ti *= pre.eta
    angle = pre.eta * motion.start * pre.quarter.eta_x
    s, c = math.sin(angle), math.cos(angle)
    return tr * c - ti * s, tr * s + ti * c


class _Row(NamedTuple):
    """A row of a matrix by which quaternions are multiplied."""

    w: float
    x: float
    y: float
    z: float


@kernel()
def _row(turn: NDArray[np.float64], k: int) -> _Row:
    return _Row(turn[k, 0], turn[k, 1], turn[k, 2], turn[k, 3])


@kernel()
def _dot(row: _Row, q: tuple[float, float, float, float]) -> float:
    return fma(row.w, q[0], fma(row.x, q[1], fma(row.y, q[2], row.z * q[3])))


@kernel()
def sample_attitude(
    motion: ConstantsOfMotion,
    pre: PrecessionConstants,
    times: NDArray[np.float64],
    turn: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out`, shape (4, n), with `turn`, shape (4, 4), applied to the quaternions Rz(psi) P."""
    # One array per component and one loop per branch, without branches inside, so the loops are vectorised.
    w, x, y, z = out[0], out[1], out[2], out[3]
    to_w, to_x, to_y, to_z = _row(turn, 0), _row(turn, 1), _row(turn, 2), _row(turn, 3)
    if pre.branch == CIRCULAR:
        for i in range(times.size):
            t = motion.time_scale * times[i]
            q = _quaternion(pre, t, _near_circular(motion, pre, t))
            w[i], x[i], y[i], z[i] = _dot(to_w, q), _dot(to_x, q), _dot(to_y, q), _dot(to_z, q)
    elif pre.branch == LIMIT:
        for i in range(times.size):
            t = motion.time_scale * times[i]
            q = _quaternion(pre, t, _on_the_separatrix(motion, pre, t))
            w[i], x[i], y[i], z[i] = _dot(to_w, q), _dot(to_x, q), _dot(to_y, q), _dot(to_z, q)
    else:
        for i in range(times.size):
            t = motion.time_scale * times[i]
            q = _quaternion(pre, t, _near_the_separatrix(motion, pre, t))
            w[i], x[i], y[i], z[i] = _dot(to_w, q), _dot(to_x, q), _dot(to_y, q), _dot(to_z, q)


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

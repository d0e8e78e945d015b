"""The periods of one modulus and the constants of its theta quotients, set up in double-double, compiled.

* m1 >= 1/2 ("circular"): nome q = exp(-pi K'/K) <= 0.0433, argument z = pi u/2K, trigonometric theta series;
* m1 < 1/2 ("hyperbolic"): Jacobi's imaginary transformation, nome q' = exp(-pi K/K'), argument x = pi u/2K'.

References
----------
NIST Digital Library of Mathematical Functions, 20.2, 20.7 (theta functions), 22.2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from core.compiled import kernel
from core.double_double import PI, Pair, dd_add, dd_add_d, dd_div, dd_exp, dd_mul, dd_sqr, dd_sub
from core.elliptic.integrals import agm_dd


class Lattice(NamedTuple):
    """The periods of one modulus and the constants for evaluation."""

    circular: bool
    K: float
    """Quarter period."""
    K_tail: float
    nome: float
    """q if circular, else q'."""
    root_nome: float
    scale: float
    """A quarter period in the argument of the theta functions: pi/2, or pi K/2K'."""
    scale_tail: float
    even_sn: Pair
    even_cn: Pair
    even_dn: Pair
    odd_sn: Pair
    odd_cn: Pair
    odd_dn: Pair
    """Constant factors of the quotients near even and odd quarter periods."""


@kernel()
def theta_constants(qh: float, ql: float) -> tuple[float, float, float, float, float, float]:
    """Return theta3(0), theta4(0) and theta2(0)/2q^(1/4) for the nome q <= 0.05, each as a pair."""
    q2h, q2l = dd_sqr(qh, ql)
    q4h, q4l = dd_sqr(q2h, q2l)
    q8 = q4h * q4h
    # 1 + 2(q^4 + q^16) and 2(q + q^9 + q^25): the even and the odd part.
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
    """A quarter period in the argument of the theta functions: pi/2, or pi K/2K'."""
    scale_tail: float
    mean: float
    """Arithmetic-geometric mean of 1 and k, so that K' = pi/2 mean; 0 if k is negligible."""
    mean_tail: float
    complementary_mean: float
    """Arithmetic-geometric mean of 1 and k'."""
    complementary_mean_tail: float


@kernel()
def periods(kh: float, kl: float, ch: float, cl: float) -> Periods:
    """Return the periods of modulus k = (kh, kl) and complementary modulus k' = (ch, cl) > 0."""
    gh, gl = agm_dd(ch, cl)
    halfpi_h, halfpi_l = 0.5 * PI[0], 0.5 * PI[1]
    Kh, Kl = dd_div(halfpi_h, halfpi_l, gh, gl)
    circular = ch * ch >= 0.5
    if circular and kh < 1e-40:
        # q = m/16 is negligible in every sum.
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

"""Which axis a free rotation circles, and the constants of circling it that are free of cancellation, compiled.

With principal moments A <= B <= C, w_A, w_B, w_C the angular velocity along their axes and d the extreme axis that is
circled, c the other extreme and b the middle,

    D_B = C (C - B) w_C^2 - A (B - A) w_A^2     decides: d is the axis of C where it is positive, of A where negative,
    X = |L^2 - 2 E I_d|,   Y = |L^2 - 2 E I_c|  are sums of positive terms, and with them
    A_c^2 = X/(I_c |I_c - I_d|),   A_b^2 = X/(I_b |I_b - I_d|),   A_d^2 = Y/(I_d |I_c - I_d|),
    p^2 = |I_b - I_d| Y/(A B C),   k^2 = |I_b - I_c| X/(|I_b - I_d| Y),   k'^2 = |I_c - I_d| |D_B|/(|I_b - I_d| Y).

Everything is formed in double-double with separate exponents. A product, a quotient, a root, a sum of positive terms
and the difference of two moments each have a relative error below 4 2^-106, and none of X, Y, p, k and the amplitudes
takes more than 20 of them one upon another: they are right to 80 2^-106 = 1e-30 of themselves. D_B, and k' by half as
much, may be worse by the factor by which D_B cancelled: at most 2^6, as beyond that it is to be given exactly.

References
----------
L. D. Landau, E. M. Lifshitz, "Mechanics", section 37.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import (
    Scaled,
    dd_sub,
    sc_abs,
    sc_add,
    sc_div,
    sc_mul,
    sc_neg,
    sc_pair,
    sc_sqrt,
    scaled,
)
from core.errors import AccuracyUnreachable
from core.rotation.closed_form.principal_frame import Resolved

REST, STEADY, PERIODIC, SEPARATRIX, UNDECIDED, UNREACHABLE = range(6)

UNDECIDED_CANCELLATION = 2.0**6
"""Where D_B has cancelled by more than this, exact arithmetic forms it: flips near the separatrix hang on it."""

SMALLEST_MODULUS = -946
"""Binary exponent below which a complementary modulus other than 0 has lost digits of its low part."""


LIKE_SYMMETRIC = -30
"""Exponent up to which m and |I_b - I_c|/|I_b - I_d| let two nearly equal moments move a body as two equal ones do.

The rate in the body varies by half of each, here 2^-31 of itself.
"""


class Decision(NamedTuple):
    """What the motion does, and the difference by which it was decided."""

    regime: int
    D: Scaled
    """D_B."""
    S: Scaled
    """The same with both of its terms positive."""
    cancellation: float
    """S/|D|, at most 1e300."""


class Circulation(NamedTuple):
    """A motion that circles an axis; c, b, d as above."""

    circled: int
    """Number of the axis d in ascending order of moments: 2 or 0."""
    I_c: Scaled
    I_b: Scaled
    I_d: Scaled
    cd: Scaled
    """|I_c - I_d|, and likewise below."""
    bc: Scaled
    bd: Scaled
    X: Scaled
    Y: Scaled
    bdY: Scaled
    p: Scaled
    """Rate of u = u0 + p t."""
    k: Scaled
    """Modulus."""


class Amplitudes(NamedTuple):
    """Of the components along c, b, d; none negative."""

    c: Scaled
    b: Scaled
    d: Scaled


@kernel()
def difference(i: NDArray[np.float64], it: NDArray[np.float64], j: int, k: int) -> Scaled:
    """Return I_j - I_k."""
    h, low = dd_sub(i[j], it[j], i[k], it[k])
    return scaled(h, low, 0)


@kernel()
def _decision(regime: int) -> Decision:
    none = Scaled(0.0, 0.0, 0)
    return Decision(regime, none, none, 1.0)


@kernel()
def decision(
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    decided: bool,
    exact: Scaled,
) -> Decision:
    """Return the regime of a motion; parameters as in `core.rotation.closed_form.constants_of_motion`.

    The regime is UNDECIDED where the difference has cancelled and is to be given as `exact`.
    """
    if w[0] == 0.0 and w[1] == 0.0 and w[2] == 0.0:
        return _decision(REST)
    AB, BC = difference(i, it, 1, 0), difference(i, it, 2, 1)
    turning_a = BC.high != 0.0 and w[1] != 0.0 and w[2] != 0.0
    turning_b = (AB.high != 0.0 or BC.high != 0.0) and w[0] != 0.0 and w[2] != 0.0
    turning_c = AB.high != 0.0 and w[0] != 0.0 and w[1] != 0.0
    if not (turning_a or turning_b or turning_c):
        return _decision(STEADY)
    WA, WC = scaled(w[0], wt[0], 0), scaled(w[2], wt[2], 0)
    t_a = sc_mul(sc_mul(scaled(i[0], it[0], 0), AB), sc_mul(WA, WA))
    t_c = sc_mul(sc_mul(scaled(i[2], it[2], 0), BC), sc_mul(WC, WC))
    D = sc_add(t_c, sc_neg(t_a))
    S = sc_add(t_c, t_a)
    if decided:
        D = exact
    cancellation = 1e300
    if D.high != 0.0:
        ratio = sc_div(S, sc_abs(D))
        if ratio.exponent < 900:
            cancellation = sc_pair(ratio)[0]
    if cancellation > UNDECIDED_CANCELLATION and not decided:
        return _decision(UNDECIDED)
    return Decision(SEPARATRIX if D.high == 0.0 else PERIODIC, D, S, cancellation)


@kernel()
def circulation(
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    circled: int,
) -> Circulation:
    """Return the constants of circling an axis."""
    AB, BC, AC = difference(i, it, 1, 0), difference(i, it, 2, 1), difference(i, it, 2, 0)
    IA, IB, IC = scaled(i[0], it[0], 0), scaled(i[1], it[1], 0), scaled(i[2], it[2], 0)
    WA, WB, WC = scaled(w[0], wt[0], 0), scaled(w[1], wt[1], 0), scaled(w[2], wt[2], 0)
    WA2, WB2, WC2 = sc_mul(WA, WA), sc_mul(WB, WB), sc_mul(WC, WC)
    upper = sc_add(sc_mul(sc_mul(IA, AC), WA2), sc_mul(sc_mul(IB, BC), WB2))
    lower = sc_add(sc_mul(sc_mul(IC, AC), WC2), sc_mul(sc_mul(IB, AB), WB2))
    if circled == 2:
        I_c, I_d, bd, bc, X, Y = IA, IC, BC, AB, upper, lower
    else:
        I_c, I_d, bd, bc, X, Y = IC, IA, AB, BC, lower, upper
    bdY = sc_mul(bd, Y)
    p = sc_sqrt(sc_div(bdY, sc_mul(IA, sc_mul(IB, IC))))
    k = sc_sqrt(sc_div(sc_mul(bc, X), bdY))
    return Circulation(circled, I_c, IB, I_d, AC, bc, bd, X, Y, bdY, p, k)


@kernel()
def like_symmetric(c: Circulation) -> bool:
    """Return whether a body with nearly equal moments about the axes c and b moves as one with equal ones."""
    unevenness = sc_div(c.bc, c.bd)
    return sc_mul(c.k, c.k).exponent <= LIKE_SYMMETRIC and unevenness.exponent <= LIKE_SYMMETRIC


@kernel()
def amplitudes(c: Circulation) -> Amplitudes:
    """Return the largest components of the angular velocity."""
    return Amplitudes(
        sc_sqrt(sc_div(c.X, sc_mul(c.I_c, c.cd))),
        sc_sqrt(sc_div(c.X, sc_mul(c.I_b, c.bd))),
        sc_sqrt(sc_div(c.Y, sc_mul(c.I_d, c.cd))),
    )


@kernel()
def complement(c: Circulation, D: Scaled) -> Scaled:
    """Return the complementary modulus k'; D is D_B."""
    return sc_sqrt(sc_div(sc_mul(c.cd, sc_abs(D)), c.bdY))


def exact_difference(resolved: Resolved) -> Scaled:
    """Return D_B = C (C - B) w_C^2 - A (B - A) w_A^2 from exact rational arithmetic, where `decision` left it open."""
    i, it, w, wt = resolved.numbers
    a, b, c = (Fraction(float(x)) + Fraction(float(y)) for x, y in zip(i, it, strict=True))
    wa, _, wc = (Fraction(float(x)) + Fraction(float(y)) for x, y in zip(w, wt, strict=True))
    exact = c * (c - b) * wc * wc - a * (b - a) * wa * wa
    if exact == 0:
        return Scaled(0.0, 0.0, 0)
    exponent = exact.numerator.bit_length() - exact.denominator.bit_length()
    mantissa = exact / Fraction(2) ** exponent
    high = float(mantissa)
    decided: Scaled = scaled(high, float(mantissa - Fraction(high)), exponent)
    return decided


def too_near_the_separatrix() -> AccuracyUnreachable:
    """Return the refusal of a start whose distance from the separatrix doubles cannot hold."""
    return AccuracyUnreachable(
        None,
        2.0,
        "the start differs from a rotation about the middle axis by less than the range of doubles resolves",
        path=("angular_velocity",),
        remedy="start on the axis itself, or further from it",
    )

"""The figures of a free precession from moments and start, compiled; `core.rotation.precession` says what they mean.

Each is formed in double-double with separate exponents and rounded once. The figures of a symmetric body are products,
quotients, roots and sums of positive terms, at most 25 of them one upon another, each right to 4 2^-106: before the
last rounding they are right to 100 2^-106 < 1.3e-30. Those of three distinct moments go through the mean of Gauss,
Carlson's R_F and theta series besides, and D_B may carry a cancellation of 2^6 (more than that is decided exactly):
1e-27. So each is the nearest double unless the exact number lies within 1e-11 units in the last place of the middle
between two. There are two exceptions. Angles are arctangents, as right as those of the C library, to one unit. And the
angle of a precession about the smallest moment is what is left of a whole turn: it is right to 1e-29 rad, to K/8 times
that where the quarter period K is longer (what cancels grows with it), and not stated where that is more than half a
unit in the last place. Matter hardly gets there: the moments of such a needle are as 1 to 1e14.

All of this is for moments and components that are doubles. Those of a turned body are derived, to 1e-30 of the largest,
and that is seen next to the separatrix, as K is the logarithm of the distance from it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import (
    PI,
    Scaled,
    dd_add,
    dd_sub,
    sc_abs,
    sc_add,
    sc_div,
    sc_mul,
    sc_pair,
    sc_sqrt,
    scaled,
)
from core.elliptic.lattice import periods
from core.rotation.closed_form.circulation import (
    PERIODIC,
    SEPARATRIX,
    SMALLEST_MODULUS,
    STEADY,
    UNREACHABLE,
    Circulation,
    amplitudes,
    circulation,
    complement,
    decision,
    like_symmetric,
)
from core.rotation.precession.constants import angle_per_period, quarter_turn, turning

ABSENT = math.nan
"""In place of a figure that the motion does not have."""

OUT_OF_RANGE = math.inf
"""In place of a figure that no normal double can state."""

UNRESOLVED = -math.inf
"""In place of an angle that is lost in the whole turn from which it is taken, and of the rate that it makes."""

SMALLEST_ANGLE = 2.0**-43
"""What 1e-29 rad are half a unit in the last place of (rad); for K/8 times that, K/4 times the angle."""

Figures = tuple[float, float, float, float, float, float, float, float, float]
Found = tuple[int, bool, bool, tuple[float, float, float], Figures]


@kernel()
def stated(x: Scaled) -> float:
    """Return the nearest double, or `OUT_OF_RANGE`."""
    if x.high == 0.0:
        return 0.0
    if not (0.5 <= abs(x.high) < 1.0 and -1021 <= x.exponent <= 1024):
        return OUT_OF_RANGE
    return math.ldexp(x.high, x.exponent)


@kernel()
def angle_of_tangent(across: Scaled, along: Scaled, obtuse: bool) -> float:
    """Return the angle in [0, pi] whose tangent is across/along in magnitude; both are at least 0."""
    if along.high == 0.0:
        return 0.5 * PI[0] if across.high != 0.0 else 0.0
    t = sc_div(across, along)
    # The small complement, so that no tangent leaves the range of doubles.
    steep = t.exponent > 0
    if steep:
        t = sc_div(along, across)
    h, low = sc_pair(t)
    if h < 2.0**-1022 and t.high != 0.0:
        if not (steep or obtuse):
            return OUT_OF_RANGE
        h, low = 0.0, 0.0
    # atan(h + l) = atan h + l/(1 + h^2) to first order in l.
    a, al = math.atan(h), low / (1.0 + h * h)
    if steep:
        sign = 1.0 if obtuse else -1.0
        return dd_add(0.5 * PI[0], 0.5 * PI[1], sign * a, sign * al)[0]
    return dd_sub(PI[0], PI[1], a, al)[0] if obtuse else a + al


@kernel()
def _momentum(
    i: NDArray[np.float64], it: NDArray[np.float64], w: NDArray[np.float64], wt: NDArray[np.float64]
) -> Scaled:
    """Return L."""
    square = Scaled(0.0, 0.0, 0)
    for k in range(3):
        component = sc_mul(scaled(i[k], it[k], 0), scaled(w[k], wt[k], 0))
        square = sc_add(square, sc_mul(component, component))
    return sc_sqrt(square)


@kernel()
def _regular(equal: Scaled, single: Scaled, gap: Scaled, along: Scaled, across: Scaled, periodic: bool) -> Figures:
    """Return the figures of a body with moments `equal`, twice, and `single`; gap is what they differ by."""
    forward = sc_abs(along)
    m_along, m_across = sc_mul(single, forward), sc_mul(equal, across)
    space_rate = sc_div(sc_sqrt(sc_add(sc_mul(m_along, m_along), sc_mul(m_across, m_across))), equal)
    # Across the axis nothing goes round it; along the axis there is nothing that could.
    body_rate = 0.0 if along.high == 0.0 else ABSENT
    period, turned, mean = ABSENT, ABSENT, ABSENT
    if periodic:
        rate = sc_mul(sc_div(gap, equal), along)
        time = sc_div(scaled(2.0 * PI[0], 2.0 * PI[1], 0), sc_abs(rate))
        body_rate, period = stated(rate), stated(time)
        turned, mean = stated(sc_mul(space_rate, time)), stated(space_rate)
    between = angle_of_tangent(
        sc_mul(sc_mul(sc_abs(gap), across), forward), sc_add(sc_mul(m_across, across), sc_mul(m_along, forward)), False
    )
    obtuse = along.high < 0.0
    return (
        body_rate, stated(space_rate), period, ABSENT,
        angle_of_tangent(m_across, m_along, obtuse), angle_of_tangent(across, forward, obtuse), between, turned, mean,
    )  # fmt: skip


@kernel()
def _elliptic(c: Circulation, k1: Scaled) -> Figures:
    """Return the figures of a periodic motion with three distinct moments; k1 is the complementary modulus."""
    far = amplitudes(c)
    kh, kl = sc_pair(c.k)
    ch, cl = sc_pair(k1)
    of = periods(kh, kl, ch, cl)
    quarter = quarter_turn(c, turning(c, far.c, far.d), of)
    h, low = angle_per_period(quarter, 1.0 if c.circled == 2 else -1.0)
    turned, resolved = scaled(h, low, 0), h >= SMALLEST_ANGLE * max(1.0, 0.25 * of.K)
    half = sc_div(scaled(2.0 * of.K, 2.0 * of.K_tail, 0), c.p)
    period = Scaled(half.high, half.low, half.exponent + 1)
    return (
        ABSENT, ABSENT, stated(period), stated(half), ABSENT, ABSENT, ABSENT,
        stated(turned) if resolved else UNRESOLVED, stated(sc_div(turned, period)) if resolved else UNRESOLVED,
    )  # fmt: skip


@kernel()
def _of_a_limit(mean: float) -> Figures:
    return ABSENT, ABSENT, ABSENT, ABSENT, ABSENT, ABSENT, ABSENT, ABSENT, mean


@kernel()
def oriented(axes: NDArray[np.float64], k: int) -> tuple[float, float, float, float]:
    """Return a principal axis, turned to the positive side of the body axis that it is nearest to, and its sign."""
    x, y, z = axes[0, k], axes[1, k], axes[2, k]
    most = x
    if abs(y) > abs(most):
        most = y
    if abs(z) > abs(most):
        most = z
    return (0.0 - x, 0.0 - y, 0.0 - z, -1.0) if most < 0.0 else (x, y, z, 1.0)


@kernel()
def precession_figures(
    symmetry_axis: int,
    moments: NDArray[np.float64],
    moments_tail: NDArray[np.float64],
    axes: NDArray[np.float64],
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    decided: bool,
    high: float,
    low: float,
    exponent: int,
) -> Found:
    """Return regime, whether the body moves as no symmetric one, whether equal moments differ, axis and figures.

    Parameters
    ----------
    symmetry_axis : int
        Number of the moment that is not equal to the other two: 2 or 0; -1 where all three differ.
    moments, moments_tail, axes : ndarray, shape (3,) and (3, 3)
        As in `PrincipalInertia`; all moments positive, or the smallest 0 and the spin across its axis.
    i, it, w, wt : ndarray, shape (3,)
        As in `Resolved`; the angular velocity not 0.
    decided, high, low, exponent : bool, float, float, int
        As `decided` and `exact` of `constants_of_motion`, for a second call where the first returned UNDECIDED.

    Returns
    -------
    tuple
        The figures in the order of `core.rotation.precession.FIGURES`.
    """
    k = symmetry_axis
    regime, apart, spun = STEADY, False, 0
    exact_period, followed = _of_a_limit(ABSENT), False
    if k >= 0:
        a, b = (0, 1) if k == 2 else (1, 2)
        # As resolved: what rounding leaves between the derived moments of a turned coin is none.
        apart = i[a] != i[b] or it[a] != it[b]
    if k < 0 or apart:
        exact = Scaled(high, low, exponent)
        found = decision(i, it, w, wt, decided, exact)
        regime = found.regime
        if regime == STEADY:
            if k < 0:
                for n in (1, 2):
                    if abs(w[n]) > abs(w[spun]):
                        spun = n
                ax, ay, az, _ = oriented(axes, spun)
                return regime, False, False, (ax, ay, az), _of_a_limit(ABSENT)
        elif regime in (SEPARATRIX, PERIODIC):
            circled = 2 if found.D.high >= 0.0 else 0
            if regime == SEPARATRIX:
                ax, ay, az, _ = oriented(axes, 1)
                mean = sc_div(_momentum(moments, moments_tail, w, wt), scaled(moments[1], moments_tail[1], 0))
                return regime, k >= 0, apart, (ax, ay, az), _of_a_limit(stated(mean))
            c = circulation(i, it, w, wt, circled)
            k1 = complement(c, found.D)
            if k1.exponent < SMALLEST_MODULUS:
                return UNREACHABLE, False, apart, (0.0, 0.0, 0.0), _of_a_limit(ABSENT)
            exact_period, followed = _elliptic(c, k1), True
            if circled != k or not like_symmetric(c):
                ax, ay, az, _ = oriented(axes, circled)
                return regime, k >= 0, apart, (ax, ay, az), exact_period
        else:
            return regime, False, apart, (0.0, 0.0, 0.0), _of_a_limit(ABSENT)
    a, b = (0, 1) if k == 2 else (1, 2)
    ax, ay, az, sign = oriented(axes, k)
    along = scaled(sign * w[k], sign * wt[k], 0)
    u, v = scaled(w[a], wt[a], 0), scaled(w[b], wt[b], 0)
    across = sc_sqrt(sc_add(sc_mul(u, u), sc_mul(v, v)))
    if not apart and along.high != 0.0 and across.high != 0.0:
        regime = PERIODIC
    h, tail = dd_add(0.5 * moments[a], 0.5 * moments_tail[a], 0.5 * moments[b], 0.5 * moments_tail[b])
    equal, single = scaled(h, tail, 0), scaled(moments[k], moments_tail[k], 0)
    h, tail = dd_sub(moments[k], moments_tail[k], h, tail)
    figures = _regular(equal, single, scaled(h, tail, 0), along, across, regime == PERIODIC)
    if followed:
        figures = (
            figures[0], figures[1], exact_period[2], exact_period[3], figures[4], figures[5], figures[6],
            exact_period[7], exact_period[8],
        )  # fmt: skip
    return regime, False, apart, (ax, ay, az), figures

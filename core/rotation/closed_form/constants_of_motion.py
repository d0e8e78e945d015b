"""The constants of a torque-free motion: which axis it circles, amplitudes, modulus, rate and starting phase, compiled.

In principal axes with moments A <= B <= C the motion is

    w_c = A_c cn u,   w_b = s A_b sn u,   w_d = s A_d dn u,   u = u0 + p t,

where d is the extreme axis that the motion circles, c the other extreme, b the middle and s the sign of w_d;
`core.rotation.closed_form.circulation` decides which and forms the amplitudes, so that neither cancellation nor the
range of doubles enters. Right for ascending moments in a right-handed frame, in which time never runs backwards.

References
----------
L. D. Landau, E. M. Lifshitz, "Mechanics", section 37. E. T. Whittaker, "A Treatise on the Analytical Dynamics
of Particles and Rigid Bodies", section 69.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import (
    Pair,
    Scaled,
    dd_div,
    dd_mul,
    sc_abs,
    sc_div,
    sc_pair,
    scaled,
)
from core.elliptic.integrals import rf_of_roots
from core.elliptic.lattice import Lattice, lattice
from core.rotation.closed_form.circulation import (
    PERIODIC,
    REST,
    SEPARATRIX,
    SMALLEST_MODULUS,
    STEADY,
    UNDECIDED,
    UNREACHABLE,
    amplitudes,
    circulation,
    complement,
    decision,
)
from core.rotation.closed_form.condition_bounds import (
    NONE,
    ConditionBounds,
    rounding_bounds,
)


class Weights(NamedTuple):
    """Amplitudes times the constants of the theta quotients, near even and odd quarter periods, each rounded once."""

    c_even: float
    b_even: float
    d_even: float
    c_odd: float
    b_odd: float
    d_odd: float


class ConstantsOfMotion(NamedTuple):
    """Constants of one motion; times in seconds, rates in rad/s, axes numbered in ascending order of moments."""

    regime: int
    circled: int
    """Number of the axis d: 2 (largest moment) or 0 (smallest)."""
    A_c: float
    A_b: float
    A_d: float
    """Signed amplitudes of the components along c, b, d."""
    m: float
    m1: float
    p: float
    lattice: Lattice
    weights: Weights
    rate: float
    rate_tail: float
    """Quarter periods per unit of scaled time; on the separatrix, u per unit of scaled time."""
    time_scale: float
    """A power of two: scaled time is time_scale t."""
    start_quarter: float
    start: float
    start_tail: float
    """Quarter periods at t = 0: start_quarter + start; on the separatrix, u at t = 0."""
    condition_bounds: ConditionBounds
    """With u = 1: for the rounding of 2^-104 with which these constants were formed."""

    def mirrored(self, c: float, b: float, d: float) -> ConstantsOfMotion:
        """Return the motion with the components along its three axes multiplied by signs."""
        k = self.weights
        weights = Weights(c * k.c_even, b * k.b_even, d * k.d_even, c * k.c_odd, b * k.b_odd, d * k.d_odd)
        return self._replace(A_c=c * self.A_c, A_b=b * self.A_b, A_d=d * self.A_d, weights=weights)


@kernel()
def _no_lattice() -> Lattice:
    none = (0.0, 0.0)
    return Lattice(True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, none, none, none, none, none, none)


@kernel()
def _weights(ac: Pair, ab: Pair, ad: Pair, lat: Lattice) -> Weights:
    return Weights(
        dd_mul(ac[0], ac[1], lat.even_cn[0], lat.even_cn[1])[0],
        dd_mul(ab[0], ab[1], lat.even_sn[0], lat.even_sn[1])[0],
        dd_mul(ad[0], ad[1], lat.even_dn[0], lat.even_dn[1])[0],
        dd_mul(ac[0], ac[1], lat.odd_cn[0], lat.odd_cn[1])[0],
        dd_mul(ab[0], ab[1], lat.odd_sn[0], lat.odd_sn[1])[0],
        dd_mul(ad[0], ad[1], lat.odd_dn[0], lat.odd_dn[1])[0],
    )


@kernel()
def _motionless(regime: int) -> ConstantsOfMotion:
    return ConstantsOfMotion(
        regime, 2, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, _no_lattice(), Weights(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        0.0, 0.0, 1.0, 0.0, 0.0, 0.0, NONE,
    )  # fmt: skip


@kernel()
def _rate(f: Scaled) -> tuple[float, float, float]:
    """Return a rate as a pair and the power of two by which times are to be multiplied, both within range."""
    e = max(-1000, min(1000, f.exponent))
    rest = math.ldexp(1.0, f.exponent - e)
    return f.high * rest, f.low * rest, math.ldexp(1.0, e)


@kernel()
def constants_of_motion(
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    decided: bool,
    exact: Scaled,
) -> ConstantsOfMotion:
    """Return the constants of the motion that starts with angular velocity `w` at t = 0.

    Parameters
    ----------
    i, it : ndarray, shape (3,)
        Principal moments in ascending order, as sums i + it, all positive (kg m^2).
    w, wt : ndarray, shape (3,)
        Angular velocity in right-handed principal axes, as sums w + wt (rad/s).
    decided : bool
        Whether D_B is given by `exact`, as it must be after an answer of regime UNDECIDED.
    exact : Scaled
        D_B in the units of the inputs, used if `decided`.
    """
    largest = max(abs(w[0]), abs(w[1]), abs(w[2]))
    found = decision(i, it, w, wt, decided, exact)
    if found.regime == REST or found.regime == STEADY or found.regime == UNDECIDED:
        return _motionless(found.regime)

    circled = 2 if found.D.high >= 0.0 else 0
    turning = circulation(i, it, w, wt, circled)
    k1 = complement(turning, found.D)
    if k1.high != 0.0 and k1.exponent < SMALLEST_MODULUS:
        return _motionless(UNREACHABLE)
    far, p, cancellation = amplitudes(turning), turning.p, found.cancellation
    W_d, W_c = scaled(w[circled], wt[circled], 0), scaled(w[2 - circled], wt[2 - circled], 0)
    s = -1.0 if W_d.high < 0.0 else 1.0

    sn = sc_pair(sc_div(scaled(w[1], wt[1], 0), far.b))
    sh, sl = s * sn[0], s * sn[1]
    ch, cl = sc_pair(sc_div(W_c, far.c))
    dh, dl = sc_pair(sc_div(sc_abs(W_d), far.d))
    kh, kl = sc_pair(turning.k)
    k1h, k1l = sc_pair(k1)
    ah, al = (sh, sl) if sh >= 0.0 else (-sh, -sl)
    gh, gl = (ch, cl) if ch >= 0.0 else (-ch, -cl)

    ac, ab, ad = sc_pair(far.c), sc_pair(far.b), sc_pair(far.d)
    amplitude_c, amplitude_b, amplitude_d = ac[0], s * ab[0], s * ad[0]
    p_pair = sc_pair(p)
    # Sensitivities in units in which the largest component is of order one.
    we = math.ldexp(1.0, -max(-1000, min(1000, scaled(largest, 0.0, 0).exponent)))
    m, m1 = kh * kh, k1h * k1h
    size_c, size_b, size_d = amplitude_c * we, abs(amplitude_b) * we, abs(amplitude_d) * we
    top = max(size_c, size_b, size_d)

    if k1h == 0.0:
        # sech has no sign of its own: half a turn about d gives w_c its sign, and w_b with it.
        side = -1.0 if ch < 0.0 else 1.0
        sh, sl, ch, cl = side * sh, side * sl, side * ch, side * cl
        amplitude_c, amplitude_b = side * amplitude_c, side * amplitude_b
        uh, ul = rf_of_roots(gh, gl, gh, gl, 1.0, 0.0)
        uh, ul = dd_mul(uh, ul, sh, sl)
        computed = rounding_bounds(size_c, size_b, size_d, 1.0, 0.0, p_pair[0], 0.0, sh, ch, dh, uh, 1.0, top)
        return ConstantsOfMotion(
            SEPARATRIX, circled, amplitude_c, amplitude_b, amplitude_d, 1.0, 0.0, p_pair[0],
            _no_lattice(), Weights(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            *_rate(p), 0.0, uh, ul, computed,
        )  # fmt: skip
    lat = lattice(kh, kl, k1h, k1l)
    # Distance from the nearest quarter period, where |sn(K/2)|^2 = 1/(1 + k').
    near_even = ah * ah * (1.0 + k1h) <= 1.0
    if near_even:
        vh, vl = rf_of_roots(gh, gl, dh, dl, 1.0, 0.0)
        vh, vl = dd_mul(vh, vl, ah, al)
    else:
        eh, el = dd_mul(k1h, k1l, ah, al)
        vh, vl = rf_of_roots(eh, el, k1h, k1l, dh, dl)
        vh, vl = dd_mul(vh, vl, gh, gl)
    rh, rl = dd_div(vh, vl, lat.K, lat.K_tail)
    side = 1.0 if sh >= 0.0 else -1.0
    if near_even:
        quarter = 0.0 if ch >= 0.0 else 2.0 * side
        sign = side if ch >= 0.0 else -side
    else:
        quarter = side
        sign = -side if ch >= 0.0 else side
    f = sc_div(p, scaled(lat.K, lat.K_tail, 0))
    computed = rounding_bounds(
        size_c, size_b, size_d, m, m1, p_pair[0], lat.K, sh, ch, dh, vh, 1.0 if decided else cancellation, top
    )
    return ConstantsOfMotion(
        PERIODIC, circled, amplitude_c, amplitude_b, amplitude_d, m, m1, p_pair[0],
        lat, _weights(ac, (s * ab[0], s * ab[1]), (s * ad[0], s * ad[1]), lat),
        *_rate(f), quarter, sign * rh, sign * rl, computed,
    )  # fmt: skip

"""How a relative uncertainty of moments and start grows along a torque-free motion, to first order, compiled.

Three bounds hold at once, and the smallest is stated:

* by the constants of the motion: the phase drifts with the rate, the modulus and the start, the amplitudes stay off;
* by polynomials, where two moments are equal: the spin along the third axis drifts, and turns the others with it;
* by Grönwall's lemma, for short times: Euler's equations have coefficients of bounded relative size.

Each is in units of the uncertainty, relative to the largest angular velocity of the motion.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from core.compiled import kernel
from core.elliptic.integrals import one_less_e_over_k


class ConditionBounds(NamedTuple):
    """The three bounds as functions of the time t >= 0.

    start + rate t + growth exp(exponent t),   even_start + even_rate t + even_quadratic t^2,
    (2 + short_rate t) exp(short_exponent t).
    """

    start: float
    rate: float
    growth: float
    exponent: float
    even_start: float
    even_rate: float
    even_quadratic: float
    short_rate: float
    short_exponent: float

    def at(self, uncertainty: float, horizon: float, graded: float = 1.0) -> float:
        """Return what a relative uncertainty has grown to at a time, at most 2.

        Parameters
        ----------
        uncertainty : float
            Of the moments, each relative to itself, and of the start, relative to its norm.
        horizon : float
            Largest time from the start (s).
        graded : float
            By how much more the start's components are uncertain, each relative to itself.

        First order ends somewhere: a growth beyond a tenth is stated as what it can come to, the whole motion.
        """
        by_phase = self.start + self.rate * horizon + _exponential(self.growth, self.exponent * horizon)
        grown = uncertainty * min(
            graded * _finite(by_phase),
            _finite(self.even_start + self.even_rate * horizon + self.even_quadratic * horizon * horizon),
            _finite(_exponential(2.0 + self.short_rate * horizon, self.short_exponent * horizon)),
        )
        return grown if grown < 0.1 else 2.0


def _finite(size: float) -> float:
    return size if math.isfinite(size) else math.inf


def _exponential(factor: float, power: float) -> float:
    if factor == 0.0:
        return 0.0
    return factor * math.exp(power) if power < 700.0 else math.inf


NONE = ConditionBounds(0.0, 0.0, 0.0, 0.0, math.inf, 0.0, 0.0, 0.0, math.inf)


@kernel()
def steady_sensitivity(A: float, B: float, C: float, axis: int, largest: float) -> ConditionBounds:
    """ConditionBounds of a steady rotation at the rate `largest`, along a principal axis or, axis being -1, in a plane.

    An error of the start out of the middle axis grows exponentially; were two equal moments not quite equal, a spin in
    their plane would drift in proportion to t (the Jordan block of this equilibrium) and turn in proportion to t^2.
    """
    equal_low, equal_high = A == B, B == C
    if equal_low and equal_high:
        return ConditionBounds(2.0, 4.0 * largest, 0.0, 0.0, math.inf, 0.0, 0.0, 0.0, math.inf)
    if equal_low or equal_high:
        pair, single = (A, C) if equal_low else (C, A)
        drift = 4.0 * largest * max(1.0, pair / single if single > 0.0 else 1.0)
        turn = 4.0 * largest * abs(1.0 - single / pair)
        return ConditionBounds(math.inf, 0.0, 0.0, 0.0, 2.0, drift + turn, drift * turn, 0.0, math.inf)
    if axis == 1:
        # The eigenvalue of the saddle; the eigenvectors' lengths along the two axes differ by a factor of this root.
        escape = math.sqrt((B - A) / C * ((C - B) / A))
        skew = math.sqrt((B - A) / C / ((C - B) / A))
        return ConditionBounds(
            2.0, 0.0, 4.0 * max(skew, 1.0 / skew), escape * largest, math.inf, 0.0, 0.0, 0.0, math.inf
        )
    return ConditionBounds(2.0, 4.0 * largest, 0.0, 0.0, math.inf, 0.0, 0.0, 0.0, math.inf)


@kernel()
def _e_minus_m1_k(m: float, m1: float, K: float) -> float:
    """Return (E - m1 K)/m, where 0 <= m <= 1, to a few digits."""
    if m < 1e-4:
        return 0.25 * math.pi * (1.0 + 0.125 * m)
    if m1 < 1e-12:
        return 1.0
    return (K * (1.0 - one_less_e_over_k(m, math.sqrt(m1))) - m1 * K) / m


@kernel()
def inherited_sensitivity(
    A: float, B: float, C: float, wa: float, wb: float, wc: float, am: float, bm: float, cm: float,
    m: float, m1: float, p: float, K: float, sn: float, cn: float, dn: float,
    difference: float, missed: float, largest: float, rate: float,
) -> ConditionBounds:  # fmt: skip
    """ConditionBounds to all six inputs; here c is the circled axis, a the other extreme, b the middle.

    Each term is the sum of the absolute relative sensitivities of one constant: p, the modulus, u0, the amplitudes.
    `difference` is the relative uncertainty of D_B per unit uncertainty of the inputs; `missed` that of m1 on the
    separatrix, where K is 0. Moments and components are in units in which `largest` is of order one; p and `rate`, the
    largest angular velocity, are in rad/s.
    """
    g_cb, g_ca = (C + B) / abs(C - B), (C + A) / abs(C - A)
    d_c = 2 * (wc / cm) ** 2 + (wb / cm) ** 2 * (B * abs(B - A) * (4 + g_ca) + B * (A + B)) / (C * abs(C - A))
    d_b = 2 + (A * abs(C - A) / (B * abs(C - B))) * (wa / bm) ** 2 * (2 + g_ca + g_cb)
    d_a = 2 + (B * abs(C - B) / (A * abs(C - A))) * (wb / am) ** 2 * (2 + g_ca + g_cb)
    d_p = 0.5 * (g_cb + g_ca + 2 + d_c)
    from_m = m * (2 + g_ca + d_b + d_c) + (A + B) * B / (abs(C - A) * C) * (bm / cm) ** 2
    from_m1 = difference + g_cb + 1 + d_c
    relative = min(from_m / m1, from_m1) if m1 > 0.0 else from_m1
    shift = 0.5 * _e_minus_m1_k(m, m1, K) * relative if K > 0.0 else 0.5 * relative
    start = abs(sn * cn) * (1 + 0.5 * (d_a + d_b)) / dn + shift
    slope = math.sqrt(max(am * am, bm * bm) + 0.25 * (m * cm) ** 2)
    amplitudes = 0.5 * max(am * d_a, bm * d_b, cm * d_c)
    drift = p * d_p + (p / K * shift if K > 0.0 else 0.0)
    growth = 0.0
    if K == 0.0:
        # cn(u|1 - m1) = sech u - (m1/4)(sinh u cosh u - u) tanh u sech u + ...: missed by m1, it is left as exp u.
        growth = 0.25 * missed * math.exp(math.asinh(abs(sn) / cn)) * slope / largest
    even_start, even_rate, even_quadratic = math.inf, 0.0, 0.0
    if A == B:
        # Two equal moments: c is the axis of the third.
        linear, turn = 4.0 * rate * max(1.0, B / C), 4.0 * rate * abs(1.0 - C / B)
        even_start, even_rate, even_quadratic = 2.0, linear + turn, linear * turn
    steepest = max(abs(C - B) / A, abs(C - A) / B, abs(B - A) / C)
    relative_error = max((C + B) / A, (C + A) / B, (B + A) / C)
    return ConditionBounds(
        (slope * start + amplitudes) / largest, slope * drift / largest, growth, p,
        even_start, even_rate, even_quadratic, 2.0 * relative_error * rate, 2.0 * steepest * rate,
    )  # fmt: skip


@kernel()
def computed_sensitivity(
    am: float, bm: float, cm: float, m: float, m1: float, p: float, K: float, sn: float, cn: float, dn: float,
    u0: float, cancellation: float, largest: float,
) -> ConditionBounds:  # fmt: skip
    """ConditionBounds to the rounding with which the constants themselves are formed from exact inputs.

    Every constant is a product or a sum of positive terms, within a few units, but D_B, which carries `cancellation`.
    """
    slope = math.sqrt(max(am * am, bm * bm) + 0.25 * (m * cm) ** 2) / largest
    if K == 0.0:
        # Away from u = 0 the slope falls as sech u, faster than the error of u grows.
        return ConditionBounds(
            8.0 * slope * (1.0 + 2.0 * abs(u0)) + 4.0, 0.0, 0.0, 0.0, math.inf, 0.0, 0.0, 0.0, math.inf
        )
    relative = 8.0 * (min(m / m1, cancellation) if m1 > 0.0 else cancellation)
    shift = 0.5 * _e_minus_m1_k(m, m1, K) * relative
    start = slope * (8.0 * abs(sn * cn) / dn + 8.0 * abs(u0) + shift) + 4.0
    return ConditionBounds(start, slope * p * (8.0 + shift / K), 0.0, 0.0, math.inf, 0.0, 0.0, 0.0, math.inf)

"""The constants of a motion: the phase with which it starts, its periods, its regimes, against Landen's ladder.

From the exact polhode of a state, sn, cn and dn at the start follow without any integral; the starting phase that the
code found by Carlson's integral has to give them back. u = 2^-53.
"""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.double_double import Scaled, scaled
from core.rotation.closed_form.circulation import PERIODIC, REST, SEPARATRIX, STEADY, UNDECIDED, UNREACHABLE
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion, constants_of_motion
from tests.drawn import draws
from tests.oracles.elliptic import Periodic
from tests.oracles.polhode import Polhode, accelerates

U = 2.0**-53
SQUARE = 2.0**-106
NONE = Scaled(0.0, 0.0, 0)
ZERO = np.zeros(3)

decades = st.floats(-100, 100).map(lambda e: 10.0**e)
moment = st.floats(0.5, 2.0) | st.floats(1e-3, 1e3)
rate = (st.floats(0.1, 1.0) | st.floats(-12, 0).map(lambda e: 10.0**e)).flatmap(lambda x: st.sampled_from([x, -x]))


def real(x: Fraction) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator


def difference(moments, rates) -> Scaled:
    """C(C - B) w_C^2 - A(B - A) w_A^2 exactly, as `core.rotation.free_rotation` gives it."""
    (a, b, c), (wa, _, wc) = (tuple(Fraction(x) for x in v) for v in (moments, rates))
    exact = c * (c - b) * wc * wc - a * (b - a) * wa * wa
    if exact == 0:
        return NONE
    e = exact.numerator.bit_length() - exact.denominator.bit_length()
    part = exact / Fraction(2) ** e
    return scaled(float(part), float(part - Fraction(float(part))), e)


def motion(moments, rates) -> ConstantsOfMotion:
    return constants_of_motion(np.array(moments), ZERO, np.array(rates), ZERO, True, difference(moments, rates))


@settings(deadline=None, derandomize=True, max_examples=draws(120))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate), decades, decades)
def test_the_start_is_at_its_phase(moments, rates, heavy, fast) -> None:
    moments = sorted(heavy * x for x in moments)
    rates = [fast * x for x in rates]
    i, w = [Fraction(x) for x in moments], [Fraction(x) for x in rates]
    assume(len(set(i)) == 3)
    assume(accelerates(i, w))
    found = motion(moments, rates)
    polhode = Polhode.through(i, w)
    assume(polhode.m1 > Fraction(10) ** -60)
    assert found.regime == PERIODIC
    assert found.circled == polhode.axes.d
    with mpmath.workdps(120):
        m, m1 = real(polhode.m), real(polhode.m1)
        ladder = Periodic(m, m1, mpmath.mpf(0))
        quarters = mpmath.mpf(found.start_quarter) + mpmath.mpf(found.start) + mpmath.mpf(found.start_tail)
        at = ladder.phase(quarters * ladder.quarter)
        sign = -1 if at.turns % 2 else 1
        b, c, d = (mpmath.sqrt(real(x)) for x in polhode.squared_amplitudes)
        towards = 1 if w[polhode.axes.d] > 0 else -1
        # Signed amplitudes are doubles: the nearest ones.
        for got, want in ((found.A_c, c), (found.A_b, towards * b), (found.A_d, towards * d)):
            assert abs(got - want) <= (1 + 1e-12) * U * abs(want)
        # Squares of the rounded moduli: three roundings.
        assert abs(found.m - m) <= 3 * U * m
        assert abs(found.m1 - m1) <= 3 * U * m1
        assert abs(found.p - mpmath.sqrt(real(polhode.squared_p))) <= (1 + 1e-12) * U * found.p
        got = (c * sign * at.cn, towards * b * sign * at.sn, towards * d * at.dn)
        wanted = [real(w[k]) for k in (polhode.axes.c, polhode.axes.b, polhode.axes.d)]
        # A phase is right to what its amplitudes (80 u^2 each), twenty duplications of 8 u^2, a product and a quotient
        # round, times its own size; as a share of the quarter period, which carries 70 u^2.
        few = (2 * 80 + 160 + 8 + 70 + 10) * SQUARE
        slopes = (c * at.sn * at.dn, b * at.cn * at.dn, d * m * at.sn * at.cn)
        for g, want, slope in zip(got, wanted, slopes, strict=True):
            # A cosine close to 1 fixes its angle by half its digits; the code starts from the nearer quarter.
            assert abs(g - want) <= few * (abs(slope) * abs(quarters) * ladder.quarter + abs(want))
        assert abs(found.start) <= 0.5 + 1e-15
        # f = p/K, over the power of two by which times are multiplied.
        f = mpmath.sqrt(real(polhode.squared_p)) / ladder.quarter / mpmath.mpf(found.time_scale)
        assert abs(mpmath.mpf(found.rate) + mpmath.mpf(found.rate_tail) - f) <= 200 * SQUARE * f
        assert math.frexp(found.time_scale)[0] == 0.5


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.integers(1, 40), st.integers(1, 40), rate, st.sampled_from([-1.0, 1.0]), st.sampled_from([-1.0, 1.0]))
def test_the_start_on_the_separatrix(p, q, middle, first, second) -> None:
    """A (B - A) w_A^2 = C (C - B) w_C^2 in whole numbers: moments 14, 21, 24 have 98 = 2 7^2 and 72 = 2 6^2."""
    moments, rates = (14.0, 21.0, 24.0), (first * 6.0 * p, middle * q, second * 7.0 * p)
    found = motion(moments, rates)
    assert (found.regime, found.m, found.m1) == (SEPARATRIX, 1.0, 0.0)
    polhode = Polhode.through([Fraction(x) for x in moments], [Fraction(x) for x in rates])
    with mpmath.workdps(60):
        u = mpmath.mpf(found.start) + mpmath.mpf(found.start_tail)
        # Neither extreme is circled: the oracle may name the other one.
        largest = dict(zip(polhode.axes, (mpmath.sqrt(real(x)) for x in polhode.squared_amplitudes), strict=True))
        c, b, d = largest[2 - found.circled], largest[1], largest[found.circled]
        # w_c = A_c sech u, w_b = A_b tanh u, w_d = A_d sech u, signs in the amplitudes.
        w_d, w_c = rates[found.circled], rates[2 - found.circled]
        for got, want in (
            (math.copysign(1.0, found.A_c) * c * mpmath.sech(u), w_c),
            (math.copysign(1.0, found.A_b) * b * mpmath.tanh(u), rates[1]),
            (math.copysign(1.0, found.A_d) * d * mpmath.sech(u), w_d),
        ):
            assert abs(got - want) <= 400 * SQUARE * (1 + abs(u)) * abs(want)
        rate_of_u = mpmath.sqrt(real(polhode.squared_p)) / found.time_scale
        assert abs(mpmath.mpf(found.rate) + mpmath.mpf(found.rate_tail) - rate_of_u) <= 80 * SQUARE * rate_of_u


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.integers(-280, -40), st.floats(0.3, 0.99), st.sampled_from([-1, 1]))
def test_the_complement_has_no_cancellation_if_the_difference_is_given(e, wb, side) -> None:
    """m1 = (C - A) |D_B|/((I_b - I_d) Y): with D_B given, no cancellation is left."""
    moments, rates = (14.0, 21.0, 24.0), (6.0, wb, 7.0)
    given_difference = scaled(side * 10.0**e, 0.0, 0)
    found = constants_of_motion(np.array(moments), ZERO, np.array(rates), ZERO, True, given_difference)
    assert found.regime == PERIODIC
    assert found.circled == (2 if side > 0 else 0)
    a, b, c = (Fraction(x) for x in moments)
    wa2, wb2, wc2 = (Fraction(x) ** 2 for x in rates)
    if side > 0:
        y, gap = c * (c - a) * wc2 + b * (b - a) * wb2, c - b
    else:
        y, gap = a * (c - a) * wa2 + b * (c - b) * wb2, b - a
    want = (c - a) * Fraction(10.0**e) / (gap * y)
    assert abs(Fraction(found.m1) - want) <= 3 * Fraction(U) * want


def test_regimes() -> None:
    def regime(moments, rates, decided=False, exact=NONE):
        return constants_of_motion(np.array(moments), ZERO, np.array(rates), ZERO, decided, exact).regime

    assert regime((1.0, 2.0, 3.0), (0.0, 0.0, 0.0)) == REST
    assert regime((1.0, 2.0, 3.0), (0.0, 1.0, 0.0)) == STEADY
    assert regime((14.0, 21.0, 24.0), (6.0, 1.0, 7.0)) == UNDECIDED
    assert regime((14.0, 21.0, 24.0), (6.0, 1.0, 7.0), True) == SEPARATRIX
    # k'^2 = 2^-1900: the low part of k' is below every double.
    assert regime((14.0, 21.0, 24.0), (6.0, 1.0, 7.0), True, Scaled(0.5, 0.0, -1900)) == UNREACHABLE
    assert regime((14.0, 21.0, 24.0), (6.0, 1.0, 7.0), True, Scaled(0.5, 0.0, -1800)) == PERIODIC


@pytest.mark.parametrize("rates", [(0.1, 1.0, 0.1), (1.0, 1.0, 0.1), (0.3, -0.2, -1.0)])
def test_mirrored_components(rates) -> None:
    found = motion((1.0, 2.0, 3.5), rates)
    turned = found.mirrored(-1.0, 1.0, -1.0)
    assert (turned.A_c, turned.A_b, turned.A_d) == (-found.A_c, found.A_b, -found.A_d)
    k, own = turned.weights, found.weights
    assert (k.c_even, k.c_odd) == (-own.c_even, -own.c_odd)
    assert (k.b_even, k.b_odd) == (own.b_even, own.b_odd)
    assert (k.d_even, k.d_odd) == (-own.d_even, -own.d_odd)
    assert turned._replace(A_c=found.A_c, A_d=found.A_d, weights=own) == found

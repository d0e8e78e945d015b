"""The angle about the angular momentum, against its integral, and its series against mpmath's theta functions.

Half of psi grows at the rate (E + L w_d/2)/(L + M_d), which a quadrature over the amplitude phi, du = dphi/Delta,
integrates without elliptic functions; whole periods are also Carlson's integrals of the third kind
(`tests.oracles.free_rotation`). u^2 = 2^-106.
"""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.double_double import Scaled
from core.elliptic.lattice import periods
from core.rotation.closed_form.circulation import amplitudes, circulation
from core.rotation.closed_form.constants_of_motion import constants_of_motion
from core.rotation.precession.constants import (
    CIRCULAR,
    HYPERBOLIC,
    LIMIT,
    _sin_cos_dd,
    _theta2_slope,
    _theta4_slope,
    precession_constants,
    quarter_turn,
    turning,
)
from tests.core.elliptic.parameters import moduli
from tests.core.rotation.closed_form.test_constants_of_motion import motion
from tests.drawn import draws
from tests.oracles.free_rotation import precession_per_period
from tests.oracles.polhode import Polhode, accelerates

SQUARE = 2.0**-106
ZERO = np.zeros(3)

moment = st.floats(0.5, 2.0) | st.floats(1e-2, 1e2)
rate = (st.floats(0.1, 1.0) | st.floats(-6, 0).map(lambda e: 10.0**e)).flatmap(lambda x: st.sampled_from([x, -x]))


def number(high: float, low: float) -> mpmath.mpf:
    return mpmath.mpf(high) + mpmath.mpf(low)


def real(x: Fraction) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator


def exact(x: Scaled) -> mpmath.mpf:
    return mpmath.ldexp(number(x.high, x.low), x.exponent)


# Below 1e-290 the tails of pairs are subnormal.
ANGLE = st.just(0.0) | st.floats(1e-290, 0.78)


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(ANGLE | st.floats(-250, 0).map(lambda e: 0.7 * 10.0**e), st.floats(-0.5, 0.5))
def test_sine_and_cosine_of_pairs(a, part) -> None:
    tail = part * np.spacing(a)
    sh, sl, ch, cl = _sin_cos_dd(a, tail)
    with mpmath.workdps(60):
        whole = number(a, tail)
        # Two nested series with factors below 1/10: the last product and sum, 7 u^2, and a tenth of each before.
        for got, want in ((number(sh, sl), mpmath.sin(whole)), (number(ch, cl), mpmath.cos(whole))):
            assert abs(got - want) <= 16 * SQUARE * want


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(ANGLE, st.floats(0.0, 0.0433))
def test_slope_of_the_second_theta_function(a, q) -> None:
    assume(q == 0.0 or q > 1e-30)
    sine = _sin_cos_dd(a, 0.0)
    with mpmath.workdps(60):
        got = number(*_theta2_slope(*sine, q, 0.0))
        terms = [(q ** mpmath.mpf(n * (n + 1) // 2), 2 * n + 1) if n else (mpmath.mpf(1), 1) for n in range(14)]
        above = mpmath.fsum(w * k * mpmath.sin(k * mpmath.mpf(a)) for w, k in terms)
        below = mpmath.fsum(w * mpmath.cos(k * mpmath.mpf(a)) for w, k in terms)
        # Sine and cosine, a dozen operations above and below; multiples of sines are 3q at most beside the first.
        assert abs(got - above / below) <= 60 * SQUARE * abs(above / below)


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.floats(0.0, 0.99), st.floats(1e-6, 0.0433))
def test_slope_of_the_fourth_theta_function(part, q) -> None:
    """Arguments between 0 and pi K'/2K, where q e^(2 xi) is 1: the poles lie there."""
    with mpmath.workdps(60):
        xi = float(-mpmath.log(q) / 2 * mpmath.mpf(part))
        oh, ol, c1, s1, c2, s2 = _theta4_slope(xi, 0.0, q, 0.0)
        Q, x = mpmath.mpf(q) ** 2, mpmath.mpf(xi)

        def theta(z):
            return 1 + 2 * mpmath.fsum((-1) ** n * Q ** (n * n) * mpmath.cos(2 * n * z) for n in range(1, 9))

        slope = 4 * mpmath.fsum((-1) ** (n + 1) * n * Q ** (n * n) * mpmath.sin(2 * n * -1j * x) for n in range(1, 9))
        # d/dz log theta4 at -i xi is purely imaginary; its imaginary part is d/dz arg.
        want = -mpmath.im(slope / theta(-1j * x))
        # Sums have terms of both signs, the first q at most: exp carries 8 + 2 xi u^2.
        assert abs(number(oh, ol) - want) <= (60 + 4 * xi) * SQUARE * (abs(want) + q)
        for got, w in (
            (c1, 2 * Q * mpmath.cosh(2 * x)),
            (s1, 2 * Q * mpmath.sinh(2 * x)),
            (c2, 2 * Q**4 * mpmath.cosh(4 * x)),
            (s2, 2 * Q**4 * mpmath.sinh(4 * x)),
        ):
            assert abs(got - w) <= 2.0**-52 * w + (60 + 4 * xi) * SQUARE * (abs(w) + q)


def built(moments, rates):
    """Return circulation, what turns, and what it does in a quarter, of a motion given by doubles."""
    i, w = np.array(moments), np.array(rates)
    found = motion(moments, rates)
    c = circulation(i, ZERO, w, ZERO, found.circled)
    far = amplitudes(c)
    return found, c, turning(c, far.c, far.d)


def fractions(moments, rates) -> tuple[list[Fraction], list[Fraction]]:
    return [Fraction(x) for x in moments], [Fraction(x) for x in rates]


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate))
def test_turning_at_the_end_of_a_quarter(moments, rates) -> None:
    i, w = fractions(sorted(moments), rates)
    assume(len(set(i)) == 3)
    polhode = Polhode.through(i, w)
    assume(polhode.m1 > 0)
    _, _, t = built(sorted(moments), rates)
    with mpmath.workdps(60):
        L = mpmath.sqrt(sum(real(a * b) ** 2 for a, b in zip(i, w, strict=True)))
        few = 200 * SQUARE
        assert abs(exact(t.L) - L) <= few * L
        assert abs(exact(t.M_c) ** 2 + exact(t.M_d) ** 2 - L * L) <= 2 * few * L * L
        # sin^2 + cos^2 = 1 is an identity of the moments that nothing enforces.
        sine, cosine = number(t.sine, t.sine_tail), number(t.cosine, t.cosine_tail)
        assert abs(sine**2 + cosine**2 - 1) <= few
        # psi' at sn = 0: (2E + L w_d)/(L + M_d), over 2p.
        energy = real(sum(a * b * b for a, b in zip(i, w, strict=True)))
        w_d = mpmath.sqrt(real(polhode.squared_amplitudes.d))
        slope = (energy + L * w_d) / (L + real(polhode.moments.d) * w_d)
        want = slope / (2 * mpmath.sqrt(real(polhode.squared_p)))
        assert abs(number(t.kappa, t.kappa_tail) - want) <= few * want


@settings(deadline=None, derandomize=True, max_examples=draws(40))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate))
def test_a_quarter_turn_is_the_integral_of_the_rate(moments, rates) -> None:
    i, w = fractions(sorted(moments), rates)
    assume(len(set(i)) == 3)
    polhode = Polhode.through(i, w)
    assume(polhode.m1 > Fraction(1, 10**3))
    _, c, t = built(sorted(moments), rates)
    with mpmath.workdps(45):
        m, m1 = real(polhode.m), real(polhode.m1)
        k, k1 = mpmath.sqrt(m), mpmath.sqrt(m1)
        of = periods(*pair(k), *pair(k1))
        q = quarter_turn(c, t, of)
        L = exact(t.L)
        energy = real(sum(a * b * b for a, b in zip(i, w, strict=True)))
        p, w_d = mpmath.sqrt(real(polhode.squared_p)), mpmath.sqrt(real(polhode.squared_amplitudes.d))

        def slope(phi):
            delta = mpmath.sqrt(1 - m * mpmath.sin(phi) ** 2)
            return (energy + L * w_d * delta) / (L + real(polhode.moments.d) * w_d * delta) / (2 * p * delta)

        # Periodic and analytic in a strip: the trapezoidal rule converges exponentially.
        n = 400
        half = [slope(mpmath.pi * j / (2 * n)) for j in range(n + 1)]
        want = mpmath.pi / (2 * n) * (mpmath.fsum(half) - (half[0] + half[-1]) / 2)
        K = mpmath.pi / (2 * mpmath.agm(1, k1))
        size = number(t.kappa, t.kappa_tail) * K + 2
        assert abs(number(q.per_quarter, q.per_quarter_tail) - want) <= 600 * SQUARE * size


def pair(x: mpmath.mpf) -> tuple[float, float]:
    high = float(x)
    return high, float(x - high)


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate))
def test_whole_periods_are_integrals_of_the_third_kind(moments, rates) -> None:
    moments = sorted(moments)
    i, w = fractions(moments, rates)
    assume(len(set(i)) == 3)
    assume(accelerates(i, w))
    polhode = Polhode.through(i, w)
    assume(polhode.m1 > Fraction(10) ** -30)
    found = motion(moments, rates)
    pre = precession_constants(found, np.array(moments), ZERO, np.array(rates), ZERO)
    assert pre.branch == (CIRCULAR if 2 * polhode.m1 >= 1 else HYPERBOLIC)
    assert pre.eta == (1.0 if polhode.axes.d == 2 else -1.0)
    want = precession_per_period(moments, rates)
    with mpmath.workdps(50):
        # Half of psi in a quarter, eight times; axis d turns once more than psi in a period (Montgomery's angle).
        got = 8 * number(pre.quarter.per_quarter, pre.quarter.per_quarter_tail) + 2 * pre.eta * mpmath.pi
        K = mpmath.pi / (2 * mpmath.agm(1, mpmath.sqrt(real(polhode.m1))))
        _, _, t = built(moments, rates)
        size = 8 * (number(t.kappa, t.kappa_tail) * K + 2 + K)
        assert abs(got - want) <= 600 * SQUARE * size
        # The amplitudes of the unit vector of angular momentum.
        L = mpmath.sqrt(real(polhode.squared_momentum))
        for a, moment_of, square in zip(
            (abs(pre.a_y), pre.a_x, pre.a_z), polhode.moments, polhode.squared_amplitudes, strict=True
        ):
            assert abs(a - real(moment_of) * mpmath.sqrt(real(square)) / L) <= (1 + 1e-12) * 2.0**-53 * a


@pytest.mark.parametrize("spin", [(6.0, 1.0, 7.0), (-6.0, 0.25, 7.0), (12.0, -3.0, -14.0), (6e-3, 1e3, 7e-3)])
def test_on_the_separatrix_the_body_ends_turning_at_the_rate_of_its_middle_axis(spin) -> None:
    """w tends to L/B along the middle axis, and psi'/2 with it to L/2B."""
    moments = (14.0, 21.0, 24.0)
    found = constants_of_motion(np.array(moments), ZERO, np.array(spin), ZERO, True, Scaled(0.0, 0.0, 0))
    pre = precession_constants(found, np.array(moments), ZERO, np.array(spin), ZERO)
    assert pre.branch == LIMIT
    with mpmath.workdps(50):
        L = mpmath.sqrt(sum((mpmath.mpf(a) * mpmath.mpf(b)) ** 2 for a, b in zip(moments, spin, strict=True)))
        want = L / (2 * 21) / (mpmath.pi / 2) / mpmath.mpf(found.time_scale)
        assert abs(number(pre.turn, pre.turn_tail) - want) <= 400 * SQUARE * want
        # tan eta_x = M_x/(L + M_z) at u = 0, where M_y = 0.
        tangent = mpmath.mpf(pre.a_x) / (1 + mpmath.mpf(pre.a_z))
        assert abs(mpmath.mpf(pre.quarter.sin_x) / mpmath.mpf(pre.quarter.cos_x) - tangent) <= 6 * 2.0**-53 * tangent


def test_a_modulus_that_vanishes_turns_evenly() -> None:
    """Two equal moments: psi grows in proportion to time, at half of psi'."""
    i, w = np.array([1.0, 1.0, 2.0]), np.array([0.3, 0.4, 1.0])
    found = motion((1.0, 1.0, 2.0), tuple(w))
    c = circulation(i, ZERO, w, ZERO, 2)
    far = amplitudes(c)
    t = turning(c, far.c, far.d)
    q = quarter_turn(c, t, periods(*moduli(0.0, 1.0)))
    assert found.m == 0.0
    assert q[2:] == (0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    # psi' = L/A less the rate (C - A)/A w_z: P carries no turn of its own about z.
    with mpmath.workdps(50):
        L = mpmath.sqrt(mpmath.mpf(w[0]) ** 2 + mpmath.mpf(w[1]) ** 2 + 4)
        want = (L - 1) * mpmath.pi / 4
        assert abs(number(q.per_quarter, q.per_quarter_tail) - want) <= 200 * SQUARE * want

"""Quaternions along a motion, part by part: the theta phase, the pole, the angle about it, a steady spin.

The angle psi is compared with a quadrature of psi' = (2E + L w_d)/(L + M_d) over the amplitude of the motion, and the
place of the momentum with samples of the angular velocity, which are made without any attitude.
"""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.double_double import Scaled
from core.rotation.attitude.sampling import phase_at_start, sample_attitude, sample_steady
from core.rotation.closed_form.constants_of_motion import constants_of_motion
from core.rotation.closed_form.sampling import sample_components
from core.rotation.precession.constants import CIRCULAR, HYPERBOLIC, LIMIT, PrecessionConstants, precession_constants
from tests.core.rotation.closed_form.test_constants_of_motion import motion
from tests.drawn import draws
from tests.oracles.polhode import Polhode

U = 2.0**-53
ZERO = np.zeros(3)
SAME = np.eye(4)

moment = st.floats(0.5, 2.0)
rate = (st.floats(0.1, 1.0) | st.floats(-3, 0).map(lambda e: 10.0**e)).flatmap(lambda x: st.sampled_from([x, -x]))
time = st.floats(-20.0, 20.0)
SEPARATRIX = ((14.0, 21.0, 24.0), (6.0, 1.0, 7.0))


def real(x: Fraction) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator


def built(moments, rates):
    found = motion(moments, rates)
    return found, precession_constants(found, np.array(moments), ZERO, np.array(rates), ZERO)


def sampled(found, pre: PrecessionConstants, times) -> np.ndarray:
    out = np.empty((4, len(times)))
    sample_attitude(found, pre, np.array(times), SAME, out)
    return out.T


def pole(q) -> np.ndarray:
    """Return the space axis z' in the body: the last row of the rotation matrix."""
    w, x, y, z = q
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z])


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate), st.lists(time, min_size=1, max_size=5))
def test_unit_quaternions_that_take_the_momentum_to_its_place(moments, rates, times) -> None:
    moments = sorted(moments)
    assume(min(moments[1] - moments[0], moments[2] - moments[1]) > 1e-3)
    found, pre = built(moments, rates)
    c, b, d = np.empty((3, len(times)))
    sample_components(found, np.array(times), c, b, d)
    axis_c, axis_d = (0, 2) if found.circled == 2 else (2, 0)
    L = np.linalg.norm(np.array(moments) * np.array(rates))
    towards_c = 1.0 if found.A_c >= 0.0 else -1.0
    towards_d = 1.0 if found.A_d >= 0.0 else -1.0
    for n, q in enumerate(sampled(found, pre, times)):
        # A reciprocal root and the products of its factors: six roundings, squared.
        assert abs(q @ q - 1) <= 12 * U
        # x' along c, z' along d, each to where the motion is at its largest; y' completes them.
        right = 1.0 if axis_d == 2 else -1.0
        want = np.array(
            [
                towards_c * moments[axis_c] * c[n],
                towards_c * towards_d * right * moments[1] * b[n],
                towards_d * moments[axis_d] * d[n],
            ]
        )
        # Two samples of 8 u each, the pole a sum of products of the quaternion.
        assert np.abs(pole(q) - want / L).max() <= (8 + 8 + 12) * U


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate), time)
def test_the_angle_about_the_momentum_is_the_integral_of_its_rate(moments, rates, t) -> None:
    moments = sorted(moments)
    assume(min(moments[1] - moments[0], moments[2] - moments[1]) > 0.02)
    i, w = [Fraction(x) for x in moments], [Fraction(x) for x in rates]
    polhode = Polhode.through(i, w)
    assume(polhode.m1 > Fraction(1, 10**3))
    found, pre = built(moments, rates)
    assert pre.branch in (CIRCULAR, HYPERBOLIC)
    here, there = sampled(found, pre, [0.0, t])
    # P has no part along z: half of psi is the angle of (w, z).
    got = np.angle(complex(there[0], there[3]) / complex(here[0], here[3]))
    with mpmath.workdps(30):
        m = real(polhode.m)
        L = mpmath.sqrt(real(polhode.squared_momentum))
        energy = real(sum(a * b * b for a, b in zip(i, w, strict=True)))
        p, w_d = mpmath.sqrt(real(polhode.squared_p)), mpmath.sqrt(real(polhode.squared_amplitudes.d))
        I_d = real(polhode.moments.d)
        K = mpmath.ellipk(m)
        u0 = (mpmath.mpf(found.start_quarter) + mpmath.mpf(found.start) + mpmath.mpf(found.start_tail)) * K

        def half_rate(time):
            dn = mpmath.ellipfun("dn", u0 + p * time, m=m)
            return (energy + L * w_d * dn) / (L + I_d * w_d * dn) / 2

        # Gauss-Legendre on pieces of a quarter period, in which the rate is analytic far around.
        pieces = max(1, int(abs(p * t) / K) + 1)
        want = mpmath.quad(half_rate, mpmath.linspace(0, t, pieces + 1), method="gauss-legendre", maxdegree=5)
    # Each attitude is right to 5 u (docs/accuracy.md), half of it here for an angle, for two; the quaternion's sign is
    # that of continuity, so that no half turn is left out.
    off = (float(mpmath.fmod(want - got + mpmath.pi, 2 * mpmath.pi)) + 2 * np.pi) % (2 * np.pi) - np.pi
    assert abs(off) <= 2 * 10 * U


def test_the_angle_on_the_separatrix() -> None:
    """psi/2 = L u/(2 B p) - g arctan(h tanh(u/2)), h = M_x/(L + M_z) at u = 0 (`core.rotation.turning_motion`)."""
    moments, rates = SEPARATRIX
    found = constants_of_motion(np.array(moments), ZERO, np.array(rates), ZERO, True, Scaled(0.0, 0.0, 0))
    pre = precession_constants(found, np.array(moments), ZERO, np.array(rates), ZERO)
    assert pre.branch == LIMIT
    times = [-3.0, -0.1, 0.0, 0.2, 5.0]
    with mpmath.workdps(40):
        L = mpmath.sqrt(sum((mpmath.mpf(a) * b) ** 2 for a, b in zip(moments, rates, strict=True)))
        polhode = Polhode.through([Fraction(x) for x in moments], [Fraction(x) for x in rates])
        p = mpmath.sqrt(real(polhode.squared_p))
        u0 = mpmath.mpf(found.start) + mpmath.mpf(found.start_tail)
        h = mpmath.mpf(pre.a_x) / (1 + mpmath.mpf(pre.a_z))

        def half(u):
            return L * u / (2 * 21 * p) - pre.eta * mpmath.atan(h * mpmath.tanh(u / 2))

        first = complex(*sampled(found, pre, [0.0])[0][[0, 3]])
        for t, q in zip(times, sampled(found, pre, times), strict=True):
            got = np.angle(complex(q[0], q[3]) / first)
            off = float(mpmath.fmod(half(u0 + p * t) - half(u0) - got + 7 * mpmath.pi, 2 * mpmath.pi) - mpmath.pi)
            assert abs(off) <= 2 * 10 * U


@pytest.mark.parametrize("rates", [(0.1, 1.0, 1.5), (1.5, -1.0, 0.1), (1e-7, 1.0, 2e-7), (0.3, 0.2, -2.0)])
def test_the_phase_at_the_start_is_that_of_the_first_sample(rates) -> None:
    moments = (14.0, 21.0, 24.0)
    found, pre = built(moments, rates)
    cosine, sine = phase_at_start(found, pre)
    q = sampled(found, pre, [0.0])[0]
    assert np.angle(complex(q[0], q[3]) / complex(cosine, sine)) == pytest.approx(0.0, abs=8 * U)


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.floats(1e-3, 1e3), st.floats(-1e6, 1e6), st.tuples(*3 * [st.floats(-1.0, 1.0)]))
def test_a_steady_spin(rate, t, axis) -> None:
    """exp(n theta/2), theta/2 = rate t quarter turns; `turn` is any matrix and is applied to it."""
    assume(max(map(abs, axis)) > 1e-3)
    n = np.array(axis) / np.linalg.norm(axis)
    turn = np.array([[0.5, -0.5, 0.5, 0.5], [0.5, 0.5, 0.5, -0.5], [-0.5, -0.5, 0.5, -0.5], [-0.5, 0.5, 0.5, 0.5]])
    out = np.empty((4, 1))
    sample_steady(rate, 0.25 * np.spacing(rate), n, 2.0, np.array([t]), turn, out)
    with mpmath.workdps(50):
        half = (mpmath.mpf(rate) + mpmath.mpf(0.25 * np.spacing(rate))) * 2 * mpmath.mpf(t) * mpmath.pi / 2
        q = [mpmath.cos(half), *(mpmath.sin(half) * x for x in n)]
        for k in range(4):
            want = sum(mpmath.mpf(turn[k, j]) * q[j] for j in range(4))
            # Sine and cosine to 1.5 u, five products and sums; every term is at most 1/2.
            assert abs(out[k, 0] - want) <= 6 * U

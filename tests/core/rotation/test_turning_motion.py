"""A turning motion as balls: every enclosure holds the truth, and energy, momentum and the pole stand still in it.

The oracle is Euler's angles with Carlson's integrals (`tests.oracles`); the code has theta functions and the shortest
arc. A ball that does not contain the truth is an error, however narrow.
"""

from __future__ import annotations

from fractions import Fraction

import mpmath
import pytest
from flint import arb
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.bodies.exact_inertia import ExactInertia
from core.rotation.exact_start import ExactStart
from core.rotation.turning_motion import TurningMotion, product
from tests.drawn import draws
from tests.oracles.free_rotation import precession_per_period, reference_angular_velocity
from tests.oracles.polhode import Polhode, accelerates

BITS = 240
moment = st.fractions(Fraction(1, 2), 3, max_denominator=64)
rate = st.fractions(-2, 2, max_denominator=64).filter(lambda x: abs(x) > Fraction(1, 32))
time = st.fractions(-20, 20, max_denominator=16)


def built(moments, rates) -> TurningMotion:
    return TurningMotion(ExactStart(ExactInertia.of_moments(moments), tuple(rates)))


def contains(ball: arb, want: Fraction | mpmath.mpf, width: int = 180) -> None:
    """The ball contains the true value, as far as its digits are known, and is narrow."""
    text = arb(mpmath.nstr(want, 58)) if isinstance(want, mpmath.mpf) else arb(want.numerator) / want.denominator
    slack = arb(0, abs(text) * arb(10) ** -50 + arb(10) ** -55) if isinstance(want, mpmath.mpf) else arb(0)
    assert ball.overlaps(text + slack)
    assert ball.rad() < (abs(text) + 1) * arb(2) ** -width


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate))
def test_constants_are_those_of_the_exact_polhode(moments, rates) -> None:
    assume(len(set(moments)) == 3)
    polhode = Polhode.through(moments, rates)
    assume(polhode.m1 > 0)
    with precision(BITS):
        found = built(moments, rates)
        b, c, d = polhode.squared_amplitudes
        for ball, want in (
            (found.A_b**2, b), (found.A_c**2, c), (found.A_d**2, d), (found.p**2, polhode.squared_p),
            (found.m, polhode.m), (found.m1, polhode.m1), (found.L**2, polhode.squared_momentum),
        ):  # fmt: skip
            contains(ball, want)
        with mpmath.workdps(60):
            largest = mpmath.mpf(polhode.squared_largest_rate.numerator) / polhode.squared_largest_rate.denominator
            contains(found.largest_rate, mpmath.sqrt(largest))


@settings(deadline=None, derandomize=True, max_examples=20)
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate), time)
def test_samples_against_the_oracle(moments, rates, t) -> None:
    assume(len(set(moments)) == 3)
    assume(accelerates(moments, rates))
    assume(Polhode.through(moments, rates).m1 > Fraction(1, 10**6))
    with precision(BITS), mpmath.workdps(60):
        found = built(moments, rates)
        at = arb(t.numerator) / t.denominator
        w = found.angular_velocity(at)
        (want,) = reference_angular_velocity(moments, rates, [t], digits=52)
        for ball, truth in zip(w, want, strict=True):
            contains(ball, truth)
        contains(found.precession_per_period, precession_per_period(moments, rates, digits=52))
        # Energy and momentum, from the samples alone.
        for power in (1, 2):
            start = sum(i**power * x * x for i, x in zip(moments, rates, strict=True))
            now = sum(
                ((arb(i.numerator) / i.denominator) ** power * x * x for i, x in zip(moments, w, strict=True)), arb(0)
            )
            contains(now, start)


@settings(deadline=None, derandomize=True, max_examples=20)
@given(st.tuples(moment, moment, moment), st.tuples(rate, rate, rate), time)
def test_the_attitude_holds_the_momentum_where_it_is_in_space(moments, rates, t) -> None:
    assume(len(set(moments)) == 3)
    assume(accelerates(moments, rates))
    assume(Polhode.through(moments, rates).m1 > Fraction(1, 10**6))
    with precision(BITS):
        found = built(moments, rates)
        one = (arb(1), arb(0), arb(0), arb(0))
        attitude = found.attitudes(one)
        at = arb(t.numerator) / t.denominator
        phase = found.phase(at)
        q = attitude(phase, found.in_frame(phase))
        contains(sum((x * x for x in q), arb(0)), Fraction(1))
        w = found.angular_velocity(at)
        M = [arb(i.numerator) / i.denominator * x for i, x in zip(moments, w, strict=True)]
        back = (q[0], -q[1], -q[2], -q[3])
        _, *space = product(product(q, (arb(0), *M)), back)
        for ball, i, x in zip(space, moments, rates, strict=True):
            contains(ball, i * x)
        start = attitude(found.z0, found.in_frame(found.z0))
        for ball, want in zip(start, (1, 0, 0, 0), strict=True):
            contains(ball, Fraction(want))


def test_the_separatrix() -> None:
    """Moments 14, 21, 24 and rates 6, 1, 7: 14 7 36 = 24 3 49."""
    with precision(BITS), mpmath.workdps(60):
        found = built((14, 21, 24), (Fraction(6), Fraction(1), Fraction(7)))
        assert found.separatrix
        assert found.period is None
        assert found.precession_per_period is None
        (want,) = reference_angular_velocity((14.0, 21.0, 24.0), (6.0, 1.0, 7.0), [0.5], digits=52)
        for ball, truth in zip(found.angular_velocity(arb(0.5)), want, strict=True):
            contains(ball, truth)


@pytest.mark.parametrize(("p", "q", "r"), [(1, 2, 3), (2, 3, 1), (3, 1, 2)])
def test_hamilton_s_product(p: int, q: int, r: int) -> None:
    unit = [tuple(arb(int(k == n)) for n in range(4)) for k in range(4)]
    assert [float(x) for x in product(unit[p], unit[q])] == [float(x) for x in unit[r]]
    assert [float(x) for x in product(unit[q], unit[p])] == [-float(x) for x in unit[r]]
    assert [float(x) for x in product(unit[p], unit[p])] == [-1.0, 0.0, 0.0, 0.0]
    assert [float(x) for x in product(unit[0], unit[p])] == [float(x) for x in unit[p]]

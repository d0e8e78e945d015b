"""The pendulum against Taylor series of its equation, its first integrals and its own samples.

u = 2^-53. A sample is right to 6.5 u in each Jacobian function and a rounding or two after it.
"""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.errors import AccuracyUnreachable
from core.scenes.enclosure import BITS, as_pair, exact
from core.scenes.pendulum import Pendulum
from tests.core.scenes.oracles import pendulum_angle
from tests.drawn import draws

U = 2.0**-53
frequency = st.floats(0.2, 5.0)
angle = st.floats(-3.0, 3.0)
rate = st.floats(-12.0, 12.0)
time = st.floats(-3.0, 3.0)


def started(w0: float, psi: float, spin: float) -> Pendulum:
    half = exact(psi) / 2
    return Pendulum(exact(w0), half.sin(), half.cos(), exact(spin))


def number(ball) -> mp.mpf:
    high, low = as_pair(ball)
    return mp.mpf(high) + mp.mpf(low)


@settings(deadline=None, derandomize=True, max_examples=15)
@given(frequency, angle, rate, st.lists(time, min_size=1, max_size=1))
def test_every_regime_against_taylor_series(w0, psi, spin, times) -> None:
    with precision(BITS):
        swing = started(w0, psi, spin)
        found = swing.sample(np.array(times))
        regime = swing.regime
    with mp.workdps(30):
        m = mp.sin(mp.mpf(psi) / 2) ** 2 + (mp.mpf(spin) / (2 * w0)) ** 2
        assert regime == ("rest" if m == 0 else "libration" if m < 1 else "rotation" if m > 1 else "separatrix")
        for n, t in enumerate(times):
            want, want_rate = pendulum_angle(mp.mpf(w0), mp.mpf(psi), mp.mpf(spin), mp.mpf(t))
            s, c, speed, turned = (column[n] for column in found)
            largest = 2 * w0 * mp.sqrt(m)
            assert abs(speed - want_rate) <= 10 * U * largest
            assert abs(turned - want) <= 20 * U * max(abs(want), mp.mpf(1))
            # Half the angle modulo whole turns: the sign of the pair (s, c) is that of continuity or its opposite.
            side = 1 if mp.cos(want / 2) * c + mp.sin(want / 2) * s > 0 else -1
            assert abs(side * s - mp.sin(want / 2)) <= 10 * U
            assert abs(side * c - mp.cos(want / 2)) <= 10 * U


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(frequency, angle, rate)
def test_energy_along_the_samples(w0, psi, spin) -> None:
    with precision(BITS):
        swing = started(w0, psi, spin)
        assume(swing.regime != "rest")
        m = float(swing.m)
        s, c, speed, _ = swing.sample(np.linspace(-1e4, 1e4, 301))
    assert np.abs(s * s + c * c - 1).max() <= 2 * 8 * U * (1 + m)
    assert np.abs(s * s + (speed / (2 * w0)) ** 2 - m).max() <= 2 * 9 * U * (1 + m)


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(frequency, angle, rate)
def test_the_period_brings_everything_back(w0, psi, spin) -> None:
    with precision(BITS), mp.workdps(40):
        swing = started(w0, psi, spin)
        assume(swing.regime in ("libration", "rotation"))
        m = mp.sin(mp.mpf(psi) / 2) ** 2 + (mp.mpf(spin) / (2 * w0)) ** 2
        # T = 4K(m)/w0 swinging, 2K(1/m)/(w0 sqrt m) for a whole turn, K by Carlson's duplication.
        turning = 2 * mp.elliprf(0, 1 - 1 / m, 1) / (w0 * mp.sqrt(m)) if m > 1 else None
        want = turning or 4 * mp.elliprf(0, 1 - m, 1) / w0
        assert abs(number(swing.period) - want) <= mp.mpf(2) ** -100 * want


@settings(deadline=None, derandomize=True, max_examples=30)
@given(frequency, angle, rate, st.floats(-3.0, 3.0), st.sampled_from([-1, 1]))
def test_the_first_passage_is_one_and_none_is_before_it(w0, psi, spin, goal, way) -> None:
    with precision(BITS):
        swing = started(w0, psi, spin)
        assume(swing.regime in ("libration", "rotation"))
        half = exact(goal) / 2
        found = swing.passes(half.sin(), half.cos(), way)
        period = float(swing.period)
        until = period if found is None else float(found)
        assert 0 <= until <= period * (1 + 1e-15)
        times = np.linspace(0.0, until, 400)[1:-1]
        s, c, _, _ = swing.sample(times)
        # The sine of half the angle short of the goal; positive beyond it.
        beyond = s * math.cos(goal / 2) - c * math.sin(goal / 2)
        beyond *= np.sign(c * math.cos(goal / 2) + s * math.sin(goal / 2))
        crossed = (np.sign(beyond[:-1]) == -way) & (np.sign(beyond[1:]) == way) & (np.abs(np.diff(beyond)) < 0.5)
        inside = np.minimum(np.abs(beyond[:-1]), np.abs(beyond[1:])) > 1e-9
        assert not (crossed & inside).any()
        if found is None:
            reach = float(swing.m)
            assert math.sin(goal / 2) ** 2 > reach * (1 - 1e-12) or (
                swing.regime == "rotation" and way != swing.direction
            )
            return
        with mp.workdps(40):
            there, speed_there = pendulum_angle(mp.mpf(w0), mp.mpf(psi), mp.mpf(spin), number(found))
            assert abs(mp.sin((there - mp.mpf(goal)) / 2)) <= mp.mpf(10) ** -25
            assert speed_there * way > -(mp.mpf(10) ** -12)


def test_rest_and_the_separatrix() -> None:
    with precision(BITS):
        rest = started(1.0, 0.0, 0.0)
        assert rest.regime == "rest"
        assert rest.period is None
        assert rest.passes(exact(0.0), exact(1.0), 1) is None
        assert [column.tolist() for column in rest.sample(np.array([1.0, 2.0]))] == [
            [0.0, 0.0],
            [1.0, 1.0],
            *2 * [[0.0, 0.0]],
        ]
        # psi' = 2 w0 at the bottom: psi = 2 arctan(sinh(w0 t)).
        upward = started(1.5, 0.0, -3.0)
        assert upward.regime == "separatrix"
        assert upward.period is None
        times = np.array([-1.0, 0.0, 0.4, 30.0])
        s, c, speed, turned = upward.sample(times)
        assert turned == pytest.approx(-2 * np.arctan(np.sinh(1.5 * times)), rel=8 * U)
        assert speed == pytest.approx(-3.0 / np.cosh(1.5 * times), rel=2 * 50 * U)
        assert s * s + c * c == pytest.approx(1.0, abs=8 * U)
        half = exact(-1.0) / 2
        arrival = upward.passes(half.sin(), half.cos(), -1)
        assert float(arrival) == pytest.approx(math.asinh(math.tan(0.5)) / 1.5, rel=4 * U)
        assert upward.passes(half.sin(), half.cos(), 1) is None
        assert upward.passes(-half.sin(), half.cos(), -1) is None


def test_a_phase_without_digits_is_refused() -> None:
    with precision(BITS), pytest.raises(AccuracyUnreachable) as refused:
        started(1.0, 1.0, 0.0).sample(np.array([1e17]))
    assert refused.value.path == ("times",)

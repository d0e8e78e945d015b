"""Kutta's method against its own tableau in rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.systems.methods import RungeKutta4
from tests.core.systems.systems import bell, oscillator, rigid_body
from tests.drawn import draws

U = 2.0**-53
HALF = Fraction(1, 2)
ROWS = ((), (HALF,), (Fraction(0), HALF), (Fraction(0), Fraction(0), Fraction(1)))
NODES = (Fraction(0), HALF, HALF, Fraction(1))
WEIGHTS = (Fraction(1, 6), Fraction(1, 3), Fraction(1, 3), Fraction(1, 6))


def step(field, t: Fraction, y: list[Fraction], h: Fraction) -> list[Fraction]:
    """One step of the tableau of W. Kutta (1901)."""
    slopes: list[list[Fraction]] = []
    for row, node in zip(ROWS, NODES, strict=True):
        moved = [sum((a * s[k] for a, s in zip(row, slopes, strict=False)), Fraction(0)) for k in range(len(y))]
        stage = [y[k] + h * moved[k] for k in range(len(y))]
        slopes.append(field(t + node * h, stage))
    return [y[k] + h * sum(b * s[k] for b, s in zip(WEIGHTS, slopes, strict=True)) for k in range(len(y))]


def euler(moments):
    def field(t: Fraction, w: list[Fraction]) -> list[Fraction]:
        return [(moments[i - 2] - moments[i - 1]) / moments[i] * w[i - 2] * w[i - 1] for i in range(3)]

    return field


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.tuples(*3 * [st.floats(0.5, 4.0)]), st.tuples(*3 * [st.floats(-2.0, 2.0)]), st.floats(1e-3, 0.25))
def test_a_step_of_euler_s_equations(moments, rates, h) -> None:
    exact = [Fraction(x) for x in moments]
    want = step(euler(exact), Fraction(0), [Fraction(x) for x in rates], Fraction(h))
    got = RungeKutta4(h).integrate(rigid_body(moments, rates), np.array([h])).states[0]
    # A slope is at most 7 2^2 = 28 and rounds five times; its errors pass on multiplied by h, and less with each stage.
    for g, w in zip(got, want, strict=True):
        assert abs(Fraction(float(g)) - w) <= Fraction(U) * (abs(w) + Fraction(h) * 28 * 12)


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.floats(0.01, 1.0), st.integers(1, 20))
def test_an_oscillator_is_multiplied_by_the_taylor_polynomial_of_degree_four(h, n) -> None:
    """(1 + z + z^2/2 + z^3/6 + z^4/24)^n at z = i h."""
    exact = Fraction(h)
    factor = (1 - exact**2 / 2 + exact**4 / 24, exact - exact**3 / 6)
    c, s = Fraction(1), Fraction(0)
    for _ in range(n):
        c, s = c * factor[0] - s * factor[1], c * factor[1] + s * factor[0]
    got = RungeKutta4(h).integrate(oscillator(), h * np.arange(1.0, n + 1)).states[-1]
    # Each step rounds position and velocity a dozen times, and adds to what was there.
    for g, w in zip(got, (c, -s), strict=True):
        assert abs(Fraction(float(g)) - w) <= 12 * n * Fraction(U)


def test_a_field_of_time_is_evaluated_at_the_nodes() -> None:
    """y' = -2 t y from t = 0.5 on: the stages stand at t, t + h/2, t + h/2, t + h."""
    h = 0.125
    states = RungeKutta4(h).integrate(bell(), np.array([0.5, 0.625])).states
    want = step(lambda t, y: [-2 * t * y[0]], Fraction(1, 2), [Fraction(float(states[0, 0]))], Fraction(h))
    assert abs(Fraction(float(states[1, 0])) - want[0]) <= 8 * Fraction(U)

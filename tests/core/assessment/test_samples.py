"""Samples made by integrators that are written out here are found with their step, and nothing else is."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from core.assessment.samples import consistent_method, errors_of_samples
from core.bodies import PrincipalMoments
from core.rotation.torque_free import TorqueFree

Rows = np.ndarray
Slope = Callable[[Rows], Rows]


def gyration(moments: Rows) -> Slope:
    a, b, c = moments
    return lambda w: np.array([(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]])


def euler(f: Slope, w: Rows, h: float) -> Rows:
    return w + h * f(w)


def runge_kutta(f: Slope, w: Rows, h: float) -> Rows:
    k1 = f(w)
    k2 = f(w + h / 2 * k1)
    k3 = f(w + h / 2 * k2)
    return w + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(w + h * k3))


def midpoint(f: Slope, w: Rows, h: float) -> Rows:
    new = w
    for _ in range(100):
        new = w + h * f((w + new) / 2)
    return new


def marched(step: Callable[[Slope, Rows, float], Rows], f: Slope, w: Rows, h: float, count: int) -> Rows:
    rows = [w]
    for _ in range(count):
        rows.append(step(f, rows[-1], h))
    return np.array(rows)


def motion(chance: Random) -> tuple[Rows, Rows, TorqueFree]:
    a, b = sorted(chance.uniform(1.0, 2.0) for _ in range(2))
    moments = np.array(chance.sample([a, b, chance.uniform(b, a + b)], 3))
    start = np.array([chance.choice([-1, 1]) * chance.uniform(0.5, 2.0) for _ in range(3)])
    return moments, start, TorqueFree(PrincipalMoments(tuple(moments.tolist())).mass_properties(), start)


CASES = {"explicit-euler": (euler, 0.001, 0.02), "runge-kutta-4": (runge_kutta, 0.05, 0.2),
         "implicit-midpoint": (midpoint, 0.01, 0.1)}  # fmt: skip


@pytest.mark.parametrize("kind", CASES)
@settings(max_examples=15)
@given(seed=st.integers(0, 10**9), every=st.sampled_from([1, 2, 5]))
def test_a_method_is_found_with_its_step(kind: str, seed: int, every: int) -> None:
    chance = Random(seed)
    moments, start, system = motion(chance)
    step, low, high = CASES[kind]
    h = chance.uniform(low, high)
    rows = marched(step, gyration(moments), start, h, 200)[::every]
    times = np.arange(201)[::every] * h
    found = consistent_method(system, times, rows, system.closed_form().sample(times))
    assert found is not None
    assert found.method == kind
    assert found.step == pytest.approx(h, rel=1e-6)
    assert (
        found.unexplained < 1e-3 * errors_of_samples(system, times, rows, system.closed_form().sample(times), 0).largest
    )


def test_a_step_that_does_not_divide_the_spacing_is_found() -> None:
    moments, start, system = motion(Random(1))
    grid = np.arange(2001) * 0.007
    states = marched(euler, gyration(moments), start, 0.007, 2000)
    times = np.arange(100) * 0.1
    rows = np.array([np.interp(times, grid, states[:, k]) for k in range(3)]).T
    found = consistent_method(system, times, rows, system.closed_form().sample(times))
    assert found is not None
    assert (found.method, found.step) == ("explicit-euler", pytest.approx(0.007))


def test_printed_digits_hide_no_method() -> None:
    moments, start, system = motion(Random(2))
    rows = np.round(marched(euler, gyration(moments), start, 0.01, 500), 4)
    times = np.arange(501) * 0.01
    found = consistent_method(system, times, rows, system.closed_form().sample(times))
    assert found is not None
    assert (found.method, found.step) == ("explicit-euler", pytest.approx(0.01, rel=1e-3))


@settings(max_examples=10)
@given(seed=st.integers(0, 10**9))
def test_other_errors_are_taken_for_no_method(seed: int) -> None:
    chance = Random(seed)
    moments, start, system = motion(chance)
    times = np.arange(100) * 0.1
    right = system.closed_form().sample(times)
    noisy = right + np.random.default_rng(seed).normal(0.0, 1e-3, right.shape)
    adaptive = solve_ivp(lambda t, w: gyration(moments)(w), (0, 10), start, t_eval=times, rtol=1e-4).y.T
    late = right.copy()
    late[50:] += 0.1
    for rows in (noisy, adaptive, late, right[:, [1, 0, 2]]):
        assert consistent_method(system, times, rows, right) is None


def test_exact_samples_are_exact_to_their_digits() -> None:
    _, _, system = motion(Random(3))
    times = np.linspace(-3.0, 5.0, 50)
    right = system.closed_form().sample(times)
    for rows in (right, np.round(right, 3)):
        found = consistent_method(system, times, rows, right)
        assert found is not None
        assert (found.method, found.step) == ("exact", None)


def test_errors_say_how_much_and_since_when() -> None:
    moments, _, system = motion(Random(4))
    times = np.array([0.0, 3.0, 1.0, -2.0, 4.0])
    right = system.closed_form().sample(times)
    rows = right + np.array([[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, 0.02], [0.0, 0.2, 0.0]])
    found = errors_of_samples(system, times, rows, right, 0.015)
    assert found.largest == pytest.approx(0.5)
    assert found.final == pytest.approx(0.2)
    assert found.within_until == -2.0
    energy = (moments * rows**2).sum(axis=1)
    assert found.energy_drift == pytest.approx(np.abs(energy / energy[0] - 1).max())
    assert errors_of_samples(system, times, rows, right, 1.0).within_until is None


def test_the_drift_of_explicit_euler_obeys_its_identity() -> None:
    """Every step adds h^2/2 sum I f^2 to the energy, and h^2 sum (I f)^2 to the square of the angular momentum."""
    moments, start, system = motion(Random(5))
    f, h = gyration(moments), 0.01
    states = marched(euler, f, start, h, 300)
    slopes = np.array([f(w) for w in states[:-1]])
    times = np.arange(301) * h
    found = errors_of_samples(system, times, states, system.closed_form().sample(times), 1.0)
    energy = 0.5 * (moments * start**2).sum()
    gained = 0.5 * h * h * (moments * slopes**2).sum()
    assert found.energy_drift == pytest.approx(gained / energy, rel=1e-9)
    square = ((moments * start) ** 2).sum()
    momentum = np.sqrt(1.0 + h * h * ((moments * slopes) ** 2).sum() / square) - 1.0
    assert found.angular_momentum_drift == pytest.approx(momentum, rel=1e-9)


def test_samples_that_run_away_have_no_drift() -> None:
    _, _, system = motion(Random(6))
    times = np.array([0.0, 1.0])
    rows = np.array([[1.0, 1.0, 1.0], [1e200, 1e200, 1e200]])
    found = errors_of_samples(system, times, rows, system.closed_form().sample(times), 1.0)
    assert found.energy_drift is None
    assert found.largest == pytest.approx(3**0.5 * 1e200)

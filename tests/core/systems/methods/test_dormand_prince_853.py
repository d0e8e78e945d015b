"""Dormand-Prince 8(5,3): its control of the step, its interpolant at work."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.errors import BudgetExceeded, InvalidParameter
from core.systems.budget import Budget
from core.systems.methods import DormandPrince853
from tests.core.systems.systems import bell, elliptic_functions, explosion, kepler, oscillator, prey_and_predator


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-11, 1e-14])
def test_the_error_is_of_the_size_of_the_tolerance(tolerance: float) -> None:
    system, times = elliptic_functions(), np.linspace(0, 20, 501)
    states = DormandPrince853(tolerance).integrate(system, times).states
    error = np.abs(states - system.exact.sample(times)).max()
    assert error < 10 * tolerance + 2e-14


def test_as_efficient_as_the_published_control() -> None:
    system = kepler(0.7)
    times = np.linspace(0, 20, 51)
    exact = system.exact.sample(times)

    def field(t: float, y: np.ndarray) -> np.ndarray:
        slope = np.empty(4)
        system.equation(t, y, system.parameters, slope)
        return slope

    ours = DormandPrince853(1e-9).integrate(system, times)
    theirs = solve_ivp(field, (0, 20), system.initial_state, "DOP853", times, rtol=1e-9, atol=1e-9)
    assert ours.work.evaluations < 1.3 * theirs.nfev
    assert np.abs(ours.states - exact).max() < 3 * np.abs(theirs.y.T - exact).max()


@pytest.mark.parametrize("n", [2, 3, 100, 5000])
def test_how_many_samples_are_requested_changes_no_step(n: int) -> None:
    system = prey_and_predator()
    few = DormandPrince853(1e-9).integrate(system, np.array([30.0]))
    many = DormandPrince853(1e-9).integrate(system, np.linspace(0, 30, n))
    assert many.work.steps == few.work.steps
    assert (many.states[-1] == few.states[-1]).all()
    assert many.work.evaluations <= few.work.evaluations + 3 * few.work.steps


def test_interpolated_samples_are_as_right_as_the_ends_of_steps() -> None:
    system = elliptic_functions()
    times = np.linspace(0, 20, 3001)
    dense = DormandPrince853(1e-10).integrate(system, times).states
    apart = DormandPrince853(1e-13).integrate(system, times).states
    assert np.abs(dense - apart).max() < 1e-9


def test_a_long_run_grows_no_faster_than_the_phase() -> None:
    # 1600 periods; the rounding of 30000 steps, were it not carried on, would add to the amplitude at random.
    times = np.linspace(0, 10_000, 101)
    system = oscillator()
    run = DormandPrince853(1e-15).integrate(system, times)
    assert run.work.steps > 10_000
    assert np.abs(run.states - system.exact.sample(times)).max() < 3e-12


def test_the_time_is_given_to_the_equation() -> None:
    times = np.linspace(-2, 2, 41)
    assert np.abs(DormandPrince853(1e-12).integrate(bell(), times).states[:, 0] - np.exp(-(times**2))).max() < 1e-10


def test_a_solution_that_ceases_to_exist_is_reported_with_the_place() -> None:
    with pytest.raises(InvalidParameter, match="at t = 1 s") as refused:
        DormandPrince853(1e-9).integrate(explosion(), np.array([2.0]))
    assert refused.value.path == ("tolerance",)
    before = DormandPrince853(1e-12).integrate(explosion(), np.array([0.999])).states[0, 0]
    assert before == pytest.approx(1000, rel=1e-7)


def test_the_budget_ends_a_run_and_says_what_it_would_have_needed() -> None:
    times = np.array([1000.0])
    full = DormandPrince853(1e-9).integrate(oscillator(), times).work.evaluations
    with pytest.raises(BudgetExceeded) as refused:
        DormandPrince853(1e-9).integrate(oscillator(), times, Budget(evaluations=1000))
    assert 0.8 * full < refused.value.needed < 1.2 * full
    assert refused.value.path == ("tolerance",)


@pytest.mark.parametrize("tolerance", [0.0, -1e-9, 1e-17, 1.0, float("nan")])
def test_tolerances_that_mean_nothing_are_refused(tolerance: float) -> None:
    with pytest.raises(InvalidParameter):
        DormandPrince853(tolerance)


def test_rest_stays_at_rest() -> None:
    run = DormandPrince853(1e-9).integrate(oscillator(position=0.0), np.linspace(-5, 5, 11))
    assert (run.states == 0).all()


def test_a_start_from_rest_that_is_pushed_later_finds_its_scale() -> None:
    run = DormandPrince853(1e-10).integrate(oscillator(position=0.0, velocity=1.0), np.array([1.0]))
    assert run.states[0] == pytest.approx([np.sin(1), np.cos(1)], abs=1e-9)

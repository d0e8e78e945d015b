"""The plan of the steps, and what all methods with a fixed step do with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.systems.budget import Budget
from core.systems.methods import ExplicitEuler, ImplicitMidpoint, RungeKutta4, SymmetricSplitting
from core.systems.methods.fixed_step import plan
from core.systems.system import Structure
from tests.core.systems.systems import bell, explosion, oscillator, rigid_body

FIXED = [ExplicitEuler, RungeKutta4, ImplicitMidpoint, SymmetricSplitting]


def laid_out(targets: np.ndarray, step: float) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    begin, length, count = np.empty_like(targets), np.empty_like(targets), np.empty(targets.size, np.int64)
    return plan(targets, step, begin, length, count), begin, length, count


@pytest.mark.parametrize("n", [2, 11, 2000, 10_000, 1_000_000])
@pytest.mark.parametrize("stop", [15.0, 20.0, 1e-30, 1e30, 0.1, 7 / 3])
def test_a_grid_whose_spacing_is_the_step_gets_one_exact_step_per_interval(stop: float, n: int) -> None:
    times = np.linspace(0, stop, n)
    total, _, length, count = laid_out(times[1:], times[1] - times[0])
    assert total == n - 1
    assert (count == 1).all()
    assert (length == times[1] - times[0]).all()


def test_a_grid_of_rounded_decimals_counts_as_equally_spaced() -> None:
    times = np.array([float(f"{i / 10:.1f}") for i in range(1, 1000)])
    total, _, length, _ = laid_out(times, 0.1)
    assert total == 999
    assert (length == 0.1).all()


@settings(deadline=None, max_examples=200)
@given(
    st.lists(st.floats(1e-6, 1e6), min_size=1, max_size=30, unique=True),
    st.floats(1e-2, 1e7),
    st.sampled_from([-1.0, 1.0]),
)
def test_the_steps_are_no_longer_than_asked_and_end_at_the_targets(
    times: list[float], step: float, sign: float
) -> None:
    targets = sign * np.sort(np.array(times))
    total, begin, length, count = laid_out(targets, step)
    assert total == count.sum()
    assert (np.abs(length) <= step * (1 + 1e-15)).all()
    assert (np.abs(begin + count * length - targets) <= 8 * np.spacing(np.abs(targets))).all()
    # As few as can be: one step less would be too long.
    gaps = np.abs(np.diff(targets, prepend=0.0))
    assert ((count - 1) * step < gaps + 8 * np.spacing(np.abs(targets))).all()


def test_rounding_of_the_times_does_not_add_up_over_many_intervals() -> None:
    times = np.cumsum(np.full(100_000, 0.1))
    _, begin, length, count = laid_out(times, 0.1)
    assert abs(begin[-1] + count[-1] * length[-1] - times[-1]) <= 8 * np.spacing(times[-1])


@pytest.mark.parametrize("method", FIXED)
def test_a_count_beyond_the_budget_is_refused_before_running_with_the_count_needed(method: type) -> None:
    with pytest.raises(BudgetExceeded) as refused:
        method(1e-6).integrate(oscillator(), np.array([1e9]), Budget())
    assert refused.value.path == ("step",)
    assert refused.value.what == "evaluations"
    assert refused.value.limit == 20_000_000
    assert refused.value.needed >= 10**15
    assert "larger step" in (refused.value.remedy or "")


@pytest.mark.parametrize("method", FIXED)
def test_counts_that_no_integer_holds_are_refused_too(method: type) -> None:
    with pytest.raises(BudgetExceeded) as refused:
        method(1e-300).integrate(oscillator(), np.array([1e-300, 1e299, 1e300]))
    assert refused.value.needed == 10**18


def test_the_budget_covers_both_sides_of_the_start() -> None:
    times = np.array([-1.0, 1.0])
    assert ExplicitEuler(0.01).integrate(oscillator(), times, Budget(evaluations=200)).work.evaluations == 200
    with pytest.raises(BudgetExceeded):
        ExplicitEuler(0.01).integrate(oscillator(), times, Budget(evaluations=199))


def test_an_implicit_method_is_stopped_when_its_iterations_use_up_the_budget() -> None:
    with pytest.raises(BudgetExceeded) as refused:
        ImplicitMidpoint(0.1).integrate(oscillator(), np.linspace(0, 1000, 11), Budget(evaluations=20_000))
    full = ImplicitMidpoint(0.1).integrate(oscillator(), np.linspace(0, 1000, 11)).work.evaluations
    assert 20_000 < refused.value.needed < 1.3 * full


@pytest.mark.parametrize("method", FIXED)
def test_states_that_overflow_are_refused_and_no_sample_is_handed_on(method: type) -> None:
    system = oscillator(rate=100.0) if method is SymmetricSplitting else explosion()
    with pytest.raises(InvalidParameter, match="step must be small enough") as refused:
        method(0.4).integrate(system, np.linspace(0, 1000, 101))
    assert "smaller step" in (refused.value.remedy or "")


def test_forward_euler_with_a_step_of_a_fifth_of_a_second_overflows_on_the_tumbling_handle() -> None:
    # The T-handle about the origin, started 8 degrees off its middle axis, as in the source document.
    system = rigid_body((837.195503014, 714.008200689, 437.685185185), (1, 10, 1))
    with pytest.raises(InvalidParameter, match="step must be small enough"):
        ExplicitEuler(0.2).integrate(system, np.linspace(0, 20, 101))
    ExplicitEuler(0.002).integrate(system, np.linspace(0, 20, 101))


def test_a_start_whose_acceleration_overflows_is_refused() -> None:
    unscaled = replace(rigid_body((1, 2, 3), (1e200, 1e200, 1e200)), structure=Structure())
    with pytest.raises(NotApplicable, match="rate of change of the initial state"):
        RungeKutta4(1e-3).integrate(unscaled, np.array([1.0]))


def test_the_equation_is_given_the_time_of_every_stage() -> None:
    times = np.array([0.5, -0.5, 1.5])
    exact = np.exp(-(times[:, None] ** 2))
    assert np.abs(RungeKutta4(1e-3).integrate(bell(), times).states - exact).max() < 1e-12
    assert np.abs(ImplicitMidpoint(1e-3).integrate(bell(), times).states - exact).max() < 1e-6


def test_a_method_without_what_it_needs_names_one_that_needs_less() -> None:
    with pytest.raises(NotApplicable, match="no splitting") as refused:
        SymmetricSplitting(0.1).integrate(bell(), np.array([1.0]))
    assert refused.value.path == ("kind",)
    assert "implicit-midpoint" in (refused.value.remedy or "")

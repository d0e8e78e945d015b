"""The plan of the steps, and what all methods with a fixed step do with it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.systems.budget import Budget
from core.systems.error_statements import estimated, measured
from core.systems.methods import (
    DiscreteMoserVeselov,
    ExplicitEuler,
    ImplicitMidpoint,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.methods.fixed_step import lay_out
from core.systems.system import Structure
from tests.core.systems.systems import bell, explosion, oscillator, rigid_body
from tests.drawn import draws

FIXED = [ExplicitEuler, RungeKutta4, ImplicitMidpoint, SymmetricSplitting, DiscreteMoserVeselov]


def laid_out(targets: np.ndarray, step: float) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    shape = (targets.size, 2)
    begin, length, count = np.empty(shape), np.empty(shape), np.empty(shape, np.int64)
    return lay_out(targets, step, 1, begin, length, count), begin, length, count


@pytest.mark.parametrize("n", [2, 11, 2000, 10_000, 1_000_000])
@pytest.mark.parametrize("stop", [15.0, 20.0, 1e-30, 1e30, 0.1, 7 / 3])
def test_a_grid_whose_spacing_is_the_step_gets_one_exact_step_per_interval(stop: float, n: int) -> None:
    times = np.linspace(0, stop, n)
    total, _, length, count = laid_out(times[1:], times[1] - times[0])
    assert total == n - 1
    assert (count == [1, 0]).all()
    assert (length[:, 0] == times[1] - times[0]).all()


def test_a_grid_of_rounded_decimals_counts_as_equally_spaced() -> None:
    times = np.array([float(f"{i / 10:.1f}") for i in range(1, 1000)])
    total, _, length, _ = laid_out(times, 0.1)
    assert total == 999
    assert (length[:, 0] == 0.1).all()


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(
    st.lists(st.floats(1e-6, 1e6), min_size=1, max_size=30, unique=True),
    st.floats(1e-2, 1e7),
    st.sampled_from([-1.0, 1.0]),
)
def test_the_steps_are_those_of_the_grid_and_end_before_the_target_by_less_than_one(
    times: list[float], step: float, sign: float
) -> None:
    targets = sign * np.sort(np.array(times))
    total, begin, length, count = laid_out(targets, step)
    assert (length[:, 0] == sign * step).all()
    assert total == count.sum()
    off = [4 * Fraction(float(np.spacing(abs(target)))) for target in targets]
    for target, done, before, slack in zip(targets, count[:, 0].cumsum(), length[:, 1], off, strict=True):
        # In rational arithmetic: so many whole steps fit in, and the rest is what is left.
        left = abs(Fraction(target)) - int(done) * Fraction(step)
        assert abs(left - abs(Fraction(before))) <= slack
        assert -slack <= left < Fraction(step)
    assert (np.abs(begin[:, 1] + length[:, 1] - targets) <= 4 * np.spacing(np.abs(targets))).all()


def test_rounding_of_the_grid_does_not_add_up_over_many_steps() -> None:
    _, begin, length, _ = laid_out(np.array([0.1 * 10**12 + 0.05]), 0.1)
    assert begin[0, 1] + length[0, 1] == 0.1 * 10**12 + 0.05


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(
    st.sampled_from(FIXED),
    st.sampled_from([rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7)), oscillator(rate=0.7)]),
    st.floats(1e-3, 0.2),
    st.lists(st.floats(-3.0, 3.0), max_size=12),
)
def test_states_at_grid_points_are_the_same_whatever_other_times_are_requested(method, system, step, others) -> None:
    """In both directions of time, to the last bit, with the work of the samples between them counted."""
    grid = step * np.array([0, 1, 2, 5, 9, -1, -3, -4], dtype=float)
    alone = method(step).integrate(system, grid)
    together = method(step).integrate(system, np.concatenate([others, grid]))
    assert (together.states[len(others) :] == alone.states).all()
    assert together.work.step == alone.work.step == step
    reach = {side: max([9 if side > 0 else 4, *(abs(t) / step for t in others if side * t > 0)]) for side in (1, -1)}
    assert together.work.steps == sum(int(most * (1 + 1e-15)) for most in reach.values())


@pytest.mark.parametrize("method", FIXED)
def test_a_sample_between_grid_points_is_one_step_of_the_method_from_the_point_before(method) -> None:
    system = rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7))
    for way in (1.0, -1.0):
        times = way * 0.1 * np.arange(1.0, 5.0)
        at, between = (method(0.1).integrate(system, x).states for x in (times, times + way * 0.03))
        for before, sample in zip(at, between, strict=True):
            own = method(0.03).integrate(replace(system, initial_state=before), np.array([way * 0.03])).states[0]
            # The march carries the roundings of its sums on; they are below an ulp.
            assert np.abs(sample - own).max() <= 4 * 2.0**-53


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.sampled_from([ExplicitEuler, RungeKutta4, ImplicitMidpoint]), st.floats(0.01, 1.0), st.floats(-0.6, 0.6))
def test_the_finer_run_is_finer_within_the_first_step_too(method, step, share) -> None:
    """There both runs would be the same single step, and show no error, if the finer one only had the finer grid."""
    system, times = oscillator(), np.array([share * step])
    run = method(step).integrate(system, times)
    stated = estimated(method(step), system, times, run, Budget(), 0).errors.largest
    assert measured(run.states, system.exact.sample(times), times, 1.0).largest <= stated + system.exact.bound


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
    system = explosion() if method in (ExplicitEuler, RungeKutta4, ImplicitMidpoint) else oscillator(rate=100.0)
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

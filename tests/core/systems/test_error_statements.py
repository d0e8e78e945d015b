"""Statements of error: what they measure, and that they are never smaller than the truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import diagonal
from core.errors import BudgetExceeded, MechanicsError, NotApplicable
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.error_statements import Errors, drifts, estimated, known_norm, measured
from core.systems.methods import (
    ClosedFormEvaluation,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.solve import solve
from core.systems.state_motion import UNCONVERGED
from core.work_precision import work_precision
from tests.core.systems.systems import (
    elliptic_functions,
    kepler,
    oscillator,
    prey_and_predator,
    rigid_body,
    rigid_body_with_solution,
)
from tests.drawn import draws

TIMES = np.array([0.0, 1.0, 2.0])


@pytest.mark.parametrize("unit", [1.0, 2.0**-1000, 2.0**1000])
@pytest.mark.parametrize("norm", [5.0, 10.0, 500.0])
def test_errors_are_relative_to_the_norm_of_the_whole_motion_whatever_the_unit(unit: float, norm: float) -> None:
    reference = np.array([[3.0, 4.0], [0.0, 1.0], [0.5, 0.0]]) * unit
    states = reference + np.array([[0.0, 0.0], [0.3, 0.4], [0.0, 0.1]]) * unit
    errors = measured(states, reference, np.array([0.0, 1.0, -2.0]), norm * unit)
    assert errors.largest == pytest.approx(0.5 / norm, rel=1e-14)
    assert errors.final == pytest.approx(0.1 / norm, rel=1e-14)
    # Components are relative to what their own samples reach.
    assert errors.components == pytest.approx((0.1, 0.1), rel=1e-14)


def test_rest_has_no_scale_of_its_own() -> None:
    rest = np.zeros((3, 2))
    assert measured(rest, rest, TIMES, 0.0) == (0.0, 0.0, (0.0, 0.0))
    wrong = rest.copy()
    wrong[1, 0] = 1e-200
    errors = measured(wrong, rest, TIMES, 0.0)
    assert errors.largest == pytest.approx(1.0)
    assert errors.components == (1.0, 0.0)


def test_a_component_that_stays_zero_is_measured_against_the_motion() -> None:
    reference = np.array([[2.0, 0.0], [2.0, 0.0]])
    assert measured(reference + np.array([0.0, 0.02]), reference, TIMES[:2], 2.0).components == pytest.approx(
        (0.0, 0.01)
    )


def test_drift_is_not_error() -> None:
    # Near its middle axis the phase of the body is wrong altogether while energy and momentum stay.
    system = rigid_body((1, 2, 3), (1e-8, 1, 1.001e-8))
    times = np.linspace(0, 100, 1000)
    one = DormandPrince853(1e-13).integrate(system, times).states
    other = DormandPrince853(1e-14).integrate(system, times).states
    assert all(drift < 1e-12 for drift in drifts(system, one).values())
    assert measured(one, other, times, 1.0).largest > 0.1


def test_drifts_of_quantities_at_the_end_of_the_double_range() -> None:
    system = rigid_body((1, 2, 3), (1e-100, 2e-100, 1e-100))
    states = system.initial_state * np.array([[1.0], [1.5]])
    assert drifts(system, states) == pytest.approx({"energy": 1.25, "momentum": 0.5})
    with np.errstate(over="ignore", invalid="ignore"):
        huge = rigid_body((1, 2, 3), (1e200, 2e200, 1e200))
        assert drifts(huge, np.array([[1e200, 2e200, 1e200]])) == {}


SYSTEMS = {
    "oscillator": (oscillator(rate=1.3), 20.0),
    "elliptic functions": (elliptic_functions(), 20.0),
    "rigid body": (rigid_body_with_solution(), 30.0),
    "kepler": (kepler(0.3), 20.0),
    "eccentric kepler": (kepler(0.8), 15.0),
}
METHODS = [
    *(ExplicitEuler(step) for step in (3e-1, 1e-1, 1e-2, 1e-3)),
    *(RungeKutta4(step) for step in (6e-1, 2e-1, 5e-2, 1e-2, 1e-3)),
    *(ImplicitMidpoint(step) for step in (3e-1, 1e-1, 1e-2, 1e-3)),
    *(SymmetricSplitting(step) for step in (6e-1, 1e-1, 1e-2, 1e-3)),
    *(DormandPrince853(tolerance) for tolerance in (1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-14, 1e-15)),
    *(Lsoda(tolerance) for tolerance in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 2.3e-14)),
    *(Radau(tolerance) for tolerance in (1e-2, 1e-4, 1e-6, 1e-8)),
]


@pytest.mark.parametrize("name", SYSTEMS)
def test_what_a_finer_run_states_is_never_below_the_truth(name: str) -> None:
    system, horizon = SYSTEMS[name]
    times = np.linspace(0, horizon, 101)
    reference = system.exact.sample(times)
    ratios = []
    for method in METHODS:
        try:
            run = method.integrate(system, times)
        except MechanicsError:
            continue  # A method that fails states nothing.
        stated = estimated(method, system, times, run, Budget(), 0).errors
        true = measured(run.states, reference, times, known_norm(reference, system.initial_state))
        if stated.largest > UNCONVERGED:
            continue  # `solve` takes another judge then; see there.
        own = system.exact.bound
        assert stated.largest + own >= true.largest, (method, stated.largest, true.largest)
        assert all(s + own >= t for s, t in zip(stated.components, true.components, strict=True)), method
        assert stated.final + own >= true.final, method
        ratios.append((stated.largest + own) / max(true.largest, own))
    assert len(ratios) > 15
    assert np.median(ratios) < 10


def test_the_comparison_is_charged_to_the_budget() -> None:
    system, times = prey_and_predator(), np.array([1.0])
    method = ExplicitEuler(1e-3)
    run = method.integrate(system, times)
    with pytest.raises(BudgetExceeded) as refused:
        estimated(method, system, times, run, Budget(evaluations=2999), 1000)
    assert (refused.value.needed, refused.value.limit) == (3000, 2999)
    estimate = estimated(method, system, times, run, Budget(evaluations=3000), 1000)
    assert (estimate.integration.states == ExplicitEuler(5e-4).integrate(system, times).states).all()


def test_the_finer_run_is_finer_where_samples_lie_closer_than_the_step() -> None:
    system, times = elliptic_functions(), np.linspace(0, 0.4, 101)
    run = RungeKutta4(1.0).integrate(system, times)
    assert (run.work.steps, run.work.evaluations) == (0, 400)
    estimate = estimated(RungeKutta4(1.0), system, times, run, Budget(), 0)
    assert estimate.integration.work.evaluations == 800
    assert estimate.errors.largest > measured(run.states, system.exact.sample(times), times, 1.0).largest


def test_a_method_without_a_setting_cannot_be_compared_with_itself() -> None:
    system = oscillator()
    run = ClosedFormEvaluation().integrate(system, TIMES)
    with pytest.raises(NotApplicable):
        estimated(ClosedFormEvaluation(), system, TIMES, run, Budget(), 0)


def test_states_whose_error_has_no_square_in_range_have_an_error_all_the_same() -> None:
    reference, times = np.array([[3.0, 4.0, 0.0]]), np.array([1.0])
    for size in (1e150, 1e200, 1e300):
        found = measured(np.array([[3.0, 4.0 - 5 * size, 0.0]]), reference, times, 5.0)
        assert found.largest == found.final == pytest.approx(size, rel=1e-15)
        assert found.components[1] == pytest.approx(1.25 * size, rel=1e-15)
        assert found.components[2] == 0.0
    with pytest.raises(NotApplicable) as refused:
        measured(np.array([[1e300, 0.0, 0.0]]), 1e-300 * reference, times, 5e-300)
    assert refused.value.path == ("kind",)


def test_a_component_too_small_to_measure_by_is_measured_by_the_whole() -> None:
    found = measured(np.array([[1.0, 1.0]]), np.array([[2.0, 5e-324]]), np.array([1.0]), 2.0)
    assert found.components == (0.5, 0.5)


def test_an_error_against_a_reference_covers_what_that_leaves_open() -> None:
    found = Errors(1e9, 0.0, (1.0,)).beyond(1e-15)
    assert found.largest > 1e9 * (1 + 1e-15)
    assert (found.final, found.components[0] > 1.0 + 1e-15) == (1e-15, True)


@pytest.mark.parametrize("unit", [1.0, 2.0**-1060, 2.0**1020])
def test_the_norm_that_is_known_is_the_largest_of_start_and_samples(unit: float) -> None:
    start = np.array([3.0, 4.0]) * unit
    assert known_norm(np.array([[0.0, 1.0], [1.0, 0.0]]) * unit, start) == 5.0 * unit
    assert known_norm(np.array([[0.0, 8.0], [1.0, 0.0]]) * unit, start) == 8.0 * unit
    assert known_norm(np.zeros((2, 2)), 0.0 * start) == 0.0


def test_a_norm_beyond_the_doubles_is_infinite_and_errors_are_relative_to_the_largest_double() -> None:
    huge = np.array([1.5e308, 1.5e308])
    assert known_norm(huge[None, :], huge) == np.inf
    found = measured(huge[None, :] / 2, huge[None, :], np.array([1.0]), np.inf)
    # By no more than the root of two, which is what the norm of a double pair exceeds the largest double by.
    assert 0.5 <= found.largest <= 0.5 * 2**0.5 * 1.5e308 / np.finfo(float).max * (1 + 1e-15)


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(
    st.tuples(*3 * [st.floats(0.3, 3.0)]),
    st.tuples(*3 * [st.floats(-2.0, 2.0)]).filter(lambda w: max(map(abs, w)) > 0.1),
    st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=4),
    st.sampled_from([ExplicitEuler(0.01), RungeKutta4(0.05), ImplicitMidpoint(0.05), DormandPrince853(1e-6)]),
)
def test_closed_form_methods_and_work_precision_divide_by_the_same_norm(moments, spin, times, method) -> None:
    """By that of the whole motion, whichever times are asked for: the error of a sample is the same among others."""
    system, instants = TorqueFree(diagonal(moments), np.array(spin)), np.array(times)
    norm = system.closed_form().largest_norm
    found, reference = solve(system, instants, method=method), solve(system, instants)
    assert found.accuracy.largest_norm == reference.accuracy.largest_norm == norm
    (curve,) = work_precision(system, instants, [method]).curves
    assert curve.measurements[0].error == found.accuracy.error
    true = np.linalg.norm(found.state - reference.state, axis=1).max() / norm
    assert true <= found.accuracy.error <= true * (1 + 1e-14) + reference.accuracy.error + 1e-15
    # The norm of the whole motion is met by no sample, and is that of some time.
    period = system.closed_form().period
    if period is not None and period < 1e6:
        dense = np.linalg.norm(system.closed_form().sample(np.linspace(0.0, period, 4001)), axis=1).max()
        assert dense <= norm * (1 + 1e-14)
        assert dense >= norm * (1 - 1e-4)


@pytest.mark.parametrize("far", [1e300, 1e307, 1.7e308])
def test_no_stated_error_leaves_the_range_of_doubles(far: float) -> None:
    """Errors next to the largest double, to which the reference's own is added."""
    component = measured(np.array([[1.0, 0.5]]), np.array([[1.0, 1.0 / far]]), TIMES[:1], 1.0).beyond(2.0)
    assert np.isfinite([component.largest, *component.components]).all()
    assert component.components[1] >= 0.5
    try:
        whole = measured(np.array([[far]]), np.array([[1.0]]), TIMES[:1], 1.0).beyond(2.0)
    except NotApplicable:
        assert far > 1e307
    else:
        assert np.isfinite(whole.largest)

"""Work and precision: measured orders, floors, fronts, and a recommendation that holds."""

from __future__ import annotations

from dataclasses import replace
from itertools import count

import numpy as np
import pytest

from core.errors import AccuracyUnreachable, InvalidParameter, NotApplicable
from core.multibody.motion.modelling import system_of
from core.systems.accuracy import run_to_accuracy
from core.systems.budget import Budget
from core.systems.error_statements import known_norm, measured
from core.systems.methods import (
    ClosedFormEvaluation,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    RungeKutta4,
    SymmetricSplitting,
)
from core.work_precision import Measurement, pareto_front, work_precision
from tests.core.multibody.motion.test_generic_equation import PENDULUM, PROJECTILE
from tests.core.multibody.worked_examples import read
from tests.core.systems.systems import elliptic_functions, explosion, lorenz, prey_and_predator, stiff

TIMES = np.linspace(0, 10, 11)


@pytest.fixture(scope="module")
def whole():
    return work_precision(elliptic_functions(), TIMES)


def test_every_method_has_a_curve_with_its_declared_order(whole) -> None:
    curves = {curve.kind: curve for curve in whole.curves}
    assert set(curves) == {
        *("closed-form", "explicit-euler", "runge-kutta-4", "implicit-midpoint", "symmetric-splitting"),
        *("discrete-moser-veselov", "dormand-prince-853", "lsoda", "radau"),
    }
    for kind in ("explicit-euler", "runge-kutta-4", "implicit-midpoint", "symmetric-splitting"):
        assert curves[kind].fitted_order == pytest.approx(curves[kind].declared_order, abs=0.25)
    assert 6.5 < curves["dormand-prince-853"].fitted_order < 9.5
    assert curves["closed-form"].fitted_order is None
    assert curves["explicit-euler"].floor is None


def test_errors_are_those_that_the_question_has(whole) -> None:
    reference = elliptic_functions().exact
    for curve in whole.curves:
        for one in curve.measurements:
            assert one.failure is None
            run = one.method.integrate(elliptic_functions(), TIMES)
            true = measured(run.states, reference.sample(TIMES), TIMES, reference.largest_norm)
            # Never below what the reference leaves open, and above it only by rounding.
            assert true.largest + reference.bound <= one.error <= (true.largest + reference.bound) * (1 + 1e-14)
            assert true.final + reference.bound <= one.final_error <= (true.final + reference.bound) * (1 + 1e-14)
            assert one.evaluations == run.work.evaluations
            assert len(one.component_errors) == 3
            assert one.seconds is None


def test_the_floor_is_found_where_more_work_brings_nothing() -> None:
    steps = [0.1 / 2**k for k in range(11)]
    found = work_precision(elliptic_functions(), TIMES, [RungeKutta4(step) for step in steps])
    (curve,) = found.curves
    assert curve.floor is not None
    assert 1e-15 < curve.floor < 1e-13
    assert curve.fitted_order == pytest.approx(4, abs=0.1)


def test_an_error_that_still_falls_unevenly_is_no_floor() -> None:
    # At coarse steps halving takes away less than half of the error, which is no round-off yet.
    (curve,) = work_precision(stiff(1.0), [1.0], [ExplicitEuler(1 / 3), ExplicitEuler(0.2)]).curves
    coarse, fine = (one.error for one in curve.measurements)
    assert 0.55 * coarse < fine < 0.6 * coarse
    assert curve.floor is None


def test_nothing_beats_a_member_of_the_front_and_everything_else_is_beaten(whole) -> None:
    front = whole.pareto_front
    assert [one.method.kind for one in front] == ["closed-form"]
    integrators = [one for curve in whole.curves for one in curve.measurements if curve.kind != "closed-form"]
    front = pareto_front(integrators)
    assert len(front) > 5
    for one in integrators:
        beaten = any(
            other.evaluations <= one.evaluations
            and other.error <= one.error
            and (other.evaluations < one.evaluations or other.error < one.error)
            for other in integrators
        )
        assert beaten != any(one is member for member in front)


def test_failures_are_listed_and_beat_nobody() -> None:
    methods = [ExplicitEuler(1e-9), ImplicitMidpoint(50.0), DormandPrince853(1e-9)]
    found = work_precision(elliptic_functions(), [0.0, 100.0], methods, budget=Budget(evaluations=100_000))
    failed = {curve.kind: curve.measurements[0] for curve in found.curves if curve.measurements[0].failure}
    assert "100000 are allowed" in failed["explicit-euler"].failure
    assert "iterated" in failed["implicit-midpoint"].failure
    assert found.pareto_front == (found.curves[0].measurements[0],)
    assert found.recommendation.method is None


@pytest.mark.parametrize("accuracy", [1e-2, 1e-5, 1e-8, 1e-11])
def test_the_recommendation_reaches_the_accuracy_when_it_is_followed(accuracy: float) -> None:
    system = prey_and_predator()
    method = work_precision(system, TIMES, accuracy=accuracy).recommendation.method
    assert method is not None
    reference = run_to_accuracy(system, TIMES, 1e-12, Budget()).states
    norm = known_norm(reference, system.initial_state)
    assert measured(method.integrate(system, TIMES).states, reference, TIMES, norm).largest <= accuracy


def test_an_accuracy_that_nothing_reached_is_reported_with_the_best() -> None:
    found = work_precision(elliptic_functions(), TIMES, [ExplicitEuler(0.01)], accuracy=1e-9)
    assert found.recommendation.method is None
    assert "the smallest error was 0.0" in found.recommendation.reason


def test_without_a_closed_form_the_reference_is_an_integrator_whose_error_is_added() -> None:
    problem = elliptic_functions()
    found = work_precision(replace(problem, exact=None), TIMES, [RungeKutta4(0.05), DormandPrince853(1e-15)])
    assert found.reference == "dormand-prince-853"
    assert 1e-15 < found.reference_error < 1e-12
    for curve in found.curves:
        for one in curve.measurements:
            true = measured(
                one.method.integrate(problem, TIMES).states,
                problem.exact.sample(TIMES),
                TIMES,
                problem.exact.largest_norm,
            ).largest
            assert true <= one.error + problem.exact.bound


def test_times_are_medians_and_rule_the_recommendation() -> None:
    ticks = count(0.0, 1.0)
    methods = [RungeKutta4(0.01), SymmetricSplitting(0.01)]
    found = work_precision(elliptic_functions(), TIMES, methods, repeats=3, accuracy=0.1, clock=lambda: next(ticks))
    assert [one.seconds for curve in found.curves for one in curve.measurements] == [1.0, 1.0]
    assert "median time" in found.recommendation.reason


def test_the_same_question_has_the_same_answer(whole) -> None:
    assert work_precision(elliptic_functions(), TIMES) == whole


def test_a_method_is_refused_that_is_there_already_with_the_same_settings() -> None:
    methods = [RungeKutta4(0.01), RungeKutta4(0.02), SymmetricSplitting(0.01), RungeKutta4(0.01)]
    with pytest.raises(InvalidParameter) as caught:
        work_precision(elliptic_functions(), TIMES, methods)
    assert caught.value.path == ("methods", 3)
    assert "differ from methods/0" in caught.value.rule
    assert "repeats" in str(caught.value.remedy)
    assert len(work_precision(elliptic_functions(), TIMES, methods[:3]).curves) == 2


def test_questions_that_cannot_be_answered() -> None:
    with pytest.raises(InvalidParameter, match="methods must"):
        work_precision(elliptic_functions(), TIMES, [])
    with pytest.raises(InvalidParameter, match="times must"):
        work_precision(elliptic_functions(), [])
    with pytest.raises(AccuracyUnreachable, match="no reference"):
        work_precision(lorenz(), [60.0], [ExplicitEuler(0.01)])
    with pytest.raises(InvalidParameter, match="at t = 1 s"):
        work_precision(explosion(), [2.0], [ExplicitEuler(0.01)])


def test_equal_points_are_one_on_the_front() -> None:
    one = Measurement(ClosedFormEvaluation(), error=1e-15)
    assert pareto_front([one, replace(one), Measurement(ExplicitEuler(1.0), error=0.1, evaluations=9)]) == (one,)


def test_a_described_scene_is_measured_against_pairs_with_the_orders_of_the_methods() -> None:
    """The pendulum's rod is a constraint: after projection every method has its order."""
    system = system_of(read(PENDULUM))
    found = work_precision(system, [0.5, 2.0])
    assert found.reference == "pairs of doubles"
    assert found.reference_error < 1e-14
    orders = {curve.kind: curve.fitted_order for curve in found.curves}
    for kind, order in (("explicit-euler", 1), ("implicit-midpoint", 2), ("runge-kutta-4", 4)):
        assert orders[kind] == pytest.approx(order, abs=0.35)
    assert {*orders} == {
        *("explicit-euler", "implicit-midpoint", "runge-kutta-4"),
        *("dormand-prince-853", "lsoda", "radau"),
    }
    assert found.recommendation.method is not None
    assert found.pareto_front[-1].error < 1e-12


def test_a_scene_in_closed_form_is_measured_against_that() -> None:
    found = work_precision(system_of(read(PROJECTILE)), [1.0], [ExplicitEuler(0.125), RungeKutta4(0.125)])
    assert found.reference == "closed form"
    euler, kutta = (curve.measurements[0] for curve in found.curves)
    assert euler.error is not None
    assert kutta.error is not None
    assert kutta.error < 1e-15 < 1e-2 < euler.error


def test_a_scene_at_rest_has_nothing_to_compare() -> None:
    hanging = {"bodies": {"bob": {"mass": 1, "at": [0, -1]}}}
    with pytest.raises(NotApplicable):
        system_of(read(hanging))

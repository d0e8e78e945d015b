"""`solve`: which model and method, how the error is stated, what is refused and how it is named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, MechanicsError, NotApplicable
from core.systems.budget import Budget
from core.systems.error_statements import known_norm, measured
from core.systems.methods import (
    ClosedFormEvaluation,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.solve import solve
from tests.core.systems.systems import (
    Exact,
    elliptic_functions,
    explosion,
    kepler,
    lorenz,
    oscillator,
    prey_and_predator,
    rigid_body,
)

TIMES = np.linspace(0, 10, 101)


@pytest.mark.parametrize("method", [None, ClosedFormEvaluation()])
def test_a_closed_form_is_evaluated_where_there_is_one(method: ClosedFormEvaluation | None) -> None:
    system = oscillator()
    trajectory = solve(system, TIMES, method=method)
    assert trajectory.method == "closed-form"
    assert (trajectory.state == system.exact.sample(TIMES)).all()
    assert trajectory.accuracy.how == "closed form"
    assert trajectory.accuracy.error == system.exact.bound
    assert trajectory.accuracy.inherited == pytest.approx(11 * 2**-53)
    assert trajectory.accuracy.drifts["energy"] < 1e-15
    assert trajectory.period == pytest.approx(2 * np.pi)
    assert trajectory.work.evaluations == 0
    assert trajectory.warnings == ()
    assert trajectory.ended == "horizon"


def test_a_named_method_is_measured_against_the_closed_form_whose_own_bound_is_added() -> None:
    system = replace(elliptic_functions(), exact=Exact(elliptic_functions().exact.solution, bound=1e-3))
    trajectory = solve(system, TIMES, method=DormandPrince853(1e-12), accuracy=1e-2)
    assert trajectory.accuracy.how == "measured against closed form"
    assert 1e-3 < trajectory.accuracy.error < 1.001e-3
    assert trajectory.method == "dormand-prince-853"
    assert trajectory.work.evaluations > 0
    assert trajectory.work.evaluations_for_error == 0


def test_a_named_method_that_misses_the_accuracy_is_answered_with_a_warning() -> None:
    trajectory = solve(oscillator(), TIMES, method=ExplicitEuler(1e-2), accuracy=1e-9)
    assert trajectory.accuracy.error > 0.01
    (notice,) = trajectory.warnings
    assert notice.code == "accuracy-not-reached"
    assert notice.path == ("method",)
    assert "explicit-euler" in notice.detail
    assert solve(oscillator(), TIMES, method=ExplicitEuler(1e-2), accuracy=0.5).warnings == ()


def test_without_a_closed_form_a_named_method_is_compared_with_a_finer_run() -> None:
    system = elliptic_functions(exact=False)
    reference = elliptic_functions().exact.sample(TIMES)
    for method in (ExplicitEuler(1e-3), SymmetricSplitting(1e-2), DormandPrince853(1e-8), Lsoda(1e-8)):
        trajectory = solve(system, TIMES, method=method)
        true = measured(trajectory.state, reference, TIMES, known_norm(reference, system.initial_state))
        assert trajectory.accuracy.how == "estimate (finer run)"
        assert true.largest <= trajectory.accuracy.error <= 10 * true.largest
        assert true.final <= trajectory.accuracy.final_error
        assert trajectory.accuracy.inherited is None
        assert trajectory.work.evaluations_for_error > trajectory.work.evaluations


@pytest.mark.parametrize("step", [0.6, 0.3, 0.2, 0.1, 0.05])
@pytest.mark.parametrize("method", [ExplicitEuler, RungeKutta4, ImplicitMidpoint])
@pytest.mark.parametrize("eccentricity", [0.3, 0.8])
def test_a_run_that_has_not_converged_is_judged_by_one_that_has(method, step: float, eccentricity: float) -> None:
    problem = kepler(eccentricity)
    system, times = replace(problem, exact=None), np.linspace(0, 15, 31)
    try:
        trajectory = solve(system, times, method=method(step))
    except InvalidParameter:
        return  # The iteration does not converge at the perihelion.
    true = measured(trajectory.state, problem.exact.sample(times), times, problem.exact.largest_norm)
    assert true.largest <= trajectory.accuracy.error
    assert true.final <= trajectory.accuracy.final_error
    assert {notice.code for notice in trajectory.warnings} <= {"accuracy-not-reached"}


def test_where_nothing_converges_the_statement_says_that_it_is_uncertain() -> None:
    trajectory = solve(lorenz(), np.linspace(0, 60, 601), method=RungeKutta4(0.01))
    assert trajectory.accuracy.error > 0.5
    assert [notice.code for notice in trajectory.warnings] == ["accuracy-not-reached", "error-uncertain"]


def test_a_closed_form_whose_bound_exceeds_the_accuracy_is_refused() -> None:
    system = replace(oscillator(), exact=Exact(oscillator().exact.solution, bound=1e-7))
    with pytest.raises(AccuracyUnreachable) as refused:
        solve(system, TIMES, accuracy=1e-9)
    assert refused.value.achievable == 1e-7
    assert solve(system, TIMES, accuracy=1e-6).accuracy.error == 1e-7


def test_a_closed_form_out_of_reach_leaves_the_finer_run() -> None:
    class OutOfReach(Exact):
        def error(self, times):
            raise AccuracyUnreachable(0.0, 1.0, "the phase is lost")

    system = replace(oscillator(), exact=OutOfReach(oscillator().exact.solution))
    with pytest.raises(AccuracyUnreachable):
        solve(system, TIMES)
    assert solve(system, TIMES, method=DormandPrince853(1e-10)).accuracy.how == "estimate (finer run)"


def test_samples_beyond_the_double_range_are_refused_not_handed_on() -> None:
    system = replace(oscillator(), exact=Exact(lambda t: np.full((t.size, 2), np.nan)))
    with pytest.raises(NotApplicable, match="double precision"):
        solve(system, TIMES)


@pytest.mark.parametrize(
    ("fault", "path"),
    [
        (lambda: solve(oscillator(), []), ("times",)),
        (lambda: solve(oscillator(), [[1.0]]), ("times",)),
        (lambda: solve(oscillator(), [0.0, np.nan, 1.0]), ("times", 1)),
        (lambda: solve(oscillator(), [0.0, 1.0, -np.inf]), ("times", 2)),
        (lambda: solve(oscillator(), TIMES, accuracy=0.0), ("accuracy",)),
        (lambda: solve(oscillator(), TIMES, accuracy=1.0), ("accuracy",)),
        (lambda: solve(oscillator(), TIMES, accuracy=float("nan")), ("accuracy",)),
        (lambda: solve(oscillator(), TIMES, input_uncertainty=-1.0), ("input_uncertainty",)),
        (lambda: solve(oscillator(), TIMES, budget=Budget(samples=100)), ("times",)),
        (lambda: solve(explosion(), [2.0], method=ExplicitEuler(0.1)), ("method", "step")),
        (lambda: solve(explosion(), [2.0], method=DormandPrince853(1e-6)), ("method", "tolerance")),
        (lambda: solve(prey_and_predator(), [2.0], method=ClosedFormEvaluation()), ("method", "kind")),
        (lambda: solve(prey_and_predator(), [2.0], method=SymmetricSplitting(0.1)), ("method", "kind")),
        (lambda: solve(oscillator(), [1e9], method=ExplicitEuler(0.1)), ("method", "step")),
        (lambda: solve(prey_and_predator(), [2.0]), ("method", "kind")),
        (lambda: Budget(evaluations=0), ("evaluations",)),
    ],
)
def test_every_refusal_names_the_place_in_the_question(fault, path) -> None:
    with pytest.raises(MechanicsError) as refused:
        fault()
    assert refused.value.path == path


def test_a_finer_run_over_the_budget_is_refused_with_the_whole_need() -> None:
    with pytest.raises(BudgetExceeded) as refused:
        solve(prey_and_predator(), [10.0], method=ExplicitEuler(0.01), budget=Budget(evaluations=2999))
    assert refused.value.needed == 3000
    assert refused.value.limit == 2999
    allowed = solve(prey_and_predator(), [10.0], method=ExplicitEuler(0.01), budget=Budget(evaluations=3000))
    assert allowed.work.evaluations + allowed.work.evaluations_for_error == 3000


def test_the_order_of_the_times_is_preserved() -> None:
    times = np.array([3.0, -1.0, 0.0, 3.0, 0.5, -2.0])
    for method in (None, DormandPrince853(1e-10), ExplicitEuler(1e-4)):
        trajectory = solve(oscillator(), times, method=method)
        assert (trajectory.time == times).all()
        assert trajectory.state[:, 0] == pytest.approx(np.cos(times), abs=1e-3)
        assert (trajectory.state[0] == trajectory.state[3]).all()


def test_invalid_settings_name_the_setting() -> None:
    with pytest.raises(InvalidParameter) as refused:
        ExplicitEuler(-1.0)
    assert refused.value.path == ("step",)


def test_near_the_separatrix_the_statement_owns_up() -> None:
    # Every integrator is wrong by the whole motion after the second flip, whatever its tolerance.
    system = rigid_body((1, 2, 3), (1e-8, 1, 1.001e-8))
    trajectory = solve(system, np.linspace(0, 100, 1001), method=DormandPrince853(1e-12))
    assert trajectory.accuracy.error > 0.1
    assert max(trajectory.accuracy.drifts.values()) < 1e-10


@pytest.mark.parametrize("samples", [2, 6, 101])
def test_a_named_step_is_the_step_that_is_run_and_the_work_says_so(samples: int) -> None:
    system, times = oscillator(), np.linspace(0, 1, samples)
    found = solve(system, times, method=RungeKutta4(0.1))
    assert (found.work.step, found.work.steps) == (0.1, 10)
    assert (found.state[-1] == solve(system, [1.0], method=RungeKutta4(0.1)).state[0]).all()
    assert solve(system, times, method=DormandPrince853(1e-8)).work.step is None
    assert solve(system, times).work.step is None

"""From an accuracy to a method: the record as it is read, and what is chosen from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import AccuracyUnreachable, BudgetExceeded
from core.systems.accuracy import CANDIDATES, integrator, record, run_to_accuracy
from core.systems.budget import Budget
from core.systems.error_statements import measured
from tests.core.systems.systems import Given, bell, elliptic_functions, kepler, lorenz, oscillator

ACCURACIES = [10.0**-n for n in range(1, 16)]


def test_the_record_is_read_cheapest_first_and_knows_its_methods() -> None:
    entries = record()
    assert [e.microseconds for e in entries] == sorted(e.microseconds for e in entries)
    assert {e.kind for e in entries} == set(CANDIDATES)
    for entry in entries:
        assert CANDIDATES[entry.kind](entry.tolerance).kind == entry.kind
        assert entry.error > 0
        assert entry.evaluations > 0


@pytest.mark.parametrize("accuracy", ACCURACIES)
def test_nothing_cheaper_in_the_record_reaches_the_accuracy(accuracy: float) -> None:
    chosen = integrator(accuracy)
    reach = [e for e in record() if e.error <= accuracy]
    mine = next(e for e in record() if (e.kind, e.tolerance) == (chosen.kind, chosen.tolerance))
    if reach:
        assert mine.error <= accuracy
        assert mine.microseconds == min(e.microseconds for e in reach)
    else:
        assert mine.error == min(e.error for e in record())


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-12])
def test_what_is_answered_reaches_the_accuracy_in_truth(accuracy: float) -> None:
    system, times = elliptic_functions(), np.linspace(0.0, 20.0, 41)
    run = run_to_accuracy(elliptic_functions(exact=False), times, accuracy, Budget())
    true = np.linalg.norm(run.states - system.exact.sample(times), axis=1).max()
    largest = np.linalg.norm(run.states, axis=1).max()
    # The solution itself is known to a few 1e-14 (scipy's ellipj).
    assert true / largest <= run.errors.largest + 5e-14
    assert run.errors.largest <= accuracy
    assert run.work.evaluations_for_error > 0


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-9, 1e-11, 1e-12])
@pytest.mark.parametrize("problem", [elliptic_functions(), kepler(0.5), bell()], ids=["elliptic", "kepler", "bell"])
def test_no_more_than_the_accuracy_is_paid_for(problem: Given, accuracy: float) -> None:
    times = np.linspace(-2, 2, 41) if len(problem.initial_state) == 1 else np.linspace(0, 10, 101)
    assert problem.exact is not None
    system = replace(problem, exact=None)
    run = run_to_accuracy(system, times, accuracy, Budget())
    true = measured(run.states, problem.exact.sample(times), times, problem.exact.largest_norm).largest
    assert true <= run.errors.largest + problem.exact.bound
    # More than a thousandfold better than the accuracy would be waste.
    assert accuracy / 1e4 < run.errors.largest <= accuracy


def test_chaos_is_refused_beyond_its_horizon_with_what_is_achievable() -> None:
    assert run_to_accuracy(lorenz(), np.linspace(0, 5, 51), 1e-6, Budget()).errors.largest < 1e-6
    with pytest.raises(AccuracyUnreachable) as refused:
        run_to_accuracy(lorenz(), np.linspace(0, 60, 61), 1e-6, Budget())
    assert refused.value.requested == 1e-6
    assert refused.value.achievable > 0.01


def test_what_cannot_be_reached_says_how_far_it_came() -> None:
    with pytest.raises(AccuracyUnreachable) as refused:
        run_to_accuracy(elliptic_functions(exact=False), np.linspace(0.0, 200.0, 5), 1e-17, Budget())
    assert 1e-17 < refused.value.achievable < 1e-9


def test_a_budget_is_not_exceeded_by_refining() -> None:
    with pytest.raises(BudgetExceeded):
        run_to_accuracy(elliptic_functions(exact=False), np.linspace(0.0, 200.0, 5), 1e-9, Budget(evaluations=3000))
    with pytest.raises(BudgetExceeded):
        run_to_accuracy(oscillator(exact=False), np.array([1.0]), 1e-9, Budget(evaluations=1000), spent=999)

"""Samples made by integrators that are written out here are found with their step, and nothing else is."""

from __future__ import annotations

from collections import Counter
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.assessment.method_search import MethodSearch
from core.assessment.sample_findings import Consistent
from core.rotation.torque_free import TorqueFree
from tests.core.assessment.student_integrators import FIXED, SOLVERS, Rows, euler, gyration, marched, motion, submitted
from tests.drawn import ALL


def found_in(system: TorqueFree, times: Rows, rows: Rows) -> Consistent | None:
    return MethodSearch(system, times, system.closed_form().sample(times)).consistent(rows)


def outcome(kind: str, digits: int | None, seed: int) -> str:
    """Return right, wrong, exact (the error is that of the digits), hidden (hardly more than that), or none."""
    case = submitted(kind, digits, seed)
    right = case.system.closed_form().sample(case.times)
    search = MethodSearch(case.system, case.times, right)
    found = search.consistent(case.rows)
    error, digit = np.linalg.norm(case.rows - right, axis=1).max(), 0.0 if digits is None else 10.0**-digits
    if found is None:
        return "none" if error > 30.0 * digit else "hidden"
    if found.method == "exact":
        assert error <= digit + 1e-11
        return "exact"
    near = found.step is not None and abs(found.step / case.setting - 1.0) < 1e-3 + 3.0 * digit / error
    return "right" if found.method == kind and (near or found.tolerance == case.setting) else "wrong"


@pytest.mark.parametrize("kind", [*FIXED, *SOLVERS])
def test_methods_are_found_with_their_setting_and_none_falsely(kind: str) -> None:
    full_seeds, rounded_seeds = (6, 4) if ALL else (2, 1)
    full = Counter(outcome(kind, None, seed) for seed in range(full_seeds))
    assert full["right"] >= full_seeds - (kind not in FIXED)
    assert not full["wrong"]
    rounded = Counter(outcome(kind, digits, seed) for digits in (6, 5, 4) for seed in range(rounded_seeds))
    assert not rounded["wrong"]
    # What shows in the digits is found.
    assert rounded["right"] >= rounded["none"]


def test_a_step_that_does_not_divide_the_spacing_is_found_in_interpolated_samples() -> None:
    moments, start, system = motion(Random(1))
    grid = np.arange(2001) * 0.007
    states = marched(euler, gyration(moments), start, 0.007, grid)
    times = np.arange(100) * 0.1
    rows = np.array([np.interp(times, grid, states[:, k]) for k in range(3)]).T
    found = found_in(system, times, rows)
    assert found is not None
    assert (found.method, found.step) == ("explicit-euler", pytest.approx(0.007))


@settings(max_examples=10)
@given(seed=st.integers(0, 10**9))
def test_other_errors_are_taken_for_no_method(seed: int) -> None:
    chance = Random(seed)
    _, _, system = motion(chance)
    times = np.arange(100) * 0.1
    right = system.closed_form().sample(times)
    noisy = right + np.random.default_rng(seed).normal(0.0, 1e-3, right.shape)
    late = right.copy()
    late[50:] += 0.1
    search = MethodSearch(system, times, right)
    for rows in (noisy, late, right[:, [1, 0, 2]], np.zeros_like(right), 1e200 * right, 1e307 * right):
        assert search.consistent(rows) is None


def test_exact_samples_are_exact_to_their_digits() -> None:
    _, _, system = motion(Random(3))
    times = np.linspace(-3.0, 5.0, 50)
    right = system.closed_form().sample(times)
    for rows in (right, np.round(right, 3)):
        found = found_in(system, times, rows)
        assert found is not None
        assert (found.method, found.step, found.tolerance) == ("exact", None, None)


def test_solvers_are_run_within_a_budget_and_once_for_all_samples() -> None:
    case = submitted("RK45", None, 1)
    search = MethodSearch(case.system, case.times, case.system.closed_form().sample(case.times))
    first = search.consistent(case.rows)
    assert first is not None
    assert first.tolerance == case.setting
    assert search.consistent(case.rows) == first
    far = MethodSearch(case.system, 1e5 * case.times, case.system.closed_form().sample(1e5 * case.times))
    assert far.consistent(case.rows) is None

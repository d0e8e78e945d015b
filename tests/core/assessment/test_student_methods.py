"""The methods give what students' own loops give, on the grid and between its points, to both sides of the start."""

from __future__ import annotations

from random import Random
from typing import Any

import numpy as np
import pytest

from core.assessment.student_methods import ExplicitMidpoint, Heun, SemiImplicitEuler
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from tests.core.assessment.student_integrators import Step, explicit_midpoint, gyration, heun, in_turn, marched, motion

CASES: list[tuple[Any, Step]] = [(SemiImplicitEuler, in_turn), (ExplicitMidpoint, explicit_midpoint), (Heun, heun)]


@pytest.mark.parametrize(("method", "step"), CASES)
def test_they_are_the_loops_that_students_write(method: Any, step: Step) -> None:
    for seed in range(5):
        moments, start, system = motion(Random(seed))
        times = np.array([0.0, 0.05, 0.1, 0.13, 1.0, 2.02])
        found = method(0.05).integrate(system, times, Budget())
        np.testing.assert_allclose(
            found.states, marched(step, gyration(moments), start, 0.05, times), rtol=0, atol=1e-13
        )
        # Steps backwards are those of the reversed motion: w(-t) turned about.
        turned = TorqueFree(system.body, -start)
        back = method(0.05).integrate(system, -times, Budget()).states
        np.testing.assert_allclose(back, -method(0.05).integrate(turned, times, Budget()).states, rtol=0, atol=1e-13)


@pytest.mark.parametrize(("method", "step"), CASES)
def test_their_error_falls_with_their_order(method: Any, step: Step) -> None:
    _, _, system = motion(Random(3))
    times = np.array([2.0])
    right = system.closed_form().sample(times)
    coarse, fine = (np.abs(method(h).integrate(system, times, Budget()).states - right).max() for h in (2e-3, 1e-3))
    assert np.log2(coarse / fine) == pytest.approx(method.order, abs=0.1)


@pytest.mark.parametrize(("method", "step"), CASES)
def test_runs_that_leave_the_doubles_are_refused(method: Any, step: Step) -> None:
    _, _, system = motion(Random(4))
    with pytest.raises(MechanicsError):
        method(50.0).integrate(system, np.array([1e4]), Budget())

"""The implicit midpoint rule: its invariants, its iteration, its failures."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.systems.methods import ImplicitMidpoint
from tests.core.systems.systems import oscillator, rigid_body, stiff


def test_quadratic_invariants_are_conserved_to_round_off_over_many_steps() -> None:
    system = rigid_body((1, 2, 3), (0.1, 1, 0.1))
    run = ImplicitMidpoint(0.05).integrate(system, np.linspace(0, 5000, 101))
    assert run.work.steps == 100_000
    for values in system.invariants(run.states).values():
        assert np.abs(values / values[0] - 1).max() < 2e-14


def test_one_step_solves_the_equation_of_the_rule() -> None:
    # For x'' = -x the step is Cayley's transform of the matrix.
    h = 0.3
    step = np.array([[1 - h * h / 4, h], [-h, 1 - h * h / 4]]) / (1 + h * h / 4)
    states = ImplicitMidpoint(h).integrate(oscillator(), h * np.arange(1, 4.0)).states
    for n, state in enumerate(states, start=1):
        assert state == pytest.approx(np.linalg.matrix_power(step, n) @ [1, 0], abs=4e-16)


def test_a_step_that_cannot_be_iterated_is_refused_not_hidden() -> None:
    with pytest.raises(InvalidParameter, match="small enough that the implicit step can be iterated") as refused:
        ImplicitMidpoint(0.1).integrate(stiff(), np.array([1.0]))
    assert "radau" in (refused.value.remedy or "")
    ImplicitMidpoint(1e-4).integrate(stiff(), np.array([1.0]))

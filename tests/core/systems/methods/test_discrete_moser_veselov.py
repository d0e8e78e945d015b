"""The march of discrete mechanics: each of its steps is Moser and Veselov's, found by another route, and goes back.

Their equation X D - D X^T = h hat(M), X orthogonal, has the solution X D = S + (h/2) hat(M) with S symmetric and

    S^2 - (h/2) (hat(M) S - S hat(M)) = D^2 + (h^2/4) hat(M)^2,

an algebraic Riccati equation whose positive solution is that near the identity; then M' = X^T M (J. R. Cardoso,
F. Silva Leite, "The Moser-Veselov equation", Linear Algebra and its Applications 360 (2003) 237). It is solved by an
ordered Schur form, where core iterates on a quaternion.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import solve_continuous_are

from core.errors import InvalidParameter, NotApplicable
from core.systems.methods import DiscreteMoserVeselov
from tests.core.systems.systems import bell, elliptic_functions, oscillator, rigid_body

squares = st.tuples(*3 * [st.floats(0.2, 5.0)])
spins = st.tuples(*3 * [st.floats(-1.0, 1.0)]).filter(lambda w: max(map(abs, w)) > 0.05)


def step_by_riccati(second: np.ndarray, momentum: np.ndarray, h: float) -> np.ndarray:
    """Return the angular momentum after one step; `second` are the moments (tr I)/2 - I."""
    x, y, z = momentum
    hat = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    d = np.diag(second)
    s = solve_continuous_are(-0.5 * h * hat, np.eye(3), d @ d + 0.25 * h * h * hat @ hat, np.eye(3))
    turn = (s + 0.5 * h * hat) @ np.linalg.inv(d)
    assert np.abs(turn @ turn.T - np.eye(3)).max() < 1e-9
    return turn.T @ momentum


@settings(deadline=None, derandomize=True, max_examples=25)
@given(squares, spins, st.floats(0.02, 0.3))
def test_every_step_solves_the_riccati_equation(second, spin, h) -> None:
    second = np.array(second)
    moments = second.sum() - second
    # The solution near the identity is the positive one while the body turns by less than a right angle.
    assume(h * np.abs(moments * np.array(spin)).max() / moments.min() < 0.5)
    times = h * np.arange(1, 6)
    states = DiscreteMoserVeselov(h).integrate(rigid_body(tuple(moments), spin), times).states
    momentum = moments * np.array(spin)
    for state in states:
        momentum = step_by_riccati(second, momentum, h)
        # The Schur form carries 1e-15 of the squares of D over their smallest, and divides by D once more.
        few = 1e-14 * (second.max() / second.min()) ** 2
        assert np.abs(moments * state - momentum).max() <= few * np.abs(momentum).max()
        momentum = moments * state


@pytest.mark.parametrize("system", [rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7)), oscillator(), elliptic_functions()])
def test_it_goes_back_the_way_it_came(system) -> None:
    there = DiscreteMoserVeselov(0.05).integrate(system, np.array([4.0])).states[0]
    back = DiscreteMoserVeselov(0.05).integrate(replace(system, initial_state=there.copy()), np.array([-4.0])).states[0]
    # Eighty steps there and back, each rounded by a few 1e-16, on motions that do not diverge.
    assert np.abs(back - system.initial_state).max() <= 160 * 4 * 2.0**-53


def test_first_integrals_do_not_drift() -> None:
    """In a hundred thousand steps roundings of the state would walk 300 u away, those of increments 0.05 as large 16 u.

    Each increment rounds a few times, so that 90 u = 1e-14 covers them.
    """
    system = rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7))
    run = DiscreteMoserVeselov(0.05).integrate(system, np.linspace(0.0, 5000.0, 201))
    assert run.work.steps == 100_000
    for values in system.invariants(run.states).values():
        assert np.abs(values / values[0] - 1).max() <= 90 * 2.0**-53


def test_order_two() -> None:
    system = rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7))
    ends = [DiscreteMoserVeselov(h).integrate(system, np.array([2.0])).states[0] for h in (0.04, 0.02, 0.01)]
    ratio = np.linalg.norm(ends[0] - ends[1]) / np.linalg.norm(ends[1] - ends[2])
    # The next term is of fourth order, as the step is symmetric: ratios differ from 4 by a multiple of h^2.
    assert abs(ratio - 4) < 0.02


def test_a_step_without_a_solution_is_refused() -> None:
    fast = rigid_body((1.0, 1.0, 1.0), (0.0, 0.0, 3.0))
    with pytest.raises(InvalidParameter, match="step must be small enough") as refused:
        DiscreteMoserVeselov(1.0).integrate(fast, np.array([1.0]))
    assert refused.value.path == ("step",)


def test_a_system_without_discrete_mechanics_is_refused() -> None:
    with pytest.raises(NotApplicable, match="no discrete mechanics") as refused:
        DiscreteMoserVeselov(0.1).integrate(bell(), np.array([1.0]))
    assert refused.value.path == ("kind",)
    assert "implicit-midpoint" in (refused.value.remedy or "")

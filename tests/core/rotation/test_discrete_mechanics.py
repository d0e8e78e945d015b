"""Moser and Veselov's step, against its own equation in matrices and against the curve that it stays on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from scipy.linalg import qr
from scipy.optimize import minimize_scalar

from core.bodies.mass_properties import diagonal
from core.bodies.measured import InertiaTensor
from core.rotation.discrete_mechanics import moser_veselov
from core.rotation.torque_free import TorqueFree
from core.systems.methods import DiscreteMoserVeselov
from tests.core.systems.methods.test_discrete_moser_veselov import step_by_riccati

UPRIGHT = np.eye(3).ravel()

# Semi-axes of the body's ellipsoid, from which every physical set of moments comes.
shapes = st.tuples(*3 * [st.floats(-2, 2)]).map(lambda p: np.exp(2 * np.array(p)))
spins = st.tuples(*3 * [st.floats(-1, 1)]).map(np.array)


@seed(1991)
@given(shapes, spins, st.floats(0.01, 0.5))
def test_the_step_solves_the_matrix_equation(squares: np.ndarray, spin: np.ndarray, size: float) -> None:
    # Moser and Veselov: Q'D - DQ = h hat(M), M' = Q M with Q orthogonal and D the second moments (tr I)/2 - I.
    moments = squares.sum() - squares
    largest = np.linalg.norm(spin)
    if largest < 1e-3:
        return
    h = size / largest
    increment = np.empty(3)
    if not moser_veselov(h, spin, np.concatenate([moments, UPRIGHT]), increment):
        # No solution near the identity: the momentum asks for more than a needle can turn in half a step.
        assert (h / 2 * moments * np.abs(spin)).max() > 0.5 * moments.min()
        return
    before, after = moments * spin, moments * (spin + increment)
    # Q is fixed by what it is to solve: rebuild it from the two momenta and e, e = I^-1 (h/4)(M + M')/r.
    direction = (before + after) * h / 4 / moments
    r2 = (1 + np.sqrt(max(0.0, 1 - 4 * direction @ direction))) / 2
    e, r = direction / np.sqrt(r2), np.sqrt(r2)
    cross = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
    turn = np.eye(3) + 2 * r * cross + 2 * cross @ cross
    d = np.diag(squares)
    hat = turn @ d - d @ turn.T
    skew = np.array([hat[2, 1], hat[0, 2], hat[1, 0]])
    scale = np.abs(before).max() * h
    if r2 > 0.75:
        assert np.abs(skew - h * before).max() < 1e-12 * scale
        assert np.abs(turn.T @ before - after).max() * h < 1e-12 * scale
    assert abs(np.linalg.norm(after) / np.linalg.norm(before) - 1) < 1e-13
    assert abs((after @ (after / moments)) / (before @ (before / moments)) - 1) < 1e-12


@settings(deadline=None, derandomize=True, max_examples=25)
@given(shapes, spins, st.floats(0.01, 0.4))
def test_the_step_is_that_of_a_riccati_equation(squares: np.ndarray, spin: np.ndarray, h: float) -> None:
    moments = squares.sum() - squares
    # The positive solution is that near the identity while the body turns by less than a right angle.
    if not 1e-3 < h * (moments * np.abs(spin)).max() / moments.min() < 0.5:
        return
    increment = np.empty(3)
    assert moser_veselov(h, spin, np.concatenate([moments, UPRIGHT]), increment)
    want = step_by_riccati(squares, moments * spin, h)
    # The Schur form carries 1e-15 of the squares of D over their smallest, and divides by D once more.
    few = 1e-14 * (squares.max() / squares.min()) ** 2
    assert np.abs(moments * (spin + increment) - want).max() <= few * np.abs(moments * spin).max()


def test_the_state_stays_on_the_true_polhode_at_another_time() -> None:
    body = TorqueFree(diagonal((1.0, 2.0, 3.0)), np.array([1.0, 0.3, 1.0]))
    times = np.arange(1, 400) * 0.2
    states = DiscreteMoserVeselov(0.2).integrate(body, times).states
    exact = body.closed_form()
    behind = []
    for t, state in zip(times[::40], states[::40], strict=True):

        def distance(shift: float, t: float = t, state: np.ndarray = state) -> float:
            return float(np.linalg.norm(exact.sample(np.array([t + shift]))[0] - state))

        best = min(
            (minimize_scalar(distance, (s, s + 0.05), tol=1e-12) for s in np.arange(-2, 2, 0.2)), key=lambda o: o.fun
        )
        assert best.fun < 1e-7
        behind.append(best.x)
    # All of the error is time, and it grows in proportion to time.
    assert np.polyfit(times[::40], behind, 1)[0] == pytest.approx(behind[-1] / times[::40][-1], rel=0.05)
    assert abs(behind[-1]) > 0.05


def test_oblique_axes_change_nothing() -> None:
    axes = qr(np.random.default_rng(7).standard_normal((3, 3)))[0]
    axes *= np.linalg.det(axes)
    moments, spin = np.array([1.0, 2.0, 2.5]), np.array([0.2, 1.0, -0.4])
    tensor = axes @ np.diag(moments) @ axes.T
    tensor = (tensor + tensor.T) / 2
    given_body = InertiaTensor(tuple(map(tuple, tensor.tolist()))).mass_properties()
    times = np.linspace(0.1, 20, 50)
    oblique = DiscreteMoserVeselov(0.05).integrate(TorqueFree(given_body, axes @ spin), times).states
    upright = DiscreteMoserVeselov(0.05).integrate(TorqueFree(diagonal(tuple(moments)), spin), times).states
    assert np.abs(oblique @ axes - upright).max() < 1e-12


def test_a_turn_of_half_a_circle_in_one_step_has_no_solution() -> None:
    assert not moser_veselov(2.5, np.array([0.0, 0.0, 1.0]), np.concatenate([[1.0, 1.0, 1.0], UPRIGHT]), np.empty(3))

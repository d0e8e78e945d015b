"""Stiff motions: when collocation is chosen, and its errors against series of higher order in pairs of doubles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import BITS
from core.multibody.motion.dissipative import Dissipative
from core.multibody.motion.stiff import limiting_decay
from core.multibody.solve import solve_scene
from tests.core.multibody.judge import judged, numerical
from tests.core.multibody.random_scenes import stiff_linkage
from tests.core.multibody.worked_examples import column, read

GOVERNOR = {
    "gravity": [0, -9.81],
    "bodies": {
        "left": {"mass": 1, "at": [-0.3, -0.4]},
        "right": {"mass": 1, "at": [0.3, -0.4]},
        "sleeve": {"mass": 2, "at": [0, -0.8]},
    },
    "connections": [
        {"kind": "rod", "a": "left", "b": [0, 0]},
        {"kind": "rod", "a": "right", "b": [0, 0]},
        {"kind": "rod", "a": "left", "b": "sleeve"},
        {"kind": "rod", "a": "right", "b": "sleeve"},
        {"kind": "track", "name": "shaft", "place": "sleeve", "on": {"at": [0, 0], "slope": {"degrees": 90}}},
        {"kind": "spinning-frame", "rate": 10},
        {"kind": "spring", "a": "sleeve", "b": [0, -3], "stiffness": 8e5, "rest_length": 2.2},
        {"kind": "damper", "a": "sleeve", "b": [0, -3], "coefficient": 4e4},
    ],
}


@pytest.mark.parametrize("seed", range(6))
def test_errors_are_never_stated_too_small(seed: int) -> None:
    """The judge is a series of order 40, which is limited by what decays fast, and so asked for short times."""
    with precision(BITS):
        for motion in numerical(stiff_linkage(seed)):
            assert isinstance(motion, Dissipative)
            motion.stiff, time = True, 0.1
            for finer in (False, True):
                found = motion.states(np.array([time]), finer=finer)
                assert motion.stiff
                for value, error, right in zip(
                    (found.q, found.v), (found.q_error, found.v_error), judged(motion, time), strict=True
                ):
                    true = np.abs((value[0, :, 0] - right[:, 0]) + (value[0, :, 1] - right[:, 1]))
                    assert np.all(true <= 1.02 * error[0] + 2.0**-98 * np.abs(right[:, 0]).max())
                    assert np.all(error[0] < 1e-12 * np.abs(right[:, 0]).max())


def test_a_stiff_governor_settles_in_its_equilibrium() -> None:
    answer = solve_scene(read(GOVERNOR), [0.0, 1.0, 10.0], ("trajectory",), 1e-9)
    assert answer.model.name == "collocation"
    assert "would limit the steps of its Taylor series" in answer.model.why
    height = column(answer, "sleeve.position").values[:, 1]
    # In equilibrium (M + m) g + k (y + 0.8) = 4 m W^2 y / 4, the balls at half the height of the sleeve.
    assert abs(3 * 9.81 + 8e5 * (height[2] + 0.8) - (-50.0 * height[2])) < 1e-4


def test_what_takes_no_time_is_not_stiff() -> None:
    assert limiting_decay(np.array([[-1e6, 0.0]]), 0.0, 0.0) is None
    assert limiting_decay(np.array([[0.0, 1.0]]), 1.0, 0.0) is None


def test_a_stiff_motion_whose_steps_become_too_short_is_followed_by_its_series() -> None:
    """Drawn by c/x against a damper of c it reaches x = 0 after some x^2/2; its inertia takes a little longer."""
    scene = {
        "bodies": {"bead": {"mass": 1, "at": [0.5, 0]}},
        "connections": [
            {"kind": "track", "place": "bead", "on": {"at": [0, 0], "slope": 0}},
            {"kind": "damper", "a": "bead", "b": [10, 0], "coefficient": 1e4},
            {"kind": "force", "name": "pull", "place": "bead", "force": ["-1e4/x", 0]},
        ],
    }
    early, late = (solve_scene(read(scene), [0.0, end], ("trajectory",)) for end in (0.1, 1.0))
    assert (early.model.name, late.model.name) == ("collocation", "Taylor series")
    assert late.ended is not None
    assert (late.ended.kind, late.ended.name) == ("formula", "pull")
    assert 0.125 < late.ended.time < 0.126


def elastic_pendulum(stiffness: float) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [
            {"kind": "spring", "a": "bob", "b": [0, 0], "stiffness": stiffness, "rest_length": 1},
            {"kind": "spring", "a": "bob", "b": [1, 0], "stiffness": 5, "rest_length": 0.5},
        ],
    }


def test_what_oscillates_is_not_stiff_and_the_model_says_that_it_is_followed() -> None:
    """The frequency of a bob on its spring is the root of k/m; stretched by some m g/k, it hardly leaves a circle."""
    soft, hard = (solve_scene(read(elastic_pendulum(k)), [0.0, 1.0], ("trajectory",)) for k in (1e4, 1e8))
    assert (soft.model.name, hard.model.name) == ("Taylor series", "Taylor series")
    assert "oscillates" not in soft.model.why
    assert "what oscillates at 1e+04 rad/s is followed turn by turn" in hard.model.why
    assert abs(np.linalg.norm(column(hard, "bob.position").values[-1]) - 1.0) < 1e-6


def test_what_oscillates_too_often_is_named_where_it_is_refused() -> None:
    with pytest.raises(BudgetExceeded) as refused:
        solve_scene(read(elastic_pendulum(1e12)), [0.0, 1.0], ("trajectory",))
    assert refused.value.remedy is not None
    assert "what oscillates at 1e+06 rad/s" in refused.value.remedy
    # Steps of order 24 turn by some radians.
    assert 1e5 < refused.value.needed < 1e6


@pytest.mark.parametrize("coefficient", [10.0**power for power in range(-3, 7)])
def test_a_pendulum_is_stiff_under_a_strong_damper_alone(coefficient: float) -> None:
    """Beside an implicit method of fifth order for its angle; the damper pulls at the bob from a place beside it."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [
            {"kind": "rod", "a": "bob", "b": [0, 0]},
            {"kind": "damper", "a": "bob", "b": [1, -1], "coefficient": coefficient},
        ],
    }
    answer = solve_scene(read(scene), [0.0, 1.0], ("trajectory",))
    assert answer.model.name == ("collocation" if coefficient > 1e3 else "Taylor series")

    def rates(_: float, state: Any) -> list[float]:
        (s, c), along = (np.sin(state[0]), np.cos(state[0])), np.array([np.cos(state[0]), np.sin(state[0])])
        way = np.array([1 - s, -1 + c])
        way /= np.linalg.norm(way)
        return [state[1], -9.81 * s - coefficient * (along @ way) ** 2 * state[1]]

    start = [np.arctan2(0.6, 0.8), 0.0]
    angle = solve_ivp(rates, (0.0, 1.0), start, method="Radau", rtol=1e-11, atol=1e-13).y[0, -1]
    place = column(answer, "bob.position")
    assert place.error < 1e-14
    np.testing.assert_allclose(place.values[-1], [np.sin(angle), -np.cos(angle)], atol=1e-10)

"""Stiff motions: when collocation is chosen, and its errors against series of higher order in pairs of doubles."""

from __future__ import annotations

import numpy as np
import pytest

from core.balls import precision
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

"""Quaternions of axes, in balls and in doubles, against the axis and the angle of a turn."""

from __future__ import annotations

import numpy as np
from flint import arb
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.multibody.motion.attitudes import quaternion, quaternions
from tests.drawn import draws

components = st.floats(-1, 1)


@settings(max_examples=draws(200))
@given(st.lists(components, min_size=4, max_size=4).filter(lambda q: sum(x * x for x in q) > 0.01))
@example([0.0, 1.0, 0.0, 0.0])
@example([0.0, 0.0, -1.0, 0.0])
@example([0.0, 0.0, 0.0, 1.0])
@example([1e-9, 0.6, 0.0, -0.8])
def test_the_quaternion_of_the_axes_of_a_quaternion_is_the_same_up_to_sign(given_one: list[float]) -> None:
    right = np.array(given_one) / np.linalg.norm(given_one)
    w, u = right[0], right[1:]
    # Rodrigues: v + 2 w (u x v) + 2 u x (u x v) for every axis v.
    axes = np.array([v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v)) for v in np.eye(3)])
    with precision(200):
        balls = [float(x) for x in quaternion([[arb(x) for x in axis] for axis in axes.tolist()])]
    for found in (quaternions(axes[None])[0], np.array(balls)):
        assert found[0] >= 0.0
        assert min(np.abs(found - right).max(), np.abs(found + right).max()) <= 4e-15


def test_no_axes_have_no_quaternions() -> None:
    assert quaternions(np.empty((0, 3, 3))).shape == (0, 4)

from __future__ import annotations

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.motion.test_free_body import tumbling
from tests.core.multibody.table.test_rolling_in_space import rolling
from tests.core.multibody.worked_examples import LAGRANGE_TOP, TWO_RODS, column, read

MOMENTA = ["trajectory", "momenta-in-time"]


def rotation(quaternion):
    w, *v = quaternion
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * k + 2 * k @ k


def test_a_free_body_keeps_its_angular_momentum_and_has_that_of_its_tensor():
    description = tumbling(2)
    answer = solve_scene(read(description), [0.0, 3.0, -2.0], MOMENTA)
    momentum = column(answer, "angular_momentum")
    tensor = np.array([[eval(x) for x in row] for row in description["bodies"]["b"]["tensor"]])
    for t in range(3):
        attitude, omega = (column(answer, f"b.{name}").values[t] for name in ("attitude", "angular_velocity"))
        assert rotation(attitude) @ tensor @ omega == pytest.approx(momentum.values[t], abs=1e-13)
        assert momentum.values[t] == pytest.approx(momentum.values[0], abs=2 * momentum.error)
    assert column(answer, "momentum").values == pytest.approx(np.zeros((3, 3)), abs=1e-15)


def test_weight_turns_a_top_about_the_horizontal_only():
    answer = solve_scene(read(LAGRANGE_TOP), [0.0, 0.3, 2.0], MOMENTA)
    momentum = column(answer, "top.angular_momentum")
    assert momentum.values[:, 2] == pytest.approx(momentum.values[0, 2], abs=2 * momentum.error)
    # The momentum about its own axis stays 0.8, too.
    along = (momentum.values * column(answer, "top.axis").values).sum(axis=1)
    assert along == pytest.approx(np.full(3, 0.8), rel=1e-13)


def test_momenta_of_the_parts_add_up_and_change_by_the_weight():
    answer = solve_scene(read(TWO_RODS), [0.0, 0.5], MOMENTA)
    for name in ("momentum", "angular_momentum"):
        parts = sum(column(answer, f"{body}.{name}").values for body in ("one", "two"))
        assert parts == pytest.approx(column(answer, name).values, abs=1e-13)
    spin = column(answer, "one.angular_velocity").values
    (x, y), (u, w) = (column(answer, f"one.{what}").values.T for what in ("position", "velocity"))
    assert column(answer, "one.angular_momentum").values == pytest.approx(x * w - y * u + 0.0833 * spin, rel=1e-13)


def test_a_ball_that_rolls_has_its_spin():
    answer = solve_scene(read(rolling("plane")), [0.4], MOMENTA)
    place, rate, omega = (
        column(answer, f"ball.{name}").values[0] for name in ("position", "velocity", "angular_velocity_in_space")
    )
    expected = 0.5 * np.cross(place, rate) + 0.002 * omega
    assert column(answer, "ball.angular_momentum").values[0] == pytest.approx(expected, abs=1e-15)


def test_momenta_that_are_zero_are_not_taken_for_lost():
    bodies = {
        "a": {"mass": 1, "at": [-1, 0], "velocity": [0, 0.3]},
        "b": {"mass": 1, "at": [1, 0], "velocity": [0, -0.3]},
    }
    scene = {"bodies": bodies, "connections": [{"kind": "gravitation", "a": "a", "b": "b", "constant": 1}]}
    answer = solve_scene(read(scene), [2.0], ["momenta-in-time"])
    momentum = column(answer, "momentum")
    assert np.linalg.norm(momentum.values) <= momentum.error
    assert column(answer, "angular_momentum").values[0] == pytest.approx(-0.6, rel=1e-14)

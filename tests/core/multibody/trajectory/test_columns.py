"""Errors relative to the scale of a motion."""

from __future__ import annotations

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from core.multibody.trajectory.column_errors import worst
from core.systems.trajectory import Column
from tests.core.multibody.worked_examples import column, read


def made(values: list[float], unit: str, error: float) -> Column:
    return Column(np.array(values), unit, error, "measured against pairs")


def test_errors_are_relative_to_the_largest_value_of_a_unit() -> None:
    columns = {"a": made([1.0, -4.0], "m", 1e-12), "b": made([0.0], "m", 4e-12), "c": made([2e-3], "rad", 1e-9)}
    assert worst(columns) == pytest.approx(5e-7)


def test_angles_that_are_zero_within_their_error_are_measured_by_radians_and_speeds() -> None:
    columns = {"x": made([2.0], "m", 0.0), "v": made([6.0], "m/s", 0.0)}
    assert worst(columns | {"a": made([1e-30], "rad", 1e-14)}) == pytest.approx(1e-14)
    assert worst(columns | {"w": made([1e-30], "rad/s", 6e-14)}) == pytest.approx(2e-14)
    # Without a motion there is nothing to measure by.
    assert worst({"w": made([1e-30], "rad/s", 6e-14)}) == pytest.approx(6e16)


def test_a_plank_on_two_strings_that_never_turns_is_answered() -> None:
    plank = {"mass": 2, "inertia": 0.5, "at": [0.6, -0.8], "places": {"l": [-1, 0], "r": [1, 0]}}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"plank": plank},
        "connections": [
            {"kind": "string", "through": ["plank.l", [-1, 0]]},
            {"kind": "string", "through": ["plank.r", [1, 0]]},
        ],
    }
    answer = solve_scene(read(scene), [0.3, 1.0])
    for name in ("plank.angle", "plank.angular_velocity"):
        found = column(answer, name)
        assert np.abs(found.values).max() <= found.error < 1e-25

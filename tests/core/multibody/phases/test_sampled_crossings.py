"""Events of motions that nearly repeat, against dense samples of the same motion without what is touched."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


def spherical_pendulum(pivot: tuple[int, int, int], rate: str) -> dict[str, Any]:
    x, y, z = pivot
    bob = {"mass": 1, "at": [f"{x} + 0.6", y, f"{z} - 0.8"], "velocity": [0, rate, 0]}
    return {
        "gravity": [0, 0, -9.81],
        "bodies": {"b": bob},
        "connections": [{"kind": "rod", "a": "b", "b": list(pivot)}],
    }


@pytest.mark.parametrize("pivot", [(0, 0, 0), (1, 2, 3)])
@pytest.mark.parametrize("rate", ["0.35", "-0.35", "0.2"])
def test_a_wall_that_an_ellipse_reaches_as_it_turns(pivot: tuple[int, int, int], rate: str) -> None:
    """The height repeats every second, and the ellipse turns: the wall beside it is reached after ten or more."""
    scene = spherical_pendulum(pivot, rate)
    place = {"at": [0, f"{pivot[1]} + 0.5", 0], "normal": [0, -1, 0]}
    wall = {"kind": "contact", "name": "w", "place": "b", "on": place, "restitution": 1}
    touch = solve_scene(read(scene | {"connections": [*scene["connections"], wall]}), [60]).events[0]
    times = np.linspace(0.0, 60.0, 60_001)
    beyond = column(solve_scene(read(scene), times), "b.position").values[:, 1] > pivot[1] + 0.5
    first = times[int(np.argmax(beyond))]
    assert first > 10.0
    assert first - 1.1e-3 <= touch.time <= first


def test_a_wall_that_a_swing_in_a_plane_never_reaches_is_looked_for_in_one_period() -> None:
    scene = spherical_pendulum((0, 0, 0), "0")
    wall = {"kind": "contact", "name": "w", "place": "b", "on": {"at": [0, 1, 0], "normal": [0, -1, 0]}}
    assert not solve_scene(read(scene | {"connections": [*scene["connections"], wall]}), [1e6]).events


@pytest.mark.parametrize("horizon", [1.5, 50.0, 5000.0])
def test_a_wall_beside_a_conical_pendulum_is_met_in_the_first_turn(horizon: float) -> None:
    """It circles at 0.6 m with sqrt(10/0.8) rad/s, and the wall is at 0.599 m on the other side."""
    bob = {"mass": 1, "at": ["0.6", 0, "-0.8"], "velocity": [0, "0.6*sqrt(12.5)", 0]}
    rod = {"kind": "rod", "a": "b", "b": [0, 0, 0]}
    wall = {"kind": "contact", "name": "w", "place": "b", "on": {"at": ["-0.599", 0, 0], "normal": [1, 0, 0]}}
    found = solve_scene(read({"gravity": [0, 0, -10], "bodies": {"b": bob}, "connections": [rod, wall]}), [horizon])
    right = (np.pi - np.arccos(0.599 / 0.6)) / np.sqrt(12.5)
    assert found.events[0].time == pytest.approx(right, rel=1e-13)

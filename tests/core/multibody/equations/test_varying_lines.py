"""Friction that turns from the first moment on, in space: beside the plain engine, and by the first powers of time."""

from __future__ import annotations

from typing import Any

import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read
from tests.oracles.plain_engine.comparison.comparing import compared

FLOOR = {
    "kind": "contact",
    "name": "floor",
    "place": "b",
    "friction": "1/10",
    "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
}
SPRING = {"kind": "spring", "a": "b", "b": [0, 0, 0], "stiffness": 4, "rest_length": 0}


def scene(*connections: dict[str, Any]) -> dict[str, Any]:
    bodies = {"b": {"mass": 1, "at": [1, 0, 0]}}
    return {"gravity": [0, 0, -10], "bodies": bodies, "connections": [FLOOR, *connections]}


@pytest.mark.parametrize(
    "given",
    [
        scene(SPRING, {"kind": "force", "place": "b", "force": [0, "2*t", 0]}),
        scene({"kind": "spinning-frame", "rate": 2}),
    ],
)
def test_what_begins_to_slide_with_an_acceleration_moves_as_the_plain_engine_says(given: dict[str, Any]) -> None:
    verdict = compared(given, [0.0, 0.2, 0.4])
    assert verdict.differences == []
    assert verdict.compared > 0


def test_the_slip_across_grows_as_friction_lets_it() -> None:
    """With s_x = -3 t, s_y' = 2 t - s_y/(3 t) has the solution s_y = 6 t^2/7, and y = 2 t^3/7."""
    answer = solve_scene(
        read(scene(SPRING, {"kind": "force", "place": "b", "force": [0, "2*t", 0]})),
        [0.0, 0.001],
        ("trajectory", "forces-in-time"),
    )
    assert answer.trajectory is not None
    assert answer.trajectory.columns["b.position"].values[1, 1] == pytest.approx(2e-9 / 7, rel=1e-5)
    friction = answer.trajectory.columns["floor.friction.x"].values
    assert friction[0] == pytest.approx(1.0, rel=1e-15)

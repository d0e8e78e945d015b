"""Torques on bodies of space, along the axes of space or of the body, against Euler's equations by DOP853."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.arrays import Floats
from core.errors import InvalidParameter
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

TIMES = [0.0, 0.5, 2.0]
MOMENTS, SPIN = np.array([1.0, 2.0, 3.0]), np.array([0.1, 1.0, 0.2])


def scene(torque: Any, **more: Any) -> dict[str, Any]:
    body = {"mass": 3, "moments": [1, 2, 3], "at": [0, 0, 0], "angular_velocity": ["0.1", "1", "0.2"]}
    beside = {"mass": 1, "at": [5, 0, 0], "velocity": [0, 1, 0]}
    push = {"kind": "torque", "name": "push", "body": "b", "torque": torque, **more}
    return {"bodies": {"b": body, "p": beside}, "connections": [push]}


def spun(torque: Callable[[float, Floats], Any]) -> tuple[Floats, Floats]:
    """Return angular velocities in space, shape (t, 3), and works, of a torque in body axes by time and attitude."""

    def rates(t: float, y: Floats) -> Floats:
        w, attitude = y[:3], y[3:12].reshape(3, 3)
        push = np.asarray(torque(t, attitude))
        turned = attitude @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return np.concatenate([(push - np.cross(w, MOMENTS * w)) / MOMENTS, turned.ravel(), [push @ w]])

    start = np.concatenate([SPIN, np.eye(3).ravel(), [0.0]])
    y = solve_ivp(rates, (0, 2), start, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=TIMES).y
    return np.array([y[3:12, i].reshape(3, 3) @ y[:3, i] for i in range(len(TIMES))]), y[12]


CASES: dict[str, tuple[list[Any], dict[str, str], Callable[[float, Floats], Any]]] = {
    "constant": ([0.1, 0.2, -0.3], {}, lambda t, turn: turn.T @ [0.1, 0.2, -0.3]),
    "formulas": (["sin(3*t)", 0.2, "-t"], {}, lambda t, turn: turn.T @ [np.sin(3 * t), 0.2, -t]),
    "turning": ([0.1, 0.2, -0.3], {"in": "body"}, lambda t, turn: [0.1, 0.2, -0.3]),
    "turning formulas": (["sin(3*t)", 0, "p.y"], {"in": "body"}, lambda t, turn: [np.sin(3 * t), 0, t]),
}


@pytest.mark.parametrize("case", CASES)
def test_a_torque_turns_a_free_body(case: str) -> None:
    torque, more, in_body = CASES[case]
    outputs = ("accelerations", "trajectory", "work-in-time")
    found = solve_scene(scene_from(scene(torque, **more)), TIMES, outputs).trajectory
    assert found is not None
    spin, work = spun(in_body)
    # In axes of the body or of space: their lengths and those along the angular momentum do not depend on it.
    own = found.columns["b.angular_velocity"].values
    np.testing.assert_allclose(np.linalg.norm(own, axis=1), np.linalg.norm(spin, axis=1), rtol=1e-11)
    np.testing.assert_allclose(found.columns["push.work"].values, work, atol=1e-11)


def test_what_no_torque_can_be_is_refused() -> None:
    with pytest.raises(InvalidParameter, match='be "body"') as refused:
        solve_scene(scene_from(scene([1, 2, 3], **{"in": "space"})), TIMES)
    assert refused.value.path == ("connections", 0, "in")
    with pytest.raises(InvalidParameter, match="list of three"):
        solve_scene(scene_from(scene("t", **{"in": "body"})), TIMES)
    plane = {
        "bodies": {"b": {"mass": 1, "inertia": 1, "at": [0, 0]}},
        "connections": [{"kind": "torque", "body": "b", "torque": 1, "in": "body"}],
    }
    with pytest.raises(InvalidParameter, match="left out in the plane"):
        solve_scene(scene_from(plane), TIMES)

"""Formulas of several pieces, which the plain engine integrates across: its motion is that of the phases in between."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from tests.oracles.plain_engine.motion import follow

ROD = {"kind": "rod", "a": "p", "b": [0, 0]}
STRAP = {"kind": "spring", "a": "p", "b": [0, 0], "law": "max(0, 20*(length - 1.2))"}
FLOOR = {"kind": "contact", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5}


def push(*force: Any) -> dict[str, Any]:
    return {"kind": "force", "place": "p", "force": list(force)}


@pytest.mark.parametrize(
    ("body", "connections", "time"),
    [
        ({}, [ROD, push("if(vx, 1, -1)", 0)], 1.3),
        ({}, [ROD, push("-0.3*abs(vx)*vx", "0")], 1.5),
        ({"velocity": [1, 1]}, [STRAP], 1.0),
        ({"at": [0, 0.2]}, [FLOOR, push("min(t, 1/8)", "4*max(0, 1/10 - y)")], 0.5),
    ],
)
def test_the_same_motion(body: dict[str, Any], connections: list[dict[str, Any]], time: float) -> None:
    bodies = {"p": {"mass": 1, "at": [1, 0]} | body}
    scene = scene_from({"gravity": [0, -10], "bodies": bodies, "connections": connections})
    found, plain = solve_scene(scene, [time]), follow(scene, [time], tolerance=1e-10)
    assert any(event.kind == "switch" for event in found.events)
    assert found.trajectory is not None
    place = plain.mechanism.coordinates.placement(plain.states[time])["p"].position
    np.testing.assert_allclose(found.trajectory.columns["p.position"].values[0], place, atol=1e-7)

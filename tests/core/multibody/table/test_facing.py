"""Which edge of a shape a corner may meet: at ends of edges, at corners, and beside a bouncing ball."""

from __future__ import annotations

from typing import Any

import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read

SQUARE = {"mass": 1, "shape": {"kind": "box", "width": 0.2, "height": 0.2}}


def pair(a: dict[str, Any], b: dict[str, Any], **more: Any) -> dict[str, Any]:
    contact = {"kind": "contact", "name": "c", "a": "a", "b": "b", "friction": 0.5, "restitution": 0.5}
    return {"bodies": {"a": {**SQUARE, **a}, "b": {**SQUARE, **b}}, "connections": [contact], **more}


def test_corner_on_corner_is_undecided() -> None:
    """Two squares on their tips; moved a little, or with a radius, the edges decide."""
    tip = {"angle": {"degrees": 45}}
    scene = pair({"at": [0, 1], "velocity": [0, -1], **tip}, {"at": [0, 0], **tip})
    answer = solve_scene(read(scene), [1.0])
    assert answer.problem is not None
    assert answer.problem.code == "corner-on-corner"
    scene["bodies"]["a"]["angle"] = 0.6
    scene["bodies"]["a"]["at"] = [0.05, 1]
    answer = solve_scene(read(scene), [1.0])
    assert answer.problem is None
    assert answer.events[0].energy_loss > 0


def test_corners_that_lie_on_corners_share_one_force_each() -> None:
    """Equal boxes in a stack: the corners of one, on the ends of the edge of the other."""
    scene = pair({"at": [0, 0.3]}, {"at": [0, 0.1]}, gravity=[0, -10])
    scene["connections"].append({"kind": "contact", "name": "floor", "place": "b", "on": {"at": [0, 0]}, "friction": 1})
    answer = solve_scene(read(scene), [1.0])
    assert answer.forces is not None
    assert [answer.forces[f"c.{i}.normal"].value for i in range(1, 9)] == [5, 5, 0, 0, 0, 0, 0, 0]
    assert not answer.events


@pytest.mark.parametrize("first", [True, False])
def test_another_ball_does_not_matter(first: bool) -> None:
    """A square that turns past another meets it as if nothing else bounced."""
    scene = pair({"at": [0, 0], "velocity": [1, 0], "angular_velocity": 1}, {"at": [1, 0.1], "angle": 0.4})
    alone = solve_scene(read(scene), [2.0])
    ball = {"mass": 1, "at": [9, 1], "velocity": [0, -1]}
    bodies = {"ball": ball, **scene["bodies"]} if first else {**scene["bodies"], "ball": ball}
    floor = {"kind": "contact", "name": "f", "place": "ball", "on": {"at": [9, 0]}, "restitution": 0.9}
    together = solve_scene(read({"bodies": bodies, "connections": [*scene["connections"], floor]}), [2.0])
    assert [one for one in kinds(together) if one[1] != "f"] == kinds(alone)
    name = "b.angular_velocity"
    assert column(together, name).values[0] == pytest.approx(column(alone, name).values[0], abs=2e-15)

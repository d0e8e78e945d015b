"""A pendulum at its lowest place that touches a floor: what pushes it sideways moves it off, and nothing holds it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.relations import geometry
from tests.core.multibody.worked_examples import read

OUTPUTS = ("accelerations", "forces", "trajectory", "forces-in-time")
ROD = {"kind": "rod", "name": "r", "a": "p", "b": [0, 0]}
STRING = {"kind": "string", "name": "r", "through": ["p", [0, 0]]}


def bob(holds: dict[str, Any], *more: dict[str, Any], floor: bool = True) -> dict[str, Any]:
    contact = {"kind": "contact", "name": "c", "place": "p", "on": {"at": [0, -1]}}
    return {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, -1]}},
        "connections": [holds, *([contact] if floor else []), *more],
    }


def push(force: float | str) -> dict[str, Any]:
    return {"kind": "force", "place": "p", "force": [force, 0]}


@pytest.mark.parametrize("holds", [ROD, STRING])
@pytest.mark.parametrize("force", [1, -30, "t^3", "t^9"])
def test_it_moves_as_it_would_without_the_floor(holds: dict[str, Any], force: float | str) -> None:
    times = np.linspace(0.0, 0.8, 9)
    with_floor, alone = (
        solve_scene(read(bob(holds, push(force), floor=floor)), times, OUTPUTS) for floor in (True, False)
    )
    assert with_floor.trajectory is not None
    assert alone.trajectory is not None
    assert with_floor.ended is None
    for name, column in alone.trajectory.columns.items():
        own = with_floor.trajectory.columns[name]
        np.testing.assert_allclose(own.values, column.values, rtol=0, atol=own.error + column.error + 1e-14)
    assert with_floor.forces is not None
    assert with_floor.forces["c.normal"].value == 0.0


def test_in_space_too() -> None:
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, 0, -1]}},
        "connections": [
            {"kind": "rod", "a": "p", "b": [0, 0, 0]},
            {"kind": "contact", "name": "c", "place": "p", "on": {"at": [0, 0, -1], "normal": [0, 0, 1]}},
            {"kind": "force", "place": "p", "force": [3, 4, 0]},
        ],
    }
    answer = solve_scene(read(scene), [0.5], OUTPUTS)
    assert answer.accelerations is not None
    assert answer.accelerations["p"].linear == pytest.approx([3.0, 4.0, 0.0], abs=1e-14)


@pytest.mark.parametrize("sides", [None, (3, 4, 5), (5, 12, 13)])
def test_at_rest_the_load_is_shared_with_the_floor(sides: tuple[int, int, int] | None) -> None:
    body = {"mass": 2, "inertia": 0.2, "at": [0, -0.5], "angle": 0.0, "places": {"top": [0, 0.5], "end": [0, -0.5]}}
    pin = {"kind": "pin", "name": "r", "a": "p.top", "b": [0, 0]}
    end = {"kind": "contact", "name": "c", "place": "p.end", "on": {"at": [0, -1]}}
    for given in (bob(ROD), {**bob(pin), "bodies": {"p": body}, "connections": [pin, end]}):
        scene = given
        if sides is not None:
            turned = geometry.turned({**given, "times": [0.5]}, sides=sides)
            assert turned is not None
            scene = {key: turned.request[key] for key in given}
        answer = solve_scene(read(scene), [0.5], OUTPUTS)
        assert answer.forces is not None
        assert answer.forces["c.normal"].value is None
        assert answer.forces["c.normal"].shared_with == ("c", "r")


def test_a_platform_hangs_on_parallel_rods_above_a_floor_that_it_touches() -> None:
    contact = {"kind": "contact", "name": "c", "place": "b.r", "on": {"at": [0, 0]}}

    def moved(*more: dict[str, Any]) -> dict[str, float]:
        scene = {
            "gravity": [0, -9.81],
            "bodies": {"b": {"mass": 0.5, "inertia": 0.05, "at": [0.5, 0], "places": {"l": [-0.5, 0], "r": [0.5, 0]}}},
            "connections": [
                {"kind": "rod", "a": "b.l", "b": [0, 1]},
                {"kind": "rod", "a": "b.r", "b": [1, 1]},
                {"kind": "force", "place": "b", "force": ["t", 0]},
                *more,
            ],
        }
        found = solve_scene(read(scene), [0.5], ("trajectory",)).trajectory
        assert found is not None
        return {name: float(column.values[-1][0]) for name, column in found.columns.items() if "position" in name}

    free = moved()
    assert max(free.values()) > 0.51
    assert moved(contact) == pytest.approx(free, abs=1e-12)


def _plane(x: int, scale: str, sides: tuple[int, int, int] | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a pendulum from its side above a floor at its lowest place, moved, scaled and turned; and the floor."""
    rod = {"kind": "rod", "a": "p", "b": [x, 0]}
    contact = {"kind": "contact", "name": "c", "place": "p", "on": {"at": [x, f"-({scale})"]}, "restitution": 0.5}
    body = {"mass": 1, "at": [f"{x} + {scale}", 0]}
    scene = {"gravity": [0, -10], "bodies": {"p": body}, "connections": [rod, contact], "times": [1]}
    if sides is not None:
        turned = geometry.turned(scene, sides=sides)
        assert turned is not None
        scene = turned.request
    del scene["times"]
    return scene, scene["connections"][1]


@pytest.mark.parametrize("sides", [None, (3, 4, 5), (5, 12, 13)])
@pytest.mark.parametrize(("x", "scale"), [(0, "1"), (0, "1e-3"), (0, "1e3"), (1000, "1")])
def test_a_pendulum_passes_a_floor_that_touches_its_path(
    x: int, scale: str, sides: tuple[int, int, int] | None
) -> None:
    scene, contact = _plane(x, scale, sides)
    times = np.linspace(0.0, 3.0, 7) * np.sqrt(float(scale))
    found = solve_scene(read(scene), times, OUTPUTS)
    free = {**scene, "connections": [one for one in scene["connections"] if one is not contact]}
    alone = solve_scene(read(free), times, OUTPUTS)
    assert found.events == ()
    assert found.trajectory is not None
    assert alone.trajectory is not None
    own, other = found.trajectory.columns["p.position"], alone.trajectory.columns["p.position"]
    np.testing.assert_allclose(own.values, other.values, rtol=0, atol=own.error + other.error)


def test_a_floor_that_is_hardly_higher_or_lower_is_no_such_floor() -> None:
    for apart, kinds in (("1e-20", ["touch"]), ("-1e-20", [])):
        scene, contact = _plane(0, "1", None)
        contact["on"]["at"] = [0, f"-1 + {apart}"]
        assert [event.kind for event in solve_scene(read(scene), [0.7], OUTPUTS).events] == kinds


def test_rods_and_plates_pass_such_a_floor_in_the_plane_and_in_space() -> None:
    pin, below = {"kind": "pin", "a": "p.t", "b": [0, 0]}, {"at": [0, -2]}
    floor = {"kind": "contact", "name": "c", "place": "p.e", "on": below}
    far = {"kind": "contact", "name": "far", "place": "ball", "on": below, "restitution": 0.5}
    places = {"t": ["-1", 0], "e": ["1", 0]}
    rod = {"mass": 2, "inertia": "1/6", "at": [1, 0], "places": places}
    other = {"mass": 1, "at": [50, 3]}
    plane = {
        "gravity": [0, -10],
        "bodies": {"p": rod, "ball": other},
        "connections": [pin, floor, far],
    }
    plate = {"mass": 1, "moments": [0.1, 0.2, 0.3], "at": [0, 0, -1], "angular_velocity": [0, 1, 0]}
    space = {
        "gravity": [0, 0, -10],
        "bodies": {"p": {**plate, "velocity": [-1, 0, 0], "places": {"t": [0, 0, 1]}}},
        "connections": [
            {"kind": "pin", "a": "p.t", "b": [0, 0, 0], "axis": [0, 1, 0]},
            {"kind": "contact", "name": "c", "place": "p", "on": {"at": [0, 0, -1], "normal": [0, 0, 1]}},
        ],
    }
    for scene in (plane, space):
        answer = solve_scene(read(scene), [3], OUTPUTS)
        assert answer.ended is None
        assert not any(event.name == "c" for event in answer.events)

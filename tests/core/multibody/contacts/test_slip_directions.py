"""Directions in which something begins to slide in space, against the plane and against the scene turned."""

from __future__ import annotations

from typing import Any

import pytest
from flint import arb

from core.balls import precision
from core.multibody.contacts.slip_directions import Direction, directions
from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read

TURNED = (["0.6", "0.8", 0], ["-0.8", "0.6", 0])


def on_a_floor(gravity: Any, friction: Any, place: str = "one", **body: Any) -> dict[str, Any]:
    return {
        "gravity": gravity,
        "bodies": {"one": {"mass": 1, **body}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": place, "on": FLOOR, "friction": friction},
        ],
    }


FLOOR = {"at": [0, 0, 0], "normal": [0, 0, 1]}


@pytest.mark.parametrize("steep", [2, 3, 5, 7])
def test_a_force_without_bounds_is_no_direction(steep: int) -> None:
    """N = 1/(1 - k cos) is unbounded; what follows is off by sin (1 - cos)/(1 - k cos), ahead where it is at 180."""

    def after(way: Direction) -> Direction:
        push = 1 / (1 - steep * way[0])
        return arb(-1), (steep - 1) * push * way[1]

    with precision(256):
        found = directions(after)
    assert [tuple(map(float, way)) for way in found] == [pytest.approx((-1, 0), abs=1e-15)]


@pytest.mark.parametrize(
    ("gravity", "at", "axes"),
    [
        ([3, 0, -9], ["0.3", 0, "0.4"], [["0.8", 0, "-0.6"], [0, 1, 0], ["0.6", 0, "0.8"]]),
        (
            ["1.8", "2.4", -9],
            ["0.18", "0.24", "0.4"],
            [["0.48", "0.64", "-0.6"], ["-0.8", "0.6", 0], ["0.36", "0.48", "0.8"]],
        ),
    ],
)
def test_a_falling_rod_slips_one_way(gravity: Any, at: Any, axes: Any) -> None:
    """As in the plane: the time is that at which a rod with J = 0.04 about its centre asks for friction of 2."""
    body = {"moments": ["0.044", "0.04", "0.01"], "at": at, "axes": axes, "places": {"toe": [0, 0, "-0.5"]}}
    answer = solve_scene(read(on_a_floor(gravity, 2, "one.toe", **body)), [0.35])
    plane = {
        "gravity": [3, -9],
        "bodies": {
            "one": {"mass": 1, "inertia": "0.04", "at": ["0.3", "0.4"], "places": {"toe": ["-0.3", "-0.4"]}},
        },
        "connections": [
            {"kind": "contact", "name": "floor", "place": "one.toe", "on": {"at": [0, 0]}, "friction": 2},
        ],
    }
    flat = solve_scene(read(plane), [0.35])
    assert kinds(answer) == kinds(flat) == [("slip", "floor")]
    assert answer.events[0].time == pytest.approx(flat.events[0].time, rel=1e-14)


@pytest.mark.parametrize("friction", [2, "1.2"])
def test_a_tipping_box_slips_on_its_edge_however_it_lies(friction: Any) -> None:
    box = {"shape": {"kind": "box", "width": "0.2", "height": "0.2", "depth": "0.4"}, "at": [0, 0, "0.2"]}
    along = solve_scene(read(on_a_floor([5, 0, -8], friction, **box)), [0.54])
    turned = solve_scene(read(on_a_floor([3, 4, -8], friction, **box, axes=[*TURNED, [0, 0, 1]])), [0.54])
    assert turned.problem is along.problem is None
    assert sorted(kinds(turned)) == sorted(kinds(along))
    assert [kind for kind, _ in kinds(turned)].count("slip") == 2
    times = [event.time for event in along.events]
    assert [event.time for event in turned.events] == pytest.approx(times, rel=1e-10)


@pytest.mark.parametrize(("width", "height", "depth"), [("0.066", "0.066", "0.12"), ("0.2", "0.3", "0.1")])
@pytest.mark.parametrize("force", [["2*t", 0, 0], ["1.2*t", "1.6*t", 0]])
def test_all_corners_of_a_pushed_box_slip_at_once(width: str, height: str, depth: str, force: Any) -> None:
    """From mu m g = 2 t on the acceleration is 2 (t - t0)/m: it moves by (t - t0)^3/(3 m)."""
    box = {"shape": {"kind": "box", "width": width, "height": height, "depth": depth}, "at": [0, 0, f"{depth}/2"]}
    scene = on_a_floor([0, 0, "-9.81"], "0.5", **box)
    scene["bodies"]["one"]["mass"] = "0.4"
    scene["connections"].append({"kind": "force", "place": "one", "force": force})
    # What is pressed harder on a floor of its own has no part in it.
    ball = {"mass": 1, "moments": [1, 1, 1], "radius": 1, "at": [9, 0, 1]}
    scene["bodies"]["ball"] = ball
    scene["connections"] += [
        {"kind": "contact", "name": "other", "place": "ball", "on": FLOOR, "friction": 1},
        {"kind": "force", "place": "ball", "force": [0, 0, "-1e12"]},
    ]
    answer = solve_scene(read(scene), [1.2])
    assert sorted(kinds(answer)) == [("slip", f"floor.{k}") for k in range(1, 5)]
    assert all(abs(event.time - 0.981) <= event.error < 1e-10 for event in answer.events)
    moved = (1.2 - 0.981) ** 3 / (3 * 0.4)
    x, y = column(answer, "one.position").values[0][:2]
    way = (1, 0) if force[1] == 0 else (0.6, 0.8)
    assert (x, y) == pytest.approx((moved * way[0], moved * way[1]), abs=1e-9)

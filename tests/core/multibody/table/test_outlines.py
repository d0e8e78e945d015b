"""Shapes that meet, against closed forms: ends of edges, corners of boxes under discs, overlaps."""

from __future__ import annotations

from math import acos, cos, sin, sqrt
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read

G = 9.81
FLOOR = {"kind": "contact", "name": "floor", "on": {"at": [0, 0]}}


def box(width: float, height: float, at: Any, **more: Any) -> dict[str, Any]:
    return {"mass": 1, "shape": {"kind": "box", "width": width, "height": height}, "at": at, **more}


def test_a_box_slides_off_the_end_of_a_plank() -> None:
    """With x = v t - mu g t^2/2: its corner is at the end, then the normal force is, at mu h/2 before the centre."""
    scene = {
        "gravity": [0, -G],
        "bodies": {"box": box(0.4, 0.2, [0, 0.3], velocity=[3, 0]), "plank": box(2, 0.2, [0, 0.1])},
        "connections": [
            {"kind": "contact", "name": "top", "a": "box", "b": "plank", "friction": 0.1},
            {**FLOOR, "place": "plank", "friction": 0.5},
        ],
    }
    answer = solve_scene(read(scene), [0.1, 0.3], ("forces-in-time", "trajectory"))
    assert kinds(answer)[:2] == [("lift-off", "top.2")]
    answer = solve_scene(read(scene), [0.3, 0.45], ("forces-in-time", "trajectory"))
    assert kinds(answer) == [("lift-off", "top.2"), ("lift-off", "top.1"), ("lift-off", "top.7")]
    for event, x in zip(answer.events, (0.8, 1 - 0.1 * 0.1), strict=False):
        expected = (3 - sqrt(9 - 4 * x * 0.05 * G)) / (0.1 * G)
        assert event.time == pytest.approx(expected, rel=4e-15)
    # The end of the plank (its third corner) has taken over from the corner of the box.
    assert column(answer, "top.2.normal").values[0] == 0.0
    seventh, total = (column(answer, f"top.{name}normal").values[0] for name in ("7.", ""))
    reach = 3 * 0.3 - 0.05 * G * 0.09
    assert total == pytest.approx(G, rel=1e-14)
    assert seventh == pytest.approx(G * (0.2 + 0.01) / (1 - (reach - 0.2)), rel=1e-13)


def test_a_disc_rolls_off_a_corner() -> None:
    """It leaves where m g cos = m v^2/r, of the energy of rolling about the corner: cos = (3/7)(4/3 + v0^2/(g r))."""
    scene = {
        "gravity": [0, -G],
        "bodies": {
            "disc": {"mass": 1, "shape": {"kind": "disc", "radius": 0.1}, "at": [0.15, 0.3], "velocity": [0.3, 0]},
            "box": box(0.4, 0.2, [0, 0.1]),
        },
        "connections": [
            {"kind": "contact", "name": "c", "a": "disc", "b": "box", "friction": 1e9},
            {"kind": "weld", "a": "box", "b": [0, 0]},
        ],
    }
    scene["bodies"]["disc"]["angular_velocity"] = -3  # type: ignore[index]
    answer = solve_scene(read(scene), [0.6])
    leaves = next(event for event in answer.events if event.kind == "lift-off")
    answer = solve_scene(read(scene), [leaves.time])
    angle = acos(3 / 7 * (4 / 3 + 0.09 / (G * 0.1)))
    expected = [0.2 + 0.1 * sin(angle), 0.2 + 0.1 * cos(angle)]
    # Before that it slips, where what its friction takes is 1e9 times its normal force.
    assert column(answer, "disc.position").values[0] == pytest.approx(expected, rel=1e-8)


def test_a_block_rocks_as_housner_says() -> None:
    """At every impact its rate falls to 1 - (3/2) sin^2 of the angle between its diagonal and its height.

    References
    ----------
    G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bulletin of the Seismological
    Society of America 53 (1963).
    """
    tilt = 0.05
    at = [f"0.1*cos({tilt}) - 0.5*sin({tilt})", f"0.1*sin({tilt}) + 0.5*cos({tilt})"]
    scene = {
        "gravity": [0, -G],
        "bodies": {"block": box(0.2, 1, at, angle=tilt)},
        "connections": [{**FLOOR, "place": "block", "friction": 10}],
    }
    times = np.array([0.01, 1.0])
    hit, other = [event.time for event in solve_scene(read(scene), times).events if event.kind == "touch"][:2]
    ratio = 1 - 1.5 * 0.2**2 / (0.2**2 + 1)
    rates = column(solve_scene(read(scene), [hit, np.nextafter(hit, 0)]), "block.angular_velocity").values
    assert rates[0] / rates[1] == pytest.approx(ratio, rel=1e-12)
    # Energy lost, from the heights of the tilted block: it turns back at a smaller tilt after it has gone up again.
    answer = solve_scene(read(scene), [(hit + other) / 2], ("trajectory",))
    assert column(answer, "block.angular_velocity").values[0] == pytest.approx(0, abs=1e-12)


def test_discs_collide_off_centre() -> None:
    """Each of two smooth discs takes (1 + e)/2 of the speed along the line between their centres."""
    disc = {"mass": 1, "shape": {"kind": "disc", "radius": 0.1}}
    scene = {
        "bodies": {"a": {**disc, "at": [0, 0], "velocity": [1, 0]}, "b": {**disc, "at": [1, 0.1]}},
        "connections": [{"kind": "contact", "name": "c", "a": "a", "b": "b", "restitution": 0.8}],
    }
    answer = solve_scene(read(scene), [2.0])
    (event,) = answer.events
    assert event.time == pytest.approx(1 - sqrt(0.03), rel=4e-16)
    n = np.array([sqrt(0.75), 0.5])
    assert column(answer, "b.velocity").values[0] == pytest.approx(0.9 * n[0] * n, rel=1e-14)


def test_overlaps_are_refused_with_their_depth() -> None:
    """Boxes that cross have no corner inside one another."""
    for b, depth in (({"at": [0.3, 0.15]}, "0.05"), ({"at": [0, 0], "angle": {"degrees": 90}}, "0.3")):
        scene = {
            "bodies": {"a": box(0.4, 0.2, [0, 0]), "b": {**box(0.4, 0.2, [0, 0]), **b}},
            "connections": [{"kind": "contact", "a": "a", "b": "b"}],
        }
        with pytest.raises(InvalidParameter, match=f"by {depth}$") as fault:
            solve_scene(read(scene))
        assert fault.value.path == ("connections", 0)


def test_what_is_not_answered_in_space_is_named() -> None:
    hollow = {"kind": "contact", "place": "c", "on": {"at": [0, 0, 0], "radius": -9}}
    shape = {"kind": "cylinder", "radius": 1, "height": 1}
    scene = {"bodies": {"c": {"mass": 1, "at": [0, 0, 3], "shape": shape}}, "connections": [hollow]}
    with pytest.raises(InvalidParameter, match="cylinder in space"):
        solve_scene(read(scene))


def test_a_box_in_space_falls_on_its_corners() -> None:
    """Four corners share its weight; it lands at sqrt(2 h/g)."""
    floor = {"kind": "contact", "name": "f", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    body = {"mass": 1, "at": [0, 0, 0.1], "shape": {"kind": "box", "width": 0.4, "height": 0.3, "depth": 0.2}}
    scene = {"gravity": [0, 0, -G], "bodies": {"b": body}, "connections": [{**floor, "friction": 0.3}]}
    answer = solve_scene(read(scene))
    assert answer.forces is not None
    assert answer.forces["f.normal"].value == pytest.approx(G, rel=1e-15)
    assert answer.forces["f.1.normal"].value is None


def test_a_smooth_box_tips_from_exact_balance() -> None:
    """Its centre passes the edge at 2 m/s, and from there on energy is kept: the edge is under the box, which turns."""
    scene = {
        "gravity": [0, -10],
        "bodies": {"box": box(0.5, 0.2, [1, 1.1], velocity=[2, 0]), "table": box(4, 1, [0, 0.5], mass=1000)},
        "connections": [
            {**FLOOR, "place": "table"},
            {"kind": "contact", "name": "g", "a": "box", "b": "table"},
        ],
    }
    answer = solve_scene(read(scene), [0.55], ("trajectory", "energy-in-time"))
    assert kinds(answer)[:2] == [("lift-off", "g.2"), ("lift-off", "g.1")]
    assert [event.time for event in answer.events[:2]] == [0.375, 0.5]
    angle = float(column(answer, "box.angle").values[0])
    assert angle < -1e-4
    # The corner of the table lies on the lower edge of the box.
    places = [column(answer, f"{name}.position").values[0] for name in ("box", "table")]
    x, y = places[0] - places[1] - [2, 0.5]
    assert cos(angle) * y - sin(angle) * x == pytest.approx(0.1, rel=1e-14)
    energy = sum(column(answer, f"energy.{kind}").values[0] for kind in ("kinetic", "potential"))
    assert energy == pytest.approx(2 + 11 + 5000, rel=1e-14)

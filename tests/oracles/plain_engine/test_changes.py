"""Connections that begin and end, and blows, in the plain engine beside closed forms."""

from __future__ import annotations

from typing import Any

import pytest

from core.multibody.language.reading import scene_from
from tests.oracles.plain_engine.motion import Motion, follow

BOB = {"gravity": [0, -10], "bodies": {"bob": {"mass": 2, "at": [1, 0]}}}


def followed(end: float, *connections: dict[str, Any], **scene: Any) -> Motion:
    return follow(scene_from({**BOB, **scene, "connections": list(connections)}), [0.0, end])


def happened(motion: Motion) -> list[tuple[str, str]]:
    return [(event.kind, event.name) for event in motion.events]


def test_a_rod_takes_its_length_and_the_speed_along_it_where_it_begins() -> None:
    begun = {"event": {"kind": "begin", "name": "r"}}
    motion = followed(1.2, {"kind": "rod", "name": "r", "a": "bob", "b": [0, 0], "from": 0.5, "until": begun})
    assert happened(motion) == [("begin", "r"), ("end", "r")]
    # At (1, -5/4) with (0, -5) the part across the rod is left.
    assert motion.states[1.2].rates == pytest.approx([-100 / 41, -80 / 41 - 7], rel=1e-12)


def test_a_blow_beside_a_hinge_turns_a_rod() -> None:
    # J l / (m l^2 / 3) = 6 rad/s; the hinge takes half of the blow at the end.
    rod = {"mass": 1, "inertia": "1/12", "at": [0.5, 0], "places": {"top": [-0.5, 0], "end": [0.5, 0]}}
    motion = followed(
        0.1,
        {"kind": "pin", "name": "hinge", "a": "rod.top", "b": [0, 0]},
        {"kind": "impulse", "name": "blow", "place": "rod.end", "impulse": [0, 2], "in": "body"},
        gravity=[0, 0],
        bodies={"rod": rod},
    )
    assert happened(motion) == [("impulse", "blow")]
    assert motion.states[0.1].rates[2] == pytest.approx(6, rel=1e-12)


def test_a_value_is_passed_twice_before_what_waits_for_the_second_time() -> None:
    # Up with 5 m/s and down again through 1 m at (5 + sqrt 5)/10 s; the force lifts it from there on.
    lift = {"kind": "force", "name": "lift", "place": "bob", "force": [0, 20]}
    bob = {"bob": {"mass": 2, "at": [1, 0], "velocity": [0, 5]}}
    when = {"when": {"quantity": "bob.position.y", "equals": 1, "nth": 2}}
    motion = followed(1.0, {**lift, "from": when}, bodies=bob)
    assert [event.time for event in motion.events] == pytest.approx([(5 + 5**0.5) / 10], rel=1e-12)
    assert motion.states[1.0].rates == pytest.approx([0, -(5**0.5)], rel=1e-12)


def test_a_floor_that_is_taken_away_by_its_touch_has_pushed() -> None:
    floor = {"kind": "contact", "name": "f", "place": "bob", "on": {"at": [0, -1.25]}, "restitution": 0.5}
    motion = followed(1.0, {**floor, "until": {"event": {"kind": "touch", "name": "f"}}})
    assert happened(motion) == [("touch", "f"), ("end", "f")]
    assert motion.states[1.0].rates == pytest.approx([0, 2.5 - 5], abs=1e-12)


def test_what_misses_its_place_cannot_begin() -> None:
    motion = followed(1.0, {"kind": "rod", "name": "r", "a": "bob", "b": [0, 0], "length": 3, "from": 0.5})
    assert motion.ended is not None
    assert (motion.ended.kind, motion.ended.name, motion.ended.time) == ("cannot-begin", "r", 0.5)

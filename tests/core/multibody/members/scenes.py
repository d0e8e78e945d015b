"""Scenes with numbers of which members have their own."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.members.many import ManyScenes
from core.multibody.members.recorded_balls import Varied

Places = Sequence[tuple[Any, ...]]


def double_pendulum() -> dict[str, Any]:
    """Two rods, of which the angles have names."""
    rod = {"mass": 1, "inertia": 0.08, "places": {"top": [-0.5, 0], "end": [0.5, 0]}}
    return {
        "gravity": [0, -9.81],
        "let": {"a": 0.5, "b": 1.0},
        "bodies": {
            "one": rod | {"at": ["cos(a)/2", "sin(a)/2"], "angle": "a"},
            "two": rod | {"at": ["cos(a)+cos(b)/2", "sin(a)+sin(b)/2"], "angle": "b"},
        },
        "connections": [
            {"kind": "pin", "a": "one.top", "b": [0, 0]},
            {"kind": "pin", "a": "two.top", "b": "one.end"},
        ],
    }


def sprung_pendulum() -> dict[str, Any]:
    """The same with a spring between the rods, and rates at the start."""
    found = double_pendulum()
    found["connections"].append({"kind": "torsion-spring", "a": "two", "b": "one", "stiffness": 3})
    found["bodies"]["one"]["angular_velocity"] = 1.0
    found["bodies"]["two"]["angular_velocity"] = -0.5
    return found


def with_numbers(description: Any, places: Places, numbers: Sequence[Any]) -> Any:
    """Return a description with numbers at some places."""
    # Numbers that stand for those of members are no JSON.
    copied = json.loads(json.dumps(description))
    for place, number in zip(places, numbers, strict=True):
        inner = copied
        for step in place[:-1]:
            inner = inner[step]
        inner[place[-1]] = number
    return copied


def many(description: Any, places: Places) -> ManyScenes:
    """Return what answers members of a scene."""

    def scene_of(numbers: Sequence[Any]) -> Scene:
        return scene_from(with_numbers(description, places, numbers))

    return ManyScenes(scene_of([Varied() for _ in places]), places, scene_of)

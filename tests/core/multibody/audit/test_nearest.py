"""The audit of assemblies: places beside the nearest, and off the connections, do not pass."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from core.multibody.assembly.assembled_scene import assembled
from core.multibody.audit.nearest import audited_assembly
from tests.core.multibody.worked_examples import read


def pendulum() -> Any:
    bar = {"mass": 2, "inertia": 0.5, "at": [0.5, 0.3], "angle": 1.1, "places": {"end": [-0.6, 0]}}
    pin = {"kind": "pin", "name": "hinge", "a": "bar.end", "b": [0, 0]}
    return read({"gravity": [0, -9.81], "assemble": "nearest", "bodies": {"bar": bar}, "connections": [pin]})


def at_angle(scene: Any, angle: float, length: float = 0.6) -> Any:
    place = (length * math.cos(angle), length * math.sin(angle))
    return replace(scene, bodies={"bar": replace(scene.bodies["bar"], at=place, angle=angle)})


def test_the_nearest_places_pass_and_others_do_not() -> None:
    sketch, found = pendulum(), assembled(pendulum())
    assert found.assembly is not None
    angle = found.assembly.bodies["bar"].angle
    assert angle is not None
    assert audited_assembly(sketch, found.scene) is None
    beside = audited_assembly(sketch, at_angle(found.scene, angle + 1e-6))
    assert beside is not None
    assert beside.law == "the places are the nearest"
    off = audited_assembly(sketch, at_angle(found.scene, angle, 0.6 + 1e-9))
    assert off is not None
    assert off.connection == "hinge"


def test_in_space_and_for_some_bodies_too() -> None:
    bob = {"mass": 1, "moments": [0.2, 0.3, 0.4], "at": [0.4, 0.2, -0.9], "places": {"top": [0.1, 0, 1]}}
    arm = {"mass": 1, "at": [0, 0, 0.3]}
    scene = read(
        {
            "gravity": [0, 0, -9.81],
            "assemble": {"nearest": ["bob"]},
            "bodies": {"arm": arm, "bob": bob},
            "connections": [{"kind": "ball-joint", "a": "bob.top", "b": "arm"}],
        }
    )
    found = assembled(scene).scene
    assert found.bodies["arm"] == scene.bodies["arm"]
    assert audited_assembly(scene, found) is None
    moved = replace(found.bodies["bob"], at=scene.bodies["bob"].at)
    failure = audited_assembly(scene, replace(found, bodies={**found.bodies, "bob": moved}))
    assert failure is not None
    assert failure.connection == "ball-joint-1"

"""Shapes in both engines: the second knows the distances of outlines, and neither corners that take over nor facets."""

from __future__ import annotations

from typing import Any

import pytest

from tests.oracles.plain_engine.comparison.comparing import compared

BOX = {"mass": 1, "shape": {"kind": "box", "width": 0.4, "height": 0.2}}
CAPSULE = {"mass": 2, "shape": {"kind": "capsule", "radius": 0.05, "length": 0.3}}
WEDGE = {"mass": 1, "shape": {"kind": "polygon", "corners": [[-0.2, -0.1], [0.2, -0.1], [0, 0.2]]}}


def pair(a: dict[str, Any], b: dict[str, Any], **more: Any) -> dict[str, Any]:
    contact = {"kind": "contact", "name": "c", "a": "a", "b": "b", **more}
    return {"bodies": {"a": a, "b": b}, "connections": [contact]}


COLLIDE = pair(
    {**BOX, "at": [0, 0], "velocity": [1, 0], "angular_velocity": 1},
    {**WEDGE, "at": [0.8, 0.1], "velocity": [-1, 0], "angle": "acos(3/5)"},
    friction=0.4,
    restitution=0.5,
)

GRAZES_THE_CAPS = pair(
    {**CAPSULE, "at": [0, 0.5], "angle": 0.4, "velocity": [0, -1]},
    {**CAPSULE, "at": [0.25, 0], "angle": {"degrees": 90}},
    restitution=0.3,
)


@pytest.mark.parametrize(("scene", "end"), [(COLLIDE, 0.5), (GRAZES_THE_CAPS, 0.6)])
def test_the_two_engines_agree_about_shapes(scene: dict[str, Any], end: float) -> None:
    verdict = compared(scene, [0.0, end / 2, end])
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0

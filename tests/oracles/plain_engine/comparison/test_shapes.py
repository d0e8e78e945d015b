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


FLOOR = {"name": "f", "place": "a", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
LEANS = [[1, 0, 0], [0, "-3/5", "4/5"], [0, "-4/5", "-3/5"]]


def on_a_plane(body: dict[str, Any], **connection: Any) -> dict[str, Any]:
    return {"gravity": [0, 0, -9.81], "bodies": {"a": body}, "connections": [FLOOR | connection]}


COIN_ROLLS = on_a_plane(
    {"mass": 1, "shape": {"kind": "disc", "radius": 0.5}, "at": [0, 0, 0.4], "axes": LEANS}
    | {"angular_velocity": [0.1, 1, 6]},
    kind="rolling",
)
CYLINDER_LANDS = on_a_plane(
    {"mass": 1, "shape": {"kind": "cylinder", "radius": 0.2, "height": 0.3}, "at": [0, 0, 0.5], "axes": LEANS}
    | {"angular_velocity": [0.3, 1, 2], "velocity": [1, 0, 0]},
    kind="contact",
    restitution=0.4,
)
CYLINDER = {"mass": 1, "shape": {"kind": "cylinder", "radius": 0.2, "height": 0.6}}
COIN_SLIDES = on_a_plane(
    {"mass": 1, "shape": {"kind": "disc", "radius": 0.2}, "at": [0, 0, 0]}
    | {"angular_velocity": [0, 0, 0], "velocity": [1, 0.5, 0]},
    kind="contact",
    friction=0.2,
)
CYLINDER_TIPS = on_a_plane(
    CYLINDER | {"at": [0, 0, 0.3], "angular_velocity": ["5/2", 0, 0], "velocity": [0, "-3/4", "1/2"]},
    kind="contact",
    friction=0.8,
)
CYLINDER_TUMBLES = on_a_plane(
    CYLINDER | {"at": [0, 0, 1], "angular_velocity": [0, 3, 0], "velocity": [0, 1, 0]}, kind="contact", restitution=0.4
)
EGG_SLIDES = on_a_plane(
    {"mass": 1, "shape": {"kind": "ellipsoid", "semi_axes": [0.1, 0.12, 0.15], "at": [0.01, 0, 0]}, "at": [0, 0, 0.15]}
    | {"moments": ["0.004", "0.005", "0.003"], "angular_velocity": [1, 2, 9], "velocity": [1, 0, 0.02]},
    kind="contact",
    friction=0.3,
)


@pytest.mark.parametrize(
    ("scene", "end"),
    [
        (COLLIDE, 0.5),
        (GRAZES_THE_CAPS, 0.6),
        (COIN_ROLLS, 0.5),
        (CYLINDER_LANDS, 0.4),
        (EGG_SLIDES, 0.05),
        (COIN_SLIDES, 1.0),
        (CYLINDER_TIPS, 0.2),
        (CYLINDER_TUMBLES, 0.5),
    ],
)
def test_the_two_engines_agree_about_shapes(scene: dict[str, Any], end: float) -> None:
    verdict = compared(scene, [0.0, end / 2, end])
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0

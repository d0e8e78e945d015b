"""Four-bar linkages by the conditions of Grashof, and their branches."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.multibody.assembly.assembled_scene import assembled
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


def linkage(crank: float, coupler: float, rocker: float, ground: float, rocker_up: bool = True) -> Any:
    def bar(length: float, x: float, y: float, degrees: float) -> dict[str, Any]:
        places = {"start": [-length / 2, 0], "end": [length / 2, 0]}
        return {"mass": 1, "inertia": 0.1, "at": [x, y], "angle": {"degrees": degrees}, "places": places}

    side = 1 if rocker_up else -1
    return read(
        {
            "gravity": [0, -9.81],
            "assemble": "nearest",
            "bodies": {
                "crank": bar(crank, 0, crank / 2, 90),
                "coupler": bar(coupler, coupler / 2, crank * (1 + side) / 2, 0 if rocker_up else -45),
                "rocker": bar(rocker, ground, side * rocker / 2, 90 * side),
            },
            "connections": [
                {"kind": "pin", "a": "crank.start", "b": [0, 0]},
                {"kind": "pin", "a": "coupler.start", "b": "crank.end"},
                {"kind": "pin", "a": "coupler.end", "b": "rocker.end"},
                {"kind": "pin", "a": "rocker.start", "b": [ground, 0]},
            ],
        }
    )


@pytest.mark.parametrize(
    ("lengths", "kind", "margin"),
    [
        ((1, 4, 3, 4), "crank-rocker", 2),
        ((4, 3, 1, 4), "crank-rocker", 2),
        ((3, 4, 4, 1), "double-crank", 2),
        ((3, 1, 3, 4), "double-rocker", 1),
        ((2, 2, 3, 4), "triple-rocker", -1),
        ((2, 3, 2, 3), "change-point", 0),
    ],
)
def test_linkages_are_named_by_the_link_that_turns_fully(lengths: Any, kind: str, margin: float) -> None:
    found = assembled(linkage(*lengths)).assembly
    assert found is not None
    assert found.four_bar is not None
    assert found.four_bar.kind == kind
    assert found.four_bar.margin == pytest.approx(margin, abs=found.four_bar.errors["margin"])
    assert sorted(found.four_bar.lengths) == pytest.approx(sorted(lengths), rel=1e-15)


def test_the_sketch_decides_the_branch() -> None:
    for up, branch in ((True, "open"), (False, "crossed")):
        found = assembled(linkage(1, 4, 3, 4, up)).assembly
        assert found is not None
        assert found.four_bar is not None
        assert found.four_bar.branch == branch


def test_rods_and_points_are_links_too_and_other_scenes_are_none() -> None:
    points = {"p": {"mass": 1, "at": [0, 1]}, "q": {"mass": 1, "at": [3, 1.4]}}
    rods = [
        {"kind": "rod", "name": "crank", "a": "p", "b": [0, 0], "length": 1},
        {"kind": "rod", "name": "coupler", "a": "p", "b": "q", "length": 3},
        {"kind": "rod", "name": "rocker", "a": "q", "b": [3, 0], "length": 2},
    ]
    scene = {"gravity": [0, -9.81], "assemble": "nearest", "bodies": points, "connections": rods}
    found = assembled(read(scene)).assembly
    assert found is not None
    assert found.four_bar is not None
    assert set(found.four_bar.links) == {"ground", "crank", "coupler", "rocker"}
    assert found.four_bar.kind == "crank-rocker"
    assert found.four_bar.margin == 1.0
    found = assembled(read(scene | {"connections": rods[:2]})).assembly
    assert found is not None
    assert found.four_bar is None


@pytest.mark.parametrize("degrees", [20, 60, 150, 300])
def test_what_follows_a_crank_is_where_two_circles_meet(degrees: int) -> None:
    """J. M. McCarthy, G. S. Soh, Geometric Design of Linkages (2011), chapter 2; the crank stays where it is given."""

    def bar(length: float, x: Any, y: Any, angle: Any) -> dict[str, Any]:
        places = {"start": [-length / 2, 0], "end": [length / 2, 0]}
        return {"mass": 1, "inertia": 0.1, "at": [x, y], "angle": angle, "places": places}

    def joint(angle: float) -> tuple[float, float]:
        p = (math.cos(angle), math.sin(angle))
        d = (4 - p[0], -p[1])
        square = d[0] ** 2 + d[1] ** 2
        along = (square + 16 - 9) / (2 * square)
        across = math.sqrt(16 / square - along**2)
        return p[0] + along * d[0] - across * d[1], p[1] + along * d[1] + across * d[0]

    scene = {
        "gravity": [0, -9.81],
        "assemble": {"nearest": ["coupler", "rocker"]},
        "let": {"start": f"{degrees}*pi/180"},
        "bodies": {
            "crank": bar(1, "cos(start)/2", "sin(start)/2", "start"),
            "coupler": bar(4, 2.5, 1.6, 0.3),
            "rocker": bar(3, 4.5, 1.3, 1.4),
        },
        "connections": [
            {"kind": "pin", "a": "crank.start", "b": [0, 0]},
            {"kind": "pin", "a": "coupler.start", "b": "crank.end"},
            {"kind": "pin", "a": "coupler.end", "b": "rocker.end"},
            {"kind": "pin", "a": "rocker.start", "b": [4, 0]},
        ],
    }
    found = solve_scene(read(scene), [0.0, 0.2])
    assert found.assembly is not None
    assert found.assembly.bodies["crank"].moved == 0.0
    angles, places = column(found, "crank.angle").values, column(found, "rocker.position").values
    for angle, place in zip(angles, places, strict=True):
        x, y = joint(float(angle))
        assert place == pytest.approx(((x + 4) / 2, y / 2), abs=1e-12)

"""Scenes that are turned in space as a whole have the same models, periods and motions."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, is_zero
from core.multibody.reduction.turned_axes import plane_axes, spans_plane, vertical_axes
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

Vector = list[Any]

PIN = {"kind": "pin", "a": "b.p", "b": [0.5, 0, 0]}
RIGID = {"mass": 1, "moments": [0.15, 0.2, 0.25], "at": [0, 0, 0], "places": {"p": [0.5, 0, 0], "q": [0, 0.3, 0.4]}}
SCENES: dict[str, dict[str, Any]] = {
    # Each moves in a plane, along a line or about a vertical.
    "rigid pendulum": {"bodies": {"b": RIGID}, "connections": [PIN]},
    "hinge": {"bodies": {"b": RIGID}, "connections": [PIN | {"axis": ["2/3", "1/3", "2/3"]}]},
    "pendulum on a line": {
        "bodies": {"a": {"mass": 1, "at": [0, 0, 0]}, "b": {"mass": 2, "at": [0.6, 0, -0.8]}},
        "connections": [
            {"kind": "track", "place": "a", "on": {"at": [0, 0, 0], "direction": [1, 0, 0]}},
            {"kind": "rod", "a": "a", "b": "b"},
        ],
    },
    "level pendulum": {
        "bodies": {"b": {"mass": 1, "at": [1, 0, 0]}},
        "connections": [{"kind": "rod", "a": "b", "b": [0, 0, 0]}],
    },
    "conical pendulum": {
        "bodies": {"b": {"mass": 1, "at": [0.6, 0, -0.8], "velocity": [0, 1.5, 0]}},
        "connections": [{"kind": "rod", "a": "b", "b": [0, 0, 0]}],
    },
    "spherical pendulum": {
        "bodies": {"b": {"mass": 1, "at": [0.6, 0, -0.8], "velocity": [0, 3, 0]}},
        "connections": [{"kind": "rod", "a": "b", "b": [0, 0, 0]}],
    },
    "top": {
        "bodies": {
            "b": {
                "mass": 1,
                "moments": [0.2, 0.2, 0.1],
                "at": [0.6, 0, 0.8],
                "axes": [[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]],
                "angular_velocity": [0, 0, 40],
                "places": {"p": [0, 0, -1]},
            }
        },
        "connections": [{"kind": "pin", "a": "b.p", "b": [0, 0, 0]}],
    },
    "on a slope": {
        "bodies": {"b": {"mass": 1, "at": [0, 0, 0]}},
        "connections": [{"kind": "track", "place": "b", "on": {"at": [0, 0, 0], "normal": [0.6, 0, 0.8]}}],
    },
}
Turn = tuple[tuple[str, str, str], ...]
TURNS: list[Turn] = [
    (("0.6", "-0.8", "0"), ("0.8", "0.6", "0"), ("0", "0", "1")),
    (("5/13", "0", "12/13"), ("0", "1", "0"), ("-12/13", "0", "5/13")),
    (("2/3", "-1/3", "2/3"), ("2/3", "2/3", "-1/3"), ("-1/3", "2/3", "2/3")),
]


def turned_vector(turn: Turn, vector: Vector) -> list[str]:
    return [" + ".join(f"({a})*({x})" for a, x in zip(row, vector, strict=True)) for row in turn]


def turned_scene(scene: dict[str, Any], turn: Turn) -> dict[str, Any]:
    made = copy.deepcopy(scene) | {"gravity": turned_vector(turn, [0, 0, -10])}
    for body in made["bodies"].values():
        for name in ("at", "velocity"):
            if name in body:
                body[name] = turned_vector(turn, body[name])
        if "moments" in body:
            axes = body.get("axes", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
            body["axes"] = [turned_vector(turn, axis) for axis in axes]
    for connection in made["connections"]:
        for name in ("b", "axis"):
            if isinstance(connection.get(name), list):
                connection[name] = turned_vector(turn, connection[name])
        if "on" in connection:
            connection["on"] = {name: turned_vector(turn, vector) for name, vector in connection["on"].items()}
    return made


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_turned_in_space_has_the_same_model_period_and_motion(name: str, turn: Turn) -> None:
    times, scene = [0.15, 0.4, 1.1], SCENES[name]
    first = solve_scene(read(scene | {"gravity": [0, 0, -10]}), times, ("trajectory",))
    second = solve_scene(read(turned_scene(scene, turn)), times, ("trajectory",))
    assert first.model.name == second.model.name
    assert first.model.degrees_of_freedom == second.model.degrees_of_freedom
    assert (first.period is None) == (second.period is None)
    assert first.model.name != "Taylor series"
    if first.period is not None:
        assert first.period == pytest.approx(second.period, rel=1e-14)
    matrix = np.array([[float(arb(x.split("/")[0]) / arb((x + "/1").split("/")[1])) for x in row] for row in turn])
    here, there = (column(one, "b.position") for one in (first, second))
    apart = np.abs(np.asarray(here.values) @ matrix.T - np.asarray(there.values))
    assert np.max(apart) <= np.max(here.error) + np.max(there.error) + 1e-15


def test_axes_are_the_normal_of_the_plane_and_the_vertical_in_it() -> None:
    with precision(BITS):
        flat = [[arb(3), arb(4), arb(0)], [arb(0), arb(0), arb(2)], [arb(6), arb(8), arb(5)]]
        axes = plane_axes(flat, [ZERO, ZERO, -ONE])
        assert axes is not None
        assert all(is_zero(sum((x * y for x, y in zip(axes[0], v, strict=True)), ZERO)) for v in flat)
        assert [float(x) for x in axes[2]] == [0, 0, 1]


@pytest.mark.parametrize(
    "moving", [[], [[1, 0, 0]], [[1, 0, 0], [0, 0, 1]], [[1, 2, 3], [1, 0, 0], [0, 1, 0]]], ids=str
)
def test_axes_stay_where_no_others_are_better(moving: list[list[int]]) -> None:
    with precision(BITS):
        assert plane_axes([[arb(x) for x in vector] for vector in moving], [ZERO, ZERO, -ONE]) is None


def test_the_vertical_is_an_axis_where_it_is_oblique() -> None:
    with precision(BITS):
        assert vertical_axes([ZERO, ZERO, -ONE]) is None
        assert vertical_axes([ZERO, ZERO, ZERO]) is None
        axes = vertical_axes([arb(-3), ZERO, arb(-4)])
        assert axes is not None
        assert [float(x) for x in axes[2]] == [0.6, 0.0, 0.8]


def test_vectors_on_a_line_span_no_plane() -> None:
    assert not spans_plane([[arb(1), arb(2), arb(3)], [ZERO, ZERO, ZERO], [arb(-2), arb(-4), arb(-6)]])
    assert spans_plane([[arb(1), arb(2), arb(3)], [arb(-2), arb(-4), arb(6)]])

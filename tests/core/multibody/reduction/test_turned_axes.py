"""Scenes that are turned in space as a whole have the same models, periods and motions."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.errors import MechanicsError
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, is_zero
from core.multibody.reduction.turned_axes import line_axes, plane_axes, spans_plane, vertical_axes
from core.multibody.solve import solve_scene
from tests.core.multibody.relations.geometry import dimension, turned
from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.relations import OF_OUTPUTS
from tests.core.multibody.relations.sources import catalogue, random_scene
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
    (("0", "1", "0"), ("0", "0", "1"), ("1", "0", "0")),
    (("1", "0", "0"), ("0", "-1", "0"), ("0", "0", "-1")),
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
    # The angle of precession counts about the upward vertical.
    windings = [[part.precession or 0.0 for part in one.model.apart] for one in (first, second)]
    assert windings[0] == pytest.approx(windings[1], rel=1e-13)
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


def test_the_vertical_of_the_plane_is_its_second_axis() -> None:
    with precision(BITS):
        assert vertical_axes([ZERO, -ONE]) is None
        axes = vertical_axes([arb(3), arb(-4)])
        assert axes is not None
        assert [[float(x) for x in axis] for axis in axes] == [[0.8, 0.6], [-0.6, 0.8]]


@pytest.mark.parametrize("changes", [[], [[0, 0]], [[0, 2]], [[1, 2], [2, 1]], [[1, 2, 3], [1, 2, 4]]], ids=str)
def test_no_line_has_its_own_axes(changes: list[list[int]]) -> None:
    with precision(BITS):
        assert line_axes([[arb(x) for x in vector] for vector in changes]) is None


@pytest.mark.parametrize("changes", [[[3, 4], [0, 0], [-6, -8]], [[2, 0, 1], [0, 0, 0], [4, 0, 2]]], ids=str)
def test_the_first_axis_is_along_a_line(changes: list[list[int]]) -> None:
    with precision(BITS):
        axes = line_axes([[arb(x) for x in vector] for vector in changes])
        assert axes is not None
        assert len(axes) == len(changes[0])
        assert all(is_zero(sum((x * y for x, y in zip(axis, changes[0], strict=True)), ZERO)) for axis in axes[1:])


def model_of(request: Json) -> tuple[str, ...]:
    """Return the model of a scene, or why it has none."""
    scene = {key: request[key] for key in OF_OUTPUTS if key in request}
    try:
        return (solve_scene(read(scene), (), ("accelerations",)).model.name,)
    except MechanicsError as refused:
        return (type(refused).__name__, str(refused)[:60])


@pytest.mark.parametrize("about", [2, 0])
@pytest.mark.parametrize("source", ["the catalogue", "200 random scenes"])
def test_scenes_turned_by_3_4_5_have_the_models_of_the_upright_ones(source: str, about: int) -> None:
    scenes = catalogue() if source == "the catalogue" else {str(seed): random_scene(seed) for seed in range(700, 900)}
    found: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {}
    for name, request in scenes.items():
        made = turned(request, about=about) if about == 2 or dimension(request) == 3 else None
        if made is not None:
            found[name] = (model_of(request), model_of(made.request))
    assert len(found) > 20
    assert {name: models for name, models in found.items() if models[0] != models[1]} == {}


LINES: dict[str, dict[str, Any]] = {
    # What moves along a line in the plane, each body along its own, without gravity to show a direction.
    "spring and damper": {
        "bodies": {"a": {"mass": 1, "at": [0.6, 0.8]}},
        "connections": [
            {"kind": "spring", "a": "a", "b": [0, 0], "stiffness": 4, "rest_length": 2},
            {"kind": "damper", "a": "a", "b": [0, 0], "coefficient": 1},
        ],
    },
    "string over two pegs": {
        "bodies": {"a": {"mass": 1, "at": [0.6, 0.8]}, "b": {"mass": 2, "at": ["1+5/13", "12/13"]}},
        "connections": [
            {"kind": "string", "through": ["a", [0, 0], [1, 0], "b"]},
            {"kind": "force", "place": "a", "force": [3, 4]},
            {"kind": "force", "place": "b", "force": [5, 12]},
        ],
    },
    "bar that does not turn": {
        "bodies": {
            "a": {"mass": 1, "inertia": 0.1, "at": [0.6, 0.8], "angle": "acos(0.6)", "places": {"p": [-0.5, 0]}}
        },
        "connections": [{"kind": "spring", "a": "a.p", "b": [0, 0], "stiffness": 4, "rest_length": 0.2}],
    },
}


@pytest.mark.parametrize("name", LINES)
def test_what_moves_along_an_oblique_line_is_linear(name: str) -> None:
    answer = solve_scene(read(LINES[name]), [0.2, 0.4], ("trajectory",))
    assert answer.model.name in ("modes", "constant acceleration")

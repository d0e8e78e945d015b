"""Descriptions that cannot be: each refused with the path to the fault, none with anything else."""

from __future__ import annotations

import re
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import pytest

from core.errors import InvalidParameter
from core.multibody.language.body import SceneBody
from core.multibody.language.joints import Rod
from core.multibody.language.kinds import KINDS
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene

BODY = {"mass": 1, "at": [0, -1]}
PAIR = {"p": BODY, "q": {"mass": 1, "at": [1, -1]}}
ROD = {"kind": "rod", "a": "p", "b": [0, 0]}
SPACE: dict[str, Any] = {"gravity": [0, 0, -1]}


def joined(**connection: Any) -> dict[str, Any]:
    return {"gravity": [0, -9.81], "bodies": PAIR, "connections": [connection]}


def pendulum(**changed: Any) -> dict[str, Any]:
    return {"gravity": [0, -9.81], "bodies": {"p": BODY}, "connections": [ROD], **changed}


def solid(**changed: Any) -> dict[str, Any]:
    return {**SPACE, "bodies": {"p": {"mass": 1, "at": [0, 0, 0], "moments": [1, 1, 1], **changed}}}


FAULTS: list[tuple[Any, tuple[str | int, ...]]] = [
    (None, ("scene",)),
    ([], ("scene",)),
    ({}, ("bodies",)),
    ({"bodies": {}}, ("bodies",)),
    ({"bodies": [1]}, ("bodies",)),
    ({"bodies": {"p": 3}}, ("bodies", "p")),
    ({"bodies": {f"b{i}": BODY for i in range(101)}}, ("bodies",)),
    (pendulum(connections=[ROD] * 10_000), ("connections",)),
    (pendulum(connections="x"), ("connections",)),
    (pendulum(connections={}), ("connections",)),
    (pendulum(connections=[3]), ("connections", 0)),
    (pendulum(colour=1), ("colour",)),
    ({"bodies": {"../etc/passwd": BODY}}, ("bodies", "../etc/passwd")),
    ({"bodies": {"a.b": BODY}}, ("bodies", "a.b")),
    ({"bodies": {"ground": BODY}}, ("bodies", "ground")),
    ({"bodies": {"": BODY}}, ("bodies", "")),
    ({"bodies": {"p": {**BODY, "places": {"a/b": [0, 0]}}}}, ("bodies", "p", "places", "a/b")),
    ({"bodies": {"p": {**BODY, "places": [1]}}}, ("bodies", "p", "places")),
    (joined(a="p"), ("connections", 0, "kind")),
    (joined(kind="glue"), ("connections", 0, "kind")),
    (joined(kind=[1]), ("connections", 0, "kind")),
    (joined(kind="contact", place="p"), ("connections", 0)),
    (joined(kind="contact", a="p", b="q"), ("connections", 0)),
    (joined(kind="contact", place="p", on={"at": [0, 5], "slope": 0}), ("connections", 0)),
    (joined(kind="contact", place="p", on={"slope": 0}), ("connections", 0, "on", "at")),
    (joined(kind="contact", place="p", on={"at": "p"}), ("connections", 0, "on", "at")),
    (joined(kind="contact", place="p", on={"at": [0, -2]}, friction=-1), ("connections", 0, "friction")),
    (joined(kind="contact", place="p", on={"at": [0, -2]}, friction=[0.1, 0.2]), ("connections", 0, "friction", 1)),
    (joined(kind="contact", place="p", on={"at": [0, -2]}, restitution=2), ("connections", 0, "restitution")),
    (joined(kind="contact", measure="turn", a="p", at_most=1), ("connections", 0, "a")),
    (joined(kind="contact", measure="turn", at_most=1), ("connections", 0, "a")),
    (joined(kind="contact", measure="gap", at_most=1, place="p", on={"at": [0, -2]}), ("connections", 0, "at_most")),
    (joined(kind="shove"), ("connections", 0, "kind")),
    (joined(kind="rod", a="p"), ("connections", 0, "b")),
    (joined(kind="rod", a="p", b=[0, 0], friction=0.1), ("connections", 0, "friction")),
    (joined(kind="rod", a="p", b=[0, 0], name=5), ("connections", 0, "name")),
    (joined(kind="rod", a="p", b=[0, 0], name="p"), ("connections", 0, "name")),
    (pendulum(connections=[{**ROD, "name": "r"}, {**ROD, "name": "r"}]), ("connections", 1, "name")),
    (joined(kind="rod", a="x", b=[0, 0]), ("connections", 0, "a")),
    (joined(kind="pin", a="p.x", b=[0, 0]), ("connections", 0, "a")),
    (joined(kind="pin", a=5, b=[0, 0]), ("connections", 0, "a")),
    (joined(kind="pin", a=None, b=[0, 0]), ("connections", 0, "a")),
    (joined(kind="pin", a={"x": 1}, b=[0, 0]), ("connections", 0, "a")),
    (joined(kind="pin", a="p", b="ground"), ("connections", 0, "b")),
    (joined(kind="rod", a="p", b="p"), ("connections", 0)),
    (joined(kind="pin", a="p", b="p"), ("connections", 0)),
    (joined(kind="rod", a=[0, 0], b=[1, 0]), ("connections", 0)),
    (joined(kind="rod", a="p", b=[0, -1]), ("connections", 0, "length")),
    (joined(kind="rod", a="p", b=[0, 0], length=2), ("connections", 0, "length")),
    (joined(kind="pin", a="p", b=[0, 0]), ("connections", 0)),
    (joined(kind="string", through=["p"]), ("connections", 0, "through")),
    (joined(kind="string", through=5), ("connections", 0, "through")),
    (joined(kind="string", through=[[0, 0], [1, 0]]), ("connections", 0, "through")),
    (joined(kind="string", through=["p", "p"]), ("connections", 0)),
    (joined(kind="string", through=["p", [0, 0]], sides={"p": "left"}), ("connections", 0, "sides", "p")),
    (joined(kind="string", through=["p", [0, 0]], slips=5), ("connections", 0, "slips")),
    (joined(kind="spring", a="p", b=[0, 0], stiffness=-1), ("connections", 0, "stiffness")),
    (joined(kind="spring", a="p", b=[0, -1], stiffness=1), ("connections", 0)),
    (joined(kind="motor", a="p", rate=1), ("connections", 0, "a")),
    (joined(kind="motor", a="p", b="p", rate=1), ("connections", 0, "b")),
    (joined(kind="damper", a="p", coefficient=1), ("connections", 0, "b")),
    (joined(kind="damper", a="p", b=[0, 0], coefficient=1, measure="x"), ("connections", 0, "measure")),
    (joined(kind="rolling"), ("connections", 0)),
    (joined(kind="rolling", place="p", on={"at": [0, 0]}), ("connections", 0, "place")),
    (joined(kind="track", place="p", on={}), ("connections", 0, "on", "at")),
    (joined(kind="track", place="p", on=5), ("connections", 0, "on", "at")),
    (joined(kind="track", place="p", on={"at": "p"}), ("connections", 0, "on", "at")),
    (joined(kind="track", place="p", on={"at": [0, 0], "x": 1}), ("connections", 0, "on")),
    (joined(kind="track", place="p", on={"at": [0, 0], "radius": -1}), ("connections", 0, "on", "radius")),
    (joined(kind="slider", a="p", b=[0, 0], direction=[0, 0]), ("connections", 0, "direction")),
    (joined(kind="spinning-frame", rate=1, about="x"), ("connections", 0, "about")),
    (joined(kind="force", place=[0, 0], force=[1, 0]), ("connections", 0, "place")),
    (joined(kind="force", place="p", force=[1, 0, 0]), ("connections", 0, "force")),
    (joined(kind="torque", body="p", torque=1), ("connections", 0, "body")),
    (joined(kind="torque", body=[1], torque=1), ("connections", 0, "body")),
    (pendulum(gravity=[0, float("nan")]), ("gravity", 1)),
    (pendulum(gravity=[0, float("inf")]), ("gravity", 1)),
    (pendulum(gravity=[True, 0]), ("gravity", 0)),
    (pendulum(gravity=[0, 10**10000]), ("gravity", 1)),
    (pendulum(gravity="down"), ("gravity",)),
    (pendulum(gravity=[0, 0, 0, 1]), ("gravity",)),
    (pendulum(gravity=[0, 0, -9.81]), ("bodies", "p", "at")),
    ({"bodies": {"p": {"mass": -1, "at": [0, 0]}}}, ("bodies", "p", "mass")),
    ({"gravity": [0, -1], "bodies": {"p": {"mass": 0, "at": [0, 0]}}}, ("bodies", "p")),
    ({"gravity": [0, -1], "bodies": {"p": {"mass": 1, "inertia": 0, "at": [0, 0]}}}, ("bodies", "p")),
    ({"bodies": {"p": {"mass": 1, "at": {"polar": [1]}}}}, ("bodies", "p", "at", "polar")),
    ({"gravity": [0, -1], "bodies": {"p": {**BODY, "moments": [1, 1, 1]}}}, ("bodies", "p", "moments")),
    ({"bodies": {"p": {**BODY, "velocity": [0, 1]}}, "connections": [ROD]}, ("bodies", "p", "velocity", 1)),
    (solid(moments=[1, 1, 3]), ("bodies", "p", "moments")),
    (solid(moments=None, tensor=[[1, 0, 0.1], [0, 1, 0], [0, 0, 1]]), ("bodies", "p", "tensor")),
    (solid(axes=[[1, 0, 0], [1, 0, 0], [0, 0, 1]]), ("bodies", "p", "axes")),
    (solid(axes=[[1, 0, 0], [0, 1, 0], [0, 0, -1]]), ("bodies", "p", "axes")),
    (solid(moments=None, mass=None, body={"kind": "x"}), ("bodies", "p", "body")),
]


@pytest.mark.parametrize(("description", "path"), FAULTS, ids=range(len(FAULTS)))
def test_faults_are_reported_with_their_path(description: Any, path: tuple[str | int, ...]) -> None:
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(scene_from(description), [0.1])
    assert refused.value.path == path
    assert len(str(refused.value)) < 500


def test_two_motors_contradict_each_other_by_name() -> None:
    disc = {"mass": 1, "inertia": 1, "at": [0, 0]}
    motors = [{"kind": "motor", "a": "d", "rate": rate} for rate in (1, 2)]
    with pytest.raises(InvalidParameter, match="motor-2") as refused:
        solve_scene(scene_from({"bodies": {"d": disc}, "connections": motors}))
    assert refused.value.path == ("connections", 1)


def test_a_mismatch_says_by_how_much() -> None:
    with pytest.raises(InvalidParameter, match=r"misses them by 1 "):
        solve_scene(scene_from(joined(kind="pin", a="p", b=[0, 0])))


def test_a_contradicted_velocity_says_what_follows() -> None:
    bodies = {"p": {**BODY, "velocity": [3, 0.5]}}
    with pytest.raises(InvalidParameter, match="from which 0 follows"):
        solve_scene(scene_from({"bodies": bodies, "connections": [ROD]}))


def test_a_hundred_bodies_and_their_connections_in_a_ring_are_read() -> None:
    count = 30
    let = {f"x{i}": f"cos({i}*pi/15)" for i in range(count)} | {f"y{i}": f"sin({i}*pi/15)" for i in range(count)}
    bodies = {f"b{i}": {"mass": 1, "at": [f"x{i}", f"y{i}"]} for i in range(count)}
    ring = [{"kind": "rod", "a": f"b{i}", "b": f"b{(i + 1) % count}"} for i in range(count)]
    answer = solve_scene(scene_from({"let": let, "bodies": bodies, "connections": ring}))
    assert answer.model.name == "rest"
    assert answer.model.mobility == 2 * count - count


def test_the_catalogue_names_every_kind_once() -> None:
    assert all(kind == cls.kind for kind, cls in KINDS.items())


def test_dataclasses_and_json_say_the_same() -> None:
    built = Scene({"p": SceneBody(mass=1, at=[0, -1])}, (Rod(a="p", b=[0, 0]),), [0, -9.81])
    assert built == scene_from(pendulum(connections=(ROD,)))
    assert built.names() == ("rod-1",)


def test_the_guide_has_every_kind_of_connection_with_its_fields() -> None:
    guide = (Path(__file__).parents[4] / "docs" / "describing-scenes.md").read_text(encoding="utf-8")
    guide = guide.split("## Kinds of connections\n")[1].split("\n## ")[0]
    rows = dict(re.findall(r"^\| `([\w-]+)` \| ([^|]+) \|", guide, re.MULTILINE))
    assert set(rows) == set(KINDS)
    for kind, connection in KINDS.items():
        required = {f.name for f in fields(connection) if f.default is MISSING and f.default_factory is MISSING}
        written = {name for group in re.findall(r"`([^`]+)`", rows[kind]) for name in re.findall(r"\w+", group)}
        assert required <= written, kind
        assert written <= {f.name.rstrip("_") for f in fields(connection)}, kind


@pytest.mark.parametrize("let", [5, "x", [1], True])
def test_names_that_are_no_object_are_refused(let: object) -> None:
    with pytest.raises(InvalidParameter, match="let must be an object of names and numbers"):
        scene_from({"let": let, "bodies": {"a": {"mass": 1, "at": [0, 0]}}})

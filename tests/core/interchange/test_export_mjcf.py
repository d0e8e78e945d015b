"""The catalogue as MJCF: read back it is the same scene, and MuJoCo, where it is installed, moves it likewise."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from core.interchange.export_mjcf import export_mjcf
from core.interchange.import_model import import_model
from core.interchange.left_out import LeftOutOfScene
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from service.routes.scene_catalogue import scene_catalogue
from tests.core.interchange.answers import accelerations, imported

FIELDS = [entry.name for entry in fields(Scene)]

SAME = (
    *("atwood-machine", "atwood-machine-with-spring", "blocks-on-incline", "movable-wedge", "simple-pendulum"),
    *("physical-pendulum", "spherical-pendulum", "conical-pendulum", "double-pendulum", "double-pendulum-of-points"),
    *("pendulum-on-cart", "elastic-pendulum", "coupled-pendulums", "swinging-atwood-machine", "block-and-tackle"),
    *("inverted-pendulum-on-torsion-spring", "plank-on-two-strings", "trammel", "four-bar-linkage", "rod-in-cylinder"),
    *("lagrange-top", "precessing-top", "sleeping-top", "gyroscope-with-offset-mass", "kovalevskaya-top"),
    *("asymmetric-top", "dumbbell", "vibrating-dumbbell", "harmonic-ellipse", "two-masses-two-springs"),
    *("damped-oscillator", "weight-under-table", "thrown-body", "loop-with-slack-string", "pendulum-timed"),
)
"""Scenes of the catalogue of which MJCF says everything, and so does what is read of it."""

AT_REST = (
    *("atwood-machine", "atwood-machine-with-spring", "blocks-on-incline", "movable-wedge", "simple-pendulum"),
    *("physical-pendulum", "double-pendulum", "double-pendulum-of-points", "pendulum-on-cart", "block-and-tackle"),
    *("coupled-pendulums", "swinging-atwood-machine", "inverted-pendulum-on-torsion-spring", "plank-on-two-strings"),
    *("trammel", "four-bar-linkage", "loaded-hoop", "cylinder-on-incline", "spool-winds-up", "spool-rolls-away"),
)
"""Scenes that MuJoCo begins like these: in motion it leaves the curvature of soft constraints to the steps after."""

IN_TREES = ("lagrange-top", "precessing-top", "gyroscope-with-offset-mass", "kovalevskaya-top", "double-pendulum")
"""Scenes without soft constraints."""


def question(name: str) -> dict[str, Any]:
    return {key: value for key, value in scene_catalogue()[name].question.items() if key in FIELDS}


@cache
def exported(name: str) -> tuple[str, list[LeftOutOfScene]]:
    return export_mjcf(scene_from(question(name)))


def test_every_scene_of_the_catalogue_is_written_or_says_what_is_left_out() -> None:
    whole = [name for name in scene_catalogue() if not any(one.changes_motion for one in exported(name)[1])]
    assert set(SAME) <= set(whole)
    # These need coordinates that are tied, which are not read back, and constant forces, which are actuators there.
    assert set(whole) - set(SAME) == {"loaded-hoop", "cylinder-on-incline"}


@pytest.mark.parametrize("name", SAME)
def test_what_is_read_back_begins_as_the_scene_does(name: str) -> None:
    back, found = imported(exported(name)[0])
    assert not any(one.changes_motion for one in back.left_out)
    ours = accelerations(question(name))
    largest = max(float(np.abs(one).max()) for one in ours.values())
    assert {*found} == {*ours}
    for body, one in ours.items():
        assert found[body] == pytest.approx(one, abs=1e-13 * (1.0 + largest)), body


@pytest.mark.parametrize("name", dict.fromkeys((*AT_REST, *IN_TREES)))
def test_mujoco_begins_as_the_scene_does(name: str) -> None:
    """To rounding where joints are a tree, else to what its soft constraints give way."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(exported(name)[0])
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)
    ours = accelerations(question(name))
    largest = max(float(np.abs(one).max()) for one in ours.values())
    for body, one in ours.items():
        read, i = np.zeros(6), mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
        mujoco.mj_objectAcceleration(model, data, mujoco.mjtObj.mjOBJ_BODY, i, read, 0)
        within = 1e-13 if name in IN_TREES else 4e-3
        assert read[3:] + model.opt.gravity == pytest.approx(one, abs=within * (1.0 + largest)), body


def test_what_has_no_element_is_left_out_with_its_pointer() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "disc": {"mass": 1, "inertia": 0.005, "radius": 0.1, "at": [0, -1]},
            "bob": {"mass": 2, "at": [1, 0]},
        },
        "connections": [
            {"kind": "string", "name": "s", "through": [[-0.1, 0], "disc"], "sides": {"disc": "left"}},
            {"kind": "spring", "name": "k", "a": "bob", "b": [0, 0], "law": "stretch^3", "rest_length": 1},
            {"kind": "force", "name": "f", "place": "bob", "force": ["sin(t)", 0]},
            {"kind": "gravitation", "name": "g", "a": "bob", "b": "disc"},
        ],
    }
    _, left_out = export_mjcf(scene_from(scene))
    assert [(one.pointer, one.what) for one in left_out] == [
        ("/connections/0", "s"),
        ("/connections/1", "k"),
        ("/connections/2", "f"),
        ("/connections/3", "g"),
    ]


def test_a_coefficient_of_sticking_beside_that_of_sliding_is_left_out() -> None:
    for friction, said in (([0.9, 0.2], True), ([0.2, 0.2], False), (0.2, False)):
        scene = {
            "gravity": [0, 0, -9.81],
            "bodies": {"ball": {"mass": 1, "at": [0, 0, 0.1], "shape": {"kind": "ball", "radius": 0.1}}},
            "connections": [
                {"kind": "contact", "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": friction}
            ],
        }
        text, left_out = export_mjcf(scene_from(scene))
        assert 'friction="0.2 0.2 0 0 0"' in text
        assert ("/connections/0/friction/0" in [one.pointer for one in left_out]) is said


def test_names_and_numbers_are_those_of_the_scene() -> None:
    text, _ = exported("double-pendulum")
    assert '<body name="two" pos="' in text
    assert 'diaginertia="0.0833 0.0833 0.0833"' in text


MOMENTS = {"moments": [1, 1, 1]}


def test_joints_have_names_of_their_own() -> None:
    """The joints of a free particle `a`, which are three, beside that of a body `a-1`."""
    for order in (1, -1):
        bodies = {"a": {"mass": 1, "at": [0, 0, 3]}, "a-1": {"mass": 1, "at": [2, 0, 0], **MOMENTS}}
        slider = {"kind": "slider", "a": "a-1", "b": [2, 0, 0], "direction": [1, 0, 0]}
        text, _ = export_mjcf(scene_from({"bodies": dict([*bodies.items()][::order]), "connections": [slider]}))
        names = [one.get("name") for one in ElementTree.fromstring(text).iter("joint")]
        assert len(names) == len(set(names)) == 4


def test_a_body_called_world_is_not_the_ground() -> None:
    """Ends of a loop name it too: a ring of two bodies."""
    bodies = {name: {"mass": 1, "at": [k, 0, 0], **MOMENTS} for k, name in enumerate(("world", "b"))}
    pins = [{"kind": "pin", "a": "world", "b": "b.p", "axis": [0, 0, 1]}, {"kind": "weld", "a": "b", "b": "world"}]
    bodies["b"]["places"] = {"p": [-1, 0, 0]}
    text, left_out = export_mjcf(scene_from({"bodies": bodies, "connections": pins}))
    assert (left_out[0].pointer, left_out[0].changes_motion) == ("/bodies/world", False)
    assert set(import_model(text).scene["bodies"]) == {"world-1", "b"}
    named = {one.get(key) for one in ElementTree.fromstring(text).iter() for key in ("body1", "body2")}
    assert named == {None, "world-1", "b"}


def test_directions_of_any_length_are_written() -> None:
    for size in ("1e-200", "1e200"):
        pin = {"kind": "pin", "a": "a", "b": [0, 0, 0], "axis": [size, size, 0]}
        bodies = {"a": {"mass": 1, "at": [0, 0, 0], **MOMENTS}}
        text, _ = export_mjcf(scene_from({"bodies": bodies, "connections": [pin]}))
        [joint] = ElementTree.fromstring(text).iter("joint")
        assert [float(x) for x in joint.get("axis", "").split()] == pytest.approx([0.5**0.5, 0.5**0.5, 0])

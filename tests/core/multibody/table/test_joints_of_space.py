"""Cylindrical and universal joints against closed forms and the ratio of Hooke's joint.

The ratio: S. Hooke's joint transmits w2/w1 = cos b/(1 - sin^2 b cos^2 a), with the bend b of the shafts and the turn a
of the first from where its fork lies in the plane of the bend (Mabie and Reinholtz, "Mechanisms and Dynamics of
Machinery", 4th edition, section 9.11).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.errors import InvalidParameter, PlacesDisagree
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

TIMES = [0.0, 0.5, 1.0, 3.0]
OUTPUTS = ("accelerations", "forces", "trajectory", "energy-in-time", "forces-in-time")


def sleeve(axis: list[Any], **body: Any) -> dict[str, Any]:
    given = {"mass": 2, "moments": [3, 3, 3], "at": [0, 0, 0], **body}
    joint = {"kind": "cylindrical", "name": "sleeve", "a": "body", "b": [0, 0, 0], "axis": axis}
    return {"gravity": [0, 0, -9], "bodies": {"body": given}, "connections": [joint]}


def test_a_body_falls_along_a_slanted_shaft_and_spins_on() -> None:
    """The axis (1, 2, 2)/3 makes 2/3 of gravity an acceleration along it; the spin along it is kept."""
    found = solve_scene(scene_from(sleeve([1, 2, 2], angular_velocity=["1/3", "2/3", "2/3"])), TIMES, OUTPUTS)
    assert found.model.degrees_of_freedom == 2
    assert found.trajectory is not None
    columns, t = found.trajectory.columns, np.array(TIMES)
    np.testing.assert_allclose(
        columns["body.position"].values, -3 * t[:, None] ** 2 * [1 / 3, 2 / 3, 2 / 3], atol=1e-13
    )
    np.testing.assert_allclose(np.linalg.norm(columns["body.angular_velocity"].values, axis=1), 1, atol=1e-14)
    # Across the shaft it carries the weight 18 times sin = sqrt(5)/3.
    normal = np.hypot(columns["sleeve.normal.1"].values, columns["sleeve.normal.2"].values)
    np.testing.assert_allclose(normal, 18 * np.sqrt(5) / 3, rtol=1e-13)


def test_an_arm_on_a_vertical_shaft_holds_by_a_moment() -> None:
    """A body beside the shaft, its place on it: it falls freely along it, and turns with the rate that it has."""
    scene = sleeve([0, 0, 1], at=[2, 0, 0], places={"ring": [-2, 0, 0]}, angular_velocity=[0, 0, 3])
    scene["connections"][0]["a"] = "body.ring"
    found = solve_scene(scene_from(scene), TIMES, OUTPUTS)
    assert found.trajectory is not None
    t = np.array(TIMES)
    place = np.stack([2 * np.cos(3 * t), 2 * np.sin(3 * t), -4.5 * t**2], axis=1)
    np.testing.assert_allclose(found.trajectory.columns["body.position"].values, place, atol=2e-13)


BEND = np.pi / 3


def shafts(first: list[Any]) -> dict[str, Any]:
    """Return two shafts in bearings that a universal joint couples, the second bent by 60 degrees about y."""
    bearings = [
        {"kind": "pin", "a": "one.back", "b": [-1, 0, 0], "axis": [1, 0, 0]},
        {"kind": "pin", "a": "two.back", "b": ["1/2", 0, "sqrt(3)/2"], "axis": ["1/2", 0, "sqrt(3)/2"]},
    ]
    cross = {"kind": "universal", "name": "cross", "a": "one", "b": "two", "axes": first}
    one = {"mass": 1, "moments": [2, 2, 2], "at": [0, 0, 0], "places": {"back": [-1, 0, 0]}}
    two = {"mass": 1, "moments": [1, 1, 1], "at": [0, 0, 0], "places": {"back": ["1/2", 0, "sqrt(3)/2"]}}
    return {
        "bodies": {"one": one | {"angular_velocity": [1, 0, 0]}, "two": two},
        "connections": [*bearings, cross],
    }


def test_two_shafts_turn_as_hookes_joint_says() -> None:
    """2 w1^2 + w2^2 is kept, with w2 = ratio w1; the fork of the first is in the plane of the bend at the start."""
    found = solve_scene(scene_from(shafts([[0, 0, 1], [0, 1, 0]])), TIMES, OUTPUTS)
    assert found.model.degrees_of_freedom == 1
    assert found.trajectory is not None
    rates = [
        np.linalg.norm(found.trajectory.columns[f"{name}.angular_velocity"].values, axis=1) for name in ("one", "two")
    ]

    def ratio(turn: Any) -> Any:
        return np.cos(BEND) / (1 - np.sin(BEND) ** 2 * np.cos(turn) ** 2)

    energy = 2 + ratio(0.0) ** 2
    turns = solve_ivp(
        *(lambda _, y: np.sqrt(energy / (2 + ratio(y) ** 2)), (0, 3), [0.0], "DOP853", TIMES), rtol=1e-12, atol=1e-12
    ).y[0]
    np.testing.assert_allclose(rates[0], np.sqrt(energy / (2 + ratio(turns) ** 2)), atol=1e-10)
    np.testing.assert_allclose(rates[1], ratio(turns) * rates[0], atol=1e-10)


@pytest.mark.parametrize(
    ("change", "pointer", "rule"),
    [
        ({"axes": [[0, 0, 1], [0, 1, 1]]}, ("axes",), "right angles"),
        ({"axes": [[0, 0, 1]]}, ("axes",), "two vectors"),
        ({"axes": [[0, 0, 1], [0, 0, 0]]}, ("axes", 1), "not all zero"),
        ({"b": "one.back"}, (), "two different bodies"),
    ],
)
def test_what_no_universal_joint_can_be_is_refused(change: dict[str, Any], pointer: tuple[Any, ...], rule: str) -> None:
    scene = shafts([[0, 0, 1], [0, 1, 0]])
    scene["connections"][2] |= change
    with pytest.raises((InvalidParameter, PlacesDisagree), match=rule) as refused:
        solve_scene(scene_from(scene), TIMES)
    assert refused.value.path == ("connections", 2, *pointer)


@pytest.mark.parametrize("kind", ["cylindrical", "universal"])
def test_joints_of_space_are_refused_in_the_plane(kind: str) -> None:
    joint = {"kind": kind, "a": "m", "b": [0, 0], **({"axis": [0, 1]} if kind == "cylindrical" else {"axes": []})}
    scene = {"bodies": {"m": {"mass": 1, "inertia": 1, "at": [0, 0]}}, "connections": [joint]}
    with pytest.raises(InvalidParameter, match="of the plane") as refused:
        solve_scene(scene_from(scene), TIMES)
    assert refused.value.path == ("connections", 0, "kind")


@pytest.mark.parametrize("pitch", [2, -2])
def test_a_nut_falls_along_its_screw(pitch: int) -> None:
    """With p = pitch/(2 pi) the weight along the axis moves m + J/p^2; the screw bears J/p^2 times the acceleration."""
    scene = sleeve([1, 2, 2])
    scene["connections"][0] |= {"kind": "screw", "pitch": pitch}
    found = solve_scene(scene_from(scene), TIMES, OUTPUTS)
    assert found.model.degrees_of_freedom == 1
    assert found.trajectory is not None
    columns, t = found.trajectory.columns, np.array(TIMES)
    p, axis = pitch / (2 * np.pi), np.array([1, 2, 2]) / 3
    gain = -2 * 9 * (2 / 3) / (2 + 3 / p**2)
    np.testing.assert_allclose(columns["body.position"].values, np.outer(gain * t**2 / 2, axis), atol=1e-12)
    np.testing.assert_allclose(columns["body.angular_velocity"].values, np.outer(gain * t / p, axis), atol=1e-12)
    np.testing.assert_allclose(columns["sleeve.force"].values, -3 * gain / p**2, rtol=1e-12)


def test_a_screw_that_is_driven_lifts_its_nut() -> None:
    """One turn a second with a pitch of 1/4 m: the motor does the work against the weight of 18 N."""
    scene = sleeve([0, 0, 1])
    scene["connections"][0] |= {"kind": "screw", "pitch": "1/4"}
    scene["connections"].append({"kind": "motor", "name": "motor", "a": "body", "drive": "2*pi*t"})
    found = solve_scene(scene_from(scene), TIMES, (*OUTPUTS, "work-in-time"))
    assert found.trajectory is not None
    columns, t = found.trajectory.columns, np.array(TIMES)
    np.testing.assert_allclose(columns["body.position"].values[:, 2], t / 4, atol=1e-13)
    np.testing.assert_allclose(columns["motor.torque"].values, 18 / 4 / (2 * np.pi), rtol=1e-12)
    np.testing.assert_allclose(columns["motor.work"].values, 18 * t / 4, atol=1e-12)


def test_a_screw_without_pitch_is_refused() -> None:
    scene = sleeve([0, 0, 1])
    scene["connections"][0] |= {"kind": "screw", "pitch": 0}
    with pytest.raises(InvalidParameter, match="other than 0 m") as refused:
        solve_scene(scene_from(scene), TIMES, OUTPUTS)
    assert refused.value.path == ("connections", 0, "pitch")

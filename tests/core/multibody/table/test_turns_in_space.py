"""Motors and dampers about the axes of pins in space, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

TIMES = np.array([0.0, 0.5, 2.0])
OUTPUTS = ("accelerations", "forces", "trajectory", "forces-in-time", "work-in-time", "energy-in-time")
AXIS = ["1/3", "2/3", "2/3"]


def wheel(moment: Any, **more: Any) -> dict[str, Any]:
    return {"mass": 1, "moments": [moment] * 3, "at": [0, 0, 0], **more}


def pin(a: str, b: Any) -> dict[str, Any]:
    return {"kind": "pin", "a": a, "b": b, "axis": AXIS}


def solved(bodies: dict[str, Any], *connections: dict[str, Any]) -> dict[str, Any]:
    found = solve_scene(scene_from({"bodies": bodies, "connections": list(connections)}), TIMES, OUTPUTS)
    assert found.trajectory is not None
    return {name: column.values for name, column in found.trajectory.columns.items()}


def rates(columns: dict[str, Any], body: str) -> Any:
    """Return the components of an angular velocity along the axis."""
    return columns[f"{body}.angular_velocity"] @ [1 / 3, 2 / 3, 2 / 3]


def test_a_wheel_on_a_slanted_pin_through_its_centre_turns_evenly() -> None:
    """Nothing of it has a place or a velocity: what its pin holds is known to the size of a direction."""
    columns = solved({"wheel": wheel(3, angular_velocity=[1, 2, 2])}, pin("wheel", [0, 0, 0]))
    np.testing.assert_allclose(rates(columns, "wheel"), 3, rtol=1e-14)


def test_a_motor_turns_a_wheel_about_a_slanted_axis() -> None:
    """The rate 2 + t with a moment of inertia of 3: the torque 3, and the work 3 (2 t + t^2/2)."""
    motor = {"kind": "motor", "name": "motor", "a": "wheel", "rate": "2 + t"}
    columns = solved({"wheel": wheel(3)}, pin("wheel", [0, 0, 0]), motor)
    np.testing.assert_allclose(rates(columns, "wheel"), 2 + TIMES, rtol=1e-14)
    np.testing.assert_allclose(columns["motor.torque"], 3, rtol=1e-13)
    np.testing.assert_allclose(columns["motor.work"], 3 * (2 * TIMES + TIMES**2 / 2), atol=1e-13)


def test_a_rotor_turns_its_stand_back() -> None:
    """Of a stand and a rotor at rest the angular momentum stays zero: 4 u + 1 (u + 10 t) = 0."""
    motor = {"kind": "motor", "name": "motor", "a": "rotor", "b": "stand", "rate": "10*t"}
    columns = solved({"stand": wheel(4), "rotor": wheel(1)}, pin("stand", [0, 0, 0]), pin("rotor", "stand"), motor)
    np.testing.assert_allclose(rates(columns, "stand"), -2 * TIMES, atol=1e-13)
    np.testing.assert_allclose(rates(columns, "rotor"), 8 * TIMES, atol=1e-13)
    np.testing.assert_allclose(columns["motor.torque"], 8, rtol=1e-13)


def test_a_damper_slows_a_hinge() -> None:
    """A moment of inertia of 2 and 3 N m s: w = 5 exp(-3 t/2)."""
    damper = {"kind": "damper", "name": "damper", "a": "wheel", "measure": "turn", "coefficient": 3}
    spin = {"angular_velocity": ["5/3", "10/3", "10/3"]}
    columns = solved({"wheel": wheel(2, **spin)}, pin("wheel", [0, 0, 0]), damper)
    exact = 5 * np.exp(-1.5 * TIMES)
    np.testing.assert_allclose(rates(columns, "wheel"), exact, atol=1e-13)
    np.testing.assert_allclose(columns["damper.torque"], -3 * exact, atol=1e-12)


def test_a_damper_between_two_wheels_brings_them_together() -> None:
    """Of 1 and 3 kg m^2 with 4 rad/s and 0: w = 1 + 3 exp(-c (1 + 1/3) t) of the first."""
    damper = {"kind": "damper", "a": "two", "b": "one", "measure": "turn", "coefficient": "3/4"}
    bodies = {"one": wheel(1, angular_velocity=["4/3", "8/3", "8/3"]), "two": wheel(3)}
    bodies["two"]["angular_velocity"] = [0, 0, 0]
    columns = solved(bodies, pin("one", [0, 0, 0]), pin("two", "one"), damper)
    np.testing.assert_allclose(rates(columns, "one"), 1 + 3 * np.exp(-TIMES), atol=1e-13)
    np.testing.assert_allclose(rates(columns, "two"), 1 - np.exp(-TIMES), atol=1e-13)


def test_a_motor_turns_a_wheel_by_an_angle_through_whole_turns() -> None:
    """The angle 5 t^2 with a moment of inertia of 3: 20 rad at 2 s, the torque 30, and the work 30 times the angle."""
    motor = {"kind": "motor", "name": "motor", "a": "wheel", "drive": "5*t^2"}
    columns = solved({"wheel": wheel(3)}, pin("wheel", [0, 0, 0]), motor)
    np.testing.assert_allclose(rates(columns, "wheel"), 10 * TIMES, atol=1e-12)
    np.testing.assert_allclose(columns["motor.torque"], 30, rtol=1e-12)
    np.testing.assert_allclose(columns["motor.work"], 150 * TIMES**2, atol=1e-10)


def test_a_torsion_spring_winds_a_wheel_through_whole_turns() -> None:
    """12 N m/rad on 3 kg m^2 from rest, 20 rad from where it is unstretched: 20 (1 - cos 2t)."""
    spring = {"kind": "torsion-spring", "name": "spring", "a": "wheel", "stiffness": 12, "rest_angle": 20}
    columns = solved({"wheel": wheel(3)}, pin("wheel", [0, 0, 0]), spring)
    np.testing.assert_allclose(rates(columns, "wheel"), 40 * np.sin(2 * TIMES), atol=1e-12)
    np.testing.assert_allclose(columns["spring.torque"], 240 * np.cos(2 * TIMES), atol=1e-11)


def test_a_spring_between_wheels_turns_them_against_each_other() -> None:
    """Of 1 and 3 kg m^2 with 3 N m/rad the relative turn swings with sqrt(3 (1 + 1/3)) = 2 rad/s."""
    bodies = {"one": wheel(3), "two": wheel(1, angular_velocity=["1/3", "2/3", "2/3"])}
    spring = {"kind": "torsion-spring", "name": "spring", "a": "one", "b": "two", "stiffness": 3}
    columns = solved(bodies, pin("one", [0, 0, 0]), pin("two", "one"), spring)
    relative = rates(columns, "two") - rates(columns, "one")
    np.testing.assert_allclose(relative, np.cos(2 * TIMES), atol=1e-13)
    np.testing.assert_allclose(columns["spring.torque"], 3 * np.sin(2 * TIMES) / 2, atol=1e-12)


def test_a_damper_by_a_formula_slows_a_hinge() -> None:
    """A moment of inertia of 2 and 4 w^3: 1/w^2 grows by 4 t."""
    damper = {"kind": "damper", "name": "damper", "a": "wheel", "measure": "turn", "law": "4*rate^3"}
    spin = {"angular_velocity": ["1/3", "2/3", "2/3"]}
    columns = solved({"wheel": wheel(2, **spin)}, pin("wheel", [0, 0, 0]), damper)
    np.testing.assert_allclose(rates(columns, "wheel"), 1 / np.sqrt(1 + 4 * TIMES), atol=1e-13)


def test_a_stop_turns_a_wheel_back() -> None:
    """At 3 rad/s it meets 7 rad, more than a turn, after 7/3 s, and leaves at half of the rate."""
    stop = {"kind": "contact", "name": "stop", "a": "wheel", "measure": "turn", "at_most": 7, "restitution": "1/2"}
    bodies = {"wheel": wheel(2, angular_velocity=[1, 2, 2])}
    scene = scene_from({"bodies": bodies, "connections": [pin("wheel", [0, 0, 0]), stop]})
    found = solve_scene(scene, [0.0, 3.0])
    assert [event.kind for event in found.events] == ["stop"]
    assert found.events[0].time == pytest.approx(7 / 3, abs=1e-13)
    assert found.events[0].impulses["normal"] == pytest.approx(2 * 4.5, abs=1e-12)
    assert found.trajectory is not None
    spin = found.trajectory.columns["wheel.angular_velocity"].values[1]
    np.testing.assert_allclose(spin, [-1 / 2, -1, -1], atol=1e-13)


@pytest.mark.parametrize(
    ("connection", "pointer", "rule"),
    [
        ({"kind": "motor", "a": "wheel", "drive": "1 + t"}, "drive", "be 0.* rad at the start"),
        ({"kind": "motor", "a": "other", "rate": 1}, "a", "joined to b by a pin, cylindrical joint or screw"),
        ({"kind": "motor", "a": "point", "rate": 1}, "a", "has moments"),
        ({"kind": "damper", "a": "wheel", "measure": "turn", "law": "angle^3"}, "law", "known names"),
        ({"kind": "torsion-spring", "a": "other", "stiffness": 1}, "a", "joined to b by a pin"),
        ({"kind": "contact", "a": "other", "measure": "turn", "at_most": 1}, "a", "joined to b by a pin"),
    ],
)
def test_what_has_no_turn_is_refused(connection: dict[str, Any], pointer: str, rule: str) -> None:
    bodies = {"wheel": wheel(1), "other": wheel(1), "point": {"mass": 1, "at": [1, 0, 0]}}
    with pytest.raises(InvalidParameter, match=rule) as refused:
        solved(bodies, pin("wheel", [0, 0, 0]), connection)
    assert refused.value.path == ("connections", 1, pointer)

"""Errors relative to the scale of a motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from core.multibody.trajectory.column_errors import apart, worst
from core.systems.methods import RungeKutta4
from core.systems.trajectory import Column
from tests.core.multibody.worked_examples import column, points, read


def made(values: list[float], unit: str, error: float) -> Column:
    return Column(np.array(values), unit, error, "measured against pairs")


def test_errors_are_relative_to_the_largest_value_of_a_unit() -> None:
    columns = {"a": made([1.0, -4.0], "m", 1e-12), "b": made([0.0], "m", 4e-12), "c": made([2e-3], "rad", 1e-9)}
    assert worst(columns) == pytest.approx(5e-7)


def test_opposite_quaternions_are_one_attitude() -> None:
    one = Column(np.array([[0.6, 0.0, 0.8, 0.0]]), "1", 0.0, "measured against pairs")
    assert apart(one, Column(-one.values, "1", 0.0, "measured against pairs")) == 0.0
    assert apart(one, Column(one.values[:, ::-1], "1", 0.0, "measured against pairs")) == pytest.approx(2.0**0.5)


def test_angles_that_are_zero_within_their_error_are_measured_by_radians_and_speeds() -> None:
    columns = {"x": made([2.0], "m", 0.0), "v": made([6.0], "m/s", 0.0)}
    assert worst(columns | {"a": made([1e-30], "rad", 1e-14)}) == pytest.approx(1e-14)
    assert worst(columns | {"w": made([1e-30], "rad/s", 6e-14)}) == pytest.approx(2e-14)
    # Of a table that slides without turning rounding is left, known to less than itself.
    assert worst(columns | {"w": made([7e-77], "rad/s", 6e-77)}) < 1e-70
    # Without a motion there is nothing to measure by.
    assert worst({"w": made([1e-30], "rad/s", 6e-14)}) == pytest.approx(6e16)


def test_a_plank_on_two_strings_that_never_turns_is_answered() -> None:
    plank = {"mass": 2, "inertia": 0.5, "at": [0.6, -0.8], "places": {"l": [-1, 0], "r": [1, 0]}}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"plank": plank},
        "connections": [
            {"kind": "string", "through": ["plank.l", [-1, 0]]},
            {"kind": "string", "through": ["plank.r", [1, 0]]},
        ],
    }
    answer = solve_scene(read(scene), [0.3, 1.0])
    for name in ("plank.angle", "plank.angular_velocity"):
        found = column(answer, name)
        assert np.abs(found.values).max() <= found.error < 1e-25


EVERY_COLUMN = ("trajectory", "energy-in-time", "momenta-in-time", "forces-in-time")


@pytest.mark.parametrize("method", [None, RungeKutta4(step=0.0005)], ids=["doubles", "runge-kutta-4"])
def test_every_error_of_a_chaotic_motion_covers_the_distance_from_the_motion_in_pairs(
    method: RungeKutta4 | None,
) -> None:
    """After 12 s doubles have lost half of their digits, and what is derived of the states as many."""
    scene, times = read(points((1, 1), ("2", "2.5"), (1, 1))), [5.0, 9.0, 12.0]
    rough = solve_scene(scene, times, EVERY_COLUMN, 0.1, method=method).trajectory
    right = solve_scene(scene, times, EVERY_COLUMN, 1e-11).trajectory
    assert rough is not None
    assert right is not None
    assert {"energy.kinetic", "momentum", "p1.angular_momentum", "r1.force"} < set(rough.columns)
    for name, own in rough.columns.items():
        other = right.columns[name]
        distance = np.abs(own.values - other.values)
        largest = distance.max() if distance.ndim == 1 else np.linalg.norm(distance, axis=1).max()
        assert other.error < 1e-12, name
        assert largest > 1e-8, name
        assert largest <= own.error, name


@pytest.mark.parametrize("contact", [False, True])
def test_a_torque_that_is_zero_by_symmetry_has_the_scale_of_the_other_forces(contact: bool) -> None:
    """A pinned bar that a motor turns evenly without gravity: the pin pulls with m r w^2, the motor does nothing."""
    bar = {"mass": 1, "inertia": "1/12", "at": [0, 0.5], "angle": "pi/2", "places": {"top": [-0.5, 0]}}
    connections: list[dict[str, Any]] = [
        {"kind": "pin", "name": "pin", "a": "bar.top", "b": [0, 0]},
        {"kind": "motor", "name": "motor", "a": "bar", "rate": 2},
    ]
    bodies: dict[str, Any] = {"bar": bar}
    if contact:
        bodies["ball"] = {"mass": 1, "at": [5, 1], "velocity": [0, -1]}
        connections.append({"kind": "contact", "place": "ball", "on": {"at": [5, 0]}, "restitution": 1})
    scene = {"gravity": [0, 0], "bodies": bodies, "connections": connections}
    found = solve_scene(read(scene), [0.0, 0.7, 1.9], ("trajectory", "forces-in-time")).trajectory
    assert found is not None
    torque = found.columns["motor.torque"]
    assert np.max(np.abs(torque.values)) <= torque.error < 1e-15
    assert torque.scale == pytest.approx(2.0, rel=0.6)


@pytest.mark.parametrize(("angle", "rate"), [("pi - 1e-9", 0), ("pi - 1e-12", 0), ("2", 0), ("0", 9), ("0", "-7.8")])
def test_the_angle_of_a_rod_goes_on_without_jumps_however_often_it_swings_or_turns(
    angle: str, rate: float | str
) -> None:
    """On a pin at its end: energy bounds its rate, which is 2 sqrt(15) rad/s at most from rest."""
    rod = {
        "mass": 1,
        "inertia": "1/12",
        "at": [f"sin({angle})/2", f"-cos({angle})/2"],
        "angle": f"{angle} - pi/2",
        "angular_velocity": rate,
        "velocity": [f"({rate})*cos({angle})/2", f"({rate})*sin({angle})/2"],
        "places": {"end": ["-0.5", 0]},
    }
    scene = {"gravity": [0, -10], "bodies": {"r": rod}, "connections": [{"kind": "pin", "a": "r.end", "b": [0, 0]}]}
    times = np.linspace(0.0, 100.0, 1001)
    answer = solve_scene(read(scene), times)
    assert answer.trajectory is not None
    found = {name: answer.trajectory.columns[f"r.{name}"].values for name in ("angle", "angular_velocity")}
    fastest = math.sqrt(float(rate) ** 2 + 60.0)
    assert np.all(np.abs(np.diff(found["angle"])) <= 0.1 * fastest)
    # Simpson's rule over steps of 0.2 s, wrong by less than a twentieth of a turn.
    w = found["angular_velocity"]
    gained = (w[:-2:2] + 4.0 * w[1:-1:2] + w[2::2]) * (0.1 / 3.0)
    assert np.allclose(np.diff(found["angle"][::2]), gained, rtol=0.0, atol=0.1)


SLOPES = ["0", "atan(3/4)", "pi/7", {"degrees": 30}]


@pytest.mark.parametrize("rest", ["0.91", "91/300", "sqrt(2)/3"])
@pytest.mark.parametrize("slope", SLOPES, ids=str)
@pytest.mark.parametrize("stiffness", ["20", "1e9/3"])
def test_forces_that_all_vanish_are_answered(rest: str, slope: Any, stiffness: str) -> None:
    """Without gravity, at the rest length of a spring, terms cancel: what is left is rounding, in every unit."""
    scene = {
        "gravity": [0, 0],
        "bodies": {"b": {"mass": "1/3", "at": [0, f"-({rest})"]}},
        "connections": [
            {"kind": "track", "place": "b", "on": {"at": [0, f"-({rest})"], "slope": slope}},
            {"kind": "spring", "name": "s", "a": "b", "b": [0, 0], "stiffness": stiffness, "rest_length": rest},
            {"kind": "contact", "place": "b", "on": {"at": [0, f"-({rest})"]}, "friction": 0.4},
        ],
    }
    answer = solve_scene(read(scene), [0.3, 1.0], EVERY_COLUMN, 1e-12)
    motion = answer.trajectory
    assert motion is not None
    for name, one in motion.columns.items():
        if name != "b.position" and one.unit != "J":
            assert one.largest <= one.error, name
    found = column(answer, "s.force")
    assert found.error <= 2e-15 * quotient(stiffness)


def quotient(formula: str) -> float:
    """Return a quotient of two numbers, or one."""
    over, _, under = formula.partition("/")
    return float(over) / float(under or 1)

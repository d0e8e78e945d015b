from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from core.bodies import Ball, Cylinder, Disc, Ellipsoid, SphericalShell, Torus
from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, force, read

BALL = {"mass": 0.5, "radius": 0.1, "moments": [0.002, 0.002, 0.002]}
SURFACES = {
    "plane": ([1, 0, 0.1], [0.3, 0.5, 0], {"at": [0, 0, 0], "normal": [0, 0, 1]}),
    "turntable": ([1, 0, 0.1], [0.3, 0.5, 0], {"at": [0, 0, 0], "normal": [0, 0, 1], "rate": -2}),
    "incline": ([0.08, 1, 0.06], [0, 0.5, 0], {"at": [0, 0, 0], "normal": [0.8, 0, 0.6]}),
    "in a cylinder": ([0.54, 0, -0.72], [0.4, 1, 0.3], {"at": [0, 5, 0], "direction": [0, 1, 0], "radius": -1}),
    "on a cylinder": ([0.66, 0, 0.88], [0.4, 1, -0.3], {"at": [0, 5, 0], "direction": [0, 1, 0], "radius": 1}),
    "in a sphere": ([0.54, 0, -0.72], [0.4, 1, 0.3], {"at": [0, 0, 0], "radius": -1}),
    "on a sphere": ([0.66, 0, 0.88], [0.4, 1, -0.3], {"at": [0, 0, 0], "radius": 1}),
}


def rolling(surface, **changes):
    at, velocity, on = copy.deepcopy(SURFACES[surface])
    ball = BALL | {"at": at, "velocity": velocity} | changes
    connection = {"kind": "rolling", "name": "r", "place": "ball", "on": on}
    return {"gravity": [0, 0, -9.81], "bodies": {"ball": ball}, "connections": [connection]}


@pytest.mark.parametrize("surface", SURFACES)
def test_a_ball_moves_alike_by_its_angular_velocity_and_by_its_axes(surface):
    """Moments that differ, by as good as nothing, make it the general rigid body with nine direction cosines."""
    plain = rolling(surface)
    axes = rolling(surface, moments=None, tensor=[[0.002, 0, 0], [0, 0.002, 0], [0, 0, "0.002 + 1e-80"]])
    del axes["bodies"]["ball"]["moments"]
    first = solve_scene(read(plain), [0.0, 0.7], ["trajectory", "forces-in-time", "forces", "energy", "energy-in-time"])
    other = solve_scene(read(axes), [0.0, 0.7], ["trajectory", "forces-in-time", "forces"])
    assert "ball.attitude" in other.trajectory.columns
    assert "ball.angular_velocity_in_space" in first.trajectory.columns
    for name in ("ball.position", "ball.velocity", *(x for x in first.trajectory.columns if x.startswith("r."))):
        one, two = column(first, name), column(other, name)
        assert one.values == pytest.approx(two.values, abs=one.error + two.error)
    for name in first.forces:
        assert force(first, name) == pytest.approx(force(other, name), abs=1e-14)
    if first.energy.conserved:
        energy = column(first, "energy.kinetic").values + column(first, "energy.potential").values
        assert energy == pytest.approx(first.energy.total, rel=1e-13)


@pytest.mark.parametrize("surface", SURFACES)
def test_where_it_touches_it_does_not_slip(surface):
    answer = solve_scene(read(rolling(surface)), [0.6])
    place, speed, omega = (
        column(answer, f"ball.{name}").values[0] for name in ("position", "velocity", "angular_velocity_in_space")
    )
    on = SURFACES[surface][2]
    if "normal" in on:
        n, ground = np.array(on["normal"], dtype=float), on.get("rate", 0) * np.cross(on["normal"], place)
        assert n @ place == pytest.approx(0.1, abs=1e-14)
    else:
        away = place - np.array(on["at"])
        if "direction" in on:
            away = away - np.array(on["direction"]) * (np.array(on["direction"]) @ away)
        assert np.linalg.norm(away) == pytest.approx(abs(on["radius"] + 0.1), abs=1e-13)
        n, ground = away / (on["radius"] + 0.1), np.zeros(3)
    contact = speed - 0.1 * np.cross(omega, n)
    assert contact - (ground - n * (n @ ground)) == pytest.approx(np.zeros(3), abs=1e-12)


def test_a_loaded_ball_in_a_plane_rolls_as_the_hoop_of_the_plane_does():
    space = {
        "gravity": [0, 0, -9.81],
        "bodies": {
            "ball": {
                "mass": 2,
                "radius": 0.5,
                "moments": [0.2, 0.3, 0.25],
                "at": ["0.1*sin(1)", 0, "0.5 - 0.1*cos(1)"],
                "axes": [["cos(1)", 0, "sin(1)"], [0, 1, 0], ["-sin(1)", 0, "cos(1)"]],
                "places": {"middle": [0, 0, 0.1]},
            }
        },
        "connections": [{"kind": "rolling", "place": "ball.middle", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}],
    }
    plane = {
        "gravity": [0, -9.81],
        "bodies": {
            "rim": {"mass": 0, "inertia": 0, "radius": 0.5, "at": [0, 0.5]},
            "load": {
                "mass": 2,
                "inertia": 0.3,
                "at": ["0.1*sin(1)", "0.5 - 0.1*cos(1)"],
                "places": {"middle": ["-0.1*sin(1)", "0.1*cos(1)"]},
            },
        },
        "connections": [
            {"kind": "rolling", "place": "rim", "on": {"at": [0, 0]}},
            {"kind": "weld", "a": "load", "b": "rim"},
        ],
    }
    first, second = (solve_scene(read(scene), [0.5, 2.0]) for scene in (space, plane))
    a, b = column(first, "ball.position"), column(second, "load.position")
    assert a.values[:, [0, 2]] == pytest.approx(b.values, abs=a.error + b.error)
    assert first.model.mobility == 3
    assert first.period == pytest.approx(second.period, rel=1e-14)


@pytest.mark.parametrize(
    ("changes", "on", "path"),
    [
        ({"radius": None}, None, ("connections", 0, "place")),
        ({}, {"normal": [0, 0, 1]}, ("connections", 0, "on", "at")),
        ({}, {"at": [0, 0, 0]}, ("connections", 0, "on")),
        ({}, {"at": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}, ("connections", 0, "on")),
        ({}, {"at": [0, 0, 0], "radius": -0.05}, ("connections", 0, "on", "radius")),
        ({"at": [1, 0, 0.2]}, None, ("connections", 0)),
        ({"velocity": [0, 0, 1]}, None, ("bodies", "ball", "velocity", 2)),
    ],
)
def test_what_cannot_roll_is_refused_with_its_path(changes, on, path):
    scene = rolling("plane")
    scene["bodies"]["ball"] |= changes
    if changes.get("radius", 1) is None:
        del scene["bodies"]["ball"]["radius"]
    if on is not None:
        scene["connections"][0]["on"] = on
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read(scene), [0.1])
    assert fault.value.path == path


@pytest.mark.parametrize("moments", [[0.1, 0.1, 0.1], [0.1, 0.1, 0.12], [0.1, 0.11, 0.12]])
def test_what_rolls_may_be_driven_by_a_torque_whatever_its_moments(moments: list[float]) -> None:
    scene = {
        "gravity": [0, 0, -10],
        "bodies": {"b": {"mass": 1, "radius": 0.5, "moments": moments, "at": [0, 0, 0.5]}},
        "connections": [
            {"kind": "rolling", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
            {"kind": "torque", "body": "b", "torque": [0, 3, 0]},
        ],
    }
    answer = solve_scene(read(scene))
    assert answer.accelerations is not None
    # About the point of contact: (I_2 + m r^2) w' = 3.
    turned = 3 / (moments[1] + 0.25)
    assert answer.accelerations["b"].angular == pytest.approx((0, turned, 0), abs=1e-15)
    assert answer.accelerations["b"].linear == pytest.approx((turned / 2, 0, 0), abs=1e-15)


@pytest.mark.parametrize(
    "body",
    [
        Disc(mass=1, radius=0.1),
        # With these moments, which are equal to 1e-4, it was a ball.
        Cylinder(mass=1, radius=0.1, height=0.1732),
        Torus(mass=1, ring_radius=0.1, tube_radius=0.02),
        Ellipsoid(mass=1, semi_axes=(0.1, 0.1, 0.11)),
    ],
    ids=lambda body: body.kind,
)
@pytest.mark.parametrize("kind", ["rolling", "contact"])
def test_a_coin_is_no_ball(body: Any, kind: str) -> None:
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"coin": {"body": body, "radius": 0.1, "at": [0, 0, 0.1], "velocity": [1, 0, 0]}},
        "connections": [{"kind": kind, "place": "coin", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}],
    }
    with pytest.raises(InvalidParameter, match="is a ball") as refused:
        solve_scene(read(scene), [1.0])
    assert refused.value.path == ("bodies", "coin", "radius")
    assert "places" in (refused.value.remedy or "")


@pytest.mark.parametrize(
    "body", [Ball(mass=1, radius=0.1), SphericalShell(mass=1, outer_radius=0.1, inner_radius=0.05)]
)
def test_bodies_that_are_round_roll(body: Any) -> None:
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"ball": {"body": body, "radius": 0.1, "at": [0, 0, 0.1], "velocity": [1, 0, 0]}},
        "connections": [{"kind": "rolling", "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}],
    }
    assert column(solve_scene(read(scene), [2.0]), "ball.position").values[0] == pytest.approx([2, 0, 0.1])

"""Bounces without end: of one contact, of several that strike together, and under forces that change on the way."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from flint import arb
from mpmath import atan2, mp, mpf, sqrt

from core.multibody.answer import SceneSolution
from core.multibody.phases.tracks import Tracks
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read
from tests.oracles.plain_engine.comparison.comparing import compared
from tests.oracles.plain_engine.comparison.run import classes_of

Json = dict[str, Any]
G = mpf("9.81")


def bar(restitution: Any, height: Any = 1.25, **more: Any) -> Json:
    body = {"mass": 1, "inertia": "1/3", "at": [0, height], "places": {"l": [-1, 0], "r": [1, 0]}, **more}
    contacts = [
        {"kind": "contact", "name": name, "place": f"bar.{name}", "on": {"at": [0, 0]}, "restitution": restitution}
        for name in ("l", "r")
    ]
    return {"gravity": [0, -9.81], "simultaneous": "together", "bodies": {"bar": body}, "connections": contacts}


def answered(scene: Json, end: float, outputs: Any = ("trajectory",)) -> SceneSolution:
    return solve_scene(read(scene), [0.0, end / 2, end], outputs)


def settling(answer: SceneSolution) -> dict[str, tuple[float, float]]:
    return {event.name: (event.time, event.error) for event in answer.events if event.kind == "settle"}


def on_a_spring(restitution: Any, height: Any, stiffness: Any) -> Any:
    """Return when what hangs on a spring, which is relaxed 1 m below the floor, comes to rest on the floor (s).

    About y = -1 - g/k it moves as a harmonic oscillator: with the speed v at the floor, d above that, an arc takes
    2 atan2(v, d w)/w.
    """
    w = sqrt(stiffness)
    d = 1 + G / stiffness
    speed = w * sqrt((d + height) ** 2 - d * d)
    time = atan2(speed, d * w) / w
    for _ in range(600):
        speed *= restitution
        time += 2 * atan2(speed, d * w) / w
    return time


@pytest.mark.parametrize("friction", [{}, {"friction": 0.1}, {"friction": 0.5}])
@pytest.mark.parametrize("speed", [0, 3])
def test_a_bar_that_falls_flat_comes_to_rest_as_one_ball(friction: Json, speed: float) -> None:
    """sqrt(2 h/g) (1 + e)/(1 - e), however its corners share the impulses."""
    scene = bar(0.8, velocity=[speed, 0])
    scene["connections"] = [one | friction for one in scene["connections"]]
    answer = answered(scene, 6.0)
    limit = float(sqrt(2 * mpf("1.25") / G) * 9)
    for name in ("l", "r"):
        time, error = settling(answer)[name]
        assert abs(time - limit) <= error < 1e-14


@pytest.mark.parametrize("corners", [1, 2])
def test_bounces_on_a_spring_are_summed_up_once_they_are_so_low_that_its_pull_does_not_change(corners: int) -> None:
    with mp.workdps(40):
        limit = on_a_spring(mpf("0.5"), mpf("1.25"), mpf(5))
    scene = bar("1/2")
    scene["connections"] = (
        scene["connections"][:corners]
        if corners == 2
        else [{"kind": "contact", "name": "l", "place": "bar", "on": {"at": [0, 0]}, "restitution": "1/2"}]
    )
    spring = {"kind": "spring", "a": "bar", "b": [0, -1], "stiffness": 5, "rest_length": 0}
    scene["connections"].append(spring)
    answer = answered(scene, 2.0)
    time, error = settling(answer)["l"]
    assert abs(time - limit) <= error < 1e-14


def test_corners_of_unlike_restitution_do_not_come_to_rest_as_one() -> None:
    scene = bar(0.8)
    scene["connections"][1]["restitution"] = 0.5
    times = {event.time for event in answered(scene, 1.5).events if event.kind == "touch"}
    # The bar turns after the first impact, and its ends strike at other times.
    assert len(times) > 1


def test_works_of_corners_that_come_to_rest_together_are_not_told_apart() -> None:
    answer = answered(bar(0.8), 6.0, ("trajectory", "energy-in-time", "work-in-time"))
    assert answer.trajectory is not None
    assert "gravity.work" in answer.trajectory.columns
    assert "l.impacts.work" not in answer.trajectory.columns


def test_a_piston_bounces_in_its_clearance_and_comes_to_rest_on_its_guide() -> None:
    """The slider-crank of Flores, Leine, Glocker (2011): 1 mm of clearance, e = 0.4, mu = 0.01, 150 rad/s."""
    corners = {"c1": [-0.05, -0.025], "c2": [0.05, -0.025], "c3": [0.05, 0.025], "c4": [-0.05, 0.025]}
    walls = {"c1": ("-0.026", 0), "c2": ("-0.026", 0), "c3": ("0.026", 180), "c4": ("0.026", 180)}
    ends = {"p": [-0.153, 0], "q": [0.153, 0]}
    bodies = {
        "crank": {"mass": 0.038, "inertia": 7.4e-5, "at": [0.0765, 0], "angular_velocity": 150},
        "rod": {"mass": 0.038, "inertia": 5.9e-4, "at": [0.306, 0], "angular_velocity": -75, "places": ends},
        "piston": {"mass": 0.076, "inertia": 2.7e-6, "at": [0.459, 0], "angular_velocity": 0, "places": corners},
    }
    bodies["crank"]["places"] = {"o": [-0.0765, 0], "p": [0.0765, 0]}
    connections: list[Json] = [
        {"kind": "pin", "a": "crank.o", "b": [0, 0]},
        {"kind": "pin", "a": "crank.p", "b": "rod.p"},
        {"kind": "pin", "a": "rod.q", "b": "piston"},
    ]
    for name, (y, degrees) in walls.items():
        on = {"at": [0, y], "slope": {"degrees": degrees}}
        contact = {"kind": "contact", "name": name, "place": f"piston.{name}", "on": on}
        connections.append(contact | {"friction": 0.01, "restitution": 0.4})
    scene = {"gravity": [0, -9.81], "simultaneous": "together", "bodies": bodies, "connections": connections}
    answer = answered(scene, 0.012)
    times = [event.time for event in answer.events if (event.kind, event.name) == ("touch", "c3")]
    settled, error = settling(answer)["c3"]
    assert settling(answer)["c4"] == (settled, error)
    assert error < 1e-15
    # What is left shrinks with the restitution, in the limit.
    gaps = [b - a for a, b in pairwise(times)]
    assert gaps[-1] / gaps[-2] == pytest.approx(0.4, rel=1e-4)
    assert settled - times[-1] == pytest.approx(gaps[-1] * 0.4 / 0.6, rel=1e-4)


def test_a_woodpecker_comes_down_its_pole_as_the_plain_engine_says() -> None:
    """The toy of C. Glocker, C. Studer, Multibody System Dynamics 13 (2005): its sleeve slips, jams and is let go."""
    bodies: Json = {
        "sleeve": {
            "mass": 0.0003,
            "inertia": 5e-9,
            "at": [0, 0],
            "angle": -0.1,
            "velocity": [0, -0.34],
            "angular_velocity": 0,
            "places": {"top": [0.0031, 0.0058], "low": [0.0031, -0.0058], "hinge": [0.01, 0]},
        },
        "bird": {
            "mass": 0.0045,
            "inertia": 7e-7,
            "at": ["0.01*cos(0.1) + 0.015*cos(0.28)", "-0.01*sin(0.1) - 0.015*sin(0.28)"],
            "angle": -0.28,
            "angular_velocity": -7.5,
            "places": {"hinge": [-0.015, 0], "beak": [-0.0201, 0.02]},
        },
    }
    pole = {"at": [0.0025, 0], "normal": [1, 0]}
    connections: list[Json] = [
        {"kind": "track", "place": "sleeve", "on": {"at": [0, 0], "slope": {"degrees": 90}}},
        {"kind": "pin", "a": "sleeve.hinge", "b": "bird.hinge"},
        {"kind": "torsion-spring", "a": "sleeve", "b": "bird", "stiffness": 0.0056, "rest_angle": 0},
        {"kind": "contact", "name": "beak", "place": "bird.beak", "on": pole, "friction": 0.3, "restitution": 0.5},
        {"kind": "contact", "name": "top", "place": "sleeve.top", "on": pole, "friction": 0.3},
        {"kind": "contact", "name": "low", "place": "sleeve.low", "on": pole, "friction": 0.3},
    ]
    scene = {"gravity": [0, -9.81], "bodies": bodies, "connections": connections}
    verdict = compared(scene, [0.0, 0.05, 0.11, 0.2])
    assert classes_of(verdict) == "", verdict.differences
    assert verdict.compared > 0


@pytest.mark.parametrize("velocity", [[0, 0, 0], [3, 0, 0]])
@pytest.mark.parametrize(
    "shape",
    [{"kind": "disc", "radius": 0.5}, {"kind": "box", "width": 1, "height": 0.6, "depth": 0.4}],
)
def test_four_contacts_of_which_three_are_independent_come_to_rest_as_one(shape: Json, velocity: list[float]) -> None:
    """sqrt(2 h/g) (1 + e)/(1 - e), in space: many shares of an impulse have one effect."""
    height = 0.2 if shape["kind"] == "disc" else 0.4
    body = {"mass": 1, "shape": shape, "at": [0, 0, height], "velocity": velocity}
    floor = {"kind": "contact", "name": "floor", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    scene = {
        "gravity": [0, 0, -10],
        "simultaneous": "together",
        "bodies": {"b": body},
        "connections": [{**floor, "restitution": 0.5}],
    }
    found = settling(answered(scene, 1.0))
    assert found
    for time, error in found.values():
        assert abs(time - 0.6) <= error + 1e-15


def test_what_rounding_leaves_of_a_turn_is_no_rate_of_a_short_phase() -> None:
    tracks = Tracks(["m", "rad"], [arb(5), arb(0)], [arb(3), arb(0)])
    tracks.each *= 2
    tracks.follow_scales(1e-10, tracks.first.q, [arb(5) + arb("3e-10"), arb("1e-33")], [arb(0), arb(0)])
    assert tracks.fastest("rad") == 0.0
    assert tracks.fastest("m") == pytest.approx(3.0)

"""Friction that turns with the slip, in space."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.balls import precision
from core.multibody.language.reading import scene_from
from core.multibody.phases.phases import motion_in_phases
from core.multibody.phases.turning_slip import TurningSlip
from core.multibody.solve import solve_scene


def test_a_ball_begins_to_slide_from_a_state_with_an_error() -> None:
    """An impact ends its slip, and a spring draws it on, faster than it can roll: what rounding leaves is no slip."""
    ball = {
        "mass": 1,
        "moments": ["0.004", "0.004", "0.004"],
        "radius": "0.1",
        "at": [5, 0, "0.4"],
        "velocity": [-2, 0, 0],
        "angular_velocity": [0, 0, 3],
    }
    floor = {"at": [5, 0, 0], "normal": [0, 0, 1]}
    scene = {
        "gravity": [0, 0, -10],
        "bodies": {"ball": ball, "other": {"mass": 1, "at": [10, 0, 0]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "ball", "on": floor, "friction": "0.3"},
            {"kind": "spring", "a": "ball", "b": "other", "stiffness": 5, "rest_length": 4},
            {"kind": "spinning-frame", "rate": 1},
        ],
    }
    motion = motion_in_phases(scene_from(scene), 0.2398)
    assert [event.kind for event in motion.events] == ["touch"]
    phase = motion.phases[-1]
    assert phase.turning
    (row,) = (row for row in phase.tables[0].table.rows if row.slide is not None)
    with precision(256):
        assert all(abs(x).upper() < 1e-60 for x in phase.tables[0].table.slip_of(row))
    ((_, turning),) = phase.models[0].whole.parts
    assert isinstance(turning, TurningSlip)
    # About a time within a step the motion is the same polynomial.
    late = 2e-5
    step = turning.run("fine", late).onset
    assert step is not None
    about, rest = turning.about_rest("fine", late)
    assert rest > 0.0
    for series, own in zip(about.places, step.places, strict=True):
        there = sum(float(x) * late**k for k, x in enumerate(own))
        assert float(series[0]) == pytest.approx(there, rel=1e-14, abs=1e-14)


def test_the_friction_of_a_shape_turns_with_that_of_its_corners() -> None:
    """A box that falls askew slides on one corner, then on another: the forces of the shape are the sums of theirs."""
    box = {"kind": "box", "width": 0.4, "height": 0.2, "depth": 0.3}
    body = {"mass": 1, "shape": box, "at": [0, 0, 0.5], "velocity": [0, 0, -1], "angular_velocity": [0, 0, 3]}
    on = {"at": [0, 0, 0], "normal": [0.6, 0, 0.8]}
    slope = {"kind": "contact", "name": "f", "place": "box", "on": on, "friction": [0.5, 0.25]}
    scene = {"gravity": [0, 0, -10], "bodies": {"box": body}, "connections": [slope]}
    answer = solve_scene(scene_from(scene), [0.1, 0.15, 0.18, 0.22], ("trajectory", "forces-in-time"))
    assert answer.trajectory is not None
    columns = answer.trajectory.columns
    for force in ("normal", "friction.x", "friction.y", "friction.z"):
        parts = [columns[f"f.{k}.{force}"].values for k in range(1, 9)]
        assert sum(bool(np.any(part)) for part in parts) == 2
        np.testing.assert_allclose(columns[f"f.{force}"].values, np.sum(parts, axis=0), atol=1e-14)


@pytest.mark.parametrize(("spin", "toe"), [(200, [0, 0, "-0.5"]), (20, [0, 0, "-0.5"]), (200, [0, 0, "-0.25"])])
def test_a_spinning_top_slides_from_rest(spin: int, toe: list[object]) -> None:
    """A top that spins about its axis has no rates at the start, by which steps were chosen: the first had no end.

    By its axis and its momentum along it, it moves as by three unit vectors.
    """
    body = {
        "mass": 1,
        "moments": ["0.04", "0.04", "0.01"],
        "at": ["0.3", 0, "0.4" if toe[2] == "-0.5" else "0.2"],
        "angular_velocity": [0, 0, spin],
        "axes": [["0.8", 0, "-0.6"], [0, 1, 0], ["0.6", 0, "0.8"]],
        "places": {"toe": toe},
    }
    floor = {"kind": "contact", "name": "f", "place": "top.toe", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    scene = {"gravity": [0, 0, -10], "bodies": {"top": body}, "connections": [{**floor, "friction": "0.3"}]}
    places = []
    for more in ({}, {"attitudes": True}):
        answer = solve_scene(scene_from({**scene, **more}), [0.05, 0.2], ("trajectory", "forces-in-time"))
        assert answer.trajectory is not None
        columns = answer.trajectory.columns
        assert max(columns[name].error or 0.0 for name in columns) < 1e-11
        places.append([columns[f"top.{name}"].values for name in ("position", "velocity")])
    np.testing.assert_allclose(places[0], places[1], rtol=0, atol=1e-12)


def test_what_slips_after_it_has_stuck_turns_from_the_first_moment_on() -> None:
    """A block under a force F(t) that grows and turns: from |F| = mu m g on, v' = F/m - mu g v/|v|, by Radau's method.

    At the start the slip is along the force, with the part of its rate of change that is along it: v = (F'.e) e t^2/2.
    """
    mass, gravity, mu = 2.0, 10.0, 0.25
    block = {"mass": mass, "at": [0, 0, 0]}
    floor = {"kind": "contact", "place": "block", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": mu}
    pull = {"kind": "force", "place": "block", "force": ["10*t", "6*t^2", 0]}
    scene = {"gravity": [0, 0, -gravity], "bodies": {"block": block}, "connections": [{"name": "floor"} | floor, pull]}
    answer = solve_scene(scene_from(scene), [0.6, 1.0])
    (event,) = answer.events
    start = event.time
    force = np.array([10 * start, 6 * start**2])
    assert (event.kind, np.hypot(*force)) == ("slip", pytest.approx(mu * mass * gravity, rel=1e-14))

    def changes(time: float, state: Any) -> Any:
        v = state[2:]
        return [*v, *(np.array([10 * time, 6 * time**2]) / mass - mu * gravity * v / np.hypot(*v))]

    along, late = force / np.hypot(*force), 1e-5
    first = along * (np.array([10, 12 * start]) / mass @ along) * late**2 / 2
    expected = solve_ivp(
        changes, [start + late, 1.0], [0, 0, *first], method="Radau", rtol=1e-9, atol=1e-14, t_eval=[0.6, 1.0]
    )
    assert answer.trajectory is not None
    columns = answer.trajectory.columns
    found = np.hstack([columns[f"block.{name}"].values[:, :2] for name in ("position", "velocity")])
    np.testing.assert_allclose(found, expected.y.T, rtol=1e-7)

"""The definitions of connections, held against answers that other formulations have confirmed.

The answered accelerations and forces of the worked scenes satisfy the laws of Newton and Euler with the definitions'
directions of forces; and every force of an answer is one that a definition names.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.multibody.audit.definitions import description_of
from core.multibody.audit.newton import Acceleration, balance
from core.multibody.audit.placement import Pose, Twist, rate
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene

FOLDER = Path(__file__).parents[4] / "examples" / "scenes"
SLOW = {"ball-in-bowl", "foucault-pendulum"}
"""Their motion takes longer than this test may."""
SKETCHED = {"sketched-linkage"}
"""Its places are found first."""
UNDECIDED = {"painleve-chalk"}
"""Without a motion."""
TOPS = {"dumbbell-dropped-in-space", "lagrange-top", "precessing-top", "sleeping-top"}
"""Of symmetric tops the axis alone is answered."""
NAMES = sorted(path.stem for path in FOLDER.glob("*.json") if path.stem not in SLOW | SKETCHED | UNDECIDED)
DESCRIBED = ("gravity", "bodies", "connections", "let", "numbers")


def worked(name: str) -> Scene:
    request: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text())
    return scene_from({key: request[key] for key in DESCRIBED if key in request})


@pytest.mark.parametrize("name", NAMES)
def test_worked_scenes_begin_as_their_connections_are_defined(name: str) -> None:
    found = description_of(worked(name))
    assert not found.undefined
    for connection in found.connections:
        for held in connection.held(found.start).values():
            assert np.max(np.abs(held)) < 1e-9
        for gap in connection.gaps(found.start).values():
            assert gap > -1e-9


@pytest.mark.parametrize("name", [name for name in NAMES if name not in TOPS])
def test_answered_forces_and_accelerations_satisfy_newton_and_euler(name: str) -> None:
    scene = worked(name)
    found = description_of(scene)
    answer = solve_scene(scene, [0.0], ("accelerations", "forces", "trajectory"))
    assert answer.trajectory is not None
    assert answer.accelerations is not None
    assert answer.forces is not None
    placement, motion, accelerations = {}, {}, {}
    for body, given in found.bodies.items():
        start, columns = given.start, answer.trajectory.columns
        placement[body] = Pose(
            *(None if x is None else x[None] for x in (start.position, start.rotation, start.turn, start.time))  # type: ignore[arg-type]
        )
        spin = angular = None
        linear = np.array(answer.accelerations[body].linear)[None]
        if given.inertia is not None:
            angular = np.array(answer.accelerations[body].angular)[None]
            own = columns.get(f"{body}.angular_velocity")
            spin = columns[f"{body}.angular_velocity_in_space"].values if own is None else own.values
            if found.dimension == 3:
                assert start.rotation is not None
                angular = angular @ start.rotation.T
                spin = spin @ start.rotation.T if own is not None else spin
        motion[body] = Twist(columns[f"{body}.velocity"].values, spin)
        accelerations[body] = Acceleration(linear, angular)
    forces = {key: np.array([one.value]) for key, one in answer.forces.items() if one.value is not None}
    left = balance(found, placement, motion, accelerations, forces)
    assert np.max(np.abs(left.left())) <= 1e-11 * np.max(left.size)
    names: set[str] = set()
    for connection in found.connections:
        efforts = connection.efforts(placement, motion)
        names |= set(efforts)
        # What strikes has no force between its blows, and none is answered.
        for key, value in () if connection.strikes else connection.laws(placement, motion).items():
            assert forces[key] == pytest.approx(value, rel=1e-9, abs=1e-9)
        for rest in connection.held_rates(placement, motion).values():
            assert np.max(np.abs(rest)) < 1e-9
        if all(key in forces for key in efforts):
            for key, value in connection.derived(placement, motion, forces).items():
                names.add(key)
                if key in forces:
                    assert forces[key] == pytest.approx(value, rel=1e-9, abs=1e-9)
    assert set(forces) <= names


def test_a_string_winds_up_by_the_radius_of_its_drum() -> None:
    scene = scene_from(
        {
            "gravity": [0, -9.81],
            "bodies": {
                "drum": {"mass": 1, "inertia": 1, "radius": 0.5, "at": [0, 0]},
                "weight": {"mass": 1, "at": [0.5, -2]},
            },
            "connections": [{"kind": "string", "name": "s", "through": ["drum", "weight"], "sides": {"drum": "right"}}],
        }
    )
    found = description_of(scene)
    (string,) = found.connections
    start = found.start["drum"]
    assert start.turn is not None
    turned = {**found.start, "drum": Pose(start.position, start.rotation, start.turn + 0.4)}
    assert string.gaps(turned)["s.tension"] == pytest.approx(-0.2)
    falling = {"drum": Twist(np.zeros(2), np.array(-2.0)), "weight": Twist(np.array([0.0, -1.0]))}
    assert string.efforts(found.start, falling)["s.tension"] == pytest.approx(0.0)


def test_rates_are_those_of_differences() -> None:
    found = description_of(worked("double-pendulum"))
    connection = found.connections[0]
    body = next(iter(found.bodies))
    motion = {body: Twist(np.array([0.3, -0.2]), np.array(0.7))}

    def measure(placement: Any) -> Any:
        return connection.held(placement)["coincidence"]

    pose, small = found.start[body], 1e-6
    assert pose.turn is not None
    later = {}
    for sign in (1, -1):
        turn = pose.turn + sign * small * 0.7
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        later[sign] = {**found.start, body: Pose(pose.position + sign * small * motion[body].velocity, rotation, turn)}
    expected = (measure(later[1]) - measure(later[-1])) / (2 * small)
    assert rate(measure, found.start, motion) == pytest.approx(expected, abs=1e-9)

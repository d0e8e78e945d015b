"""Spoiled answers are refused, and right ones are not.

Each way of spoiling is tried on twenty worked scenes, or on all that have what it spoils. What changes an answer by no
more than its stated errors is no fault; so a spoiled answer counts where it differs by more.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.audit.spoiled import (
    COLUMNS,
    MOTIONS,
    OF_OTHERS,
    OUTPUTS,
    Audited,
    another,
    answered,
    worked,
)
from tests.core.multibody.random_scenes import any_scene
from tests.core.multibody.relations import geometry, relations
from tests.core.multibody.relations.sources import catalogue
from tests.core.multibody.worked_examples import read

MOST = 20
"""Scenes on which each way of spoiling is tried."""


@cache
def right_answers() -> dict[str, Audited]:
    return {name: answered(description) for name, description in worked().items()}


def test_right_answers_pass() -> None:
    for name, one in right_answers().items():
        assert one.failure() is None, name


def differs(one: Audited, other: Audited, times: float = 30.0) -> bool:
    """Return whether two answers differ by more than their errors, in the motion or at the start."""
    motions = (one.answer.trajectory, other.answer.trajectory)
    assert motions[0] is not None
    assert motions[1] is not None
    if motions[0].columns.keys() != motions[1].columns.keys():
        # Another kind of body.
        return False
    for name, column in motions[0].columns.items():
        apart = float(np.max(np.abs(column.values - motions[1].columns[name].values), initial=0.0))
        size = float(np.max(np.abs(column.values), initial=0.0))
        if apart > times * column.error + 1e-9 * size:
            return True
    first, second = figures(one), figures(other)
    return bool(np.any(np.abs(first - second) > 1e-9 * np.maximum(1.0, np.abs(first))))


def figures(one: Audited) -> np.ndarray:
    """Return all numbers that are answered about the start."""
    answer = one.answer
    assert answer.energy is not None
    repeats = answer.period is not None and not any(part.precession is not None for part in answer.model.apart)
    found = [answer.energy.kinetic, answer.energy.potential, answer.period if repeats else 0.0]
    for body in (answer.accelerations or {}).values():
        found.extend(body.linear)
        found.extend(np.atleast_1d([] if body.angular is None else body.angular))
    found.extend(0.0 if force.value is None else force.value for force in (answer.forces or {}).values())
    return np.array(found)


def caught(spoil: Callable[[Audited], Audited]) -> int:
    """Require all of the spoiled answers to be refused, and return how many there were."""
    count = 0
    for name, one in right_answers().items():
        spoiled = spoil(one)
        if not differs(one, spoiled):
            continue
        count += 1
        assert spoiled.failure() is not None, name
        if count == MOST:
            break
    return count


@pytest.mark.parametrize("kind", COLUMNS)
def test_a_motion_with_a_wrong_column_is_refused(kind: str) -> None:
    assert caught(lambda one: one.with_columns(COLUMNS[kind])) >= 4


@pytest.mark.parametrize("kind", MOTIONS)
def test_a_wrong_motion_is_refused(kind: str) -> None:
    # Some dozen of the worked scenes have a period.
    assert caught(MOTIONS[kind]) >= (10 if "period" in kind else MOST)


@pytest.mark.parametrize("key", OF_OTHERS)
def test_the_answer_to_another_scene_is_refused(key: str) -> None:
    count = 0
    for name, description in worked().items():
        other = another(description, key)
        if other is None:
            continue
        try:
            wrong = answered(other)
        except InvalidParameter:
            # What else was written does not agree with the number any more.
            continue
        right = right_answers()[name]
        if not differs(right, wrong):
            continue
        count += 1
        spoiled = Audited(right.scene, wrong.answer, wrong.sampler, right.times)
        assert spoiled.failure() is not None, name
        if count == MOST:
            break
    assert count >= 1


@pytest.mark.parametrize("seed", range(0, 66, 3))
def test_random_scenes_pass(seed: int) -> None:
    solve_scene(read(any_scene(seed)), np.linspace(0.0, 2.0, 9), OUTPUTS)


@pytest.mark.parametrize("strength", [-5, 5])
def test_what_pulls_at_a_place_beside_a_centre_is_audited(strength: int) -> None:
    """How quick such a motion is depends on where the place is, and so on the attitude of its body."""
    rod = {"mass": 1, "inertia": "1/12", "at": [0.5, 0], "places": {"top": [-0.5, 0], "end": [0.5, 0]}}
    pin = {"kind": "pin", "a": "rod.top", "b": [0, 0]}
    law = {"kind": "inverse-square", "a": "rod.end", "b": "point", "strength": strength}
    bodies = {"rod": rod, "point": {"mass": 1, "at": [4, 0]}}
    answer = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": [pin, law]}), [0.1, 0.2])
    assert answer.trajectory is not None


def test_an_attitude_is_known_beside_one_where_all_places_are_zero() -> None:
    """A body at the origin whose axes are turned by a right angle: its quaternion has roots of a half, rounded."""
    body = {"mass": 1, "moments": [0.1, 0.2, 0.15], "at": [0, 0, 0], "axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]}
    rail = {"kind": "slider", "a": "body", "b": [0, 0, 0], "direction": [1, 0, 0]}
    answer = solve_scene(read({"gravity": [0, 0, -10], "bodies": {"body": body}, "connections": [rail]}), [0.5])
    assert answer.trajectory is not None


def test_a_component_that_is_zero_for_every_share_is_answered_alone() -> None:
    """Two wires hold a bead at their lowest point: across their normal both forces are zero, along it they share."""
    wires = [{"kind": "track", "name": k, "place": "bead", "on": {"at": [0, 0], "curvature": 1}} for k in ("a", "b")]
    scene = {"gravity": [0, -10], "bodies": {"bead": {"mass": 1, "at": [0, 0]}}, "connections": wires}
    answer = solve_scene(read(scene), [0.1, 0.3], ("trajectory", "forces-in-time"))
    assert answer.trajectory is not None
    assert "a.x" in answer.trajectory.columns
    assert "a.y" not in answer.trajectory.columns


@pytest.mark.parametrize("name", ["yo-yo", "rod-on-edge", "double-atwood-machine"])
def test_right_answers_far_from_the_origin_pass(name: str) -> None:
    """Where coordinates are large, the directions of short arms are known to their rounding."""
    far = geometry.moved(catalogue()[name], ["1e6", "-7/3"])
    assert far is not None
    assert relations.answered(far.request).trajectory is not None


def test_forces_at_the_start_that_do_not_follow_from_others_are_refused() -> None:
    """The tensions at the ends of a rope are half of its friction below and above its mean tension."""
    bodies = {"a": {"mass": 1, "at": [-0.1, -1]}, "b": {"mass": 3, "at": [0.1, -1]}}
    rope = {"kind": "string", "name": "s", "through": ["a", [-0.1, 0], [0.1, 0], "b"], "friction": 0.1}
    one = answered({"gravity": [0, -9.81], "bodies": bodies, "connections": [rope]}, [0.0, 0.3])
    assert one.failure() is None
    forces = dict(one.answer.forces or {})
    value = forces["s.1.tension"].value
    assert value is not None
    forces["s.1.tension"] = replace(forces["s.1.tension"], value=value * (1 + 1e-9))
    failure = replace(one, answer=replace(one.answer, forces=forces)).failure()
    assert failure is not None
    assert failure.law == "s.1.tension by the others"


@pytest.mark.parametrize("height", ["1e-300", "1e-100", "1e-30", 0])
def test_what_falls_through_a_floor_is_seen_however_low_it_begins(height: Any) -> None:
    def above(floor: float) -> dict[str, Any]:
        return {
            "gravity": [0, -9.81],
            "bodies": {"p": {"mass": 1, "at": [1, height]}},
            "connections": [
                {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, floor]}},
                {"kind": "force", "place": "p", "force": ["-0.1*vx*speed", "-0.1*vy*speed"]},
            ],
        }

    right, wrong = answered(above(0)), answered(above(-100))
    assert right.failure() is None
    assert Audited(right.scene, wrong.answer, wrong.sampler, right.times).failure() is not None


@pytest.mark.parametrize("law", ["sqrt(-t)", "acos(1+t)", "sqrt(-t)*length-1"])
def test_a_law_without_a_value_after_the_start_is_checked_there(law: str) -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0.6, 0.8]}},
        "connections": [
            {"kind": "spring", "name": "s", "a": "p", "b": [0, 0], "law": law, "rest_length": 1},
            {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, -5]}},
        ],
    }
    right = answered(scene, outputs=("trajectory", "accelerations"))
    assert right.failure() is None
    assert right.answer.ended is not None
    assert (right.answer.ended.kind, right.answer.ended.time) == ("formula", 0.0)


@pytest.mark.parametrize("attitudes", [False, True])
@pytest.mark.parametrize(("friction", "x"), [(1, 0.32050666152922186), (0.2, 0.3035520914710049)])
def test_a_top_on_a_rough_floor_is_answered_with_its_attitude_and_without(
    attitudes: bool, friction: float, x: float
) -> None:
    """Of a body that is answered by its axis no place has a known rate: it sticks or slides all the same.

    Where its centre of mass is after 0.1 s: the equations of a rod that falls over, by DOP853 at 1e-13.
    """
    scene = {
        "gravity": [0, 0, -10],
        "bodies": {
            "rod": {
                "mass": 1,
                "moments": [0.04, 0.04, 0.01],
                "at": [0.3, 0, 0.4],
                "axes": [[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]],
                "places": {"toe": [0, 0, -0.5]},
            }
        },
        "connections": [
            {
                "kind": "contact",
                "place": "rod.toe",
                "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
                "friction": friction,
            }
        ],
        "attitudes": attitudes,
    }
    found = solve_scene(read(scene), np.array([0.1]), ("trajectory", "forces-in-time")).trajectory
    assert found is not None
    assert found.columns["rod.position"].values[0, 0] == pytest.approx(x, abs=1e-12)


@pytest.mark.parametrize("x", [0, 10**6, -(10**7)])
def test_a_band_brake_is_answered_wherever_it_stands(x: int) -> None:
    """Its wrap is that of directions, which are known as well as differences of places are; both parts are upright."""
    scene = catalogue()["band-brake"]
    scene = copy.deepcopy({key: scene[key] for key in ("gravity", "bodies", "connections")})
    for body in scene["bodies"].values():
        body["at"][0] = f"({body['at'][0]}) + ({x})"
    pin, band = scene["connections"]
    pin["b"][0] = x
    band["through"][0][0] = f"({band['through'][0][0]}) + ({x})"
    found = solve_scene(read(scene), np.array([0.1]), ("trajectory", "forces-in-time"))
    assert found.trajectory is not None
    pull = found.trajectory.columns["band.1.tension"].values[0]
    assert pull == pytest.approx(2 * 9.81 * np.exp(0.3 * np.pi), rel=1e-12)

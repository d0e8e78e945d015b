"""Whether how a load is shared goes on not to matter: a table on four feet that slides."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

FEET = {"a": [0.5, 0.5, -0.2], "b": [0.5, -0.5, -0.2], "c": [-0.5, 0.5, -0.2], "d": [-0.5, -0.5, -0.2]}


def on_feet(*more: Any, gravity: Any = (0, 0, -9.81), names: str = "abcd") -> SceneSolution:
    """A table that slides on feet beside other connections."""
    plane = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    feet = [{"kind": "contact", "name": name, "place": f"table.{name}", "on": plane, "friction": 0.1} for name in names]
    table = {"mass": 2, "moments": [0.3, 0.3, 0.5], "at": [0, 0, 0.2], "velocity": [1, 0.2, 0], "places": FEET}
    scene = {"gravity": list(gravity), "bodies": {"table": table}, "connections": [*feet, *more]}
    return solve_scene(scene_from(scene), [0.1, 0.3], ("trajectory",))


@pytest.mark.parametrize("begins", [0, 0.125])
def test_friction_depends_on_the_shares_as_soon_as_what_slides_begins_to_turn(begins: float) -> None:
    """A spring at a corner: the slips of the feet are equal at first and part with the square of the turn."""
    pull = {"kind": "spring", "a": "table.a", "b": [3, 2, 0], "stiffness": 3, "rest_length": 1}
    answer = on_feet(pull | ({"from": begins} if begins else {}))
    assert answer.problem is not None
    assert (answer.problem.code, answer.problem.connections) == ("undetermined-friction", ("a", "b", "c", "d"))
    assert answer.problem.time == begins


def test_on_three_feet_nothing_is_left_open() -> None:
    answer = on_feet({"kind": "torque", "body": "table", "torque": [0, 0, 0.2]}, names="bcd")
    assert answer.problem is None


def test_what_translates_has_the_friction_of_a_place_however_its_direction_turns() -> None:
    """On a slope, across which the table slides, as a stone does."""
    gravity = (0, 1.5, -9.5)
    answer = on_feet(gravity=gravity)
    contact = {"kind": "contact", "place": "stone", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.1}
    stone = {"mass": 2, "at": [0, 0, 0], "velocity": [1, 0.2, 0]}
    scene = {"gravity": list(gravity), "bodies": {"stone": stone}, "connections": [contact]}
    alone = solve_scene(scene_from(scene), [0.1, 0.3], ("trajectory",))
    assert answer.problem is None
    assert answer.trajectory is not None
    assert alone.trajectory is not None
    velocities = [
        one.trajectory.columns[name].values for one, name in ((answer, "table.velocity"), (alone, "stone.velocity"))
    ]
    np.testing.assert_allclose(*velocities, rtol=0, atol=1e-12)


HEXAGON = {"a": (0.5, 0), "b": (0.3, 0.4), "c": (-0.3, 0.4), "d": (-0.5, 0), "e": (-0.3, -0.4), "f": (0.3, -0.4)}


@pytest.mark.parametrize("feet", [{name: (x, y) for name, (x, y, _) in FEET.items()}, HEXAGON])
def test_what_turns_about_its_middle_rubs_alike_however_the_load_is_shared(feet: dict[str, Any]) -> None:
    """Opposite feet rub against one another: the torque is mu m g r whatever each carries."""
    plane = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    contacts = [
        {"kind": "contact", "name": name, "place": f"table.{name}", "on": plane, "friction": 0.1} for name in feet
    ]
    places = {name: [x, y, -0.2] for name, (x, y) in feet.items()}
    table = {"mass": 2, "moments": [0.3, 0.3, 0.5], "at": [0, 0, 0.2], "angular_velocity": [0, 0, 2], "places": places}
    scene = {"gravity": [0, 0, -9.81], "bodies": {"table": table}, "connections": contacts}
    slowing = 0.1 * 2 * 9.81 * np.hypot(*feet["a"]) / 0.5
    times = [0.1, 0.3, 0.6]
    answer = solve_scene(scene_from(scene), times, ("trajectory",))
    assert answer.problem is None
    assert answer.trajectory is not None
    turns = answer.trajectory.columns["table.angular_velocity"]
    expected = [[0, 0, 2 - slowing * t] for t in times]
    np.testing.assert_allclose(turns.values, expected, rtol=0, atol=1e-14)


def test_speeds_that_are_zero_have_the_scale_of_the_turn() -> None:
    """On three feet, about a centre that stays where it is: what rounding leaves of its speed was its scale."""
    plane = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    places = {"a": [0.5, 0, -0.2], "b": [-0.3, 0.4, -0.2], "c": [-0.3, -0.4, -0.2]}
    contacts = [{"kind": "contact", "place": f"table.{name}", "on": plane, "friction": 0.1} for name in places]
    table = {"mass": 2, "moments": [0.3, 0.3, 0.5], "at": [0, 0, 0.2], "angular_velocity": [0, 0, 2], "places": places}
    scene = {"gravity": [0, 0, -9.81], "bodies": {"table": table}, "connections": contacts}
    answer = solve_scene(scene_from(scene), [0.1, 0.3], ("trajectory",))
    assert answer.trajectory is not None
    np.testing.assert_allclose(answer.trajectory.columns["table.velocity"].values, 0, rtol=0, atol=1e-30)
    turns = answer.trajectory.columns["table.angular_velocity"].values
    np.testing.assert_allclose(turns[:, 2], [2 - 0.981 * 2 * t for t in (0.1, 0.3)], rtol=0, atol=1e-14)


def test_a_turn_that_begins_by_hardly_anything_has_friction_that_turns() -> None:
    """A torque that grows until three feet let go: it is followed with them or not at all."""
    plane = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    places = {"a": [0.5, 0, -0.2], "b": [-0.3, 0.4, -0.2], "c": [-0.3, -0.4, -0.2]}
    contacts = [{"kind": "contact", "place": f"table.{name}", "on": plane, "friction": 0.1} for name in places]
    torque = {"kind": "torque", "body": "table", "torque": [0, 0, "2*t"]}
    table = {"mass": 2, "moments": [0.3, 0.3, 0.5], "at": [0, 0, 0.2], "places": places}
    scene = {"gravity": [0, 0, -9.81], "bodies": {"table": table}, "connections": [*contacts, torque]}
    answer = solve_scene(scene_from(scene), [0.3, 0.6, 1.0], ("trajectory",))
    assert answer.trajectory is not None
    column = answer.trajectory.columns["table.angular_velocity"]
    expected = [max(t - 0.4905, 0) ** 2 / 0.5 for t in (0.3, 0.6, 1.0)[: len(column.values)]]
    np.testing.assert_allclose(column.values[:, 2], expected, rtol=0, atol=max(column.error, 1e-15))

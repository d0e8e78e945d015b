"""Strings that would have to push at the start are slack, also where no motion is requested."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import NotApplicable
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

START = ("accelerations", "forces")


def bob(**others: Any) -> dict[str, Any]:
    string = {"kind": "string", "name": "s", "through": ["bob", [0, 0]]}
    return {"gravity": [0, -9.81], "bodies": {"bob": {"mass": 1, "at": [0, -1]} | others}, "connections": [string]}


def above(degrees: int) -> dict[str, Any]:
    return bob(at={"polar": [1, {"degrees": degrees}]})


def pushed(connection: dict[str, Any]) -> dict[str, Any]:
    scene = bob()
    return scene | {"connections": [*scene["connections"], connection]}


IN_SPACE = {
    "gravity": [0, 0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": [0.6, 0, 0.8], "velocity": [0, 1, 0]}},
    "connections": [{"kind": "string", "name": "s", "through": ["bob", [0, 0, 0]]}],
}

# What pulls a free particle: gravity, and what else is connected with it.
SLACK = [
    (above(90), [0.0, -9.81]),
    (above(60), [0.0, -9.81]),
    (above(1), [0.0, -9.81]),
    (pushed({"kind": "force", "place": "bob", "force": [0, 20]}), [0.0, 10.19]),
    (pushed({"kind": "spring", "a": "bob", "b": [0, 0], "stiffness": 100, "rest_length": 0.5}), [0.0, 40.19]),
    (IN_SPACE, [0.0, 0.0, -9.81]),
]


@pytest.mark.parametrize("times", [(), (0.01,)])
@pytest.mark.parametrize(("scene", "acceleration"), SLACK)
def test_a_string_does_not_push(scene: dict[str, Any], acceleration: list[float], times: tuple[float, ...]) -> None:
    answer = solve_scene(read(scene), times, START)
    assert answer.accelerations is not None
    assert answer.accelerations["bob"].linear == pytest.approx(acceleration, abs=1e-14)
    assert answer.forces is not None
    assert answer.forces["s.tension"].value == 0.0


@pytest.mark.parametrize("times", [(), (0.01,)])
@pytest.mark.parametrize(("scene", "acceleration"), SLACK)
def test_what_slack_strings_are_not_answered_for_is_refused(
    scene: dict[str, Any], acceleration: list[float], times: tuple[float, ...]
) -> None:
    with pytest.raises(NotApplicable, match="slack"):
        solve_scene(read(scene), times, ("equilibria",))
    with pytest.raises(NotApplicable, match="s would have to push at the start"):
        proven_answer(read(scene), 20)


@pytest.mark.parametrize("scene", [scene for scene, _ in SLACK])
def test_it_was_slack_before_as_it_is_afterwards(scene: dict[str, Any]) -> None:
    """What pulls the bob is the same at mirrored places: its motion is even but for its velocity."""
    answer = solve_scene(read(scene), (-0.05, 0.05), ("trajectory",))
    assert answer.trajectory is not None
    assert not answer.events
    own, velocity = answer.trajectory.columns["bob.position"], scene["bodies"]["bob"].get("velocity", 0.0)
    before, after = own.values
    assert np.allclose(after - before, 0.1 * np.array(velocity), rtol=0.0, atol=2.0 * own.error + 1e-17)


def test_a_string_that_pulls_is_taut() -> None:
    answer = solve_scene(read(bob()), (), (*START, "equilibria"))
    assert answer.forces is not None
    assert answer.forces["s.tension"].value == 9.81
    assert answer.equilibria


@pytest.mark.parametrize("more", ["1e-8", "1e-3", "0.05"])
def test_a_string_that_is_longer_than_its_way_is_slack_until_that_is_fallen(more: str) -> None:
    """g t^2/2 is what it is longer by, however little that is."""
    string = {"kind": "string", "name": "s", "through": ["p", [0, 0]], "length": f"1 + {more}"}
    scene = {"gravity": [0, -10], "bodies": {"p": {"mass": 1, "at": [0, -1]}}, "connections": [string]}
    (taut,) = (one for one in solve_scene(read(scene), [1.0], ("trajectory",)).events if one.time > 0)
    assert (taut.kind, taut.name) == ("taut", "s")
    assert taut.time == pytest.approx((float(more) / 5) ** 0.5, rel=1e-12)

"""Forces that change in time on what rests: it slips, lifts off or becomes slack when its forces demand it.

The times and places are those of the textbook: force against weight times the coefficient of friction, and the integral
of what is left over.
"""

from __future__ import annotations

from math import acos, asin, exp, log, tau
from typing import Any

import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from tests.core.multibody.worked_examples import read

FLOOR = {"kind": "contact", "name": "floor", "place": "b", "on": {"at": [0, 0]}}
ROUGH = FLOOR | {"friction": "1/2"}


def pushed(force: list[Any], *connections: dict[str, Any], **more: Any) -> dict[str, Any]:
    push = {"kind": "force", "name": "f", "place": "b", "force": force}
    scene = {"gravity": [0, -10], "bodies": {"b": {"mass": 1, "at": [0, 0]}}} | more
    return scene | {"connections": [*connections, push]}


def answer(scene: dict[str, Any], *times: float, **more: Any) -> SceneSolution:
    return solve_scene(read(scene), times, more.pop("outputs", ("trajectory", "forces-in-time")))


def placed(found: SceneSolution, place: list[float]) -> None:
    assert found.trajectory is not None
    own = found.trajectory.columns["b.position"]
    assert np.max(np.abs(own.values[-1] - place)) <= own.error + 2.0**-52 * max(map(abs, place))


SPRING = {"kind": "spring", "a": "b", "b": [9, 0], "law": "2*t"}


@pytest.mark.parametrize(
    ("scene", "kinds", "times", "place"),
    [
        # x'' = 2 t - 5 from 5/2 s on.
        (pushed(["2*t", 0], ROUGH), ["slip"], [2.5], [1.125, 0]),
        (pushed([0, 0], ROUGH, SPRING), ["slip"], [2.5], [1.125, 0]),
        # x'' = 3 - (10 - 4 t)/2 from 1 s on, 3 from 5/2 s on, where y'' = 4 t - 10.
        (pushed([3, "4*t"], ROUGH), ["slip", "lift-off"], [1, 2.5], [7.875, 2.25]),
        (pushed([0, "4*t"], FLOOR), ["lift-off"], [2.5], [0, 2.25]),
        # x'' = e^t - 5.
        (pushed(["exp(t)", 0], ROUGH), ["slip"], [log(5)],
         [exp(4) - 5 - 5 * (4 - log(5)) - 2.5 * (4 - log(5)) ** 2, 0]),
        # x'' = 2 sqrt(t + 1) - 5.
        (pushed(["2*sqrt(t + 1)", 0], ROUGH), [], [], [0, 0]),
        # The load is no polynomial, and less than the weight by a hundred thousandth of it at most.
        (pushed([0, "9.9999*sin(7*t)"], FLOOR), [], [], [0, 0]),
    ],
)  # fmt: skip
def test_a_block_moves_when_the_force_is_too_large(
    scene: dict[str, Any], kinds: list[str], times: list[float], place: list[float]
) -> None:
    found = answer(scene, 0.0, 1.0, 4.0)
    assert [event.kind for event in found.events] == kinds
    for event, time in zip(found.events, times, strict=True):
        assert abs(event.time - time) <= (event.error or 0.0) + 2.0**-52 * time
    placed(found, place)
    assert found.model.name == "rest"


def test_it_lifts_off_for_the_moment_in_which_the_force_is_larger_than_the_weight() -> None:
    found = answer(pushed([0, "10.0001*sin(7*t)"], FLOOR), 0.3)
    assert [event.kind for event in found.events] == ["lift-off", "touch"]
    assert found.events[0].time == pytest.approx(asin(10 / 10.0001) / 7, rel=1e-14)


def test_a_string_is_slack_when_its_weight_is_lifted() -> None:
    scene = pushed([0, "12*t"], {"kind": "string", "name": "s", "through": ["b", [0, 1]]})
    found = answer(scene, 0.0, 0.8, 1.2)
    (slack,) = found.events
    assert slack.kind == "slack"
    assert slack.time == pytest.approx(5 / 6, rel=1e-15)
    late = 1.2 - 5 / 6
    placed(found, [0, 2 * late**3])


def test_in_space_it_slips_along_the_force_and_turned_it_does_the_same() -> None:
    floor = {"kind": "contact", "name": "floor", "place": "b", "friction": "1/2", "on": {"at": [0, 0, 0]}}
    flat, tilted = ({"normal": [0, 0, 1]}, {"normal": ["3/5", 0, "4/5"]})
    for normal, gravity, force, place in (
        (flat, [0, 0, -10], ["6/5*t", "8/5*t", 0], [0.675, 0.9, 0]),
        (tilted, [-6, 0, -8], ["24/25*t", "8/5*t", "-18/25*t"], [0.54, 0.9, -0.405]),
    ):
        on = {"on": floor["on"] | normal}
        found = answer(pushed(force, floor | on, bodies={"b": {"mass": 1, "at": [0, 0, 0]}}, gravity=gravity), 4.0)
        (slip,) = found.events
        assert slip.kind == "slip"
        assert slip.time == pytest.approx(2.5, rel=1e-15)
        placed(found, place)


def test_what_moves_pushes_what_rests() -> None:
    """A bob that swings past pushes a block by a law of where it is: 4 x, up to 5 N at sin a = 3/5."""
    scene = pushed(["4*c.x", 0], ROUGH, {"kind": "spring", "a": "c", "b": [0, 3], "stiffness": 4, "rest_length": 0})
    scene["gravity"] = [0, -10]
    scene["bodies"]["c"] = {"mass": 1, "at": [0, 0.5], "velocity": [4, 0]}
    found = answer(scene, 0.0, 1.0)
    # The bob is at x = 2 sin(2 t).
    assert found.events[0].kind == "slip"
    assert found.events[0].time == pytest.approx(asin(5 / 8) / 2, rel=1e-14)


def test_what_goes_on_evenly_pushes_what_rests() -> None:
    """The force is 2 t, of where another body is: what begins to slip has an acceleration of rounding alone."""
    scene = pushed(["2*(c.x - 5)", 0], ROUGH, FLOOR | {"name": "ice", "place": "c"})
    scene["bodies"]["c"] = {"mass": 1, "at": [5, 0], "velocity": [1, 0]}
    found = answer(scene, 4.0)
    assert [event.kind for event in found.events] == ["slip"]
    placed(found, [1.125, 0])


def test_forces_of_what_is_held_are_searched() -> None:
    """A weld holds a rod under a torque and a force, whose moment about the weld is cos(3 t)/2."""
    rod = {"mass": 1, "inertia": "1/12", "at": [0, "-1/2"], "places": {"h": [0, "1/2"]}}
    weld = {"kind": "weld", "name": "w", "a": "b.h", "b": [0, 0]}
    torque = {"kind": "torque", "name": "q", "body": "b", "torque": "2*sin(5*t)"}
    scene = pushed(["cos(3*t)", 0], weld, torque, bodies={"b": rod})
    found = answer(scene, 0.0, 2.0, outputs=("forces-in-time", ExtremesOf("w.x"), When("w.x", 0.5), ExtremesOf("w.y")))
    assert found.extremes is not None
    assert found.occurrences is not None
    across, up = found.extremes
    assert (across.least, across.largest) == (-1.0, pytest.approx(1.0, rel=1e-15))
    assert across.largest_time == pytest.approx(tau / 6, rel=1e-14)
    assert (up.least, up.largest) == (pytest.approx(10), pytest.approx(10))
    times = [one.time for one in found.occurrences]
    assert times == pytest.approx([acos(-0.5) / 3, (tau - acos(-0.5)) / 3], rel=1e-14)
    assert found.trajectory is not None
    t = found.trajectory.time
    own = found.trajectory.columns["w.moment"]
    assert np.max(np.abs(own.values + 2 * np.sin(5 * t) + np.cos(3 * t) / 2)) <= own.error + 1e-15


def test_steps_are_not_bounded_by_forces_that_are_polynomials_in_time() -> None:
    """What starts away from the origin is measured as well: x = 1 + t^2/2 + t^3/3, and others of few powers."""
    for force, exact in (("2*t + 1", 1 + 2 + 8 / 3), ("t^2/2", 1 + 16 / 24), ("2*t*(1 + c.vx)", 1 + 8 / 3)):
        scene = pushed(
            [force, 0], bodies={"b": {"mass": 1, "at": [1, 0]}, "c": {"mass": 1, "at": [0, 5]}}, gravity=[0, 0]
        )
        placed(answer(scene, 2.0), [exact, 0])

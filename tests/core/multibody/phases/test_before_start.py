"""Times before the start of a scene with contacts: closed forms, and the same motion with its velocities reversed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read

GRAVITY = 9.81


def thrown(up: float, across: float = 1.0, height: float = 1.0) -> dict[str, Any]:
    return {
        "gravity": [0, -GRAVITY],
        "bodies": {"ball": {"mass": 2, "at": [0, height], "velocity": [across, up]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.5}
        ],
    }


def test_a_thrown_ball_left_the_floor_at_the_other_root_of_its_parabola() -> None:
    """Height 1 + 2 t - g t^2/2 vanishes at t = (2 - sqrt(4 + 2 g))/g before the start."""
    answer = solve_scene(read(thrown(2.0)), [-0.5, -0.2, -0.1, 0.1], ("trajectory",))
    event, expected = answer.events[0], (2.0 - np.sqrt(4.0 + 2.0 * GRAVITY)) / GRAVITY
    assert (event.kind, event.name) == ("touch", "floor")
    assert event.time == pytest.approx(expected, abs=4e-16)
    assert answer.trajectory is not None
    assert answer.trajectory.rows is not None
    assert answer.trajectory.rows.tolist() == [1, 2, 3]
    times = np.array([-0.2, -0.1, 0.1])
    own = column(answer, "ball.position")
    assert np.allclose(own.values[:, 1], 1.0 + 2.0 * times - GRAVITY * times**2 / 2.0, rtol=0.0, atol=own.error)


def test_what_slides_was_faster_before() -> None:
    """A block that slides to rest has x = v t - mu g t^2/2 at all times until then, also before the start."""
    scene = thrown(0.0, across=3.0, height=0.0)
    scene["connections"][0] |= {"friction": 0.25, "restitution": 0}
    times = np.array([-2.0, -0.75, 0.5])
    answer = solve_scene(read(scene), times, ("trajectory", "forces-in-time"))
    own = column(answer, "ball.position")
    assert np.allclose(own.values[:, 0], 3.0 * times - 0.25 * GRAVITY * times**2 / 2.0, rtol=0.0, atol=own.error)
    assert not answer.events


def test_without_friction_the_past_is_the_future_of_reversed_velocities() -> None:
    """A stone in a hollow sphere lifts off: its motion backwards from there on is that with reversed velocities."""

    def stone(sign: float) -> dict[str, Any]:
        return {
            "gravity": [0, 0, -GRAVITY],
            "bodies": {"stone": {"mass": 1, "at": [0, 0, -0.5], "velocity": [sign * 2.4, sign * 3.2, 0]}},
            "connections": [
                {"kind": "contact", "name": "sphere", "place": "stone", "on": {"at": [0, 0, 0], "radius": -0.5}}
            ],
        }

    times = np.array([0.1, 0.2, 0.3])
    forwards = solve_scene(read(stone(-1.0)), [*times, 0.35], ("trajectory", "forces-in-time"))
    backwards = solve_scene(read(stone(1.0)), [*-times, -0.35], ("trajectory", "forces-in-time"))
    leaves, left = forwards.events[0], backwards.events[0]
    assert (left.kind, left.name) == (leaves.kind, leaves.name) == ("lift-off", "sphere")
    assert -left.time == pytest.approx(leaves.time, abs=left.error + leaves.error)
    for name in ("stone.position", "sphere.normal"):
        one, other = column(forwards, name), column(backwards, name)
        assert np.allclose(one.values[:3], other.values[:3], rtol=0.0, atol=one.error + other.error), name


def test_a_string_that_is_taut_was_slack_before() -> None:
    """A stone thrown upwards on its string: the past is the mirrored future, where the string becomes slack."""
    scene: dict[str, Any] = {
        "gravity": [0, -GRAVITY],
        "bodies": {"stone": {"mass": 1, "at": [0, -1], "velocity": [6, 0]}},
        "connections": [{"kind": "string", "name": "s", "through": [[0, 0], "stone"], "restitution": 0}],
    }
    answer = solve_scene(read(scene), [-0.9, -0.1, 0.1, 0.9], ("trajectory",))
    before, after = answer.events[:2]
    assert (before.kind, after.kind) == ("slack", "slack")
    assert -before.time == pytest.approx(after.time, abs=before.error + after.error)


def test_before_an_impact_at_the_start_nothing_is_determined() -> None:
    with pytest.raises(InvalidParameter, match="floor changes at the start") as refused:
        solve_scene(read(thrown(-1.0, height=0.0)), [0.1, -0.1], ("trajectory",))
    assert refused.value.path == ("times", 1)


def test_before_friction_begins_at_the_start_nothing_is_determined() -> None:
    """A block that begins to slide from rest would have slid the other way before, and friction with it."""
    scene = thrown(0.0, across=0.0, height=0.0)
    scene["gravity"] = [5, -5]
    scene["connections"][0] |= {"friction": 0.25, "restitution": 0}
    with pytest.raises(InvalidParameter, match="floor changes at the start"):
        solve_scene(read(scene), [-0.1, 0.1], ("trajectory",))


def test_works_before_the_start_are_those_of_the_parabola() -> None:
    """Gravity does -m g (y - y0), with y - y0 = 2 t - g t^2/2; contacts do nothing."""
    answer = solve_scene(read(thrown(2.0)), [-0.1, 0.1], ("work-in-time",))
    times = np.array([-0.1, 0.1])
    work = column(answer, "gravity.work")
    assert np.allclose(
        work.values, -2.0 * GRAVITY * (2.0 * times - GRAVITY * times**2 / 2.0), rtol=0.0, atol=work.error
    )
    assert not column(answer, "floor.impacts.work").values.any()


def test_a_turning_slip_is_answered_from_the_start_on() -> None:
    across_a_slope: dict[str, Any] = {
        "gravity": [0, "-9.81*sin(pi/6)", "-9.81*cos(pi/6)"],
        "bodies": {"stone": {"mass": 1, "at": [0, 0, 0], "velocity": [2, 0, 0]}},
        "connections": [
            {
                "kind": "contact",
                "place": "stone",
                "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
                "friction": 0.3,
            }
        ],
    }
    with pytest.raises(NotApplicable, match="turns with the slip"):
        solve_scene(read(across_a_slope), [-0.1, 0.1], ("trajectory",))

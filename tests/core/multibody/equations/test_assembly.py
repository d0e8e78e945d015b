"""States at the start: what is rounded is fitted, what contradicts is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


def four_bar(x: Any, y: Any) -> Any:
    return read(
        {
            "gravity": [0, -9.81],
            "bodies": {"p": {"mass": 1, "at": [0, 1]}, "q": {"mass": 1, "at": [x, y]}},
            "connections": [
                {"kind": "rod", "a": "p", "b": [0, 0], "length": 1},
                {"kind": "rod", "a": "p", "b": "q", "length": 2},
                {"kind": "rod", "a": "q", "b": [3, 0], "length": 2},
            ],
        }
    )


def exact() -> tuple[float, float]:
    """Return where circles of radius 2 about (0, 1) and (3, 0) meet, above."""
    d = math.sqrt(10)
    h = math.sqrt(4 - d * d / 4)
    return 1.5 + h / d, 0.5 + 3 * h / d


def test_rounded_positions_are_moved_onto_the_connections() -> None:
    x, y = exact()
    answer = solve_scene(four_bar(f"{x:.9f}", f"{y:.9f}"), [0.0])
    assert any("moved by rounding" in sentence for sentence in answer.model.noticed)
    place = column(answer, "q.position").values[0]
    assert math.hypot(*place - np.array([3, 0])) == pytest.approx(2, rel=1e-15)
    assert place == pytest.approx((x, y), abs=1e-8)
    assert answer.model.degrees_of_freedom == 1


def test_positions_off_by_more_are_refused() -> None:
    x, y = exact()
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(four_bar(x + 0.01, y))
    assert refused.value.path in {("connections", 1, "length"), ("connections", 2, "length")}


def test_rounded_velocities_are_taken_as_meant() -> None:
    c, s = math.cos(0.3), math.sin(0.3)
    body = {"mass": 1, "at": ["sin(0.3)", "-cos(0.3)"], "velocity": [f"{2 * c:.13f}", f"{2 * s:.13f}"]}
    answer = solve_scene(
        read({"gravity": [0, -9.81], "bodies": {"p": body}, "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}]})
    )
    assert any("taken as rounded" in sentence for sentence in answer.model.noticed)
    assert answer.energy is not None
    assert answer.energy.kinetic == pytest.approx(2, rel=1e-12)


def test_velocities_given_in_part_are_completed() -> None:
    # A rod between a floor and a wall: the foot's speed is that of the head, and of the turn.
    ladder = {
        "mass": 1,
        "inertia": 0.3,
        "at": [0.3, 0.4],
        "places": {"foot": [0.3, -0.4], "head": [-0.3, 0.4]},
        "angular_velocity": 2,
    }
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"ladder": ladder},
        "connections": [
            {"kind": "track", "place": "ladder.foot", "on": {"at": [0, 0]}},
            {"kind": "track", "place": "ladder.head", "on": {"at": [0, 0], "slope": {"degrees": 90}}},
        ],
    }
    answer = solve_scene(read(scene), [0.0])
    # The centre is on a circle about the corner, and turns against the ladder.
    assert column(answer, "ladder.velocity").values[0] == pytest.approx((0.8, -0.6), rel=1e-15)

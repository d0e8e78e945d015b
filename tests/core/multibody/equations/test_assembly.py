"""States at the start: what is rounded is fitted, what contradicts is refused."""

from __future__ import annotations

import math
from fractions import Fraction
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


def turned(vector: list[str], digits: int | None) -> list[str]:
    """Return a vector turned by acos 5/13 about x and acos 3/5 about z, in fractions or rounded to decimals."""
    x, y, z = map(Fraction, vector)
    y, z = (5 * y - 12 * z) / 13, (12 * y + 5 * z) / 13
    x, y = (3 * x - 4 * y) / 5, (4 * x + 3 * y) / 5
    return [str(value) if digits is None else f"{float(value):.{digits}f}" for value in (x, y, z)]


def hinged(moments: list[str], hinge: list[str], digits: int | None) -> dict[str, Any]:
    """Return two bodies in space with a hinge between them, one on a ball joint; all typed with so many digits."""
    axes = [turned(axis, digits) for axis in (["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"])]
    body = {"mass": 1, "moments": moments, "axes": axes}
    return {
        "gravity": turned(["0", "0", "-10"], None),
        "bodies": {
            "a": body | {"at": [0, 0, 0], "places": {"p": ["1/2", 0, 0], "q": [0, "3/10", "4/10"]}},
            "b": body | {"at": turned(["1", "0", "0"], digits), "places": {"p": ["-1/2", 0, 0]}},
        },
        "connections": [
            {"kind": "pin", "a": "a.p", "b": "b.p", "axis": turned(hinge, digits)},
            {"kind": "ball-joint", "a": "a.q", "b": turned(["0", "3/10", "4/10"], digits)},
        ],
    }


@pytest.mark.parametrize("digits", [8, 11])
@pytest.mark.parametrize("moments", [["1/10", "2/10", "3/10"], ["1/5", "1/5", "1/5"]])
@pytest.mark.parametrize("hinge", [["0", "0", "1"], ["3/5", "4/5", "0"], ["2/3", "1/3", "2/3"]])
def test_rows_that_are_redundant_to_rounding_are_redundant(moments: list[str], hinge: list[str], digits: int) -> None:
    """A hinge repeats what makes its bodies rigid: three rows of which two are independent, on its places alone."""
    times = [0.2, 0.5]
    exact = solve_scene(read(hinged(moments, hinge, None)), times, ("trajectory",))
    rounded = solve_scene(read(hinged(moments, hinge, digits)), times, ("trajectory",))
    assert exact.model.degrees_of_freedom == rounded.model.degrees_of_freedom == 4
    apart = np.asarray(column(exact, "b.position").values) - np.asarray(column(rounded, "b.position").values)
    # Rounding moves the start, and the motion by little more.
    assert 0.0 < np.max(np.abs(apart)) < 100 * 10.0**-digits


def test_a_rounded_place_is_compared_with_the_body_and_not_with_a_component_that_is_nought() -> None:
    rod = {"mass": 1, "inertia": 0.1, "at": ["0.5", "1e-10"], "places": {"p": [-0.5, 0]}}
    pin = {"kind": "pin", "a": "rod.p", "b": [0, 0]}
    answer = solve_scene(read({"gravity": [0, -10], "bodies": {"rod": rod}, "connections": [pin]}))
    assert any("moved by rounding's width" in sentence for sentence in answer.model.noticed)
    rod["at"] = ["0.5", "1e-5"]
    with pytest.raises(InvalidParameter, match="agree with the positions"):
        solve_scene(read({"gravity": [0, -10], "bodies": {"rod": rod}, "connections": [pin]}))


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 0, 2), (1, 2, 0), (2, 1, 0)])
def test_what_a_motor_lifts_off_a_floor_by_a_string_rises_with_it_in_any_order(order: tuple[int, ...]) -> None:
    """The end of an arm of 1 m at 1 rad/s rises at 1 m/s, and with it what hangs there, up the slope beside it."""
    bodies = {
        "arm": {"mass": 1, "inertia": 1, "at": [0, 0], "places": {"end": [1, 0]}},
        "load": {"mass": 2, "at": [1, -1]},
    }
    one_sided = [
        {"kind": "contact", "place": "load", "on": {"at": [0, -1]}, "restitution": 1},
        {"kind": "string", "through": ["load", "arm.end"]},
        {"kind": "contact", "place": "load", "on": {"at": [1, -1], "slope": {"degrees": 30}}},
    ]
    driven = [{"kind": "pin", "a": "arm", "b": [0, 0]}, {"kind": "motor", "a": "arm", "rate": 1}]
    connections = [*driven, *(one_sided[i] for i in order)]
    scene = read({"gravity": [0, -9.81], "bodies": bodies, "connections": connections})
    answer = solve_scene(scene, [0.0, 0.1])
    assert column(answer, "load.velocity").values[0][1] == 1.0
    assert answer.energy is not None
    assert answer.energy.kinetic == pytest.approx(0.5 + (1 / math.sin(math.pi / 6)) ** 2, rel=1e-15)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_what_may_rest_or_rise_beside_a_slack_string_rests_in_any_order(order: tuple[int, ...]) -> None:
    """What hangs below rises: its string can stay taut, or what it hangs from on its shelf, but not both."""
    bodies = {"upper": {"mass": 1, "at": [0, 1]}, "lower": {"mass": 1, "at": [0, 0.5], "velocity": [0, 1]}}
    connections = [
        {"kind": "string", "through": ["upper", "lower"], "restitution": 0},
        {"kind": "contact", "place": "upper", "on": {"at": [0, 1]}},
    ]
    scene = {"gravity": [0, -10], "bodies": bodies, "connections": [connections[i] for i in order]}
    answer = solve_scene(read(scene), [0.0, 0.05])
    assert column(answer, "upper.velocity").values[0].tolist() == [0.0, 0.0]
    assert answer.energy is not None
    assert answer.energy.kinetic == 0.5


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_what_could_follow_one_of_two_slack_strings_rests_in_any_order(order: tuple[int, ...]) -> None:
    """Both ends approach the middle as fast: neither string is preferred."""
    bodies = {
        "left": {"mass": 1, "at": [-1, 0], "velocity": [1, 0]},
        "middle": {"mass": 1, "at": [0, 0]},
        "right": {"mass": 1, "at": [1, 0], "velocity": [-1, 0]},
    }
    connections = [{"kind": "string", "through": [end, "middle"], "restitution": 0} for end in ("left", "right")]
    scene = {"bodies": bodies, "connections": [connections[i] for i in order]}
    answer = solve_scene(read(scene), [0.0, 0.05])
    assert column(answer, "middle.velocity").values[0].tolist() == [0.0, 0.0]


def test_the_end_of_a_string_follows_the_other_where_nothing_hinders_it() -> None:
    bodies = {"a": {"mass": 1, "at": [-1, 0]}, "b": {"mass": 2, "at": [1, 0], "velocity": [0, 1]}}
    string = {"kind": "string", "through": ["a", [-1, 2], [1, 2], "b"], "restitution": 0}
    answer = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": [string]}), [0.0, 0.05])
    assert column(answer, "a.velocity").values[0].tolist() == pytest.approx([0.0, -1.0], abs=1e-15)

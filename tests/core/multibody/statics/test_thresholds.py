"""In which range of a number a scene stays at rest, against closed forms at 50 digits."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import InvalidParameter, NotApplicable
from core.multibody.answer import RestEnd, RestRange
from core.multibody.solve import solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.worked_examples import read

LADDER = {
    "gravity": [0, -9.81],
    "let": {"slope": "1.2"},
    "bodies": {
        "ladder": {
            "mass": 10,
            "inertia": "10/3",
            "at": ["-cos(slope)", "sin(slope)"],
            "angle": "slope",
            "places": {"foot": [-1, 0], "head": [1, 0]},
        }
    },
    "connections": [
        {"kind": "contact", "name": "floor", "place": "ladder.foot", "on": {"at": [0, 0]}, "friction": 0.4},
        {
            "kind": "contact",
            "name": "wall",
            "place": "ladder.head",
            "on": {"at": [0, 0], "slope": {"degrees": 90}},
            "friction": 0.3,
        },
    ],
}
INCLINE = {
    "gravity": [0, -9.81],
    "let": {"alpha": "0.2"},
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {
            "kind": "contact",
            "name": "face",
            "place": "block",
            "on": {"at": [0, 0], "slope": "alpha"},
            "friction": [0.7, 0.3],
        }
    ],
}
PULLED = {
    "gravity": [0, -9.81],
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.5},
        {"kind": "force", "name": "pull", "place": "block", "force": [1, 3]},
    ],
}


def ranged(scene: dict[str, Any], vary: str, least: float, most: float) -> RestRange:
    answer = solve_scene(read(scene), outputs=["accelerations", RestOf(vary, (least, most))])
    assert answer.thresholds is not None
    return answer.thresholds[0]


def require(end: RestEnd | None, exact: mpmath.mpf, beyond: dict[str, str]) -> None:
    assert end is not None
    with mpmath.workdps(50):
        assert abs(mpmath.mpf(end.value) - exact) <= end.error
    assert end.error <= 2.0**-52 * abs(end.value)
    assert end.beyond == beyond


def test_cone_of_friction() -> None:
    """A block rests up to tan(alpha) = mu, downhill to either side, whatever it weighs."""
    with mpmath.workdps(50):
        steepest = mpmath.atan(mpmath.mpf("0.7"))
        least = mpmath.tan(mpmath.mpf("0.2"))
    # After a whole turn, at 6.4, it rests again.
    found = ranged(INCLINE, "/let/alpha", -1.5, 6.4)
    require(found.upper, steepest, {"face": "slide back"})
    require(found.lower, -steepest, {"face": "slide"})
    one = {**INCLINE, "connections": [{**INCLINE["connections"][0], "friction": 0.7}]}  # type: ignore[index]
    coefficient = ranged(one, "/connections/0/friction", 0, 5)
    require(coefficient.lower, least, {"face": "slide back"})
    assert coefficient.upper == RestEnd(5.0, 0.0, None, None)
    weight = ranged(INCLINE, "/bodies/block/mass", 0.001, 1000)
    assert (weight.lower, weight.upper) == (RestEnd(0.001, 0.0, None, None), RestEnd(1000.0, 0.0, None, None))


def test_friction_of_a_slider_is_varied_from_none_on() -> None:
    """A slider without friction is no contact, and rests where it is level."""
    rail = {"kind": "slider", "name": "rail", "a": "block", "b": [0, 0], "slope": 0.3, "friction": 0.5}
    scene = {"gravity": [0, -9.81], "bodies": {"block": {"mass": 1, "at": [0, 0]}}, "connections": [rail]}
    with mpmath.workdps(50):
        least = mpmath.tan(mpmath.mpf("0.3"))
    found = ranged(scene, "/connections/0/friction", 0, 1)
    require(found.lower, least, {"rail.1": "slide back", "rail.2": "open"})
    assert found.upper == RestEnd(1.0, 0.0, None, None)
    level = ranged({**scene, "connections": [rail | {"slope": 0}]}, "/connections/0/friction", 0, 1)
    assert level.lower == RestEnd(0.0, 0.0, None, None)


def test_the_steepest_slope_is_the_same_in_degrees() -> None:
    contact = {**INCLINE["connections"][0], "on": {"at": [0, 0], "slope": {"degrees": 10}}}  # type: ignore[index]
    found = ranged({**INCLINE, "connections": [contact]}, "/connections/0/on/slope/degrees", 0, 80)
    with mpmath.workdps(50):
        require(found.upper, mpmath.degrees(mpmath.atan(mpmath.mpf("0.7"))), {"face": "slide back"})


def test_ladder() -> None:
    """With friction at both ends four forces have three equations; at the limit moments about the foot determine them.

    tan = (1 - mu_floor mu_wall)/(2 mu_floor), so that mu_floor = 1/(2 tan + mu_wall).
    """
    with mpmath.workdps(50):
        floor, wall = mpmath.mpf("0.4"), mpmath.mpf("0.3")
        flattest = mpmath.atan((1 - floor * wall) / (2 * floor))
        turn = mpmath.tan(mpmath.mpf("1.2"))
        least = 1 / (2 * turn + wall)
    found = ranged(LADDER, "/let/slope", 0.2, 1.5)
    require(found.lower, flattest, {"floor": "slide back", "wall": "slide back"})
    assert found.upper == RestEnd(1.5, 0.0, None, None)
    rough = ranged(LADDER, "/connections/0/friction", 0, 1)
    require(rough.lower, least, {"floor": "slide back", "wall": "slide back"})


@settings(max_examples=10, derandomize=True, deadline=None)
@given(floor=st.integers(5, 95), wall=st.integers(0, 95))
def test_ladders_of_any_roughness(floor: int, wall: int) -> None:
    """The flattest slope of ladders of any roughness, also on a wall without friction."""
    with mpmath.workdps(50):
        mu, other = mpmath.mpf(floor) / 100, mpmath.mpf(wall) / 100
        flattest = mpmath.atan((1 - mu * other) / (2 * mu))
    contacts = [
        {**contact, "friction": coefficient / 100}
        for contact, coefficient in zip(LADDER["connections"], (floor, wall), strict=True)  # type: ignore[arg-type]
    ]
    scene = {**LADDER, "let": {"slope": "1.52"}, "connections": contacts}
    found = ranged(scene, "/let/slope", 0.01, 1.55)
    assert found.lower is not None
    require(found.lower, flattest, found.lower.beyond)  # type: ignore[arg-type]
    assert found.lower.beyond


@pytest.mark.parametrize("component", [0, 1])
def test_block_pulled_by_a_force(component: int) -> None:
    """A block moves where |F_x| = mu (m g - F_y), and is lifted where F_y = m g."""
    with mpmath.workdps(50):
        weight, mu = 2 * mpmath.mpf("9.81"), mpmath.mpf("0.5")
        across, up = mu * (weight - 3), weight - 1 / mu
    found = ranged(PULLED, f"/connections/1/force/{component}", -40, 40)
    if component == 0:
        require(found.upper, across, {"floor": "slide"})
        require(found.lower, -across, {"floor": "slide back"})
    else:
        require(found.upper, up, {"floor": "slide"})
        assert found.lower == RestEnd(-40.0, 0.0, None, None)


def test_block_lifted_straight_up() -> None:
    pulled = {**PULLED, "connections": [PULLED["connections"][0], {**PULLED["connections"][1], "force": [0, 3]}]}  # type: ignore[index]
    found = ranged(pulled, "/connections/1/force/1", 0, 40)
    with mpmath.workdps(50):
        require(found.upper, mpmath.mpf("19.62"), {"floor": "open"})


def test_when_a_string_holds() -> None:
    """A weight that a string holds beside a floor is lifted where the other one is the heavier."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"load": {"mass": 3, "at": [-1, 0]}, "weight": {"mass": 2, "at": [1, -1]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "load", "on": {"at": [0, 0]}, "restitution": 0},
            {"kind": "string", "name": "s", "through": ["load", [-1, 2], [1, 2], "weight"]},
        ],
    }
    found = ranged(scene, "/bodies/weight/mass", 0.5, 10)
    assert found.upper is not None
    require(found.upper, mpmath.mpf(3), {"floor": "open", "s": "closed"})


def test_equilibrium_at_one_value_alone() -> None:
    """What is balanced without friction is so at one value, in balls: both ends are there."""
    scene = {**PULLED, "connections": [{**PULLED["connections"][0], "friction": 0}, PULLED["connections"][1]]}  # type: ignore[index]
    scene["connections"][1] = {**scene["connections"][1], "force": [0, 3]}  # type: ignore[index]
    found = ranged(scene, "/connections/1/force/0", -1, 1)
    assert found.lower is not None
    assert found.upper is not None
    assert abs(found.lower.value) <= found.lower.error < 1e-30
    assert abs(found.upper.value) <= found.upper.error < 1e-30


def test_a_scene_that_moves_has_no_range() -> None:
    steep = {**INCLINE, "let": {"alpha": "0.8"}}
    found = ranged(steep, "/let/alpha", 0, 1)
    assert (found.written, found.lower, found.upper) == (0.8, None, None)
    assert found.reason == "with the written value no forces balance it: face would slide"
    assert abs(Fraction("0.8") - Fraction(0.8)) <= found.error < 2.0**-54
    thrown = {**INCLINE, "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": ["cos(0.2)", "sin(0.2)"]}}}
    found = ranged(thrown, "/connections/0/friction/0", 0.5, 1)
    assert found.lower is None
    assert found.reason == "with the written value it does not rest: at the start block has a velocity"


def test_rest_that_would_end_by_other_places_touching_is_refused() -> None:
    scene = {**INCLINE, "bodies": {"block": {"mass": 2, "at": ["cos(0.2)", "sin(0.2)"]}}}
    with pytest.raises((InvalidParameter, NotApplicable)) as refused:
        ranged(scene, "/let/alpha", 0, 0.3)
    assert refused.value.path[:3] == ("outputs", 1, "thresholds")


def test_bounds_are_numbers_as_those_of_the_scene() -> None:
    answer = solve_scene(read(INCLINE), outputs=[RestOf("/let/alpha", ("alpha", "alpha + 1e-3"))])
    (found,) = answer.thresholds or ()
    assert found.lower is not None
    assert found.upper is not None
    assert (found.lower.value, found.upper.value) == (0.2, 0.201)


@pytest.mark.parametrize(
    ("vary", "between", "where"),
    [
        ("alpha", (0, 1), "vary"),
        ("/let/beta", (0, 1), "vary"),
        ("/bodies/block", (0, 1), "vary"),
        ("/let/alpha", (0.3, 1), "between"),
        ("/let/alpha", (0,), "between"),
        ("/let/alpha", (0, math.inf), "between"),
        ("/bodies/block/mass", (-1, 3), "between"),
    ],
)
def test_faults_of_the_question(vary: str, between: Any, where: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read(INCLINE), outputs=[RestOf(vary, between)])
    assert fault.value.path[:4] == ("outputs", 0, "thresholds", where)


def test_a_chain_is_named_as_what_is_in_the_way() -> None:
    ends = {name: {"mass": 1, "at": [x, -1]} for name, x in (("a", -0.1), ("b", 0.1))}
    chain = {"kind": "chain", "through": ["a", [0, 0], "b"], "density": 0.1}
    scene = read({"gravity": [0, -9.81], "bodies": ends, "connections": [chain]})
    with pytest.raises(NotApplicable, match="beside a chain") as refused:
        solve_scene(scene, outputs=[RestOf("/bodies/a/mass", [0.5, 2])])
    assert refused.value.path == ("outputs", 0, "thresholds")
    assert "accelerations" in (refused.value.remedy or "")

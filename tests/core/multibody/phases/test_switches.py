"""Formulas that change their piece at the time of another event, or while a body rests, against closed forms.

The motions are polynomials in time; g = 10.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

FLOOR = {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}}
HIGH = {"at": [0, "5/4"]}
STRING = {"kind": "string", "name": "string", "through": ["p", [0, 0]], "length": "1.3"}

CASES: dict[str, tuple[dict[str, Any], dict[str, Any], list[Any], str, float, list[tuple[str, float]]]] = {
    "a force begins at a bounce": (
        FLOOR | {"restitution": 0.5}, HIGH, ["if(t - 1/2, 2, 0)", 0], "1/16 5/16", 0.75,
        [("touch", 0.5), ("switch", 0.5)],
    ),
    "a corner at a bounce": (
        FLOOR | {"restitution": 0.5}, HIGH, ["abs(t - 1/2)", 0], "29/384 5/16", 0.75, [("touch", 0.5), ("switch", 0.5)],
    ),
    "a force begins when something lands": (
        FLOOR, HIGH, [0, "if(t - 1/2, 20, 0)"], "0 5/16", 0.75, [("touch", 0.5), ("switch", 0.5)],
    ),
    "what rests is lifted by a jump": (
        FLOOR, {}, [0, "if(t - 1/2, 20, 0)"], "0 5/16", 0.75, [("switch", 0.5), ("lift-off", 0.5)],
    ),
    "what rests is lifted after a corner": (
        FLOOR, {}, [0, "20*max(t - 1/2, 0)"], "0 10/3", 2.0, [("switch", 0.5), ("lift-off", 1.0)],
    ),
    "a normal force touches zero at a corner": (
        FLOOR, {}, [0, "10 - abs(t - 1/2)"], "0 0", 2.0, [("switch", 0.5)],
    ),
    "what is held at the limit of friction slips after a corner": (
        FLOOR | {"friction": 0.3}, {}, ["3*max(1, 2*t)", 0], "27/8 0", 2.0, [("switch", 0.5), ("slip", 0.5)],
    ),
    "what stops is pulled on": (
        FLOOR | {"friction": 0.3}, {"velocity": [1.5, 0]}, ["if(t - 1/2, 4, 0)", 0], "13/32 0", 0.75, [("switch", 0.5)],
    ),
    "what stops is pulled by less than friction": (
        FLOOR | {"friction": 0.3}, {"velocity": [1.5, 0]}, ["if(t - 1/2, 2, 0)", 0], "3/8 0", 0.75,
        [("switch", 0.5), ("stick", 0.5)],
    ),
    "a string would become taut, and is pulled back": (
        STRING, {"at": [0, "-1/20"]}, [0, "if(t - 1/2, 20, 0)"], "0 -79/80", 0.75,
        [("taut", 0.5), ("switch", 0.5)],
    ),
    "one place of two laws": (
        FLOOR, {"velocity": [1, 0]}, ["if(x - 1/2, 2, 0)", "if(x - 1/2, 20, 0)"], "13/16 5/16", 0.75,
        [("switch", 0.5), ("lift-off", 0.5)],
    ),
}  # fmt: skip


def answer(description: dict[str, Any], times: list[float]) -> SceneSolution:
    return solve_scene(scene_from(description), np.array(times), ("trajectory", "forces-in-time", "accelerations"))


def scene(body: dict[str, Any], *connections: dict[str, Any]) -> dict[str, Any]:
    bodies = {"p": {"mass": 1, "at": [0, 0]} | body}
    return {"gravity": [0, -10], "bodies": bodies, "connections": list(connections)}


@pytest.mark.parametrize("case", CASES)
def test_a_piece_that_ends_at_an_event(case: str) -> None:
    touch, body, force, place, time, events = CASES[case]
    push = {"kind": "force", "name": "push", "place": "p", "force": force}
    for connections in ([touch, push], [push, touch]):
        found = answer(scene(body, *connections), [0.0, time])
        assert [(event.kind, event.time) for event in found.events] == events
        assert found.trajectory is not None
        own = found.trajectory.columns["p.position"]
        wanted = [float(Fraction(x)) for x in place.split()]
        assert np.max(np.abs(own.values[1] - wanted)) <= own.error + 2.0**-53
        assert own.error < 1e-14


def test_bounces_that_end_as_a_force_begins() -> None:
    push = {"kind": "force", "name": "push", "place": "p", "force": [0, "if(t - 3/2, 20, 0)"]}
    found = answer(scene(HIGH, FLOOR | {"restitution": 0.5}, push), [0.0, 1.5, 2.0])
    assert [event.kind for event in found.events[-2:]] == ["settle", "switch"]
    assert found.trajectory is not None
    assert found.trajectory.columns["p.position"].values[2, 1] == pytest.approx(1.25, abs=1e-14)


def test_a_piece_before_the_start_ends_where_it_began() -> None:
    push = {"kind": "force", "name": "push", "place": "p", "force": [0, "if(t + 1/2, 12, 10)"]}
    found = answer(scene({}, push), [-1.0, -0.25, 0.5])
    assert [(event.kind, event.time) for event in found.events] == [("switch", -0.5)]
    assert found.trajectory is not None
    assert found.trajectory.time.tolist() == [-0.25, 0.5]
    assert found.trajectory.columns["p.position"].values[:, 1].tolist() == [0.0625, 0.25]


def test_every_piece_has_the_smallest_model() -> None:
    push = {"kind": "force", "name": "push", "place": "p", "force": ["if(t - 1, 2, -vx)", "if(x - 100, sin(t), 10)"]}
    found = answer(scene({"velocity": [1, 0]}, push), [0.0, 2.0])
    assert found.phases is not None
    assert [phase.model for phase in found.phases] == ["modes", "constant acceleration"]


def test_bounces_do_not_accumulate_past_a_piece() -> None:
    """They end at 1.5 s, just before which a force begins."""
    late = "1.499999999"
    push = {"kind": "force", "name": "push", "place": "p", "force": [f"if(t - {late}, 2, 0)", 0]}
    found = answer(scene(HIGH, FLOOR | {"restitution": 0.5}, push), [0.0, 2.5])
    assert sorted(event.time for event in found.events) == [event.time for event in found.events]
    assert [event.time for event in found.events if event.kind == "switch"] == [float(late)]
    assert found.trajectory is not None
    own = found.trajectory.columns["p.position"]
    assert abs(own.values[1, 0] - (2.5 - float(late)) ** 2) <= own.error + 2.0**-52


def test_bounces_under_a_force_against_the_velocity_are_not_alike() -> None:
    """Up a body is slowed down by 12 m/s^2, and down it gains 8 m/s^2."""
    drag = {"kind": "force", "name": "drag", "place": "p", "force": [0, "-2*sign(vy)"]}
    found = answer(scene({"at": [0, 4]}, FLOOR | {"restitution": 0.5}, drag), [0.0, 1.5, 2.0])
    up = [event.time for event in found.events if event.kind == "switch"][:2]
    # It falls for 1 s and hits with 8 m/s, turns round, goes up for 4/12 s by 2/3 m, and falls for sqrt(1/6) s.
    assert up == pytest.approx([1, 1 + 4 / 12], rel=1e-14)
    hits = [event.time for event in found.events if event.kind == "touch"][:2]
    assert hits == pytest.approx([1.0, 1 + 4 / 12 + np.sqrt(1 / 6)], rel=1e-14)


def test_a_sign_that_changes_by_a_pole_ends_the_motion_there() -> None:
    push = {"kind": "force", "name": "push", "place": "p", "force": ["sign(tan(t))", 10]}
    found = answer(scene({}, push), [0.0, 1.0, 2.0])
    assert found.problem is not None
    assert (found.problem.code, found.problem.connections) == ("formula", ("push",))
    assert found.problem.time == pytest.approx(np.pi / 2, abs=1e-14)
    assert found.trajectory is not None
    assert found.trajectory.columns["p.position"].values[:, 0].tolist() == [0.0, 0.5]


def test_an_argument_is_searched_up_to_the_end_of_its_domain() -> None:
    """From rest with 1 up to x = 3/4, and on with the velocity that it has there up to x = 1."""
    push = {"kind": "force", "name": "push", "place": "p", "force": ["if(sqrt(1 - x) - 1/2, 1, 0)", 10]}
    found = answer(scene({}, push), [0.0, 1.0, 2.0])
    first, speed = np.sqrt(1.5), np.sqrt(1.5)
    assert [event.kind for event in found.events] == ["switch", "formula"]
    assert [event.time for event in found.events] == pytest.approx([first, first + 0.25 / speed], rel=1e-14)


@pytest.mark.parametrize(
    ("force", "velocity", "place"),
    [
        ("abs(abs(abs(x)))", 0, 0.0),
        ("abs(abs(x))", 1, np.sinh(1.0)),
        ("abs(abs(x))", -1, -np.sin(1.0)),
        ("1+abs(abs(x))", 0, np.cosh(1.0) - 1.0),
        ("max(abs(x),-x)", 0, 0.0),
        ("max(abs(x),-x)", -1, -np.sin(1.0)),
        ("abs(min(x,-x))", 0, 0.0),
        ("abs(x-t)-abs(t-x)", 1, 1.0),
    ],
)
def test_pieces_within_pieces_begin_at_their_common_zero(force: str, velocity: float, place: float) -> None:
    field = {"kind": "field", "name": "f", "force": [force, 0], "on": ["p"]}
    found = answer({**scene({"velocity": [velocity, 0]}, field), "gravity": [0, 0]}, [1.0])
    assert found.trajectory is not None
    column = found.trajectory.columns["p.position"]
    assert column.values[-1][0] == pytest.approx(place, abs=column.error + 1e-15)

"""Discs and cylinders that start level on a plane or above it, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable
from core.multibody.solve import solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.worked_examples import column, read

G = 10.0
R, H = 0.1, 0.4
COIN = {"mass": 2, "shape": {"kind": "disc", "radius": R}, "at": [0, 0, 0]}
CYLINDER = {"mass": 1, "shape": {"kind": "cylinder", "radius": R, "height": H}, "at": [0, 0, H / 2]}
ABOUT_THE_EDGE = R**2 / 4 + H**2 / 12 + R**2 + H**2 / 4
"""Moment of inertia of the cylinder about a level tangent of its rim, over its mass (m^2)."""


def scene(body: dict[str, Any], *beside: dict[str, Any], **contact: Any) -> dict[str, Any]:
    floor = {"kind": "contact", "name": "floor", "place": "body", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    return {"gravity": [0, 0, -G], "bodies": {"body": body}, "connections": [floor | contact, *beside]}


def push(x: object, y: object = 0) -> dict[str, Any]:
    return {"kind": "force", "place": "body", "force": [x, y, 0]}


@pytest.mark.parametrize("body", [COIN, CYLINDER], ids=["coin", "cylinder"])
def test_what_lies_slides_to_rest_by_friction(body: dict[str, Any]) -> None:
    """It stops after v/(mu g), v^2/(2 mu g) on: the friction is mu m g wherever along the rim it acts."""
    sliding = body | {"velocity": [0.6, 0.8, 0], "angular_velocity": [0, 0, 0]}
    answer = solve_scene(read(scene(sliding, friction=0.25)), [0.1, 1.0], ["trajectory", "forces-in-time"])
    assert {event.kind for event in answer.events} == {"stick"}
    assert [event.time for event in answer.events] == pytest.approx([0.4] * 4, rel=1e-14)
    place, height = column(answer, "body.position"), body["at"][2]
    assert place.values == pytest.approx(np.array([[0.0525, 0.07, height], [0.12, 0.16, height]]), abs=1e-14)
    assert column(answer, "floor.normal").values == pytest.approx(body["mass"] * G, rel=1e-13)
    assert column(answer, "floor.friction.x").values[0] == pytest.approx(-0.25 * body["mass"] * G * 0.6, rel=1e-13)


@pytest.mark.parametrize("axes", [None, [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]])
def test_a_can_slides_upright_along_any_direction(axes: Any) -> None:
    """Friction at the height h/2 below its centre moves its load by mu h/2 < r: it stops after v/(mu g)."""
    can = (
        CYLINDER | {"velocity": [0.6, 0.1, 0], "angular_velocity": [0, 0, 0]} | ({} if axes is None else {"axes": axes})
    )
    answer = solve_scene(read(scene(can, friction=0.48)), [1.0])
    assert answer.problem is None
    speed, slowed = math.hypot(0.6, 0.1), 0.48 * G
    assert [event.time for event in answer.events] == pytest.approx([speed / slowed] * 4, rel=1e-13)
    far = np.array([0.6, 0.1]) * speed / (2 * slowed)
    assert column(answer, "body.position").values[0] == pytest.approx([*far, H / 2], abs=1e-13)


def test_a_coin_that_falls_flat_lands_along_its_rim_at_once_and_goes_on_spinning() -> None:
    falls = COIN | {"at": [0, 0, 0.45], "velocity": [1, 0, 0], "angular_velocity": [0, 0, 4]}
    answer = solve_scene(read(scene(falls, restitution=0.5)), [0.4, 2.0])
    impulses: dict[float, float] = {}
    for event in answer.events:
        impulses[event.time] = impulses.get(event.time, 0.0) + event.impulses.get("normal", 0.0)
    assert list(impulses)[:3] == pytest.approx([0.3, 0.6, 0.75], rel=1e-14)
    assert list(impulses.values())[:3] == pytest.approx([9.0, 4.5, 2.25], rel=1e-13)
    assert column(answer, "body.position").values == pytest.approx(np.array([[0.4, 0, 0.1], [2, 0, 0]]), abs=1e-13)
    assert column(answer, "body.angular_velocity").values == pytest.approx(np.array([[0, 0, 4]] * 2), abs=1e-13)


def test_a_rough_landing_takes_the_slip_that_its_impulse_can() -> None:
    falls = COIN | {"at": [0, 0, 0.45], "velocity": [1, 0, 0], "angular_velocity": [0, 0, 0]}
    answer = solve_scene(read(scene(falls, friction=0.2)), [0.31, 1.0])
    # At 3 m/s it takes 0.2 times that from the slip, and stops 0.4/(mu g) later.
    assert answer.events[-1].kind == "stick"
    assert answer.events[-1].time == pytest.approx(0.5, rel=1e-14)
    assert column(answer, "body.velocity").values[0] == pytest.approx([0.38, 0, 0], abs=1e-13)


@pytest.mark.parametrize(("friction", "kind", "time"), [(0.6, "lift-off", 5 / 6), (0.3, "slip", 0.5)])
def test_a_push_that_grows_tips_what_stands_or_moves_it(friction: float, kind: str, time: float) -> None:
    """It tips where F H/2 = m g R, and slides where F = mu m g."""
    answer = solve_scene(read(scene(CYLINDER, push("6*t"), friction=friction)), [0.2, 0.9])
    assert {event.kind for event in answer.events} == {kind}
    assert [event.time for event in answer.events] == pytest.approx([time] * len(answer.events), rel=1e-12)


@pytest.mark.parametrize("axes", [None, [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]], ids=["along", "askew"])
def test_a_cylinder_tips_over_its_rim_onto_its_side(axes: list[list[float]] | None) -> None:
    """About the edge I w^2/2 grows by what the centre falls: from H/2 to H/2 cos a + R sin a above the floor."""
    rate = 4.0
    x, y = (1, 0) if axes is None else (0.6, 0.8)
    moves = [round(x, 12) for x in (rate * H / 2 * x, rate * H / 2 * y, rate * R)]
    body = CYLINDER | {"angular_velocity": [0, rate, 0], "velocity": moves} | ({} if axes is None else {"axes": axes})
    answer = solve_scene(read(scene(body, friction=1)), [0.05], ["trajectory"])

    def speed(angle: Any) -> Any:
        fallen = mpmath.mpf(H) / 2 * (1 - mpmath.cos(angle)) - mpmath.mpf(R) * mpmath.sin(angle)
        return mpmath.sqrt(rate**2 + 2 * G * fallen / mpmath.mpf(ABOUT_THE_EDGE))

    angle = mpmath.findroot(lambda a: mpmath.quad(lambda x: 1 / speed(x), [0, a]) - 0.05, 0.2)
    turned = column(answer, "body.angular_velocity").values[0]
    assert turned == pytest.approx([0, float(speed(angle)), 0], abs=1e-10)
    lands = solve_scene(read(scene(body, friction=1)), [0.6], ["trajectory"])
    assert [event.kind for event in lands.events] == ["slip", "touch", "touch", "stick"]
    assert lands.problem is None
    # On its side, with its axis along the way that it fell.
    lies = column(lands, "body.position").values[0]
    assert lies[2] == pytest.approx(R, abs=1e-12)


def test_a_cylinder_rocks_with_the_ratio_of_housner() -> None:
    """Spin about the new edge is kept where it lands: (I_c + m (H^2/4 - R^2))/(I_c + m (H^2/4 + R^2)) of it is left.

    G. W. Housner, "The behavior of inverted pendulum structures during earthquakes" (1963), for any body with two feet.
    """
    rate = 0.8
    body = CYLINDER | {"angular_velocity": [0, rate, 0], "velocity": [rate * H / 2, 0, rate * R]}
    answer = solve_scene(read(scene(body, friction=1)), [0.2], ["trajectory"])
    first = next(event for event in answer.events if event.kind == "touch")
    beside = solve_scene(read(scene(body, friction=1)), [first.time - 1e-9, first.time + 1e-9], ["trajectory"])
    before, after = column(beside, "body.angular_velocity").values[:, 1]
    middle = R**2 / 4 + H**2 / 12 + H**2 / 4
    assert before == pytest.approx(-rate, rel=1e-6)
    assert after / before == pytest.approx((middle - R**2) / (middle + R**2), rel=1e-6)


def test_what_spins_while_it_slides_is_undecided() -> None:
    spins = COIN | {"velocity": [1, 0, 0], "angular_velocity": [0, 0, 3]}
    answer = solve_scene(read(scene(spins, friction=0.3)), [0.1])
    assert answer.problem is not None
    assert answer.problem.code == "undetermined-friction"


@pytest.mark.parametrize(
    ("body", "beside"),
    [
        (CYLINDER | {"at": [0, 0, 1], "angular_velocity": [0, 9, 3], "velocity": [0, 0, 0]}, []),
        (CYLINDER, [push(4, 5)]),
        (CYLINDER, [push(3, 3)]),
    ],
    ids=["tumbles", "tips askew", "load beside the square"],
)
def test_what_tips_about_no_diameter_is_refused(body: dict[str, Any], beside: list[dict[str, Any]]) -> None:
    with pytest.raises(InvalidParameter, match="no point of a level rim is the lowest"):
        solve_scene(read(scene(body, *beside, friction=0.9)), [0.1])


def test_what_tips_askew_later_ends_there() -> None:
    answer = solve_scene(read(scene(CYLINDER, push("3*t", "4*t"), friction=0.9)), [0.1, 2.0])
    assert answer.ended is not None
    assert (answer.ended.kind, answer.ended.name) == ("singular", "floor")
    # No later than the resultant leaves the rim, no earlier than the square in it.
    assert 1 / math.sqrt(2) <= answer.ended.time <= 1


def test_thresholds_of_rest_are_not_asked_of_four_places() -> None:
    with pytest.raises(NotApplicable, match="level"):
        solve_scene(read(scene(CYLINDER, push(1), friction=0.9)), [], [RestOf("/connections/1/force/0", (0.0, 100.0))])

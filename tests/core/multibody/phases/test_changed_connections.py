"""Connections that begin and end, and blows, against textbook solutions.

Sources: L. D. Landau, E. M. Lifshitz, "Mechanics" (1976), section 11 (quadratures); S. T. Thornton, J. B. Marion,
"Classical Dynamics" (2004), chapters 9 and 11 (ballistic pendulum, centre of percussion).
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.errors import InvalidParameter, NotApplicable, SelfCheckFailed
from core.multibody.answer import SceneSolution
from core.multibody.language.occasions import AtTime
from core.multibody.language.reading import scene_from
from core.multibody.phases import changed_connections
from core.multibody.phases.schedule import Schedule
from core.multibody.solve import solve_scene
from core.systems.trajectory import MotionEvent

COLUMNS = ("trajectory", "forces-in-time", "energy-in-time", "work-in-time")


def solved(times: list[float], outputs: tuple[str, ...] = COLUMNS, **description: Any) -> SceneSolution:
    found = solve_scene(scene_from(description), np.array(times), outputs)  # type: ignore[arg-type]
    assert found.trajectory is not None
    return found


def column(found: SceneSolution, name: str) -> np.ndarray:
    assert found.trajectory is not None
    return found.trajectory.columns[name].values


def happened(found: SceneSolution) -> list[tuple[str, str]]:
    return [(event.kind, event.name) for event in found.events]


def event(found: SceneSolution, kind: str) -> MotionEvent:
    return next(one for one in found.events if one.kind == kind)


def test_a_string_breaks_where_its_tension_passes_its_strength() -> None:
    # T = 3 m g sin(depth angle): 25 N at 1 kg and 10 m/s^2 where the depth is 25/30 of the length.
    found = solved(
        [0.2, 1.0],
        gravity=[0, -10],
        bodies={"bob": {"mass": 1, "at": [1, 0]}},
        connections=[
            {
                "kind": "string",
                "name": "cord",
                "through": ["bob", [0, 0]],
                "until": {"when": {"quantity": "cord.tension", "equals": 25}},
            }
        ],
    )
    depth = mpmath.mpf(25) / 30
    # Time along a circle by the quadrature of the energy, with the depth as s^2 to take the root at its start out.
    time = mpmath.quad(lambda s: 2 / mpmath.sqrt(20 * (1 - s**4)), [0, mpmath.sqrt(depth)])
    broken = event(found, "end")
    assert abs(broken.time - float(time)) <= broken.error + 1e-15
    late, speed = 1 - time, mpmath.sqrt(20 * depth)
    x = mpmath.sqrt(1 - depth**2) - speed * depth * late
    y = -depth - speed * mpmath.sqrt(1 - depth**2) * late - 5 * late**2
    np.testing.assert_allclose(column(found, "bob.position")[1], [float(x), float(y)], atol=1e-14)
    assert column(found, "cord.tension")[1] == pytest.approx(0.0, abs=1e-25)


def test_a_bullet_stays_in_a_ballistic_pendulum() -> None:
    found = solved(
        [0.04, 0.1],
        gravity=[0, -10],
        bodies={
            "block": {"mass": "0.9", "at": [0, -1]},
            "bullet": {"mass": "0.1", "at": [-1, -1], "velocity": [20, "1/4"]},
        },
        connections=[
            {"kind": "rod", "name": "rod", "a": "block", "b": [0, 0]},
            {
                "kind": "weld",
                "name": "stuck",
                "a": "bullet",
                "b": "block",
                "from": {"when": {"quantity": "bullet.position.x", "equals": 0}},
            },
        ],
    )
    caught = event(found, "begin")
    assert caught.time == pytest.approx(0.05, abs=1e-16)
    # Along the rod the bullet's v_y = 1/4 - 10/20 goes into the rod, m (v_x^2 + v_y^2)/2 - (M + m) (m v_x/(M + m))^2/2.
    assert caught.energy_loss == pytest.approx(20 + 0.05 * 0.0625 - 2.0, rel=1e-14)
    assert caught.impulses["rod.force"] == pytest.approx(0.025, rel=1e-13)
    assert caught.impulses["x"] == pytest.approx(-1.8, rel=1e-14)
    energy = column(found, "energy.kinetic") + column(found, "energy.potential")
    # At 0.05 s the bullet is at -1 + 1/80 - 1/80 of height.
    assert energy[1] == pytest.approx(2.0 - 10.0, rel=1e-14)
    np.testing.assert_allclose(column(found, "stuck.impacts.work"), [0.0, -caught.energy_loss], rtol=1e-14)


def test_a_nail_catches_the_string_of_a_pendulum() -> None:
    start = mpmath.mpf("0.5")
    found = solved(
        [0.3, 1.0],
        gravity=[0, -10],
        bodies={"bob": {"mass": 1, "at": ["sin(0.5)", "-cos(0.5)"]}},
        connections=[
            {
                "kind": "rod",
                "name": "long",
                "a": "bob",
                "b": [0, 0],
                "until": {"when": {"quantity": "bob.position.x", "equals": 0}},
            },
            {
                "kind": "rod",
                "name": "short",
                "a": "bob",
                "b": [0, -0.5],
                "from": {"event": {"kind": "end", "name": "long"}},
            },
        ],
    )
    first = mpmath.ellipk(mpmath.sin(start / 2) ** 2) / mpmath.sqrt(10)
    assert happened(found) == [("end", "long"), ("begin", "short")]
    assert abs(found.events[0].time - float(first)) <= found.events[0].error + 1e-16
    # It comes to the height from which it fell: v^2 = 2 g (1 - cos) of both lengths.
    other = mpmath.acos(1 - 2 * (1 - mpmath.cos(start)))
    m = mpmath.sin(other / 2) ** 2
    u = mpmath.sqrt(20) * (1 - first)
    angle = 2 * mpmath.asin(mpmath.sqrt(m) * mpmath.ellipfun("sn", u, m=m))
    expected = [-0.5 * float(mpmath.sin(angle)), -0.5 - 0.5 * float(mpmath.cos(angle))]
    np.testing.assert_allclose(column(found, "bob.position")[1], expected, atol=1e-14)


def test_a_spring_that_is_hooked_on_is_unstretched_where_it_begins() -> None:
    found = solved(
        [0.5, 1.5, 3.0],
        bodies={"car": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}},
        connections=[
            {"kind": "track", "place": "car", "on": {"at": [0, 0]}},
            {"kind": "spring", "name": "k", "a": "car", "b": [3, 0], "stiffness": 4, "from": 1, "until": 2},
        ],
    )
    end = 1 + np.sin(2.0) / 2
    np.testing.assert_allclose(
        column(found, "car.position")[:, 0], [0.5, 1 + np.sin(1.0) / 2, end + np.cos(2.0)], rtol=1e-14
    )
    np.testing.assert_allclose(column(found, "k.force"), [0, -2 * np.sin(1.0), 0], atol=1e-13)
    # What it had taken up at its end is gone with it.
    np.testing.assert_allclose(
        column(found, "k.work"), [0, -(np.sin(1.0) ** 2) / 2, (np.cos(2.0) ** 2 - 1) / 2], atol=1e-13
    )
    np.testing.assert_allclose(column(found, "energy.potential"), [0, np.sin(1.0) ** 2 / 2, 0], atol=1e-13)


@pytest.mark.parametrize("arm", ["1/6", "0.2"])
def test_a_hinge_feels_nothing_of_a_blow_at_the_centre_of_percussion(arm: str) -> None:
    found = solved(
        [0.25, 1.0],
        bodies={"rod": {"mass": 1, "inertia": "1/12", "at": [0.5, 0], "places": {"top": [-0.5, 0], "spot": [arm, 0]}}},
        connections=[
            {"kind": "pin", "name": "hinge", "a": "rod.top", "b": [0, 0]},
            {"kind": "impulse", "name": "blow", "place": "rod.spot", "impulse": [0, 2], "at": 0.5},
        ],
    )
    blow, lever = event(found, "impulse"), 0.5 + float(mpmath.mpmathify(arm))
    rate = 3 * lever * 2
    assert column(found, "rod.angular_velocity")[1] == pytest.approx(rate, rel=1e-14)
    assert blow.impulses["y"] == 2.0
    assert blow.impulses.get("hinge.y", 0.0) == pytest.approx(rate / 2 - 2, abs=1e-14)
    assert ("hinge.y" in blow.impulses) == (arm != "1/6")
    assert -blow.energy_loss == pytest.approx(rate**2 / 6, rel=1e-14)


def test_a_blow_at_the_start_moves_a_free_rod() -> None:
    found = solved(
        [0.0, 1.0],
        bodies={"rod": {"mass": 1, "inertia": "1/12", "at": [0, 0], "places": {"end": [0.5, 0]}}},
        connections=[{"kind": "impulse", "name": "kick", "place": "rod.end", "impulse": [0, 2]}],
    )
    np.testing.assert_allclose(column(found, "rod.position"), [[0, 0], [0, 2]], atol=1e-14)
    np.testing.assert_allclose(column(found, "rod.angle"), [0, 12], rtol=1e-14)
    np.testing.assert_allclose(column(found, "kick.impacts.work"), [8, 8], rtol=1e-14)


def test_blows_in_space_act_along_the_axes_of_space_and_of_the_body() -> None:
    body = {
        "mass": 2,
        "moments": [2, 3, 4],
        "at": [0, 0, 0],
        "axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
        "places": {"e": [1, 0, 0]},
    }
    found = solved(
        [0.0],
        bodies={"top": body},
        connections=[
            {"kind": "impulse", "place": "top.e", "impulse": [0, 0, 4]},
            {"kind": "impulse", "place": "top.e", "impulse": [0, 8, 0], "in": "body"},
            {"kind": "impulse", "body": "top", "impulse": [3, 0, 0]},
            {"kind": "impulse", "body": "top", "impulse": [0, 6, 0], "in": "body"},
        ],
    )
    # The place is at (0, 1, 0): in space the moments are (4, 0, 0), 8 e1 x e2 = (0, 0, 8), (3, 0, 0), (-6, 0, 0).
    np.testing.assert_allclose(column(found, "top.velocity")[0], [-4, 0, 2], atol=1e-14)
    np.testing.assert_allclose(column(found, "top.angular_velocity")[0], [0, -1 / 3, 2], atol=1e-14)


def test_a_billiard_ball_rolls_at_once_where_it_is_struck_at_two_fifths_of_its_radius() -> None:
    found = solved(
        [1.0],
        gravity=[0, -10],
        bodies={"ball": {"mass": 1, "inertia": 0.016, "radius": 0.2, "at": [0, 0.2], "places": {"hit": [0, 0.08]}}},
        connections=[
            {"kind": "contact", "name": "table", "place": "ball", "on": {"at": [0, 0]}, "friction": 0.3},
            {"kind": "impulse", "name": "cue", "place": "ball.hit", "impulse": [2, 0]},
        ],
    )
    assert happened(found) == [("impulse", "cue")]
    assert found.phases is not None
    assert found.phases[0].states == {"table": "stick"}
    np.testing.assert_allclose(column(found, "ball.velocity"), [[2, 0]], atol=1e-14)


def test_wagons_couple_after_their_impact() -> None:
    found = solved(
        [0.6],
        bodies={
            "a": {"mass": 1, "radius": 0.1, "at": [0, 0], "velocity": [2, 0]},
            "b": {"mass": 3, "radius": 0.1, "at": [1, 0]},
        },
        connections=[
            {"kind": "contact", "name": "buffers", "a": "a", "b": "b", "restitution": 0.5},
            {"kind": "weld", "name": "hook", "a": "a", "b": "b", "from": {"event": {"name": "buffers"}}},
        ],
    )
    assert happened(found) == [("touch", "buffers"), ("begin", "hook")]
    assert sum(one.energy_loss for one in found.events) == pytest.approx(1.5, rel=1e-14)
    np.testing.assert_allclose(column(found, "b.velocity"), [[0.5, 0]], rtol=1e-14)


def test_a_motor_is_switched_off() -> None:
    found = solved(
        [0.5, 2.0],
        bodies={"wheel": {"mass": 1, "inertia": 0.5, "at": [0, 0]}},
        connections=[
            {"kind": "pin", "a": "wheel", "b": [0, 0]},
            {"kind": "motor", "name": "m", "a": "wheel", "rate": 3, "until": 1},
            {"kind": "damper", "a": "wheel", "measure": "turn", "coefficient": 0.5},
        ],
    )
    np.testing.assert_allclose(column(found, "wheel.angle"), [1.5, 3 + 3 * (1 - np.exp(-1.0))], rtol=1e-14)
    np.testing.assert_allclose(column(found, "m.torque"), [1.5, 0], atol=1e-14)
    np.testing.assert_allclose(column(found, "m.work"), [2.25, 4.5], rtol=1e-14)


def test_a_drive_begins_with_the_value_of_its_time() -> None:
    found = solved(
        [0.5, 1.5],
        bodies={"cart": {"mass": 1, "at": [1, 0]}},
        connections=[
            {"kind": "slider", "name": "rail", "a": "cart", "b": [0, 0], "drive": "1 + (t - 1)^2", "from": 1},
        ],
    )
    np.testing.assert_allclose(column(found, "cart.position")[:, 0], [1, 1.25], rtol=1e-14)
    np.testing.assert_allclose(column(found, "rail.drive"), [0, 2], atol=1e-13)


def test_the_floor_is_taken_away_at_the_second_bounce() -> None:
    found = solved(
        [2.0],
        gravity=[0, -10],
        bodies={"ball": {"mass": 1, "at": [0, 1.25]}},
        connections=[
            {
                "kind": "contact",
                "name": "floor",
                "place": "ball",
                "on": {"at": [0, 0]},
                "restitution": 0.8,
                "until": {"event": {"kind": "touch", "name": "floor", "nth": 2}},
            }
        ],
    )
    assert happened(found) == [("touch", "floor"), ("touch", "floor"), ("end", "floor")]
    late = 2 - 0.5 - 0.8
    np.testing.assert_allclose(column(found, "ball.position")[0, 1], 0.64 * 5 * late - 5 * late**2 + 0.0, atol=1e-13)


def test_bounces_that_end_before_a_blow_are_summed_up() -> None:
    found = solved(
        [2.9, 3.1],
        gravity=[0, -10],
        bodies={"ball": {"mass": 1, "at": [0, 1]}},
        connections=[
            {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.5},
            {"kind": "impulse", "name": "kick", "place": "ball", "impulse": [0, 3], "at": 3},
        ],
    )
    assert ("settle", "floor") in happened(found)
    np.testing.assert_allclose(column(found, "ball.position")[:, 1], [0, 0.25], atol=1e-14)


def test_a_connection_that_cannot_begin_ends_the_motion() -> None:
    found = solved(
        [0.0, 1.0],
        gravity=[0, -10],
        bodies={"ball": {"mass": 1, "at": [0, 1]}},
        connections=[{"kind": "pin", "name": "hook", "a": "ball", "b": [0, 0.5], "from": 0.1}],
    )
    assert found.problem is not None
    assert found.problem.code == "cannot-begin"
    assert found.problem.time == pytest.approx(0.1)
    assert len(column(found, "ball.position")) == 1


def spun(moments: np.ndarray, turned: np.ndarray, rate: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the attitude and the angular velocity in space of a free body, by Euler's equations (DOP853)."""

    def change(_: float, y: np.ndarray) -> np.ndarray:
        matrix, omega = y[:9].reshape(3, 3), y[9:]
        return np.concatenate(
            [np.cross(matrix, omega).ravel(), np.linalg.solve(moments, np.cross(moments @ omega, omega))]
        )

    end = solve_ivp(
        change, (0, time), np.concatenate([turned.ravel(), rate]), method="DOP853", rtol=1e-12, atol=1e-13
    ).y[:, -1]
    return end[:9].reshape(3, 3), end[:9].reshape(3, 3) @ end[9:]


@pytest.mark.parametrize("rate", [(1.0, 2.0, 0.3), (1.0, 0.0, 0.0)])
def test_bodies_that_have_turned_dock_as_they_are_then(rate: tuple[float, float, float]) -> None:
    other = {"at": [1, 0.2, 0.1], "mass": 1, "moments": [0.05, 0.03, 0.07], "velocity": [-0.2, 0, 0.4]}
    own = {"at": [0, 0, 0], "mass": 2, "moments": [0.1, 0.2, 0.25], "velocity": [0.3, 0.1, 0], "angular_velocity": rate}
    docked = {"kind": "weld", "name": "dock", "a": "a", "b": "b", "from": 0.5}
    found = solved([0.6], ("trajectory",), bodies={"a": own, "b": other}, connections=[docked])
    assert happened(found) == [("begin", "dock")]
    # In the axes in which `a` lies then: two bodies of which the momenta about the common centre are those of one.
    turned, omega = spun(np.diag([0.1, 0.2, 0.25]), np.eye(3), np.array(rate), 0.5)
    to_b = np.array([1, 0.2, 0.1]) + 0.5 * np.array([-0.5, -0.1, 0.4])
    inertia = turned @ np.diag([0.1, 0.2, 0.25]) @ turned.T
    whole = inertia + np.diag([0.05, 0.03, 0.07]) + 2 / 3 * (to_b @ to_b * np.eye(3) - np.outer(to_b, to_b))
    momentum = inertia @ omega + 2 / 3 * np.cross(to_b, [-0.5, -0.1, 0.4])
    turn, after = spun(whole, np.eye(3), np.linalg.solve(whole, momentum), 0.1)
    centre = np.array([1, 0.2, 0.1]) / 3 + 0.6 * (2 * np.array([0.3, 0.1, 0]) + np.array([-0.2, 0, 0.4])) / 3
    np.testing.assert_allclose(column(found, "b.position")[0], centre + 2 / 3 * turn @ to_b, atol=1e-11)
    np.testing.assert_allclose(column(found, "b.angular_velocity")[0], turn.T @ after, atol=1e-11)
    np.testing.assert_allclose(column(found, "a.angular_velocity")[0], (turn @ turned).T @ after, atol=1e-11)


@pytest.mark.parametrize("rate", ["2 + sin(t)", "sqrt(1 + t)", "1/(1 + t^2)", "(1 + t)^1.5", "atan(t)*exp(-t)"])
def test_a_spring_begins_beside_a_drive_that_is_a_formula_of_time(rate: str) -> None:
    found = solved(
        [0.4, 2.0],
        ("trajectory", "forces-in-time"),
        bodies={"wheel": {"at": [0, 0], "mass": 2, "inertia": 0.3}},
        connections=[
            {"kind": "pin", "a": "wheel", "b": [0, 0]},
            {"kind": "motor", "a": "wheel", "rate": rate},
            {"kind": "torsion-spring", "name": "spring", "a": "wheel", "stiffness": 3, "from": 1},
        ],
    )

    def turn(begin: float, end: float) -> float:
        names = {name: getattr(mpmath, name) for name in ("sin", "sqrt", "atan", "exp")}
        return float(mpmath.quad(lambda t: eval(rate.replace("^", "**"), {**names, "t": t}), [begin, end]))

    np.testing.assert_allclose(column(found, "wheel.angle"), [turn(0, 0.4), turn(0, 2)], rtol=1e-14)
    np.testing.assert_allclose(column(found, "spring.torque"), [0, -3 * turn(1, 2)], rtol=1e-14)


def test_what_cannot_begin_says_which_field_would_have_to_be_what() -> None:
    found = solved(
        [0.4, 1.0],
        bodies={"a": {"at": [0, 0], "mass": 1, "inertia": 0.3, "angular_velocity": 4}},
        connections=[{"kind": "relation", "name": "gear", "of": "2*a.angle + 1", "from": 0.5}],
    )
    assert found.problem is not None
    assert "connections/0/equals would have to be 5, as the formula is when it begins" in found.problem.explanation


BOB: dict[str, Any] = {"gravity": [0, -10], "bodies": {"bob": {"mass": 1, "at": [1, 0]}}}


def rod_until(moment: Any) -> dict[str, Any]:
    return {"kind": "rod", "a": "bob", "b": [0, 0], "until": moment}


def rod_when(quantity: str, value: Any) -> dict[str, Any]:
    return rod_until({"when": {"quantity": quantity, "equals": value}})


@pytest.mark.parametrize(
    ("connection", "path", "rule"),
    [
        (rod_until(-1), ("until",), "be at least 0 s"),
        (rod_until(0), ("until",), "be later than the start"),
        ({**rod_until(1), "from": 0}, ("from",), "be later than the start"),
        (rod_until({"event": {"name": "rod-1"}}), ("until", "event", "name"), "to which something may happen"),
        (rod_until({"event": {"name": "cord.zzz"}}), ("until", "event", "name"), "to which something may happen"),
        (
            rod_until({"event": {"name": "cord", "kind": "touch"}}),
            ("until", "event", "kind"),
            "one of settle, taut, sl",
        ),
        (rod_until({"event": {"name": "kick", "nth": 2}}), ("until", "event", "nth"), "be at most 1"),
        (rod_until({"event": {"name": "floor", "kind": "settle"}}), ("until", "event", "kind"), "touch, lift-off"),
        (
            rod_until({"when": {"quantity": "bob.position.length", "equals": 1}}),
            ("until", "when", "quantity"),
            "no leng",
        ),
        (rod_when("bob.velocity.x", {"value": 1, "unit": "m"}), ("until", "when", "equals", "unit"), "a unit of m/s"),
        ({**rod_until(0.3), "from": 0.5}, ("until",), "be later than the time at which the connection begins"),
        ({**rod_until("1/3"), "from": "1/3"}, ("until",), "be later than the time at which the connection begins"),
        (rod_until({"event": {"name": "rob"}}), ("until", "event", "name"), "name a connection"),
        (rod_until({"event": {"name": "rod-1", "kind": "tuch"}}), ("until", "event", "kind"), "be one of touch"),
        (rod_until({"event": {"name": "rod-1", "nth": 0}}), ("until", "event", "nth"), "whole number"),
        (rod_until({"when": {"quantity": "bob.x", "equals": 0}}), ("until", "when", "quantity"), "name a quant"),
        (rod_until({"when": {"quantity": "bob.position.x"}}), ("until", "when", "equals"), "be given"),
        (rod_until({"whn": {}}), ("until",), "be a time"),
        (rod_until({"value": 1, "unit": "m"}), ("until", "unit"), "be a unit of s"),
        ({"kind": "spinning-frame", "rate": 1, "until": 1}, ("until",), "be left out"),
        ({"kind": "impulse", "impulse": [0, 1]}, (), "have a place, or a body"),
        ({"kind": "impulse", "place": "bob", "impulse": [0, 1], "in": "body"}, ("in",), "be left out for a particle"),
        ({"kind": "impulse", "body": "bob", "impulse": 1}, ("body",), "name a body of the plane that can turn"),
        ({"kind": "impulse", "place": [0, 0], "impulse": [0, 1]}, ("place",), "belong to a body"),
    ],
)
def test_what_cannot_be_is_refused(connection: dict[str, Any], path: tuple[str, ...], rule: str) -> None:
    others = [
        {"kind": "string", "name": "cord", "through": ["bob", [0, 0]], "restitution": 0.5},
        {"kind": "contact", "name": "floor", "place": "bob", "on": {"at": [0, -9]}},
        {"kind": "impulse", "name": "kick", "place": "bob", "impulse": [0, 1]},
    ]
    with pytest.raises(InvalidParameter, match=rule) as refused:
        solved([1.0], connections=[connection, *others], **BOB)
    assert refused.value.path == ("connections", 0, *path)


@pytest.mark.parametrize(
    ("connection", "remedy"),
    [
        (rod_until({"event": {"name": "flor"}}), 'did you mean "floor"?'),
        (rod_until({"when": {"quantity": "bob.velocty.x", "equals": 1}}), 'did you mean "bob.velocity.x"?'),
        ({"kind": "blow", "place": "bob", "impulse": [0, 1]}, 'did you mean "impulse"?'),
        (rod_until(0), "leave out the connection"),
    ],
)
def test_what_was_probably_meant_is_named(connection: dict[str, Any], remedy: str) -> None:
    floor = {"kind": "contact", "name": "floor", "place": "bob", "on": {"at": [0, -9]}}
    with pytest.raises(InvalidParameter) as refused:
        solved([1.0], connections=[connection, floor], **BOB)
    assert refused.value.remedy is not None
    assert remedy in refused.value.remedy


def test_equilibria_are_not_answered_where_connections_change() -> None:
    scene = scene_from({**BOB, "connections": [{"kind": "rod", "a": "bob", "b": [0, 0], "until": 1}]})
    with pytest.raises(NotApplicable):
        solve_scene(scene, np.array([1.0]), ("equilibria",))


def test_the_audit_refuses_a_blow_that_is_not_given_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = changed_connections.struck

    def halved(table: Any, pushes: Any) -> Any:
        found = whole(table, pushes)
        return changed_connections.Struck(
            table, [(x + y) / 2 for x, y in zip(table.v, found.v, strict=True)], found.impulses
        )

    monkeypatch.setattr(changed_connections, "struck", halved)
    connections = [{"kind": "impulse", "name": "kick", "place": "bob", "impulse": [0, 3], "at": 0.5}]
    with pytest.raises(SelfCheckFailed, match="momentum at an impact"):
        solved([1.0], connections=connections, **BOB)


NEVER = {"when": {"quantity": "bob.position.x", "equals": 50}}


@pytest.mark.parametrize("seed", range(4))
def test_the_end_of_what_never_begins_holds_nothing_else_up(seed: int) -> None:
    # Constant forces and blows between times: v changes by J and by F (b - a), each over what is left of the motion.
    random = np.random.default_rng(seed)
    times = np.sort(random.integers(1, 99, 4)) / 100 + np.arange(4) / 1000
    begin, end, blow, out = (float(x) for x in random.permutation(times))
    begin, end = sorted((begin, end))
    force, impulse = (float(x) for x in random.integers(1, 5, 2))
    found = solved(
        [1.2],
        connections=[
            {"kind": "force", "name": "never", "place": "bob", "force": [7, 0], "from": NEVER, "until": out},
            {"kind": "force", "name": "f", "place": "bob", "force": [force, 0], "from": begin, "until": end},
            {"kind": "impulse", "name": "i", "place": "bob", "impulse": [impulse, 0], "at": blow},
        ],
        **BOB,
    )
    expected = sorted([(begin, "begin", "f"), (end, "end", "f"), (blow, "impulse", "i")])
    assert [(one.time, one.kind, one.name) for one in found.events] == expected
    speed = impulse + force * (end - begin)
    far = 1 + impulse * (1.2 - blow) + force * (end - begin) * (1.2 - (begin + end) / 2)
    assert column(found, "bob.velocity")[0, 0] == pytest.approx(speed, rel=1e-14)
    assert column(found, "bob.position")[0, 0] == pytest.approx(far, rel=1e-14)


def test_the_audit_refuses_a_motion_in_which_an_occasion_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Schedule, "until", lambda own, end: end)
    with pytest.raises(SelfCheckFailed, match="number of events end"):
        solved([1.0], connections=[rod_until(0.5)], **BOB)


def test_the_audit_refuses_an_occasion_at_another_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(AtTime, "has_come", lambda own, now, events, passages: True)
    with pytest.raises(SelfCheckFailed, match="time of its end"):
        solved([1.0], connections=[rod_until(0.5)], **BOB)


@pytest.mark.parametrize("gravity", [[0, 0], [0, -10]])
@pytest.mark.parametrize("time", [0.25, 0.5, "1/3"])
def test_a_value_that_is_passed_at_the_time_of_another_event_counts(time: Any, gravity: list[float]) -> None:
    when = {"when": {"quantity": "bob.position.x", "equals": time}}
    blow = {"kind": "impulse", "place": "bob", "impulse": [0, 3]}
    found = solved(
        [1.0],
        gravity=gravity,
        bodies={"bob": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}},
        connections=[{**blow, "at": time}, {**blow, "at": when}, {**blow, "at": when}],
    )
    at = float(mpmath.mpf(1) / 3) if time == "1/3" else time
    assert [(one.name, one.time) for one in found.events] == [(f"impulse-{k}", at) for k in (1, 2, 3)]
    np.testing.assert_allclose(column(found, "bob.velocity"), [[1, 9 + gravity[1]]], rtol=1e-14)
    for k in (1, 2, 3):
        # J (v + v')/2.
        work = 3 * (3 * k - 1.5 + gravity[1] * at)
        assert column(found, f"impulse-{k}.impacts.work")[0] == pytest.approx(work, rel=1e-13)


@pytest.mark.parametrize("until", [{"event": {"name": "r"}}, {"event": {"kind": "begin", "name": "r"}}, 0.25])
def test_a_rod_that_begins_and_ends_at_once_takes_the_speed_along_it(until: Any) -> None:
    begin = {"when": {"quantity": "bob.velocity.y", "equals": -5}}
    rod = {"kind": "rod", "name": "r", "a": "bob", "b": [0, 0], "from": begin, "until": until}
    found = solved([1.2], connections=[rod], **BOB)
    # At (1, -5/4) with (0, -5): what is left is (v.t) t with t across the rod.
    assert happened(found) == [("begin", "r"), ("end", "r")]
    np.testing.assert_allclose(column(found, "bob.velocity")[0], [-100 / 41, -80 / 41 - 7], rtol=1e-14)


def test_a_floor_that_is_taken_away_by_its_touch_has_pushed() -> None:
    floor = {"kind": "contact", "name": "f", "place": "bob", "on": {"at": [0, -1.25]}, "restitution": 0.5}
    found = solved([1.0], connections=[{**floor, "until": {"event": {"kind": "touch", "name": "f"}}}], **BOB)
    assert happened(found) == [("touch", "f"), ("end", "f")]
    assert column(found, "bob.velocity")[0, 1] == pytest.approx(2.5 - 5, abs=1e-13)


def gimbal(fr: Any, until: Any = None) -> dict[str, Any]:
    """Return a disc on an axle that turns with a free ball, from a time on with a brake between them."""
    brake = {"kind": "damper", "name": "brake", "a": "disc", "b": "ball", "measure": "turn", "coefficient": 0.5}
    return {
        "bodies": {
            "ball": {"mass": 1, "moments": [0.1, 0.1, 0.1], "at": [0, 0, 0], "angular_velocity": [2, 0, 0]},
            "disc": {"mass": 1, "moments": [0.1, 0.15, 0.2], "at": [0, 0, 0], "angular_velocity": [2, 0, 5]},
        },
        "connections": [
            {"kind": "pin", "name": "axle", "a": "disc", "b": "ball", "axis": [0, 0, 1], "until": until},
            {**brake, "from": fr},
        ],
    }


def test_what_begins_about_an_axle_has_the_axis_as_it_lies_then() -> None:
    found = solved([0.5, 1.0], ("trajectory", "forces-in-time"), **gimbal(0.5))
    moments = np.diag([0.1, 0.15, 0.2])

    def change(t: float, y: np.ndarray) -> np.ndarray:
        # The disc is turned by its angle about the axis n of the ball; T.n = -c s, and no moment acts on both.
        ball, (omega, angle, rate) = y[:9].reshape(3, 3), (y[9:12], y[12], y[13])
        n = ball[:, 2]
        c, s = np.cos(angle), np.sin(angle)
        disc = ball @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        own, other = disc @ moments @ disc.T, 0.1 * np.eye(3)
        whole = omega + rate * n
        known = own @ (rate * np.cross(omega, n)) + np.cross(whole, own @ whole)
        equations = np.zeros((4, 4))
        equations[:3, :3], equations[:3, 3] = own + other, own @ n
        equations[3, :3], equations[3, 3] = n @ own, n @ own @ n
        brake = -0.5 * rate if t >= 0.5 else 0.0
        slopes = np.linalg.solve(equations, [*-known, brake - n @ known])
        return np.concatenate([np.cross(omega, ball.T).T.ravel(), slopes[:3], [rate], slopes[3:]])

    y = np.array([*np.eye(3).ravel(), 2, 0, 0, 0, 5])
    for end, row in ((0.5, 0), (1.0, 1)):
        y = solve_ivp(change, (end - 0.5, end), y, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        np.testing.assert_allclose(
            column(found, "ball.angular_velocity")[row], y[:9].reshape(3, 3).T @ y[9:12], atol=1e-10
        )
        assert column(found, "brake.torque")[row] == pytest.approx(-0.5 * y[13], abs=1e-10)


def test_what_acts_about_an_axle_ends_no_later_than_that() -> None:
    found = solved([0.2, 1.0], **gimbal(0.25, until=0.5))
    assert found.problem is not None
    assert "axle cannot end here: connections/1/a would have to be joined to b" in found.problem.explanation
    scene = gimbal(0.25, until=0.5)
    scene["connections"][1]["until"] = {"event": {"kind": "end", "name": "axle"}}
    assert happened(solved([0.2, 1.0], **scene)) == [("begin", "brake"), ("end", "axle"), ("end", "brake")]
    scene["connections"][0] |= {"from": 0.25, "until": None}
    scene["connections"][1]["from"] = None
    with pytest.raises(InvalidParameter, match="whenever it acts") as refused:
        solved([1.0], **scene)
    assert refused.value.path == ("connections", 1, "a")


def test_a_motion_may_end_in_the_midst_of_what_happens_at_one_time() -> None:
    found = solved(
        [0.25, 1.0],
        bodies={"a": {"mass": 1, "at": [0, 0], "velocity": [1, 1]}, "b": {"mass": 1, "at": [1, 0]}},
        connections=[
            {"kind": "rod", "name": "rod", "a": "a", "b": "b", "from": 0.25},
            {"kind": "pin", "name": "hook", "a": "a", "b": [0, 0], "from": {"event": {"name": "rod"}}},
        ],
    )
    assert [one.kind for one in found.events] == ["begin", "cannot-begin"]
    np.testing.assert_allclose(column(found, "a.position"), [[0.25, 0.25]], rtol=1e-15)


def test_a_beginning_is_compared_where_a_body_has_turned() -> None:
    body = {"mass": 1, "moments": [0.2, 0.2, 0.2], "angular_velocity": [1, 1, 0], "places": {"q": [-0.2, 0.1, 0.1]}}
    found = solved(
        [1.0],
        bodies={"a": {**body, "at": [0, 0, 0]}, "b": {**body, "at": [1.2, 0, 0.3]}},
        connections=[
            {"kind": "impulse", "name": "blow", "body": "b", "impulse": [1, 1, 1], "at": 0.3},
            {"kind": "inverse-square", "name": "pull", "a": "b.q", "b": "a", "strength": 0.5, "from": 0.3},
        ],
    )
    assert happened(found) == [("impulse", "blow"), ("begin", "pull")]


def test_a_sketch_need_not_fit_what_begins_later() -> None:
    rod = {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0], "length": 2, "from": 0.5}
    track = {"kind": "track", "name": "line", "place": "bob", "on": {"at": [0, 1]}}
    bodies = {"bob": {"mass": 1, "at": ["sqrt(3)", 0.9]}}
    found = solved([1.0], bodies=bodies, connections=[track, rod], assemble="nearest")
    np.testing.assert_allclose(column(found, "bob.position"), [[np.sqrt(3.0), 1.0]], rtol=1e-14)


def test_what_begins_may_leave_open_what_happens_then() -> None:
    # Both feet of a plank that slides are pressed to the ground by the jerk of a rod: which strikes first is open.
    found = solved(
        [1.0],
        gravity=[0, -10],
        bodies={
            "plank": {
                "mass": 1,
                "inertia": 1,
                "at": [0, 1],
                "velocity": [1, 0],
                "places": {"left": [-0.5, -1], "right": [0.5, -1], "top": [0.2, 1]},
            }
        },
        connections=[
            {"kind": "contact", "name": "left", "place": "plank.left", "on": {"at": [0, 0]}, "restitution": 0.5},
            {"kind": "contact", "name": "right", "place": "plank.right", "on": {"at": [0, 0]}, "restitution": 0.5},
            {"kind": "rod", "name": "rod", "a": "plank.top", "b": [-1, -1], "from": 0.5},
        ],
    )
    assert happened(found) == [("begin", "rod"), ("simultaneous-impacts", "left, right")]


def test_what_pulls_at_corners_is_followed_across_a_beginning() -> None:
    # How quick a motion is where something begins depends on attitudes: of the corners that attract one another here.
    rods = {
        name: {"mass": 1, "inertia": "1/12", "at": [x, 0], "angular_velocity": 1, "places": {"end": ["1/2", 0]}}
        for name, x in (("a", 0), ("b", 5))
    }
    found = solved(
        [0.5],
        bodies=rods,
        connections=[
            {"kind": "inverse-square", "name": "pull", "a": "a.end", "b": "b.end", "strength": 1},
            {"kind": "damper", "name": "damper", "a": "a", "b": "b", "coefficient": 2, "from": 0.25},
        ],
    )
    assert found.problem is None
    assert happened(found) == [("begin", "damper")]


def test_a_rod_that_begins_on_what_hangs_at_rest_leaves_it_there() -> None:
    found = solved(
        [0.5],
        gravity=[0, 0, -10],
        bodies={
            "swings": {"mass": 1, "at": ["0.6", 0, "-0.8"], "velocity": [0, 1, 0]},
            "hangs": {"mass": 2, "at": [0, 0, -1]},
        },
        connections=[
            {"kind": "string", "name": "one", "through": ["swings", [0, 0, 0]]},
            {"kind": "string", "name": "two", "through": ["hangs", [0, 0, 0]]},
            {"kind": "damper", "name": "pull", "a": "swings", "b": "hangs", "law": "0*rate"},
            {"kind": "rod", "name": "rod", "a": "hangs", "b": [-1, -1, 2], "from": 0.159},
        ],
    )
    assert happened(found) == [("begin", "rod")]
    np.testing.assert_allclose(column(found, "hangs.velocity"), 0, atol=1e-30)


def test_a_contact_begins_where_a_body_lies_that_moves_beside_others() -> None:
    # Two corners hold the bar level beside a damper that a swinging stone pulls on, so that places are rounded.
    bar = {"mass": 2, "inertia": 1, "at": [5, 0], "places": {"l": [-1, 0], "m": [0, 0], "r": [1, 0]}}
    floors = [{"kind": "contact", "name": f"on-{spot}", "place": f"bar.{spot}", "on": {"at": [5, 0]}} for spot in "lmr"]
    floors[2]["from"] = 0.25
    found = solved(
        [0.5],
        gravity=[0, -10],
        bodies={"stone": {"mass": 0.5, "at": [0.3, -0.4]}, "bar": bar},
        connections=[
            {"kind": "rod", "name": "rod", "a": "stone", "b": [0, 0]},
            {"kind": "damper", "name": "damper", "a": "stone", "b": "bar", "coefficient": 0.5},
            *floors,
        ],
    )
    assert happened(found) == [("begin", "on-r")]
    assert found.phases is not None
    assert found.phases[1].states["on-r"] == "closed"


def test_bodies_that_have_docked_go_on_when_something_else_begins() -> None:
    # Rows of a weld in space depend on one another on its places alone; the centre of both falls freely.
    found = solved(
        [0.5],
        gravity=[0, 0, -10],
        bodies={
            "a": {"mass": 3, "moments": [1, 2, 2], "at": [0, 0, 0], "angular_velocity": [0, 0, 3]},
            "b": {"mass": 1, "moments": [0.1, 0.2, 0.15], "at": [5, 0, -0.5]},
        },
        connections=[
            {"kind": "weld", "name": "weld", "a": "a", "b": "b", "from": 0.175},
            {"kind": "spring", "name": "spring", "a": "a", "b": "b", "stiffness": 5, "from": 0.25},
        ],
    )
    assert happened(found) == [("begin", "weld"), ("begin", "spring")]
    middle = (3 * column(found, "a.position") + column(found, "b.position")) / 4
    np.testing.assert_allclose(middle[0], [1.25, 0, -0.125 - 1.25], rtol=1e-14, atol=1e-14)


def test_a_blow_to_what_two_equal_rods_hold_is_that_to_what_one_holds() -> None:
    # The support moves by formulas of time, so that its places are rounded apart.
    rod = {"kind": "rod", "a": "bob", "b": ["t^2/4", "sin(t)/3"]}
    rest = [
        {"kind": "force", "name": "drag", "place": "bob", "force": ["-vx/3", "-vy/3"]},
        {"kind": "impulse", "name": "blow", "place": "bob", "impulse": [2, -1], "at": 0.366},
        {"kind": "spring", "name": "spring", "a": "bob", "b": [3, 3], "stiffness": 5, "from": 0.5},
    ]
    one, two = (
        solved([0.8], ("trajectory",), bodies={"bob": {"mass": 1, "at": [0.6, 0.8]}}, connections=[*rods, *rest])
        for rods in ([{**rod, "name": "rod"}], [{**rod, "name": "rod"}, {**rod, "name": "again"}])
    )
    assert happened(one) == happened(two) == [("impulse", "blow"), ("begin", "spring")]
    for name in ("bob.position", "bob.velocity"):
        np.testing.assert_allclose(column(two, name), column(one, name), rtol=1e-13)


def test_a_rod_begins_on_a_truss_with_a_bar_more_than_it_needs() -> None:
    half = "sqrt(1/2)"
    places = {"a": [f"-{half}", f"-{half}"], "b": [0, f"-2*{half}"], "c": [half, f"-{half}"]}
    ties = [("a", [0, 0]), ("c", [0, 0]), ("b", "a"), ("b", "c"), ("a", "c"), ("b", [0, 0])]
    bars = [{"kind": "rod", "name": f"bar-{k}", "a": a, "b": b} for k, (a, b) in enumerate(ties)]
    rod = {"mass": 2, "inertia": "1/6", "places": {"top": [-0.5, 0], "end": [0.5, 0]}}
    found = solved(
        [0.8],
        gravity=[0, -10],
        bodies={
            **{name: {"mass": 1, "at": at} for name, at in places.items()},
            "one": {**rod, "at": [f"5 + {half}/2", f"{half}/2"], "angle": "pi/4"},
            "two": {**rod, "at": [f"5 + {half}", f"{half} - 1/2"], "angle": "-pi/2"},
        },
        connections=[
            *bars,
            {"kind": "pin", "name": "hinge", "a": "one.top", "b": [5, 0]},
            {"kind": "pin", "name": "knee", "a": "two.top", "b": "one.end"},
            {"kind": "damper", "name": "rub", "a": "two", "b": "one", "measure": "turn", "coefficient": 0.1},
            {"kind": "rod", "name": "rod", "a": "one", "b": "c", "from": 0.123},
        ],
    )
    assert happened(found) == [("begin", "rod")]
    # The truss stays rigid.
    a, b, c = (column(found, f"{name}.position")[0] for name in "abc")
    np.testing.assert_allclose([np.linalg.norm(c - a), np.linalg.norm(b)], np.sqrt([2, 2]), rtol=1e-13)


def test_what_strikes_where_something_begins_needs_no_piece_of_a_formula() -> None:
    found = solved(
        [0.8],
        gravity=[0, -10],
        bodies={"bob": {"mass": 1, "at": [0.8, -0.6]}, "block": {"mass": 2, "at": [3, 0], "velocity": [0.5, 0]}},
        connections=[
            {"kind": "force", "name": "push", "place": "bob", "force": ["if(t - 1/4, 3, 0)", 0]},
            {"kind": "rod", "name": "hangs", "a": "bob", "b": [0, 0]},
            {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}},
            {"kind": "rod", "name": "tie", "a": "bob", "b": "block", "from": 0.41},
        ],
    )
    assert happened(found) == [("switch", "push"), ("begin", "tie"), ("touch", "floor")]


def test_feet_that_share_a_load_in_no_one_way_do_so_wherever_something_begins() -> None:
    # A table of four feet slides in a spinning frame, by a motion that is rounded when the damper begins.
    feet = {"f0": [0.5, 0.3, -0.5], "f1": [-0.5, 0.3, -0.5], "f2": [-0.5, -0.3, -0.5], "f3": [0.5, -0.3, -0.5]}
    table = {"mass": 10, "moments": [1, 1.5, 2], "at": [5, 0, 0.5], "places": feet, "velocity": [0, 0.5, 0]}
    floor = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    found = solved(
        [0.31],
        ("trajectory", "forces-in-time"),
        gravity=[0, 0, -10],
        bodies={"table": table | {"angular_velocity": [0, 0, 0]}, "ball": {"mass": 3, "at": [0, 0, 1]}},
        connections=[
            *(
                {"kind": "contact", "name": f"on-{foot}", "place": f"table.{foot}", "on": floor, "friction": 0.1}
                for foot in feet
            ),
            {"kind": "spinning-frame", "rate": 1},
            {"kind": "damper", "name": "damper", "a": "table.f1", "b": "ball", "coefficient": 2, "from": 0.294},
        ],
    )
    assert found.trajectory is not None
    assert not [name for name in found.trajectory.columns if name.startswith("on-") and name.endswith("normal")]


def test_a_rod_ends_on_a_bead_on_a_curve_that_is_a_formula() -> None:
    found = solved(
        [0.29, 0.5],
        ("trajectory",),
        gravity=[0, -10],
        bodies={"bead": {"mass": 2, "at": [0, "1/2"]}},
        connections=[
            {"kind": "relation", "name": "curve", "of": "bead.y - exp(-bead.x)/2", "equals": 0},
            {"kind": "rod", "name": "rod", "a": "bead", "b": [1.5, -1], "from": 0.243, "until": 0.29},
        ],
    )
    assert happened(found) == [("begin", "rod"), ("end", "rod")]
    # On the curve, down which it falls from rest since the rod has let it go.
    (_, held), (x, y) = column(found, "bead.position")
    v = column(found, "bead.velocity")[1]
    assert y == pytest.approx(np.exp(-x) / 2, rel=1e-14)
    assert v @ v / 2 == pytest.approx(10 * (held - y), rel=1e-12)


def test_what_ends_by_an_impact_whose_shares_are_open_has_taken_its_own() -> None:
    # Two equal tracks and rods stop the bob, which then falls from rest about (0, 0).
    on = {"at": [1, 0], "slope": "-pi/2"}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0], "from": 0.5}
    until = {"event": {"kind": "begin", "name": "r"}}
    found = solved(
        [0.5 + 2.0**-10, 1.0],
        gravity=[0, -10],
        bodies={"bob": {"mass": 1, "at": [1, 0]}},
        connections=[
            *({"kind": "track", "name": name, "place": "bob", "on": on, "until": until} for name in ("line", "alike")),
            {**rod, "name": "r"},
            {**rod, "name": "again"},
        ],
    )
    assert happened(found) == [("begin", "r"), ("begin", "again"), ("end", "line"), ("end", "alike")]
    assert np.linalg.norm(column(found, "bob.velocity")[0]) < 10 * 2.0**-10


@pytest.mark.parametrize("until", [0.5, {"when": {"quantity": "a.position.x", "equals": 0.625}}])
def test_a_field_ends_for_all_bodies_at_once(until: Any) -> None:
    bodies = {"a": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}, "b": {"mass": 2, "at": [5, 0]}}
    field = {"kind": "field", "name": "wind", "acceleration": [1, 0], "until": until}
    found = solved([1.0], bodies=bodies, connections=[field])
    assert [(one.kind, one.name, one.time) for one in found.events] == [("end", "wind", 0.5)]
    # 1/8 m until then, and half a second at 1/2 m/s.
    np.testing.assert_allclose(column(found, "b.position"), [[5.375, 0]], rtol=1e-14)
    np.testing.assert_allclose(column(found, "a.position"), [[1.375, 0]], rtol=1e-14)


def test_motors_of_different_rates_do_not_hold_one_wheel() -> None:
    wheel = {"wheel": {"mass": 1, "inertia": 1, "at": [0, 0]}}
    motors = [
        {"kind": "motor", "name": "slow", "a": "wheel", "rate": 2, "from": 0.25},
        {"kind": "motor", "name": "fast", "a": "wheel", "rate": "1 + t", "from": 0.5},
    ]
    found = solved([0.3, 1.0], ("trajectory",), bodies=wheel, connections=motors)
    assert found.problem is not None
    assert found.problem.code == "cannot-begin"
    assert "agree with the rates that other connections hold" in found.problem.explanation
    motors[0]["until"] = 0.5
    found = solved([1.0], ("trajectory",), bodies=wheel, connections=motors)
    assert column(found, "wheel.angle")[0] == pytest.approx(0.5 + 0.5 + (1 - 0.25) / 2, rel=1e-14)


def test_forces_are_known_where_a_damper_has_turned_out_to_lie_level() -> None:
    # Two particles keep one height: the damper between them has no part across, but what is rounded of that.
    bodies = {
        "a": {"mass": 2, "at": [0, 1], "inertia": "1/7", "angular_velocity": 1, "places": {"p": [0.3, 0]}},
        "b": {"mass": "1/3", "at": [1.2, 1], "velocity": [1, 1]},
        "c": {"mass": "1/3", "at": [2.5, 1], "velocity": [0, 1]},
    }
    never = {"when": {"quantity": "a.position.y", "equals": 50}}
    found = solved(
        [0.6, 0.8],
        ("trajectory",),
        bodies=bodies,
        connections=[
            {"kind": "damper", "name": "damper", "a": "c", "b": "b", "coefficient": 0.5, "until": never},
            {"kind": "inverse-square", "name": "pull", "a": "a.p", "b": "b", "strength": 0.5, "from": "2/3"},
        ],
    )
    # r' = 2 c/m (1 - r) for the rate at which they approach, with the reduced mass 1/6.
    assert column(found, "b.velocity")[0, 0] == pytest.approx(0.5 + 0.5 * np.exp(-0.5 * 6 * 0.6), rel=1e-13)
    assert happened(found) == [("begin", "pull")]


def test_what_shares_its_impulses_with_others_takes_energy() -> None:
    # The loop of two bodies on a third closes at once: its impulses are not determined, the energy is.
    spins = {"a": (1, 2, 0.3), "b": (0.5, -1, 0.2), "c": (0, 1, 2)}
    moments = {"a": (0.1, 0.2, 0.25), "b": (0.05, 0.03, 0.07), "c": (0.05, 0.06, 0.07)}
    bodies = {
        name: {"mass": 1, "at": [0, 0, 0], "moments": moments[name], "angular_velocity": spins[name]} for name in spins
    }
    found = solved(
        [0.3],
        ("trajectory", "energy-in-time"),
        bodies=bodies,
        connections=[
            {"kind": "pin", "name": "hinge", "a": "b", "b": "c", "axis": [0, 1, 1], "from": 0.2},
            {"kind": "weld", "name": "one", "a": "a", "b": "b", "from": 0.2},
            {"kind": "weld", "name": "two", "a": "a", "b": "c", "from": {"event": {"name": "hinge"}}},
        ],
    )
    energy = sum(x * w * w / 2 for name in spins for x, w in zip(moments[name], spins[name], strict=True))
    lost = sum(one.energy_loss for one in found.events)
    assert not found.events[-1].impulses
    assert found.events[-1].energy_loss > 1e-3
    assert column(found, "energy.kinetic")[0] == pytest.approx(energy - lost, rel=1e-13)


@pytest.mark.parametrize(
    "tie", [{"kind": "rod"}, {"kind": "spring", "stiffness": 5}, {"kind": "damper", "coefficient": 1}]
)
def test_what_begins_later_need_not_have_a_length_at_the_start(tie: dict[str, Any]) -> None:
    bob = {"mass": 1, "at": [0, 0], "velocity": [1, 0]}
    later = {"name": "tie", "a": "bob", "b": [0, 0], "from": 0.5}
    found = solved([1.0], ("trajectory",), bodies={"bob": bob}, connections=[{**later, **tie}])
    assert happened(found) == [("begin", "tie")]
    speed = {"rod": 0.0, "spring": np.cos(np.sqrt(5) / 2), "damper": np.exp(-0.5)}[tie["kind"]]
    assert column(found, "bob.velocity")[0, 0] == pytest.approx(speed, abs=1e-14)
    ended = solved([1.0], ("trajectory",), bodies={"bob": {"mass": 1, "at": [0, 0]}}, connections=[{**later, **tie}])
    assert ended.problem is not None
    assert ended.problem.code == "cannot-begin"


def test_a_ball_like_body_is_compared_by_its_axis_after_its_joint_has_ended() -> None:
    # Of moments that are equal, places tell which axis is answered: that of the joint, also when it holds no more.
    found = solved(
        [0.36, 0.57, 0.8],
        ("trajectory",),
        gravity=[0, 0, -10],
        bodies={"body": {"mass": 1, "moments": [0.1, 0.1, 0.1], "at": [0, 0, 0], "places": {"p": [0, 0, 0.5]}}},
        connections=[
            {"kind": "ball-joint", "name": "hinge", "a": "body.p", "b": [0, 0, 0.5], "until": 0.57},
            {"kind": "force", "name": "f", "place": "body", "force": [1, 0, 0]},
        ],
    )
    assert happened(found) == [("end", "hinge")]
    before, after = column(found, "body.velocity")[1:]
    np.testing.assert_allclose(after - before, [0.23, 0, -2.3], rtol=1e-13, atol=1e-13)


def test_wheels_turn_on_beside_what_rests_when_a_force_begins() -> None:
    found = solved(
        [0.1, 0.2],
        ("trajectory",),
        bodies={
            "g": {"mass": 1, "inertia": "0.02", "radius": 0.2, "at": [0, 0], "angular_velocity": 2},
            "h": {"mass": 1, "inertia": "0.005", "radius": 0.1, "at": [0.3, 0]},
        },
        connections=[
            {"kind": "pin", "name": "axle-g", "a": "g", "b": [0, 0]},
            {"kind": "pin", "name": "axle-h", "a": "h", "b": [0.3, 0]},
            {"kind": "rolling", "name": "mesh", "a": "g", "b": "h"},
            {"kind": "torsion-spring", "name": "twist", "a": "h", "stiffness": 1},
            {"kind": "force", "name": "push", "place": "g", "force": ["1", "0"], "from": 0.122},
        ],
    )
    # (0.02 + 4 x 0.005) phi'' = -4 phi: ten radians a second.
    np.testing.assert_allclose(column(found, "g.angle"), [0.2 * np.sin(1), 0.2 * np.sin(2)], rtol=1e-14)


def test_what_has_been_stopped_may_let_go_at_that_instant() -> None:
    """A bob that a wall stops at its lowest place stays there, with the wall or without."""
    bob = {"mass": 1, "at": ["-sqrt(3)/4", "-1/4"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    wall = {"kind": "contact", "name": "wall", "place": "bob", "on": {"at": [0, 0], "slope": {"degrees": 90}}}
    wall |= {"restitution": 0, "until": {"event": {"name": "wall"}}}
    scene = {"gravity": [0, -9.81], "bodies": {"bob": bob}, "connections": [rod, wall]}
    answer = solve_scene(scene_from(scene), [0.5], ("trajectory",))
    assert [event.kind for event in answer.events] == ["touch", "end"]
    assert answer.trajectory is not None
    np.testing.assert_allclose(answer.trajectory.columns["bob.position"].values, [[0, -0.5]], rtol=0, atol=1e-14)

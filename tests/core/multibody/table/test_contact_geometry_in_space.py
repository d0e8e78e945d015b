"""Contacts in space: balls that slip and roll, bounce and spin, feet that share a load, friction that turns.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), chapter 8 (a ball slips along a parabola until it rolls).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf, odefun, quad, sqrt

from core.multibody.solve import solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.table.test_contact_geometry import kinds, states
from tests.core.multibody.worked_examples import column, force, read

G = 9.81
FLOOR = {"at": [0, 0, 0], "normal": [0, 0, 1]}


def ball(law: dict[str, Any], **state: Any) -> dict[str, Any]:
    return {
        "gravity": [0, 0, -9.81],
        "bodies": {"ball": {"mass": 1, "radius": 0.1, "moments": [0.004] * 3, "at": [0, 0, 0.1], **state}},
        "connections": [{"kind": "contact", "name": "floor", "place": "ball", "on": FLOOR, **law}],
    }


@pytest.mark.parametrize("side", [0.0, 7.0])
def test_a_ball_with_oblique_spin_slips_along_a_parabola_and_rolls(side: float) -> None:
    """The slip of the lowest point, v - R w x n, keeps its direction: 7/2 mu g takes it away. Side spin is free."""
    scene = ball({"friction": 0.2}, velocity=[3, 1, 0], angular_velocity=[5, 20, side])
    time = np.array([0.0, 0.1, 0.2, 0.5, 1.0])
    answer = solve_scene(read(scene), time, ("trajectory", "forces-in-time", "energy-in-time"))
    assert kinds(answer) == [("roll", "floor")]
    with mp.workdps(40):
        slip = (mpf(3) - mpf("0.1") * 20, mpf(1) + mpf("0.1") * 5)
        size = sqrt(slip[0] ** 2 + slip[1] ** 2)
        end = 2 * size / (7 * mpf("0.2") * mpf("9.81"))
        assert abs(answer.events[0].time - end) <= answer.events[0].error + 1e-17
        u = [float(x / size) for x in slip]
    early = np.minimum(time, float(end))
    velocity = np.stack([3 - 0.2 * G * early * u[0], 1 - 0.2 * G * early * u[1], 0 * time], axis=1)
    at_end = np.array([3 - 0.2 * G * float(end) * u[0], 1 - 0.2 * G * float(end) * u[1]])
    place = np.outer(early, [3, 1]) - 0.1 * G * np.outer(early**2, u) + np.outer(time - early, at_end)
    found = column(answer, "ball.velocity")
    assert np.abs(found.values - velocity).max() <= found.error + 1e-15
    assert np.abs(column(answer, "ball.position").values[:, :2] - place).max() <= 4e-15
    # The moment of friction: R (-n) x F.
    spin = column(answer, "ball.angular_velocity_in_space").values
    turned = 0.2 * G * 0.1 / 0.004 * early
    assert spin == pytest.approx(np.stack([5 - u[1] * turned, 20 + u[0] * turned, 0 * time + side], axis=1), abs=1e-13)
    rub = np.stack([column(answer, f"floor.friction.{axis}").values for axis in "xy"], axis=1)
    assert rub[0] == pytest.approx([-0.2 * G * x for x in u], rel=1e-15)
    assert rub[-1] == pytest.approx([0, 0], abs=1e-15)


def test_a_ball_bounces_with_spin_and_comes_to_rest() -> None:
    """The impulse of friction stops the slip if 2/7 |s| is at most mu (1 + e) v; then bounces end as without spin."""
    scene = ball(
        {"friction": 0.5, "restitution": 0.6}, at=[0, 0, 1.1], velocity=[1, 0.5, 0], angular_velocity=[3, 0, 2]
    )
    answer = solve_scene(read(scene), [1.0, 3.0], ("trajectory",))
    down = math.sqrt(2 * G)
    slip = np.array([1.0, 0.5 + 0.1 * 3])
    first = answer.events[0]
    assert first.impulses["normal"] == pytest.approx(1.6 * down, rel=1e-14)
    pushed = -2 / 7 * slip
    assert [first.impulses[f"friction.{axis}"] for axis in "xy"] == pytest.approx(pushed, rel=1e-14)
    assert kinds(answer)[-1] == ("settle", "floor")
    assert answer.events[-1].time == pytest.approx(math.sqrt(2 / G) * 1.6 / 0.4, rel=1e-15)
    assert column(answer, "ball.velocity").values[1] == pytest.approx([1 + pushed[0], 0.5 + pushed[1], 0], abs=1e-14)
    assert column(answer, "ball.angular_velocity_in_space").values[1, 2] == 2.0
    # Where friction is too weak for that, the impulse is mu times the other, against the slip.
    weak = solve_scene(read(scene | {"connections": [scene["connections"][0] | {"friction": 0.02}]}), [0.6])
    rubbed = [weak.events[0].impulses[f"friction.{axis}"] for axis in "xy"]
    assert rubbed == pytest.approx(-0.02 * 1.6 * down * slip / np.linalg.norm(slip), rel=1e-14)


def test_friction_turns_with_the_slip_on_a_slope() -> None:
    """A point pushed across a slope, psi the angle of its way: v' = g sin(a) cos(psi) - f, v psi' = -g sin(a) sin(psi).

    It stops after v0 f/(f^2 - (g sin a)^2), because f v + g sin(a) v cos(psi) falls at that constant rate.
    """
    scene = {
        "gravity": ["9.81*sin(0.3)", 0, "-9.81*cos(0.3)"],
        "bodies": {"p": {"mass": 1, "at": [0, 0, 0], "velocity": [0, 2, 0]}},
        "connections": [{"kind": "contact", "name": "slope", "place": "p", "on": FLOOR, "friction": 0.5}],
    }
    answer = solve_scene(read(scene), [0.1, 0.3, 0.6, 1.0], ("trajectory", "forces-in-time", "energy-in-time"))
    assert kinds(answer) == [("stick", "slope")]
    with mp.workdps(30):
        pull, rub = mpf("9.81") * mp.sin(mpf("0.3")), mpf("9.81") * mp.cos(mpf("0.3")) / 2
        assert abs(answer.events[0].time - 2 * rub / (rub**2 - pull**2)) <= answer.events[0].error
        # Another formulation: speed and angle as functions of time, by Taylor series of mpmath.
        mp.dps = 20
        way = odefun(
            lambda t, y: [pull * mp.cos(y[1]) - rub, -pull * mp.sin(y[1]) / y[0]],
            0,
            [mpf(2), mp.pi / 2],
            tol=mpf("1e-17"),
        )
        for k, t in enumerate((0.1, 0.3, 0.6)):
            speed, angle = way(mpf(t))
            expected = [float(speed * mp.cos(angle)), float(speed * mp.sin(angle)), 0.0]
            assert column(answer, "p.velocity").values[k] == pytest.approx(expected, abs=1e-14)
            against = [float(-rub * mp.cos(angle)), float(-rub * mp.sin(angle))]
            told = [column(answer, f"slope.friction.{axis}").values[k] for axis in "xy"]
            assert told == pytest.approx(against, abs=1e-13)
    assert column(answer, "p.velocity").values[3].tolist() == [0.0, 0.0, 0.0]
    assert states(answer)[-1] == {"slope": "stick"}


def test_what_slips_from_rest_does_so_against_the_friction_that_would_hold_it() -> None:
    scene = {
        "gravity": [6.0, 2.5, -9.81],
        "bodies": {"p": {"mass": 3, "at": [0, 0, 0]}},
        "connections": [{"kind": "contact", "name": "slope", "place": "p", "on": FLOOR, "friction": [0.6, 0.5]}],
    }
    answer = solve_scene(read(scene), [1.0])
    assert states(answer) == [{"slope": "slide"}]
    pull = math.hypot(6.0, 2.5)
    gain = (pull - 0.5 * G) / pull
    assert column(answer, "p.position").values[0] == pytest.approx([3.0 * gain, 1.25 * gain, 0], rel=1e-14)
    # Exactly at the angle of friction it sticks: 6.5 of gravity along, 6.5/0.65 against the floor.
    scene["gravity"] = [6, 2.5, -10]
    scene["connections"][0]["friction"] = 0.65  # type: ignore[index]
    assert states(solve_scene(read(scene), [1.0])) == [{"slope": "stick"}]
    (rest,) = solve_scene(read(scene), [], (RestOf("/connections/0/friction", (0.1, 2.0)),)).thresholds or ()
    assert rest.lower is not None
    assert rest.lower.value == pytest.approx(0.65, rel=1e-15)


def table(law: dict[str, Any], gravity: Any = (0, 0, -9.81)) -> dict[str, Any]:
    feet = {f"f{i}": [x, y, -0.7] for i, (x, y) in enumerate(((0.5, 0.3), (-0.5, 0.3), (-0.5, -0.3), (0.5, -0.3)))}
    return {
        "gravity": list(gravity),
        "bodies": {"table": {"mass": 10, "moments": [1, 1.5, 2], "at": [0, 0, 0.7], "places": feet}},
        "connections": [{"kind": "contact", "name": f, "place": f"table.{f}", "on": FLOOR, **law} for f in feet],
    }


def test_four_feet_share_a_load_that_is_not_determined() -> None:
    answer = solve_scene(read(table({})), [1.0])
    assert answer.model.name == "rest"
    assert answer.forces is not None
    for foot in ("f0", "f1", "f2", "f3"):
        told = answer.forces[f"{foot}.normal"]
        assert not told.determined
        assert told.shared_with == ("f0", "f1", "f2", "f3")
    # With friction it holds on a slope, if round cones admit any share of the load: 3 to 9.81 is below 0.4.
    rough = solve_scene(read(table({"friction": 0.4}, (3, 0, -9.81))), [1.0])
    assert rough.model.name == "rest"
    assert set(states(rough)[0].values()) == {"stick"}
    steep = solve_scene(read(table({"friction": 0.4}, (5, 0, -9.81))), [1.0])
    assert steep.problem is None
    assert set(states(steep)[0].values()) == {"slide"}
    # Three feet leave nothing open.
    scene = table({})
    del scene["connections"][3]
    scene["bodies"]["table"]["at"] = [0, 0, 0.7]
    tripod = solve_scene(read(scene), [0.0])
    assert force(tripod, "f0.normal") == pytest.approx(10 * G / 2, rel=1e-14)
    assert force(tripod, "f1.normal") == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("friction", [None, 0.3])
def test_a_dumbbell_dropped_in_space_is_that_of_the_plane(friction: float | None) -> None:
    """In a vertical plane of any direction the impulses are those of the scene in the plane."""
    law = {"restitution": 0.5} | ({} if friction is None else {"friction": friction})
    plane = {
        "gravity": [0, -9.81],
        "bodies": {
            "d": {
                "mass": 2,
                "inertia": 0.5,
                "at": [0, 1],
                "angle": 0.6435011087932844,
                "places": {"a": [-0.5, 0], "b": [0.5, 0]},
            }
        },
        "connections": [{"kind": "contact", "name": k, "place": f"d.{k}", "on": {"at": [0, 0]}, **law} for k in "ab"],
    }
    c, s = 0.6, 0.8
    space = {
        "gravity": [0, 0, -9.81],
        "bodies": {
            "d": {
                "mass": 2,
                "moments": [0.02, 0.5, 0.5],
                "at": [0, 0, 1],
                "axes": [[0.8 * c, 0.8 * s, 0.6], [-s, c, 0], [-0.6 * c, -0.6 * s, 0.8]],
                "places": {"a": [-0.5, 0, 0], "b": [0.5, 0, 0]},
            }
        },
        "connections": [{"kind": "contact", "name": k, "place": f"d.{k}", "on": FLOOR, **law} for k in "ab"],
    }
    time = np.linspace(0, 0.7, 8)
    flat, full = (solve_scene(read(scene), time, ("trajectory",)) for scene in (plane, space))
    assert kinds(flat) == kinds(full)
    for one, two in zip(flat.events, full.events, strict=True):
        assert two.time == pytest.approx(one.time, rel=4e-15)
        assert two.impulses["normal"] == pytest.approx(one.impulses["normal"], rel=1e-13)
        assert two.energy_loss == pytest.approx(one.energy_loss, rel=1e-12)
        if friction is not None:
            along = c * two.impulses["friction.x"] + s * two.impulses["friction.y"]
            assert along == pytest.approx(one.impulses["friction"], rel=1e-13)
    ours, theirs = column(flat, "d.position").values, column(full, "d.position").values
    assert theirs == pytest.approx(np.stack([c * ours[:, 0], s * ours[:, 0], ours[:, 1]], axis=1), abs=1e-13)


def test_a_block_takes_the_plank_along_obliquely() -> None:
    """On ice, slip 2 m/s along (0.6, 0.8): mu g (1 + 1/4) takes it away, and both go on at a fifth of it."""
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {
            "plank": {"mass": 4, "at": [0, 0, 0]},
            "block": {"mass": 1, "at": [0, 0, 0], "velocity": [1.2, 1.6, 0]},
        },
        "connections": [
            {"kind": "track", "place": "plank", "on": FLOOR},
            {
                "kind": "contact",
                "name": "top",
                "place": "block",
                "on": {"at": "plank", "normal": [0, 0, 1]},
                "friction": 0.3,
            },
        ],
    }
    answer = solve_scene(read(scene), [1.0])
    assert kinds(answer) == [("stick", "top")]
    assert answer.events[0].time == pytest.approx(2 / (0.3 * G * 1.25), rel=1e-15)
    for body in ("plank", "block"):
        assert column(answer, f"{body}.velocity").values[0] == pytest.approx([0.24, 0.32, 0], abs=1e-15)


def test_a_stone_leaves_a_hollow_sphere() -> None:
    """From the lowest place, |v|^2 between 2 g r and 5 g r: it leaves where v^2 = -g r cos(theta)."""
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, 0, -0.5], "velocity": [2.4, 3.2, 0]}},
        "connections": [{"kind": "contact", "name": "bowl", "place": "p", "on": {"at": [0, 0, 0], "radius": -0.5}}],
    }
    answer = solve_scene(read(scene), [0.35])
    assert kinds(answer)[0] == ("lift-off", "bowl")
    with mp.workdps(30):
        g, r = mpf("9.81"), mpf("0.5")
        end = mp.acos((2 * g * r - 16) / (3 * g * r))
        when = quad(lambda a: r / sqrt(16 - 2 * g * r * (1 - mp.cos(a))), [0, end])
    assert abs(answer.events[0].time - when) <= answer.events[0].error + 1e-16


@pytest.mark.parametrize(("speed", "spin"), [(2, 0), (32, -300)])
def test_friction_near_the_end_of_a_slip_that_turns_is_as_right_as_stated(speed: int, spin: int) -> None:
    """A ball on a tilted plane: with tau the tangent of half the slip's angle, everything is a power of tau.

    The slip u and its angle psi obey u' = G cos(psi) - c, u psi' = -G sin(psi) with c = 7/2 mu g_n, so that
    u = A tau^(k-1) (1 + tau^2) with k = c/G, and the time that is left is A/G (tau^(k-1)/(k-1) + tau^(k+1)/(k+1)).
    """
    with mp.workdps(50):
        along, across, friction = mp.mpf(3), mp.mpf(9), mp.mpf("0.25")
        k = 7 * friction * across / 2 / along

        def left(tau: Any) -> Any:
            return (tau ** (k - 1) / (k - 1) + tau ** (k + 1) / (k + 1)) / along

        times = [float(left(mp.mpf(1)) - mp.mpf(before)) for before in ("0.2", "1e-2", "1e-4", "1e-6", "1e-8")]
        found = []
        for time in times:
            rest = left(mp.mpf(1)) - mp.mpf(time)
            start = (rest * along * (k - 1)) ** (1 / (k - 1))
            angle = 2 * mp.atan(mp.findroot(lambda tau, rest=rest: mp.log(left(tau) / rest), start))
            found.append([-friction * across * mp.cos(angle), -friction * across * mp.sin(angle)])
    ball = {"mass": 1, "radius": "0.1", "moments": ["0.004"] * 3, "at": [0, 0, "0.1"]}
    ball |= {"velocity": [0, speed, 0], "angular_velocity": [spin, 0, 0]}
    floor = {"kind": "contact", "name": "f", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    scene = {"gravity": [3, 0, -9], "bodies": {"b": ball}, "connections": [{**floor, "friction": "0.25"}]}
    answer = solve_scene(read(scene), times, ("forces-in-time",))
    assert answer.trajectory is not None
    for i, axis in enumerate("xy"):
        rub = answer.trajectory.columns[f"f.friction.{axis}"]
        for value, true in zip(rub.values, found, strict=True):
            assert abs(value - true[i]) <= rub.error


def test_redundant_legs_stay_redundant_while_the_friction_of_another_turns() -> None:
    """A table on four smooth legs, pulled at its centre, moves as a point on a plane does."""
    spots = {f"f{k}": [x, y, -0.5] for k, (x, y) in enumerate(((0.5, 0.3), (-0.5, 0.3), (-0.5, -0.3), (0.5, -0.3)))}
    centre = {"mass": 10, "at": [0, 0, 0.5], "velocity": [1, 0, 0]}
    stone = {"mass": 0.5, "at": [5, 0, 0], "velocity": [-1.6, 0.5, 1.2]}
    slope = {"kind": "contact", "place": "m", "on": {"at": [5, 0, 0], "normal": [0.6, 0, 0.8]}, "friction": 0.2}
    spring = {"kind": "spring", "a": "table", "b": "m", "stiffness": 5}
    floor = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    legs = [{"kind": "contact", "place": f"table.{spot}", "on": floor} for spot in spots]
    plane = {"kind": "track", "place": "table", "on": {"at": [0, 0, 0.5], "normal": [0, 0, 1]}}
    table = centre | {"moments": [1, 1.5, 2], "angular_velocity": [0, 0, 0], "places": spots}
    answers = []
    for body, held in ((table, legs), (centre, [plane])):
        scene = {"gravity": [0, 0, -10], "bodies": {"table": body, "m": stone}, "connections": [*held, slope, spring]}
        answers.append(solve_scene(read(scene), [0.1, 0.3], ("trajectory",)))
    for name in ("table.position", "m.position", "m.velocity"):
        first, second = (column(answer, name) for answer in answers)
        assert np.max(np.abs(np.asarray(first.values) - np.asarray(second.values))) <= first.error + second.error


def test_bounces_whose_friction_turns_are_not_summed_up_as_if_it_did_not() -> None:
    """A particle that gravity pulls across its way, against the sum over its bounces: mu (1 + e) w at each."""
    floor = {"kind": "contact", "place": "m", "on": FLOOR, "restitution": 0.5, "friction": 0.1}
    body = {"mass": 1, "at": [0, 0, 0], "velocity": [0.5, 1, 1]}
    until = 4 / G * (1 - 1e-6)
    rate, now, opening = np.array([0.5, 1.0]), 0.0, 1.0
    while now + 2 * opening / G < until:
        rate, now = rate + np.array([3 * 2 * opening / G, 0]), now + 2 * opening / G
        rate, opening = rate * (1 - 0.1 * 1.5 * opening / np.hypot(*rate)), 0.5 * opening
    scene = {"gravity": [3, 0, -G], "bodies": {"m": body}, "connections": [floor]}
    found = column(solve_scene(read(scene), [until, 4 / G + 1e-3], ("trajectory",)), "m.velocity")
    assert np.abs(found.values[0, :2] - rate - [3 * (until - now), 0]).max() <= found.error + 1e-15

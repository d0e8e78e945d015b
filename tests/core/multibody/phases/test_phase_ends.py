"""Contacts that are only just reached or missed, told as undecided or decided; motions that nearly repeat."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mpmath import acos, cos, ellipf, ellipk, linspace, mp, mpf, quad, sqrt
from scipy.integrate import solve_ivp

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read


def pendulum(wall: Any, at: tuple[Any, Any] = (1, 0)) -> dict[str, Any]:
    """Return a pendulum of 1 m, released at rest, that turns back as high on the other side; level unless told."""
    return {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": list(at)}},
        "connections": [
            {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]},
            {"kind": "contact", "name": "wall", "place": "bob", "on": {"at": [wall, 0], "slope": {"degrees": -90}}},
        ],
    }


@pytest.mark.parametrize(
    ("at", "wall", "modulus", "order"),
    [((0.6, -0.8), -0.6, "0.1", 2), ((0.6, -0.8), "-0.6 - 1e-32", "0.1", 2), ((1, 0), "-1 - 1e-32", "0.5", 4)],
)
def test_a_wall_at_the_turning_point_is_undecided(at: Any, wall: Any, modulus: str, order: int) -> None:
    """Half a period from the angle theta is 2 K(sin^2(theta/2)) sqrt(l/g); 2 sin^2(theta/2) = 1 - cos(theta)."""
    answer = solve_scene(read(pendulum(wall, at)), [1.0, 2.0])
    assert answer.problem is not None
    assert answer.problem.code == "grazing-contact"
    assert [set(one) for one in answer.problem.candidates] == [{"wall"}, {"wall"}]
    half = 2 * ellipk(mpf(modulus)) / sqrt(mpf("9.81"))
    # The gap leaves zero as that power of time: the higher it is, the less is known when it is lowest.
    assert abs(answer.events[0].time - half) <= answer.events[0].error < 10 ** (-24 / order)
    assert answer.trajectory is not None
    assert answer.trajectory.rows.tolist() == [0]


def test_a_wall_at_the_end_of_the_circle_is_passed() -> None:
    """The gap 1 + cos(theta) is nowhere less than zero, and a touch at rest changes nothing."""
    answer = solve_scene(read(pendulum(-1)), [2.0])
    assert answer.problem is None
    assert kinds(answer) == []


def test_a_wall_that_is_clearly_missed_by_little_is_missed() -> None:
    answer = solve_scene(read(pendulum("-1 - 1e-24")), [1.0, 2.0])
    assert kinds(answer) == []


def test_a_wall_that_is_clearly_reached_by_little_is_reached() -> None:
    """At sin(theta) = 1 - 1e-20 on the way up: the time by elliptic integrals, of modulus 1/sqrt 2."""
    answer = solve_scene(read(pendulum("-1 + 1e-20")), [1.0, 2.0])
    assert kinds(answer)[0] == ("touch", "wall")
    with mp.workdps(50):
        angle = acos(sqrt(1 - (1 - mpf(10) ** -20) ** 2))
        # sin(theta/2) = sin(phi)/sqrt 2 from the lowest place on.
        phi = mp.asin(sqrt(2) * mp.sin(angle / 2))
        when = (ellipk(mpf(1) / 2) + ellipf(phi, mpf(1) / 2)) / sqrt(mpf("9.81"))
        assert abs(answer.events[0].time - when) <= answer.events[0].error


def test_in_closed_form_a_touch_at_rest_is_decided() -> None:
    scene = {
        "gravity": [0, -10],
        "bodies": {"ball": {"mass": 1, "at": [0, 0], "velocity": [0, 4]}},
        "connections": [
            {"kind": "contact", "name": "ceiling", "place": "ball", "on": {"at": [0, 0.8], "slope": {"degrees": 180}}}
        ],
    }
    answer = solve_scene(read(scene), [0.8])
    assert answer.problem is None
    assert kinds(answer) == []
    assert any("touches at rest" in sentence for sentence in answer.model.noticed)


def spherical_pendulum(pivot: tuple[int, int, int], rate: str) -> dict[str, Any]:
    x, y, z = pivot
    bob = {"mass": 1, "at": [f"{x} + 0.6", y, f"{z} - 0.8"], "velocity": [0, rate, 0]}
    return {
        "gravity": [0, 0, -9.81],
        "bodies": {"b": bob},
        "connections": [{"kind": "rod", "a": "b", "b": list(pivot)}],
    }


@pytest.mark.parametrize("pivot", [(0, 0, 0), (1, 2, 3)])
@pytest.mark.parametrize("rate", ["0.35", "-0.35", "0.2"])
def test_a_wall_that_an_ellipse_reaches_as_it_turns(pivot: tuple[int, int, int], rate: str) -> None:
    """The height repeats every second, and the ellipse turns: the wall beside it is reached after ten or more."""
    scene = spherical_pendulum(pivot, rate)
    place = {"at": [0, f"{pivot[1]} + 0.5", 0], "normal": [0, -1, 0]}
    wall = {"kind": "contact", "name": "w", "place": "b", "on": place, "restitution": 1}
    touch = solve_scene(read(scene | {"connections": [*scene["connections"], wall]}), [60]).events[0]
    times = np.linspace(0.0, 60.0, 60_001)
    beyond = column(solve_scene(read(scene), times), "b.position").values[:, 1] > pivot[1] + 0.5
    first = times[int(np.argmax(beyond))]
    assert first > 10.0
    assert first - 1.1e-3 <= touch.time <= first


def test_a_wall_that_a_swing_in_a_plane_never_reaches_is_looked_for_in_one_period() -> None:
    scene = spherical_pendulum((0, 0, 0), "0")
    wall = {"kind": "contact", "name": "w", "place": "b", "on": {"at": [0, 1, 0], "normal": [0, -1, 0]}}
    assert not solve_scene(read(scene | {"connections": [*scene["connections"], wall]}), [1e6]).events


@pytest.mark.parametrize("horizon", [1.5, 50.0, 5000.0])
def test_a_wall_beside_a_conical_pendulum_is_met_in_the_first_turn(horizon: float) -> None:
    """It circles at 0.6 m with sqrt(10/0.8) rad/s, and the wall is at 0.599 m on the other side."""
    bob = {"mass": 1, "at": ["0.6", 0, "-0.8"], "velocity": [0, "0.6*sqrt(12.5)", 0]}
    rod = {"kind": "rod", "a": "b", "b": [0, 0, 0]}
    wall = {"kind": "contact", "name": "w", "place": "b", "on": {"at": ["-0.599", 0, 0], "normal": [1, 0, 0]}}
    found = solve_scene(read({"gravity": [0, 0, -10], "bodies": {"b": bob}, "connections": [rod, wall]}), [horizon])
    right = (np.pi - np.arccos(0.599 / 0.6)) / np.sqrt(12.5)
    assert found.events[0].time == pytest.approx(right, rel=1e-13)


def swing(speed_squared: mpf, height: mpf) -> mpf:
    """Return the time from the lowest place of a circle of 1 m up to a height above its centre, with g = 10 m/s^2."""
    return quad(lambda angle: 1 / sqrt(speed_squared - 20 * (1 - cos(angle))), linspace(0, acos(-height), 5))


@pytest.mark.parametrize("short", ["1e-3", "1e-6", "1e-9"])
def test_a_string_that_is_slack_for_a_small_part_of_a_turn_is_slack(short: str) -> None:
    """Its tension is zero where v^2 = g y, which is 50 e/30 m below the top for v^2 = 50 (1 - e) at the bottom."""
    stone = {"mass": 1, "at": [0, -1], "velocity": [f"sqrt(50*(1 - {short}))", 0]}
    string = {"kind": "string", "name": "s", "through": ["stone", [0, 0]]}
    scene = {"gravity": [0, -10], "bodies": {"stone": stone}, "connections": [string]}
    answer = solve_scene(read(scene), [0.8])
    assert kinds(answer)[:2] == [("slack", "s"), ("taut", "s")]
    with mp.workdps(40):
        right = swing(50 * (1 - mpf(short)), 1 - 50 * mpf(short) / 30)
        assert abs(answer.events[0].time - right) <= answer.events[0].error


def test_what_lifts_off_at_once_flies_on_with_a_damper_between() -> None:
    """The damper does nothing, as both move alike; its length and rate change by rounding alone."""
    loops = [
        {"kind": "contact", "name": f"loop-{x}", "place": x, "on": {"at": [at, 0], "radius": -1}}
        for x, at in (("a", 0), ("b", 5))
    ]
    bodies = {x: {"mass": 2, "at": [at, -1], "velocity": ["sqrt(35)", 0]} for x, at in (("a", 0), ("b", 5))}
    damper = {"kind": "damper", "a": "a", "b": "b", "coefficient": 0.5}
    answer = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": [*loops, damper]}), [0.8])
    assert kinds(answer) == [("lift-off", "loop-a"), ("lift-off", "loop-b")]
    with mp.workdps(40):
        right = swing(mpf(35), mpf(1) / 2)
        assert all(abs(event.time - right) <= event.error for event in answer.events)


@settings(max_examples=8)
@given(st.integers(1, 20), st.integers(0, 60), st.integers(1, 9))
@example(10, 20, 10)
def test_a_block_whose_string_reaches_its_pulley_ends_there(heavy: int, friction: int, way: int) -> None:
    """On a rough table, beside a hanging block: with accelerations g (M - mu m)/(M + m)."""
    mass, rough, left = mpf(heavy) / 10, mpf(friction) / 100, mpf(way) / 10
    pull = mpf("9.81") * (mass - rough) / (1 + mass)
    assume(pull > 0.1)
    last = sqrt(2 * left / pull)
    scene = {
        "gravity": [0, "-9.81"],
        "bodies": {
            "a": {"mass": 1, "at": [f"-{way}/10", 0]},
            "b": {"mass": f"{heavy}/10", "at": [0, "-0.5"]},
        },
        "connections": [
            {"kind": "contact", "name": "floor", "place": "a", "on": {"at": [0, 0]}, "friction": f"{friction}/100"},
            {"kind": "string", "name": "s", "through": ["a", [0, 0], "b"]},
        ],
    }
    answer = solve_scene(read(scene), [float(last / 2), float(last * 2)])
    assert kinds(answer) == [("singular", "s")]
    assert answer.events[0].time == pytest.approx(float(last), rel=4e-16)
    assert answer.trajectory is not None
    assert answer.trajectory.rows.tolist() == [0]


@settings(max_examples=6)
@given(st.integers(30, 45), st.integers(12, 18), st.integers(3, 7))
@example(35, 15, 5)
def test_an_event_before_a_singular_place_does_not_depend_on_the_last_time(fast: int, strong: int, stiff: int) -> None:
    scene = {
        "gravity": [0, -10],
        "bodies": {"v": {"mass": 1, "at": [0, -1], "velocity": [f"sqrt({fast})", 0]}, "m": {"mass": 1, "at": [3.5, 0]}},
        "connections": [
            {"kind": "contact", "name": "loop", "place": "v", "on": {"at": [0, 0], "radius": -1}},
            {"kind": "track", "place": "m", "on": {"at": [3, 0]}},
            {"kind": "inverse-square", "a": [3, 0], "b": "m", "strength": f"{strong}/10"},
            {"kind": "spring", "a": "m", "b": "v", "stiffness": stiff},
        ],
    }
    whole = solve_scene(read(scene), [1.0]).events
    assert [event.kind for event in whole if event.kind != "lift-off"] == ["lost-event"]
    for share in (0.9, 0.999):
        events = solve_scene(read(scene), [share * whole[-1].time]).events
        assert [(one.kind, one.time) for one in events] == [
            (one.kind, pytest.approx(one.time, abs=one.error)) for one in whole if one.time < share * whole[-1].time
        ]


@pytest.mark.parametrize("floor", [[], [{"kind": "contact", "place": "l", "on": {"at": [0, -50]}}]])
def test_weights_that_attract_one_another_meet_their_drum(floor: list[Any]) -> None:
    """What ends the motion is no collision: the weights are metres apart then."""
    bodies = {
        "l": {"mass": 1, "at": [-0.2, -2]},
        "r": {"mass": 4, "at": [0.2, -2]},
        "d": {"mass": 1, "inertia": 0.02, "radius": 0.2, "at": [0, 0]},
    }
    connections = [
        {"kind": "pin", "a": "d", "b": [0, 0]},
        {"kind": "string", "name": "s", "through": ["l", "d", "r"], "sides": {"d": ["left", "right"]}},
        {"kind": "gravitation", "a": "l", "b": "r", "constant": "1/10"},
        *floor,
    ]
    answer = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": connections}), [2.0])
    assert kinds(answer)[-1][0] == "singular"


def test_a_weight_that_reaches_its_peg_after_a_jerk_ends_the_motion_there() -> None:
    """A weight on a string over two pegs, and on the other side one that a spring pulls away: slack, taut, singular."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"a": {"mass": 1, "at": [-0.1, -1]}, "b": {"mass": 1, "at": [0.1, -0.6]}},
        "connections": [
            {"kind": "string", "name": "cord", "through": ["a", [-0.1, 0], [0.1, 0], "b"]},
            {"kind": "spring", "a": "b", "b": [4.2, 0.6], "stiffness": 20, "rest_length": 0},
        ],
    }
    peg, far, gravity = np.array([0.1, 0.0]), np.array([4.2, 0.6]), np.array([0.0, -9.81])

    def apart(t: float, x: np.ndarray) -> np.ndarray:
        return np.concatenate([x[2:], gravity + 20.0 * (far - x[:2])])

    def slack(t: float, x: np.ndarray) -> float:
        return float(0.6 - 4.905 * t * t - np.linalg.norm(x[:2] - peg))

    def together(_: float, x: np.ndarray) -> np.ndarray:
        """Return the rates of b, whose acceleration along the string is that of a, with the tension between them."""
        along = (x[:2] - peg) / np.linalg.norm(x[:2] - peg)
        push, across = gravity + 20.0 * (far - x[:2]), x[2:] - (x[2:] @ along) * along
        bend = across @ across / np.linalg.norm(x[:2] - peg)
        return np.concatenate([x[2:], push - 0.5 * (push @ along + bend + 9.81) * along])

    def left(_: float, x: np.ndarray) -> float:
        return float(1.6 - np.linalg.norm(x[:2] - peg))

    exact = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    slack.terminal = left.terminal = True  # type: ignore[attr-defined]
    slack.direction = -1.0  # type: ignore[attr-defined]
    first = solve_ivp(apart, (0.0, 1.0), [0.1, -0.6, 0.0, 0.0], events=slack, **exact)
    (taut,), (x,) = first.t_events[0], first.y_events[0]
    along = (x[:2] - peg) / np.linalg.norm(x[:2] - peg)
    # Equal masses share the speeds along the string: that of b outward, and that of a, which falls, the other way.
    x[2:] -= 0.5 * (x[2:] @ along + 9.81 * taut) * along
    then = solve_ivp(together, (taut, 1.0), x, events=left, **exact)
    answer = solve_scene(read(scene), [0.5])
    assert kinds(answer) == [("taut", "cord"), ("singular", "cord")]
    assert [one.time for one in answer.events] == pytest.approx([taut, then.t_events[0][0]], abs=1e-8)


@pytest.mark.parametrize("heavy", ["1.01", "1.0001"])
@pytest.mark.parametrize("space", [False, True])
def test_masses_on_a_string_above_a_floor_come_down_again_and_again(heavy: str, space: bool) -> None:
    """In space one computation of the motion has constant accelerations, and the other, a rounding beside it, a series.

    The heavier lands with v, the lighter flies on and is back after 2 v/g; then both go on with v/(1 + m), and the
    heavier comes down again after 2 v/(1 + m) over the acceleration of the machine.
    """

    def at(x: float, y: float) -> list[float]:
        return [x, 0.0, y] if space else [x, y]

    floor = {"at": at(0, 0), **({"normal": [0, 0, 1]} if space else {})}
    scene = {
        "gravity": at(0, -9.81),
        "bodies": {"a": {"mass": 1, "at": at(-0.5, 2)}, "b": {"mass": heavy, "at": at(0.5, 2)}},
        "connections": [
            {"kind": "string", "name": "s", "through": ["a", at(-0.5, 5), at(0.5, 5), "b"], "restitution": 0},
            {"kind": "contact", "name": "floor", "place": "b", "on": floor},
        ],
    }
    mass, expected = float(heavy), []
    pull = 9.81 * (mass - 1.0) / (mass + 1.0)
    time, speed = np.sqrt(4.0 / pull), np.sqrt(4.0 * pull)
    for _ in range(10):
        expected.append(time)
        time, speed = time + 2.0 * speed / 9.81, speed / (1.0 + mass)
        time += 2.0 * speed / pull
    answer = solve_scene(read(scene), [1.0, 1000.0], ("trajectory", "energy"))
    landed = [event.time for event in answer.events if event.kind == "touch"][:10]
    assert landed == pytest.approx(expected, rel=1e-12)
    assert column(answer, "b.position").values[-1, -1] == pytest.approx(0.0, abs=1e-9)


HARDLY = ["1e-300", "1e-100", "1e-50", "1e-40", "1e-30", "1e-29"]
"""Heights (m) above a floor that pairs of doubles do not tell from zero beside 1 m, or only just."""


def dragged(*bodies: str, at: list[list[Any]], restitution: float = 0, friction: float = 0) -> dict[str, Any]:
    """Return points above a floor that the air slows down: their motion is no polynomial."""
    floor = {"restitution": restitution} | ({"friction": friction} if friction else {})
    return {
        "gravity": [0, -9.81],
        "bodies": {name: {"mass": 1, "at": place, "velocity": [0, 0]} for name, place in zip(bodies, at, strict=True)},
        "connections": [
            one
            for name in bodies
            for one in (
                {"kind": "contact", "name": f"floor-{name}", "place": name, "on": {"at": [0, 0]}, **floor},
                {"kind": "force", "place": name, "force": ["-0.1*vx*speed", "-0.1*vy*speed"]},
            )
        ],
    }


@pytest.mark.parametrize("height", HARDLY)
@pytest.mark.parametrize("restitution", [0, 0.5, 1])
@pytest.mark.parametrize("friction", [0, 0.25])
@pytest.mark.parametrize("x", [1, 1000])
def test_what_hardly_hangs_above_a_floor_touches_it_at_once(
    height: str, restitution: float, friction: float, x: float
) -> None:
    """Drag is nothing in so short a fall."""
    scene = dragged("p", at=[[x, height]], restitution=restitution, friction=friction)
    answer = solve_scene(read(scene), [0.5, 1.0])
    assert kinds(answer)[0] == ("touch", "floor-p")
    assert abs(answer.events[0].time - sqrt(2 * mpf(height) / mpf("9.81"))) <= answer.events[0].error < 1e-12
    assert column(answer, "p.position").values[:, 1] == pytest.approx(0.0, abs=1e-25)


@pytest.mark.parametrize("height", HARDLY)
def test_it_came_from_the_floor_as_shortly_before(height: str) -> None:
    before, after = solve_scene(read(dragged("p", at=[[1, height]])), [-0.1, 1.0]).events
    short = sqrt(2 * mpf(height) / mpf("9.81"))
    assert abs(before.time + short) <= before.error < 1e-13
    assert abs(after.time - short) <= after.error < 1e-13


@pytest.mark.parametrize("height", HARDLY)
def test_what_is_thrown_down_from_there_bounces_as_from_the_floor(height: str) -> None:
    answers = []
    for at in (height, 0):
        scene = dragged("p", at=[[1, at]], restitution=0.5)
        scene["bodies"]["p"]["velocity"] = [1, -1]
        answers.append(solve_scene(read(scene), [0.05, 0.15]))
    above, on = answers
    assert abs(above.events[0].time - mpf(height)) <= above.events[0].error < 1e-27
    for one, other in zip(above.events[:4], on.events[:4], strict=True):
        assert one.impulses["normal"] == pytest.approx(other.impulses["normal"], rel=1e-14)
    assert column(above, "p.position").values == pytest.approx(column(on, "p.position").values, rel=1e-14)


@pytest.mark.parametrize("height", HARDLY)
def test_what_is_thrown_up_from_there_falls_back_once(height: str) -> None:
    scene = dragged("p", at=[[1, height]])
    scene["bodies"]["p"]["velocity"] = [0, 1]
    answer = solve_scene(read(scene), [1.0])
    assert kinds(answer) == [("touch", "floor-p")]
    # With quadratic drag: up in atan(k v)/(k g), down in arcosh(exp(k^2 g h))/(k g), k^2 = 0.1/9.81.
    k, g = sqrt(mpf("0.1") / mpf("9.81")), mpf("9.81")
    high = mp.log(1 + k**2) / (2 * k**2 * g)
    when = (mp.atan(k) + mp.acosh(mp.exp(k**2 * g * high))) / (k * g)
    assert answer.events[0].time == pytest.approx(float(when), rel=1e-14)


@pytest.mark.parametrize("heights", [["1e-100", "1e-100"], ["1e-100", 0], [0, "1e-30"], ["1e-40", "1e-30"]])
def test_each_of_two_does_so(heights: list[Any]) -> None:
    scene = dragged("p", "q", at=[[1, heights[0]], [2, heights[1]]])
    scene["connections"].append({"kind": "spring", "a": "p", "b": "q", "stiffness": 4, "rest_length": 0.5})
    answer = solve_scene(read(scene), [1.0])
    assert sorted(kinds(answer)) == [("touch", f"floor-{n}") for n, at in zip("pq", heights, strict=True) if at]
    for name in "pq":
        assert column(answer, f"{name}.position").values[0, 1] == pytest.approx(0.0, abs=1e-25)


@pytest.mark.parametrize("height", HARDLY)
def test_a_rod_that_swings_down_onto_a_floor_at_once_rests(height: str) -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [1, height]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}},
            {"kind": "rod", "a": "p", "b": [0, 0]},
        ],
    }
    answer = solve_scene(read(scene), [1.0])
    assert kinds(answer) == [("touch", "floor")]
    assert column(answer, "p.position").values[0] == pytest.approx([1.0, 0.0], abs=1e-25)

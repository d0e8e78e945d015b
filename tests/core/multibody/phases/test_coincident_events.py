"""What happens at one instant: impacts of several contacts, the end of bounces beside what is met just then."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read


def quarter(length: float, angle: float) -> float:
    """Return the time from rest at an angle to the lowest point (s): K(sin(angle/2)) sqrt(l/g)."""
    return float(mpmath.ellipk(mpmath.sin(mpmath.mpf(angle) / 2) ** 2) * mpmath.sqrt(mpmath.mpf(length) / 10))


@settings(max_examples=10)
@given(st.sampled_from([0, 0.5, 1]), st.integers(4, 30).map(lambda x: x / 10), st.integers(3, 30).map(lambda x: x / 10))
@example(0.5, 1, 0.6435011087932844)
@example(1, 2.5, 1.2)
@example(0, 0.4, 2.9)
def test_equal_pendulums_reach_their_walls_at_one_time(restitution: float, length: float, angle: float) -> None:
    """The spring between them keeps its length, so that each moves as a pendulum alone."""
    bodies = {
        name: {"mass": 1, "at": [f"{x} + {length}*sin({angle})", f"-{length}*cos({angle})"]}
        for name, x in (("a", 0), ("b", 5))
    }
    walls = [
        {
            "kind": "contact",
            "name": f"wall-{name}",
            "place": name,
            "on": {"at": [x, 0], "slope": {"degrees": -90}},
            "restitution": restitution,
        }
        for name, x in (("a", 0), ("b", 5))
    ]
    rods = [{"kind": "rod", "a": name, "b": [x, 0]} for name, x in (("a", 0), ("b", 5))]
    spring = {"kind": "spring", "a": "a", "b": "b", "stiffness": 3}
    first = quarter(length, angle)
    speed = math.sqrt(20 * length * (1 - math.cos(angle)))
    scene = {"gravity": [0, -10], "bodies": bodies, "connections": [*rods, spring, *walls]}
    answer = solve_scene(read(scene), [1.01 * first])
    assert answer.problem is None
    assert kinds(answer)[:2] == [("touch", "wall-a"), ("touch", "wall-b")]
    assert len(answer.events) == 2
    for event in answer.events:
        assert event.time == pytest.approx(first, rel=1e-12)
        assert event.impulses["normal"] == pytest.approx((1 + restitution) * speed, rel=1e-12)
    for name in "ab":
        velocity = np.linalg.norm(column(answer, f"{name}.velocity").values[0])
        assert velocity <= restitution * speed + 1e-9
        assert velocity > 0.9 * restitution * speed - 1e-9


def balls(restitution: float, drop: float, other: dict[str, Any], rebound: float) -> dict[str, Any]:
    """Return a ball that bounces to rest beside another one, which is part of the scene by a contact never reached."""
    return {
        "gravity": [0, -10],
        "bodies": {
            "a": {"mass": 1, "inertia": 1, "radius": 0.1, "at": [0, drop + 0.1]},
            "b": {"mass": 2, "inertia": 1, "radius": 0.1, **other},
        },
        "connections": [
            {"kind": "contact", "name": "a-floor", "place": "a", "on": {"at": [0, 0]}, "restitution": restitution},
            {"kind": "contact", "name": "b-floor", "place": "b", "on": {"at": [0, 0]}, "restitution": rebound},
            {"kind": "contact", "name": "pair", "a": "a", "b": "b"},
        ],
    }


@pytest.mark.parametrize(("restitution", "share"), [(0.5, 3), (0.2, 1.5), (0.25, 5 / 3), (0.75, 7)])
@pytest.mark.parametrize("rebound", [1, 0.8])
def test_a_ball_that_lands_when_the_bounces_of_another_end_bounces(
    restitution: float, share: float, rebound: float
) -> None:
    """Bounces end at T = sqrt(2h/g)(1 + e)/(1 - e), when what fell from g T^2/2 lands with the speed g T."""
    end = 0.5 * share
    other = {"at": [3, f"0.1 + 5*(0.5*(1 + {restitution})/(1 - {restitution}))^2"]}
    answer = solve_scene(read(balls(restitution, 1.25, other, rebound)), [end, 1.1 * end])
    landed = [event for event in answer.events if event.name == "b-floor"]
    settled = [event for event in answer.events if event.kind == "settle"]
    assert [event.name for event in settled] == ["a-floor"]
    assert abs(settled[0].time - end) <= settled[0].error + 2e-16 * end
    assert abs(landed[0].time - end) <= landed[0].error + 2e-16 * end
    assert landed[0].impulses["normal"] == pytest.approx(2 * (1 + rebound) * 10 * end, rel=1e-9)
    height = column(answer, "b.position")
    late = 0.1 * end
    assert abs(height.values[1, 1] - (0.1 + rebound * 10 * end * late - 5 * late**2)) <= height.error + 1e-14


@pytest.mark.parametrize(("restitution", "drop"), [(0.5, 1), (0.3, 2.5)])
def test_two_balls_that_come_to_rest_together_both_settle(restitution: float, drop: float) -> None:
    answer = solve_scene(read(balls(restitution, drop, {"at": [3, drop + 0.1]}, restitution)), [20.0])
    end = math.sqrt(drop / 5) * (1 + restitution) / (1 - restitution)
    settled = [event for event in answer.events if event.kind == "settle"]
    assert {event.name for event in settled} == {"a-floor", "b-floor"}
    for event in settled:
        assert abs(event.time - end) <= event.error + 2e-16 * end
        assert event.error < 1e-15
    assert answer.phases is not None
    assert answer.phases[-1].model == "rest"


@pytest.mark.parametrize("trial", range(6))
def test_a_string_becomes_taut_when_the_bounces_of_its_weight_end(trial: int) -> None:
    """The heavier weight of Atwood's machine lands at v with e = 1/2.

    Its bounces take 2 e v/(g (1 - e)) = 2 v/g, just as long as the other weight flies up and falls back to where the
    string is taut. The jerk leaves both at m v/(m + M), by an impulse M m v/(m + M).
    """
    random = np.random.default_rng(trial)
    light = round(float(random.uniform(1, 2)), 2)
    heavy = round(light * float(random.uniform(1.01, 3)), 2)
    height = round(float(random.uniform(0.1, 0.6)), 2)
    gain = 10 * (heavy - light) / (heavy + light)
    scene = {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": heavy, "at": [-0.5, 2]}, "b": {"mass": light, "at": [0.5, 2]}},
        "connections": [
            {"kind": "string", "name": "s", "through": ["a", [-0.5, 4], [0.5, 4], "b"]},
            {
                "kind": "contact",
                "name": "floor",
                "place": "a",
                "on": {"at": [0, f"2 - {height}"]},
                "restitution": 0.5,
            },
        ],
    }
    speed = math.sqrt(2 * gain * height)
    landed = speed / gain
    end = landed + 2 * speed / 10
    answer = solve_scene(read(scene), [end + 0.1 * speed / 10], accuracy=1e-8)
    taut = next(event for event in answer.events if event.kind == "taut")
    settle = next(event for event in answer.events if event.kind == "settle")
    assert (settle.time, taut.time) == (pytest.approx(end, rel=1e-12), pytest.approx(end, rel=1e-12))
    after = light * speed / (light + heavy)
    assert taut.impulses["normal"] == pytest.approx(heavy * after, rel=1e-9)
    late = 0.1 * speed / 10
    lifted = column(answer, "a.position")
    assert abs(lifted.values[0, 1] - (2 - height + after * late - gain * late**2 / 2)) <= lifted.error + 1e-12


@pytest.mark.parametrize(
    "between",
    [
        {},
        {"kind": "gravitation", "a": "a", "b": "b", "constant": 1},
        {"kind": "inverse-square", "a": "a", "b": "b", "strength": -1000},
        {"kind": "damper", "a": "a", "b": "b", "coefficient": 7},
    ],
)
@pytest.mark.parametrize(("speed", "radius"), [(2.0, 1.0), (1.0, 3.0)])
def test_stones_leave_equal_humps_at_once_with_a_rod_between_them(
    between: dict[str, Any], speed: float, radius: float
) -> None:
    """cos = (2 + v^2/(g r))/3; nothing along the rod has a part in that, nor in the flight that follows."""
    scene: dict[str, Any] = {
        "gravity": [0, -10],
        "bodies": {name: {"mass": 1, "at": [x, radius], "velocity": [speed, 0]} for name, x in (("a", 0), ("b", 5))},
        "connections": [
            {"kind": "rod", "a": "a", "b": "b"},
            *(
                {"kind": "contact", "name": f"hump-{name}", "place": name, "on": {"at": [x, 0], "radius": radius}}
                for name, x in (("a", 0), ("b", 5))
            ),
            *([between] if between else []),
        ],
    }
    with mpmath.workdps(30):
        last = mpmath.acos((2 + mpmath.mpf(speed) ** 2 / (10 * radius)) / 3)

        def rate_at(angle: Any) -> Any:
            return mpmath.sqrt(speed**2 / radius**2 + 20 / radius * (1 - mpmath.cos(angle)))

        lifted, rate = mpmath.quad(lambda angle: 1 / rate_at(angle), [0, last]), rate_at(last)
        late = mpmath.mpf("0.125")
        place = (
            radius * mpmath.sin(last) + radius * rate * mpmath.cos(last) * late,
            radius * mpmath.cos(last) - radius * rate * mpmath.sin(last) * late - 5 * late**2,
        )
    answer = solve_scene(read(scene), [float(lifted + late)])
    assert answer.problem is None
    assert kinds(answer) == [("lift-off", "hump-a"), ("lift-off", "hump-b")]
    for event in answer.events:
        assert event.time == pytest.approx(float(lifted), rel=1e-14)
    for name, x in (("a", 0), ("b", 5)):
        own = column(answer, f"{name}.position")
        assert own.values[0] == pytest.approx([x + float(place[0]), float(place[1])], abs=own.error + 1e-14)


@pytest.mark.parametrize("restitution", [0, 0.5])
@pytest.mark.parametrize(("heavy", "height"), [(1.0001, 0.2), (1.2, 0.5)])
def test_weights_that_jerk_and_land_in_turn_come_to_rest(restitution: float, heavy: float, height: float) -> None:
    """Each time the string jerks, speeds fall to r = m/(m + M): 2 v/g in flight, 2 r v/a until the next landing.

    They are at rest at sqrt(2h/a) + 2v/(g (1 - r)) + 2 r v/(a (1 - r)), and every later time is answered.
    """
    scene = {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 1, "at": [-0.5, 2]}, "b": {"mass": heavy, "at": [0.5, 2]}},
        "connections": [
            {"kind": "string", "name": "s", "through": ["a", [-0.5, 3], [0.5, 3], "b"]},
            {
                "kind": "contact",
                "name": "floor",
                "place": "b",
                "on": {"at": [0, f"2 - {height}"]},
                "restitution": restitution,
            },
        ],
    }
    gain, ratio = 10 * (heavy - 1) / (heavy + 1), 1 / (heavy + 1)
    speed = math.sqrt(2 * gain * height)
    end = speed / gain + 2 * speed / (10 * (1 - ratio)) + 2 * ratio * speed / (gain * (1 - ratio))
    answer = solve_scene(read(scene), [1.01 * end, 3 * end], accuracy=1e-8)
    assert answer.problem is None
    last = answer.events[-1]
    assert abs(last.time - end) <= last.error + 1e-9 * end
    for name, place in (("a", 2 + height), ("b", 2 - height)):
        own, rate = column(answer, f"{name}.position"), column(answer, f"{name}.velocity")
        assert np.abs(own.values[:, 1] - place).max() <= own.error
        assert np.abs(rate.values).max() <= rate.error < 1e-8 * speed
        assert rate.scale >= speed


@pytest.mark.parametrize(("rate", "stiffness"), [(1, 1), (2, 1), (3, 5)])
def test_two_blades_that_are_driven_share_one_clock(rate: int, stiffness: int) -> None:
    """Two points on a spring of no length meet their blades: x = 2.5 - 1.5 cos(w t) at the height 1, w^2 = 2 k/m."""
    bodies: dict[str, Any] = {}
    connections: list[dict[str, Any]] = []
    for name, x, sense in (("l", 0, 1), ("r", 5, -1)):
        blade = {"mass": 1, "inertia": 0.1, "at": [x, 0], "angular_velocity": sense * rate}
        bodies |= {f"blade-{name}": blade, name: {"mass": 1, "at": [x + sense, 1], "velocity": [0, 0]}}
        connections += [
            {"kind": "pin", "a": f"blade-{name}", "b": [x, 0]},
            {"kind": "motor", "name": f"motor-{name}", "a": f"blade-{name}", "rate": sense * rate},
            {"kind": "contact", "name": f"touch-{name}", "place": name, "on": {"at": f"blade-{name}"}},
        ]
    spring = {"kind": "spring", "a": "l", "b": "r", "stiffness": stiffness, "rest_length": 0}
    answer = solve_scene(read({"gravity": [0, 0], "bodies": bodies, "connections": [*connections, spring]}), [0.7])
    w = math.sqrt(2 * stiffness)

    def above(t: Any) -> Any:
        return mpmath.cos(rate * t) - mpmath.sin(rate * t) * (2.5 - 1.5 * mpmath.cos(w * t))

    time = float(mpmath.findroot(above, (0.05, 0.9), solver="anderson"))
    assert kinds(answer)[:2] == ([("touch", "touch-l"), ("touch", "touch-r")] if time < 0.7 else [])
    assert [event.time for event in answer.events[:2]] == pytest.approx([time, time][: len(answer.events)], rel=1e-13)


def jerked(across: int) -> dict[str, Any]:
    """Return a stone on a string that rebounds, pulled sideways by a spring, as many metres from the origin."""
    return {
        "gravity": [0, -9.81],
        "bodies": {"stone": {"mass": "1/2", "at": [f"{across} + 3/10", "-4/10"], "velocity": [-2, 0]}},
        "connections": [
            {"kind": "string", "name": "cord", "through": ["stone", [across, 0]], "length": 0.5, "restitution": 0.5},
            {"kind": "spring", "a": "stone", "b": [across - 5, 0], "stiffness": 1, "rest_length": 0},
        ],
    }


@pytest.mark.parametrize("across", [-7, 1000, 30_000])
def test_jerks_that_accumulate_end_when_they_do_wherever_the_origin_is(across: int) -> None:
    """They are alike in the limit only: how soon they may be summed up is a matter of how quickly forces change."""
    here, there = (solve_scene(read(jerked(x)), [0.3], accuracy=1e-6) for x in (0, across))
    assert kinds(here) == kinds(there)
    for one, other in zip(here.events, there.events, strict=True):
        assert one.time == pytest.approx(other.time, abs=one.error + other.error + 2.0**-53, rel=0)


def test_what_is_taut_stays_so_when_the_jerks_of_another_string_end() -> None:
    """The string that comes to rest last pulls at its own stone alone: the spring between them changes no tension."""
    scene = jerked(0)
    scene["bodies"]["other"] = {"mass": "1/2", "at": ["5 + 3/10", "-4/10"], "velocity": [-2, 0]}
    scene["connections"][1]["b"] = "other"
    cord = {"kind": "string", "name": "second", "through": ["other", [5, 0]], "length": 0.5, "restitution": 0.5}
    answer = solve_scene(read({**scene, "connections": [*scene["connections"], cord]}), [0.5])
    ended = [(event.kind, event.name) for event in answer.events if event.kind != "taut"]
    assert ended == [("settle", "second"), ("settle", "cord")]


def test_a_sample_among_jerks_that_are_passed_over_is_that_of_the_jerks() -> None:
    """The string keeps its length there, and its rate is below the last one that is listed."""
    events = solve_scene(read(jerked(0)), [0.3]).events
    last, settled = events[-2].time, events[-1].time
    inside = np.nextafter(last, 1) + np.array([0.2, 0.5, 0.9]) * (settled - last)
    answer = solve_scene(read(jerked(0)), [*inside, 0.3])
    place, rate = column(answer, "stone.position").values, column(answer, "stone.velocity").values
    outward = np.einsum("ij,ij->i", place, rate)[:3] / 0.5
    # What the fall of the tension of the spring and of the weight gains in so short a time, twice.
    assert np.all(np.abs(outward) <= 2 * 30 * (settled - last))


def test_bounces_at_one_end_of_a_bar_that_rests_on_the_other_come_to_rest() -> None:
    """Of two points on a light bar, which lie level when one hits, the other takes nothing of the impulse."""
    bar = {"mass": 2, "inertia": 2, "at": ["cos(1/20) - 1", "sin(1/20)"], "angle": "1/20"}
    bar |= {"places": {"l": [-1, 0], "r": [1, 0]}}
    ends = [
        {"kind": "contact", "name": name, "place": f"bar.{name}", "on": {"at": [0, 0]}, "restitution": 0.5}
        for name in "lr"
    ]
    found = solve_scene(read({"gravity": [0, -10], "bodies": {"bar": bar}, "connections": ends}), [0.0, 1.0])
    assert {(event.kind, event.name) for event in found.events} == {("touch", "r"), ("settle", "r")}
    assert found.ended is None
    assert found.phases is not None
    assert found.phases[-1].model == "rest"


def test_a_welded_pair_that_turns_lands_once() -> None:
    """Of the rows of a weld and of attitudes some follow from others, but only where all hold: one impact stops it."""
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "disc": {"mass": 0.5, "inertia": 0.01, "at": [0, 0], "velocity": [-3.52, 0], "angular_velocity": 1},
            "bar": {
                "mass": 0.5,
                "inertia": "1/24",
                "at": ["1/4", "-sqrt(3)/4"],
                "angle": "-acos(1/2)",
                "places": {"top": [-0.5, 0]},
            },
        },
        "connections": [
            {"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, "-0.6"]}},
            {"kind": "weld", "a": "bar.top", "b": "disc"},
        ],
    }
    answer = solve_scene(read(scene), [1])
    assert kinds(answer) == [("touch", "floor")]
    assert column(answer, "disc.position").values[-1][1] == pytest.approx(-0.6, abs=1e-12)


@pytest.mark.parametrize("spin", [(0, 0, 0), (1, 0, 0), (1, 2, -1)])
@pytest.mark.parametrize("turned_round", [False, True])
def test_a_welded_pair_lands_once_in_space(spin: tuple[int, int, int], turned_round: bool) -> None:
    """Taken as one rigid body: P = speed / (1/m + (r x n) J^-1 (r x n)), with the moments about the common centre.

    The masses are equal, so that each centre is half of the distance off.
    """
    apart = np.array([0.3, 0.2, 0.4])
    disc = {
        "mass": 0.5,
        "moments": [0.01, 0.02, 0.03],
        "at": [0, 0, 0],
        "velocity": [-1, 0.5, 0],
        "angular_velocity": list(spin),
        "places": {"c": [0, 0, 0]},
    }
    bar = {
        "mass": 0.5,
        "moments": [0.001, "1/24", "1/24"],
        "at": apart.tolist(),
        "velocity": (np.array([-1, 0.5, 0]) + np.cross(spin, apart)).tolist(),
        "angular_velocity": list(spin),
    }
    connections = [
        {"kind": "weld", "a": "bar", "b": "disc"},
        {"kind": "contact", "name": "floor", "place": "disc.c", "on": {"at": [0, 0, -0.6], "normal": [0, 0, 1]}},
    ]
    bodies = {"disc": disc, "bar": bar}
    scene = {
        "gravity": [0, 0, -10],
        "bodies": dict(reversed(bodies.items())) if turned_round else bodies,
        "connections": connections[::-1] if turned_round else connections,
    }
    answer = solve_scene(read(scene), [0.6])
    assert answer.problem is None
    landing = next(event for event in answer.events if event.kind == "touch")
    before = solve_scene(read(scene), [landing.time * (1 - 1e-13)])
    turn = Rotation.from_quat(column(before, "disc.attitude").values[0], scalar_first=True).as_matrix()
    speed = -column(before, "disc.velocity").values[0][2]
    if not any(spin):
        assert landing.time == pytest.approx(math.sqrt(0.12), rel=1e-12)
        assert speed == pytest.approx(math.sqrt(12), rel=1e-12)
    moments = np.diag([0.011, 0.02 + 1 / 24, 0.03 + 1 / 24]) + (apart @ apart * np.eye(3) - np.outer(apart, apart)) / 4
    along = turn.T @ np.cross(turn @ -apart / 2, [0, 0, 1])
    impulse = speed / (1 + along @ np.linalg.solve(moments, along))
    assert landing.impulses["normal"] == pytest.approx(impulse, rel=1e-11)


@pytest.mark.parametrize("friction", [None, 0.2])
@pytest.mark.parametrize("gravity", [10, 9.81])
@pytest.mark.parametrize("across", [0, 1000])
def test_a_string_ends_at_its_peg_as_the_other_weight_reaches_the_floor(
    friction: float | None, gravity: float, across: int
) -> None:
    """Atwood's machine of 2 kg and 0.5 kg gains 3 g/5: both are 1 m away at sqrt(10/(3 g))."""
    scene = {
        "gravity": [0, -gravity],
        "bodies": {"a": {"mass": 2, "at": [across, 1]}, "b": {"mass": 0.5, "at": [across + 1, 1]}},
        "connections": [
            {"kind": "string", "name": "s", "through": ["a", [across, 2], [across + 1, 2], "b"]},
            {"kind": "contact", "name": "f", "place": "a", "on": {"at": [0, 0]}, "friction": friction},
        ],
    }
    answer = solve_scene(read(scene), [0.7], ["trajectory"])
    assert answer.problem is None
    assert [(event.kind, event.name) for event in answer.events] == [("singular", "s")]
    assert answer.events[0].time == pytest.approx(math.sqrt(10 / (3 * gravity)), rel=1e-13)


@pytest.mark.parametrize("x", [0, 60, 300, 1000, -3000])
def test_bounces_end_where_it_is_not_known_whether_the_next_one_strikes(x: int) -> None:
    """A block bounces on a rough floor and is drawn aside by a spring that never bears what friction can hold.

    After each impact it has no slip, so that it rests where the bounces end, wherever the scene stands. Arcs become
    shorter by the restitution one half: as much time is left as the last of them took.
    """
    block = {"mass": 2, "at": [f"{x} + 1.7", 0.5]}
    weight, other = {"mass": 1, "at": [f"{x} + 2.5", 1]}, {"mass": 1, "at": [f"{x} + 2.9", 0.5]}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"block": block, "weight": weight, "other": other},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.3}
            | {"restitution": 0.5},
            {"kind": "string", "through": ["weight", [f"{x} + 2.5", 2], [f"{x} + 2.9", 2], "other"]},
            {"kind": "spring", "a": "block", "b": "weight", "stiffness": 5},
        ],
    }
    answer = solve_scene(read(scene), [1, 1.5])
    assert answer.problem is None
    assert [event.kind for event in answer.events][-2:] == ["touch", "settle"]
    *_, before, last, settled = answer.events
    assert abs(2.0 * last.time - before.time - settled.time) <= settled.error
    place = column(answer, "block.position")
    assert np.asarray(place.values)[0] == pytest.approx(np.asarray(place.values)[1], abs=place.error)
    assert np.asarray(place.values)[0] - [x, 0] == pytest.approx(
        [1.73096813790454, 0], abs=place.error + 2.0**-52 * abs(x) + 1e-14
    )


@pytest.mark.parametrize("time", [0.1, 0.3, 0.6, 0.7, 2.3, 0.045])
@pytest.mark.parametrize("later", [[], [5.0]])
def test_a_time_that_is_the_decimal_of_an_event_is_after_it(time: float, later: list[float]) -> None:
    """The doubles of 0.3, 0.6 and 2.3 are below the decimals: as the last time, they were before what happens then."""
    wall = {"kind": "contact", "name": "wall", "place": "a", "on": {"at": [0, 0], "normal": [1, 0]}, "restitution": 0.5}
    ball = {"mass": 1, "at": [time, 0], "velocity": [-1, 0]}
    answer = solve_scene(read({"gravity": [0, 0], "bodies": {"a": ball}, "connections": [wall]}), [time, *later])
    assert [(event.kind, event.time) for event in answer.events] == [("touch", time)]
    assert np.asarray(column(answer, "a.velocity").values)[0, 0] == 0.5

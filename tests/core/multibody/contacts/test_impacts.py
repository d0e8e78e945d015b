"""Impacts: restitution, friction, simultaneous ones and those that accumulate, against formulas and counts."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.multibody.motion.turning import FEW_RADIANS
from core.multibody.solve import solve_scene
from tests.core.multibody.relations import geometry
from tests.core.multibody.table.test_contact_geometry import kinds, states
from tests.core.multibody.worked_examples import column, read

BALL = """{"gravity":[0,-9.81],"bodies":{"ball":{"mass":1,"at":[0,1.25]}},"connections":[{"kind":"contact",
"name":"floor","place":"ball","on":{"at":[0,0]},"restitution":0.8}]}"""


def test_bounces_end_at_their_limit() -> None:
    """Rest at sqrt(2 h/g)(1 + e)/(1 - e); the way is h (1 + e^2)/(1 - e^2)."""
    answer = solve_scene(read(BALL), np.linspace(0, 5, 201), ("trajectory", "energy-in-time"))
    assert kinds(answer)[-1] == ("settle", "floor")
    settle = answer.events[-1]
    with mpmath.workdps(40):
        limit = 9 * mpmath.sqrt(mpmath.mpf("2.5") / mpmath.mpf("9.81"))
    # To the last bit: 4.54336899611537..., of which doubles are 9e-16 apart.
    assert settle.time == float(limit)
    assert abs(settle.time - limit) <= settle.error < 1e-15
    first = math.sqrt(2.5 / 9.81)
    for n, event in enumerate(answer.events[:-1]):
        assert event.time == pytest.approx(first * (1 + 2 * sum(0.8**k for k in range(1, n + 1))), rel=4e-16)
        assert event.energy_loss == pytest.approx(9.81 * 1.25 * 0.64**n * 0.36, rel=1e-14)
    heights = column(answer, "ball.position").values[:, 1]
    time = np.linspace(0, 5, 201)
    # Within the arcs that are not listed, too: arc n begins at t_n with the speed e^n v.
    for t, y in zip(time, heights, strict=True):
        if t <= first:
            expected = 1.25 - 9.81 * t * t / 2
        else:
            begin, speed = first, 0.8 * 9.81 * first
            while speed > 1e-9 and begin + 2 * speed / 9.81 < t:
                begin, speed = begin + 2 * speed / 9.81, 0.8 * speed
            late = t - begin
            expected = max(0.0, late * (speed - 9.81 * late / 2)) if speed > 1e-9 else 0.0
        assert y == pytest.approx(expected, abs=2e-14)
    assert states(answer)[-1] == {"floor": "closed"}
    assert answer.phases is not None
    assert answer.phases[-2].model == "accumulating bounces"
    assert answer.phases[-1].model == "rest"
    way = 1.25 + 2 * 1.25 * sum(0.64**n for n in range(1, 400))
    assert way == pytest.approx(41 / 7.2, rel=1e-14)


@pytest.mark.parametrize(("ratio", "count"), [(1, 3), (100, 31), (10_000, 314)])
def test_blocks_between_a_wall_and_a_heavy_block_count_the_digits_of_pi(ratio: int, count: int) -> None:
    """ceil(pi/atan sqrt(m/M)) - 1 elastic impacts (G. Galperin, 2003)."""
    scene = {
        "bodies": {
            "light": {"mass": 1, "inertia": 1, "radius": 0.1, "at": [1, 0]},
            "heavy": {"mass": ratio, "inertia": 1, "radius": 0.1, "at": [2, 0], "velocity": [-1, 0]},
        },
        "connections": [
            {
                "kind": "contact",
                "name": "wall",
                "place": "light",
                "on": {"at": [0, 0], "slope": {"degrees": -90}},
                "restitution": 1,
            },
            {"kind": "contact", "name": "pair", "a": "heavy", "b": "light", "restitution": 1},
        ],
    }
    answer = solve_scene(read(scene), [1000.0], ("trajectory", "energy-in-time"))
    assert len(answer.events) == count == math.ceil(math.pi / math.atan(math.sqrt(1 / ratio))) - 1
    assert {event.kind for event in answer.events} == {"touch"}
    assert sum(event.energy_loss for event in answer.events) == 0.0
    assert column(answer, "energy.kinetic").values[0] == pytest.approx(ratio / 2, rel=1e-14)


def test_spinning_ball_bounces_off_a_rough_floor() -> None:
    """Garwin's bounce with e = 1: friction (1 + e) mu m v while it slips, else until the contact point rests."""

    def thrown(friction: float, spin: float) -> Any:
        scene = {
            "gravity": [0, -9.81],
            "bodies": {
                "ball": {
                    "mass": 1,
                    "inertia": "2/5*0.01",
                    "radius": 0.1,
                    "at": [0, 0.6],
                    "velocity": [1, 0],
                    "angular_velocity": spin,
                }
            },
            "connections": [
                {
                    "kind": "contact",
                    "name": "floor",
                    "place": "ball",
                    "on": {"at": [0, 0]},
                    "friction": friction,
                    "restitution": 0.7,
                }
            ],
        }
        return solve_scene(read(scene), [0.4])

    down = math.sqrt(2 * 9.81 * 0.5)
    slips = thrown(0.1, 40)
    assert slips.events[0].impulses["normal"] == pytest.approx(1.7 * down, rel=1e-14)
    assert slips.events[0].impulses["friction"] == pytest.approx(-0.1 * 1.7 * down, rel=1e-14)
    assert column(slips, "ball.velocity").values[0, 0] == pytest.approx(1 - 0.17 * down, rel=1e-14)
    sticks = thrown(0.9, 10)
    # (1 + R w) over 1/m + R^2/I = 7/2
    assert sticks.events[0].impulses["friction"] == pytest.approx(-2 / 3.5, rel=1e-14)
    assert column(sticks, "ball.velocity").values[0, 0] == pytest.approx(1 - 2 / 3.5, rel=1e-14)


def test_two_balls_exchange_their_velocities() -> None:
    scene = {
        "bodies": {
            "a": {"mass": 1, "inertia": 1, "radius": 0.1, "at": [0, 0], "velocity": [1, 0]},
            "b": {"mass": 1, "inertia": 1, "radius": 0.1, "at": [1.2, 0], "velocity": [0, 0]},
        },
        "connections": [{"kind": "contact", "name": "pair", "a": "a", "b": "b", "restitution": 1}],
    }
    answer = solve_scene(read(scene), [2.0])
    assert kinds(answer) == [("touch", "pair")]
    assert answer.events[0].time == 1.0
    assert column(answer, "b.velocity").values.tolist() == [[1.0, 0.0]]
    assert column(answer, "a.velocity").values.tolist() == [[0.0, 0.0]]


def cradle(**orders: int) -> dict[str, Any]:
    return {
        "bodies": {
            name: {"mass": 1, "inertia": 1, "radius": 0.1, "at": [x, 0], "velocity": [v, 0]}
            for name, x, v in (("a", -1, 1), ("b", 0, 0), ("c", 0.2, 0))
        },
        "connections": [
            {"kind": "contact", "name": name, "a": name[0], "b": name[1], "restitution": 1, **_order(orders, name)}
            for name in ("ab", "bc")
        ],
    }


def _order(orders: dict[str, int], name: str) -> dict[str, int]:
    return {"order": orders[name]} if name in orders else {}


def test_three_balls_of_a_cradle_are_undecided_unless_ordered() -> None:
    """Together, the first would go back with a third of its velocity; one after another, the last takes all."""
    answer = solve_scene(read(cradle()), [2.0])
    assert answer.problem is not None
    assert answer.problem.code == "simultaneous-impacts"
    assert {one["order"] for one in answer.problem.candidates} == {"together", "ab then bc"}
    assert answer.trajectory is not None
    assert len(answer.trajectory.rows) == 0
    ordered = solve_scene(read(cradle(ab=1, bc=2)), [2.0], ("trajectory", "energy-in-time"))
    assert ordered.problem is None
    for name, v in (("a", 0.0), ("b", 0.0), ("c", 1.0)):
        assert column(ordered, f"{name}.velocity").values.tolist() == [[v, 0.0]]


def test_dumbbell_dropped_flat_rebounds_flat() -> None:
    """Two equal points on a massless rod do not notice one another: the inertia m l^2 decouples the two ends."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "dumbbell": {"mass": 2, "inertia": 2, "at": [0, 1], "places": {"l": [-1, 0], "r": [1, 0]}},
        },
        "connections": [
            {"kind": "contact", "name": k, "place": f"dumbbell.{k}", "on": {"at": [0, 0]}, "restitution": 0.5}
            for k in ("l", "r")
        ],
    }
    answer = solve_scene(read(scene), [0.6])
    assert answer.problem is None
    assert kinds(answer) == [("touch", "l"), ("touch", "r")]
    down = math.sqrt(2 * 9.81)
    late = 0.6 - down / 9.81
    assert column(answer, "dumbbell.velocity").values[0, 1] == pytest.approx(0.5 * down - 9.81 * late, rel=1e-13)
    # A uniform rod is another thing: the one end's impulse moves the other.
    scene["bodies"]["dumbbell"]["inertia"] = "2/3"  # type: ignore[index]
    undecided = solve_scene(read(scene), [0.6])
    assert undecided.problem is not None
    assert undecided.problem.code == "simultaneous-impacts"


def test_ball_hits_a_stick_that_lies_on_ice() -> None:
    """A point hits a free rod at the end: m v = m v' + p, p = M V, p a = I w, (V + a w - v') = e v."""
    scene = {
        "bodies": {
            "ball": {"mass": 1, "inertia": 0.1, "radius": 0.1, "at": [-1, 0.9], "velocity": [2, 0]},
            "stick": {
                "mass": 3,
                "inertia": 1,
                "at": [0, 0],
                "angle": {"degrees": 90},
            },
        },
        "connections": [
            {
                "kind": "contact",
                "name": "hit",
                "place": "ball",
                "on": {"at": "stick", "slope": 0},
                "restitution": 0.5,
            }
        ],
    }
    answer = solve_scene(read(scene), [0.5], ("trajectory", "energy-in-time"))
    push = 1.5 * 2 / (1 / 1 + 1 / 3 + 0.9**2 / 1)
    (event,) = answer.events
    assert event.time == pytest.approx(0.45, rel=1e-15)
    assert event.impulses["normal"] == pytest.approx(push, rel=1e-14)
    assert column(answer, "stick.angular_velocity").values[0] == pytest.approx(-push * 0.9, rel=1e-14)
    assert event.energy_loss == pytest.approx(2 - 2 + push * 2 - push**2 / 2 * (1 + 1 / 3 + 0.81), rel=1e-13)


def box(angle: float, spin: float, *, ordered: bool) -> dict[str, Any]:
    places = {"l": [-0.3, -0.2], "r": [0.3, -0.2]}
    law = {"restitution": 0.3, "friction": 0.4}
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "box": {
                "mass": 1,
                "inertia": 0.05,
                "at": [0, 1],
                "angle": angle,
                "angular_velocity": spin,
                "places": places,
            }
        },
        "connections": [
            {"kind": "contact", "name": name, "place": f"box.{name}", "on": {"at": [0, 0]}, **law}
            | ({"order": i} if ordered else {})
            for i, name in enumerate(places)
        ],
    }


def test_a_dropped_box_bounces_on_its_corners_in_turn_until_it_rests() -> None:
    """The bounces of both corners end together; then the box slides to rest at mu g, flat on the floor."""
    answer = solve_scene(read(box(0.2, 1.0, ordered=True)), np.linspace(0, 3, 7), ("trajectory", "energy-in-time"))
    assert answer.ended is None
    assert states(answer)[-1] == {"l": "stick", "r": "stick"}
    found = column(answer, "box.position")
    assert found.values[-1, 1] == pytest.approx(0.2, abs=found.error)
    assert found.error < 1e-9
    assert column(answer, "box.angle").values[-1] == pytest.approx(0.0, abs=column(answer, "box.angle").error)
    # What the impacts take is what was there, but for the friction of sliding.
    assert 7.8 < sum(event.energy_loss for event in answer.events) < 9.81 * 0.8 + 0.025


def test_undecided_candidates_say_nothing_of_rounding() -> None:
    answer = solve_scene(read(box(0.3, 0.0, ordered=False)), [0.5, 3.0])
    assert answer.problem is not None
    assert answer.problem.code == "simultaneous-impacts"
    words = {candidate[name] for candidate in answer.problem.candidates for name in ("l", "r")}
    assert "stays closed" in words
    assert not any("e-" in word for word in words)


def test_where_everything_stops_candidates_say_nothing_of_rounding_either() -> None:
    # Boxes meet with level faces; where both corners act together nothing moves on. A guide beside them rounds places.
    box = {"mass": 1, "shape": {"kind": "box", "width": 0.4, "height": 0.2}}
    scene = {
        "bodies": {
            "first": {**box, "at": [-0.5, 0], "velocity": [1, 0]},
            "second": {**box, "at": [0.2, 0], "velocity": [-1, 0]},
        },
        "connections": [
            {"kind": "contact", "name": "meet", "a": "first", "b": "second"},
            {"kind": "damper", "name": "d", "a": "first", "b": [-3, 0], "coefficient": 0.1},
        ],
    }
    answer = solve_scene(read(scene), [0.5])
    assert answer.problem is not None
    together = next(one for one in answer.problem.candidates if one["order"] == "together")
    assert {value for name, value in together.items() if name != "order"} == {"stays closed"}


def test_more_events_than_are_followed_end_the_answer_and_lose_nothing() -> None:
    """An elastic ball bounces every 2 sqrt(2 h/g) s for ever: 500 impacts are followed, and what they say is kept."""
    scene = json.loads(BALL)
    scene["connections"][0]["restitution"] = 1
    answer = solve_scene(read(scene), [0.0, 1.0, 400.0, 1000.0])
    assert answer.problem is not None
    assert answer.problem.code == "event-limit"
    assert answer.ended is not None
    assert answer.ended.time == pytest.approx((2 * 500 + 1) * math.sqrt(2.5 / 9.81), rel=1e-13)
    assert answer.trajectory is not None
    assert answer.trajectory.rows.tolist() == [0, 1, 2]
    with mpmath.workdps(40):
        fall = mpmath.sqrt(mpmath.mpf("2.5") / mpmath.mpf("9.81"))
        late = (400 + fall) % (2 * fall)
        height = mpmath.mpf("9.81") * late * (2 * fall - late) / 2
    found = column(answer, "ball.position")
    assert abs(found.values[2, 1] - float(height)) <= found.error


def test_an_impact_goes_through_a_row_of_equal_balls() -> None:
    """Equal balls exchange their velocities: one moves at a time, over one gap after another."""
    count, gap = 30, 0.0001
    names = [f"b{i:02}" for i in range(count)]
    scene = {
        "bodies": {
            name: {
                "mass": 2,
                "inertia": 1,
                "radius": 0.01,
                "at": [f"{i}*(0.02 + {gap})", 0],
                "velocity": [3 * (i == 0), 0],
            }
            for i, name in enumerate(names)
        },
        "connections": [
            {"kind": "contact", "name": f"{a}-{b}", "a": a, "b": b, "restitution": 1} for a, b in pairwise(names)
        ],
    }
    answer = solve_scene(read(scene), [0.0, 1.0])
    assert [event.name for event in answer.events] == [f"{a}-{b}" for a, b in pairwise(names)]
    for i, event in enumerate(answer.events, 1):
        assert abs(event.time - float(Fraction(i, 30000))) <= event.error + 2**-53 * event.time
        assert event.impulses["normal"] == 6.0
    for name in names[:-1]:
        assert column(answer, f"{name}.velocity").values[-1].tolist() == [0.0, 0.0]
    assert column(answer, f"{names[-1]}.velocity").values[-1].tolist() == [3.0, 0.0]


def test_a_mass_on_a_spring_bounces_off_a_stop_at_equal_times() -> None:
    """x = a cos(wt) from a = 0.5 m to the stop at -0.2 m, and back: w t = (2n - 1) arccos(-0.4)."""
    scene = {
        "bodies": {"m": {"mass": 2, "at": ["0.5", 0]}},
        "connections": [
            {"kind": "slider", "a": "m", "b": [0, 0], "slope": 0},
            {"kind": "spring", "a": "m", "b": [0, 0], "stiffness": 50, "rest_length": 0},
            {
                "kind": "contact",
                "name": "stop",
                "place": "m",
                "on": {"at": ["-0.2", 0], "slope": {"degrees": -90}},
                "restitution": 1,
            },
        ],
    }
    answer = solve_scene(read(scene), [0.0, 15.0])
    assert len(answer.events) == 19
    with mpmath.workdps(30):
        half = mpmath.acos(mpmath.mpf(-2) / 5) / 5
        for n, event in enumerate(answer.events, 1):
            assert abs(event.time - (2 * n - 1) * half) <= event.error < 1e-14


def test_a_rod_lands_after_many_turns() -> None:
    """Its lower end is at h - 0.3 |sin(40 t)| - g t^2/2: the first zero comes after 127 radians."""
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "rod": {
                "mass": 1,
                "inertia": "0.03",
                "at": [0, 51],
                "angle": 0,
                "angular_velocity": 40,
                "places": {"left": ["-0.3", 0], "right": ["0.3", 0]},
            }
        },
        "connections": [
            {"kind": "contact", "name": end, "place": f"rod.{end}", "on": {"at": [0, 0]}, "restitution": 0}
            for end in ("left", "right")
        ],
    }
    answer = solve_scene(read(scene), [3.0])
    assert not answer.events
    answer = solve_scene(read(scene), [0.0, 3.2])
    with mpmath.workdps(30):
        times = np.linspace(3.0, 3.2, 20001)
        first = next(t for t in times if 51 - 0.3 * abs(np.sin(40 * t)) < 5 * t * t)
        end = "left" if np.sin(40 * first) > 0 else "right"
        sign = 1 if end == "left" else -1
        root = mpmath.findroot(lambda t: 51 - sign * mpmath.sin(40 * t) * 3 / 10 - 5 * t * t, first)
        event = answer.events[0]
        assert event.name == end
        assert 40 * root > FEW_RADIANS
        assert abs(event.time - root) <= event.error < 1e-14


@settings(max_examples=10)
@given(
    st.sampled_from([2, -0.7, 5]),
    st.sampled_from([0, 0.4, 1]),
    st.integers(1, 20).map(lambda x: x / 10),
    st.integers(1, 15).map(lambda x: x / 10),
)
@example(2, 0.4, 1.118033988749895, 0.4636476090008061)
@example(-0.7, 0, 0.3, 1.1)
def test_what_a_motor_strikes_takes_the_work_of_the_motor(
    rate: float, restitution: float, along: float, angle: float
) -> None:
    """A mass m at rest at the distance r leaves at (1 + e) r w, by an impulse m times that, as the rate is held."""
    side = 1 if rate > 0 else -1
    scene = {
        "bodies": {
            "paddle": {"mass": 1, "inertia": 0.1, "at": [0, 0], "angular_velocity": rate},
            "m": {
                "mass": 3,
                "at": [f"{along}*cos({angle})", f"{side * along}*sin({angle})"],
                "velocity": [0, 0],
            },
        },
        "connections": [
            {"kind": "pin", "a": "paddle", "b": [0, 0]},
            {"kind": "motor", "a": "paddle", "rate": rate},
            {
                "kind": "contact",
                "name": "face",
                "place": "m",
                "on": {"at": "paddle", "slope": {"degrees": 0 if rate > 0 else 180}},
                "restitution": restitution,
            },
        ],
    }
    answer = solve_scene(read(scene), [1.001 * angle / abs(rate)], ("trajectory", "energy-in-time"))
    (touch, *_) = answer.events
    speed = (1 + restitution) * abs(rate) * along
    assert touch.kind == "touch"
    assert touch.time == pytest.approx(angle / abs(rate), rel=1e-12)
    assert touch.impulses["normal"] == pytest.approx(3 * speed, rel=1e-12)
    # The contact takes its impulse times the mean of the closing rate before and after.
    lost = 3 * speed * (1 - restitution) * abs(rate) * along / 2
    assert touch.energy_loss == pytest.approx(lost, rel=1e-12, abs=1e-15)
    if restitution > 0:
        assert math.hypot(*column(answer, "m.velocity").values[0]) == pytest.approx(speed, rel=1e-12)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("places", "restitution"), [((-0.5, 0.5), 0.5), ((-0.2, 0.6), 0), ((-0.5, 0.1, 0.7), 0.3)])
def test_contacts_of_equal_order_act_together(turned: bool, places: tuple[float, ...], restitution: float) -> None:
    """A beam that falls flat on several places bounces flat, whatever comes first in the list."""
    floor = [
        {
            "kind": "contact",
            "name": f"c{i}",
            "place": f"beam.p{i}",
            "on": {"at": [0, 0]},
            "restitution": restitution,
            "order": 1,
        }
        for i in range(len(places))
    ]
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "beam": {
                "mass": 1,
                "inertia": 0.05,
                "at": [0, 1.25],
                "places": {f"p{i}": [x, 0] for i, x in enumerate(places)},
            }
        },
        "connections": floor[::-1] if turned else floor,
    }
    answer = solve_scene(read(scene), [0.5, 0.55])
    assert answer.problem is None
    assert sum(event.impulses["normal"] for event in answer.events[: len(places)] if event.time < 0.51) == (
        pytest.approx(5 * (1 + restitution))
    )
    # Three places on one body share an impulse in many ways, two in one.
    known = [event.errors.impulses["normal"] is not None for event in answer.events if event.impulses]
    assert known == [len(places) == 2] * len(known)
    assert column(answer, "beam.angle").values == pytest.approx(0, abs=1e-14)
    late = 0.05
    expected = max(0.0, 5 * restitution * late - 5 * late**2)
    assert column(answer, "beam.position").values[1, 1] == pytest.approx(expected, abs=1e-12)


def test_more_impacts_than_orders_are_tried_for_differ_or_are_refused_with_their_names() -> None:
    """Of two orders with different outcomes both are candidates, also where there are too many to try them all."""
    scene = {
        "gravity": [0, -10],
        "bodies": {"bar": {"mass": 2, "inertia": 1, "at": [0, 1], "places": {f"p{k}": [k - 2, 0] for k in range(5)}}},
        "connections": [
            {"kind": "contact", "name": f"c{k}", "place": f"bar.p{k}", "on": {"at": [0, 0]}, "restitution": 0.5}
            for k in range(5)
        ],
    }
    answer = solve_scene(read(scene), [1])
    assert answer.problem is not None
    assert answer.problem.code == "simultaneous-impacts"
    assert len(answer.problem.candidates) > 1


@pytest.mark.parametrize("speed", ["3", "pi"])
def test_impacts_in_an_order_that_end_as_a_limit_leave_nothing_for_another_one(speed: str) -> None:
    """Three equal plastic balls share the momentum of the first, a third of its speed each, after one impact each."""
    bodies = {
        f"b{i}": {"mass": 1, "radius": 0.1, "inertia": 0.01, "at": [x, 0], "velocity": [0 if i else speed, 0]}
        | {"angular_velocity": 0}
        for i, x in enumerate(("-0.2", "0.2", "0.4"))
    }
    pairs = [
        {"kind": "contact", "name": f"p{i}", "a": f"b{i}", "b": f"b{i + 1}", "restitution": 0, "order": i + 1}
        for i in range(2)
    ]
    answer = solve_scene(read({"gravity": [0, 0], "bodies": bodies, "connections": pairs}), [0.3], ("trajectory",))
    assert kinds(answer) == [("touch", "p0"), ("touch", "p1")]
    first = math.pi if speed == "pi" else 3.0
    assert [event.impulses["normal"] for event in answer.events] == pytest.approx([2 * first / 3, first / 3], rel=1e-15)
    for i in range(3):
        assert column(answer, f"b{i}.velocity").values[0] == pytest.approx([first / 3, 0], rel=1e-14)


def test_bounces_that_stick_at_every_impact_go_as_far_as_the_sum_of_their_arcs() -> None:
    """Gravity along the floor moves a particle by a d^2/2 in an arc of d = 2 w e^n/g; impacts take the rate."""
    floor = {"kind": "contact", "name": "floor", "place": "m", "on": {"at": [0, 0]}, "restitution": "1/2"}
    body = {"mass": 1, "at": [0, 0], "velocity": [0, 1]}
    scene = {"gravity": [3, -10], "bodies": {"m": body}, "connections": [floor | {"friction": 5}]}
    answer = solve_scene(read(scene), [0.5], ("trajectory",))
    # w = 1, so that d = 1/5, and 3/2 (1/5)^2/(1 - 1/4) = 2/25.
    for name, exact in (("m.position", [0.08, 0.0]), ("m.velocity", [0.0, 0.0])):
        found = column(answer, name)
        assert np.abs(found.values[0] - exact).max() <= found.error + 1e-16
    assert answer.events[-1].name == "floor"
    assert abs(answer.events[-1].time - 0.4) <= answer.events[-1].error + 1e-16


def test_how_contacts_of_one_body_share_friction_says_nothing_of_the_order_of_impacts() -> None:
    """A box rests on one corner as another lands: both rub along one line, which depends on itself however it lies."""
    corners = {"a": [-0.335, -0.591], "b": [0.335, -0.591], "c": [0.335, 0.591], "d": [-0.335, 0.591]}
    rubs = {"a": [1.0165, 0.8132], "b": 0.1569, "c": 0.6703, "d": [0.704625, 0.5637]}
    bounces = {"a": 0.2078, "b": 0.5076, "c": 0.7081, "d": 0.7452}
    box = {
        "mass": 1.23, "inertia": 0.1892, "at": [0, 1.303], "angle": 0.4976, "velocity": [-0.5996, -1.947],
        "angular_velocity": 1.435, "places": corners,
    }  # fmt: skip
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"box": box},
        "connections": [
            {
                "kind": "contact",
                "name": k,
                "place": f"box.{k}",
                "on": {"at": [0, 0], "slope": 0.0},
                "restitution": bounces[k],
                "friction": rubs[k],
            }
            for k in corners
        ],
        "times": [1.0],
    }
    told = []
    for sides in (None, (3, 4, 5), (5, 12, 13)):
        turned = scene if sides is None else geometry.turned(scene, sides=sides).request
        problem = solve_scene(read({key: x for key, x in turned.items() if key != "times"}), [1.0]).problem
        assert problem is not None
        assert problem.code == "simultaneous-impacts"
        told.append(problem.candidates)
    assert told[0] == told[1] == told[2]


@pytest.mark.parametrize("sides", [(3, 4, 5), (5, 12, 13), (8, 15, 17)])
def test_what_has_landed_flat_has_no_spin_to_the_last_digit(sides: tuple[int, int, int]) -> None:
    places = {"l": [-0.5, -0.2], "r": [0.5, -0.2]}
    feet = [{"kind": "contact", "name": k, "place": f"p.{k}", "on": {"at": [0, 0]}, "order": 1} for k in places]
    body = {"mass": 1, "inertia": 0.1, "at": [0, 0.7], "places": places}
    scene = {"gravity": [0, -10], "bodies": {"p": body}, "connections": feet, "times": [0.2, 0.5]}
    turned = geometry.turned(scene, sides=sides).request
    answer = solve_scene(read({key: x for key, x in turned.items() if key != "times"}), [0.5])
    spin = column(answer, "p.angular_velocity")
    assert np.abs(spin.values).max() <= spin.error


@pytest.mark.parametrize("friction", [0, 0.3])
@pytest.mark.parametrize(("count", "along", "slope"), [(5, ("0", "1"), "0"), (6, ("3/5", "4/5"), "atan(4/3) - pi/2")])
def test_a_stack_that_lands_without_bouncing_stops(
    count: int, along: tuple[str, str], slope: str, friction: float
) -> None:
    """Each impulse closes the gaps beside it, so that every order of them ends with all discs at rest.

    Their rates in between are without end; what is answered is the sum of the momenta below each gap.
    """
    x, y = along
    bodies = {
        f"d{i}": {
            "mass": i + 1,
            "inertia": 1,
            "radius": 1,
            "at": [f"{1 + 2 * i}*{x}", f"{1 + 2 * i}*{y}"],
            "velocity": [f"-3*{x}", f"-3*{y}"],
        }
        for i in range(count)
    }
    contacts: list[dict[str, Any]] = [
        {"kind": "contact", "name": "c0", "place": "d0", "on": {"at": [0, 0], "slope": slope}}
    ]
    contacts += [{"kind": "contact", "name": f"c{i}", "a": f"d{i - 1}", "b": f"d{i}"} for i in range(1, count)]
    if friction:
        contacts = [{**one, "friction": friction} for one in contacts]
    answer = solve_scene(read({"gravity": [0, 0], "bodies": bodies, "connections": contacts[::-1]}), [1.0])
    assert answer.problem is None
    assert {event.name for event in answer.events} == {one["name"] for one in contacts}
    for event in answer.events:
        above = sum(range(int(event.name[1:]) + 1, count + 1))
        assert event.impulses["normal"] == pytest.approx(3 * above, rel=1e-12)
    assert np.abs(column(answer, "d0.velocity").values).max() < 1e-12


@pytest.mark.parametrize("spin", [0, 3])
def test_the_energy_that_an_impact_takes_is_its_impulses_times_the_means_of_its_rates(spin: float) -> None:
    """W. Thomson, P. G. Tait, "Treatise on Natural Philosophy" (1867), section 309."""
    ball = {"mass": 1, "shape": {"kind": "ball", "radius": 0.1}, "at": [0, 0, 0.55], "velocity": [1, 0.5, 0]}
    ball["angular_velocity"] = [0, spin, 1]
    floor = {"kind": "contact", "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.1}
    scene = {"gravity": [0, 0, -10], "bodies": {"ball": ball}, "connections": [floor | {"restitution": 0.5}]}
    event = solve_scene(read(scene), [0.4]).events[0]
    assert (event.rates["normal"].before, event.rates["normal"].after) == pytest.approx((-3, 1.5), rel=1e-14)
    assert event.rates["friction.x"].before == pytest.approx(1 - 0.1 * spin, rel=1e-14)
    work = sum(
        impulse * (event.rates[name].before + event.rates[name].after) / 2 for name, impulse in event.impulses.items()
    )
    assert event.energy_loss == pytest.approx(-work, rel=1e-14)


@pytest.mark.parametrize("aside", ["-3", "2"])
def test_bounces_of_which_the_slip_turns_are_not_summed_up_as_if_it_were_straight(aside: str) -> None:
    """A point bounces on a rough floor in space, drawn beside its slip: each impulse of friction has its own direction.

    Arc by arc in eighty digits: the impulse of friction is 0.3 times that of the floor, against the slip before it.
    """
    with mpmath.workdps(80):
        gain, place, rate = mpmath.mpf(aside), mpmath.matrix(2, 1), mpmath.matrix([2, 1])
        time = arc = mpmath.sqrt(mpmath.mpf("0.16"))
        up = -10 * arc
        for _ in range(300):
            place += arc * rate + mpmath.matrix([0, gain * arc**2 / 2])
            rate[1] += gain * arc
            rate -= mpmath.mpf("0.45") * -up / mpmath.norm(rate) * rate
            arc = -up / 10
            time, up = time + arc, up / 2
        settles, right = float(time), [np.array([float(x) for x in vector]) for vector in (place, rate)]
    scene = {
        "gravity": [0, aside, -10],
        "bodies": {"p": {"mass": 1, "at": [0, 0, "0.8"], "velocity": [2, 1, 0]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
            | {"restitution": 0.5, "friction": 0.3}
        ],
    }
    answer = solve_scene(read(scene), [settles, 1.3])
    assert [event.kind for event in answer.events][-1] == "settle"
    for name, value in zip(("p.position", "p.velocity"), right, strict=True):
        own = column(answer, name)
        assert np.abs(own.values[0][:2] - value).max() <= own.error + 4e-16

"""Friction: sticking, sliding, rolling, and what friction leaves undecided, against textbook formulas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds, states
from tests.core.multibody.worked_examples import column, force, linear, read


def disc(inertia: Any, friction: Any, **body: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"disc": {"mass": 1, "inertia": inertia, "radius": 0.1, "at": [0, 0.1], **body}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, 0]}, "friction": friction}
        ],
    }


def block(slope: Any, friction: Any, **body: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"block": {"mass": 2, "at": [0, 0], **body}},
        "connections": [
            {"kind": "contact", "name": "slope", "place": "block", "on": {"at": [0, 0], "slope": slope}, **friction}
        ],
    }


def chalk(**body: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "chalk": {
                "mass": 1,
                "inertia": 0.3333,
                "at": [0.5, 0.8660254037844386],
                "angle": {"degrees": 60},
                "velocity": [-3, 0],
                "places": {"foot": [-1, 0]},
                **body,
            }
        },
        "connections": [
            {"kind": "contact", "name": "board", "place": "chalk.foot", "on": {"at": [0, 0]}, "friction": 2}
        ],
    }


@pytest.mark.parametrize(
    ("inertia", "friction", "speed", "time", "share"),
    [
        (0.005, 0.2, 3, 0.509683995922528, 2 / 3),
        ("2*0.01/5", 0.25, 5, 0.58249599534003201, 5 / 7),
    ],
)
def test_what_slips_comes_to_roll(inertia: Any, friction: float, speed: float, time: float, share: float) -> None:
    """From v/(mu g (1 + m R^2/I)): the friction changes v and R omega until they agree."""
    answer = solve_scene(read(disc(inertia, friction, velocity=[speed, 0])), [0.1, 2.0])
    assert kinds(answer) == [("roll", "floor")]
    assert abs(answer.events[0].time - time) <= answer.events[0].error < 2e-16
    assert states(answer) == [{"floor": "slide"}, {"floor": "stick"}]
    velocity = column(answer, "disc.velocity").values
    assert velocity[0, 0] == pytest.approx(speed - friction * 9.81 * 0.1, rel=1e-15)
    assert velocity[1, 0] == pytest.approx(share * speed, rel=1e-15)
    assert column(answer, "disc.angular_velocity").values[1] == pytest.approx(-share * speed / 0.1, rel=1e-15)
    assert answer.phases is not None
    assert {phase.model for phase in answer.phases} == {"constant acceleration"}


def test_backspin_returns() -> None:
    """Thrown forward with backspin beyond R w = 2 v, a disc of I = m R^2/2 comes back, at (2 v - R w)/3."""
    answer = solve_scene(read(disc(0.005, 0.2, velocity=[1, 0], angular_velocity=50)), [3.0])
    assert kinds(answer) == [("roll", "floor")]
    assert answer.events[0].time == pytest.approx((1 + 5) / (3 * 0.2 * 9.81), rel=1e-15)
    assert column(answer, "disc.velocity").values[0, 0] == pytest.approx((2 - 5) / 3, rel=1e-15)


@pytest.mark.parametrize("degrees", [20, 30, 45, 60])
def test_block_sticks_exactly_at_the_angle_of_friction(degrees: int) -> None:
    tangent = f"sin(pi*{degrees}/180)/cos(pi*{degrees}/180)"
    slope = {"degrees": degrees}
    at = solve_scene(read(block(slope, {"friction": tangent})), [1.0])
    assert states(at) == [{"slope": "stick"}]
    assert column(at, "block.position").values.tolist() == [[0.0, 0.0]]
    below = solve_scene(read(block(slope, {"friction": f"{tangent} - 1/1e60"})), [1.0])
    assert states(below) == [{"slope": "slide back"}]
    alpha = math.radians(degrees)
    assert force(at, "slope.normal") == pytest.approx(2 * 9.81 * math.cos(alpha), rel=1e-15)
    assert abs(force(at, "slope.friction")) == pytest.approx(2 * 9.81 * math.sin(alpha), rel=1e-15)


def test_block_slides_up_stops_and_slides_back() -> None:
    """Up with g (sin + mu cos), down with g (sin - mu cos); it sticks instead where mu_s > tan."""
    alpha, mu, v = math.radians(30), 0.3, 4.0
    velocity = [{"polar": [4, {"degrees": 30}]}][0]
    scene = block({"degrees": 30}, {"friction": [0.4, 0.3]}, velocity=velocity)
    answer = solve_scene(read(scene), [2.0])
    up, down = (9.81 * (math.sin(alpha) + s * mu * math.cos(alpha)) for s in (1, -1))
    assert kinds(answer) == [("slip", "slope")]
    assert answer.events[0].time == pytest.approx(v / up, rel=1e-15)
    late = 2.0 - v / up
    way = v * v / (2 * up) - down * late * late / 2
    assert column(answer, "block.position").values[0] @ [math.cos(alpha), math.sin(alpha)] == pytest.approx(way)
    held = solve_scene(read(block({"degrees": 30}, {"friction": [0.6, 0.3]}, velocity=velocity)), [2.0])
    assert kinds(held) == [("stick", "slope")]
    assert np.linalg.norm(column(held, "block.position").values[0]) == pytest.approx(v * v / (2 * up), rel=1e-14)


def test_cylinder_rolls_down_or_slips_at_three_times_the_coefficient() -> None:
    """tan alpha <= 3 mu rolls (a = 2/3 g sin alpha), beyond it slides with mu; exactly at the limit it rolls."""

    def on(slope: Any, friction: Any) -> Any:
        scene = disc(0.005, friction)
        scene["connections"][0]["on"] = {"at": [0, 0], "slope": slope}
        scene["let"] = {"a": "pi/6"}
        scene["bodies"]["disc"]["at"] = ["-0.1*sin(a)", "0.1*cos(a)"]
        return solve_scene(read(scene), [0.5])

    rolling = on("a", "sin(a)/cos(a)/3")
    assert states(rolling) == [{"floor": "stick"}]
    assert np.linalg.norm(linear(rolling, "disc")) == pytest.approx(2 / 3 * 9.81 / 2, rel=1e-15)
    slipping = on("a", 0.1)
    assert states(slipping) == [{"floor": "slide back"}]
    expected = 9.81 * (0.5 - 0.1 * math.sqrt(3) / 2)
    assert np.linalg.norm(linear(slipping, "disc")) == pytest.approx(expected, rel=1e-15)


def test_block_on_a_spring_with_friction_loses_alike_in_every_swing() -> None:
    """Turning points of m x'' = -k x -+ mu m g: each is 2 mu m g/k nearer, half a period pi sqrt(m/k) apart."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"block": {"mass": 1, "at": [1, 0]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.25},
            {"kind": "spring", "name": "s", "a": "block", "b": [-2, 0], "stiffness": 25, "rest_length": 2},
        ],
    }
    half, step = math.pi / 5, 2 * 0.25 * 9.81 / 25
    answer = solve_scene(read(scene), [0.3, 3.5], ("trajectory", "forces-in-time"))
    count = 5
    assert kinds(answer) == [("slip", "floor")] * (count - 1) + [("stick", "floor")]
    for n, event in enumerate(answer.events):
        assert abs(event.time - (n + 1) * half) <= event.error + 1e-15
    assert column(answer, "block.position").values[1, 0] == pytest.approx((1 - count * step) * (-1) ** count, abs=1e-14)
    assert answer.phases is not None
    assert [phase.model for phase in answer.phases] == ["modes"] * count + ["rest"]


def test_block_on_a_moving_plank() -> None:
    """Momentum, and the relative deceleration mu g (1 + m/M): they move together from v/(mu g (1 + m/M))."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "plank": {"mass": 4, "inertia": 1, "at": [0, 0]},
            "block": {"mass": 1, "at": [0, 0], "velocity": [2, 0]},
        },
        "connections": [
            {"kind": "slider", "a": "plank", "b": [0, 0], "slope": 0},
            {"kind": "contact", "name": "top", "place": "block", "on": {"at": "plank"}, "friction": 0.3},
        ],
    }
    answer = solve_scene(read(scene), [2.0])
    assert kinds(answer) == [("stick", "top")]
    assert answer.events[0].time == pytest.approx(2 / (0.3 * 9.81 * 1.25), rel=1e-15)
    assert column(answer, "plank.velocity").values[0, 0] == pytest.approx(0.4, rel=1e-15)


def test_painleve_without_a_motion() -> None:
    """1 + (l^2 m/I)(cos^2 - mu sin cos) < 0 at 60 degrees with mu = 2: nothing goes with sliding on."""
    answer = solve_scene(read(chalk()), [0.0, 1.0])
    assert answer.problem is not None
    assert answer.problem.code == "no-motion"
    assert answer.problem.connections == ("board",)
    assert answer.problem.decided_by
    assert answer.ended is not None
    assert (answer.ended.kind, answer.ended.time) == ("no-motion", 0.0)
    # With less friction the same chalk slides: N = (m g - ...)/..., by Newton and Euler about the centre.
    free = chalk()
    free["connections"][0]["friction"] = 0.5
    moving = solve_scene(read(free), [0.0])
    c, s, mu = 0.5, math.sqrt(3) / 2, 0.5
    # Acceleration of the foot upward: N/m - g + (N c - mu N s) c/I for sliding to the left, friction to the right.
    push = 9.81 / (1 + c * (c - mu * s) / 0.3333)
    assert force(moving, "board.normal") == pytest.approx(push, rel=1e-14)


def test_painleve_with_several_motions() -> None:
    """Spinning by 5 about its sliding foot, it may lift off or slide on."""
    foot = chalk()
    body = foot["bodies"]["chalk"]
    body["angular_velocity"] = 5
    # The centre moves so that the foot has the velocity (-3, 0): v = v_f + w x r.
    body["velocity"] = ["-3 - 5*0.8660254037844386", 2.5]
    answer = solve_scene(read(foot), [0.0])
    assert answer.problem is not None
    assert answer.problem.code == "several-motions"
    assert {one["board"] for one in answer.problem.candidates} == {"slide back", "open"}


def test_load_that_is_shared_is_not_determined() -> None:
    """A bar on two rough places: the vertical forces are m g/2 each, the friction may be any pair that cancels."""
    bar = {"mass": 2, "inertia": 1, "at": [0, 0], "places": {"l": [-1, 0], "r": [1, 0]}}
    floor = {"at": [0, 0]}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bar": bar},
        "connections": [
            {"kind": "contact", "name": k, "place": f"bar.{k}", "on": floor, "friction": 0.5} for k in ("l", "r")
        ],
    }
    answer = solve_scene(read(scene), [1.0])
    assert answer.forces is not None
    assert force(answer, "l.normal") == pytest.approx(9.81, rel=1e-15)
    assert not answer.forces["l.friction"].determined
    assert set(answer.forces["l.friction"].shared_with) == {"l", "r"}
    assert column(answer, "bar.position").values.tolist() == [[0.0, 0.0]]


def test_sliding_on_three_legs_of_different_roughness_is_not_determined() -> None:
    bar = {
        "mass": 2,
        "inertia": 1,
        "at": [0, 0],
        "velocity": [1, 0],
        "places": {"l": [-1, 0], "m": [0, 0], "r": [1, 0]},
    }
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bar": bar},
        "connections": [
            {"kind": "contact", "name": k, "place": f"bar.{k}", "on": {"at": [0, 0]}, "friction": mu}
            for k, mu in (("l", 0.1), ("m", 0.2), ("r", 0.1))
        ],
    }
    answer = solve_scene(read(scene), [0.0])
    assert answer.problem is not None
    assert answer.problem.code == "undetermined-friction"
    for connection in scene["connections"]:
        connection["friction"] = 0.1
    alike = solve_scene(read(scene), [0.1])
    assert alike.problem is None
    assert linear(alike, "bar") == (pytest.approx(-0.981, rel=1e-15), 0.0)


@pytest.mark.parametrize("rate", [3, -0.5])
@pytest.mark.parametrize(("friction", "mass"), [(0.3, 2), (1.2, 0.1)])
def test_a_driven_wheel_takes_along_what_rests_on_it(rate: float, friction: float, mass: float) -> None:
    """A wheel on a vertical track above it turns with alpha = mu m g R/I until their rims agree."""
    wheel = {"inertia": 0.25, "radius": 0.5}
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "driven": {**wheel, "mass": 1, "at": [0, 0], "angular_velocity": rate},
            "taken": {**wheel, "mass": mass, "at": [0, 1]},
        },
        "connections": [
            {"kind": "pin", "a": "driven", "b": [0, 0]},
            {"kind": "motor", "name": "motor", "a": "driven", "rate": rate},
            {"kind": "track", "name": "track", "place": "taken", "on": {"at": [0, 0], "slope": {"degrees": 90}}},
            {"kind": "contact", "name": "rims", "a": "driven", "b": "taken", "friction": friction},
        ],
    }
    push = 10 * mass
    alpha = friction * push * 0.5 / 0.25
    rolls = abs(rate) / alpha
    answer = solve_scene(read(scene), [0.5 * rolls, 1.5 * rolls], ("trajectory", "forces", "forces-in-time"))
    assert kinds(answer) == [("roll", "rims")]
    assert answer.events[0].time == pytest.approx(rolls, rel=1e-12)
    taken = column(answer, "taken.angular_velocity").values
    assert taken == pytest.approx([-0.5 * rate, -rate], rel=1e-12)
    side = 1 if rate > 0 else -1
    assert force(answer, "motor.torque") == pytest.approx(side * friction * push * 0.5, rel=1e-12)
    assert column(answer, "motor.torque").values[1] == pytest.approx(0, abs=1e-12)


def test_a_wheel_against_what_a_track_holds_as_well_is_undetermined() -> None:
    """Between track and wheel nothing says how much each bears, and friction depends on it."""
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "driven": {"mass": 1, "inertia": 0.1, "radius": 0.5, "at": [0, 0], "angular_velocity": 3},
            "block": {"mass": 2, "at": [0, 0.5]},
        },
        "connections": [
            {"kind": "pin", "a": "driven", "b": [0, 0]},
            {"kind": "motor", "a": "driven", "rate": 3},
            {"kind": "track", "place": "block", "on": {"at": [0, 0.5]}},
            {"kind": "contact", "name": "rim", "a": "driven", "b": "block", "friction": 0.3},
        ],
    }
    problem = solve_scene(read(scene), [1.0]).problem
    assert problem is not None
    assert (problem.code, problem.connections) == ("undetermined-friction", ("rim",))


@pytest.mark.parametrize("turn", ["acos(3/5)", "acos(5/13)", "-acos(8/17)", "1"])
@pytest.mark.parametrize("cosine", ["3/5", "5/13", "8/17", "0.3"])
@pytest.mark.parametrize("frictions", [(0.05, 0.02), (0.2, 0.4), (None, 0.3)])
def test_a_ladder_turned_with_its_gravity_moves_alike(turn: str, cosine: str, frictions: tuple[Any, Any]) -> None:
    def ladder(turn: str) -> dict[str, Any]:
        faces = [("floor", "foot", "t"), ("wall", "head", "t + pi/2")]
        return {
            "let": {
                "t": turn,
                "c": cosine,
                "s": "sqrt(1 - c^2)",
                "x": "-c/2",
                "y": "s/2",
                "u": "cos(t)",
                "v": "sin(t)",
            },
            "gravity": ["10*v", "-10*u"],
            "bodies": {
                "l": {
                    "mass": 1,
                    "inertia": "1/12",
                    "at": ["x*u - y*v", "x*v + y*u"],
                    "angle": "acos(c) + t",
                    "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
                }
            },
            "connections": [
                {"kind": "contact", "name": name, "place": f"l.{place}", "on": {"at": [0, 0], "slope": slope}}
                | ({} if friction is None else {"friction": friction})
                for (name, place, slope), friction in zip(faces, frictions, strict=True)
            ],
        }

    level, turned = (solve_scene(read(ladder(t)), [0.25]) for t in ("0", turn))
    assert kinds(turned) == kinds(level)
    assert states(turned) == states(level)
    angle = {"acos(3/5)": math.acos(0.6), "acos(5/13)": math.acos(5 / 13), "1": 1.0}.get(turn, -math.acos(8 / 17))
    x, y = column(level, "l.position").values[0]
    expected = [x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)]
    assert column(turned, "l.position").values[0] == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize(("speed", "along"), [((2, 0, 0), (1, 0)), (("1.2", "1.6", 0), (0.6, 0.8))])
def test_a_table_that_a_spring_draws_back_slides_back_at_once(speed: Any, along: tuple[float, float]) -> None:
    """Four legs begin to slide at once, from a state that is known to its error: x'' = -4 x -+ 1."""
    corners = [("0.5", "0.3"), ("-0.5", "0.3"), ("-0.5", "-0.3"), ("0.5", "-0.3")]
    table = {
        "mass": 10,
        "moments": [1, 1.5, 2],
        "at": [0, 0, "0.5"],
        "velocity": speed,
        "angular_velocity": [0, 0, 0],
        "places": {f"f{k}": [x, y, "-0.5"] for k, (x, y) in enumerate(corners)},
    }
    floor = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    legs = [{"kind": "contact", "place": f"t.f{k}", "on": floor, "friction": "0.1"} for k in range(4)]
    spring = {"kind": "spring", "a": "t", "b": [0, 0, "0.5"], "stiffness": 40, "rest_length": 0}
    scene = {"gravity": [0, 0, -10], "bodies": {"t": table}, "connections": [*legs, spring]}
    answer = solve_scene(read(scene), [0.2, 1.0], ("trajectory",))
    assert answer.problem is None
    back = math.atan(4) / 2
    farthest = math.hypot(0.25, 1) - 0.25
    expected = [0.25 * math.cos(0.4) + math.sin(0.4) - 0.25, 0.25 + (farthest - 0.25) * math.cos(2 * (1 - back))]
    place = np.asarray(column(answer, "t.position").values)
    assert np.allclose(place[:, :2], np.outer(expected, along), rtol=0, atol=1e-15)
    assert np.all(place[:, 2] == 0.5)


@pytest.mark.parametrize("x", ["0", "1e6"])
def test_a_level_bar_that_lands_on_a_rough_floor_comes_to_rest_on_both_ends(x: str) -> None:
    """What is left of its turning is rounding, which has no sign: both ends slide alike, and stick together."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "bar": {
                "mass": 1,
                "inertia": "1/3",
                "at": [x, "0.4"],
                "velocity": ["0.5", 0],
                "places": {"l": [-1, "-0.2"], "r": [1, "-0.2"]},
            }
        },
        "connections": [
            {"kind": "contact", "name": f"on-{end}", "place": f"bar.{end}", "on": {"at": [x, 0]}, "friction": "0.2"}
            for end in "lr"
        ],
    }
    answer = solve_scene(read(scene), [0.3], ("trajectory",))
    assert answer.problem is None
    fall = math.sqrt(0.4 / 9.81)
    slides = 0.5 - 0.2 * 9.81 * fall
    stops = fall + slides / (0.2 * 9.81)
    assert [event.kind for event in answer.events] == ["touch", "touch", "stick", "stick"]
    for event, time in zip(answer.events, [fall, fall, stops, stops], strict=True):
        assert abs(event.time - time) <= event.error + 4e-16
    place = column(answer, "bar.position")
    expected = 0.5 * fall + slides**2 / (2 * 0.2 * 9.81)
    assert np.asarray(place.values)[0] - [float(x), 0.2] == pytest.approx([expected, 0.0], abs=place.error + 1e-16)
    turning = column(answer, "bar.angular_velocity")
    assert abs(turning.values[0]) <= turning.error < 1e-14

"""The plain engine beside closed forms, most of them from textbooks of mechanics.

References
----------
.. [1] H. Goldstein, C. Poole, J. Safko, Classical Mechanics, 3rd ed.: Kepler's problem (3.6-3.8), tops (5.6-5.7),
   rotating frames (4.9-4.10).
.. [2] L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed.: pendulum (11), small oscillations (21-25).
.. [3] E. T. Whittaker, A Treatise on the Analytical Dynamics of Particles and Rigid Bodies, 4th ed.: elliptic functions
   of the pendulum (44), rolling (VIII).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from mpmath import ellipfun, ellipk, mp
from scipy.special import ellipj
from scipy.special import ellipk as complete

from core.multibody.language.reading import scene_from
from tests.oracles.plain_engine.motion import Motion, follow

G = 9.81
DOWN = [0, -9.81]


def moved(bodies: Any, connections: Any, times: list[float], gravity: Any = DOWN, **more: Any) -> Motion:
    scene = {"gravity": gravity, "bodies": bodies, "connections": connections, **more}
    return follow(scene_from(scene), [0.0, *times])


def position(motion: Motion, time: float, body: str) -> Any:
    return motion.states[time].position[motion.mechanism.coordinates.names.index(body)]


def velocity(motion: Motion, time: float, body: str) -> Any:
    spread, _ = motion.mechanism.coordinates.spread(motion.states[time].rates)
    return spread[motion.mechanism.coordinates.names.index(body)]


def spin(motion: Motion, time: float, body: str) -> Any:
    _, spread = motion.mechanism.coordinates.spread(motion.states[time].rates)
    return spread[motion.mechanism.coordinates.names.index(body)]


def acceleration(motion: Motion, body: str) -> Any:
    assert motion.accelerations is not None
    spread, _ = motion.mechanism.coordinates.spread(motion.accelerations)
    return spread[motion.mechanism.coordinates.names.index(body)]


def shown(motion: Motion) -> list[tuple[str, str]]:
    return [(event.kind, event.name) for event in motion.events]


def near(value: Any, wanted: Any, tolerance: float = 1e-10) -> None:
    np.testing.assert_allclose(value, wanted, rtol=tolerance, atol=tolerance)


def test_a_thrown_point_moves_on_a_parabola() -> None:
    motion = moved({"p": {"mass": 2, "at": [1, 2], "velocity": [3, 4]}}, [], [0.7])
    near(position(motion, 0.7, "p"), [1 + 3 * 0.7, 2 + 4 * 0.7 - G * 0.7**2 / 2])


@pytest.mark.parametrize("amplitude", [0.5, math.pi / 2, 2.5])
def test_a_pendulum_moves_by_elliptic_functions(amplitude: float) -> None:
    body = {"p": {"mass": 1, "at": [f"sin({amplitude})", f"-cos({amplitude})"]}}
    motion = moved(body, [{"kind": "rod", "name": "r", "a": "p", "b": [0, 0]}], [1.0])
    m, rate = math.sin(amplitude / 2) ** 2, math.sqrt(G)
    sn = ellipj(complete(m) - rate, m)[0]
    angle = 2 * math.asin(math.sqrt(m) * sn)
    near(position(motion, 1.0, "p"), [math.sin(angle), -math.cos(angle)])
    # The pull is m g cos + m v^2/l, with v^2 = 2 g (cos - cos of the amplitude).
    near(motion.forces[1.0]["r.force"], G * (3 * math.cos(angle) - 2 * math.cos(amplitude)), 1e-9)


def test_a_pendulum_has_the_period_of_the_complete_integral() -> None:
    period = float(4 * ellipk(math.sin(1.25) ** 2) / mp.sqrt(G))
    assert period == pytest.approx(3.2959322465161165, rel=1e-14)
    body = {"p": {"mass": 1, "at": ["sin(2.5)", "-cos(2.5)"]}}
    motion = moved(body, [{"kind": "rod", "a": "p", "b": [0, 0]}], [period])
    near(position(motion, period, "p"), [math.sin(2.5), -math.cos(2.5)], 1e-9)


def test_atwoods_machine_over_a_disc() -> None:
    bodies = {
        "a": {"mass": 1, "at": [-0.1, -1]},
        "b": {"mass": 3, "at": [0.1, -1]},
        "w": {"mass": 2, "radius": 0.1, "inertia": 0.01, "at": [0, 0]},
    }
    string = {"kind": "string", "name": "s", "through": ["a", "w", "b"], "sides": {"w": ["left", "right"]}}
    motion = moved(bodies, [{"kind": "pin", "name": "axle", "a": "w", "b": [0, 0]}, string], [0.2])
    near(acceleration(motion, "a"), [0, 3.924])
    near([motion.forces[0.2]["s.1.tension"], motion.forces[0.2]["s.2.tension"]], [13.734, 17.658])
    near(motion.forces[0.2]["axle.y"], 51.012)


def test_a_weight_that_reaches_its_drum_ends_the_motion() -> None:
    bodies = {
        "a": {"mass": 1, "at": [-0.1, -1]},
        "b": {"mass": 2, "at": [0.1, -1]},
        "w": {"mass": 0.5, "radius": 0.1, "inertia": 0.0025, "at": [0, 0]},
    }
    string = {"kind": "string", "name": "s", "through": ["a", "w", "b"], "sides": {"w": ["left", "right"]}}
    motion = moved(bodies, [{"kind": "pin", "a": "w", "b": [0, 0]}, string], [1.0])
    assert motion.ended is not None
    assert motion.ended.kind == "singular"
    assert motion.ended.time == pytest.approx(math.sqrt(2 / (G * 1 / 3.25)), abs=1e-8)


def test_a_yo_yo() -> None:
    body = {"y": {"mass": 0.1, "radius": 0.01, "inertia": 4e-5, "at": [0.01, -0.5]}}
    string = {"kind": "string", "name": "s", "through": [[0, 0], "y"], "sides": {"y": "left"}}
    motion = moved(body, [string], [0.3])
    near(acceleration(motion, "y"), [0, -1.962])
    near(motion.forces[0.3]["s.tension"], 0.7848)


@pytest.mark.parametrize(
    ("half", "inertia", "tilt", "time"),
    [(1, "0.3333333", "pi/2 - 0.9272952180016122", 0.39239451801046), (1.5, "0.75", "0.5", 0.58173830116164499)],
)
def test_a_ladder_leaves_the_wall_at_two_thirds_of_its_height(
    half: float, inertia: str, tilt: str, time: float
) -> None:
    body = {
        "mass": 1,
        "inertia": inertia,
        "at": [f"-{half}*sin({tilt})", f"{half}*cos({tilt})"],
        "angle": f"pi/2 - ({tilt})",
        "places": {"f": [-half, 0], "h": [half, 0]},
    }
    floor = {"kind": "contact", "name": "floor", "place": "l.f", "on": {"at": [0, 0]}}
    wall = {"kind": "contact", "name": "wall", "place": "l.h", "on": {"at": [0, 0], "slope": {"degrees": 90}}}
    motion = moved({"l": body}, [floor, wall], [time + 0.01])
    assert shown(motion) == [("lift-off", "wall")]
    near(motion.events[0].time, time, 1e-11)


@pytest.mark.parametrize(("factor", "mu", "v"), [(0.5, 0.2, 3.0), (0.4, 0.25, 5.0)])
def test_what_slips_rolls_when_friction_has_turned_it(factor: float, mu: float, v: float) -> None:
    body = {"d": {"mass": 1, "inertia": factor * 0.01, "radius": 0.1, "at": [0, 0.1], "velocity": [v, 0]}}
    floor = {"kind": "contact", "name": "floor", "place": "d", "on": {"at": [0, 0]}, "friction": mu}
    time = v * factor / (mu * G * (1 + factor))
    motion = moved(body, [floor], [time + 0.1])
    assert shown(motion) == [("roll", "floor")]
    near(motion.events[0].time, time, 1e-12)
    near(velocity(motion, time + 0.1, "d"), [v / (1 + factor), 0])


def test_a_stone_on_a_string_flies_and_is_caught() -> None:
    body = {"p": {"mass": 1, "at": [0, -0.5], "velocity": [4, 0]}}
    motion = moved(body, [{"kind": "string", "name": "s", "through": ["p", [0, 0]], "restitution": 0}], [0.9])
    assert shown(motion)[:2] == [("slack", "s"), ("taut", "s")]
    near([event.time for event in motion.events[:2]], [0.33986875327139788, 0.87122732934228872])


def test_a_double_pendulum_of_points() -> None:
    bodies = {
        "p": {"mass": 1, "at": ["sin(1)", "-cos(1)"]},
        "q": {"mass": 1, "at": ["sin(1) + sin(-0.5)", "-cos(1) - cos(-0.5)"]},
    }
    rods = [{"kind": "rod", "name": "r", "a": "p", "b": [0, 0]}, {"kind": "rod", "a": "q", "b": "p"}]
    motion = moved(bodies, rods, [1.0])
    first, second = -0.82194943572101677, 0.29181553578655226
    near(position(motion, 1.0, "p"), [math.sin(first), -math.cos(first)])
    near(position(motion, 1.0, "q")[0], math.sin(first) + math.sin(second))
    near(motion.forces[1.0]["r.force"], 10.370139833611142)


def test_a_bead_rests_on_a_hoop_that_turns() -> None:
    height = G / (36 * 0.5)
    body = {"b": {"mass": 1, "at": [f"0.5*sqrt(1 - {height}^2)", f"-0.5*{height}"]}}
    frame = {"kind": "spinning-frame", "rate": 6}
    motion = moved(body, [{"kind": "rod", "a": "b", "b": [0, 0]}, frame], [0.3])
    near(velocity(motion, 0.3, "b"), [0, 0])
    assert math.acos(height) == pytest.approx(0.99440721205869942, rel=1e-14)


@pytest.mark.parametrize("rate", [3.6390508741573294, 32.244054117648667])
def test_a_top_precesses_at_either_of_two_rates(rate: float) -> None:
    c, s, spin3 = math.cos(0.8), math.sin(0.8), 150.0
    # In body axes: the precession along the vertical, and so much about the axis that the whole there is 150 rad/s.
    body = {
        "mass": 1,
        "moments": ["0.012 - 0.01", "0.012 - 0.01", 0.002],
        "at": ["0.1*sin(0.8)", 0, "0.1*cos(0.8)"],
        "axes": [["cos(0.8)", 0, "-sin(0.8)"], [0, 1, 0], ["sin(0.8)", 0, "cos(0.8)"]],
        "angular_velocity": [f"-{rate}*sin(0.8)", 0, spin3],
        "places": {"tip": [0, 0, -0.1]},
    }
    motion = moved({"t": body}, [{"kind": "pin", "a": "t.tip", "b": [0, 0, 0]}], [0.02], [0, 0, -9.81])
    angle = rate * 0.02
    near(position(motion, 0.02, "t"), [0.1 * s * math.cos(angle), 0.1 * s * math.sin(angle), 0.1 * c], 1e-9)


def test_two_masses_on_two_springs_swing_in_a_mode() -> None:
    rate, ratio = 0.61803398874989485, "(1 + sqrt(5))/2"
    bodies = {"a": {"mass": 1, "at": ["1 + 0.1", 0]}, "b": {"mass": 1, "at": [f"2 + 0.1*{ratio}", 0]}}
    springs = [
        {"kind": "spring", "a": "a", "b": [0, 0], "stiffness": 1, "rest_length": 1},
        {"kind": "spring", "a": "b", "b": "a", "stiffness": 1, "rest_length": 1},
    ]
    motion = moved(bodies, springs, [2.0], [0, 0])
    near(position(motion, 2.0, "a")[0] - 1, 0.1 * math.cos(2 * rate))


def test_bounces_come_to_rest_at_the_sum_of_a_geometric_series() -> None:
    body = {"b": {"mass": 1, "at": [0, 1.25]}}
    floor = {"kind": "contact", "name": "floor", "place": "b", "on": {"at": [0, 0]}, "restitution": 0.5}
    motion = moved(body, [floor], [1.7])
    first = math.sqrt(2 * 1.25 / G)
    near([event.time for event in motion.events[:3]], [first, first * 2, first * 2.5])
    settled = next(event.time for event in motion.events if event.kind == "settle")
    near(settled, 3 * first, 1e-9)


@pytest.mark.parametrize("ratio", [10, 100])
def test_blocks_count_the_digits_of_pi(ratio: int) -> None:
    """A block between a wall and a heavier one: ceil(pi/atan sqrt(m/M)) - 1 elastic impacts (G. Galperin, 2003)."""
    bodies = {
        "m": {"mass": 1, "at": [1, 0], "velocity": [0, 0]},
        "M": {"mass": ratio, "at": [2, 0], "velocity": [-1, 0]},
    }
    rails = [{"kind": "track", "place": k, "on": {"at": [0, 0]}} for k in bodies]
    wall = {
        "kind": "contact",
        "name": "wall",
        "place": "m",
        "on": {"at": [0, 0], "slope": {"degrees": -90}},
        "restitution": 1,
    }
    pair = {
        "kind": "contact",
        "name": "pair",
        "place": "M",
        "on": {"at": "m", "slope": {"degrees": -90}},
        "restitution": 1,
    }
    motion = moved(bodies, [*rails, wall, pair], [40.0], [0, 0])
    assert len(motion.events) == math.ceil(math.pi / math.atan(math.sqrt(1 / ratio))) - 1


@pytest.mark.parametrize(
    ("rest", "code"), [(["-3", "0", 0], "no-motion"), (["-3 - 5*sqrt(3)/2", "2.5", 5], "several-motions")]
)
def test_painleves_chalk(rest: list[Any], code: str) -> None:
    body = {
        "mass": 1,
        "inertia": 0.3333,
        "at": [0.5, "sqrt(3)/2"],
        "angle": {"degrees": 60},
        "velocity": rest[:2],
        "angular_velocity": rest[2],
        "places": {"foot": [-1, 0]},
    }
    board = {"kind": "contact", "name": "board", "place": "c.foot", "on": {"at": [0, 0]}, "friction": 2}
    motion = moved({"c": body}, [board], [0.1])
    assert motion.ended is not None
    assert motion.ended.kind == code


def test_an_ellipse_of_kepler_closes() -> None:
    body = {"p": {"mass": 1, "at": [1, 0], "velocity": [0, 1.2]}}
    period = 2 * math.pi / (2 - 1.44) ** 1.5
    pull = {"kind": "inverse-square", "a": "p", "b": [0, 0], "strength": 1}
    motion = moved(body, [pull], [period / 2, period], [0, 0])
    near(position(motion, period / 2, "p"), [-1.44 / (2 - 1.44), 0], 1e-9)
    near(position(motion, period, "p"), [1, 0], 1e-9)


def test_newtons_cradle_of_three_is_undecided_and_of_two_is_not() -> None:
    bodies = {
        k: {"mass": 1, "inertia": 1, "radius": 0.1, "at": [x, 0], "velocity": [v, 0]}
        for k, x, v in (("a", -1, 1), ("b", 0, 0), ("c", 0.2, 0))
    }
    pairs = [{"kind": "contact", "name": k, "a": k[0], "b": k[1], "restitution": 1} for k in ("ab", "bc")]
    three = moved(bodies, pairs, [1.0], [0, 0])
    assert three.ended is not None
    assert three.ended.kind == "simultaneous-impacts"
    near(three.ended.time, 0.8)
    two = moved({k: bodies[k] for k in "ab"}, pairs[:1], [1.0], [0, 0])
    near([velocity(two, 1.0, "a")[0], velocity(two, 1.0, "b")[0]], [0, 1])


def test_a_point_leaves_a_loop_where_gravity_suffices() -> None:
    speed = math.sqrt(4 * G)
    body = {"p": {"mass": 1, "at": [0, -1], "velocity": ["sqrt(4*9.81)", 0]}}
    motion = moved(body, [{"kind": "contact", "name": "loop", "place": "p", "on": {"at": [0, 0], "radius": -1}}], [0.9])
    assert shown(motion)[0] == ("lift-off", "loop")
    # cos of the angle from the bottom: (2 g - v^2)/(3 g) = -2/3; with v^2 = 4 g the pendulum is the separatrix:
    # sin(angle/2) = tanh(t sqrt g).
    angle = math.acos((2 * G - speed**2) / (3 * G))
    near(motion.events[0].time, math.atanh(math.sin(angle / 2)) / math.sqrt(G))


def test_a_point_leaves_a_hump_at_two_thirds_of_its_height() -> None:
    body = {"p": {"mass": 1, "at": ["sin(0.2)", "cos(0.2)"]}}
    motion = moved(body, [{"kind": "contact", "name": "hump", "place": "p", "on": {"at": [0, 0], "radius": 1}}], [1.5])
    # Of the inverted pendulum from rest at 0.2: cosh-like growth is sn at an imaginary modulus; by energy at the event.
    assert shown(motion)[0] == ("lift-off", "hump")
    time = motion.events[0].time
    m = math.cos(0.1) ** 2
    half = math.acos(2 / 3 * math.cos(0.2)) / 2
    # With u = pi - angle the motion is that of a pendulum from rest at pi - 0.2: sin(u/2) = sqrt(m) cd(t sqrt g).
    near(math.sqrt(m) * float(ellipfun("cd", time * math.sqrt(G), m=m)), math.cos(half), 1e-9)


def test_a_block_slides_up_a_rough_slope_and_stays() -> None:
    body = {"b": {"mass": 2, "at": [0, 0], "velocity": [1.6, 1.2]}}
    slope = {
        "kind": "contact",
        "name": "slope",
        "place": "b",
        "on": {"at": [0, 0], "slope": "atan(3/4)"},
        "friction": 0.8,
    }
    motion = moved(body, [slope], [0.5])
    assert shown(motion) == [("stick", "slope")]
    near(motion.events[0].time, 2 / (G * (0.6 + 0.8 * 0.8)))
    near(motion.forces[0.5]["slope.friction"], 2 * G * 0.6)


@pytest.mark.parametrize("factor", ["1/2", "2/5", "1"])
def test_what_rolls_down_a_slope(factor: str) -> None:
    body = {"d": {"mass": 3, "radius": 0.2, "inertia": f"3*0.2^2*{factor}", "at": ["-0.2*0.6", "0.2*0.8"]}}
    motion = moved(body, [{"kind": "rolling", "place": "d", "on": {"at": [0, 0], "slope": "atan(3/4)"}}], [0.2])
    size = G * 0.6 / (1 + {"1/2": 0.5, "2/5": 0.4, "1": 1.0}[factor])
    near(acceleration(motion, "d"), [-size * 0.8, -size * 0.6])


def test_a_block_on_a_movable_wedge() -> None:
    bodies = {"w": {"mass": 2, "at": [0, 0]}, "b": {"mass": 1, "at": [0.8, 0.6]}}
    connections = [
        {"kind": "slider", "a": "w", "b": [0, 0], "slope": 0},
        {"kind": "contact", "name": "face", "place": "b", "on": {"at": "w", "slope": "atan(3/4)"}},
    ]
    motion = moved(bodies, connections, [0.2])
    near(acceleration(motion, "w")[0], G * 0.6 * 0.8 / (2 + 0.36))
    near(motion.forces[0.2]["face.normal"], 2 * G * 0.8 / (2 + 0.36))


def test_a_damped_oscillator() -> None:
    connections = [
        {"kind": "track", "place": "p", "on": {"at": [0, 0]}},
        {"kind": "spring", "a": "p", "b": [-5, 0], "stiffness": 4, "rest_length": 5},
        {"kind": "damper", "a": "p", "b": [-5, 0], "coefficient": 1},
    ]
    motion = moved({"p": {"mass": 1, "at": [1, 0]}}, connections, [1.3], [0, 0])
    rate = math.sqrt(4 - 0.25)
    wanted = math.exp(-0.65) * (math.cos(rate * 1.3) + math.sin(rate * 1.3) / (2 * rate))
    near(position(motion, 1.3, "p")[0], wanted)


def test_a_free_point_seen_from_a_frame_that_spins() -> None:
    body = {"p": {"mass": 1, "at": [1, 0, 0], "velocity": [0, 0, 0]}}
    motion = moved(body, [{"kind": "spinning-frame", "rate": 2}], [0.7], [0, 0, 0])
    # At rest in the frame it moves at 2 m/s along y outside; the frame has turned by 1.4 rad.
    x, y = 1.0, 2 * 0.7
    c, s = math.cos(1.4), math.sin(1.4)
    near(position(motion, 0.7, "p"), [c * x + s * y, -s * x + c * y, 0])


def test_a_ball_on_a_turntable_runs_in_a_circle() -> None:
    """Its centre turns at 2/7 of the rate of the table."""
    body = {
        "mass": 1,
        "moments": [0.004, 0.004, 0.004],
        "radius": 0.1,
        "at": [1, 0, 0.1],
        "velocity": [0, 0.5, 0],
        "angular_velocity": [0, 0, 0],
    }
    body.pop("angular_velocity")
    table = {"kind": "rolling", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1], "rate": 7}}
    motion = moved({"b": body}, [table], [0.5], [0, 0, -9.81])
    near(velocity(motion, 0.5, "b"), [-0.5 * math.sin(1.0), 0.5 * math.cos(1.0), 0])


def test_a_symmetric_body_precesses_about_its_momentum() -> None:
    body = {"mass": 1, "moments": [0.2, 0.2, 0.1], "at": [0, 0, 0], "angular_velocity": [1, 0, 3]}
    motion = moved({"b": body}, [], [0.9], [0, 0, 0])
    axis = motion.states[0.9].turn[0][:, 2]
    momentum = np.array([0.2, 0, 0.3])
    size = float(np.linalg.norm(momentum))
    unit, angle = momentum / size, size / 0.2 * 0.9
    start = np.array([0.0, 0.0, 1.0])
    turned = (
        start * math.cos(angle)
        + np.cross(unit, start) * math.sin(angle)
        + unit * (unit @ start) * (1 - math.cos(angle))
    )
    near(axis, turned)


def test_a_conical_pendulum() -> None:
    rate = math.sqrt(G / 0.8)
    body = {"p": {"mass": 1, "at": [0.6, 0, -0.8], "velocity": [0, "0.6*sqrt(9.81/0.8)", 0]}}
    motion = moved(body, [{"kind": "rod", "name": "r", "a": "p", "b": [0, 0, 0]}], [1.0], [0, 0, -9.81])
    near(position(motion, 1.0, "p"), [0.6 * math.cos(rate), 0.6 * math.sin(rate), -0.8])
    near(motion.forces[1.0]["r.force"], G / 0.8)


def test_a_chain_slides_off_a_table() -> None:
    bodies = {"f": {"mass": 0, "at": [0, -0.5]}, "b": {"mass": 0, "at": [-1.5, 0]}}
    chain = {"kind": "chain", "name": "c", "through": ["f", [0, 0], "b"], "density": 1.2}
    motion = moved(bodies, [chain], [0.5])
    near(position(motion, 0.5, "f")[1], -0.5 * math.cosh(0.5 * math.sqrt(G / 2)))


def test_a_table_on_four_legs_rests_and_its_legs_share_what_is_open() -> None:
    legs = {f"l{k}": [x, y, -0.5] for k, (x, y) in enumerate([(0.5, 0.3), (-0.5, 0.3), (-0.5, -0.3), (0.5, -0.3)])}
    body = {"mass": 10, "moments": [1, 1.5, 2], "at": [0, 0, 0.5], "places": legs}
    contacts = [
        {"kind": "contact", "name": k, "place": f"t.{k}", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}} for k in legs
    ]
    motion = moved({"t": body}, contacts, [0.1], [0, 0, -9.81])
    assert motion.forces[0.1] == {}
    near(velocity(motion, 0.1, "t"), [0, 0, 0])


def test_equally_rough_places_of_a_bar_stop_together() -> None:
    body = {
        "mass": 2,
        "inertia": 1,
        "at": [0, 0],
        "velocity": [1, 0],
        "places": {"l": [-1, 0], "m": [0, 0], "r": [1, 0]},
    }
    contacts = [
        {"kind": "contact", "name": k, "place": f"b.{k}", "on": {"at": [0, 0]}, "friction": 0.1}
        for k in ("l", "m", "r")
    ]
    motion = moved({"b": body}, contacts, [1.5], [0, -10])
    assert shown(motion) == [("stick", "l"), ("stick", "m"), ("stick", "r")]
    near(motion.events[0].time, 1.0)


def test_a_pulled_ladder_tips_when_no_share_holds_it() -> None:
    """From moments about the foot and the wall's cone: as soon as the pull is 35/12 N."""
    bodies = {
        "l": {
            "mass": 1,
            "inertia": "1/12",
            "at": [-0.14, 0.48],
            "angle": "acos(0.28)",
            "places": {"f": [-0.5, 0], "h": [0.5, 0]},
        },
        "m": {"mass": 1000, "at": [-1.14, 0.48], "velocity": [-1, 0]},
    }
    connections = [
        {"kind": "contact", "name": "floor", "place": "l.f", "on": {"at": [0, 0]}, "friction": 0.3},
        {
            "kind": "contact",
            "name": "wall",
            "place": "l.h",
            "on": {"at": [0, 0], "slope": {"degrees": 90}},
            "friction": 0.3,
        },
        {"kind": "track", "place": "m", "on": {"at": [0, 0.48]}},
        {"kind": "spring", "a": "l", "b": "m", "stiffness": 10},
    ]
    motion = moved(bodies, connections, [0.3], [0, -10])
    assert shown(motion) == [("lift-off", "wall")]
    # The mass swings on the spring: 10 d = 35/12 with d = sin(t/10)/(1/10).
    near(motion.events[0].time, 10 * math.asin(35 / 1200), 1e-9)


def test_what_a_motor_strikes_moves_off_with_the_paddle() -> None:
    bodies = {
        "c": {"mass": 1, "inertia": 0.1, "at": [0, 0], "angular_velocity": 2},
        "m": {"mass": 1, "at": [1, 0.5], "velocity": [0, 0]},
    }
    connections = [
        {"kind": "pin", "a": "c", "b": [0, 0]},
        {"kind": "motor", "a": "c", "rate": 2},
        {"kind": "contact", "name": "paddle", "place": "m", "on": {"at": "c"}},
    ]
    motion = moved(bodies, connections, [0.5], [0, 0])
    time = math.atan(0.5) / 2
    assert shown(motion) == [("touch", "paddle")]
    near(motion.events[0].time, time)
    # On the paddle its distance grows as r'' = 4 r from r = sqrt(1.25) at r' = 0.
    r = math.sqrt(1.25) * math.cosh(2 * (0.5 - time))
    near(position(motion, 0.5, "m"), [r * math.cos(1.0), r * math.sin(1.0)])


def test_two_balls_collide_in_space() -> None:
    bodies = {
        "a": {"mass": 1, "radius": 0.1, "at": [-0.5, 0, 0], "velocity": [1, 0, 0]},
        "b": {"mass": 3, "radius": 0.1, "at": [0.5, 0, 0], "velocity": [-1, 0, 0]},
    }
    motion = moved(bodies, [{"kind": "contact", "name": "p", "a": "a", "b": "b", "restitution": 0.5}], [0.5], [0, 0, 0])
    near(motion.events[0].time, 0.4)
    near([velocity(motion, 0.5, "a")[0], velocity(motion, 0.5, "b")[0]], [-1.25, -0.25])


def test_a_hinge_with_an_oblique_axis_is_a_pendulum_about_it() -> None:
    body = {"mass": 2, "moments": [0.1, 0.1, 0.1], "at": [0, 0, 0.5], "places": {"p": [0, 0, -0.5]}}
    hinge = {"kind": "pin", "a": "b.p", "b": [0, 0, 0], "axis": [0.6, 0.8, 0]}
    motion = moved({"b": {**body, "angular_velocity": [0.6, 0.8, 0]}}, [hinge], [0.6], [0, 0, -9.81])
    # By energy: I w^2/2 + m g h with I = 0.1 + m l^2.
    inertia = 0.1 + 2 * 0.25
    height = position(motion, 0.6, "b")[2]
    w = float(np.linalg.norm(spin(motion, 0.6, "b")))
    near(inertia * w * w / 2 + 2 * G * height, inertia / 2 + 2 * G * 0.5)
    assert height < 0.45
    near(position(motion, 0.6, "b") @ np.array([0.6, 0.8, 0]), 0.0)


def test_twins_meet_their_walls_at_one_instant() -> None:
    bodies = {"a": {"mass": 1, "at": [0.6, -0.8]}, "b": {"mass": 1, "at": [5.6, -0.8]}}
    connections = [
        {"kind": "rod", "a": "a", "b": [0, 0]},
        {"kind": "rod", "a": "b", "b": [5, 0]},
        {"kind": "contact", "name": "wa", "place": "a", "on": {"at": [0, 0], "slope": {"degrees": -90}}},
        {"kind": "contact", "name": "wb", "place": "b", "on": {"at": [5, 0], "slope": {"degrees": -90}}},
    ]
    motion = moved(bodies, connections, [0.6], [0, -10])
    quarter = complete(math.sin(math.asin(0.6) / 2) ** 2) / math.sqrt(10)
    near([event.time for event in motion.events], [quarter, quarter])
    near(velocity(motion, 0.6, "a"), [0, 0])


def test_a_force_that_swings_with_time_beats_with_the_spring() -> None:
    """x'' + k x = 2 cos(3 t) from rest: x = 2 (cos(3 t) - cos(w t))/(w^2 - 9), w^2 = k."""
    spring = {"kind": "spring", "a": "p", "b": [-1, 0], "stiffness": 20}
    rail = {"kind": "track", "place": "p", "on": {"at": [0, 0]}}
    push = {"kind": "force", "place": "p", "force": ["2*cos(3*t)", 0]}
    motion = moved({"p": {"mass": 1, "at": [0, 0]}}, [spring, rail, push], [0.7])
    near(position(motion, 0.7, "p"), [2 * (math.cos(2.1) - math.cos(0.7 * math.sqrt(20))) / 11, 0])

"""Every kind of connection in a small scene, against its equation of motion derived by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from core.bodies import Cuboid
from core.multibody.language.body import SceneBody
from core.multibody.language.joints import Pin
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene
from tests.core.multibody.oracles import integrated
from tests.core.multibody.worked_examples import column, force, linear, points, read

G = 9.81
EPS = 2.0**-52


def scene(bodies: dict[str, Any], connections: list[dict[str, Any]], gravity: Any = (0, -9.81), **rest: Any) -> Any:
    return read({"gravity": list(gravity), "bodies": bodies, "connections": connections, **rest})


def flow(rate: Callable[..., Any], start: list[Any]) -> Any:
    return lambda t: integrated(rate, start, t)


def test_disc_rolls_down_a_slope() -> None:
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    disc = {"mass": 2, "inertia": 0.01, "radius": 0.1, "at": ["-0.1*sin(pi/6)", "0.1*cos(pi/6)"]}
    roll = {"kind": "rolling", "name": "r", "place": "disc", "on": {"at": [0, 0], "slope": {"degrees": 30}}}
    answer = solve_scene(scene({"disc": disc}, [roll]))
    a = G * s / (1 + 0.01 / (2 * 0.01))
    assert answer.model.name == "constant acceleration"
    assert linear(answer, "disc") == pytest.approx((-a * c, -a * s), rel=4 * EPS)
    assert force(answer, "r.normal") == pytest.approx(2 * G * c, rel=4 * EPS)
    # Friction holds the disc back, up the slope.
    assert force(answer, "r.friction") == pytest.approx(0.01 / 0.01 * a, rel=4 * EPS)


def test_cylinder_rolls_inside_a_cylinder_as_a_pendulum() -> None:
    disc = {"mass": 1, "inertia": 0.02, "radius": 0.2, "at": ["0.8*sin(1)", "-0.8*cos(1)"]}
    roll = {"kind": "rolling", "name": "r", "place": "disc", "on": {"at": [0, 0], "radius": -1}}
    times = [0.5, 100.0]
    answer = solve_scene(scene({"disc": disc}, [roll]), times, ("trajectory", "forces", "forces-in-time"))
    assert answer.model.name == "one period"
    with mpmath.workdps(30):
        omega = mpmath.sqrt(mpmath.mpf("9.81") / (mpmath.mpf("0.8") * mpmath.mpf("1.5")))
        m = mpmath.sin(mpmath.mpf("0.5")) ** 2
        assert answer.period == pytest.approx(float(4 * mpmath.ellipk(m) / omega), rel=2 * EPS)
        for i, t in enumerate(times):
            psi = 2 * mpmath.asin(mpmath.sin(mpmath.mpf("0.5")) * mpmath.ellipfun("cd", omega * mpmath.mpf(t), m=m))
            place = column(answer, "disc.position")
            assert abs(place.values[i, 0] - mpmath.mpf("0.8") * mpmath.sin(psi)) <= place.error
            # Inside, the disc turns against the way its centre goes round: R - r over r.
            turn = column(answer, "disc.angle")
            assert abs(turn.values[i] + 4 * (psi - 1)) <= turn.error
            normal = column(answer, "r.normal")
            rate2 = 2 * omega**2 * (mpmath.cos(psi) - mpmath.cos(1))
            assert abs(abs(normal.values[i]) - (mpmath.mpf("9.81") * mpmath.cos(psi) + mpmath.mpf("0.8") * rate2)) <= (
                normal.error
            )


def test_cylinder_on_a_movable_wedge() -> None:
    bodies = {
        "wedge": {"mass": 3, "at": [0, 0]},
        "disc": {"mass": 2, "inertia": 0.01, "radius": 0.1, "at": ["1 - 0.1*s", "0.1*c + s/c"]},
    }
    connections = [
        {"kind": "track", "place": "wedge", "on": {"at": [0, 0], "slope": 0}},
        {"kind": "rolling", "place": "disc", "on": {"at": "wedge", "slope": 0.5}},
    ]
    answer = solve_scene(scene(bodies, connections, let={"c": "cos(0.5)", "s": "sin(0.5)"}))
    c, s = math.cos(0.5), math.sin(0.5)
    # X of the wedge and u along the slope: [[M + m, m c], [m c, m + I/r^2]] (X'', u'') = (0, -m g s)
    xx, uu = np.linalg.solve([[5, 2 * c], [2 * c, 3]], [0, -2 * G * s])
    assert answer.model.name == "constant acceleration"
    assert linear(answer, "wedge") == pytest.approx((xx, 0), rel=1e-14)
    assert linear(answer, "disc") == pytest.approx((xx + uu * c, uu * s), rel=1e-14)


def test_block_slides_on_a_movable_wedge() -> None:
    bodies = {"wedge": {"mass": 3, "inertia": 1, "at": [0, 0]}, "block": {"mass": 2, "inertia": 0.1, "at": [1, 1]}}
    connections = [
        {"kind": "slider", "a": "wedge", "b": [0, 0], "slope": 0},
        {"kind": "slider", "name": "face", "a": "block", "b": "wedge", "slope": {"degrees": 45}},
    ]
    answer = solve_scene(scene(bodies, connections))
    c = math.sqrt(0.5)
    xx, uu = np.linalg.solve([[5, 2 * c], [2 * c, 2]], [0, -2 * G * c])
    assert answer.model.name == "constant acceleration"
    assert linear(answer, "block") == pytest.approx((xx + uu * c, uu * c), rel=1e-14)
    assert answer.forces is not None


def test_elastic_pendulum() -> None:
    start = {"bob": {"mass": 1, "at": [0.6, -0.8], "velocity": [0.1, 0]}}
    spring = {"kind": "spring", "name": "s", "a": "bob", "b": [0, 0], "stiffness": 40, "rest_length": 0.9}
    answer = solve_scene(scene(start, [spring]), [0.7], ("trajectory", "forces-in-time"))
    with mpmath.workdps(25):

        def rate(x: Any, y: Any, u: Any, v: Any) -> list[Any]:
            r = mpmath.sqrt(x * x + y * y)
            pull = 40 * (1 - mpmath.mpf("0.9") / r)
            return [u, v, -pull * x, -pull * y - mpmath.mpf("9.81")]

        x, y, *_ = flow(rate, ["0.6", "-0.8", "0.1", "0"])(mpmath.mpf(0.7))
        place, pull = column(answer, "bob.position"), column(answer, "s.force")
        assert mpmath.hypot(place.values[0, 0] - x, place.values[0, 1] - y) <= place.error < 1e-13
        assert abs(pull.values[0] - 40 * (mpmath.hypot(x, y) - mpmath.mpf("0.9"))) <= pull.error


def physical(extra: list[dict[str, Any]], **body: Any) -> Any:
    arm = {"mass": 2, "inertia": 0.3, "at": [0, -0.5], "places": {"top": [0, 0.5]}, **body}
    return scene({"arm": arm}, [{"kind": "pin", "name": "hinge", "a": "arm.top", "b": [0, 0]}, *extra])


def test_pendulum_with_a_torsion_spring_and_a_damper() -> None:
    extra = [
        {"kind": "torsion-spring", "name": "k", "a": "arm", "stiffness": 7, "rest_angle": 0.4},
        {"kind": "damper", "name": "d", "a": "arm", "measure": "turn", "coefficient": 0.3},
    ]
    answer = solve_scene(physical(extra, angular_velocity=5), [0.9], ("trajectory", "forces-in-time", "energy"))
    with mpmath.workdps(25):

        def rate(a: Any, w: Any) -> list[Any]:
            total = -mpmath.mpf("9.81") * mpmath.sin(a) - 7 * (a - mpmath.mpf("0.4")) - mpmath.mpf("0.3") * w
            return [w, total / mpmath.mpf("0.8")]

        a, w = flow(rate, ["0", "5"])(mpmath.mpf(0.9))
        angle, spin = column(answer, "arm.angle"), column(answer, "arm.angular_velocity")
        assert abs(angle.values[0] - a) <= angle.error < 1e-13
        assert abs(spin.values[0] - w) <= spin.error
        torque = column(answer, "k.torque")
        assert abs(torque.values[0] + 7 * (a - mpmath.mpf("0.4"))) <= torque.error
        drag = column(answer, "d.torque")
        assert abs(drag.values[0] + mpmath.mpf("0.3") * w) <= drag.error
    assert answer.energy is not None
    assert not answer.energy.conserved


def test_constant_torque_and_force_on_a_pendulum() -> None:
    extra = [
        {"kind": "torque", "body": "arm", "torque": 3},
        {"kind": "force", "place": "arm", "force": [1, 2]},
    ]
    answer = solve_scene(physical(extra), [0.0])
    assert answer.accelerations is not None
    # About the pivot: the torque, and the force on the arm (0, -0.5).
    assert answer.accelerations["arm"].angular == pytest.approx((3 + 0.5 * 1) / 0.8, rel=4 * EPS)


def test_damped_oscillator_is_a_closed_form() -> None:
    bodies = {"m": {"mass": 2, "at": [1.5, 0], "velocity": [0.2, 0]}}
    connections = [
        {"kind": "spring", "a": [0, 0], "b": "m", "stiffness": 8, "rest_length": 1},
        {"kind": "damper", "a": [0, 0], "b": "m", "coefficient": 0.4},
        {"kind": "track", "place": "m", "on": {"at": [0, 0], "slope": 0}},
    ]
    times = [0.0, 1.0, 30.0]
    answer = solve_scene(scene(bodies, connections), times)
    assert answer.model.name == "modes"
    with mpmath.workdps(30):
        b, w = mpmath.mpf("0.1"), mpmath.sqrt(4 - mpmath.mpf("0.01"))
        place = column(answer, "m.position")
        for i, t in enumerate(times):
            x = mpmath.exp(-b * t) * (
                mpmath.mpf("0.5") * mpmath.cos(w * t) + (mpmath.mpf("0.2") + b / 2) / w * mpmath.sin(w * t)
            )
            assert abs(place.values[i, 0] - 1 - x) <= place.error < 1e-14
    assert answer.model.apart[0].modes[0][:2] == pytest.approx((float(w), -0.1), rel=4 * EPS)


def test_bead_on_a_rod_that_a_motor_turns() -> None:
    bodies = {"arm": {"mass": 1, "inertia": 1, "at": [0, 0]}, "bead": {"mass": 0.5, "at": [0.1, 0]}}
    connections = [
        {"kind": "pin", "a": "arm", "b": [0, 0]},
        {"kind": "motor", "name": "m", "a": "arm", "rate": 2},
        {"kind": "slider", "name": "s", "a": "bead", "b": "arm", "slope": 0},
    ]
    answer = solve_scene(scene(bodies, connections, (0, 0)), [0.0, 1.0, 1.5], ("trajectory", "forces-in-time"))
    place, torque, side = (column(answer, name) for name in ("bead.position", "m.torque", "s.normal"))
    for i, t in enumerate((0.0, 1.0, 1.5)):
        r = 0.1 * math.cosh(2 * t)
        assert place.values[i] == pytest.approx((r * math.cos(2 * t), r * math.sin(2 * t)), abs=1e-13)
        # N = 2 m r' w, and the motor balances it.
        n = 2 * 0.5 * 0.2 * math.sinh(2 * t) * 2
        assert side.values[i] == pytest.approx(n, abs=1e-12)
        assert torque.values[i] == pytest.approx(n * r, abs=1e-12)


def test_crank_and_slider_follow_the_crank() -> None:
    bodies = {
        "crank": {"mass": 1, "inertia": 0.01, "at": [0, 0], "places": {"end": [0.3, 0]}},
        "rod": {"mass": 1, "inertia": 0.1, "at": [0.8, 0], "places": {"l": [-0.5, 0], "r": [0.5, 0]}},
        "piston": {"mass": 2, "at": [1.3, 0]},
    }
    connections = [
        {"kind": "pin", "a": "crank", "b": [0, 0]},
        {"kind": "motor", "a": "crank", "rate": 3},
        {"kind": "pin", "a": "rod.l", "b": "crank.end"},
        {"kind": "pin", "a": "rod.r", "b": "piston"},
        {"kind": "slider", "a": "piston", "b": [0, 0], "slope": 0},
    ]
    times = np.linspace(0, 3, 13)
    answer = solve_scene(scene(bodies, connections), times)
    place, angle = column(answer, "piston.position"), column(answer, "crank.angle")
    expected = 0.3 * np.cos(3 * times) + np.sqrt(1 - (0.3 * np.sin(3 * times)) ** 2)
    assert np.abs(place.values[:, 0] - expected).max() <= place.error + 4e-16
    assert np.abs(angle.values - 3 * times).max() <= angle.error + 1e-15
    assert answer.model.degrees_of_freedom == 0


def test_bead_on_a_parabola() -> None:
    bead = {"bead": {"mass": 1, "at": [1, 0.5]}}
    track = {"kind": "track", "name": "t", "place": "bead", "on": {"at": [0, 0], "curvature": 1}}
    answer = solve_scene(scene(bead, [track]), [0.8])
    assert answer.model.name == "one period"
    with mpmath.workdps(25):

        def rate(x: Any, u: Any) -> list[Any]:
            return [u, -(x * u * u + mpmath.mpf("9.81") * x) / (1 + x * x)]

        x, _ = flow(rate, ["1", "0"])(mpmath.mpf(0.8))
        place = column(answer, "bead.position")
        assert mpmath.hypot(place.values[0, 0] - x, place.values[0, 1] - x * x / 2) <= place.error < 1e-14


def test_track_on_a_body_that_turns() -> None:
    # A bead on a circle of a disc that a motor turns slips without friction: it does not see the turning.
    bodies = {
        "disc": {"mass": 1, "inertia": 1, "at": [0, 0]},
        "bead": {"mass": 1, "at": ["sin(0.5)", "-cos(0.5)"]},
    }
    connections = [
        {"kind": "pin", "a": "disc", "b": [0, 0]},
        {"kind": "motor", "a": "disc", "rate": 5},
        {"kind": "track", "place": "bead", "on": {"at": "disc.centre", "radius": 1}},
    ]
    answer = solve_scene(scene(bodies, connections), [2.0])
    alone = solve_scene(read(points((1,), ("0.5",), (1,))), [2.0])
    assert column(answer, "bead.position").values == pytest.approx(column(alone, "p0.position").values, abs=4e-15)


def test_particle_on_a_turntable_goes_straight_in_space() -> None:
    bodies = {"p": {"mass": 1, "at": [1, 0], "velocity": [0.2, "0.3 - 2*1"]}}
    frame = {"kind": "spinning-frame", "rate": 2, "about": "normal"}
    times = [0.0, 0.5, 4.0]
    answer = solve_scene(scene(bodies, [frame], (0, 0)), times)
    place = column(answer, "p.position")
    assert answer.model.name == "modes"
    for i, t in enumerate(times):
        x, y = 1 + 0.2 * t, 0.3 * t
        c, s = math.cos(2 * t), math.sin(2 * t)
        assert place.values[i] == pytest.approx((c * x + s * y, -s * x + c * y), abs=4e-15)


def test_loose_pulley_moves_half_as_fast() -> None:
    bodies = {"p": {"mass": 3, "at": [0, -1]}, "b": {"mass": 1, "at": [0.5, -1]}}
    string = {"kind": "string", "name": "s", "through": [[0, 0], "p", [0, 0], [0.5, 0], "b"]}
    answer = solve_scene(scene(bodies, [string]))
    tension = 3 * 3 * 1 * G / (3 + 4 * 1)
    assert answer.model.name == "constant acceleration"
    assert force(answer, "s.tension") == pytest.approx(tension, rel=4 * EPS)
    assert linear(answer, "p")[1] == pytest.approx(2 * tension / 3 - G, rel=1e-14)
    assert linear(answer, "b")[1] == pytest.approx(tension - G, rel=1e-14)


def test_double_atwood_machine_in_decimals_has_two_degrees_of_freedom() -> None:
    bodies = {
        "top": {"mass": 0, "inertia": 0, "radius": 0.1, "at": [0, 0]},
        "low": {"mass": 0, "inertia": 0, "radius": 0.05, "at": [0.1, -0.9]},
        "a": {"mass": 4, "at": [-0.1, -1]},
        "b": {"mass": 1, "at": [0.05, -1.7]},
        "c": {"mass": 2, "at": [0.15, -1.9]},
    }
    connections = [
        {"kind": "pin", "a": "top", "b": [0, 0]},
        {"kind": "string", "name": "s", "through": ["a", "top", "low.centre"], "sides": {"top": ["left", "right"]}},
        {"kind": "string", "name": "u", "through": ["b", "low", "c"], "sides": {"low": ["left", "right"]}},
    ]
    answer = solve_scene(scene(bodies, connections))
    # The loose side weighs as 4 m1 m2/(m1 + m2).
    weight = 4 * 1 * 2 / 3
    a = G * (weight - 4) / (weight + 4)
    assert answer.model.degrees_of_freedom == 2
    assert answer.model.name == "constant acceleration"
    assert linear(answer, "a")[1] == pytest.approx(a, rel=1e-14)
    assert force(answer, "u.1.tension") == pytest.approx(2 * 1 * 2 / 3 * (G - a), rel=1e-14)


def test_belt_between_two_drums() -> None:
    bodies = {
        "p": {"mass": 1, "inertia": 0.5, "radius": 0.2, "at": [0, 0], "angular_velocity": 3},
        "q": {"mass": 1, "inertia": 0.1, "radius": 0.1, "at": [1, 0]},
    }
    connections = [
        {"kind": "pin", "a": "p", "b": [0, 0]},
        {"kind": "pin", "a": "q", "b": [1, 0]},
        {"kind": "string", "name": "s", "through": ["p", "q"], "sides": {"p": "above", "q": "above"}},
        {"kind": "torque", "body": "q", "torque": -0.2},
    ]
    answer = solve_scene(scene(bodies, connections), [0.0, 1.0])
    spin = column(answer, "q.angular_velocity")
    assert spin.values[0] == pytest.approx(6, rel=4 * EPS)
    # I_p w_p' = -R T, I_q w_q' = r T + torque, R w_p = r w_q; T > 0 pulls both.
    wp, t = np.linalg.solve([[0.5, 0.2], [0.1 * 2, -0.1]], [0, -0.2])
    assert answer.forces is not None
    assert abs(force(answer, "s.tension")) == pytest.approx(abs(t), rel=1e-13)
    assert answer.accelerations is not None
    assert answer.accelerations["p"].angular == pytest.approx(wp, rel=1e-13)


def test_welded_bodies_swing_as_one() -> None:
    bodies = {
        "rod": {"mass": 1, "inertia": 0.1, "at": [0.5, 0], "places": {"top": [-0.5, 0], "end": [0.5, 0]}},
        "bob": {"mass": 2, "at": [1, 0]},
    }
    connections = [
        {"kind": "pin", "a": "rod.top", "b": [0, 0]},
        {"kind": "weld", "a": "bob", "b": "rod.end"},
    ]
    answer = solve_scene(scene(bodies, connections), [1.0])
    inertia, moment = 0.1 + 0.25 + 2, 0.5 + 2
    assert answer.accelerations is not None
    assert answer.accelerations["rod"].angular == pytest.approx(-moment * G / inertia, rel=4 * EPS)
    assert answer.model.coordinates == 2


def spherical(x: Any, u: Any) -> Any:
    with mpmath.workdps(25):

        def rate(*y: Any) -> list[Any]:
            q, v = y[:3], y[3:]
            pull = sum(w * w for w in v) - mpmath.mpf("9.81") * q[2]
            return [*v, -q[0] * pull, -q[1] * pull, -q[2] * pull - mpmath.mpf("9.81")]

        return flow(rate, [*x, *u])


@pytest.mark.parametrize("centre", [("0", "0"), ("0.3", "-7")])
def test_spherical_pendulum_repeats_up_to_a_turn(centre: tuple[str, str]) -> None:
    at = [f"0.6 + {centre[0]}", centre[1], -0.8]
    bob = {"mass": 1, "at": at, "velocity": [0.4, 1.5, 0.3]}
    rod = {"kind": "rod", "name": "r", "a": "bob", "b": [centre[0], centre[1], 0]}
    answer = solve_scene(scene({"bob": bob}, [rod], (0, 0, -9.81)), [1.1, 30.0])
    assert answer.model.name == "one period"
    place = column(answer, "bob.position")
    with mpmath.workdps(25):
        expected = spherical(["0.6", "0", "-0.8"], ["0.4", "1.5", "0.3"])(mpmath.mpf(1.1))
        away = [place.values[0, i] - expected[i] - (mpmath.mpf(centre[i]) if i < 2 else 0) for i in range(3)]
        assert mpmath.norm(away) <= place.error < 1e-13


def heavy_top(moments: list[float], tip: list[float], omega: list[float]) -> Any:
    """Euler and Poisson: I w' = (I w) x w + m g (n x arm) with n the downward vertical in body axes."""
    with mpmath.workdps(25):
        i = [mpmath.mpf(str(x)) for x in moments]
        d = [-mpmath.mpf(str(x)) for x in tip]
        full = [i[k] + d[(k + 1) % 3] ** 2 + d[(k + 2) % 3] ** 2 for k in range(3)]
        tensor = mpmath.matrix(3)
        for a in range(3):
            for b in range(3):
                tensor[a, b] = full[a] if a == b else -d[a] * d[b]
        inverse = tensor**-1

        def cross(p: Any, q: Any) -> list[Any]:
            return [p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3] for k in range(3)]

        def rate(*y: Any) -> list[Any]:
            w, n = y[:3], y[3:]
            momentum = tensor * mpmath.matrix(list(w))
            weight = cross(d, [mpmath.mpf("9.81") * x for x in n])
            total = mpmath.matrix([a + b for a, b in zip(cross(list(momentum), w), weight, strict=True)])
            return [*(inverse * total), *cross(n, w)]

        return flow(rate, [*map(str, omega), "0", "0", "-1"])


def test_asymmetric_heavy_top_on_a_ball_joint() -> None:
    moments, tip, omega = [0.03, 0.05, 0.06], [0.01, 0.02, -0.2], [1.0, -2.0, 9.0]
    top = {"mass": 1, "moments": moments, "at": [-x for x in tip], "angular_velocity": omega, "places": {"tip": tip}}
    joint = {"kind": "ball-joint", "name": "j", "a": "top.tip", "b": [0, 0, 0]}
    answer = solve_scene(scene({"top": top}, [joint], (0, 0, -9.81)), [0.0, 0.6])
    assert answer.model.name == "Euler-Poisson"
    assert answer.model.degrees_of_freedom == 3
    spin, attitude = column(answer, "top.angular_velocity"), column(answer, "top.attitude")
    with mpmath.workdps(25):
        expected = heavy_top(moments, tip, omega)(mpmath.mpf(0.6))
        assert mpmath.norm([spin.values[1, k] - expected[k] for k in range(3)]) <= spin.error < 1e-11
        w, x, y, z = attitude.values[1]
        down = [-2 * (x * z - w * y), -2 * (y * z + w * x), -(w * w - x * x - y * y + z * z)]
        assert [float(expected[3 + k]) for k in range(3)] == pytest.approx(down, abs=4 * attitude.error)


def test_hinge_in_space_swings_as_in_the_plane() -> None:
    arm = {"mass": 2, "moments": [0.3, 0.1, 0.25], "at": [0, 0, -0.5], "places": {"top": [0, 0, 0.5]},
           "angular_velocity": [4, 0, 0]}  # fmt: skip
    hinge = {"kind": "pin", "a": "arm.top", "b": [0, 0, 0], "axis": [1, 0, 0]}
    answer = solve_scene(scene({"arm": arm}, [hinge], (0, 0, -9.81)), [0.5])
    plane = solve_scene(physical([], angular_velocity=4), [0.5])
    assert answer.model.degrees_of_freedom == 1
    assert answer.period == pytest.approx(plane.period or 0, rel=1e-15)
    # Turned about x, what is to the right in the plane is y in space.
    x, z = column(plane, "arm.position").values[0]
    assert column(answer, "arm.position").values[0] == pytest.approx((0, x, z), abs=1e-15)


def test_bodies_of_the_catalogue_bring_their_mass_properties() -> None:
    brick = Cuboid(edges=(1.0, 2.0, 3.0), mass=2.0)
    body = SceneBody(at=(0, 0, -1), body=brick, places={"top": (0, 0, 1)}, angular_velocity=(1, 0, 0))
    joint = Pin(a="brick.top", b=(0, 0, 0), axis=(1, 0, 0))
    answer = solve_scene(Scene({"brick": body}, (joint,), (0, 0, -9.81)))
    assert answer.energy is not None
    # I about the hinge: m (2^2 + 3^2)/12 + m 1^2
    assert answer.energy.kinetic == pytest.approx((2 * 13 / 12 + 2) / 2, rel=4 * EPS)


def test_velocities_left_out_follow_with_least_energy() -> None:
    bodies = {"a": {"mass": 1, "at": [0, 0], "velocity": [0, 3]}, "b": {"mass": 2, "at": [1, 0]}}
    answer = solve_scene(scene(bodies, [{"kind": "rod", "a": "a", "b": "b"}], (0, 0)), [0.0])
    # Nothing ties b across the rod: the least energy leaves it at rest.
    assert column(answer, "b.velocity").values[0] == pytest.approx((0, 0), abs=1e-300)
    bodies["a"]["velocity"] = [3, 0]
    answer = solve_scene(scene(bodies, [{"kind": "rod", "a": "a", "b": "b"}], (0, 0)), [0.0])
    assert column(answer, "b.velocity").values[0] == pytest.approx((3, 0), abs=1e-300)


DOWN = (0, 0, -9.81)


def test_block_on_a_plane_in_space() -> None:
    block = {"b": {"mass": 2, "at": [0, 0, 0]}}
    track = {"kind": "track", "name": "t", "place": "b", "on": {"at": [0, 0, 0], "normal": [1, 0, 1]}}
    answer = solve_scene(scene(block, [track], DOWN))
    assert answer.model.name == "constant acceleration"
    assert linear(answer, "b") == pytest.approx((G / 2, 0, -G / 2), rel=4 * EPS)
    assert force(answer, "t.normal") == pytest.approx(2 * G * math.sqrt(0.5), rel=4 * EPS)


def test_bead_on_a_line_in_space() -> None:
    bead = {"b": {"mass": 2, "at": [0, 0, 0]}}
    track = {"kind": "track", "name": "t", "place": "b", "on": {"at": [0, 0, 0], "direction": [0, 3, -4]}}
    answer = solve_scene(scene(bead, [track], DOWN))
    assert linear(answer, "b") == pytest.approx((0, -0.8 * -0.6 * G, -0.8 * 0.8 * G), rel=4 * EPS)


def test_rigid_body_on_a_slider_in_space_does_not_turn() -> None:
    body = {"b": {"mass": 2, "moments": [1, 2, 2.5], "at": [0, 0, 0], "places": {"p": [0.1, 0.2, 0.3]}}}
    slider = {"kind": "slider", "name": "s", "a": "b.p", "b": ["0.1", "0.2", "0.3"], "direction": [1, 0, -1]}
    answer = solve_scene(scene(body, [slider], DOWN))
    assert answer.model.degrees_of_freedom == 1
    assert linear(answer, "b") == pytest.approx((G / 2, 0, -G / 2), rel=4 * EPS)
    assert answer.accelerations is not None
    assert answer.accelerations["b"].angular == (0, 0, 0)


def test_sphere_for_a_track_is_a_spherical_pendulum() -> None:
    bob = {"mass": 1, "at": [0.6, 0, -0.8], "velocity": [0.4, 1.5, 0.3]}
    track = {"kind": "track", "name": "t", "place": "bob", "on": {"at": [0, 0, 0], "radius": 1}}
    rod = {"kind": "rod", "name": "t", "a": "bob", "b": [0, 0, 0]}
    first, second = (solve_scene(scene({"bob": bob}, [held], DOWN), [1.1]) for held in (track, rod))
    assert np.array_equal(column(first, "bob.position").values, column(second, "bob.position").values)
    assert force(first, "t.normal") == -force(second, "t.force")


def test_bodies_welded_in_space_swing_as_one() -> None:
    bodies = {
        "rod": {"mass": 1, "moments": [0.2, 0.3, 0.25], "at": [0, 0.5, 0], "places": {"top": [0, -0.5, 0]}},
        "bob": {"mass": 2, "moments": [0.1, 0.1, 0.1], "at": [0, 1, 0]},
    }
    connections = [
        {"kind": "pin", "a": "rod.top", "b": [0, 0, 0], "axis": [1, 0, 0]},
        {"kind": "weld", "a": "bob", "b": "rod"},
    ]
    answer = solve_scene(scene(bodies, connections, DOWN))
    # About the hinge: 0.2 + 0.25 + 0.1 + 2, and the moment of the weights 0.5 + 2.
    assert answer.accelerations is not None
    assert answer.accelerations["rod"].angular == pytest.approx((-2.5 * G / 2.55, 0, 0), rel=4 * EPS, abs=1e-15)
    assert answer.accelerations["bob"].angular == pytest.approx((-2.5 * G / 2.55, 0, 0), rel=4 * EPS, abs=1e-15)


def test_spring_in_space_pulls_along_itself() -> None:
    bob = {"mass": 2, "at": [1, 2, 2]}
    spring = {"kind": "spring", "name": "s", "a": "bob", "b": [0, 0, 0], "stiffness": 6, "rest_length": 2}
    answer = solve_scene(scene({"bob": bob}, [spring], (0, 0, 0)))
    assert force(answer, "s.force") == pytest.approx(6, rel=4 * EPS)
    assert linear(answer, "bob") == pytest.approx((-1, -2, -2), rel=4 * EPS)


def test_torque_in_space_turns_by_euler() -> None:
    body = {"b": {"mass": 1, "moments": [1, 2, 2.5], "at": [0, 0, 0], "angular_velocity": [1, 2, 3]}}
    answer = solve_scene(scene(body, [{"kind": "torque", "body": "b", "torque": [0.1, 0.2, 0.3]}], (0, 0, 0)))
    assert answer.accelerations is not None
    expected = ((0.1 - 0.5 * 6) / 1, (0.2 + 1.5 * 3) / 2, (0.3 - 1 * 2) / 2.5)
    assert answer.accelerations["b"].angular == pytest.approx(expected, rel=1e-14)


def test_frame_that_spins_in_space() -> None:
    # About the hinge: I_x a'' = -m g l sin(a) + W^2 (I_y - I_z) sin(a) cos(a)
    arm = {
        "mass": 2,
        "moments": [0.3, 0.28, 0.05],
        "at": [0, "0.5*sin(1)", "-0.5*cos(1)"],
        "axes": [[1, 0, 0], [0, "cos(1)", "sin(1)"], [0, "-sin(1)", "cos(1)"]],
        "places": {"top": [0, 0, 0.5]},
    }
    connections = [
        {"kind": "pin", "a": "arm.top", "b": [0, 0, 0], "axis": [1, 0, 0]},
        {"kind": "spinning-frame", "rate": 4},
    ]
    answer = solve_scene(scene({"arm": arm}, connections, DOWN), [0.6])
    ix, iy, iz = 0.3 + 0.5, 0.28 + 0.5, 0.05
    expected = (-2 * G * 0.5 * math.sin(1) + 16 * (iy - iz) * math.sin(1) * math.cos(1)) / ix
    assert answer.accelerations is not None
    assert answer.accelerations["arm"].angular == pytest.approx((expected, 0, 0), rel=1e-14, abs=1e-14)
    with mpmath.workdps(25):

        def rate(a: Any, w: Any) -> list[Any]:
            pull = mpmath.mpf("9.81") * mpmath.sin(a)
            return [w, (-pull + 16 * mpmath.mpf("0.73") * mpmath.sin(a) * mpmath.cos(a)) / mpmath.mpf("0.8")]

        a, _ = flow(rate, ["1", "0"])(mpmath.mpf(0.6))
        place = column(answer, "arm.position")
        assert abs(place.values[0, 1] - mpmath.sin(a) / 2) <= place.error < 1e-13


def hoop(*, welded: bool) -> dict[str, Any]:
    """A hoop that rolls with a load on its rim; a part of its mass may be a disc that is welded to its centre."""
    whole = {"mass": 3, "radius": 0.5, "inertia": 0.5, "at": [0, 0.5], "places": {"rim": [0.5, 0]}}
    bodies: dict[str, Any] = {"hoop": whole, "load": {"mass": 0.5, "at": [0.5, 0.5]}}
    connections: list[dict[str, Any]] = [
        {"kind": "rolling", "place": "hoop", "on": {"at": [0, 0]}},
        {"kind": "pin", "a": "load", "b": "hoop.rim"},
    ]
    if welded:
        bodies["hoop"] = whole | {"mass": 1, "inertia": 0.25}
        bodies["disc"] = {"mass": 2, "inertia": 0.25, "at": [0, 0.5], "angle": 1}
        connections.append({"kind": "weld", "a": "disc", "b": "hoop.centre"})
    return {"gravity": [0, -9.81], "bodies": bodies, "connections": connections}


def test_a_disc_welded_to_the_centre_of_a_wheel_turns_with_it() -> None:
    one, two = (solve_scene(read(hoop(welded=welded)), [0.3, 2.0]) for welded in (False, True))
    assert (one.model.name, two.model.name) == ("one period", "one period")
    assert one.period == pytest.approx(two.period, rel=1e-15)
    for name in ("hoop.angle", "load.position", "load.velocity"):
        away = column(one, name).values - column(two, name).values
        assert np.abs(away).max() <= column(one, name).error + column(two, name).error
    turned = column(two, "disc.angle")
    assert turned.values == pytest.approx(column(two, "hoop.angle").values + 1, abs=4e-15)


def test_a_spool_of_two_welded_wheels_is_uniformly_accelerated() -> None:
    """(M + I/R^2 + m (1 - r/R)^2) a = m g (1 - r/R)."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "flange": {"mass": 2, "radius": 0.2, "inertia": 0.03, "at": [0, 0.2]},
            "axle": {"mass": 0, "radius": 0.1, "inertia": 0, "at": [0, 0.2]},
            "weight": {"mass": 1, "at": [1, -0.5]},
        },
        "connections": [
            {"kind": "weld", "a": "axle", "b": "flange"},
            {"kind": "rolling", "place": "flange", "on": {"at": [0, 0]}},
            {"kind": "string", "through": ["axle", [1, 0.1], "weight"], "sides": {"axle": "below"}},
        ],
    }
    answer = solve_scene(read(scene))
    assert answer.model.name == "constant acceleration"
    assert (answer.model.coordinates, answer.model.rows) == (1, 0)
    assert linear(answer, "flange") == pytest.approx((9.81 / 6, 0), rel=1e-15)


@pytest.mark.parametrize("rate", [2, -0.7])
def test_a_rod_with_a_counted_turn_swings_in_a_spinning_frame(rate: float) -> None:
    """About a pivot P off the axis of the frame: (I + m h^2) a'' = -m rate^2 h |P| sin a - k (a - a_0), by mpmath."""
    start, stiffness, half, mass, inertia = 0.8, 1.5, 0.5, 2, 0.3
    rod = {
        "mass": mass,
        "inertia": inertia,
        "at": [f"1 + {half}*cos({start})", f"{half}*sin({start})"],
        "angle": start,
        "places": {"end": [-half, 0]},
        "angular_velocity": 0.4,
    }
    connections = [
        {"kind": "pin", "a": "rod.end", "b": [1, 0]},
        {"kind": "torsion-spring", "a": "rod", "stiffness": stiffness},
        {"kind": "spinning-frame", "rate": rate, "about": "normal"},
    ]
    answer = solve_scene(read({"gravity": [0, 0], "bodies": {"rod": rod}, "connections": connections}), [0.7])
    with mpmath.workdps(25):
        pull, whole = mpmath.mpf(mass) * mpmath.mpf(rate) ** 2 * half, inertia + mass * mpmath.mpf(half) ** 2

        def change(_: Any, y: Any) -> Any:
            return [y[1], (-pull * mpmath.sin(y[0]) - stiffness * (y[0] - start)) / whole]

        angle, turn = mpmath.odefun(change, 0, [mpmath.mpf(start), mpmath.mpf("0.4")])(0.7)
    assert float(column(answer, "rod.angle").values[0]) == pytest.approx(float(angle), rel=1e-13)
    assert float(column(answer, "rod.angular_velocity").values[0]) == pytest.approx(float(turn), rel=1e-12)


def test_a_torque_turns_a_wheel_in_a_spinning_frame_as_elsewhere() -> None:
    wheel = {"mass": 1, "radius": 0.2, "inertia": 0.02, "at": [0.5, 0], "angular_velocity": 3}
    connections = [
        {"kind": "pin", "a": "wheel", "b": [0.5, 0]},
        {"kind": "torque", "body": "wheel", "torque": 0.1},
        {"kind": "spinning-frame", "rate": 4, "about": "normal"},
    ]
    answer = solve_scene(read({"gravity": [0, -10], "bodies": {"wheel": wheel}, "connections": connections}), [2.0])
    assert float(column(answer, "wheel.angle").values[0]) == pytest.approx(3 * 2 + 0.1 / 0.02 * 2, rel=1e-14)

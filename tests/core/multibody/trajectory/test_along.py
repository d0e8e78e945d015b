from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp

from core.errors import BudgetExceeded
from core.multibody.solve import solve_scene
from core.multibody.trajectory import integrals
from tests.core.multibody.swings import Swing
from tests.core.multibody.worked_examples import column, points, read

SCENES = Path(__file__).parents[4] / "examples" / "scenes"
ALL = ["trajectory", "energy-in-time", "work-in-time", "paths-in-time"]


def example(name):
    question = json.loads((SCENES / f"{name}.json").read_text())
    return read({key: value for key, value in question.items() if key not in ("times", "outputs")})


@pytest.mark.parametrize(
    "name",
    [
        "damped-oscillator",
        "crank-slider",
        "sphere-on-turntable",
        "double-pendulum",
        "elastic-pendulum",
        "inverted-pendulum-on-torsion-spring",
        "binary-stars",
        "spool",
        "harmonic-ellipse",
    ],
)
def test_what_is_done_on_a_scene_is_what_its_energy_gains(name):
    """Kinetic energy, which is no sum of works, against their sum: forces of constraint do nothing unless driven."""
    answer = solve_scene(example(name), [0.0, 0.4, 1.1, -0.7], ALL)
    kinetic = column(answer, "energy.kinetic")
    works = [one for key, one in answer.trajectory.columns.items() if key.endswith(".work")]
    total = sum(one.values for one in works)
    error = 2 * kinetic.error + sum(one.error for one in works)
    assert kinetic.values - kinetic.values[0] == pytest.approx(total, abs=error)
    assert error < 1e-10 * max(1.0, float(np.abs(kinetic.values).max()))


def test_a_torque_in_space_works():
    body = {"mass": 1, "moments": [1, 2, 3], "at": [0, 0, 0], "angular_velocity": [1, 0.2, 0.3]}
    torque = {"kind": "torque", "name": "t", "body": "b", "torque": [0.5, 1, -2]}
    answer = solve_scene(read({"gravity": [0, 0, 0], "bodies": {"b": body}, "connections": [torque]}), [0.0, 2.0], ALL)
    gain = column(answer, "energy.kinetic").values
    work = column(answer, "t.work")
    assert gain[1] - gain[0] == pytest.approx(work.values[1], abs=work.error + 1e-13)


@pytest.mark.parametrize("time", [0.3, 77.7, 1e6, 1e9, -1e7])
@pytest.mark.parametrize("amplitude", [1, 2.5])
def test_the_path_of_a_pendulum_at_any_horizon_is_that_of_elliptic_functions(amplitude, time):
    """theta = 2 asin(k sn(K - sqrt(g) t, k)) from rest at the amplitude; a period's path is four amplitudes."""
    bob = {"mass": 2, "at": [f"sin({amplitude})", f"-cos({amplitude})"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    scene = read({"gravity": [0, "-9.81"], "bodies": {"bob": bob}, "connections": [rod]})
    path = column(solve_scene(scene, [time], ["paths-in-time"]), "bob.path")
    with mp.workdps(40):
        rate, k = mp.sqrt(mp.mpf("9.81")), mp.sin(mp.mpf(amplitude) / 2)
        quarter = mp.ellipk(k**2) / rate
        halves = mp.floor(abs(time) / (2 * quarter))
        angle = 2 * mp.asin(k * mp.ellipfun("sn", rate * (quarter - abs(time) + 2 * halves * quarter), m=k**2))
        expected = mp.sign(time) * (2 * amplitude * halves + amplitude - angle)
        true = abs(mp.mpf(path.values[0]) - expected)
        assert true <= path.error
        assert path.error <= 1e-13 * abs(expected)


def test_an_integral_of_too_many_pieces_is_refused(monkeypatch):
    """Two pendulums of different periods on one beam repeat together nowhere near."""
    bodies = {f"p{i}": {"mass": 1, "at": [f"{i} + sin(1)*{size}", f"-cos(1)*{size}"]} for i, size in ((0, 1), (1, 1.7))}
    beam = {"mass": 1, "inertia": 1, "at": [0, 0], "places": {"end": [1, 0]}}
    rods = [{"kind": "rod", "a": f"p{i}", "b": place} for i, place in enumerate(("beam", "beam.end"))]
    held = {"kind": "weld", "a": "beam", "b": "ground"}
    scene = read({"gravity": [0, "-9.81"], "bodies": bodies | {"beam": beam}, "connections": [*rods, held]})
    monkeypatch.setattr(integrals, "MOST_POINTS", 4000)
    with pytest.raises(BudgetExceeded):
        solve_scene(scene, [60.0], ["paths-in-time"])


def test_the_path_of_a_pendulum_is_its_arc_in_every_swing():
    answer = solve_scene(read(points((1,), (2.5,), (2,))), [0.0, 40.0], [*ALL])
    period = answer.period
    swings = int(40.0 / period * 2)
    path = column(answer, "p0.path")
    x, y = column(answer, "p0.position").values[1]
    angle = math.atan2(x, -y)
    rest = 2.5 - angle if swings % 2 == 0 else 2.5 + angle
    assert path.values[1] == pytest.approx(5.0 * swings + rest, abs=path.error + 1e-13)
    assert path.error < 1e-11


def test_the_path_of_a_throw_is_the_length_of_its_parabola():
    ball = read({"gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "at": [0, 0], "velocity": [1, 9.81]}}})
    path = column(solve_scene(ball, [2.0, -1.0], ["paths-in-time"]), "b.path")
    with mp.workdps(30):
        speed = lambda t: mp.sqrt(1 + (mp.mpf("9.81") * (1 - t)) ** 2)  # noqa: E731
        exact = [float(mp.quad(speed, [0, 1, 2])), -float(mp.quad(speed, [-1, 0]))]
    assert path.values == pytest.approx(exact, abs=path.error)
    assert path.error < 1e-13


def test_a_path_through_a_place_of_rest_has_a_corner_in_its_speed():
    """Straight up and down again: |v| = g |1 - t|."""
    ball = read({"gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "at": [0, 0], "velocity": [0, 9.81]}}})
    path = column(solve_scene(ball, [1.7], ["paths-in-time"]), "b.path")
    assert path.values[0] == pytest.approx(9.81 / 2 * (1 + 0.49), abs=path.error + 1e-15)
    assert path.error < 1e-12


@pytest.mark.parametrize("speed", [1.9, 0.93, -0.55, 0.054, 0.0027, -3.5e-4, 9.3e-6, -8.1e-7, 4.1e-9])
def test_a_path_turns_back_wherever_the_swing_does(speed):
    """By Jacobi's functions; the speed has a corner at every turn, the first of them soon after the start."""
    swing = Swing(speed)
    times = [0.3, 0.684, 2.0, 5.1, 11.9]
    found = column(solve_scene(swing.scene(), times, ["paths-in-time"]), "bob.path")
    with mp.workdps(40):
        off = max(
            float(abs(swing.path(mp.mpf(t)) - mp.mpf(float(x)))) for t, x in zip(times, found.values, strict=True)
        )
    assert off <= found.error < 1e-13


def test_a_path_turns_back_at_the_top_of_every_throw():
    """h = v^2/2g up and down again, between bounces that keep 0.6 of the speed and across the horizon."""
    ball = {"mass": 1, "at": [0, 0], "velocity": [0, 5]}
    floor = {"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.6}
    scene = read({"gravity": [0, -10], "bodies": {"ball": ball}, "connections": [floor]})
    # At 1.9 s the third flight, of 0.36 s, has lasted 0.3 s.
    found = column(solve_scene(scene, [0.503, 1.9], ["paths-in-time"]), "ball.path")
    assert found.values == pytest.approx(
        [1.25 + 0.5 * 10 * 0.003**2, 2 * 1.25 + 2 * 0.45 + 0.162 + 5 * 0.12**2], abs=1e-14
    )
    assert found.error < 1e-13


def test_the_path_of_an_eccentric_orbit_is_that_of_whole_ellipses():
    """By complete and incomplete elliptic integrals; at its pericentre it goes 1e-9 m in what rounds the period."""
    scene = read(
        {
            "gravity": [0, 0],
            "bodies": {"p": {"mass": 1, "at": [1, 0], "velocity": [0, "sqrt(2*1.9999)"]}},
            "connections": [{"kind": "inverse-square", "a": "p", "b": [0, 0], "strength": 2}],
        }
    )
    times = [5331460.0, 90634812.0, -5331460.0]
    found = column(solve_scene(scene, times, ["paths-in-time"]), "p.path")
    with mp.workdps(60):
        a = 1 / (2 - mp.mpf("1.9999"))
        e, period = 1 - 1 / a, 2 * mp.pi * mp.sqrt(a**3 / 2)
        whole = mp.ellipe(e**2)
        for time, value in zip(times, found.values.tolist(), strict=True):
            count = mp.floor(abs(time) / period)
            mean = 2 * mp.pi * (abs(time) / period - count)
            anomaly = mp.findroot(lambda x, mean=mean: x - e * mp.sin(x) - mean, mp.pi)
            path = a * (4 * count * whole + mp.ellipe(anomaly + mp.pi / 2, e**2) - whole)
            assert abs(mp.sign(time) * path - mp.mpf(value)) <= found.error < 1e-8

"""Described linkages: one angle by Lagrange's equation, closed kinematics, energy.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), problem 8.3 (leaving ladder); J. M. McCarthy, G. S. Soh, Geometric
Design of Linkages (2011), chapter 2 (angles of the four-bar); L. D. Landau, E. M. Lifshitz, Mechanics, section 5,
problem 4 (the governor).
"""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb
from mpmath import asin as mp_asin
from mpmath import cos as mp_cos
from mpmath import diff, mp, mpf, pi
from mpmath import log as mp_log
from mpmath import sin as mp_sin
from mpmath import sqrt as mp_sqrt
from scipy.integrate import solve_ivp

from tests.examples.scene_columns import agree, columns, in_time, observed, stated, swing, swinging, times
from tests.oracles.minimal_coordinates import cos, exact, motion, sin, sqrt

G = 9.81
EXACT = 4 * 2.0**-52


def test_the_ladder_on_rails(answer_of):
    """4/3 phi'' = g sin(phi): a pendulum turned over. Each rail pushes as the centre accelerates."""
    answer = answer_of("scenes/ladder-on-rails")

    def places(a):
        # The pendulum's angle is measured from where the ladder would hang.
        phi = arb.pi() - a
        return {"ladder.position": (sin(phi), cos(phi)), "ladder.angle": arb.pi() / 2 + phi}

    def amplitude():
        return pi - mpf("0.5")

    def square():
        return mpf("9.81") * 3 / 4

    agree(answer, swinging(answer, amplitude, square, places))
    pushes = []
    for t in times(answer):
        a, rate = swing(amplitude, square, t)
        s, c, gain = mp_sin(a), -mp_cos(a), mpf("9.81") * 3 / 4 * mp_sin(a)
        # x = sin(phi), y = cos(phi), phi'' = 3/4 g sin(phi).
        pushes.append([float(-10 * (c * gain - s * rate**2)), float(10 * (mpf("9.81") - s * gain - c * rate**2))])
    pushes = np.array(pushes)
    # The normal of the wall is the direction of its rail, turned counter-clockwise: to the left.
    agree(answer, {"wall.normal": pushes[:, 0], "floor.normal": pushes[:, 1]}, own=1e-13)


def test_the_trammel(answer_of):
    answer = answer_of("scenes/trammel")

    def places(a):
        return {"a.position": (sin(a), 0 * a), "b.position": (0 * a, cos(a))}

    with mp.workdps(40):
        start = [mp_asin(mpf("0.6"))]
    states = motion(lambda a: [(1, sin(a)), (2, cos(a))], lambda a: cos(a) * 2 * G, start, [0], times(answer))
    agree(answer, observed(states, places))
    # (cos^2 + 2 sin^2) a'' = 2 g sin(a) at the start.
    gain = 2 * G * 0.6 / (0.64 + 2 * 0.36)
    assert answer["accelerations"]["a"]["linear"][0] == pytest.approx(0.8 * gain, rel=EXACT)


def test_the_four_bar_linkage(answer_of):
    """The joint of coupler and rocker is where two circles meet; the moments of inertia go with unit vectors."""
    answer = answer_of("scenes/four-bar-linkage")

    def joints(a):
        # By the angle of the rocker: the crank turns back where coupler and rocker are in line.
        q = (cos(a) * sqrt(2) + 3, sin(a) * sqrt(2))
        square = q[0] * q[0] + q[1] * q[1]
        along = (square - 3) / (2 * square)
        across = sqrt(1 / square - along * along)
        return (along * q[0] - across * q[1], along * q[1] + across * q[0]), q

    def places(a):
        p, q = joints(a)
        return {
            "crank.position": (p[0] / 2, p[1] / 2),
            "coupler.position": ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2),
            "rocker.position": ((q[0] + 3) / 2, q[1] / 2),
            "rocker.angle": a,
        }

    def inertias(a):
        p, q = joints(a)
        weights = {"crank": 1, "coupler": 2, "rocker": 1.5}
        centres = [(m, x) for name, m in weights.items() for x in places(a)[f"{name}.position"]]
        crank, coupler = exact(1) / 12, exact(2) / 3 / 4
        turns = [(crank, p[0]), (crank, p[1]), (coupler, q[0] - p[0]), (coupler, q[1] - p[1])]
        return [*centres, *turns, (0.25, a)]

    def potential(a):
        (_, crank), (_, coupler), (_, rocker), _ = places(a).values()
        return crank * G + coupler * (2 * G) + rocker * exact(G) * 1.5

    with mp.workdps(40):
        start = [pi * 3 / 4]
    # The angle of the rocker says which place it is until crank and coupler are in line.
    early = [t for t in times(answer) if t < 0.9]
    found = columns(answer)
    for name, values in observed(motion(inertias, potential, start, [0], early), places).items():
        away = (found[name][: len(early)] - values).reshape(len(early), -1)
        assert np.linalg.norm(away, axis=1).max() <= stated(answer, name)
    # Energy, at all times.
    energy = answer["energy"]["potential"]
    kinetic = sum(
        m / 2 * (found[f"{name}.velocity"] ** 2).sum(axis=1) + i / 2 * found[f"{name}.angular_velocity"] ** 2
        for name, m, i in (("crank", 1, 1 / 12), ("coupler", 2, 2 / 3), ("rocker", 1.5, 1 / 4))
    )
    height = found["crank.position"][:, 1] + 2 * found["coupler.position"][:, 1] + 1.5 * found["rocker.position"][:, 1]
    np.testing.assert_allclose(kinetic + G * height, energy, rtol=1e-14)


def test_the_crank_slider(answer_of):
    """x = r cos + sqrt(l^2 - r^2 sin^2); the motor gives what the energy takes, over its rate."""
    answer = answer_of("scenes/crank-slider")

    def places(t):
        x, y = cos(10 * t) / 5, sin(10 * t) / 5
        reach = sqrt(exact(0.36) - y * y)
        return {
            "piston.position": (x + reach, 0 * x),
            "rod.position": (x + reach / 2, y / 2),
            "rod.angle": -(y / exact(0.6)).asin(),
            "crank.angle": 10 * t,
        }

    agree(answer, in_time(answer, places))

    def energy(t):
        def x(s):
            return mp_cos(10 * s) / 5

        def y(s):
            return mp_sin(10 * s) / 5

        def reach(s):
            return mp_sqrt(mpf("0.36") - y(s) ** 2)

        parts = (
            (mpf("0.8"), lambda s: x(s) + reach(s)),
            (mpf("0.5"), lambda s: x(s) + reach(s) / 2),
            (mpf("0.5"), lambda s: y(s) / 2),
            (mpf("0.015"), lambda s: mp_asin(y(s) / mpf("0.6"))),
        )
        return sum(m / 2 * diff(part, t) ** 2 for m, part in parts) + mpf("0.5") * mpf("9.81") * y(t) / 2

    with mp.workdps(60):
        torque = [float(diff(energy, mpf(t)) / 10) for t in times(answer)]
    agree(answer, {"motor-2.torque": torque})


def test_the_centrifugal_governor(answer_of):
    """It rests where cos(theta) = (m + M) g/(m W^2 l), M the sleeve's mass."""
    answer = answer_of("scenes/centrifugal-governor")

    def places(a):
        return {
            "left.position": (-(sin(a) / 2), -(cos(a) / 2)),
            "right.position": (sin(a) / 2, -(cos(a) / 2)),
            "sleeve.position": (0 * a, -cos(a)),
        }

    def inertias(a):
        found = places(a)
        return [(1, x) for name in ("left.position", "right.position") for x in found[name]] + [(2, cos(a))]

    def potential(a):
        return -(cos(a) * 3 * G) - sin(a) * sin(a) * 25

    with mp.workdps(40):
        start = [mp_asin(mpf("0.6"))]
    states = motion(inertias, potential, start, [0], times(answer))
    agree(answer, observed(states, places))
    c = 3 * G / 50
    open_ones = [one for one in answer["equilibria"] if abs(one["positions"]["sleeve"][1] + c) < 1e-9]
    for one in open_ones:
        assert one["stable"]
        assert abs(one["positions"]["left"][0]) == pytest.approx((1 - c * c) ** 0.5 / 2, rel=1e-13)
        # (2 m l^2 + M (2 l)^2 sin^2) w^2 = V'' of V = -3 g cos - 25 sin^2.
        square = (3 * G * c - 50 * (2 * c * c - 1)) / (0.5 + 2 * (1 - c * c))
        assert one["modes"][0]["frequency"] == pytest.approx(square**0.5, rel=1e-12)
    # Each ball to the left or to the right.
    assert len(open_ones) == 4


def test_the_damped_governor(answer_of):
    """Lagrange's equation of the angle of its rods, by scipy's implicit method of order 5 to 1e-11."""
    answer = answer_of("scenes/damped-governor")

    def change(_, state):
        a, rate = state
        s, c = np.sin(a), np.cos(a)
        # The spring is 3 - cos(a) long, and the damper as well.
        slope = 3 * G * s - 50 * s * c + 8e4 * (3 - c - 2.4) * s
        return [rate, (-slope - 4e4 * (s * rate) * s - 2 * s * c * rate**2) / (0.5 + 2 * s * s)]

    asked = times(answer)
    right = solve_ivp(change, (0, asked[-1]), [np.arcsin(0.6), 0], "Radau", asked, rtol=1e-11, atol=1e-13).y
    found = columns(answer)
    assert np.abs(found["sleeve.position"][:, 1] + np.cos(right[0])).max() < 1e-12
    assert np.abs(found["sleeve.velocity"][:, 1] - np.sin(right[0]) * right[1]).max() < 1e-11


def test_the_rod_in_a_cylinder_agrees_with_the_named_scene(answer_of):
    answer, named = answer_of("scenes/rod-in-cylinder"), answer_of("scenes/rod-in-hole/swing")

    def places(a):
        k = sqrt(exact(3)) / 2
        return {"rod.position": (k * sin(a), -k * cos(a)), "rod.angle": a}

    agree(answer, swinging(answer, lambda: pi / 3, lambda: mpf("9.81") * mp_sqrt(mpf("0.75")) * 6 / 5, places))
    # The named rod is released at the other rim.
    common = [i for i, t in enumerate(named["trajectory"]["time"]) if t in times(answer)]
    angle = np.array(named["trajectory"]["angle"])[common]
    own = named["accuracy"]["error"] * np.abs(angle).max()
    assert len(common) == 3
    away = np.abs(np.abs(columns(answer)["rod.angle"][: len(common)]) - np.abs(angle)).max()
    assert away <= stated(answer, "rod.angle") + own
    assert answer["period"] == pytest.approx(named["period"], rel=EXACT)
    ends = [answer["forces"][f"{name}.normal"]["value"] for name in ("a", "b")]
    assert sorted(map(abs, ends)) == pytest.approx(sorted(named["forces_at_release"]), rel=EXACT)


def test_a_bead_slides_on_a_rough_ring_by_the_exponential_of_its_angle(answer_of):
    """v' = -mu v^2/r on a level ring: the angle is log(1 + mu v0 t/r)/mu."""
    answer = answer_of("scenes/bead-on-rough-ring")

    def places(t):
        angle = mp_log(1 + mpf("0.3") * 5 * t) / mpf("0.3")
        return [mp_cos(angle), mp_sin(angle)]

    agree(answer, {"bead.position": [places(mpf(t)) for t in times(answer)]}, own=EXACT)
    assert not answer["events"]


def test_a_drawer_that_is_pulled_aside_presses_on_both_ends_of_its_runners(answer_of):
    """A pull P at an arm h: both ends press by P h/L, so that it moves by P (1 - 2 mu h/L)."""
    answer = answer_of("scenes/drawer-pulled-aside")
    gain = 20 * (1 - 2 * mpf("0.3") * mpf("0.15") / mpf("0.4")) / 4
    agree(answer, {"drawer.position": [[gain * mpf(t) ** 2 / 2, 0] for t in times(answer)]}, own=EXACT)
    assert answer["forces"]["runners.normal"]["value"] == pytest.approx(2 * 20 * 0.15 / 0.4, rel=1e-14)
    assert answer["forces"]["runners.friction"]["value"] == pytest.approx(-0.3 * 15, rel=1e-14)

"""Described scenes that roll or slide along curves: Lagrange's equations of one or two coordinates.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, sections 11 (periods by quadrature) and 39; D. Morin, Introduction to Classical
Mechanics (2008), chapters 6 and 8 (beads on wires, rolling cylinders and loaded hoops).
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf, pi, quad
from mpmath import sin as mp_sin
from mpmath import sqrt as mp_sqrt

from tests.examples.scene_columns import agree, columns, in_time, observed, stated, swinging, times
from tests.oracles.minimal_coordinates import cos, exact, motion, sin

G = 9.81
EXACT = 4 * 2.0**-52


def test_a_cylinder_rolls_in_a_hollow_one(answer_of):
    """3/2 m d theta'' = -m g sin(theta), d = R - r; it turns against its way, d/r times as far."""
    answer = answer_of("scenes/cylinder-in-cylinder")

    def places(a):
        d = exact(0.8)
        return {"cylinder.position": (d * sin(a), -d * cos(a)), "cylinder.angle": 4 - 4 * a}

    agree(answer, swinging(answer, 1, lambda: mpf("9.81") / mpf("1.2"), places))
    normal = answer["forces"]["rolling-1.normal"]["value"]
    assert normal == pytest.approx(2 * G * np.cos(1), rel=EXACT)


def test_a_cylinder_rolls_on_one_that_turns(answer_of):
    """Angles a of the line of centres and b of the lower cylinder; the upper turns by -(D a + R b)/r."""
    answer = answer_of("scenes/cylinder-on-cylinder")

    def places(a, b):
        turn = (exact(0.2) - a) * 3 - b * 2
        return {
            "upper.position": (sin(a) * exact(0.75), cos(a) * exact(0.75)),
            "lower.angle": b,
            "upper.angle": turn,
        }

    def inertias(a, b):
        found = places(a, b)
        return [*((1, x) for x in found["upper.position"]), (0.5, b), (0.03125, found["upper.angle"])]

    states = motion(inertias, lambda a, b: cos(a) * G * 0.75, [0.2, 0], [0, 0], times(answer))
    agree(answer, observed(states, places))
    # m (g cos(a) - D a'^2) presses, and the torque about the lower axle is the friction's.
    pressed = [float(G * cos(q[0]) - 0.75 * v[0] ** 2) for q, v in states]
    agree(answer, {"contact.normal": pressed}, own=1e-14)


def test_the_loaded_hoop(answer_of):
    """The hoop rolls by a to the right; its weight goes down with it."""
    answer = answer_of("scenes/loaded-hoop")

    def places(a):
        return {
            "hoop.position": (a / 2, 0 * a + 0.5),
            "load.position": (a / 2 + cos(a) / 2, 0.5 - sin(a) / 2),
            "hoop.angle": -a,
        }

    def inertias(a):
        return [(1, a / 2), (0.25, a), *((0.5, x) for x in places(a)["load.position"])]

    def potential(a):
        return places(a)["load.position"][1] * G * 0.5

    agree(answer, observed(motion(inertias, potential, [0], [0], times(answer)), places))
    # From the level to the level on the other side, half a turn, and back.
    (half,) = motion(inertias, potential, [0], [0], [answer["period"] / 2])
    assert float(half[0][0]) == pytest.approx(np.pi, rel=1e-14)


def test_a_bead_on_a_parabola(answer_of):
    """y = x^2: (1 + 4 x^2) x'^2 = 2 g (1 - x^2), so T = 4 times the integral of sqrt((1 + 4 sin^2)/(2 g))."""
    answer = answer_of("scenes/bead-on-parabola")
    with mp.workdps(30):
        period = 4 * quad(lambda s: mp_sqrt((1 + 4 * mp_sin(s) ** 2) / (2 * mpf("9.81"))), [0, pi / 2])
    assert answer["period"] == pytest.approx(float(period), rel=2.0**-52)
    (bottom,) = answer["equilibria"]
    assert bottom["stable"]
    assert bottom["modes"][0]["frequency"] == pytest.approx((2 * G) ** 0.5, rel=1e-14)

    def places(x):
        return {"bead.position": (x, x * x)}

    early = [t for t in times(answer) if t <= 4]
    states = motion(lambda x: [(1, x), (1, x * x)], lambda x: x * x * G, [1], [0], early)
    expected = observed(states, places)
    found = columns(answer)
    for name, values in expected.items():
        assert np.linalg.norm(found[name][: len(early)] - values, axis=1).max() <= stated(answer, name)
    # Energy, at all times.
    speed, height = (found["bead.velocity"] ** 2).sum(axis=1), found["bead.position"][:, 1]
    np.testing.assert_allclose(speed / 2 + G * height, G, rtol=1e-14)


def test_a_bead_on_a_rotating_rod(answer_of):
    """r = r0 cosh(W t) + v0/W sinh(W t); the rod pushes with 2 m W r'."""
    answer = answer_of("scenes/bead-on-rotating-rod")
    (part,) = answer["model"]["apart"]
    assert sorted(mode["growth_rate"] for mode in part["modes"]) == pytest.approx([-3, 3], rel=EXACT)

    def places(t):
        growing, decaying = (3 * t).exp(), (-3 * t).exp()
        r = (growing + decaying) / 4 + (growing - decaying) / 30
        return {"bead.position": (r, 0 * r)}

    expected = in_time(answer, places)
    expected["rod.normal"] = 0.6 * expected["bead.velocity"][:, 0]
    agree(answer, expected, own=2e-16)

"""Described scenes of masses on springs, rods and strings: closed forms, polar coordinates.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, sections 13 (reduced mass), 14 (central field), 23 (modes), 25 (damping).
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from tests.examples.scene_columns import agree, columns, in_time, observed, times
from tests.oracles.minimal_coordinates import cos, exact, motion, sin, sqrt

G = 9.81
EXACT = 4 * 2.0**-52


def test_the_ellipse_of_a_spring_without_length(answer_of):
    """omega^2 = k/m = 4: x = cos(2 t), y = 3/4 sin(2 t), about the centre."""
    answer = answer_of("scenes/harmonic-ellipse")
    agree(answer, in_time(answer, lambda t: {"bob.position": (cos(2 * t), sin(2 * t) * exact(0.75))}))
    (centre,) = answer["equilibria"]
    assert centre["stable"]
    assert centre["positions"]["bob"] == pytest.approx([0, 0], abs=1e-15)


def test_a_dumbbell_is_thrown(answer_of):
    """The centre of mass falls freely, the rod turns at (6 - 3)/0.6 rad/s and pulls with 2/3 omega^2 l."""
    answer = answer_of("scenes/dumbbell")
    assert answer["forces"]["rod-1.force"]["value"] == pytest.approx(10, rel=EXACT)

    def places(t):
        x, y = exact(0.1) + 2 * t, 1 + 5 * t - exact(G) / 2 * t * t
        u, v = exact(0.2) * cos(5 * t), exact(0.2) * sin(5 * t)
        return {"a.position": (x - 2 * u, y - 2 * v), "b.position": (x + u, y + v)}

    agree(answer, in_time(answer, places))


def test_a_dumbbell_vibrates(answer_of):
    """Distance and direction with the reduced mass 2/3; the centre of mass at 1/6 is at rest."""
    answer = answer_of("scenes/vibrating-dumbbell")

    def apart(r, a):
        return r * cos(a), r * sin(a)

    def places(r, a):
        x, y = apart(r, a)
        return {"a.position": (exact(1) / 6 - x * 2 / 3, -y * 2 / 3), "b.position": (exact(1) / 6 + x / 3, y / 3)}

    def potential(r, a):
        return (r - 0.9) * (r - 0.9) * 15

    states = motion(lambda r, a: [(exact(2) / 3, x) for x in apart(r, a)], potential, [1, 0], [0, 1.5], times(answer))
    agree(answer, observed(states, places))
    found = columns(answer)
    d, rate = (found[f"b.{what}"] - found[f"a.{what}"] for what in ("position", "velocity"))
    np.testing.assert_allclose(d[:, 0] * rate[:, 1] - d[:, 1] * rate[:, 0], 1.5, rtol=1e-14)


def test_two_masses_on_two_springs_have_golden_modes(answer_of):
    """omega = (sqrt(5) -+ 1)/2, shapes (1, phi) and (1, -1/phi), phi the golden ratio."""
    answer = answer_of("scenes/two-masses-two-springs")
    (part,) = answer["model"]["apart"]
    golden = (5**0.5 + 1) / 2
    assert [mode["frequency"] for mode in part["modes"]] == pytest.approx([1 / golden, golden], rel=EXACT)

    def places(t):
        phi, share = (sqrt(exact(5)) + 1) / 2, 1 / sqrt(exact(5)) / 2
        slow, fast = cos(t / phi) * share, cos(t * phi) * share
        return {"first.position": (1 + slow - fast, 0 * t), "second.position": (2 + phi * slow + fast / phi, 0 * t)}

    agree(answer, in_time(answer, places))


def test_the_damped_oscillator(answer_of):
    """u'' + 2 u' + 25 u = 0: exp(-t) (cos(w t) + sin(w t)/w), w^2 = 24, about the elongation g/25."""
    answer = answer_of("scenes/damped-oscillator")
    (part,) = answer["model"]["apart"]
    (mode,) = part["modes"]
    assert (mode["frequency"], mode["growth_rate"]) == pytest.approx((24**0.5, -1), rel=EXACT)

    def places(t):
        rate, mean = sqrt(exact(24)), exact(G) / 25
        gone = (-t).exp() * (cos(rate * t) + sin(rate * t) / rate)
        return {"bob.position": (0 * t, -1 - mean + mean * gone)}

    expected = in_time(answer, places)
    lowered, rate = -expected["bob.position"][:, 1], -expected["bob.velocity"][:, 1]
    agree(answer, expected)
    agree(answer, {"spring-1.force": 25 * (lowered - 1), "damper-2.force": 2 * rate}, own=1e-14)
    hanging, standing = answer["equilibria"]
    assert (hanging["stable"], standing["stable"]) == (True, False)
    assert hanging["positions"]["bob"] == pytest.approx([0, -1 - G / 25], abs=1e-14)


def test_a_weight_under_a_table_holds_a_puck(answer_of):
    """(m + M) r'' = L^2/(m r^3) - M g; the string pulls with M (g + r'')."""
    answer = answer_of("scenes/weight-under-table")

    def places(r, a):
        return {"puck.position": (r * cos(a), r * sin(a), 0 * r), "weight.position": (0 * r, 0 * r, r - 1.5)}

    def inertias(r, a):
        return [(1, r * cos(a)), (1, r * sin(a)), (0.5, r)]

    states = motion(inertias, lambda r, a: r * G * 0.5, [0.5, 0], [0, 4], times(answer))
    agree(answer, observed(states, places))
    with mp.workdps(30):
        pulls = [float((1 / mpf(str(float(q[0]))) ** 3 - mpf(G) / 2) / 3 + mpf(G) / 2) for q, _ in states]
    agree(answer, {"string-2.tension": pulls}, own=4e-14)

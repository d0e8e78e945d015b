"""Described scenes of balls that roll in space: closed forms of rolling with the moment 2/5 m R^2.

References
----------
E. A. Milne, Vectorial Mechanics (1948), sections on rolling spheres (turntable, cylinder). J. I. Neimark, N. A. Fufaev,
Dynamics of Nonholonomic Systems (1972), chapter 3.
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import asin, mpf

from tests.examples.scene_columns import agree, columns, in_time, swinging, times
from tests.oracles.minimal_coordinates import cos, exact, sin, sqrt

G = 9.81
EXACT = 4 * 2.0**-52


def test_a_sphere_rolls_down_an_incline(answer_of):
    """A share 5/7 of g sin(30 degrees) down the slope, and straight on across it."""
    answer = answer_of("scenes/sphere-on-incline")

    def places(t):
        gone = exact(G) * 5 / 28 * t * t
        slope = sqrt(exact(3)) / 2
        return {"ball.position": (exact(0.05) + gone * slope, t, slope / 10 - gone / 2)}

    agree(answer, in_time(answer, places))
    assert answer["forces"]["incline.normal"]["value"] == pytest.approx(0.5 * G * 0.75**0.5, rel=EXACT)
    friction = [answer["forces"][f"incline.friction.{x}"]["value"] for x in "xyz"]
    assert friction == pytest.approx([-0.5 * G / 7 * 0.75**0.5, 0, 0.5 * G / 14], rel=EXACT)


def test_a_sphere_circles_on_a_turntable(answer_of):
    """The velocity turns at 2/7 of the table's rate: a circle, in 7/2 of its turns."""
    answer = answer_of("scenes/sphere-on-turntable")

    def places(t):
        rate = exact(6) / 7
        return {
            "ball.position": (
                1 + (cos(rate * t) - 1) / (2 * rate),
                sin(rate * t) / (2 * rate),
                0 * t + exact(0.1),
            )
        }

    agree(answer, in_time(answer, places))
    found, moments = columns(answer), np.array(times(answer))
    turned = 6 / 7 * moments
    np.testing.assert_allclose(found["table.friction.x"], -1.5 / 7 * np.cos(turned), atol=1e-14)
    np.testing.assert_allclose(found["table.friction.y"], -1.5 / 7 * np.sin(turned), atol=1e-14)
    np.testing.assert_allclose(found["table.normal"], 0.5 * G, rtol=EXACT)
    assert not answer["energy"]["conserved"]


def test_a_ball_in_an_upright_cylinder_comes_up_again(answer_of):
    """Its height swings at sqrt(2/7) of the rate at which it goes round, about 5 g/(2 rate^2) below the start."""
    answer = answer_of("scenes/ball-in-cylinder")

    def places(t):
        rate = exact(20) / 9
        slow = rate * sqrt(exact(2) / 7)
        depth = exact(G) * 5 / (2 * rate * rate)
        return {
            "ball.position": (
                cos(rate * t) * exact(0.9),
                sin(rate * t) * exact(0.9),
                depth * (cos(slow * t) - 1),
            )
        }

    agree(answer, in_time(answer, places))
    np.testing.assert_allclose(columns(answer)["wall.normal"], 0.5 * 4 / 0.9, rtol=1e-13)


def test_a_ball_swings_in_a_bowl(answer_of):
    """A pendulum of 7/5 of the distance of the centres."""
    answer = answer_of("scenes/ball-in-bowl")

    def places(angle):
        return {"ball.position": (sin(angle) * exact(0.9), 0 * angle, -(cos(angle) * exact(0.9)))}

    agree(answer, swinging(answer, lambda: asin(mpf("0.6")), lambda: mpf("9.81") * 5 / 7 / mpf("0.9"), places))
    # At rest it is the weight along the normal, less nothing.
    assert answer["forces"]["bowl.normal"]["value"] == pytest.approx(0.5 * G * 0.8, rel=EXACT)

"""Described coins, stones and wheels that roll on rims and ellipsoids, and a rope that rubs around a bollard."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import exp, mpf, pi
from scipy.linalg import expm

from tests.core.multibody.test_bicycle import linearised
from tests.examples.scene_columns import agree, columns, in_time, times
from tests.oracles.bodies_on_planes import BodyOnPlane, ellipsoid
from tests.oracles.minimal_coordinates import cos, exact, sin

G = 9.81


def test_a_coin_rolls_around_a_circle(answer_of):
    """With its plane inclined by cos c = 4/5 to the vertical it turns at 5 rad/s: E. J. Routh, article 244."""
    answer = answer_of("scenes/coin-rolls-round")
    # The balance of moments for s = -W sin(c)/6 + 4 g tan(c)/(3 W), with R = 1/2, the centre at R s.
    spin = -exact(0.5) + exact(981) / 100 / 5

    def places(t):
        radius = spin / 10
        return {"coin.position": (-radius * sin(5 * t), radius * (cos(5 * t) - 1), 0 * t + exact(0.4))}

    agree(answer, in_time(answer, places))
    assert answer["forces"]["floor.normal"]["value"] == pytest.approx(2 * G, rel=1e-14)


def test_a_rattleback_turns_back(answer_of):
    answer = answer_of("scenes/rattleback")
    tensor = np.array([[0.0006, -0.0004, 0], [-0.0004, 0.005, 0], [0, 0, 0.0055]])
    stone = BodyOnPlane(1.0, tensor, ellipsoid((0.05, 0.2, 0.03)))
    moments, found = times(answer), columns(answer)["stone.angular_velocity"]
    for k in (2, 5):
        _, expected = stone.rolls(np.array([0.0, 0.0, 1.0]), np.array([0.01, 0.01, 5.0]), moments[k])
        assert found[k] == pytest.approx(expected, abs=1e-8)
    assert found[0, 2] > 0 > found[-1, 2]


def test_a_bicycle_steers_itself_upright(answer_of):
    """Leaning by up to 0.002 rad, to the third order of which its linearised equations are right."""
    answer = answer_of("scenes/bicycle")
    lean = 2 * columns(answer)["frame.attitude"][:, 1]
    expected = [(expm(linearised(5.0) * time) @ [0, 0, 0.01, 0])[0] for time in times(answer)]
    assert lean == pytest.approx(expected, abs=1e-6)
    assert abs(lean[-1]) < 0.5 * np.abs(lean).max()


def test_a_weight_slips_down_on_a_rope_around_a_bollard(answer_of):
    """Half a turn and one more: a = g (M - k m)/(M + k m) with k = exp(3 pi mu)."""
    answer = answer_of("scenes/rope-on-bollard")
    k = exp(3 * pi * mpf(3) / 10)
    gain = mpf(981) / 100 * (40 - k) / (40 + k)
    agree(answer, in_time(answer, lambda t: {"heavy.position": (0 * t + exact(0.1), -1 - exact(gain) * t * t / 2)}))
    found = answer["forces"]
    assert found["rope.2.tension"]["value"] / found["rope.1.tension"]["value"] == pytest.approx(float(k), rel=1e-14)

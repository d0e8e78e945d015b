"""Described scenes in which connections begin and end, and blows: conservation laws by hand, and elliptic functions.

References
----------
S. T. Thornton, J. B. Marion, "Classical Dynamics of Particles and Systems" (2004), chapter 9 (ballistic pendulum) and
section 11.12 (centre of percussion); L. D. Landau, E. M. Lifshitz, Mechanics, section 11 (elliptic functions).
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import acos, asin, ellipfun, ellipk, mp, mpf, pi, quad
from mpmath import cos as mp_cos
from mpmath import sin as mp_sin
from mpmath import sqrt as mp_sqrt

from tests.examples.scene_columns import columns, times

G = mpf("9.81")


def agrees(answer, name, expected):
    column = answer["trajectory"]["columns"][name]
    off = np.abs(np.array(column["values"]) - np.array(expected, dtype=np.float64))
    assert off.max() <= column["error"] + 2.0**-50


def from_below(rate, length, time):
    """Return the angle of a pendulum that passes its lowest place at a rate: sin(angle/2) = k sn(omega t, k)."""
    omega = mp_sqrt(G / length)
    k = rate / (2 * omega)
    return 2 * asin(k * ellipfun("sn", omega * time, m=k * k))


def test_a_string_that_breaks(answer_of):
    answer = answer_of("scenes/breaking-string")
    with mp.workdps(30):
        depth = 25 / (3 * G)
        time = quad(lambda s: 2 / mp_sqrt(2 * G * (1 - s**4)), [0, mp_sqrt(depth)])
        (broken,) = answer["events"]
        assert abs(broken["time"] - float(time)) <= broken["error"] + 1e-16
        x, speed = mp_sqrt(1 - depth**2), mp_sqrt(2 * G * depth)
        flying = [k for k, t in enumerate(times(answer)) if t > time]
        late = [mpf(times(answer)[k]) - time for k in flying]
        expected = [[float(x - speed * depth * t), float(-depth - speed * x * t - G / 2 * t * t)] for t in late]
    np.testing.assert_allclose(columns(answer)["bob.position"][flying], expected, atol=1e-14)


def test_a_ballistic_pendulum(answer_of):
    """(M + m) V = m v, and V^2 = 2 g h; the cord takes the velocity with which the bullet falls on its way."""
    answer = answer_of("scenes/ballistic-pendulum")
    with mp.workdps(30):
        late = mpf(10) / 300
        (caught,) = answer["events"]
        assert caught["time"] == pytest.approx(float(late), rel=1e-15)
        speed = mpf("0.01") * 300 / mpf("2.01")
        height = speed**2 / 2 / G
    (swing,) = answer["extremes"]
    assert swing["largest"] == pytest.approx(float(height) - 1, abs=1e-13)
    assert caught["energy_loss"] == pytest.approx(
        float(450 + mpf("0.01") * (G * late) ** 2 / 2 - mpf("2.01") * speed**2 / 2), rel=1e-14
    )


def test_a_pendulum_on_a_nail(answer_of):
    """It rises to the height from which it came, whatever the length; then from the lowest place as a short one."""
    answer = answer_of("scenes/pendulum-on-a-nail")
    with mp.workdps(30):
        quarter = ellipk(mp_sin(pi / 12) ** 2) / mp_sqrt(G)
        assert [(one["kind"], one["name"]) for one in answer["events"]] == [("end", "long"), ("begin", "short")]
        assert answer["events"][0]["time"] == pytest.approx(float(quarter), rel=1e-15)
        rate = mp_sqrt(2 * G * (1 - mp_cos(pi / 6))) / mpf("0.5")
        after = [k for k, t in enumerate(times(answer)) if t > quarter]
        angles = [from_below(rate, mpf("0.5"), mpf(times(answer)[k]) - quarter) for k in after]
        expected = [[float(-mp_sin(a) / 2), float(-mpf("0.5") - mp_cos(a) / 2)] for a in angles]
        assert max(angles) <= acos(1 - 2 * (1 - mp_cos(pi / 6)))
    np.testing.assert_allclose(columns(answer)["bob.position"][after], expected, atol=1e-14)
    (extremes,) = answer["extremes"]
    assert extremes["largest"] == pytest.approx(-float(mp_cos(pi / 6)), rel=1e-14)


def test_a_rod_that_is_struck_at_its_end(answer_of):
    """J L = I omega with I = M L^2/3, and the hinge takes M omega L/2 - J."""
    answer = answer_of("scenes/struck-rod")
    (blow,) = answer["events"]
    assert blow["impulses"] == {"x": 2.0, "y": 0.0, "hinge.x": pytest.approx(1.0, rel=1e-14)}
    with mp.workdps(30):
        # A rod swings as a point at two thirds of its length.
        expected = [float(from_below(mpf(2), mpf(2) / 3, mpf(t)) - pi / 2) for t in times(answer)]
    agrees(answer, "rod.angle", expected)

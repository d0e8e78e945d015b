"""The described scenes that the documentation shows, against closed forms and other coordinates."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import cos as mp_cos
from mpmath import mp, mpf, pi, quad, sqrt

from tests.examples.scene_columns import agree, columns, observed, stated, times
from tests.oracles.minimal_coordinates import cos, motion, sin

G = 9.81


def test_the_massive_pulley_is_uniformly_accelerated(answer_of):
    """Newton's law by hand: a = (m2 - m1) g/(m1 + m2 + I/r^2), and each straight part has its own tension."""
    answer = answer_of("scenes/massive-pulley")
    a = 1 * G / (3 + 0.0025 / 0.1**2)
    assert answer["model"]["name"] == "constant acceleration"
    assert (answer["model"]["degrees_of_freedom"], answer["model"]["described"]) == (1, [11, 8])
    assert answer["accelerations"]["b"]["linear"] == [0.0, pytest.approx(-a, rel=1e-15)]
    assert answer["accelerations"]["wheel"]["angular"] == pytest.approx(-a / 0.1, rel=1e-15)
    tensions = [answer["forces"][f"string-2.{i}.tension"] for i in (1, 2)]
    assert [one["value"] for one in tensions] == pytest.approx([1 * (G + a), 2 * (G - a)], rel=1e-15)
    assert all(one["determined"] and one["unit"] == "N" for one in tensions)
    time = np.array(answer["trajectory"]["time"])
    error = np.abs(columns(answer)["b.position"][:, 1] - (-1 - a * time**2 / 2)).max()
    assert error <= stated(answer, "b.position")
    assert answer["accuracy"]["how"] == "closed form"


def test_the_yo_yo_falls_straight_down(answer_of):
    answer = answer_of("scenes/yo-yo")
    a = G / (1 + 4e-5 / (0.1 * 0.01**2))
    assert answer["accelerations"]["yo-yo"]["linear"] == [0.0, pytest.approx(-a, rel=1e-15)]
    assert answer["forces"]["string-1.tension"]["value"] == pytest.approx(0.1 * (G - a), rel=1e-15)
    assert answer["model"]["noticed"] == ["constant throughout the motion: yo-yo.x"]
    time = np.array(answer["trajectory"]["time"])
    error = np.abs(columns(answer)["yo-yo.angle"] + a * time**2 / 2 / 0.01).max()
    assert error <= stated(answer, "yo-yo.angle")


def test_the_double_pendulum_agrees_with_lagrange_s_equations(answer_of):
    """Two angles, in other coordinates and without constraints."""
    answer = answer_of("scenes/double-pendulum")

    def places(a, b):
        x, y = cos(a) / 2, sin(a) / 2
        return {
            "one.position": (x, y),
            "two.position": (x * 2 + cos(b) / 2, y * 2 + sin(b) / 2),
            "one.angle": a,
            "two.angle": b,
        }

    def inertias(a, b):
        one, two, *_ = places(a, b).values()
        return [*((1, x) for x in (*one, *two)), (0.0833, a), (0.0833, b)]

    def potential(a, b):
        (_, first), (_, second), *_ = places(a, b).values()
        return (first + second) * G

    with mp.workdps(40):
        states = motion(inertias, potential, [0, pi / 2], [0, 0], times(answer))
    agree(answer, observed(states, places))
    found = columns(answer)
    assert (answer["model"]["described"], answer["model"]["coordinates"], answer["model"]["rows"]) == ([8, 6], 4, 2)
    assert answer["accuracy"]["how"] == "measured against pairs"
    assert answer["accuracy"]["error"] < 1e-9
    # Energy, which the series does not use.
    (x1, x2), (v1, v2) = ([found[f"{name}.{what}"] for name in ("one", "two")] for what in ("position", "velocity"))
    spin = 0.0833 * (found["one.angular_velocity"] ** 2 + found["two.angular_velocity"] ** 2)
    energy = ((v1**2).sum(axis=1) + (v2**2).sum(axis=1) + spin) / 2 + G * (x1[:, 1] + x2[:, 1])
    np.testing.assert_allclose(energy, answer["energy"]["total"], rtol=1e-8)


def test_the_bead_on_the_hoop_has_four_equilibria_and_its_period(answer_of):
    """cos theta = g/(W^2 R); with u = cos theta, u'^2 = W^2 (1 - u^2)(u0 - u)(u - u1), u1 = 2g/(W^2 R) - u0."""
    answer = answer_of("scenes/bead-on-hoop")
    with mp.workdps(30):
        high, w = mpf("0.8"), 4
        low = 2 * mpf("9.81") / w**2 - high
        middle, half = (high + low) / 2, (high - low) / 2
        period = 2 / mpf(w) * quad(lambda a: 1 / sqrt(1 - (middle + half * mp_cos(a)) ** 2), [0, pi])
        side = sqrt(1 - (mpf("9.81") / 16) ** 2)
    assert answer["period"] == pytest.approx(float(period), rel=4e-16)
    places = [one["positions"]["bead"] for one in answer["equilibria"]]
    # Zeros are zero to rounding, of either sign.
    assert sorted(places, key=lambda place: [round(x, 9) + 0.0 for x in place]) == pytest.approx(
        np.array([[-float(side), -0.613125], [0, -1], [0, 1], [float(side), -0.613125]]), abs=1e-12
    )
    assert [one["stable"] for one in answer["equilibria"]] == [True, True, False, False]
    assert answer["equilibria"][0]["modes"][0]["frequency"] == pytest.approx(float(4 * side), rel=1e-12)
    assert answer["forces"]["rod-1.force"]["value"] == pytest.approx(0.1 * (G * 0.8 + 16 * 0.6**2), rel=1e-14)


def test_the_lagrange_top_nods_and_goes_round(answer_of):
    """With u the cosine of the inclination: u'^2 = b (u0 - u)(u - u1)(u2 - u), phi' = a (u0 - u)/(1 - u^2)."""
    answer = answer_of("scenes/lagrange-top")
    with mp.workdps(30):
        inertia, start = mpf("0.05"), mpf("0.8")
        a, b = mpf("0.004") * 200 / inertia, 2 * mpf("9.81") * mpf("0.2") / inertia
        root = sqrt(a**4 - 4 * b * (a**2 * start - b))
        low, far = (a**2 - root) / (2 * b), (a**2 + root) / (2 * b)

        def u(psi):
            return (start + low) / 2 + (start - low) / 2 * mp_cos(psi)

        period = 2 / sqrt(b) * quad(lambda x: 1 / sqrt(far - u(x)), [0, pi])
        turn = 2 / sqrt(b) * quad(lambda x: a * (start - u(x)) / (1 - u(x) ** 2) / sqrt(far - u(x)), [0, pi])
    (part,) = answer["model"]["apart"]
    assert answer["period"] == part["period"] == pytest.approx(float(period), rel=4e-16)
    assert part["precession"] == pytest.approx(float(turn), rel=1e-15)
    height = columns(answer)["top.axis"][:, 2]
    assert (float(low) - 1e-15 <= height).all()
    assert (height <= 0.8 + 1e-15).all()
    assert answer["accuracy"]["error"] < 1e-14

"""Described tops and gyroscopes: closed forms, and Euler's equations in body axes by Gragg's method with 30 digits.

References
----------
H. Goldstein, C. Poole, J. Safko, Classical Mechanics, 3rd ed., sections 5.6 and 5.7; V. V. Golubev, Lectures on
Integration of the Equations of Motion of a Rigid Body about a Fixed Point (1953), chapter 3 (Kovalevskaya's integral).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from flint import arb
from mpmath import matrix, mp, mpf

from tests.core.multibody.oracles import integrated
from tests.examples.scene_columns import agree, columns, in_time, stated, times
from tests.oracles.minimal_coordinates import cos, exact, sin, sqrt
from tests.oracles.taylor import integrate, rigid_body

G = 9.81
EXACT = 4 * 2.0**-52


def test_the_precessing_top(answer_of):
    """I1 cos(theta) W^2 - I3 w3 W + m g l = 0: the slow root."""
    answer = answer_of("scenes/precessing-top")
    rate = 3.6390508741573294
    assert answer["period"] == pytest.approx(2 * np.pi / rate, rel=EXACT)

    def axis(t):
        weight = exact(0.981)
        turn = 2 * weight / (exact(0.3) + sqrt(exact(0.09) - 4 * exact(0.012) * weight * cos(arb("0.8")))) * t
        s, c = sin(arb("0.8")), cos(arb("0.8"))
        return s * cos(turn), s * sin(turn), c

    agree(answer, in_time(answer, lambda t: {"top.axis": axis(t), "top.position": tuple(x / 10 for x in axis(t))}))
    # The tip is drawn inwards, as what goes round.
    inwards = [-0.1 * np.sin(0.8) * rate**2, 0, G]
    pulls = [answer["forces"][f"pin-1.{x}"]["value"] for x in "xyz"]
    assert pulls == pytest.approx(inwards, rel=1e-14, abs=1e-15)


def test_the_sleeping_top(answer_of):
    """z = x + i y: I1 z'' - i I3 w3 z' - m g l z = 0; stable while (I3 w3)^2 > 4 I1 m g l."""
    answer = answer_of("scenes/sleeping-top")
    assert answer["model"]["name"] == "steady spin"
    assert columns(answer)["top.axis"].tolist() == 6 * [[0.0, 0.0, 1.0]]
    hanging, upright = answer["equilibria"]
    momentum, weight, inertia = 0.24, 0.981, 0.012
    for one, sign in ((upright, -1), (hanging, 1)):
        root = (momentum**2 + sign * 4 * inertia * weight) ** 0.5
        expected = [abs(momentum - root) / 2 / inertia, (momentum + root) / 2 / inertia]
        assert [mode["frequency"] for mode in one["modes"]] == pytest.approx(expected, rel=1e-13)
        assert [mode["growth_rate"] for mode in one["modes"]] == pytest.approx([0, 0], abs=1e-12)
    # What gyroscopic forces hold is no minimum of the potential: small motions do not decide.
    assert (hanging["stable"], upright["stable"]) == (True, None)


def heavy(inertia, arm, weight):
    """Return the rates of angular velocity and of the axes of space, in the axes of a body about a fixed point."""
    inverse = inertia**-1

    def rates(*state):
        omega, axes = matrix(state[:3]), [state[3 + 3 * k : 6 + 3 * k] for k in range(3)]
        torque = [-weight * x for x in cross(arm, axes[2])]
        spin = cross(omega, inertia * omega)
        gain = inverse * matrix([a - b for a, b in zip(torque, spin, strict=True)])
        return [*gain, *(x for axis in axes for x in cross(axis, omega))]

    return rates


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def followed(rates, start, moments, steps):
    states = [start]
    for before, after in pairwise(moments):
        states.append(integrated(rates, states[-1], mpf(after) - mpf(before), steps))
    return states


def in_space(state, vector):
    """Return the components in space of a vector of the body."""
    return [float(sum(x * y for x, y in zip(state[3 + 3 * k : 6 + 3 * k], vector, strict=True))) for k in range(3)]


def test_the_gyroscope_with_an_offset_mass(answer_of):
    """The load makes one body with the gyroscope: its tensor about the pivot, its weight's torque."""
    answer = answer_of("scenes/gyroscope-with-offset-mass")
    with mp.workdps(30):
        load, arm = mpf("0.1"), [mpf("0.05"), mpf(0), mpf("0.2")]
        square = sum(x * x for x in arm)
        inertia = matrix(3)
        for i, moment in enumerate(("0.01", "0.01", "0.02")):
            for j in range(3):
                inertia[i, j] = (mpf(moment) + load * square if i == j else 0) - load * arm[i] * arm[j]
        # The axes of space in those of the body, which are y, z, x.
        start = [mpf(x) for x in (0, 0, 60, 0, 0, 1, 1, 0, 0, 0, 1, 0)]
        rates = heavy(inertia, arm, load * mpf("9.81"))
        states = followed(rates, start, times(answer), 20)
        coarse = followed(rates, start, times(answer)[:3], 15)
        own = max(float(abs(x - y)) for x, y in zip(coarse[-1], states[2], strict=True))
    assert own < 1e-16
    agree(
        answer,
        {
            "load.position": [in_space(state, arm) for state in states],
            "gyroscope.angular_velocity": [[float(x) for x in state[:3]] for state in states],
        },
        own=own,
    )
    # Energy, with the momentum about the vertical that nothing turns.
    found = columns(answer)
    omega, place, speed = (found[name] for name in ("gyroscope.angular_velocity", "load.position", "load.velocity"))
    energy = (np.array([0.01, 0.01, 0.02]) * omega**2).sum(axis=1) / 2 + 0.05 * (speed**2).sum(axis=1)
    np.testing.assert_allclose(energy + 0.981 * place[:, 2], answer["energy"]["total"], rtol=1e-13)


def test_the_top_of_kovalevskaya(answer_of):
    """A = B = 2 C: |(p + i q)^2 + m g l/C (g1 + i g2)| is conserved, g upward in the body axes."""
    answer = answer_of("scenes/kovalevskaya-top")
    with mp.workdps(30):
        inertia = matrix(3)
        for i, moment in enumerate(("0.04", "0.04", "0.02")):
            inertia[i, i] = mpf(moment)
        arm = [mpf("0.1"), mpf(0), mpf(0)]
        start = [mpf(x) for x in (1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1)]
        rates = heavy(inertia, arm, mpf("9.81"))
        states = followed(rates, start, times(answer), 16)
        coarse = followed(rates, start, times(answer)[:3], 12)
        own = max(float(abs(x - y)) for x, y in zip(coarse[-1], states[2], strict=True))
    assert own < 1e-15
    agree(
        answer,
        {
            "top.position": [in_space(state, arm) for state in states],
            "top.angular_velocity": [[float(x) for x in state[:3]] for state in states],
        },
        own=own,
    )
    omega, attitude = columns(answer)["top.angular_velocity"], columns(answer)["top.attitude"]
    w, x, y, z = attitude.T
    up = 2 * (x * z - w * y) + 2j * (y * z + w * x)
    integral = np.abs((omega[:, 0] + 1j * omega[:, 1]) ** 2 - 0.981 / 0.02 * up)
    np.testing.assert_allclose(integral, integral[0], rtol=1e-13)


def test_the_asymmetric_top(answer_of):
    """Euler's equations without torque, and the quaternion, by their series."""
    answer = answer_of("scenes/asymmetric-top")
    with mp.workdps(40):
        start = [mpf("0.01"), mpf(1), mpf("0.01"), mpf(1), mpf(0), mpf(0), mpf(0)]
        states = integrate(rigid_body([1, 2, 3]), start, times(answer))
    omega = np.array([[float(x) for x in state[:3]] for state in states])
    attitude = np.array([[float(x) for x in state[3:]] for state in states])
    attitude[attitude[:, 0] < 0] *= -1
    agree(answer, {"body.angular_velocity": omega, "body.attitude": attitude})
    assert stated(answer, "body.angular_velocity") < 3e-15


def test_a_thrown_body(answer_of):
    """The centre of mass on a parabola; Euler's equations without torque beside it."""
    answer = answer_of("scenes/thrown-body")

    def places(t):
        return {"body.position": (3 * t, t, 1 + 5 * t - exact(G) / 2 * t * t)}

    agree(answer, in_time(answer, places))
    with mp.workdps(40):
        start = [mpf("0.1"), mpf(8), mpf("0.2"), mpf(1), mpf(0), mpf(0), mpf(0)]
        states = integrate(rigid_body([mpf("0.02"), mpf("0.05"), mpf("0.06")]), start, times(answer))
    omega = np.array([[float(x) for x in state[:3]] for state in states])
    attitude = np.array([[float(x) for x in state[3:]] for state in states])
    attitude[attitude[:, 0] < 0] *= -1
    agree(answer, {"body.angular_velocity": omega, "body.attitude": attitude})
    assert stated(answer, "body.attitude") < 3e-15

"""Described pendulums: elliptic functions, and Lagrange's equations in angles by series with 128 bits.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, sections 5 (Lagrange's equations of pendulums), 11 (elliptic functions), 14
(spherical), 30 (Kapitza). N. B. Tufillaro, "Integrable motion of a swinging Atwood's machine", American Journal of
Physics 54 (1986) 142.
"""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb
from mpmath import cos as mp_cos
from mpmath import ellipk, mp, mpf, pi
from mpmath import sin as mp_sin
from mpmath import sqrt as mp_sqrt

from tests.examples.scene_columns import (
    agree,
    columns,
    in_time,
    observed,
    stated,
    swing,
    swinging,
    times,
)
from tests.oracles.minimal_coordinates import cos, exact, motion, sin, sqrt

G = 9.81
EXACT = 4 * 2.0**-52


def below(angle):
    """Return the place at distance 1 below the origin, at an angle from the vertical."""
    return sin(angle), -cos(angle)


def test_the_simple_pendulum(answer_of):
    """T = 4 K(sin^2 1.25)/omega_0, and the elliptic functions after thirty periods."""
    answer = answer_of("scenes/simple-pendulum")
    with mp.workdps(30):
        period = 4 * ellipk(mp_sin(mpf("1.25")) ** 2) / mp_sqrt(mpf("9.81"))
    assert answer["period"] == pytest.approx(float(period), rel=2.0**-52)
    agree(answer, swinging(answer, "2.5", "9.81", lambda a: {"bob.position": below(a)}))


def test_the_timed_pendulum(answer_of):
    """m = 2, l = 1: the third passage after 5/4 of the period, the pull m g (3 cos(theta) - 2 cos(2.5)), the arc."""
    answer = answer_of("scenes/pendulum-timed")
    states = [swing("2.5", "9.81", t) for t in times(answer)]
    with mp.workdps(30):
        quarter = ellipk(mp_sin(mpf("1.25")) ** 2) / mp_sqrt(mpf("9.81"))
        arcs = []
        for t, (angle, _) in zip(times(answer), states, strict=True):
            swings = int(mpf(t) / (2 * quarter))
            arcs.append(5 * swings + abs(angle - (-1) ** swings * mpf("2.5")))
        fallen = [2 * mpf("9.81") * (mp_cos(angle) - mp_cos(mpf("2.5"))) for angle, _ in states]
        momenta = [2 * rate for _, rate in states]
        ends = [2 * mpf("9.81") * x for x in (mp_cos(mpf("2.5")), 3 - 2 * mp_cos(mpf("2.5")))]
    agree(answer, {"bob.path": arcs, "gravity.work": fallen, "angular_momentum": momenta, "energy.kinetic": fallen})
    (third,) = answer["occurrences"]
    assert abs(third["time"] - 5 * quarter) <= third["error"] < 1e-13
    (pull,) = answer["extremes"]
    assert [pull["least"], pull["largest"]] == pytest.approx([float(x) for x in ends], abs=pull["error"])
    assert pull["periodic"]


def test_the_physical_pendulum(answer_of):
    """theta'' = -3 g/(2 l) sin(theta); the hinge by Newton's law, from angle and rate."""
    answer = answer_of("scenes/physical-pendulum")

    def places(a):
        x, y = below(a)
        return {"rod.position": (x / 2, y / 2), "rod.angle": a - arb.pi() / 2}

    def square():
        return mpf("9.81") * 3 / 2

    agree(answer, swinging(answer, lambda: pi / 2, square, places))
    pulls = []
    for t in times(answer):
        a, rate = swing(lambda: pi / 2, square, t)
        s, c = mp_sin(a), mp_cos(a)
        # 2 r'' = F + 2 g of the centre, r = (s, -c)/2.
        pulls.append([float(-c * square() * s - s * rate**2), float(-s * square() * s + c * rate**2 + 2 * mpf("9.81"))])
    pulls = np.array(pulls)
    # The doubles of the rate carry 2^-53 of it, its square some times as much.
    agree(answer, {"hinge.x": pulls[:, 0], "hinge.y": pulls[:, 1]}, own=1e-14)


def test_the_spherical_pendulum(answer_of):
    """Colatitude and azimuth; the vertical angular momentum is the product that Lagrange's equations conserve."""
    answer = answer_of("scenes/spherical-pendulum")

    def place(a, b):
        return sin(a) * cos(b), sin(a) * sin(b), -cos(a)

    with mp.workdps(40):
        start, rate = [mp.asin(mpf("0.6")), mpf(0)], [mpf(0), 2 / mpf("0.6")]
    states = motion(lambda a, b: [(1, x) for x in place(a, b)], lambda a, b: -G * cos(a), start, rate, times(answer))
    agree(answer, observed(states, lambda a, b: {"bob.position": place(a, b)}))
    found = columns(answer)
    spin = np.cross(found["bob.position"], found["bob.velocity"])[:, 2]
    np.testing.assert_allclose(spin, 1.2, rtol=1e-14)


def test_the_conical_pendulum(answer_of):
    """omega^2 = g/(l cos(theta)); the string pulls with m g/cos(theta)."""
    answer = answer_of("scenes/conical-pendulum")
    assert answer["forces"]["string-1.tension"]["value"] == pytest.approx(G / 0.8, rel=EXACT)
    assert answer["period"] == pytest.approx(2 * np.pi * (0.8 / G) ** 0.5, rel=EXACT)

    def places(t):
        turn = sqrt(exact(G) / exact(0.8)) * t
        return {"bob.position": (exact(0.6) * cos(turn), exact(0.6) * sin(turn), exact(-0.8))}

    agree(answer, in_time(answer, places))


def test_foucault_s_pendulum(answer_of):
    """At rest in the frame seen from outside it starts at 0.5 x 0.6 m/s across."""
    answer = answer_of("scenes/foucault-pendulum")

    def place(x, y):
        return x, y, -sqrt(1 - x * x - y * y)

    def potential(x, y):
        return G * place(x, y)[2]

    states = motion(lambda x, y: [(1, z) for z in place(x, y)], potential, [0.6, 0], [0, 0.3], times(answer))

    def framed(x, y, angle):
        x, y, z = place(x, y)
        c, s = cos(angle), sin(angle)
        return {"bob.position": (c * x + s * y, c * y - s * x, z)}

    # What turns with the frame is less by its turn.
    turning = [([*q, mpf(t) / 2], [*v, 0.5]) for (q, v), t in zip(states, times(answer), strict=True)]
    agree(answer, observed(turning, framed))


def test_the_double_pendulum_of_points(answer_of):
    answer = answer_of("scenes/double-pendulum-of-points")

    def places(a, b):
        (x, y), (u, v) = below(a), below(b)
        return {"upper.position": (x, y), "lower.position": (x + u, y + v)}

    def inertias(a, b):
        return [(1, x) for place in places(a, b).values() for x in place]

    def potential(a, b):
        return G * (places(a, b)["upper.position"][1] + places(a, b)["lower.position"][1])

    states = motion(inertias, potential, [1.0, -0.5], [0, 0], times(answer))
    agree(answer, observed(states, places))
    # theta at 1 s and the upper tension, found in two ways at 40 digits.
    (a, b), _ = states[-1]
    assert (float(a), float(b)) == pytest.approx((-0.82194943572101677, 0.29181553578655226), rel=EXACT)
    found = answer["trajectory"]["columns"]["first.tension"]
    assert abs(found["values"][-1] - 10.370139833611142) <= found["error"] + 2e-15
    (hanging,) = answer["equilibria"]
    assert hanging["stable"]
    assert [mode["frequency"] for mode in hanging["modes"]] == pytest.approx(
        [(G * (2 - 2**0.5)) ** 0.5, (G * (2 + 2**0.5)) ** 0.5], rel=1e-13
    )


def test_the_pendulum_on_a_cart(answer_of):
    answer = answer_of("scenes/pendulum-on-cart")

    def places(x, a):
        u, v = below(a)
        return {"cart.position": (x, 0 * x), "bob.position": (x + u, v)}

    def inertias(x, a):
        u, v = below(a)
        return [(2, x), (1, x + u), (1, v)]

    states = motion(inertias, lambda x, a: -G * cos(a), [0, 2.0], [0, 0], times(answer))
    agree(answer, observed(states, places))
    found = columns(answer)
    momentum = 2 * found["cart.velocity"][:, 0] + found["bob.velocity"][:, 0]
    assert np.abs(momentum).max() <= 2 * stated(answer, "cart.velocity") + stated(answer, "bob.velocity")


def test_the_elastic_pendulum(answer_of):
    """Length and angle; it can hang at 1 + g/40, and stand at 1 - g/40."""
    answer = answer_of("scenes/elastic-pendulum")

    def place(r, a):
        return r * sin(a), -(r * cos(a))

    def potential(r, a):
        return 20 * (r - 1) * (r - 1) - G * r * cos(a)

    with mp.workdps(40):
        start = [mpf(1), mp.asin(mpf("0.6"))]
    states = motion(lambda r, a: [(1, x) for x in place(r, a)], potential, start, [0, 0], times(answer))
    agree(answer, observed(states, lambda r, a: {"bob.position": place(r, a)}))
    hanging, standing = answer["equilibria"]
    assert hanging["positions"]["bob"] == pytest.approx([0, -1 - G / 40], abs=1e-14)
    assert standing["positions"]["bob"] == pytest.approx([0, 1 - G / 40], abs=1e-14)
    assert (hanging["stable"], standing["stable"]) == (True, False)
    assert [mode["frequency"] for mode in hanging["modes"]] == pytest.approx(
        [(G / (1 + G / 40)) ** 0.5, 40**0.5], rel=1e-13
    )


def test_the_coupled_pendulums(answer_of):
    """Small motions: sqrt(g/l) in phase, sqrt(g/l + 2 k/m) against one another; four equilibria."""
    answer = answer_of("scenes/coupled-pendulums")

    def places(a, b):
        (x, y), (u, v) = below(a), below(b)
        return {"left.position": (x, y), "right.position": (u + 1, v)}

    def inertias(a, b):
        return [(1, x) for place in places(a, b).values() for x in place]

    def potential(a, b):
        (x, y), (u, v) = below(a), below(b)
        across, up = u + 1 - x, v - y
        stretch = sqrt(across * across + up * up) - 1
        return G * (y + v) + stretch * stretch * 1.5

    with mp.workdps(40):
        start = [mp.asin(mpf("0.6")), mpf(0)]
    states = motion(inertias, potential, start, [0, 0], times(answer))
    agree(answer, observed(states, places))
    assert len(answer["equilibria"]) == 4
    modes = [mode["frequency"] for mode in answer["equilibria"][0]["modes"]]
    assert modes == pytest.approx([G**0.5, (G + 6) ** 0.5], rel=1e-13)


def test_the_kapitza_pendulum_stays_up(answer_of):
    """theta'' = -(g + y'') sin(theta), y = 0.1 sin(100 t); upright while (a w)^2 > 2 g l."""
    answer = answer_of("scenes/kapitza-pendulum")

    def places(turn, a):
        x, y = below(a)
        return {"yoke.position": (0 * a, sin(turn) / 10), "bob.position": (x, y + sin(turn) / 10), "crank.angle": turn}

    def inertias(turn, a):
        x, y = places(turn, a)["bob.position"]
        return [(1, x), (1, y)]

    def potential(turn, a):
        return G * places(turn, a)["bob.position"][1]

    # The velocity that is left out is that of least kinetic energy: the bob moves along its rod only.
    with mp.workdps(40):
        rate = -10 * mp_sin(mpf(3))
    states = motion(inertias, potential, [0, 3.0], [100, rate], times(answer), driven=1)
    agree(answer, observed(states, places))
    assert (columns(answer)["bob.position"][:, 1] > 0.8).all()


def test_the_swinging_atwood_machine(answer_of):
    """Distance and angle; for a ratio of masses of 3 an integral that is neither energy nor momentum (Tufillaro).

    With theta from the downward vertical, r^2 theta' (r' cos(theta/2) - r theta'/2 sin(theta/2))
    + g r^2 sin(theta/2) cos^2(theta/2) is conserved.
    """
    answer = answer_of("scenes/swinging-atwood-machine")

    def places(r, a):
        return {"weight.position": (0 * r - 1, r - 3), "bob.position": (r * sin(a), -(r * cos(a)))}

    def inertias(r, a):
        return [(3, r), *((1, x) for x in places(r, a)["bob.position"])]

    def potential(r, a):
        return 3 * G * r - G * r * cos(a)

    states = motion(inertias, potential, [1, pi_over_two()], [0, 0], times(answer))
    agree(answer, observed(states, places))
    found = columns(answer)
    (x, y), (u, v) = found["bob.position"].T, found["bob.velocity"].T
    r, angle = np.hypot(x, y), np.arctan2(x, -y)
    away, turn = (x * u + y * v) / r, (x * v - y * u) / r**2
    s, c = np.sin(angle / 2), np.cos(angle / 2)
    integral = r**2 * turn * (away * c - r * turn / 2 * s) + G * r**2 * s * c * c
    # The half of an angle is known up to a half turn.
    np.testing.assert_allclose(np.abs(integral), integral[0], rtol=1e-12)


def pi_over_two():
    with mp.workdps(40):
        return +pi / 2


def test_the_inverted_pendulum_on_a_torsion_spring(answer_of):
    """theta'' = (m g l/2 sin(theta) - k theta)/(m l^2/3), theta from the upward vertical."""
    answer = answer_of("scenes/inverted-pendulum-on-torsion-spring")

    def places(a):
        return {"rod.position": (sin(a) / 2, cos(a) / 2)}

    def inertias(a):
        return [(1, sin(a) / 2), (1, cos(a) / 2), (1, a * sqrt(exact(1) / 12))]

    def potential(a):
        return a * a * 2 + G * cos(a) / 2

    states = motion(inertias, potential, [0.1], [0], times(answer))
    expected = observed(states, places)
    expected |= {"rod.angle": [np.pi / 2 - float(q[0]) for q, _ in states]}
    expected |= {"rod.angular_velocity": [-float(v[0]) for _, v in states]}
    agree(answer, expected)
    # It falls to one side and comes back to where it was released.
    time, angle = answer["period"], columns(answer)["rod.angle"]
    (again,) = motion(inertias, potential, [0.1], [0], [time])
    assert float(again[0][0]) == pytest.approx(0.1, rel=1e-14)
    assert (angle <= np.pi / 2 - 0.1 + 1e-15).all()


def test_the_plank_on_two_strings(answer_of):
    """Translation along a circle: a simple pendulum; each string carries half of m (g cos(theta) + v^2/l)."""
    answer = answer_of("scenes/plank-on-two-strings")
    with mp.workdps(40):
        amplitude = mp.asin(mpf("0.6"))
    expected = swinging(answer, amplitude, "9.81", lambda a: {"plank.position": below(a)})
    agree(answer, expected | {"plank.angle": np.zeros(6), "plank.angular_velocity": np.zeros(6)})
    for name in ("first", "second"):
        assert answer["forces"][f"{name}.tension"]["value"] == pytest.approx(0.8 * G, rel=EXACT)

"""Described scenes of bodies that attract or repel by the inverse square: Kepler's equation, and Cartesian coordinates.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, section 15 (orbits by the eccentric anomaly, attraction and repulsion).
A. Chenciner, R. Montgomery, "A remarkable periodic solution of the three-body problem in the case of equal masses",
Annals of Mathematics 152 (2000), with the initial state of C. Simó. V. Szebehely, Theory of Orbits (1967): equilibria.
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from tests.examples.scene_columns import agree, columns, observed, times
from tests.oracles.kepler import orbit
from tests.oracles.minimal_coordinates import cos as cosine
from tests.oracles.minimal_coordinates import exact, motion
from tests.oracles.minimal_coordinates import sin as sine
from tests.oracles.minimal_coordinates import sqrt as root

EXACT = 4 * 2.0**-52


def test_a_planet_on_an_ellipse_in_space(answer_of):
    """a = 1, e = 3/5, from the apocentre; the plane of the orbit holds (0, 4/5, 3/5)."""
    answer = answer_of("scenes/kepler-ellipse")
    with mp.workdps(40):
        places, rates, period = orbit((mpf("1.6"), mpf(0)), (mpf(0), mpf("0.5")), mpf(1), times(answer))
        found = [[(x, y * 4 / 5, y * 3 / 5) for x, y in values] for values in (places, rates)]
    assert answer["period"] == pytest.approx(float(period), rel=EXACT)
    agree(answer, {"planet.position": found[0], "planet.velocity": found[1]})
    assert answer["accuracy"]["how"] == "closed form"
    assert answer["forces"]["inverse-square-1.force"]["value"] == pytest.approx(0.5 / 1.6**2, rel=EXACT)


def test_two_stars(answer_of):
    """The distance moves about the sum of the masses; the centre of mass moves on, at (0.075, 0.6) m/s."""
    answer = answer_of("scenes/binary-stars")
    with mp.workdps(40):
        moments = times(answer)
        places, rates, period = orbit((mpf(2), mpf(0)), (mpf("0.1"), mpf("0.8")), mpf(4), moments)
        centre = [(mpf("1.5") + mpf("0.075") * mpf(t), mpf("0.6") * mpf(t)) for t in moments]
        rate = [(mpf("0.075"), mpf("0.6"))] * len(moments)
        expected = {}
        for body, share in (("a", mpf(-3) / 4), ("b", mpf(1) / 4)):
            for what, own, whole in (("position", places, centre), ("velocity", rates, rate)):
                expected[f"{body}.{what}"] = [
                    tuple(x + share * y for x, y in zip(*pair, strict=True)) for pair in zip(whole, own, strict=True)
                ]
        pulls = [3 / (x * x + y * y) for x, y in places]
    agree(answer, expected | {"gravitation-1.force": pulls})
    assert [part["period"] for part in answer["model"]["apart"]] == [
        None,
        None,
        pytest.approx(float(period), rel=EXACT),
    ]
    found = columns(answer)
    energy = found["energy.kinetic"] + found["energy.potential"]
    np.testing.assert_allclose(energy, answer["energy"]["total"], rtol=1e-14)


def test_an_alpha_particle_is_turned_aside(answer_of):
    """A hyperbola about its outer focus; the angle of Rutherford's formula between the asymptotes."""
    answer = answer_of("scenes/alpha-particle")
    with mp.workdps(40):
        start = (mpf(-10), mpf("0.5")), (mpf(1), mpf(0)), mpf("-0.5")
        places, rates, _ = orbit(*start, times(answer))
    agree(answer, {"alpha.position": places, "alpha.velocity": rates})
    assert answer["period"] is None


def test_three_bodies_follow_one_another_on_an_eight(answer_of):
    answer = answer_of("scenes/three-body-figure-eight")

    def apart(*q):
        pairs = ((0, 1), (1, 2), (2, 0))
        return [
            root(
                (q[2 * i] - q[2 * j]) * (q[2 * i] - q[2 * j])
                + (q[2 * i + 1] - q[2 * j + 1]) * (q[2 * i + 1] - q[2 * j + 1])
            )
            for i, j in pairs
        ]

    def potential(*q):
        first, second, third = apart(*q)
        return -(1 / first) - 1 / second - 1 / third

    x, y, u, w = (exact(value) for value in (0.97000436, -0.24308753, -0.93240737, -0.86473146))
    start, rates = [x, y, -x, -y, 0, 0], [-u / 2, -w / 2, -u / 2, -w / 2, u, w]
    states = motion(lambda *q: [(1, c) for c in q], potential, start, rates, times(answer))
    agree(
        answer,
        observed(states, lambda *q: {f"{body}.position": q[2 * k : 2 * k + 2] for k, body in enumerate("abc")}),
    )
    # After a period of 6.32591398 everything is where it was, as far as the eight digits of the start go.
    found = columns(answer)
    for body in "abc":
        assert np.abs(found[f"{body}.position"][-1] - found[f"{body}.position"][0]).max() < 1e-6


def test_the_points_of_lagrange(answer_of):
    """L4 and L5 make equilateral triangles; small motions there have w^4 - w^2 + 27/4 mu (1 - mu) = 0."""
    answer = answer_of("scenes/lagrange-points")
    mu = exact(1) / 82

    def potential(f, x, y):
        return -((1 - mu) / root((x + mu) * (x + mu) + y * y)) - mu / root((x - 1 + mu) * (x - 1 + mu) + y * y)

    def inertias(f, x, y):
        return [(1, x * cosine(f) - y * sine(f)), (1, x * sine(f) + y * cosine(f))]

    states = motion(inertias, potential, [0, 0.48, 0.85], [1, 0, 0], times(answer), driven=1)
    agree(answer, observed(states, lambda f, x, y: {"probe.position": (x, y)}))
    share = 1 / 82
    triangles = [one for one in answer["equilibria"] if abs(one["positions"]["probe"][1]) > 0.1]
    assert len(answer["equilibria"]) == 5
    for one, sign in zip(sorted(triangles, key=lambda one: one["positions"]["probe"][1]), (-1, 1), strict=True):
        assert one["positions"]["probe"] == pytest.approx([0.5 - share, sign * 3**0.5 / 2], rel=1e-14)
        squares = [(1 + sign * (1 - 27 * share * (1 - share)) ** 0.5) / 2 for sign in (-1, 1)]
        assert [mode["frequency"] for mode in one["modes"]] == pytest.approx(np.sqrt(squares), rel=1e-12)
    # The others are on the line, and unstable: Euler's quintic is the balance of the two pulls.
    for one in answer["equilibria"]:
        x, y = one["positions"]["probe"]
        if abs(y) < 0.1:
            pull = (1 - share) * (x + share) / abs(x + share) ** 3 + share * (x - 1 + share) / abs(x - 1 + share) ** 3
            assert abs(y) < 1e-12
            assert pull == pytest.approx(x, rel=1e-13)
            assert one["stable"] is False

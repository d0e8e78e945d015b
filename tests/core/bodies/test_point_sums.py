"""Sums over point masses against rational arithmetic.

u^2 = 2^-106; a sum of pairs is right to 3 u^2 of itself and a product to 4 u^2 (Joldes, Muller, Popescu 2017), so that
n terms added one after the other are right to 3 n u^2 of the sum of their sizes.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.point_sums import first_moments, second_moments
from tests.drawn import draws

SQUARE = Fraction(2) ** -106

weights = st.floats(-60, 60).map(lambda e: 10.0**e) | st.floats(0.5, 2.0)
places = st.floats(-1e10, 1e10, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-60 else 0.0)
parts = st.floats(-0.5, 0.5)
points = st.lists(st.tuples(weights, st.tuples(places, places, places), parts), min_size=1, max_size=12)


def arrays(given_points) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    masses = np.array([m for m, _, _ in given_points])
    positions = np.array([x for _, x, _ in given_points])
    tails = np.array([[part * float(np.spacing(abs(c))) if c else 0.0 for c in x] for _, x, part in given_points])
    return masses, positions, tails


def whole(value: np.ndarray, tail: np.ndarray) -> list[list[Fraction]]:
    return [
        [Fraction(float(h)) + Fraction(float(t)) for h, t in zip(row, tail_row, strict=True)]
        for row, tail_row in zip(value, tail, strict=True)
    ]


@settings(deadline=None, derandomize=True, max_examples=draws(80))
@given(points)
def test_mass_and_centre(given_points) -> None:
    masses, positions, tails = arrays(given_points)
    out = np.zeros((2, 4))
    first_moments(masses, positions, tails, out)
    m, x = [Fraction(float(mass)) for mass in masses], whole(positions, tails)
    n, total = len(m), sum(m)
    got = whole(out[:1], out[1:])[0]
    assert abs(got[0] - total) <= 3 * n * SQUARE * total
    for j in range(3):
        want = sum(m[k] * x[k][j] for k in range(n)) / total
        size = sum(m[k] * abs(x[k][j]) for k in range(n)) / total
        # A product and n sums above, n sums below, a quotient.
        assert abs(got[1 + j] - want) <= (4 + 3 * n + 3 * n + 4) * SQUARE * (size + abs(want))


@settings(deadline=None, derandomize=True, max_examples=draws(80))
@given(points, st.tuples(places, places, places))
def test_second_moments_about_any_point(given_points, middle) -> None:
    masses, positions, tails = arrays(given_points)
    center = np.zeros((2, 4))
    center[0, 1:] = middle
    center[1, 1:] = 0.25 * np.spacing(np.abs(center[0, 1:]))
    out = np.zeros((2, 3, 3))
    second_moments(masses, positions, tails, center, out)
    m, x = [Fraction(float(mass)) for mass in masses], whole(positions, tails)
    c = whole(center[:1], center[1:])[0][1:]
    n = len(m)
    d = [[x[k][j] - c[j] for j in range(3)] for k in range(n)]
    for i in range(3):
        got = whole(out[0, i : i + 1], out[1, i : i + 1])[0]
        for j in range(3):
            want = sum(m[k] * d[k][i] * d[k][j] for k in range(n))
            # A difference of unequal pairs is right to 3 u^2 of its terms, not of itself.
            size = sum(m[k] * (abs(x[k][i]) + abs(c[i])) * (abs(x[k][j]) + abs(c[j])) for k in range(n))
            assert abs(got[j] - want) <= (3 + 3 + 4 + 4 + 3 * n) * SQUARE * size
    assert np.array_equal(out, out.transpose(0, 2, 1))


def test_points_far_from_the_origin_lose_no_digits() -> None:
    masses, far = np.array([1.0, 3.0]), 2.0**60
    positions = np.array([[far, 0.0, 0.0], [far, 0.0, 0.0]])
    tails = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    center, out = np.zeros((2, 4)), np.zeros((2, 3, 3))
    first_moments(masses, positions, tails, center)
    assert Fraction(center[0, 1]) + Fraction(center[1, 1]) == Fraction(far) - Fraction(1, 2)
    second_moments(masses, positions, tails, center, out)
    # m1 m2/(m1 + m2) times the square of the distance.
    assert out[0, 0, 0] == 3.0
    assert not out[0, 1:, :].any()

"""Quaternions of 106 bits, against mpmath at 50 digits."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from core.double_double import Pair
from core.rotation.attitude.quaternions import IDENTITY, Quaternion, conjugate, fill_between, of_matrix, product, unit
from tests.drawn import draws

pytestmark = pytest.mark.filterwarnings("error")

SMALL = mpf(2) ** -100
"""Some tens of operations, each right to a few 2^-106."""

WIDE = st.floats(allow_nan=False, allow_infinity=False)
NEAR_ONE = st.floats(-1.0, 1.0)
UNITS = st.tuples(NEAR_ONE, NEAR_ONE, NEAR_ONE, NEAR_ONE).filter(lambda q: max(map(abs, q)) > 1e-3)


def exact(q: Quaternion) -> list[mpf]:
    return [mpf(high) + mpf(low) for high, low in q]


def given_by(values: tuple[float, ...]) -> Quaternion:
    w, x, y, z = ((value, 0.0) for value in values)
    return Quaternion(w, x, y, z)


def length(q: list[mpf]) -> mpf:
    return mp.sqrt(sum(x * x for x in q))


def distance(p: list[mpf], q: list[mpf]) -> mpf:
    return length([a - b for a, b in zip(p, q, strict=True)])


def rotation(q: list[mpf]) -> Any:
    """Return the matrix of a unit quaternion (Diebel, "Representing attitude", 2006, equation 125)."""
    w, x, y, z = q
    return mp.matrix(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def pair(x: mpf) -> Pair:
    high = float(x)
    return high, float(x - high)


@given(st.tuples(WIDE, WIDE, WIDE, WIDE).filter(any))
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_unit_quaternions_of_any_length(values: tuple[float, ...]) -> None:
    with mp.workdps(50):
        q = [mpf(value) for value in values]
        expected = [x / length(q) for x in q]
        assert distance(exact(unit(given_by(values))), expected) < SMALL


@pytest.mark.parametrize("size", [5e-324, 2.0**-1022, 1e-160, 1e160, 1.7976931348623157e308])
def test_unit_quaternions_at_the_ends_of_the_range(size: float) -> None:
    with mp.workdps(50):
        q = exact(unit(given_by((size, -size, size, size))))
        assert distance(q, [mpf(sign) / 2 for sign in (1, -1, 1, 1)]) < SMALL


@given(UNITS, UNITS, UNITS)
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_a_product_turns_by_one_and_then_the_other(p: Any, q: Any, v: Any) -> None:
    with mp.workdps(50):
        first, second = unit(given_by(q)), unit(given_by(p))
        both = rotation(exact(second)) * rotation(exact(first))
        assert mp.mnorm(rotation(exact(product(second, first))) - both) < SMALL
        assert distance(exact(product(first, conjugate(first))), exact(IDENTITY)) < SMALL


# A half turn, where the scalar part vanishes, about every axis and between them.
HALF_TURNS = [(0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0), (1e-17, 1.0, 1.0, 1.0)]


@given(UNITS | st.sampled_from(HALF_TURNS))
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_the_quaternion_of_a_matrix_turns_as_it_does(values: tuple[float, ...]) -> None:
    with mp.workdps(50):
        turn = rotation(exact(unit(given_by(values))))
        pairs = [[pair(turn[i, j]) for j in range(3)] for i in range(3)]
        found = of_matrix(
            np.array([[h for h, _ in row] for row in pairs]), np.array([[t for _, t in row] for row in pairs])
        )
        assert mp.mnorm(rotation(exact(found)) - turn) < SMALL


@given(UNITS, UNITS, UNITS)
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_the_matrix_multiplies_from_both_sides(p: Any, q: Any, r: Any) -> None:
    with mp.workdps(50):
        before, between, after = (unit(given_by(values)) for values in (p, q, r))
        matrix = np.empty((4, 4))
        fill_between(before, after, matrix)
        expected = exact(product(product(before, between), after))
        found = [sum(mpf(matrix[i, j]) * x for j, x in enumerate(exact(between))) for i in range(4)]
        # Each of sixteen entries, at most 1, is rounded by 2^-54 at most, and |between| = 1.
        assert distance(found, expected) <= 2 * mpf(2) ** -53

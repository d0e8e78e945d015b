"""Quaternions in extended precision, against Hamilton's rules and rational rotations."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.rotation.quaternions import left, quaternion_of, right, unit

EPS = float(np.finfo(np.longdouble).eps)
whole = st.integers(-1000, 1000)
numbers = st.tuples(whole, whole, whole, whole)


def extended(q) -> np.ndarray:
    return np.array([np.longdouble(x) for x in q])


def hamilton(p, q) -> list[int]:
    """Multiply by the table i j = k, j k = i, k i = j, i^2 = j^2 = k^2 = -1, term by term."""
    table = {(n, n): (0, -1) for n in (1, 2, 3)}
    for n in range(4):
        table[0, n] = table[n, 0] = (n, 1)
    for a, b, c in ((1, 2, 3), (2, 3, 1), (3, 1, 2)):
        table[a, b], table[b, a] = (c, 1), (c, -1)
    out = [0, 0, 0, 0]
    for m, x in enumerate(p):
        for n, y in enumerate(q):
            place, sign = table[m, n]
            out[place] += sign * x * y
    return out


@settings(deadline=None, derandomize=True)
@given(numbers, numbers)
def test_both_matrices_multiply(p, q) -> None:
    want = hamilton(p, q)
    assert (left(extended(p)) @ extended(q)).tolist() == want
    assert (right(extended(q)) @ extended(p)).tolist() == want


@settings(deadline=None, derandomize=True)
@given(numbers.filter(any), st.integers(-4000, 4000))
def test_unit_at_any_magnitude(q, exponent) -> None:
    """To the range of doubles and beyond: components are shortened before they are squared."""
    if np.finfo(np.longdouble).maxexp < 16000:
        exponent = exponent // 4
    found = unit(np.ldexp(extended(q), exponent))
    norm = float(sum(Fraction(x) ** 2 for x in q)) ** 0.5
    assert found.astype(float) == pytest.approx(np.array(q) / norm, abs=4e-16)
    assert abs(np.sum(found * found) - 1) <= 8 * EPS


@settings(deadline=None, derandomize=True, max_examples=300)
@given(st.tuples(*4 * [st.integers(-30, 30)]).filter(any))
def test_quaternion_of_a_rotation_matrix_turns_as_it_does(q) -> None:
    """Euler's and Rodrigues' matrix in whole numbers over |q|^2; half turns, where w = 0, included."""
    w, x, y, z = q
    square = w * w + x * x + y * y + z * z
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    found = quaternion_of(np.array([[np.longdouble(entry) / square for entry in row] for row in rows]))
    want = extended(q) / np.sqrt(np.longdouble(square))
    side = -1 if found @ want < 0 else 1
    # Shepperd: the largest component is at least 1/2, so that entries rounded to eps/2 are divided by no less.
    assert np.abs(side * found - want).max() <= 8 * EPS


def test_quarter_and_half_turns_exactly() -> None:
    assert quaternion_of(np.eye(3, dtype=np.longdouble)).tolist() == [1.0, 0.0, 0.0, 0.0]
    for k in range(3):
        half = -np.eye(3, dtype=np.longdouble)
        half[k, k] = 1
        assert quaternion_of(half).tolist() == [0.0, *np.eye(3)[k]]
    # A quarter turn about z takes x to y.
    found = quaternion_of(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=np.longdouble))
    assert found.astype(float) == pytest.approx([0.5**0.5, 0.0, 0.0, 0.5**0.5], abs=1e-16)

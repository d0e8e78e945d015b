"""Linear algebra in pairs against rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from flint import fmpq, fmpq_mat
from hypothesis import given
from hypothesis import strategies as st

from core.multibody.algebra.pair_arrays import gathered, invert_pairs, settled


@given(st.integers(0, 10**6), st.integers(1, 6))
def test_inverse_is_right_to_pairs(seed: int, n: int) -> None:
    random = np.random.default_rng(seed)
    a = np.zeros((n, n, 2))
    a[..., 0] = random.uniform(-1, 1, (n, n)) + 3 * np.eye(n)
    a[..., 1] = random.uniform(-1, 1, (n, n)) * 2.0**-55
    exact = fmpq_mat([[_rational(x) for x in row] for row in a]).inv()
    out = np.empty_like(a)
    assert invert_pairs(a.copy(), out)
    for i in range(n):
        for j in range(n):
            off = _rational(out[i, j]) - exact[i, j]
            assert abs(Fraction(int(off.p), int(off.q))) < Fraction(1, 2**92)


def test_a_singular_matrix_has_no_inverse() -> None:
    a = np.zeros((2, 2, 2))
    a[..., 0] = [[1, 2], [2, 4]]
    assert not invert_pairs(a, np.empty_like(a))


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=30))
def test_gathered_products_are_right_to_pairs(products: list[tuple[float, float]]) -> None:
    high, low = 0.0, 0.0
    for a, b in products:
        high, low = gathered(high, low, a, 0.0, b, 0.0)
    high, low = settled(high, low)
    exact = sum((Fraction(a) * Fraction(b) for a, b in products), Fraction(0))
    assert abs(Fraction(high) + Fraction(low) - exact) <= len(products) ** 2 * Fraction(1, 2**103)


def _rational(pair: np.ndarray) -> fmpq:
    value = Fraction(float(pair[0])) + Fraction(float(pair[1]))
    return fmpq(value.numerator, value.denominator)

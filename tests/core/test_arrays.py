"""Sizes of arrays, beside those of mpmath."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from core.arrays import largest_magnitude, row_lengths


def test_the_largest_magnitude_is_that_of_the_farthest_from_zero() -> None:
    assert largest_magnitude(np.array([[1.0, -3.5], [2.0, 3.0]])) == 3.5
    assert largest_magnitude(np.zeros((0, 2))) == 0.0
    assert np.isnan(largest_magnitude(np.array([1.0, np.nan])))


@pytest.mark.parametrize("shape", [(5, 2), (3, 4), (0, 3)])
def test_lengths_of_rows_are_those_of_vectors(shape: tuple[int, int]) -> None:
    rows = np.random.default_rng(7).standard_normal(shape)
    expected = [float(mpmath.norm(row.tolist())) for row in rows]
    assert row_lengths(rows) == pytest.approx(expected, rel=1e-15)

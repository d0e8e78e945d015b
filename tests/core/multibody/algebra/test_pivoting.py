"""Pivoted columns against LAPACK's QR factorisation with pivoting, in SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import qr

from core.multibody.algebra.pivoting import pivoted


@pytest.mark.parametrize("shape", [(1, 1), (5, 3), (3, 8), (40, 40)])
def test_order_and_distances_are_those_of_lapack(shape: tuple[int, int]) -> None:
    matrix = np.random.default_rng(7).normal(size=shape)
    _, triangle, expected = qr(matrix, mode="economic", pivoting=True)
    order, pivots = pivoted(matrix)
    count = min(shape)
    assert order[:count].tolist() == expected[:count].tolist()
    assert pivots == pytest.approx(np.abs(np.diag(triangle)), rel=1e-9)


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_of_columns_that_depend_on_others_rounding_remains(scale: float) -> None:
    chance = np.random.default_rng(1)
    matrix = scale * (chance.normal(size=(12, 5)) @ chance.normal(size=(5, 9)))
    order, pivots = pivoted(matrix)
    assert np.linalg.matrix_rank(matrix[:, order[:5]] / scale) == 5
    assert (pivots[5:] < 1e-14 * pivots[0]).all()
    assert sorted(order) == list(range(9))


def test_columns_of_zeros_and_none_at_all() -> None:
    order, pivots = pivoted(np.zeros((3, 4)))
    assert (order.tolist(), pivots.tolist()) == ([0, 1, 2, 3], [0.0, 0.0, 0.0])
    order, pivots = pivoted(np.zeros((3, 0)))
    assert (order.size, pivots.size) == (0, 0)
    # The first of equals.
    assert pivoted(np.eye(3))[0].tolist() == [0, 1, 2]

"""How far lines are from depending on one another."""

from __future__ import annotations

import numpy as np
import pytest

from core.multibody.algebra.orthogonal_rests import least_rest


def test_what_is_left_is_bounded_by_singular_values() -> None:
    """Of unit vectors: at least the least of them, and not more than they allow."""
    drawn = np.random.default_rng(5)
    for count, n in ((1, 1), (2, 4), (5, 5), (6, 9)):
        for smallness in (1.0, 1e-3, 1e-9):
            lines = drawn.normal(size=(count, n))
            lines[-1] = lines[0] * (count > 1) + smallness * lines[-1]
            lines /= np.linalg.norm(lines, axis=1, keepdims=True)
            singular = np.linalg.svd(lines, compute_uv=False)
            found = least_rest(lines * 2.0 ** drawn.integers(-500, 500, (count, 1)))
            assert singular[-1] * (1 - 1e-6) - 1e-15 <= found <= 2.0**count * singular[-1] + 1e-15


@pytest.mark.parametrize(
    "lines",
    [
        [[0.0, 0.0], [1.0, 0.0]],
        [[1.0], [2.0]],
        [[1.0, 2.0], [np.nan, 1.0]],
        [[np.inf, 2.0], [0.0, 1.0]],
        [[1.0, 2.0, 3.0], [1.0, 0.0, 1.0], [2.0, 2.0, 4.0]],
    ],
)
def test_of_lines_that_depend_nothing_is_left(lines: list[list[float]]) -> None:
    assert least_rest(np.array(lines)) < 1e-15

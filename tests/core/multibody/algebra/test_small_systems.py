"""Many small systems against exact rational arithmetic and against singular values."""

from __future__ import annotations

import numpy as np
from flint import fmpq_mat
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from core.arrays import Floats
from core.multibody.algebra.small_systems import solve

matrices = st.lists(st.lists(st.integers(-5, 5), min_size=4, max_size=4), min_size=4, max_size=4)
vectors = st.lists(st.integers(-5, 5), min_size=4, max_size=4)


def solutions(systems: Floats, right: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the solution of every system, and which are nearly singular."""
    found = right.copy()
    return found, np.array([solve(system, x) for system, x in zip(systems, found, strict=True)])


@given(matrices, vectors)
def test_regular_systems_have_the_solution_of_rational_arithmetic(rows: list[list[int]], right: list[int]) -> None:
    exact = fmpq_mat(rows)
    assume(exact.det() != 0)
    solved = exact.solve(fmpq_mat([[x] for x in right])).entries()
    found, singular = solutions(np.array([rows], dtype=float), np.array([right], dtype=float))
    assert not singular[0]
    expected = [int(x.p) / int(x.q) for x in solved]
    np.testing.assert_allclose(found[0], expected, rtol=1e-11, atol=1e-11 * max(1.0, *map(abs, expected)))


@given(matrices, vectors)
def test_singular_systems_have_the_shortest_of_least_squares(rows: list[list[int]], right: list[int]) -> None:
    rows = [*rows[:3], [a + b for a, b in zip(rows[0], rows[1], strict=True)]]
    found, singular = solutions(np.array([rows], dtype=float), np.array([right], dtype=float))
    assert singular[0]
    expected = np.linalg.lstsq(np.array(rows, dtype=float), np.array(right, dtype=float), rcond=1e-12)[0]
    np.testing.assert_allclose(found[0], expected, atol=1e-10 * max(1.0, np.abs(expected).max()))


def test_each_system_is_solved_apart() -> None:
    systems = np.array([[[2.0, 0.0], [0.0, 4.0]], [[1.0, 1.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]])
    found, singular = solutions(systems, np.array([[2.0, 4.0], [2.0, 2.0], [3.0, 5.0]]))
    assert singular.tolist() == [False, True, False]
    np.testing.assert_allclose(found, [[1.0, 1.0], [1.0, 1.0], [5.0, 3.0]], atol=1e-15)

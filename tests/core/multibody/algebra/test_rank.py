"""Elimination against rational linear algebra."""

from __future__ import annotations

from flint import arb, fmpq_mat
from hypothesis import given
from hypothesis import strategies as st

from core.multibody.algebra.rank import Elimination, independent

matrices = st.lists(st.lists(st.integers(-2, 2), min_size=4, max_size=4), min_size=1, max_size=5)


def sparse(row: list[int]) -> dict[int, arb]:
    return {j: arb(x) for j, x in enumerate(row) if x}


@given(matrices)
def test_rank_is_that_of_rational_arithmetic(rows: list[list[int]]) -> None:
    assert len(independent(map(sparse, rows))) == fmpq_mat(rows).rank()


@given(matrices, st.lists(st.integers(-3, 3), min_size=4, max_size=4))
def test_solutions_solve_and_consistent_rows_leave_nothing(rows: list[list[int]], x: list[int]) -> None:
    elimination = Elimination()
    for row in rows:
        left = elimination.add(sparse(row), arb(sum(a * b for a, b in zip(row, x, strict=True))))
        assert left is None or 0 in left
    found = elimination.solution(range(4))
    for row in rows:
        assert 0 in sum((a * b for a, b in zip(row, found, strict=True)), arb(0)) - sum(
            a * b for a, b in zip(row, x, strict=True)
        )


def test_contradictions_leave_their_residual() -> None:
    elimination = Elimination()
    assert elimination.add({0: arb(1), 1: arb(1)}, arb(2)) is None
    left = elimination.add({0: arb(2), 1: arb(2)}, arb(5))
    assert left == 1


def test_priority_decides_which_unknown_is_determined() -> None:
    elimination = Elimination([0, 1])
    elimination.add({0: arb(100), 1: arb(1)}, arb(0))
    assert list(elimination.pivots) == [1]


def test_what_is_left_of_a_line_below_what_is_known_of_it_is_nothing() -> None:
    lines = [{0: arb(1), 1: arb(1)}, {0: arb(1), 1: arb(1) + arb("1e-9")}, {2: arb("1e-12")}]
    assert independent(lines) == [0, 1, 2]
    assert independent(lines, 1e-8) == [0, 2]
    assert independent(lines, 1e-10) == [0, 1, 2]


def test_a_line_of_which_little_is_left_is_tried_after_the_others() -> None:
    """The second line is the first up to its rounding: taken before the third, it would leave nothing of that one."""
    lines = [{0: arb(1), 1: arb(1)}, {0: arb(1), 1: arb(1) + arb("1e-9")}, {0: arb(1), 1: arb(-1)}]
    assert independent(lines) == [0, 2]
    assert independent(lines[:2]) == [0, 1]
    assert independent([lines[0], lines[2], lines[1]]) == [0, 1]

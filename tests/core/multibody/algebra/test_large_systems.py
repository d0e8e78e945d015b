"""Large systems in balls against the same systems in rational numbers (FLINT's fmpq_mat)."""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb, fmpq, fmpq_mat

from core.balls import precision
from core.multibody.algebra.large_systems import solved_from_doubles
from core.multibody.algebra.polynomials import BITS

Entries = dict[tuple[int, int], fmpq]


def drawn(seed: int, size: int) -> tuple[Entries, list[fmpq]]:
    """Return a sparse system whose rows and columns have sizes from 1e-6 to 1e6, and a right side with zeros."""
    random = np.random.default_rng(seed)
    scales = [fmpq(10) ** int(random.integers(-6, 7)) for _ in range(size)]
    entries = {
        (i, j): fmpq(int(random.integers(-999, 1000)), 7) * scales[i] * scales[j]
        for i in range(size)
        for j in range(size)
        if i == j or random.random() < 0.2
    }
    right = [fmpq(int(random.integers(-99, 100)), 3) * scale if random.random() < 0.5 else fmpq(0) for scale in scales]
    return {at: x for at, x in entries.items() if x != 0}, right


def exactly(entries: Entries, right: list[fmpq]) -> list[fmpq]:
    size = len(right)
    dense = [[entries.get((i, j), fmpq(0)) for j in range(size)] for i in range(size)]
    return fmpq_mat(dense).solve(fmpq_mat([[x] for x in right])).entries()


def in_balls(entries: Entries, right: list[fmpq]) -> list[arb] | None:
    return solved_from_doubles({at: arb(x) for at, x in entries.items()}, [arb(x) for x in right])


@pytest.mark.parametrize("seed", range(6))
def test_balls_hold_the_solution_and_are_narrow(seed: int) -> None:
    entries, right = drawn(seed, 40)
    with precision(BITS):
        found = in_balls(entries, right)
        assert found is not None
        exact = exactly(entries, right)
        largest = max(abs(arb(x)) for x in exact)
        for ball, x in zip(found, exact, strict=True):
            assert ball.contains(arb(x))
            assert ball.rad() < largest * arb(2) ** -260


def test_what_is_known_to_a_width_is_solved_to_the_width_that_it_makes() -> None:
    entries, right = drawn(0, 30)
    with precision(BITS):
        given = {at: arb(x) for at, x in entries.items()}
        wide = [arb(x) * (1 + arb(0, 1e-20)) for x in right]
        found = solved_from_doubles(given, wide)
        assert found is not None
        for sign in (1, -1):
            moved = [x * (1 + sign * fmpq(1, 2 * 10**20)) for x in right]
            assert all(ball.contains(arb(x)) for ball, x in zip(found, exactly(entries, moved), strict=True))


def test_a_zero_right_side_has_the_solution_zero() -> None:
    entries, right = drawn(1, 30)
    with precision(BITS):
        found = in_balls(entries, [0 * x for x in right])
        assert found is not None
        assert all(x == 0 for x in found)


def test_singular_and_nearly_singular_systems_are_left_to_elimination() -> None:
    with precision(BITS):
        assert in_balls({(0, 0): fmpq(1), (0, 1): fmpq(2), (1, 0): fmpq(2), (1, 1): fmpq(4)}, [fmpq(1)] * 2) is None
        hilbert = {(i, j): fmpq(1, i + j + 1) for i in range(14) for j in range(14)}
        assert in_balls(hilbert, [fmpq(1)] * 14) is None


@pytest.mark.parametrize("size", [fmpq(10) ** 280, fmpq(10) ** -280, fmpq(10) ** 400, fmpq(10) ** -400])
def test_numbers_beyond_the_range_of_doubles_are_left_to_elimination(size: fmpq) -> None:
    with precision(BITS):
        assert in_balls({(0, 0): size, (1, 1): fmpq(1)}, [fmpq(1), fmpq(1)]) is None
        assert in_balls({(0, 0): fmpq(1), (1, 1): fmpq(1)}, [size, fmpq(1)]) is None

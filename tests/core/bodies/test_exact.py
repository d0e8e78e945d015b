"""Rational mechanics against its own laws: Steiner, orthogonality, invariants; and pi against mpmath."""

from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies import exact
from core.errors import InvalidParameter
from tests.drawn import draws

number = st.floats(-1e3, 1e3)
quaternion = st.lists(number, min_size=4, max_size=4).filter(any)
IDENTITY = [[Fraction(int(i == j)) for j in range(3)] for i in range(3)]


def product(a: exact.Matrix, b: exact.Matrix) -> list[list[Fraction]]:
    return [[sum((a[i][k] * b[k][j] for k in range(3)), Fraction(0)) for j in range(3)] for i in range(3)]


def transposed(a: exact.Matrix) -> list[list[Fraction]]:
    return [list(column) for column in zip(*a, strict=True)]


def determinant(a: exact.Matrix) -> Fraction:
    return sum(
        (a[0][i] * (a[1][(i + 1) % 3] * a[2][(i + 2) % 3] - a[1][(i + 2) % 3] * a[2][(i + 1) % 3]) for i in range(3)),
        Fraction(0),
    )


def test_pi_to_two_hundred_bits() -> None:
    with mp.workdps(80):
        assert abs(mp.mpf(exact.PI.numerator) / exact.PI.denominator - mp.pi) < mp.mpf(2) ** -198


@settings(deadline=None)
@given(st.fractions().filter(bool), st.integers(-280, 280))
def test_a_pair_is_the_nearest_double_and_the_nearest_to_the_rest(x: Fraction, exponent: int) -> None:
    x *= Fraction(10) ** exponent
    value, tail = exact.pair(x)
    assert value == float(x)
    assert abs(x - Fraction(value) - Fraction(tail)) <= abs(x) / 2**106 + Fraction(1, 2**1075)


def test_doubles_are_pairs_without_a_tail() -> None:
    for x in (0.1, -1e300, 5e-324, 0.0):
        assert exact.pair(Fraction(x)) == (x, 0.0)


def test_what_is_too_large_is_refused() -> None:
    for x in (Fraction(10) ** 309, -(Fraction(10) ** 400)):
        with pytest.raises(InvalidParameter, match="range of doubles"):
            exact.pair(x)


@settings(deadline=None, max_examples=draws(50))
@given(quaternion)
def test_a_rotation_is_exactly_orthogonal(q: list[float]) -> None:
    turn = exact.rotation(q)
    assert product(turn, transposed(turn)) == IDENTITY
    assert determinant(turn) == 1


def test_a_rotation_takes_body_to_space() -> None:
    # A quarter turn about z takes x to y: [w, x, y, z] = [1, 0, 0, 1], of any length.
    assert exact.rotation([1, 0, 0, 1]) == [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    assert exact.rotation([-3, 0, 0, 0]) == IDENTITY
    assert exact.rotation([1e-200, 1e-200, 0, 0]) == [[1, 0, 0], [0, 0, -1], [0, 1, 0]]


@settings(deadline=None, max_examples=draws(40))
@given(quaternion, st.lists(number, min_size=6, max_size=6))
def test_a_rotated_tensor_has_the_same_invariants(q: list[float], entries: list[float]) -> None:
    xx, yy, zz, xy, xz, yz = map(Fraction, entries)
    tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    turned = exact.rotated(tensor, exact.rotation(q))
    assert turned == transposed(turned)
    assert sum(turned[i][i] for i in range(3)) == xx + yy + zz
    assert determinant(turned) == determinant(tensor)


@settings(deadline=None, max_examples=draws(40))
@given(st.lists(number, min_size=3, max_size=3), st.floats(1e-3, 1e3))
def test_a_point_mass_away_from_an_axis(offset: list[float], mass: float) -> None:
    nothing = [[Fraction(0)] * 3] * 3
    d = [Fraction(x) for x in offset]
    found = exact.parallel_axis(Fraction(mass), d, nothing)
    # The moment about the axis through the point is zero, whatever the direction.
    assert [sum(row[j] * d[j] for j in range(3)) for row in found] == [0, 0, 0]
    assert sum(found[i][i] for i in range(3)) == 2 * Fraction(mass) * sum(x * x for x in d)


def test_exact_sums_of_value_and_tail() -> None:
    value, tail = np.array([1.0, 2.0, 3.0]), np.array([1e-20, -1e-300, 0.0])
    assert exact.exact_vector(value, tail)[0] == 1 + Fraction(1e-20)
    assert exact.exact_vector(value, None) == [1, 2, 3]
    assert exact.exact_matrix(np.diag(value), np.diag(tail))[1][1] == 2 - Fraction(1e-300)


def test_a_mass_has_53_bits_down_to_the_least_normal_double() -> None:
    least = Fraction(np.finfo(float).smallest_normal)
    assert exact.size_pair(least) == (least, 0.0)
    assert exact.size_pair(Fraction(0)) == (0.0, 0.0)
    for less in (least / 2, -least / 2, least * Fraction(1023, 1024)):
        with pytest.raises(InvalidParameter):
            exact.size_pair(less)
    # A component of a vector may be subnormal.
    assert exact.pair(least / 2) == (least / 2, 0.0)

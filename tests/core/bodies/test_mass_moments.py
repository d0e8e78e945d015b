"""Sums of moments in fixed point against the same sums in rational numbers, which nothing rounds."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.bodies.exact import Matrix, parallel_axis, rotated, rotation
from core.bodies.mass_moments import BITS, MassMoments
from tests.drawn import draws

UNIT = Fraction(1, 2**BITS)

signed = st.floats(-1e3, 1e3)
wild = st.one_of(signed, st.floats(allow_nan=False, allow_infinity=False, min_value=-1e150, max_value=1e150))
positive = st.floats(1e-3, 1e3)
vectors = st.tuples(wild, wild, wild)
quaternions = st.tuples(wild, wild, wild, wild).filter(any)
bodies = st.tuples(positive, vectors, st.tuples(positive, positive, positive), quaternions, vectors)


def fractions(values: Any) -> list[Fraction]:
    return [Fraction(x) for x in values]


def diagonal(values: Any) -> Matrix:
    return [[Fraction(values[i]) if i == j else Fraction(0) for j in range(3)] for i in range(3)]


def together(parts: list[Any]) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
    """Return mass, centre of mass and inertia of placed bodies by the parallel-axis theorem, without rounding."""
    placed = []
    for mass, center, moments, attitude, position in parts:
        turn = rotation(attitude)
        at = [
            Fraction(p) + sum((r * Fraction(c) for r, c in zip(row, center, strict=True)), Fraction(0))
            for p, row in zip(position, turn, strict=True)
        ]
        placed.append((Fraction(mass), at, rotated(diagonal(moments), turn)))
    total = sum((m for m, _, _ in placed), Fraction(0))
    middle = [sum((m * c[k] for m, c, _ in placed), Fraction(0)) / total for k in range(3)]
    inertia = [[Fraction(0)] * 3 for _ in range(3)]
    for m, c, own in placed:
        moved = parallel_axis(m, [x - y for x, y in zip(c, middle, strict=True)], own)
        inertia = [[x + y for x, y in zip(a, b, strict=True)] for a, b in zip(inertia, moved, strict=True)]
    return total, middle, inertia


def in_fixed_point(parts: list[Any]) -> MassMoments:
    total = MassMoments()
    for mass, center, moments, attitude, position in parts:
        own = MassMoments.of(Fraction(mass), fractions(center), diagonal(moments))
        total += own.turned(attitude).moved(position)
    return total


@given(st.lists(bodies, min_size=1, max_size=3))
@settings(max_examples=draws(60), deadline=None, derandomize=True)
def test_the_sum_is_the_rational_sum(parts: list[Any]) -> None:
    mass, center, inertia = together(parts)
    found_mass, found_center, found_inertia = in_fixed_point(parts).properties()
    assert found_mass == mass
    # Far below half of the least double: 2^-1075.
    for x, y in zip(found_center, center, strict=True):
        assert abs(x - y) < Fraction(1, 2**2000) or (x == 0 and abs(y) < Fraction(1, 2**1074))
    trace = inertia[0][0] + inertia[1][1] + inertia[2][2]
    for row, expected in zip(found_inertia, inertia, strict=True):
        for x, y in zip(row, expected, strict=True):
            assert abs(x - y) < Fraction(1, 2**2000) or (x == 0 and abs(y) < trace / 2**256)


@given(bodies, quaternions)
@settings(max_examples=draws(40), deadline=None, derandomize=True)
def test_turning_back_is_to_have_turned_nothing(body: Any, attitude: Any) -> None:
    w, x, y, z = attitude
    assume(any((x, y, z)))
    own = MassMoments.of(Fraction(body[0]), fractions(body[1]), diagonal(body[2]))
    back = own.turned(attitude).turned((w, -x, -y, -z))
    assert back.mass == own.mass
    assert all(abs(a - b) <= 8 for a, b in zip(back.first, own.first, strict=True))
    assert all(abs(a - b) <= 32 for a, b in zip(back.second, own.second, strict=True))


def test_what_is_added_and_taken_away_leaves_nothing() -> None:
    one = MassMoments.of(Fraction(1, 3), fractions((0.1, 0.2, 0.3)), diagonal((1.0, 2.0, 2.5)))
    other = one.turned((0.1, 0.2, 0.3, 0.4)).moved((1e300, -1e-300, 7.0))
    assert one + other + -other == one
    assert not (other + -other).massive
    assert other + -other == MassMoments()


def test_a_place_nearer_to_the_origin_than_every_double_is_the_origin() -> None:
    least = Fraction(1, 2**1074)
    own = MassMoments.of(Fraction(1), (Fraction(0),) * 3, diagonal((1.0, 2.0, 2.5)))
    for place, found in ((least, least), (least / 2, least / 2), (least / 4, Fraction(0))):
        first = (int(place * (1 << BITS)), 0, 0)
        assert MassMoments(own.mass, first, own.second).properties()[1] == [found, 0, 0]


def test_attitudes_need_no_length_of_one() -> None:
    own = MassMoments.of(Fraction(2), fractions((0.1, 0.2, 0.3)), diagonal((1.0, 2.0, 2.5)))
    assert own.turned((0.5, 0.25, -0.125, 1.0)) == own.turned((2.0, 1.0, -0.5, 4.0))
    assert own.turned((5e-324, 0.0, 0.0, 0.0)) is own
    assert own.turned((-3.0, 0.0, 0.0, 0.0)) is own


@pytest.mark.parametrize("attitude", [(1.0, 1.0, 0.0, 0.0), (0.3, -0.7, 0.2, 0.9), (1e-300, 1e300, 1.0, 3.0)])
def test_numbers_do_not_grow_with_every_part(attitude: tuple[float, float, float, float]) -> None:
    # The denominators of a rational sum would reach 10^5 digits here.
    total = MassMoments()
    for k in range(300):
        own = MassMoments.of(Fraction(1, 3), fractions((0.1, 0.2, 0.3)), diagonal((1.0, 2.0, 2.5)))
        total += own.turned((attitude[0], attitude[1] + k, *attitude[2:])).moved((1.0, 2.0, k))
    assert max(x.bit_length() for x in total.second) < BITS + 64

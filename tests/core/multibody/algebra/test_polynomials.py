"""Polynomials of degree two against evaluation at random places."""

from __future__ import annotations

from typing import Any

from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from core.balls import precision
from core.multibody.algebra.polynomials import (
    BITS,
    Poly,
    change_by,
    combined,
    constant,
    coordinate,
    degree,
    difference,
    enclosed,
    evaluated,
    gradient,
    product,
    size,
    substituted,
    variables,
)

small = st.integers(-4, 4)


@st.composite
def affine(draw: Any) -> Poly:
    found: Poly = {(i,): arb(draw(small)) for i in range(3)}
    found[()] = arb(draw(small))
    return {key: value for key, value in found.items() if value != 0}


places = st.lists(small, min_size=3, max_size=3)


def at(poly: Poly, place: list[int]) -> float:
    return float(evaluated(poly, [arb(x) for x in place]))


@given(affine(), affine(), places)
def test_sums_and_products_are_those_of_values(a: Poly, b: Poly, place: list[int]) -> None:
    assert at(product(a, b), place) == at(a, place) * at(b, place)
    assert at(combined((arb(2), a), (arb(-3), b)), place) == 2 * at(a, place) - 3 * at(b, place)
    assert difference(a, a) == {}


@given(affine(), affine(), places)
def test_gradient_is_the_product_rule(a: Poly, b: Poly, place: list[int]) -> None:
    found = gradient(product(a, b))
    for i in range(3):
        expected = float(a.get((i,), arb(0))) * at(b, place) + float(b.get((i,), arb(0))) * at(a, place)
        assert at(found.get(i, {}), place) == expected


@given(affine(), affine(), st.lists(affine(), min_size=3, max_size=3), places)
def test_substitution_is_composition(a: Poly, b: Poly, inner: list[Poly], place: list[int]) -> None:
    moved = [int(at(poly, place)) for poly in inner]
    assert at(substituted(product(a, b), inner), place) == at(a, moved) * at(b, moved)


@given(affine(), affine(), places)
def test_size_bounds_the_value(a: Poly, b: Poly, place: list[int]) -> None:
    poly = product(a, b)
    assert abs(at(poly, place)) <= float(size(poly, [arb(x) for x in place]))


def test_degrees_and_variables() -> None:
    x, y = coordinate(0), coordinate(4)
    assert [degree(poly) for poly in ({}, constant(arb(2)), x, product(x, y))] == [-1, 0, 1, 2]
    assert variables([product(x, y)]) == {0, 4}


def test_terms_that_cancel_are_dropped_whatever_their_rounding() -> None:
    third = arb(1) / 3
    assert (
        combined((third, coordinate(0)), (third, coordinate(0)), (third, coordinate(0)), (arb(-1), coordinate(0))) == {}
    )


@given(st.lists(st.integers(-9, 9), min_size=2, max_size=2), st.sampled_from([0, 1000, 10**6, 10**9]))
def test_values_within_wide_balls_hold_those_inside_and_are_as_wide_wherever_the_origin_is(
    apart: list[int], origin: int
) -> None:
    """(x - y)^2 for x, y within 1/8 of places apart by n has values within n^2 +- (|n|/2 + 1/16)."""
    first, second = origin + apart[0], origin + apart[1]
    square = product(difference(coordinate(0), coordinate(1)), difference(coordinate(0), coordinate(1)))
    with precision(BITS):
        n, found = first - second, enclosed(square, [arb(first, 0.125), arb(second, 0.125)])
    for dx in (-0.125, 0.0, 0.125):
        for dy in (-0.125, 0.125):
            assert found.contains(arb((n + dx - dy) ** 2))
    # Terms of second order are not told to have one sign.
    assert float(found.rad()) <= abs(n) / 2 + 1 / 16 + 1e-6


def test_the_change_of_a_square_is_that_of_its_root_and_constants_change_as_much_as_the_rest() -> None:
    x, y = coordinate(0), coordinate(1)
    square, at, sizes = product(difference(x, y), difference(x, y)), [arb(1003), arb(1000)], [arb(2), arb(5)]
    assert float(change_by(square, at, sizes)) == 6 * 2 + 6 * 5
    assert float(change_by(difference(x, constant(arb(1000))), at, sizes)) == 2 + 2
    assert float(change_by(difference(x, constant(arb(1))), at, sizes)) == 2 + 1

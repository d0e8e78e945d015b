"""Polynomials of degree two against evaluation at random places."""

from __future__ import annotations

from typing import Any

from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from core.multibody.algebra.polynomials import (
    Poly,
    combined,
    constant,
    coordinate,
    degree,
    difference,
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

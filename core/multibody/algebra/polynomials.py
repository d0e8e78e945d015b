"""Polynomials of degree at most two in a scene's coordinates, with coefficients in balls.

A polynomial is a dictionary from monomials to coefficients: ``()`` is the constant, ``(i,)`` the coordinate i,
``(i, j)`` with i <= j a product. A coefficient that contains zero is zero: the radius of a ball is its
own measure of rounding, so no threshold of ours enters, whatever the units.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

from flint import arb

Ball = Any
"""A real number of `flint`, midpoint and radius; the package carries no types."""

Poly = dict[tuple[int, ...], Ball]

LinearForm = dict[int, Poly]
"""A linear form in the rates: for each coordinate whose rate enters, an affine polynomial. Lines of W are such."""

Key = TypeVar("Key")

ZERO: Ball = arb(0)
"""Nothing, without a radius."""

ONE: Ball = arb(1)
"""One, without a radius."""

BITS = 320
"""Working precision of the set-up: differences of 1e-90 of the terms are taken as zero."""


def larger(first: Ball, second: Ball) -> Ball:
    """Return the larger of two numbers, of which either may be recorded."""
    return second.max(first) if type(first) is arb else first.max(second)


def smaller(first: Ball, second: Ball) -> Ball:
    """Return the smaller of two numbers, of which either may be recorded."""
    return second.min(first) if type(first) is arb else first.min(second)


def entry(numbers: Mapping[Any, Ball], key: Any) -> Ball:
    """Return a number of a sparse array, zero where it has none."""
    found = numbers.get(key)
    return ZERO if found is None else found


def is_zero(ball: Ball) -> bool:
    """Return whether a ball cannot be told from zero."""
    # The zero of balls spares its conversion.
    return ZERO in ball


def constant(value: Ball) -> Poly:
    """Return a constant."""
    return {} if value == 0 else {(): value}


def coordinate(index: int) -> Poly:
    """Return one of the coordinates."""
    return {(index,): ONE}


def combined(*parts: tuple[Ball, Poly]) -> Poly:
    """Return the sum of polynomials, each times a number; terms that cancel are dropped."""
    total: Poly = {}
    for factor, poly in parts:
        for key, value in poly.items():
            term = factor * value
            old = total.get(key)
            total[key] = term if old is None else old + term
    return {key: value for key, value in total.items() if ZERO not in value}


def difference(first: Poly, second: Poly) -> Poly:
    """Return first - second."""
    return combined((ONE, first), (-ONE, second))


def product(first: Poly, second: Poly) -> Poly:
    """Return the product of two polynomials whose degrees add up to two at most."""
    total: Poly = {}
    for a, x in first.items():
        for b, y in second.items():
            key = a + b
            if len(key) == 2 and key[0] > key[1]:
                key = (key[1], key[0])
            assert len(key) <= 2, "a product of degree three is no part of a table"
            old = total.get(key)
            total[key] = x * y if old is None else old + x * y
    return {key: value for key, value in total.items() if ZERO not in value}


def dot(first: Sequence[Poly], second: Sequence[Poly]) -> Poly:
    """Return the scalar product of two vectors of polynomials."""
    return combined(*((ONE, product(a, b)) for a, b in zip(first, second, strict=True)))


def gradient(poly: Poly) -> dict[int, Poly]:
    """Return the derivatives with respect to the coordinates that occur."""
    found: dict[int, Poly] = {}
    for key, value in poly.items():
        if len(key) == 1:
            add_term(found.setdefault(key[0], {}), (), value)
        elif len(key) == 2:
            i, j = key
            if i == j:
                add_term(found.setdefault(i, {}), (i,), 2 * value)
            else:
                add_term(found.setdefault(i, {}), (j,), value)
                add_term(found.setdefault(j, {}), (i,), value)
    return found


def evaluated(poly: Poly, at: Sequence[Ball] | Mapping[int, Ball]) -> Ball:
    """Return the value of a polynomial at given coordinates."""
    total = ZERO
    for key, value in poly.items():
        if not key:
            total = total + value
        elif len(key) == 1:
            total = total + value * at[key[0]]
        else:
            total = total + value * at[key[0]] * at[key[1]]
    return total


def enclosed(poly: Poly, at: Sequence[Ball]) -> Ball:
    """Return the values for coordinates within wide balls, formed about the middles of these.

    As `evaluated`, the square of a difference would have the widths of squares of coordinates, however far the origin.
    """
    middle = [x.mid() for x in at]
    away = [x - y for x, y in zip(at, middle, strict=True)]
    total = evaluated(poly, middle)
    for j, slope in gradient(poly).items():
        total = total + evaluated(slope, middle) * away[j]
    return total + evaluated({key: value for key, value in poly.items() if len(key) == 2}, away)


def size(poly: Poly, at: Sequence[Ball]) -> Ball:
    """Return the sum of the magnitudes of the terms: what a residual is compared with."""
    total = ZERO
    for key, value in poly.items():
        term = value
        for i in key:
            term = term * at[i]
        total = total + abs(term)
    return total


def change_by(poly: Poly, at: Sequence[Ball], sizes: Sequence[Ball]) -> Ball:
    """Return by how much a polynomial changes at most, to first order, where every coordinate changes by its size.

    Of one of degree one its constant may change by as much, too. That of a quadratic is left out: the square of a
    distance far from the origin is a small difference of large terms, but no place is known worse for that.
    """
    if degree(poly) < 2:
        terms = size({key: value for key, value in poly.items() if key}, sizes)
        found: Ball = terms + smaller(abs(poly[()]), terms) if () in poly else terms
        return found
    return sum((abs(evaluated(slope, at) * sizes[j]) for j, slope in gradient(poly).items()), ZERO)


def degree(poly: Poly) -> int:
    """Return the degree, -1 of the zero polynomial."""
    return max(map(len, poly), default=-1)


def substituted(poly: Poly, expressions: Sequence[Poly]) -> Poly:
    """Return a polynomial with every coordinate replaced by an affine expression."""
    total: Poly = {}
    for key, value in poly.items():
        if not key:
            add_term(total, (), value)
        elif len(key) == 1:
            for a, x in expressions[key[0]].items():
                add_term(total, a, value * x)
        else:
            for a, x in expressions[key[0]].items():
                scaled = value * x
                for b, y in expressions[key[1]].items():
                    pair = a + b
                    add_term(total, (pair[1], pair[0]) if len(pair) == 2 and pair[0] > pair[1] else pair, scaled * y)
    return {key: value for key, value in total.items() if ZERO not in value}


def variables(polys: Iterable[Poly]) -> set[int]:
    """Return the coordinates that occur."""
    return {i for poly in polys for key in poly for i in key}


def add_term(total: dict[Key, Ball], key: Key, value: Ball) -> None:
    """Add a value to what a mapping has under a key."""
    old = total.get(key)
    total[key] = value if old is None else old + value

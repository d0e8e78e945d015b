"""Unit vectors along a direction that a description gives and across it, angles and products of vectors, in balls."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero


def unit(vector: Sequence[Ball], path: Path) -> list[Ball]:
    """Return a vector over its length.

    Raises
    ------
    InvalidParameter
        If it has none.
    """
    square = sum((x * x for x in vector), ZERO)
    if not square > 0:
        raise InvalidParameter(path, "have a direction: not all zero")
    # A vector along an axis stays exactly along it.
    single = [i for i, x in enumerate(vector) if not is_zero(x)]
    if len(single) == 1:
        positive = vector[single[0]] > 0
        return [(ONE if positive else -ONE) if i == single[0] else ZERO for i in range(len(vector))]
    size = square.sqrt()
    return [x / size for x in vector]


def perpendicular(along: Sequence[Ball], path: Path) -> list[list[Ball]]:
    """Return the unit vectors that complete a direction: one in the plane, two in space."""
    t = unit(along, path)
    if len(t) == 2:
        return [[-t[1], t[0]]]
    k = min(range(3), key=lambda i: abs(float(t[i])))
    e = [ONE if i == k else ZERO for i in range(3)]
    first = unit(cross(t, e), path)
    return [first, cross(t, first)]


def cross(a: Sequence[Ball], b: Sequence[Ball]) -> list[Ball]:
    """Return the cross product a x b of two vectors with three components."""
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


def scalar_product(a: Sequence[Ball], b: Sequence[Ball]) -> Ball:
    """Return the scalar product a.b of two vectors."""
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def polar_angle(cosine: Ball, sine: Ball) -> Ball:
    """Return the angle of a direction, which need not have the length one, from minus to plus half a turn (rad).

    A direction that may be on either side of half a turn has an angle as narrow as it is, about plus half a turn.
    """
    if cosine < 0 and is_zero(sine):
        return arb.pi() + arb.atan2(-sine, -cosine)
    return arb.atan2(sine, cosine)

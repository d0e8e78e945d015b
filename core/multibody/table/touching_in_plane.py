"""What touches in the plane: a circle or point on a face, and two circles: gaps and rates of slip.

Every gap is of degree two at most. Of a face it is n.(P - A) - R, of circles and edges (d.d - r^2)/(2r), with r the sum
of the radii, that of a hollow negative: to first order in the gap that is the gap itself, so that the multiplier is the
normal force. The rate of slip is that of the points of the two bodies that touch.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import (
    ONE,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    difference,
    dot,
    is_zero,
)
from core.multibody.table.contact_places import gap_of_rims
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates


def face(
    measures: Measures, a: tuple[Point, Ball], at: Point, normal: Sequence[Ball], path: Path, *, rubs: bool
) -> tuple[Poly, LinearForm | None]:
    """Return gap and slip of a circle on a face through a point, whose unit normal is in the axes of its body."""
    point, radius = a
    n = measures.coordinates.vector_of(at.body, normal, path)
    along = measures.coordinates.vector_of(at.body, [normal[1], -normal[0]], path)
    d = [difference(x, y) for x, y in zip(point.at, at.at, strict=True)]
    gap = combined((ONE, dot(n, d)), (-radius, constant(ONE)))
    if not rubs:
        return gap, None
    # A face's points move along it as one, so that its turning does not enter.
    parts = [(along[i], rate_of(d[i])) for i in range(2)]
    return gap, _sum(sum_of_rates(*parts), _times(radius, spin_of(measures, point.body, path)))


def circle(
    measures: Measures, a: tuple[Point, Ball], b: tuple[Point, Ball], path: Path, *, rubs: bool
) -> tuple[Poly, LinearForm | None]:
    """Return gap and slip of two circles; the second is hollow where its radius is negative."""
    gap, d, reach = gap_of_rims(a, b, path)
    if not rubs:
        return gap, None
    across = [combined((-1 / reach, d[1])), combined((1 / reach, d[0]))]
    rates = sum_of_rates(*((across[i], rate_of(d[i])) for i in range(2)))
    spins = [_times(-radius, spin_of(measures, point.body, path)) for point, radius in (a, b)]
    return gap, _sum(rates, *spins)


def spin_of(measures: Measures, body: str | None, path: Path) -> LinearForm:
    """Return the angular velocity of a body of the plane as a linear form; nothing of the ground and of particles."""
    if body is None:
        return {}
    frame = measures.coordinates.frames[body]
    if frame.turn is not None:
        return {frame.turn: constant(ONE)}
    if frame.direction is not None:
        c, s = frame.direction
        return {s: {(c,): ONE}, c: {(s,): -ONE}}
    if frame.radius is not None:
        raise InvalidParameter(path, f'rub on bodies that can turn, unlike "{body}"', remedy="give it its inertia")
    return {}


def _times(factor: Ball, rate: LinearForm) -> LinearForm:
    """Return a linear form times a number, nothing for zero."""
    return {} if is_zero(factor) else {j: combined((factor, poly)) for j, poly in rate.items()}


def _sum(*rates: LinearForm) -> LinearForm:
    found: LinearForm = {}
    for rate in rates:
        for j, poly in rate.items():
            found[j] = combined((ONE, found.get(j, {})), (ONE, poly))
    return {j: poly for j, poly in found.items() if poly}

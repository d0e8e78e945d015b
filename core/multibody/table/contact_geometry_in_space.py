"""Geometry of contacts in space: corners and balls on planes, with two directions of slip; smooth balls on one another.

On a plane through A with normal n the gap is n.(P - A) - h, with P a corner and h how far what is about it reaches
below. The point that touches slips with its velocity, less that of A, along two unit vectors of the plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import perpendicular, unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    degree,
    difference,
    dot,
    is_zero,
)
from core.multibody.language.contacts import Contact
from core.multibody.table.ball_on_box import facets_of_box, is_box
from core.multibody.table.connection_effects import Facet
from core.multibody.table.contact_places import Side, gap_of_rims, is_on, place_on, refuse_limits, two_sides
from core.multibody.table.level_rims import with_places
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates
from core.multibody.table.supports import Support, support


@dataclass(frozen=True)
class Touching:
    """What a contact in space is.

    Attributes
    ----------
    gap : polynomial
    slips : two linear forms in the rates, or None
        Without friction, none.
    tangents : two vectors, or None
    rolls : bool
        Whether sticking is rolling.
    together : bool
        Whether it is one of several places that land at once.
    facets : tuple of Facet
        What a ball may meet of a box.
    """

    gap: Poly
    slips: tuple[LinearForm, LinearForm] | None
    tangents: tuple[Sequence[Ball], Sequence[Ball]] | None
    rolls: bool
    together: bool = False
    facets: tuple[Facet, ...] = ()


def contact_in_space(measures: Measures, connection: Contact, name: str, path: Path, *, rubs: bool) -> list[Touching]:
    """Return gaps and slips of a contact in space, by its corners.

    Raises
    ------
    InvalidParameter
        Where it names nothing that can touch, or rubs where the directions of slip are not the same for ever.
    """
    if connection.measure != "gap":
        raise InvalidParameter((*path, "measure"), 'be "gap" in space', remedy="describe a stop in the plane")
    refuse_limits(connection, path)
    if is_on(connection, path):
        return _on(measures, connection, name, path, rubs=rubs)
    first, second = two_sides(measures, connection, path)
    for ball, box in ((first, second), (second, first)):
        if not rubs and ball.single and is_box(box) and bool(ball.radius >= 0):
            facets = facets_of_box(measures, name, ball, box, path)
            return [Touching(facets[0].gap, None, None, ball.round, facets=facets)]
    return _round(first, second, path, rubs=rubs)


def _on(measures: Measures, connection: Contact, name: str, path: Path, *, rubs: bool) -> list[Touching]:
    side, at, on = place_on(measures, connection, path)
    where = (*path, "on")
    if set(on) == {"radius"}:
        reach = measures.numerals.number(on["radius"], (*where, "radius"))
        return _round(side, Side([at], [()], reach), path, rubs=rubs)
    if not {"normal"} <= set(on) <= {"normal", "rate"}:
        raise InvalidParameter(
            where, "have at, and normal (and rate) or radius", remedy='a level floor is "normal": [0, 0, 1]'
        )
    n = unit(measures.numerals.vector(on["normal"], (*where, "normal"), 3), (*where, "normal"))
    if rubs and at.body is not None and measures.coordinates.frames[at.body].orients:
        raise InvalidParameter(
            (*path, "friction"),
            f'be left out on a plane that turns with "{at.body}": its directions of slip turn, too',
            remedy="describe the body without moments, as one that does not turn",
        )
    normal = measures.coordinates.vector_of(at.body, n, where)
    rims, side = side, with_places(measures, name, side, normal, path)
    level = side is not rims
    reach = support(measures, name, side, normal, path, levers=rubs)
    apart = [[difference(x, y) for x, y in zip(point.at, at.at, strict=True)] for point in side.points]
    gaps = [combined((ONE, dot(normal, d)), (-ONE, reach.depth)) for d in apart]
    if not rubs:
        return [Touching(gap, None, None, side.round, level) for gap in gaps]
    tangents = perpendicular(n, where)
    rate = measures.numerals.number(on.get("rate", 0), (*where, "rate"))
    if is_zero(rate):
        slips = [_slips(measures, f"{name}.slip.{k + 1}", reach, apart, e) for k, e in enumerate(tangents)]
    else:
        slips = [[], []]
        for i, d in enumerate(apart):
            for k, e in enumerate(tangents):
                own = f"{2 * i + k + 1}"
                turning = reach.carried(measures, (name, f"{name}.arm.{own}"), d, n, e, rate)
                line = sum_of_rates(*reach.velocity(d, e), turning)
                slips[k].append(_constant(measures, f"{name}.slip.{own}", line))
    return [
        Touching(gap, (one, other), (tangents[0], tangents[1]), side.round, level)
        for gap, one, other in zip(gaps, *slips, strict=True)
    ]


def _slips(
    measures: Measures, name: str, reach: Support, apart: Sequence[Sequence[Poly]], e: Sequence[Ball]
) -> list[LinearForm]:
    """Return the rates of slip of all corners along a direction, as forms with constant coefficients.

    Friction that turns with the slip takes its direction from such forms. Where the point that touches moves in the
    body, a coordinate is added whose rate is the slip of the first corner; that of another differs as the corners do.
    """
    first = _constant(measures, name, sum_of_rates(*reach.velocity(apart[0], e)))
    fixed = list(map(constant, e))
    beside = [rate_of(difference(dot(fixed, d), dot(fixed, apart[0]))) for d in apart]
    return [sum_of_rates((constant(ONE), first), (constant(ONE), rate)) for rate in beside]


def _constant(measures: Measures, name: str, line: LinearForm) -> LinearForm:
    """Return a rate as a form with constant coefficients, if need be by a coordinate whose rate it is."""
    if all(degree(poly) <= 0 for poly in line.values()):
        return line
    index = measures.table.coordinate(name, "m", ZERO)
    measures.roll(name.partition(".")[0], {**line, index: constant(-ONE)})
    return {index: constant(ONE)}


def _round(a: Side, b: Side, path: Path, *, rubs: bool) -> list[Touching]:
    """Return the gaps of balls, of which the second is hollow where its radius is negative; corners are in a hollow."""
    if rubs:
        raise InvalidParameter(
            (*path, "friction"),
            "be left out between two round bodies in space",
            remedy="let one of them be a plane, or describe rolling",
        )
    if not b.single or a.semi_axes or not (a.single or b.radius < 0):
        kinds = [side.frame.shape.kind for side in (a, b) if side.frame is not None and side.frame.shape is not None]
        raise InvalidParameter(
            path,
            f"be between balls, on a plane or in a hollow: contacts of a {kinds[0]} in space with other shapes are not "
            "answered yet",
            remedy="describe planes, or places of the body that touch",
        )
    gaps = [gap_of_rims((point, a.radius), (b.points[0], b.radius), path)[0] for point in a.points]
    return [Touching(gap, None, None, a.round or b.round) for gap in gaps]

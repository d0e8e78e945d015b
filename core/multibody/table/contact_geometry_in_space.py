"""Geometry of contacts in space: corners and balls on planes, with two directions of slip; smooth balls on one another.

On a plane through A with normal n the gap is n.(P - A) - R. The point of a ball that touches slips with
v_P - v_A - R w x n, of which the components along two unit vectors e of the plane are e.(v_P - v_A) - R (n x e).w.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import cross, perpendicular, unit
from core.multibody.algebra.polynomials import ONE, Ball, LinearForm, Poly, combined, constant, difference, dot, is_zero
from core.multibody.language.contacts import Contact
from core.multibody.table.contact_places import Side, gap_of_rims, is_on, place_on, refuse_limits, two_sides
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates


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
    """

    gap: Poly
    slips: tuple[LinearForm, LinearForm] | None
    tangents: tuple[Sequence[Ball], Sequence[Ball]] | None
    rolls: bool


def contact_in_space(measures: Measures, connection: Contact, path: Path, *, rubs: bool) -> list[Touching]:
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
        return _on(measures, connection, path, rubs=rubs)
    first, second = two_sides(measures, connection, path)
    return _round(first, second, path, rubs=rubs)


def _on(measures: Measures, connection: Contact, path: Path, *, rubs: bool) -> list[Touching]:
    side, at, on = place_on(measures, connection, path)
    where = (*path, "on")
    if set(on) == {"radius"}:
        reach = measures.numerals.number(on["radius"], (*where, "radius"))
        return _round(side, Side([at], [()], reach), path, rubs=rubs)
    if set(on) != {"normal"}:
        raise InvalidParameter(where, "have at, and normal or radius", remedy='a level floor is "normal": [0, 0, 1]')
    n = unit(measures.numerals.vector(on["normal"], (*where, "normal"), 3), (*where, "normal"))
    if rubs and at.body is not None and measures.coordinates.frames[at.body].orients:
        raise InvalidParameter(
            (*path, "friction"),
            f'be left out on a plane that turns with "{at.body}": its directions of slip turn, too',
            remedy="describe the body without moments, as one that does not turn",
        )
    return [_on_plane(measures, side, point, at, n, path, rubs=rubs) for point in side.points]


def _on_plane(
    measures: Measures, side: Side, point: Point, at: Point, n: Sequence[Ball], path: Path, *, rubs: bool
) -> Touching:
    """Return the contact of one corner or ball with a plane."""
    where = (*path, "on")
    d = [difference(x, y) for x, y in zip(point.at, at.at, strict=True)]
    normal = measures.coordinates.vector_of(at.body, n, where)
    gap = combined((ONE, dot(normal, d)), (-side.radius, constant(ONE)))
    if not rubs:
        return Touching(gap, None, None, side.round)
    along = perpendicular(n, where)
    slips = []
    for e in along:
        parts = [(constant(x), rate_of(d[i])) for i, x in enumerate(e) if not is_zero(x)]
        if side.round:
            frame = side.frame
            if frame is None or frame.turns is None:
                raise InvalidParameter(
                    (*path, "friction"),
                    "be left out of what is round in space and no ball that can turn",
                    remedy="give a ball its moments of inertia; a capsule touches without friction",
                )
            lever = [-side.radius * x for x in cross(n, e)]
            spin = {j: constant(x) for j, x in zip(frame.turns, lever, strict=True) if not is_zero(x)}
            parts.append((constant(ONE), spin))
        slips.append(sum_of_rates(*parts))
    return Touching(gap, (slips[0], slips[1]), (along[0], along[1]), side.round)


def _round(a: Side, b: Side, path: Path, *, rubs: bool) -> list[Touching]:
    """Return the gaps of balls, of which the second is hollow where its radius is negative; corners are in a hollow."""
    if rubs:
        raise InvalidParameter(
            (*path, "friction"),
            "be left out of what is round on both sides in space",
            remedy="let one of them be a plane, or describe rolling",
        )
    if not b.single or not (a.single or b.radius < 0):
        kinds = [side.frame.shape.kind for side in (a, b) if side.frame is not None and side.frame.shape is not None]
        raise InvalidParameter(
            path,
            f"be between balls, on a plane or in a hollow: contacts of a {kinds[0]} in space with other shapes are not "
            "answered yet",
            remedy="describe planes, or places of the body that touch",
        )
    gaps = [gap_of_rims((point, a.radius), (b.points[0], b.radius), path)[0] for point in a.points]
    return [Touching(gap, None, None, a.round or b.round) for gap in gaps]

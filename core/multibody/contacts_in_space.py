"""Geometry of contacts in space: places and balls on planes, with two directions of slip; smooth balls on one another.

On a plane through A with normal n the gap is n.(P - A) - R. The point of a ball that touches slips with
v_P - v_A - R w x n, of which the components along two unit vectors e of the plane are e.(v_P - v_A) - R (n x e).w.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.coordinates import Frame, Point, Rate
from core.multibody.measures import Measures, perpendicular, unit
from core.multibody.polynomials import ONE, ZERO, Ball, Poly, combined, constant, difference, dot, is_zero
from core.multibody.rolling import rate_of, sum_of_rates


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
    slips: tuple[Rate, Rate] | None
    tangents: tuple[Sequence[Ball], Sequence[Ball]] | None
    rolls: bool


def contact_in_space(measures: Measures, connection: Any, path: Path, *, rubs: bool) -> Touching:
    """Return gap and slip of a contact in space.

    Raises
    ------
    InvalidParameter
        Where it names nothing that can touch, or rubs where the directions of slip are not the same for ever.
    """
    if connection.measure != "gap":
        raise InvalidParameter((*path, "measure"), 'be "gap" in space', remedy="describe a stop in the plane")
    for entry in ("at_least", "at_most"):
        if getattr(connection, entry) is not None:
            raise InvalidParameter((*path, entry), 'be left out where the measure is no "turn"')
    if connection.place is not None and connection.on is not None and connection.a is None and connection.b is None:
        return _on(measures, connection, path, rubs=rubs)
    if connection.a is not None and connection.b is not None and connection.place is None and connection.on is None:
        first, second = (_ball(measures, getattr(connection, k), (*path, k)) for k in "ab")
        if first[0].body == second[0].body:
            raise InvalidParameter((*path, "b"), "belong to another body than a")
        return _round(measures, first, second, path, rubs=rubs)
    raise InvalidParameter(path, "have place and on, or a and b")


def _ball(measures: Measures, place: Any, path: Path) -> tuple[Point, Ball, Frame | None]:
    """Return centre and radius of a ball, or a place with the radius 0."""
    point = measures.coordinates.point(place, path)
    frame = measures.coordinates.frames.get(place) if isinstance(place, str) else None
    return point, ZERO if frame is None or frame.radius is None else frame.radius, frame


def _on(measures: Measures, connection: Any, path: Path, *, rubs: bool) -> Touching:
    point, radius, frame = _ball(measures, connection.place, (*path, "place"))
    where, on = (*path, "on"), connection.on
    if not isinstance(on, Mapping) or "at" not in on:
        raise InvalidParameter((*where, "at"), "be given")
    at = measures.coordinates.point(on["at"], (*where, "at"))
    if point.body is None and at.body is None:
        raise InvalidParameter(
            (*path, "place"),
            "belong to a body: a fixed point does not move on what is fixed",
            remedy='name a body or a place of one, as "table.foot"; or let the plane in "on" be that of a body',
        )
    if at.body == point.body:
        raise InvalidParameter((*where, "at"), "belong to another body than the place")
    keys = set(on) - {"at"}
    if keys == {"radius"}:
        reach = measures.numerals.number(on["radius"], (*where, "radius"))
        return _round(measures, (point, radius, frame), (at, reach, None), path, rubs=rubs)
    if keys != {"normal"}:
        raise InvalidParameter(where, "have at, and normal or radius", remedy='a level floor is "normal": [0, 0, 1]')
    n = unit(measures.numerals.vector(on["normal"], (*where, "normal"), 3), (*where, "normal"))
    d = [difference(x, y) for x, y in zip(point.at, at.at, strict=True)]
    normal = measures.coordinates.vector_of(at.body, n, where)
    gap = combined((ONE, dot(normal, d)), (-radius, constant(ONE)))
    rolls = not is_zero(radius)
    if not rubs:
        return Touching(gap, None, None, rolls)
    if at.body is not None and measures.coordinates.frames[at.body].orients:
        raise InvalidParameter(
            (*path, "friction"),
            f'be left out on a plane that turns with "{at.body}": its directions of slip turn, too',
            remedy="describe the body without moments, as one that does not turn",
        )
    along = perpendicular(n, where)
    slips = []
    for e in along:
        parts = [(constant(x), rate_of(d[i])) for i, x in enumerate(e) if not is_zero(x)]
        if rolls:
            if frame is None or frame.turns is None:
                raise InvalidParameter(
                    (*path, "friction"),
                    "be left out on balls that cannot turn",
                    remedy=f'give "{connection.place}" its moments of inertia',
                )
            lever = [-radius * x for x in _cross(n, e)]
            spin = {j: constant(x) for j, x in zip(frame.turns, lever, strict=True) if not is_zero(x)}
            parts.append((constant(ONE), spin))
        slips.append(sum_of_rates(*parts))
    return Touching(gap, (slips[0], slips[1]), (along[0], along[1]), rolls)


def _round(
    measures: Measures,
    a: tuple[Point, Ball, Frame | None],
    b: tuple[Point, Ball, Frame | None],
    path: Path,
    *,
    rubs: bool,
) -> Touching:
    """Return the gap of two balls; the second is hollow where its radius is negative."""
    if rubs:
        raise InvalidParameter(
            (*path, "friction"),
            "be left out of what is round on both sides in space",
            remedy="let one of them be a plane, or describe rolling",
        )
    reach = a[1] + b[1]
    if is_zero(reach):
        raise InvalidParameter(path, "have radii that differ: a point has no side of a point")
    if b[1] < 0 and reach > 0:
        raise InvalidParameter(path, "have a hollow that is larger than what is in it")
    d = [difference(x, y) for x, y in zip(a[0].at, b[0].at, strict=True)]
    half = 1 / (2 * reach)
    gap = combined((half, dot(d, d)), (-half * reach * reach, constant(ONE)))
    return Touching(gap, None, None, not (is_zero(a[1]) and is_zero(b[1])))


def _cross(a: Sequence[Ball], b: Sequence[Ball]) -> list[Ball]:
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] + ZERO for i in range(3)]

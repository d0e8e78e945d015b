"""What a contact is between: a place or a rim on a face or a circle, or two rims, in the plane and in space alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, difference, dot, is_zero
from core.multibody.language.contacts import Contact
from core.multibody.table.frames import Frame, Point
from core.multibody.table.measures import Measures

Rim = tuple[Point, Ball, Frame | None]
"""Centre and radius of a body with a rim and its frame, or a place with the radius 0."""


def refuse_limits(connection: Contact, path: Path) -> None:
    """Raise `InvalidParameter` where a gap has the limits of a turn."""
    for entry in ("at_least", "at_most"):
        if getattr(connection, entry) is not None:
            raise InvalidParameter((*path, entry), 'be left out where the measure is no "turn"')


def is_on(connection: Contact, path: Path, also: str = "") -> bool:
    """Return whether a place touches a face or a circle; otherwise two rims touch.

    Raises
    ------
    InvalidParameter
        Where neither is described.
    """
    on, between = (connection.place, connection.on), (connection.a, connection.b)
    if None not in on and between == (None, None):
        return True
    if None not in between and on == (None, None):
        return False
    raise InvalidParameter(path, f"have place and on, or a and b{also}")


def rim(measures: Measures, place: Any, path: Path) -> Rim:
    """Return centre and radius of a body with a rim, or a place with the radius 0."""
    point = measures.coordinates.point(place, path)
    frame = measures.coordinates.frames.get(place) if isinstance(place, str) else None
    return point, ZERO if frame is None or frame.radius is None else frame.radius, frame


def place_on(measures: Measures, connection: Contact, path: Path) -> tuple[Rim, Point, Mapping[str, Any]]:
    """Return what touches, a point of what it touches, and the rest of the description of that.

    Raises
    ------
    InvalidParameter
        Where both are fixed, or belong to one body.
    """
    first = rim(measures, connection.place, (*path, "place"))
    where, on = (*path, "on"), connection.on
    if not isinstance(on, Mapping) or "at" not in on:
        raise InvalidParameter((*where, "at"), "be given")
    at = measures.coordinates.point(on["at"], (*where, "at"))
    if first[0].body is None and at.body is None:
        face = "face" if measures.dimension == 2 else "plane"
        raise InvalidParameter(
            (*path, "place"),
            "belong to a body: a fixed point does not move on what is fixed",
            remedy=f'name a body or a place of one, as "rod.end"; or let the {face} in "on" be that of a body',
        )
    if at.body == first[0].body:
        raise InvalidParameter((*where, "at"), "belong to another body than the place")
    return first, at, {key: value for key, value in on.items() if key != "at"}


def two_rims(measures: Measures, connection: Contact, path: Path) -> tuple[Rim, Rim]:
    """Return the two rims of a contact.

    Raises
    ------
    InvalidParameter
        Where both are fixed, or belong to one body.
    """
    a, b = (rim(measures, getattr(connection, end), (*path, end)) for end in "ab")
    if a[0].body is not None and a[0].body == b[0].body:
        raise InvalidParameter((*path, "b"), "belong to another body than a")
    if a[0].body is None and b[0].body is None:
        raise InvalidParameter(path, "connect a body")
    return a, b


def gap_of_rims(a: tuple[Point, Ball], b: tuple[Point, Ball], path: Path) -> tuple[Poly, list[Poly], Ball]:
    """Return (d.d - r^2)/(2r) with the distance d and the sum r of the radii; the second is hollow where negative.

    To first order in the gap that is the gap itself, so that its multiplier is the normal force.
    """
    reach = a[1] + b[1]
    if is_zero(reach):
        raise InvalidParameter(path, "have radii that differ: a point has no side of a point")
    if b[1] < 0 and reach > 0:
        raise InvalidParameter(path, "have a hollow that is larger than what is in it")
    d = [difference(x, y) for x, y in zip(a[0].at, b[0].at, strict=True)]
    half = 1 / (2 * reach)
    return combined((half, dot(d, d)), (-half * reach * reach, constant(ONE))), d, reach

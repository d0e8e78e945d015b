"""What a contact is between: a place or a rim on a face or a circle, or two rims, in the plane and in space alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, difference, dot, is_zero
from core.multibody.language.contacts import Contact
from core.multibody.language.shapes import Corner
from core.multibody.table.frames import Frame, Point
from core.multibody.table.measures import Measures


@dataclass(frozen=True)
class Side:
    """One of two things that touch: corners with a radius, of which a place has one with the radius 0.

    Attributes
    ----------
    points : sequence of Point
        The corners.
    offsets : sequence of tuple of ball
        The same in body axes from the centre of mass (m); of the ground, its coordinates.
    radius : ball
        m; of a hollow below zero.
    frame : Frame or None
        Of a body that is named as a whole.
    semi_axes : tuple of ball
        Of the ellipsoid about every corner, in body axes (m); none where there is a ball.
    """

    points: Sequence[Point]
    offsets: Sequence[Corner]
    radius: Ball
    frame: Frame | None = None
    semi_axes: tuple[Ball, ...] = ()

    @property
    def body(self) -> str | None:
        """The body that carries it; None of the ground."""
        return self.points[0].body

    @property
    def round(self) -> bool:
        """Whether it is a body with a rim, so that sticking is rolling; the ground, hollow or not, does not turn."""
        return self.body is not None and (bool(self.semi_axes) or bool(self.radius > 0))

    @property
    def single(self) -> bool:
        """Whether it is a point, a disc of the plane or a ball."""
        return len(self.points) == 1 and not self.semi_axes


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


def side_of(measures: Measures, place: Any, path: Path) -> Side:
    """Return what a body touches with as a whole, or a place with the radius 0."""
    coordinates = measures.coordinates
    point = coordinates.point(place, path)
    frame = coordinates.frames.get(place) if isinstance(place, str) else None
    if frame is None or (frame.shape is None and frame.radius is None):
        return Side([point], [()], ZERO, frame)
    if frame.shape is None:
        assert frame.radius is not None
        return Side([point], [(ZERO,) * measures.dimension], frame.radius, frame)
    outline = frame.shape.outline
    points = [coordinates.carried(frame.name, corner, path) for corner in outline.corners]
    return Side(points, outline.corners, outline.radius, frame, outline.semi_axes)


def place_on(measures: Measures, connection: Contact, path: Path) -> tuple[Side, Point, Mapping[str, Any]]:
    """Return what touches, a point of what it touches, and the rest of the description of that.

    Raises
    ------
    InvalidParameter
        Where both are fixed, or belong to one body.
    """
    first = side_of(measures, connection.place, (*path, "place"))
    where, on = (*path, "on"), connection.on
    if not isinstance(on, Mapping) or "at" not in on:
        raise InvalidParameter((*where, "at"), "be given")
    at = measures.coordinates.point(on["at"], (*where, "at"))
    if first.body is None and at.body is None:
        face = "face" if measures.dimension == 2 else "plane"
        raise InvalidParameter(
            (*path, "place"),
            "belong to a body: a fixed point does not move on a fixed face",
            remedy=f'name a body or a place of one, as "rod.end"; or let the {face} in "on" be that of a body',
        )
    if at.body == first.body:
        raise InvalidParameter((*where, "at"), "belong to another body than the place")
    return first, at, {key: value for key, value in on.items() if key != "at"}


def two_sides(measures: Measures, connection: Contact, path: Path) -> tuple[Side, Side]:
    """Return the two sides of a contact.

    Raises
    ------
    InvalidParameter
        Where both are fixed, or belong to one body.
    """
    a, b = (side_of(measures, getattr(connection, end), (*path, end)) for end in "ab")
    if a.body is not None and a.body == b.body:
        raise InvalidParameter((*path, "b"), "belong to another body than a")
    if a.body is None and b.body is None:
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
        raise InvalidParameter(path, "have a hollow that is larger than the body in it")
    d = [difference(x, y) for x, y in zip(a[0].at, b[0].at, strict=True)]
    half = 1 / (2 * reach)
    return combined((half, dot(d, d)), (-half * reach * reach, constant(ONE))), d, reach

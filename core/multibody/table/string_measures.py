"""What all strings are made of: what they pass, their length, and the measure that is zero while they are taut."""

from __future__ import annotations

from dataclasses import dataclass

from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.polynomials import ONE, Ball, Poly, combined
from core.multibody.language.strings import String
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.contact_geometry import bounciness
from core.multibody.table.frames import Point
from core.multibody.table.measures import CLOSE, Measures


@dataclass
class Knot:
    """What a string passes: a place, or a drum.

    Attributes
    ----------
    radius : ball or None
        None for a place.
    turn : polynomial or None
        The drum's angle; None where the string slips.
    sides : list of str or None
        On which side each part touches, in the order of the string.
    senses : list of int
        The sense of winding that each part found.
    """

    point: Point
    name: str
    radius: Ball
    turn: Poly | None
    sides: list[str | None]
    senses: list[int]
    at: Path


def at_most(measures: Measures, part: str, longer: Poly, connection: String, path: Path) -> Unilateral:
    """Return the measure of a string: what it is longer than its way."""
    restitution, order = bounciness(measures, connection, path)
    gap = combined((-ONE, longer))
    return Unilateral(
        part,
        gap,
        restitution=restitution,
        closes="taut",
        opens="slack",
        order=order,
        law=measures.coordinates.scene.impacts,
    )


def require_long_enough(measures: Measures, way: Ball, length: Ball, path: Path, field: str = "length") -> None:
    """Raise `PlacesDisagree` where a string is shorter than its way at the start."""
    if not measures.sketch and way - length > CLOSE * length:
        raise PlacesDisagree(
            (*path, field), f"be at least {float(way):.10g} m, the way it goes at the start", remedy="leave it out"
        )


def written_length(measures: Measures, value: object, path: Path) -> Ball:
    """Return the length of a string as it was written (m)."""
    length = measures.numerals.number(value, (*path, "length"))
    if not length > 0:
        raise InvalidParameter((*path, "length"), "be greater than 0 m")
    return length

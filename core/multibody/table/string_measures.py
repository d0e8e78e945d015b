"""What all strings are made of: what they pass, their length, and the measure that is zero while they are taut."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined
from core.multibody.language.strings import String
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.contact_geometry import bounciness
from core.multibody.table.frames import Point
from core.multibody.table.measures import CLOSE, Measures

SIDES: Mapping[str, tuple[int, int]] = {"left": (0, -1), "right": (0, 1), "below": (1, -1), "above": (1, 1)}
"""A side of a drum: which component of the way from its centre to the tangent point, and the sign it has."""


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


def course(a: Knot, b: Knot, d: Sequence[Ball], path: Path) -> tuple[int, int, Ball, tuple[Ball, Ball]]:
    """Return how a straight part that touches a drum runs.

    Parameters
    ----------
    d : two balls
        From the first centre to the second at the start (m).

    Returns
    -------
    senses in which it winds at its ends, 0 at a place; d x u, with the sign reversed (m); the direction u

    Raises
    ------
    InvalidParameter
        For sides at which it cannot touch.
    """
    square = d[0] * d[0] + d[1] * d[1]
    found = []
    for ka, kb in product((1, -1) if a.radius is not None else (0,), (1, -1) if b.radius is not None else (0,)):
        offset = (ka * a.radius if ka else ZERO) - (kb * b.radius if kb else ZERO)
        rest = square - offset * offset
        if not rest > 0:
            continue
        span = rest.sqrt()
        u = ((span * d[0] + offset * d[1]) / square, (span * d[1] - offset * d[0]) / square)
        if all(_touches(knot, which, k, u) for knot, which, k in ((a, -1, ka), (b, 0, kb)) if k):
            found.append((ka, kb, offset, u))
    if len(found) != 1:
        culprit = a if a.radius is not None else b
        raise InvalidParameter(
            (*path, "sides", culprit.name), "be sides on which the string can touch, and which decide its course"
        )
    return found[0]


def _touches(knot: Knot, which: int, sense: int, u: tuple[Ball, Ball]) -> bool:
    side = knot.sides[which]
    assert side is not None
    component, sign = SIDES[side]
    way = (-u[1], u[0])[component] * sense * sign
    return bool(way > 0)


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
    if not measures.loose and way - length > CLOSE * length:
        raise PlacesDisagree(
            (*path, field), f"be at least {float(way):.10g} m, the way it goes {measures.moment}", remedy="leave it out"
        )


def written_length(measures: Measures, value: object, path: Path) -> Ball:
    """Return the length of a string as it was written (m)."""
    length = measures.numerals.number(value, (*path, "length"))
    if not length > 0:
        raise InvalidParameter((*path, "length"), "be greater than 0 m")
    return length

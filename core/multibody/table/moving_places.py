"""Places of the ground that move as formulas of time say, and what brings the energy for it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import degree, evaluated
from core.multibody.language.connection import TwoEnded
from core.multibody.language.written import GROUND
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.formulas_of_time import driven
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures


def place_of(measures: Measures, name: str, place: object, path: Path) -> Point:
    """Return a place, of which the components may be formulas of time if it belongs to the ground."""
    if place == GROUND:
        raise InvalidParameter(path, "be a place: of the ground, its coordinates")
    if isinstance(place, str) or not isinstance(place, Sequence) or len(place) != measures.dimension:
        return measures.coordinates.point(place, path)
    at = [driven(measures, name, value, (*path, i)) for i, value in enumerate(place)]
    measures.table.places.append([evaluated(x, measures.table.q) for x in at])
    return Point(at, None)


def ends_of(connection: TwoEnded, measures: Measures, name: str, path: Path) -> tuple[Point, Point]:
    """Return the places of the two ends of a connection."""
    ends = (("a", connection.a), ("b", connection.b))
    a, b = (place_of(measures, name, place, (*path, end)) for end, place in ends)
    return a, b


def require_two_bodies(a: Point, b: Point, path: Path) -> None:
    """Raise `InvalidParameter` for two places of one body."""
    if a.body == b.body:
        raise InvalidParameter(path, "connect two different bodies, or a body and the ground")


def driven_works(measures: Measures, name: str, first: int) -> Iterator[WorkTerm]:
    """Yield the work of what drives a connection, whose rows begin with number `first`: that of rows with the clock."""
    table = measures.table
    if "clock" not in table.names:
        return
    clock = table.names.index("clock")
    rows = [
        (r, line)
        for r, row in enumerate(table.rows[first:], first)
        if row.name == name and degree(line := row.rates.get(clock, {})) >= 0
    ]
    if rows:
        taken = any(work.name == name for work in measures.works)
        yield WorkTerm(f"{name}.drive" if taken else name, rows=rows)

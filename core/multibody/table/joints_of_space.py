"""Rows of joints that are of space alone: cylindrical joints, screws and universal joints."""

from __future__ import annotations

from collections.abc import Sequence

from core.balls import as_text
from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.directions import scalar_product, unit
from core.multibody.algebra.polynomials import ONE, combined, constant, difference, dot, evaluated, is_zero
from core.multibody.language.joints import Cylindrical, Screw, Universal
from core.multibody.language.written import GROUND
from core.multibody.table.frames import Point
from core.multibody.table.measures import CLOSE, Measures
from core.multibody.table.moving_places import ends_of, require_two_bodies
from core.multibody.table.rows import add_rows
from core.multibody.table.turns_in_space import turn_about


@add_rows.register
def cylindrical(connection: Cylindrical, measures: Measures, name: str, path: Path) -> None:
    """Hold a place on a line and the direction of that line in both bodies."""
    a, b = _ends_with_axes(connection, measures, name, path)
    where = (*path, "axis")
    axis = unit(measures.numerals.vector(connection.axis, where, 3), where)
    measures.slide(name, a, b, measures.in_body(b.body, axis), where)
    measures.aligned(name, a.body, b.body, [axis], path)


@add_rows.register
def screw(connection: Screw, measures: Measures, name: str, path: Path) -> None:
    """Hold a place on a line as a cylindrical joint does, and its way along that to the turn about it."""
    cylindrical(Cylindrical(connection.a, connection.b, connection.axis), measures, name, path)
    a, b = ends_of(connection, measures, name, path)
    pitch = measures.numerals.number(connection.pitch, (*path, "pitch"))
    if is_zero(pitch):
        remedy = "hold what does not move along its axis by a pin"
        raise InvalidParameter((*path, "pitch"), "be a number other than 0 m", remedy=remedy)
    axis = unit(measures.numerals.vector(connection.axis, (*path, "axis"), 3), (*path, "axis"))
    way = measures.coordinates.vector_of(b.body, measures.in_body(b.body, axis), path)
    along = dot(way, [difference(x, y) for x, y in zip(a.at, b.at, strict=True)])
    turn = turn_about(measures, name, (a.body or GROUND, b.body or GROUND), axis, measures.table.q, path)
    begun = constant(evaluated(along, measures.table.q))
    row = measures.hold(name, combined((ONE, along), (-pitch / (2 * ONE.pi()), turn), (-ONE, begun)))
    measures.force(f"{name}.force", [(row, constant(ONE))])


@add_rows.register
def universal(connection: Universal, measures: Measures, name: str, path: Path) -> None:
    """Hold two places together, and an axis of each body at right angles; the moment on `a` is along their product."""
    a, b = _ends_with_axes(connection, measures, name, path)
    where = (*path, "axes")
    if isinstance(connection.axes, str) or not isinstance(connection.axes, Sequence) or len(connection.axes) != 2:
        raise InvalidParameter(where, "be two vectors: one that is fixed in a, and one in b")
    axes = [unit(measures.numerals.vector(axis, (*where, i), 3), (*where, i)) for i, axis in enumerate(connection.axes)]
    off = scalar_product(*axes)
    if not (measures.loose or abs(off) < CLOSE):
        raise PlacesDisagree(where, f"be at right angles, unlike two whose cosine is {as_text(off, 4)}")
    measures.coincide(name, a, b, path)
    first, second = (
        measures.coordinates.vector_of(end.body, measures.in_body(end.body, axis), path)
        for end, axis in zip((a, b), axes, strict=True)
    )
    measures.force(f"{name}.moment", [(measures.hold(name, dot(first, second)), constant(ONE))], "N m")


def _ends_with_axes(
    connection: Cylindrical | Universal, measures: Measures, name: str, path: Path
) -> tuple[Point, Point]:
    if measures.dimension == 2:
        raise InvalidParameter((*path, "kind"), "be that of a connection of the plane, such as pin or slider")
    a, b = ends_of(connection, measures, name, path)
    require_two_bodies(a, b, path)
    for end, point in (("a", a), ("b", b)):
        if point.body is not None and measures.coordinates.frames[point.body].axes is None:
            raise InvalidParameter((*path, end), f'be of a body that has moments, unlike "{point.body}"')
    return a, b

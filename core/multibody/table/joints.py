"""Rows of connections that hold places or bodies to one another: pins, welds, sliders, rods, tracks."""

from __future__ import annotations

from collections.abc import Mapping

from core.balls import as_text
from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.directions import unit
from core.multibody.algebra.polynomials import ONE, ZERO, constant, difference, dot, evaluated
from core.multibody.language.joints import BallJoint, GuideCurve, Pin, Rod, Slider, Weld
from core.multibody.language.written import GROUND
from core.multibody.table.curves import on_curve_by_formulas, on_surface
from core.multibody.table.formulas_of_time import driven
from core.multibody.table.guides import rubbing_slider, rubbing_track, rubs
from core.multibody.table.measures import CLOSE, Measures
from core.multibody.table.moving_places import ends_of, require_two_bodies
from core.multibody.table.rows import add_rows


@add_rows.register
def pin(connection: Pin, measures: Measures, name: str, path: Path) -> None:
    """Hold two places together, and in space the direction of an axis, if there is one."""
    a, b = ends_of(connection, measures, name, path)
    measures.coincide(name, a, b, path)
    if connection.axis is None:
        return
    if measures.dimension == 2:
        raise InvalidParameter((*path, "axis"), "be left out in the plane")
    axis = unit(measures.numerals.vector(connection.axis, (*path, "axis"), 3), (*path, "axis"))
    frames = measures.coordinates.frames
    for body in (a.body, b.body):
        if body is not None and frames[body].axes is None:
            raise InvalidParameter((*path, "axis"), f'hold bodies that have moments, unlike "{body}"')
    measures.aligned(name, a.body, b.body, [axis], path)


@add_rows.register
def ball_joint(connection: BallJoint, measures: Measures, name: str, path: Path) -> None:
    """Hold two places of space together."""
    a, b = ends_of(connection, measures, name, path)
    if measures.dimension == 2:
        raise InvalidParameter((*path, "kind"), 'be "pin" in the plane')
    measures.coincide(name, a, b, path)


@add_rows.register
def rod(connection: Rod, measures: Measures, name: str, path: Path) -> None:
    """Hold two places at a distance."""
    a, b = ends_of(connection, measures, name, path)
    if connection.drive is not None and connection.length is not None:
        raise InvalidParameter((*path, "drive"), "be left out beside a length")
    drive = None if connection.drive is None else driven(measures, name, connection.drive, (*path, "drive"))
    measures.rod(name, a, b, connection.length, drive, path)


@add_rows.register
def slider(connection: Slider, measures: Measures, name: str, path: Path) -> None:
    """Hold a place on a line that is fixed in a body, and the orientation to that body."""
    a, b = ends_of(connection, measures, name, path)
    numerals, plane = measures.numerals, measures.dimension == 2
    require_two_bodies(a, b, path)
    if connection.direction is not None and connection.slope is not None:
        raise InvalidParameter((*path, "slope"), "be left out where a direction is given")
    if connection.direction is not None:
        along = numerals.vector(connection.direction, (*path, "direction"), measures.dimension)
    elif plane:
        along = numerals.angle(0 if connection.slope is None else connection.slope, (*path, "slope"))
    else:
        raise InvalidParameter((*path, "direction"), "be given")
    if rubs(measures, connection, path):
        if connection.drive is not None:
            raise InvalidParameter(
                (*path, "friction"), "be left out beside a drive, whose force it would share", remedy="leave out one"
            )
        rubbing_slider(measures, name, connection, (a, b), along, path)
        return
    for field in ("length", "width"):
        if getattr(connection, field) is not None and connection.friction is None:
            raise InvalidParameter((*path, field), "be left out of a slider without friction")
    measures.slide(name, a, b, along, (*path, "direction"))
    measures.unturned(name, a, b, path)
    if connection.drive is None:
        return
    where, size = (*path, "drive"), sum((x * x for x in along), ZERO).sqrt()
    unit = measures.coordinates.vector_of(b.body, [x / size for x in along], path)
    away = dot(unit, [difference(x, y) for x, y in zip(a.at, b.at, strict=True)])
    apart = difference(away, driven(measures, name, connection.drive, where))
    now = evaluated(away, measures.table.q)
    if not (measures.loose or abs(evaluated(apart, measures.table.q)) < CLOSE * (ONE + abs(now))):
        rule = f"be {as_text(now, 10)} m {measures.moment}, as the places are apart along the line"
        raise PlacesDisagree(where, rule, remedy="change it, or move the bodies")
    measures.force(f"{name}.drive", [(measures.hold(name, apart), constant(ONE))])


@add_rows.register
def weld(connection: Weld, measures: Measures, name: str, path: Path) -> None:
    """Hold the vector from one place to the other, and the orientation, as they are at the start."""
    a = measures.coordinates.point(connection.a, (*path, "a"))
    ground = [0] * measures.dimension
    b = measures.coordinates.point(ground if connection.b == GROUND else connection.b, (*path, "b"))
    require_two_bodies(a, b, path)
    carrier = b if b.body is not None and measures.coordinates.frames[b.body].orients else a
    other = a if carrier is b else b
    d = [difference(x, y) for x, y in zip(other.at, carrier.at, strict=True)]
    start = [evaluated(x, measures.table.q) for x in d]
    arm = measures.coordinates.vector_of(carrier.body, measures.in_body(carrier.body, start), path)
    sign = ONE if carrier is b else -ONE
    for axis, x, y in zip("xyz", d, arm, strict=False):
        row = measures.hold(name, difference(x, y))
        measures.force(f"{name}.{axis}", [(row, constant(sign))])
    measures.unturned(name, a, b, path)


@add_rows.register
def track(connection: GuideCurve, measures: Measures, name: str, path: Path) -> None:
    """Hold a place on a curve or surface."""
    given = connection.on if isinstance(connection.on, Mapping) else {}
    for kind, form in (("surface", on_surface), ("curve", on_curve_by_formulas)):
        if kind in given:
            form(measures, name, connection, path)
            return
    if rubs(measures, connection, path):
        rubbing_track(measures, name, connection, path)
        return
    measures.on_curve(name, measures.coordinates.point(connection.place, (*path, "place")), connection.on, path)

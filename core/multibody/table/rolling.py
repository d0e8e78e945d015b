"""Rolling without slip in the plane: a rim on a face or a circle, and bodies on one another."""

from __future__ import annotations

from collections.abc import Mapping

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    difference,
    dot,
    evaluated,
)
from core.multibody.language.contacts import Rolling
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.table import Row
from core.near_names import near_and_all

_FIXED = (
    'for a circle of the ground give "place": the body, and "on": {"at": [0, 0], "radius": 1}, in place of a and b; '
    "or describe it as a body with a radius that is pinned to the ground"
)


def rate_of(poly: Poly) -> LinearForm:
    """Return the rate of an affine polynomial as a linear form."""
    return {key[0]: constant(value) for key, value in poly.items() if key}


def sum_of_rates(*parts: tuple[Poly, LinearForm]) -> LinearForm:
    """Return a sum of linear forms with constant coefficients, each times an affine polynomial."""
    total: LinearForm = {}
    for factor, rate in parts:
        for j, value in rate.items():
            number = value.get((), ZERO)
            total[j] = combined((ONE, total.get(j, {})), (number, factor))
    return {j: poly for j, poly in total.items() if poly}


def rolling_in_plane(measures: Measures, name: str, connection: Rolling, path: Path) -> None:
    """Add the rows of a rim that rolls.

    Raises
    ------
    InvalidParameter
        Where it names no rim, or both or neither of its two forms.
    """
    if connection.place is not None and connection.on is not None and connection.a is None and connection.b is None:
        _on_ground_or_face(measures, name, connection, path)
    elif connection.a is not None and connection.b is not None and connection.place is None and connection.on is None:
        first, second = _rim(measures, connection.a, (*path, "a")), _rim(measures, connection.b, (*path, "b"))
        if connection.a == connection.b:
            raise InvalidParameter((*path, "b"), "be another body than a")
        radius = -second[1] if connection.inside else second[1]
        _on_circle(measures, name, first, (second[0], radius, second[2]), path)
    else:
        raise InvalidParameter(path, "have place and on, or a and b")


def _rim(measures: Measures, name: object, path: Path) -> tuple[Point, Ball, Poly]:
    """Return centre, radius and turn of a body with a rim."""
    frame = measures.coordinates.frames.get(name) if isinstance(name, str) else None
    if frame is None:
        remedy = near_and_all(name, measures.coordinates.frames, "bodies") if isinstance(name, str) else _FIXED
        raise InvalidParameter(path, "name a body of the scene", remedy=remedy)
    if frame.radius is None:
        raise InvalidParameter(path, f'name a body with a rim; "{name}" has no radius')
    return measures.coordinates.point(name, path), frame.radius, measures.coordinates.turn_of(name, path)


def _on_ground_or_face(measures: Measures, name: str, connection: Rolling, path: Path) -> None:
    rim = _rim(measures, connection.place, (*path, "place"))
    where, on = (*path, "on"), connection.on
    if not isinstance(on, Mapping) or "at" not in on:
        raise InvalidParameter((*where, "at"), "be given")
    at = measures.coordinates.point(on["at"], (*where, "at"))
    if at.body == rim[0].body:
        raise InvalidParameter((*where, "at"), "belong to another body than the rim")
    keys = set(on) - {"at"}
    if keys == {"radius"}:
        radius = measures.numerals.number(on["radius"], (*where, "radius"))
        if at.body is not None:
            raise InvalidParameter((*where, "at"), "be a point of the ground; use a and b for two bodies")
        _on_circle(measures, name, rim, (at, radius, {}), path)
        return
    if not keys <= {"slope"}:
        raise InvalidParameter(where, "have at, and slope or radius")
    cosine, sine = measures.numerals.angle(on.get("slope", 0), (*where, "slope"))
    along = measures.coordinates.vector_of(at.body, [cosine, sine], where)
    normal = measures.coordinates.vector_of(at.body, [-sine, cosine], where)
    d = [difference(x, y) for x, y in zip(rim[0].at, at.at, strict=True)]
    gap = measures.hold(name, combined((ONE, dot(normal, d)), (-rim[1], constant(ONE))))
    measures.force(f"{name}.normal", [(gap, constant(ONE))])
    # A face's points move along it as one, so that its turning does not enter.
    parts = [(along[i], rate_of(d[i])) for i in range(2)]
    slip = measures.roll(name, sum_of_rates(*parts, (constant(rim[1]), rate_of(rim[2]))))
    measures.force(f"{name}.friction", [(slip, constant(ONE))])


def _on_circle(
    measures: Measures, name: str, a: tuple[Point, Ball, Poly], b: tuple[Point, Ball, Poly], path: Path
) -> None:
    """Roll a rim on a circle, outside (its radius positive) or inside (negative)."""
    table = measures.table
    d = [difference(y, x) for x, y in zip(a[0].at, b[0].at, strict=True)]
    reach = a[1] + b[1]
    if 0 in reach:
        raise InvalidParameter(path, "have rims of different radii, one inside the other")
    start = [evaluated(x, table.q) / reach for x in d]
    size = (start[0] * start[0] + start[1] * start[1]).sqrt()
    if not size > 0:
        raise InvalidParameter(path, "start with its centres apart")
    n = [table.coordinate(f"{name}.normal.{axis}", "1", x / size) for axis, x in zip("xy", start, strict=True)]
    table.rows.append(Row.held(name, {(n[0], n[0]): ONE, (n[1], n[1]): ONE, (): -ONE}))
    rows = [measures.hold(name, difference(d[i], {(n[i],): reach})) for i in range(2)]
    measures.force(f"{name}.normal", [(rows[i], coordinate(n[i])) for i in range(2)])
    across: list[Poly] = [{(n[1],): -ONE}, {(n[0],): ONE}]
    parts = [(across[i], rate_of(d[i])) for i in range(2)]
    slip = measures.roll(name, sum_of_rates(*parts, (constant(-b[1]), rate_of(b[2])), (constant(-a[1]), rate_of(a[2]))))
    measures.force(f"{name}.friction", [(slip, constant(ONE))])

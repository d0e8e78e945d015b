"""Rolling without slip on a plane in space, which may turn like a table: balls, ellipsoids and rims of discs."""

from __future__ import annotations

from core.errors import Path
from core.multibody.algebra.directions import perpendicular, unit
from core.multibody.algebra.polynomials import ONE, combined, constant, difference, dot, is_zero
from core.multibody.table.contact_places import Side
from core.multibody.table.frames import Point
from core.multibody.table.measures import COMPONENTS, Measures
from core.multibody.table.rolling import sum_of_rates
from core.multibody.table.supports import support


def roll_on_plane(
    measures: Measures, name: str, side: Side, at: Point, normal: object, rate: object, path: Path
) -> None:
    """Add the rows of what rolls on a plane, which may turn about its normal through a given place.

    Parameters
    ----------
    side : Side
        Round about one corner.
    normal, rate : object
        Of the plane, as they were written.

    Raises
    ------
    InvalidParameter
        For a disc that lies flat at the start.
    """
    n = unit(measures.numerals.vector(normal, (*path, "normal"), 3), (*path, "normal"))
    d = [difference(x, y) for x, y in zip(side.points[0].at, at.at, strict=True)]
    reach = support(measures, name, side, list(map(constant, n)), path, levers=True)
    gap = measures.hold(name, combined((ONE, dot(list(map(constant, n)), d)), (-ONE, reach.depth)))
    measures.force(f"{name}.normal", [(gap, constant(ONE))])
    turning = measures.numerals.number(rate, (*path, "rate"))
    rows, across = [], perpendicular(n, path)
    for k, e in enumerate(across):
        parts = reach.velocity(d, e)
        if not is_zero(turning):
            parts.append(reach.carried(measures, (name, f"{name}.arm.{k + 1}"), d, n, e, turning))
        rows.append(measures.roll(name, sum_of_rates(*parts)))
    for i, axis in enumerate(COMPONENTS):
        terms = [(row, constant(e[i])) for row, e in zip(rows, across, strict=True) if not is_zero(e[i])]
        measures.force(f"{name}.friction.{axis}", terms)

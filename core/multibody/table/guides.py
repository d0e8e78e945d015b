"""Guides that rub: sliders and tracks of the plane as contacts on both sides of a line or circle, without play.

What is guided presses on one side at every place where the guide holds it. The gap of the other side is that of the
first below zero, so that both are zero all the time; only one of them pushes, because a guide is taken to be without
preload. What sticks, slides and jams is then what contacts do.

References
----------
J. L. Meriam, L. G. Kraige, "Engineering Mechanics: Statics", chapter 6 (friction: guides that jam, wedges).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    difference,
    dot,
    evaluated,
    is_zero,
)
from core.multibody.language.joints import GuideCurve, Slider
from core.multibody.language.written import GROUND
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.contact_geometry import coefficients_of_friction
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.moving_places import require_two_bodies
from core.multibody.table.rolling import rate_of, sum_of_rates
from core.multibody.table.touching_in_plane import circle, face

SIDES_OF_GUIDE = (ONE, -ONE)
"""Both sides of a line, that of its normal first; of a circle, outside and inside."""


def rubs(measures: Measures, connection: Slider | GuideCurve, path: Path) -> bool:
    """Return whether a slider or track has friction. The places of a sketch need not fit, and nothing in it rubs.

    Raises
    ------
    InvalidParameter
        For coefficients that cannot be, and in space.
    """
    if connection.friction is None:
        return False
    where = (*path, "friction")
    if measures.dimension != 2:
        raise InvalidParameter(where, "be left out in space", remedy="describe contacts of places with planes")
    static, _ = coefficients_of_friction(measures, connection.friction, where)
    return not is_zero(static) and not measures.sketch


def rubbing_slider(
    measures: Measures, name: str, connection: Slider, ends: tuple[Point, Point], along: Sequence[Ball], path: Path
) -> None:
    """Add the measures of a slider with friction: of its place, or of both ends of its block.

    What the bodies turn to each other is zero, and stands in a measure by its arm: a line of the table, whatever the
    attitude.

    Parameters
    ----------
    along : two balls
        Direction of the line in the axes of the body of `b`.

    Raises
    ------
    InvalidParameter
        For sizes that are not above zero, for a width without a length, and for a length between bodies of which one
        cannot turn.
    """
    a, b = ends
    x, y = unit(along, (*path, "direction"))
    tangent, normal = (measures.coordinates.vector_of(b.body, v, path) for v in ([x, y], [-y, x]))
    d = [difference(p, q) for p, q in zip(a.at, b.at, strict=True)]
    off, passing = dot(normal, d), [(tangent[i], rate_of(d[i])) for i in range(2)]
    length, width = (_size(measures, connection, field, path) for field in ("length", "width"))
    found = []
    if is_zero(length):
        if not is_zero(width):
            raise InvalidParameter((*path, "width"), "be left out without a length", remedy="give the length as well")
        measures.unturned(name, a, b, path)
        found = [(combined((side, off)), sum_of_rates(*passing)) for side in SIDES_OF_GUIDE]
    else:
        apart = difference(*(measures.coordinates.turn_of(one.body or GROUND, (*path, "length")) for one in ends))
        turned = difference(apart, constant(evaluated(apart, measures.table.q)))
        for arm in (-length / 2, length / 2):
            gap = combined((ONE, off), (arm, turned))
            # Towards the first side the block is pushed by the guide below it, half of its width from the line.
            found.extend(
                (combined((side, gap)), sum_of_rates(*passing, (constant(side * width / 2), rate_of(turned))))
                for side in SIDES_OF_GUIDE
            )
    _on_both_sides(measures, name, connection, found, path)


def rubbing_track(measures: Measures, name: str, connection: GuideCurve, path: Path) -> None:
    """Add the measures of a place on a line or circle with friction.

    Raises
    ------
    InvalidParameter
        For another curve, and for what belongs to one body.
    """
    on, where = connection.on, (*path, "on")
    keys = set(on) - {"at"}
    if "at" not in on or not (keys <= {"slope"} or keys == {"radius"}):
        raise InvalidParameter(
            where, "have at, and slope or radius, where it has friction", remedy="leave out the friction"
        )
    place, at = (
        measures.coordinates.point(x, way)
        for x, way in ((connection.place, (*path, "place")), (on["at"], (*where, "at")))
    )
    require_two_bodies(place, at, where)
    if keys == {"radius"}:
        radius = measures.numerals.number(on["radius"], (*where, "radius"))
        if not radius > 0:
            raise InvalidParameter((*where, "radius"), "be greater than 0 m")
        touching = [circle(measures, (place, ZERO), (at, side * radius), path, rubs=True) for side in SIDES_OF_GUIDE]
    else:
        cosine, sine = measures.numerals.angle(on.get("slope", 0), (*where, "slope"))
        n = [-sine, cosine]
        touching = [
            face(measures, (place, ZERO), at, [side * x for x in n], path, rubs=True) for side in SIDES_OF_GUIDE
        ]
    # Both sides slip along one direction, so that their friction adds up.
    found = [(gap, _times(side, slip or {})) for side, (gap, slip) in zip(SIDES_OF_GUIDE, touching, strict=True)]
    _on_both_sides(measures, name, connection, found, path)


def _size(measures: Measures, connection: Slider, field: str, path: Path) -> Ball:
    """Return the length or width of the block of a slider (m), zero where it is left out."""
    written = connection.length if field == "length" else connection.width
    if written is None:
        return ZERO
    size = measures.numerals.number(written, (*path, field))
    if not size > 0:
        raise InvalidParameter((*path, field), "be greater than 0 m")
    return size


def _times(factor: Ball, rates: LinearForm) -> LinearForm:
    return {j: combined((factor, poly)) for j, poly in rates.items()}


def _on_both_sides(
    measures: Measures,
    name: str,
    connection: Slider | GuideCurve,
    found: Sequence[tuple[Poly, LinearForm]],
    path: Path,
) -> None:
    """Add gaps and slips, of which every two in turn are of one place, as measures."""
    static, kinetic = coefficients_of_friction(measures, connection.friction, (*path, "friction"))
    common = Unilateral(name, {}, None, static, kinetic, opens="release", whole=name)
    names = [f"{name}.{i + 1}" for i in range(len(found))]
    for i, (gap, slip) in enumerate(found):
        measures.unilateral.append(replace(common, name=names[i], gap=gap, slip=slip, opposite=names[i ^ 1]))

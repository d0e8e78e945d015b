"""From the description of a contact to its unilateral measures: coefficients, stops, and what touches in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, difference, is_zero
from core.multibody.language.contacts import Contact, ImpactLaw
from core.multibody.language.strings import String
from core.multibody.language.written import GROUND
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.contact_geometry_in_space import contact_in_space
from core.multibody.table.contact_places import Side, is_on, place_on, refuse_limits, two_sides
from core.multibody.table.measures import Measures
from core.multibody.table.outlines import outlines
from core.multibody.table.rows import add_rows
from core.multibody.table.touching_in_plane import circle, face
from core.multibody.table.turns_in_space import turn_in_space


@add_rows.register
def contact(connection: Contact, measures: Measures, name: str, path: Path) -> None:
    """Add the unilateral measure of a contact.

    Raises
    ------
    InvalidParameter
        Where it names nothing that can touch, or coefficients out of their ranges.
    """
    static, kinetic = coefficients_of_friction(measures, connection.friction, (*path, "friction"))
    restitution, order = bounciness(measures, connection, path)
    rubs = not is_zero(static)
    law = impact_law(measures, connection, path)
    if rubs and measures.dimension == 3 and law != "newton":
        raise InvalidParameter(
            (*path, "impacts"),
            "be newton where a contact in space has friction: its slip turns while the impulse acts",
            remedy='leave out the friction, or take "newton" for this contact',
        )
    tangential = _tangential(measures, connection, path, rubs=rubs and law == "newton")
    common = Unilateral(name, {}, None, static, kinetic, restitution, order=order, law=law, tangential=tangential)
    if connection.measure == "turn":
        if rubs:
            raise InvalidParameter((*path, "friction"), "be left out of a stop that limits a turn")
        gap = _turn(measures, connection, name, path)
        found = [replace(common, gap=gap, closes="stop", opens="release", unit="N m")]
    elif measures.dimension == 3:
        found = [
            replace(
                common,
                gap=touching.gap,
                slip=None if touching.slips is None else touching.slips[0],
                across=None if touching.slips is None else touching.slips[1],
                tangents=touching.tangents,
                rolls=touching.rolls,
                facets=touching.facets,
                order=ZERO if touching.together and order is None else order,
            )
            for touching in contact_in_space(measures, connection, name, path, rubs=rubs)
        ]
    elif connection.measure != "gap":
        raise InvalidParameter((*path, "measure"), 'be "gap" or "turn"')
    else:
        refuse_limits(connection, path)
        where = _on if is_on(connection, path, ', or measure "turn"') else _between
        found = where(measures, connection, common, path)
    if len(found) > 1:
        found = [replace(one, name=f"{name}.{i + 1}", whole=name) for i, one in enumerate(found)]
    measures.unilateral.extend(found)


def impact_law(measures: Measures, connection: Contact, path: Path) -> ImpactLaw:
    """Return the law of the impacts of a contact: its own, or that of the scene."""
    law = connection.impacts
    if law is None:
        return measures.coordinates.scene.impacts
    if law not in get_args(ImpactLaw):
        raise InvalidParameter((*path, "impacts"), f"be one of {', '.join(get_args(ImpactLaw))}")
    return law


def bounciness(measures: Measures, connection: Contact | String, path: Path) -> tuple[Ball, Ball | None]:
    """Return coefficient of restitution and place in the order of simultaneous impacts."""
    restitution, order = ZERO, None
    if connection.restitution is not None:
        restitution = measures.numerals.number(connection.restitution, (*path, "restitution"))
        if restitution < 0 or restitution > 1:
            raise InvalidParameter(
                (*path, "restitution"),
                "be at least 0 and at most 1",
                remedy="it is the speed apart over the speed together: 1 is elastic, 0 leaves both in touch",
            )
    if connection.order is not None:
        order = measures.numerals.number(connection.order, (*path, "order"))
    return restitution, order


def _tangential(measures: Measures, connection: Contact, path: Path, *, rubs: bool) -> Ball:
    """Return the share of a slip that an impact turns back; friction does so, by Newton's law."""
    if connection.tangential_restitution is None:
        return ZERO
    where = (*path, "tangential_restitution")
    share = measures.numerals.number(connection.tangential_restitution, where)
    if share < 0 or share > 1:
        raise InvalidParameter(where, "be at least 0 and at most 1", remedy="0 lets it stick, 1 turns all of it back")
    if not rubs:
        raise InvalidParameter(
            where,
            "be left out of a contact without friction, and of one whose impacts are not by Newton's law",
            remedy='give its friction, and "impacts": "newton"',
        )
    return share


def coefficients_of_friction(measures: Measures, value: object, path: Path) -> tuple[Ball, Ball]:
    """Return the coefficients of sticking and of sliding, zero where none is given."""
    if value is None:
        return ZERO, ZERO
    if isinstance(value, Sequence) and not isinstance(value, str):
        if len(value) != 2:
            raise InvalidParameter(path, "be one coefficient, or two: of sticking and of sliding")
        static, kinetic = (measures.numerals.number(x, (*path, i)) for i, x in enumerate(value))
    else:
        static = kinetic = measures.numerals.number(value, path)
    if kinetic < 0 or static < 0:
        raise InvalidParameter(path, "be at least 0")
    if kinetic > static:
        raise InvalidParameter((*path, 1), "be at most the coefficient of sticking")
    return static, kinetic


def _turn(measures: Measures, connection: Contact, name: str, path: Path) -> Poly:
    for entry in ("place", "on"):
        if getattr(connection, entry) is not None:
            raise InvalidParameter((*path, entry), 'be left out where the measure is "turn"')
    if connection.a is None:
        raise InvalidParameter((*path, "a"), "be given")
    b = GROUND if connection.b is None else connection.b
    if connection.a == b:
        raise InvalidParameter((*path, "b"), "be another body than a")
    if measures.dimension == 3:
        angle = turn_in_space(measures, name, connection.a, b, path)
    else:
        turn = measures.coordinates.turn_of
        angle = difference(turn(connection.a, (*path, "a")), turn(b, (*path, "b")))
    if (connection.at_least is None) == (connection.at_most is None):
        raise InvalidParameter(path, "have either at_least or at_most")
    if connection.at_least is not None:
        return combined((ONE, angle), (-measures.numerals.number(connection.at_least, (*path, "at_least")), {(): ONE}))
    return combined((-ONE, angle), (measures.numerals.number(connection.at_most, (*path, "at_most")), {(): ONE}))


def _on(measures: Measures, connection: Contact, common: Unilateral, path: Path) -> list[Unilateral]:
    """Return the contacts of the corners of one side with a face or a circle."""
    side, at, on = place_on(measures, connection, path)
    where, keys = (*path, "on"), set(on)
    if keys == {"radius"}:
        reach = measures.numerals.number(on["radius"], (*where, "radius"))
        return _round(measures, side, Side([at], [()], reach), common, path)
    if not keys <= {"slope"} and keys != {"normal"}:
        raise InvalidParameter(where, "have at, and slope, normal or radius")
    if "normal" in keys:
        n = unit_in_plane(measures, on["normal"], (*where, "normal"))
    else:
        cosine, sine = measures.numerals.angle(on.get("slope", 0), (*where, "slope"))
        n = [-sine, cosine]
    rubs = not is_zero(common.static)
    touching = [face(measures, (point, side.radius), at, n, path, rubs=rubs) for point in side.points]
    return [replace(common, gap=gap, slip=slip, rolls=side.round) for gap, slip in touching]


def unit_in_plane(measures: Measures, value: object, path: Path) -> list[Ball]:
    """Return a direction of the plane as a unit vector."""
    x, y = measures.numerals.vector(value, path, 2)
    square = x * x + y * y
    if not square > 0:
        raise InvalidParameter(path, "have a direction: not all zero")
    if is_zero(x) or is_zero(y):
        return [ZERO if is_zero(z) else ONE if z > 0 else -ONE for z in (x, y)]
    size = square.sqrt()
    return [x / size, y / size]


def _between(measures: Measures, connection: Contact, common: Unilateral, path: Path) -> list[Unilateral]:
    a, b = two_sides(measures, connection, path)
    if a.single and b.single and not (a.round or b.round):
        raise InvalidParameter(
            path, "name a body with a rim or a shape: two points never meet", remedy="give one a radius"
        )
    return _round(measures, a, b, common, path)


def _round(measures: Measures, a: Side, b: Side, common: Unilateral, path: Path) -> list[Unilateral]:
    """Return the contacts of two outlines; the second is hollow where its radius is negative."""
    rubs, rolls = not is_zero(common.static), a.round or b.round
    if b.radius < 0 or (a.single and b.single):
        touching = [circle(measures, (point, a.radius), (b.points[0], b.radius), path, rubs=rubs) for point in a.points]
        return [replace(common, gap=gap, slip=slip, rolls=rolls) for gap, slip in touching]
    return outlines(measures, a, b, replace(common, rolls=rolls), path)

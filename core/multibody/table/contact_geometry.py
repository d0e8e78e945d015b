"""Geometry of contacts in the plane: gaps and rates of slip as polynomials of the table.

Every gap is of degree two at most. Of a face it is n.(P - A) - R, of circles and edges (d.d - r^2)/(2r), with r the sum
of the radii, that of a hollow negative: to first order in the gap that is the gap itself, so that the multiplier is the
normal force. The rate of slip is that of the points of the two bodies that touch.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.errors import InvalidParameter, Path
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
    is_zero,
)
from core.multibody.language.contacts import Contact
from core.multibody.language.strings import String
from core.multibody.language.written import GROUND
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.contact_geometry_in_space import contact_in_space
from core.multibody.table.contact_places import gap_of_rims, is_on, place_on, refuse_limits, two_rims
from core.multibody.table.frames import Frame, Point
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of, sum_of_rates
from core.multibody.table.rows import add_rows


@add_rows.register
def contact(connection: Contact, measures: Measures, name: str, path: Path) -> None:
    """Add the unilateral measure of a contact.

    Raises
    ------
    InvalidParameter
        Where it names nothing that can touch, or coefficients out of their ranges.
    """
    static, kinetic = _friction(measures, connection.friction, (*path, "friction"))
    restitution, order = bounciness(measures, connection, path)
    rubs = not is_zero(static)
    if measures.dimension == 3:
        touching = contact_in_space(measures, connection, path, rubs=rubs)
        slips = touching.slips or (None, None)
        measures.unilateral.append(
            Unilateral(
                name,
                touching.gap,
                slips[0],
                static,
                kinetic,
                restitution,
                rolls=touching.rolls,
                order=order,
                across=slips[1],
                tangents=touching.tangents,
            )
        )
        return
    if connection.measure == "turn":
        if rubs:
            raise InvalidParameter((*path, "friction"), "be left out of a stop that limits a turn")
        gap = _turn(measures, connection, path)
        stop = Unilateral(name, gap, restitution=restitution, closes="stop", opens="release", unit="N m", order=order)
        measures.unilateral.append(stop)
        return
    if connection.measure != "gap":
        raise InvalidParameter((*path, "measure"), 'be "gap" or "turn"')
    refuse_limits(connection, path)
    where = _on if is_on(connection, path, ', or measure "turn"') else _between
    gap, slip, rolls = where(measures, connection, path, rubs=rubs)
    measures.unilateral.append(
        Unilateral(name, gap, slip if rubs else None, static, kinetic, restitution, rolls=rolls, order=order)
    )


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


def _friction(measures: Measures, value: object, path: Path) -> tuple[Ball, Ball]:
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


def _turn(measures: Measures, connection: Contact, path: Path) -> Poly:
    for entry in ("place", "on"):
        if getattr(connection, entry) is not None:
            raise InvalidParameter((*path, entry), 'be left out where the measure is "turn"')
    if connection.a is None:
        raise InvalidParameter((*path, "a"), "be given")
    turn = measures.coordinates.turn_of
    b = GROUND if connection.b is None else connection.b
    if connection.a == b:
        raise InvalidParameter((*path, "b"), "be another body than a")
    angle = difference(turn(connection.a, (*path, "a")), turn(b, (*path, "b")))
    if (connection.at_least is None) == (connection.at_most is None):
        raise InvalidParameter(path, "have either at_least or at_most")
    if connection.at_least is not None:
        return combined((ONE, angle), (-measures.numerals.number(connection.at_least, (*path, "at_least")), {(): ONE}))
    return combined((-ONE, angle), (measures.numerals.number(connection.at_most, (*path, "at_most")), {(): ONE}))


def spin_of(measures: Measures, body: str | None, path: Path) -> LinearForm:
    """Return the angular velocity of a body of the plane as a linear form; nothing of the ground and of particles."""
    if body is None:
        return {}
    frame = measures.coordinates.frames[body]
    if frame.turn is not None:
        return {frame.turn: constant(ONE)}
    if frame.direction is not None:
        c, s = frame.direction
        return {s: {(c,): ONE}, c: {(s,): -ONE}}
    if frame.radius is not None:
        raise InvalidParameter(path, f'rub on bodies that can turn, unlike "{body}"', remedy="give it its inertia")
    return {}


def _times(factor: Ball, rate: LinearForm) -> LinearForm:
    """Return a linear form times a number, nothing for zero."""
    return {} if is_zero(factor) else {j: combined((factor, poly)) for j, poly in rate.items()}


def _sum(*rates: LinearForm) -> LinearForm:
    found: LinearForm = {}
    for rate in rates:
        for j, poly in rate.items():
            found[j] = combined((ONE, found.get(j, {})), (ONE, poly))
    return {j: poly for j, poly in found.items() if poly}


def _on(measures: Measures, connection: Contact, path: Path, *, rubs: bool) -> tuple[Poly, LinearForm, bool]:
    (point, radius, frame), at, on = place_on(measures, connection, path)
    where, keys = (*path, "on"), set(on)
    rolls = _rolls(frame)
    if keys == {"radius"}:
        reach = measures.numerals.number(on["radius"], (*where, "radius"))
        return *_circle(measures, (point, radius), (at, reach), path, rubs=rubs), rolls
    if not keys <= {"slope"} and keys != {"normal"}:
        raise InvalidParameter(where, "have at, and slope, normal or radius")
    if "normal" in keys:
        n = unit_in_plane(measures, on["normal"], (*where, "normal"))
        cosine, sine = n[1], -n[0]
    else:
        cosine, sine = measures.numerals.angle(on.get("slope", 0), (*where, "slope"))
    along = measures.coordinates.vector_of(at.body, [cosine, sine], where)
    normal = measures.coordinates.vector_of(at.body, [-sine, cosine], where)
    d = [difference(x, y) for x, y in zip(point.at, at.at, strict=True)]
    gap = combined((ONE, dot(normal, d)), (-radius, constant(ONE)))
    if not rubs:
        return gap, {}, rolls
    # A face's points move along it as one, so that its turning does not enter.
    parts = [(along[i], rate_of(d[i])) for i in range(2)]
    return gap, _sum(sum_of_rates(*parts), _times(radius, spin_of(measures, point.body, path))), rolls


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


def _between(measures: Measures, connection: Contact, path: Path, *, rubs: bool) -> tuple[Poly, LinearForm, bool]:
    a, b = two_rims(measures, connection, path)
    rolls = _rolls(a[2]) or _rolls(b[2])
    if not rolls:
        raise InvalidParameter(path, "name a body with a rim: two points never meet", remedy="give one a radius")
    return *_circle(measures, a[:2], b[:2], path, rubs=rubs), rolls


def _rolls(frame: Frame | None) -> bool:
    return frame is not None and frame.radius is not None


def _circle(
    measures: Measures, a: tuple[Point, Ball], b: tuple[Point, Ball], path: Path, *, rubs: bool
) -> tuple[Poly, LinearForm]:
    """Return gap and slip of two circles; the second is hollow where its radius is negative."""
    gap, d, reach = gap_of_rims(a, b, path)
    if not rubs:
        return gap, {}
    across = [combined((-1 / reach, d[1])), combined((1 / reach, d[0]))]
    rates = sum_of_rates(*((across[i], rate_of(d[i])) for i in range(2)))
    spins = [_times(-radius, spin_of(measures, point.body, path)) for point, radius in (a, b)]
    return gap, _sum(rates, *spins)

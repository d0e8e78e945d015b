"""A heavy chain over a smooth peg of the plane: one coordinate, with all of the chain's mass.

With z the length of the first side, u_1 and u_2 the directions of the sides from the peg, A and B the components of
gravity along them, L the length and rho the mass per length, the kinetic energy is rho L z'^2/2 and the potential
-rho A z^2/2 - rho B (L - z)^2/2: nothing exceeds degree two. The ends are held on their lines, at z and L - z from the
peg; the multipliers of these two rows are the tensions T_1 and T_2 there. What moves between an end and the peg gives
the tension at the peg, with z'' eliminated,

    T = T_1 (1 - z/L) + T_2 z/L + rho (A + B) z (1 - z/L).

To turn from one side to the other, what passes the peg takes rho z'^2 of it: the peg is pressed with
(T - rho z'^2) |u_1 + u_2|, and the chain lifts off where that vanishes (docs/physics/chain-on-wedge.md).
"""

from __future__ import annotations

from math import inf

from core.balls import raised
from core.errors import InvalidParameter, NotApplicable, Path
from core.multibody.algebra.directions import unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    coordinate,
    difference,
    dot,
    evaluated,
    is_zero,
)
from core.multibody.language.strings import Chain
from core.multibody.table.connection_effects import Force, Limit
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.momenta import StateFunction
from core.multibody.table.rows import add_rows


@add_rows.register
def chain(connection: Chain, measures: Measures, name: str, path: Path) -> None:
    """Add the coordinate, the rows and the forces of a chain.

    Raises
    ------
    InvalidParameter
        For a chain in space, ends that are no places of two bodies, a peg that moves or that an end touches, sides
        that continue one another, a density that is not positive, and a weight beyond the range of doubles.
    NotApplicable
        Beside contacts and strings that jerk, and in a spinning frame.
    """
    _require_alone(measures, path)
    first, peg, last = _places(measures, connection, path)
    density = measures.numerals.number(connection.density, (*path, "density"))
    if not density > 0:
        raise InvalidParameter(
            (*path, "density"), "be greater than 0 kg/m", remedy="describe a chain without mass as a string"
        )
    at = [evaluated(x, measures.table.q) for x in peg.at]
    ways = [_direction(measures, end, peg, (*path, "through", i)) for end, i in ((first, 0), (last, 2))]
    bend = sum((raised(x + y, 2) for x, y in zip(*ways, strict=True)), ZERO)
    if is_zero(bend):
        raise InvalidParameter(
            (*path, "through"), "bend at the peg", remedy="leave the peg out: describe the chain as a body"
        )
    sides = []
    for end, way in zip((first, last), ways, strict=True):
        d = [difference(x, y) for x, y in zip(end.at, peg.at, strict=True)]
        measures.hold(name, dot([constant(-way[1]), constant(way[0])], d))
        sides.append(dot([constant(x) for x in way], d))
    start, rest = (evaluated(side, measures.table.q) for side in sides)
    length = start + rest
    if connection.length is not None:
        length = measures.numerals.number(connection.length, (*path, "length"))
        if not length > 0:
            raise InvalidParameter((*path, "length"), "be greater than 0 m")
    z = measures.table.coordinate(f"{name}.1.length", "m", start)
    rows = (
        measures.hold(name, difference(coordinate(z), sides[0])),
        measures.hold(name, combined((ONE, coordinate(z)), (ONE, sides[1]), (-length, constant(ONE)))),
    )
    pulls = [sum((x * y for x, y in zip(measures.coordinates.gravity, way, strict=True)), ZERO) for way in ways]
    hanging = density * length * (abs(pulls[0]) + abs(pulls[1]))
    weight = float(hanging)
    if not weight < inf or (weight == 0.0 and not is_zero(hanging)):
        # Its forces decide where it lifts off, and they are looked at in doubles.
        raise InvalidParameter(
            (*path, "density"),
            "give the chain a weight within the range of doubles",
            remedy="choose units in which the numbers are moderate",
        )
    _weigh(measures, z, density, length, pulls, at)
    _name_forces(measures, name, z, rows, density, length, pulls, bend.sqrt(), weight)
    measures.momenta[name] = _momenta(z, density, length, at, ways)


def _require_alone(measures: Measures, path: Path) -> None:
    remedy = "leave out restitution, and hold what touches by a connection of another kind"
    if measures.one_sided:
        raise NotApplicable(
            "a chain is followed until it lifts off or ends at its peg, not through contacts and jerks",
            path=path,
            remedy=remedy,
        )
    if measures.dimension != 2:
        raise InvalidParameter(path, "be in the plane: the plane of the chain and its peg")
    for i, other in measures.coordinates.scene.numbered():
        if other.everywhere:
            raise NotApplicable(
                f"what a {other.kind} does to the links of a chain is not modelled", path=("connections", i)
            )


def _places(measures: Measures, connection: Chain, path: Path) -> tuple[Point, Point, Point]:
    through = connection.through
    if not isinstance(through, (list, tuple)) or len(through) != 3:
        raise InvalidParameter((*path, "through"), "be a list of three places: an end, the peg and the other end")
    points = [measures.coordinates.point(entry, (*path, "through", i)) for i, entry in enumerate(through)]
    first, peg, last = points
    if peg.body is not None:
        raise InvalidParameter((*path, "through", 1), "be a point of the ground: a peg does not move")
    for i in (0, 2):
        if points[i].body is None:
            raise InvalidParameter(
                (*path, "through", i),
                "be a place of a body",
                remedy="give the bare end of a chain a body of mass 0",
            )
    if first.body == last.body:
        raise InvalidParameter((*path, "through", 2), "belong to another body than the first end")
    return first, peg, last


def _direction(measures: Measures, end: Point, peg: Point, path: Path) -> list[Ball]:
    """Return the direction from the peg to an end."""
    d = [evaluated(difference(x, y), measures.table.q) for x, y in zip(end.at, peg.at, strict=True)]
    if not d[0] * d[0] + d[1] * d[1] > 0:
        raise InvalidParameter(path, "start away from the peg: the line of this side is not determined")
    return unit(d, path)


def _weigh(measures: Measures, z: int, density: Ball, length: Ball, pulls: list[Ball], at: list[Ball]) -> None:
    """Add the mass of the chain and its potential, which is measured from the origin as that of the bodies is."""
    table, (first, last) = measures.table, pulls
    table.add_mass(z, z, density * length)
    fall: Poly = {}
    if not is_zero(first + last):
        table.add_stiffness(z, z, -density * (first + last))
        fall[z, z] = -density * (first + last) / 2
    if not is_zero(last):
        table.add_load(z, -density * last * length)
        fall[z,] = density * last * length
    measures.fall = combined((ONE, measures.fall), (ONE, fall))
    peg = sum((x * y for x, y in zip(measures.coordinates.gravity, at, strict=True)), ZERO)
    measures.potential = measures.potential - density * length * (last * length / 2 + peg)


def _name_forces(
    measures: Measures,
    name: str,
    z: int,
    rows: tuple[int, int],
    density: Ball,
    length: Ball,
    pulls: list[Ball],
    bend: Ball,
    weight: float,
) -> None:
    """Name the tensions at the ends and at the peg, and the force on the peg; say which of them stay positive."""
    share: Poly = {(z,): 1 / length}
    pull = density * (pulls[0] + pulls[1])
    hung: Poly = {} if is_zero(pull) else {(z,): pull, (z, z): -pull / length}
    terms = [(rows[0], combined((ONE, constant(ONE)), (-ONE, share))), (rows[1], combined((-ONE, share)))]
    for i, sign in ((0, ONE), (1, -ONE)):
        force = measures.force(f"{name}.{i + 1}.tension", [(rows[i], constant(sign))])
        measures.limits.append(Limit("slack", f"{name}.{i + 1}", force=force, scale=weight))
    measures.forces.append(Force(f"{name}.tension", "N", terms, hung))
    pressed = [(row, combined((bend, poly))) for row, poly in terms]
    measures.forces.append(Force(f"{name}.normal", "N", pressed, combined((bend, hung)), {}, {z: -density * bend}))
    measures.limits.append(Limit("lift-off", name, force=len(measures.forces) - 1, scale=weight * float(bend)))
    measures.limits.append(Limit("end-of-chain", f"{name}.1", length=coordinate(z)))
    rest = combined((length, constant(ONE)), (-ONE, coordinate(z)))
    measures.limits.append(Limit("end-of-chain", f"{name}.2", length=rest))


def _momenta(
    z: int, density: Ball, length: Ball, at: list[Ball], ways: list[list[Ball]]
) -> tuple[StateFunction, StateFunction]:
    """Return momentum and angular momentum about the origin: rho z on the first side, rho (L - z) back on the other."""
    rho, size = float(density), float(density * length)
    along = [(float(x + y), float(y)) for x, y in zip(*ways, strict=True)]
    first, last = (float(at[0] * way[1] - at[1] * way[0]) for way in ways)
    turns = (first + last, last)
    moved, turned = (
        StateFunction(kind, [[(rho * both, z, z), (-size * one, None, z)] for both, one in components])
        for kind, components in (("kg m/s", along), ("kg m^2/s", [turns]))
    )
    return moved, turned

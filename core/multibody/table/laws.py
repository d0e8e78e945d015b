"""Connections that pull or drive: springs, dampers, motors, spinning frames, constant forces and torques."""

from __future__ import annotations

from collections.abc import Sequence

from core.balls import as_text
from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    coordinate,
    difference,
    entry,
    evaluated,
    is_zero,
    product,
)
from core.multibody.language.connection import TwoEnded
from core.multibody.language.forces import AppliedForce, Damper, Motor, SpinningFrame, Spring, TorsionSpring
from core.multibody.language.written import GROUND
from core.multibody.table.connection_effects import Force, WorkTerm
from core.multibody.table.formula_laws import (
    damper_by_law,
    force_by_formulas,
    spring_by_law,
)
from core.multibody.table.formulas_of_time import clock, driven
from core.multibody.table.frames import Point
from core.multibody.table.measures import CLOSE, Measures
from core.multibody.table.moving_places import place_of
from core.multibody.table.rolling import rate_of, sum_of_rates
from core.multibody.table.rows import add_rows
from core.multibody.table.turns_in_space import turn_in_space


@add_rows.register
def spring(connection: Spring, measures: Measures, name: str, path: Path) -> None:
    """Add a spring between two places: linear, of energy k (l - l_0)^2/2, or with its pull as a formula."""
    if connection.law is None:
        a, b = (
            place_of(measures, name, place, (*path, end)) for end, place in (("a", connection.a), ("b", connection.b))
        )
    else:
        a, b = _ends(measures, connection, path)
    if connection.law is not None:
        spring_by_law(connection, measures, name, a, b, path)
        return
    k = _positive(measures, connection.stiffness, (*path, "stiffness"))
    d = [difference(y, x) for x, y in zip(a.at, b.at, strict=True)]
    rest = None
    if connection.rest_length is not None:
        rest = measures.numerals.number(connection.rest_length, (*path, "rest_length"))
        if rest < 0:
            raise InvalidParameter((*path, "rest_length"), "be at least 0 m")
        if is_zero(rest):
            # Without a rest length the pull is k d: nothing but stiffness, whatever the direction.
            if (a.body is None and b.body is None) or a.body == b.body:
                raise InvalidParameter(path, "connect two different bodies, or a body and the ground")
            for component in d:
                _potential(measures, component, k)
            measures.works.append(WorkTerm(name, combined(*((k / 2, product(x, x)) for x in d))))
            for axis, component in zip("xyz", d, strict=False):
                measures.forces.append(Force(f"{name}.{axis}", "N", [], combined((k, component))))
            return
    index = measures.length(name, a, b, path)
    if rest is None:
        rest = measures.table.q[index]
    stretch = combined((ONE, coordinate(index)), (-rest, constant(ONE)))
    _potential(measures, stretch, k)
    measures.works.append(WorkTerm(name, combined((k / 2, product(stretch, stretch)))))
    pull = combined((k, coordinate(index)), (-k * rest, constant(ONE)))
    measures.forces.append(Force(f"{name}.force", "N", [], pull))


@add_rows.register
def torsion_spring(connection: TorsionSpring, measures: Measures, name: str, path: Path) -> None:
    """Add a linear spring between two turns: energy k (angle - rest)^2/2."""
    k = _positive(measures, connection.stiffness, (*path, "stiffness"))
    turn = _turn(measures, connection, name, path)
    if connection.rest_angle is None:
        rest = evaluated(turn, measures.table.q)
    else:
        rest = measures.numerals.number(connection.rest_angle, (*path, "rest_angle"))
    away = combined((ONE, turn), (-rest, constant(ONE)))
    _potential(measures, away, k)
    measures.works.append(WorkTerm(name, combined((k / 2, product(away, away)))))
    measures.forces.append(Force(f"{name}.torque", "N m", [], combined((-k, away))))


@add_rows.register
def damper(connection: Damper, measures: Measures, name: str, path: Path) -> None:
    """Add a force against the rate of a distance or of a turn."""
    if connection.measure == "turn":
        measured, unit = _turn(measures, connection, name, path), "N m"
    elif connection.measure == "length":
        a, b = _ends(measures, connection, path)
        measured, unit = coordinate(measures.length(name, a, b, path)), "N"
    else:
        raise InvalidParameter((*path, "measure"), 'be "length" or "turn"')
    if connection.law is not None:
        damper_by_law(connection, measures, name, measured, unit, path)
        return
    c = _positive(measures, connection.coefficient, (*path, "coefficient"))
    slopes = {key[0]: value for key, value in measured.items() if key}
    for i, x in slopes.items():
        for j, y in slopes.items():
            measures.table.add_damping(i, j, c * x * y)
    measures.works.append(WorkTerm(name, square=(c, slopes)))
    suffix, sign = ("force", c) if unit == "N" else ("torque", -c)
    measures.forces.append(Force(f"{name}.{suffix}", unit, [], {}, {i: sign * x for i, x in slopes.items()}))
    measures.conservative = False


@add_rows.register
def motor(connection: Motor, measures: Measures, name: str, path: Path) -> None:
    """Hold the rate of a turn, or the turn itself, which may be formulas of time."""
    turn = _turn(measures, connection, name, path)
    if (connection.rate is None) == (connection.drive is None):
        raise InvalidParameter(path, "have a rate or a drive")
    if connection.drive is not None:
        drive = driven(measures, name, connection.drive, (*path, "drive"))
        apart = evaluated(difference(turn, drive), measures.table.q)
        if not (measures.loose or abs(apart) < CLOSE):
            now = as_text(evaluated(turn, measures.table.q), 10)
            rule = f"be {now} rad {measures.moment}, as the bodies are turned"
            raise PlacesDisagree((*path, "drive"), rule, remedy="change it, or turn the bodies")
        row = measures.hold(name, difference(turn, drive))
    else:
        drive, rates = driven(measures, name, connection.rate, (*path, "rate")), rate_of(turn)
        if any(not is_zero(x) for x in drive.values()):
            rates = sum_of_rates((constant(ONE), rates), (combined((-ONE, drive)), {clock(measures): constant(ONE)}))
        row = measures.roll(name, rates)
    measures.force(f"{name}.torque", [(row, constant(ONE))], "N m")


@add_rows.register
def spinning_frame(connection: SpinningFrame, measures: Measures, name: str, path: Path) -> None:
    """Add centrifugal and Coriolis forces: every unit vector and centre moves as particles do.

    Notes
    -----
    In space the scene describes every orientation by unit vectors: the spin of a top or ball is conserved only as seen
    from outside of the frame.
    """
    coordinates = measures.coordinates
    rate = measures.numerals.number(connection.rate, (*path, "rate"))
    given = (0,) * measures.dimension if connection.at is None else connection.at
    at = measures.numerals.vector(given, (*path, "at"), measures.dimension)
    square = rate * rate
    if connection.about not in ("vertical", "normal"):
        raise InvalidParameter((*path, "about"), 'be "vertical" or "normal"')
    if measures.dimension == 2 and connection.about == "vertical":
        across = _horizontal(coordinates.gravity, path)
        for frame in coordinates.frames.values():
            if frame.orients or frame.turn is not None:
                raise InvalidParameter(
                    (*path, "about"),
                    f'be "normal" where rigid bodies move in the plane, as "{frame.name}" does',
                    remedy="describe the scene in space",
                )
            _outward(measures, frame.position, across, at, square)
        measures.pressed_by = None if is_zero(rate) else across
        return
    if measures.dimension == 3 and connection.about != "vertical":
        raise InvalidParameter((*path, "about"), 'be "vertical" in space')
    planar = range(2)
    if measures.dimension == 3 and not all(is_zero(coordinates.gravity[i]) for i in planar):
        raise InvalidParameter((*path, "about"), "be about the z axis: gravity has to be along it")
    for frame in coordinates.frames.values():
        # In the plane a steady spin has no moment about a centre: what it adds to a direction is along that.
        vectors = [frame.position]
        if frame.axes is not None:
            vectors.extend(frame.axes)
        for vector in vectors:
            _rotating(measures, vector[:2], at if vector is frame.position else None, rate)
        if frame.axes is not None:
            _rotating_products(measures, frame.axes, rate)


@add_rows.register
def force(connection: AppliedForce, measures: Measures, name: str, path: Path) -> None:
    """Add a force on a place."""
    if force_by_formulas(connection, measures, name, path):
        return
    point = measures.coordinates.point(connection.place, (*path, "place"))
    if point.body is None:
        raise InvalidParameter((*path, "place"), "belong to a body")
    vector = measures.numerals.vector(connection.force, (*path, "force"), measures.dimension)
    for component, value in zip(point.at, vector, strict=True):
        for key, x in component.items():
            if key and not is_zero(value):
                measures.table.add_load(key[0], value * x)
    measures.works.append(
        WorkTerm(name, combined(*((-x, component) for x, component in zip(vector, point.at, strict=True))))
    )


def _ends(measures: Measures, connection: TwoEnded, path: Path) -> tuple[Point, Point]:
    if connection.b == GROUND:
        raise InvalidParameter((*path, "b"), "be given: a place, or of the ground its coordinates")
    point = measures.coordinates.point
    return point(connection.a, (*path, "a")), point(connection.b, (*path, "b"))


def _positive(measures: Measures, value: object, path: Path) -> Ball:
    if value is None:
        raise InvalidParameter(path, "be given")
    number = measures.numerals.number(value, path)
    if not number > 0:
        raise InvalidParameter(path, "be greater than 0")
    return number


def _turn(measures: Measures, connection: TwoEnded, name: str, path: Path) -> Poly:
    if connection.a == connection.b:
        raise InvalidParameter((*path, "b"), "be another body than a")
    if measures.dimension == 3:
        return turn_in_space(measures, name, connection.a, connection.b, path)
    turn = measures.coordinates.turn_of
    return difference(turn(connection.a, (*path, "a")), turn(connection.b, (*path, "b")))


def _potential(measures: Measures, away: Poly, k: Ball) -> None:
    """Add the energy k away^2/2 of an affine polynomial."""
    slopes = {key[0]: value for key, value in away.items() if key}
    offset = entry(away, ())
    for i, x in slopes.items():
        for j, y in slopes.items():
            measures.table.add_stiffness(i, j, k * x * y)
        if offset != 0:
            measures.table.add_load(i, -k * x * offset)
    measures.potential = measures.potential + k * offset * offset / 2


def _horizontal(gravity: Sequence[Ball], path: Path) -> list[Ball]:
    if all(is_zero(x) for x in gravity):
        return [ONE, ZERO]
    size = (gravity[0] * gravity[0] + gravity[1] * gravity[1]).sqrt()
    if is_zero(gravity[0]):
        return [ONE, ZERO]
    return [-gravity[1] / size, gravity[0] / size]


def _outward(measures: Measures, position: list[int], across: list[Ball], at: Sequence[Ball], square: Ball) -> None:
    """Add the centrifugal force on a particle of the plane that spins about a line in the plane."""
    table = measures.table
    mass = entry(table.mass, (position[0], position[0]))
    away: Poly = combined(
        *((across[i], coordinate(position[i])) for i in range(2)),
        (-(across[0] * at[0] + across[1] * at[1]), constant(ONE)),
    )
    _potential(measures, away, -mass * square)


def _rotating(measures: Measures, vector: list[int], at: Sequence[Ball] | None, rate: Ball) -> None:
    """Add the forces m (2 rate v x z + rate^2 (q - at)) of a vector of the plane of rotation."""
    x, y = vector
    mass = entry(measures.table.mass, (x, x))
    if is_zero(mass):
        return
    measures.table.add_damping(x, y, -2 * mass * rate)
    measures.table.add_damping(y, x, 2 * mass * rate)
    for number, i in enumerate((x, y)):
        away = coordinate(i) if at is None else combined((ONE, coordinate(i)), (-at[number], constant(ONE)))
        _potential(measures, away, -mass * rate * rate)


def _rotating_products(measures: Measures, axes: list[list[int]], rate: Ball) -> None:
    """Add the same for the products of different unit vectors, where the tensor is not diagonal."""
    table = measures.table
    for a in range(3):
        for b in range(3):
            weight = entry(table.mass, (min(axes[a][0], axes[b][0]), max(axes[a][0], axes[b][0])))
            if a == b or is_zero(weight):
                continue
            table.add_damping(axes[a][0], axes[b][1], -2 * weight * rate)
            table.add_damping(axes[a][1], axes[b][0], 2 * weight * rate)
            for i in range(2):
                table.add_stiffness(axes[a][i], axes[b][i], -weight * rate * rate)

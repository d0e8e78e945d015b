"""From the description of what pulls or drives to its definition."""

from __future__ import annotations

from math import hypot

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.driven import DrivenRate, DrivenTurn
from core.multibody.audit.formula_definitions import (
    damper_by_law,
    force_by_formulas,
    formula_of,
    spring_by_law,
    torque_by_formula,
    value_or_formula,
)
from core.multibody.audit.joint_definitions import distance_at_start, ends_of
from core.multibody.audit.laws import (
    Attraction,
    ConstantForce,
    ConstantTorque,
    DamperDefinition,
    MotorDefinition,
    SpinningFrameDefinition,
    SpringDefinition,
    SpringWithoutLength,
    TorsionSpringDefinition,
    TurnDamper,
)
from core.multibody.audit.turns_in_space import (
    AxialDamper,
    AxialDamperByFormula,
    AxialDrive,
    AxialMotor,
    AxialSpring,
    axis_between,
)
from core.multibody.language.forces import (
    AppliedForce,
    Damper,
    Gravitation,
    InverseSquare,
    Motor,
    SpinningFrame,
    Spring,
    Torque,
    TorsionSpring,
)
from core.multibody.language.written import GROUND


@definition_of.register
def spring(connection: Spring, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a spring; where it has no rest length, its pull has components."""
    a, b = ends_of(connection, reader, path)
    if connection.law is not None:
        return spring_by_law(connection, reader, name, a, b, path)
    bodies = (*a.bodies, *b.bodies)
    stiffness = reader.number(connection.stiffness, (*path, "stiffness"))
    if connection.rest_length is None:
        return SpringDefinition(name, bodies, a, b, stiffness, distance_at_start(reader, a, b))
    rest = reader.number(connection.rest_length, (*path, "rest_length"))
    if rest == 0.0:
        return SpringWithoutLength(name, bodies, a, b, stiffness)
    return SpringDefinition(name, bodies, a, b, stiffness, rest)


@definition_of.register
def torsion_spring(connection: TorsionSpring, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a torsion spring."""
    stiffness = reader.number(connection.stiffness, (*path, "stiffness"))
    if reader.dimension == 3:
        at_rest = 0.0
        if connection.rest_angle is not None:
            at_rest = reader.number(connection.rest_angle, (*path, "rest_angle"))
        return AxialSpring(name, *axis_between(reader, connection.a, connection.b), stiffness, at_rest)
    bodies, a, b = _turning(connection)
    if connection.rest_angle is None:
        rest = float(TorsionSpringDefinition(name, bodies, a, b, stiffness, 0.0).turn(reader.start))
    else:
        rest = reader.number(connection.rest_angle, (*path, "rest_angle"))
    return TorsionSpringDefinition(name, bodies, a, b, stiffness, rest)


@definition_of.register
def damper(connection: Damper, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a damper of a length or of a turn."""
    if connection.measure == "turn" and reader.dimension == 3:
        bodies, axis = axis_between(reader, connection.a, connection.b)
        if connection.law is None:
            return AxialDamper(name, bodies, axis, reader.number(connection.coefficient, (*path, "coefficient")))
        formula = value_or_formula(reader, connection.law, {"rate": axis.turning}, (*path, "law"))
        return AxialDamperByFormula(name, bodies, axis, formula)
    if connection.measure == "turn" and connection.law is not None:
        return damper_by_law(connection, reader, name, _turning(connection), path)
    if connection.law is not None:
        a, b = ends_of(connection, reader, path)
        return spring_by_law(Spring(connection.a, connection.b, law=connection.law), reader, name, a, b, path)
    coefficient = reader.number(connection.coefficient, (*path, "coefficient"))
    if connection.measure == "turn":
        return TurnDamper(name, *_turning(connection), coefficient)
    a, b = ends_of(connection, reader, path)
    return DamperDefinition(name, (*a.bodies, *b.bodies), a, b, coefficient)


@definition_of.register
def motor(connection: Motor, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a motor."""
    if reader.dimension == 3:
        bodies, axis = axis_between(reader, connection.a, connection.b)
        if connection.drive is not None:
            return AxialDrive(name, bodies, axis, value_or_formula(reader, connection.drive, {}, (*path, "drive")))
        return AxialMotor(name, bodies, axis, value_or_formula(reader, connection.rate, {}, (*path, "rate")))
    if connection.drive is not None:
        drive = value_or_formula(reader, connection.drive, {}, (*path, "drive"))
        return DrivenTurn(name, *_turning(connection), drive)
    formula = formula_of(reader, connection.rate, {}, (*path, "rate"))
    if formula is not None:
        return DrivenRate(name, *_turning(connection), formula)
    return MotorDefinition(name, *_turning(connection), reader.number(connection.rate, (*path, "rate")))


@definition_of.register
def gravitation(connection: Gravitation, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of the attraction of two masses."""
    a, b = ends_of(connection, reader, path)
    bodies = (*a.bodies, *b.bodies)
    masses = [reader.bodies[body].mass for body in bodies]
    constant = reader.number(connection.constant, (*path, "constant"))
    return Attraction(name, bodies, a, b, constant * masses[0] * masses[1])


@definition_of.register
def inverse_square(connection: InverseSquare, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of an attraction by a strength."""
    a, b = ends_of(connection, reader, path)
    return Attraction(name, (*a.bodies, *b.bodies), a, b, reader.number(connection.strength, (*path, "strength")))


@definition_of.register
def force(connection: AppliedForce, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a force."""
    formulas = force_by_formulas(connection, reader, name, path)
    if formulas is not None:
        return formulas
    place = reader.place(connection.place, (*path, "place"))
    return ConstantForce(name, place.bodies, place, reader.vector(connection.force, (*path, "force")))


@definition_of.register
def torque(connection: Torque, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a torque."""
    formula = torque_by_formula(connection, reader, name, path)
    if formula is not None:
        return formula
    where, given = (*path, "torque"), connection.torque
    torque = reader.number(given, where) if reader.dimension == 2 else reader.vector(given, where)
    return ConstantTorque(name, (connection.body,), connection.body, torque)


@definition_of.register
def spinning_frame(connection: SpinningFrame, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a spinning frame."""
    given = (0,) * reader.dimension if connection.at is None else connection.at
    across: tuple[float, ...] | None = None
    if reader.dimension == 2 and connection.about == "vertical":
        g = reader.gravity
        # Horizontal is at right angles to gravity, and the first axis without one.
        across = (1.0, 0.0) if not any(g) else (-g[1] / hypot(*g), g[0] / hypot(*g))
    bodies = tuple(reader.bodies.values())
    rate = reader.number(connection.rate, (*path, "rate"))
    return SpinningFrameDefinition(
        name, tuple(reader.bodies), rate, reader.vector(given, (*path, "at")), across, bodies
    )


def _turning(connection: TorsionSpring | Damper | Motor) -> tuple[tuple[str, ...], str, str | None]:
    """Return the bodies whose turns a connection compares, the first, and the second or None for the ground."""
    a, b = str(connection.a), str(connection.b)
    return ((a,), a, None) if b == GROUND else ((a, b), a, b)

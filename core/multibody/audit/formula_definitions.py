"""From the description of forces that are formulas to their definitions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from core.formulas import Node
from core.multibody.audit.between_places import approach
from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.driven import RelationDefinition
from core.multibody.audit.formula_forces import ForcesByFormulas, PullByFormula, TorqueByFormulas, TwistByFormula
from core.multibody.audit.formulas import FormulaValue, Read, names_of_place, names_of_turn, time_of
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, length, spin_of
from core.multibody.language.forces import AppliedForce, Damper, Field, Spring, Torque
from core.multibody.language.joints import Relation
from core.multibody.language.motion_formulas import TIME, TURNS, motion_formula, names_of_bodies


def formula_of(reader: Reader, value: object, own: Mapping[str, Read], path: Path) -> FormulaValue | None:
    """Return a formula of the motion with what its names mean; None for a number."""
    others = names_of_bodies(reader.scene.bodies, reader.dimension)
    names = [*own, "speed"] if "vx" in own else list(own)
    found = motion_formula(value, reader.numerals, names, others, path)
    if found is None:
        return None
    _note_sizes(reader, found.root, path)
    inputs = {name: _read(reader, name, own) for name in found.names}
    rates = frozenset(name for name in found.names if name.rpartition(".")[2] in ("vx", "vy", "vz", "rate"))
    numbers = {name: float(number) for name, number in reader.numerals.let.items()}
    return FormulaValue(found.root, numbers, inputs, rates, reader.start)


def _note_sizes(reader: Reader, node: Node, path: Path) -> None:
    if node.kind == "number":
        reader.note_size(float(node.text), path)
    for inner in node.inner:
        _note_sizes(reader, inner, path)


def value_or_formula(reader: Reader, value: object, own: Mapping[str, Read], path: Path) -> FormulaValue:
    """Return a formula of the motion, or that of a number."""
    found = formula_of(reader, value, own, path)
    if found is not None:
        return found
    return FormulaValue.constant(reader.number(value, path), reader.start)


def _read(reader: Reader, name: str, own: Mapping[str, Read]) -> Read:
    if name in own:
        return own[name]
    if name == TIME:
        return time_of
    place, _, column = name.rpartition(".")
    return names_of_turn(place)[column] if column in TURNS else names_of_place(reader.place(place, ()))[column]


def spring_by_law(connection: Spring, reader: Reader, name: str, a: Place, b: Place, path: Path) -> Definition:
    """Return the definition of a spring whose pull is a formula."""

    def distance(placement: Placement, _: Motion) -> Numbers:
        return length(b.at(placement) - a.at(placement))

    own: dict[str, Read] = {"length": distance, "rate": lambda placement, motion: approach(a, b, placement, motion)}
    if connection.rest_length is not None:
        rest = reader.number(connection.rest_length, (*path, "rest_length"))
        own["stretch"] = lambda placement, motion: distance(placement, motion) - rest
    formula = value_or_formula(reader, connection.law, own, (*path, "law"))
    return PullByFormula(name, (*a.bodies, *b.bodies), a, b, formula)


def damper_by_law(
    connection: Damper, reader: Reader, name: str, turning: tuple[tuple[str, ...], str, str | None], path: Path
) -> Definition:
    """Return the definition of a damper of a turn whose moment is a formula.

    Parameters
    ----------
    turning : tuple
        The bodies, the first, and the second or None for the ground.
    """
    bodies, first, second = turning

    def angle(placement: Placement, _: Motion) -> Numbers:
        return TwistByFormula(name, bodies, first, second, NOTHING, 1.0).turn(placement)

    def rate(_: Placement, motion: Motion) -> Numbers:
        return np.asarray(spin_of(motion, first) - spin_of(motion, second))

    formula = value_or_formula(reader, connection.law, {"angle": angle, "rate": rate}, (*path, "law"))
    return TwistByFormula(name, bodies, first, second, formula, -1.0)


NOTHING = FormulaValue(Node("number", "0"), {}, {}, frozenset(), {})
"""The formula of no force."""


def force_by_formulas(connection: AppliedForce, reader: Reader, name: str, path: Path) -> Definition | None:
    """Return the definition of a force that is given by formulas or turns with a body; None of others."""
    given = connection.force
    if not isinstance(given, (list, tuple)):
        return None
    place = reader.place(connection.place, (*path, "place"))
    own, where = names_of_place(place), (*path, "force")
    if connection.in_ is None and not any(formula_of(reader, value, own, (*where, i)) for i, value in enumerate(given)):
        return None
    return ForcesByFormulas(
        name, place.bodies, ((place, _components(reader, given, own, where), 1.0),), connection.in_ == "body"
    )


def _components(
    reader: Reader, given: Sequence[object], own: Mapping[str, Read], path: Path
) -> tuple[FormulaValue, ...]:
    return tuple(value_or_formula(reader, value, own, (*path, i)) for i, value in enumerate(given))


def torque_by_formula(connection: Torque, reader: Reader, name: str, path: Path) -> Definition | None:
    """Return the definition of a torque that is a formula, or turns with a body; None of others."""
    where, given = (*path, "torque"), connection.torque
    if reader.dimension == 3:
        every = given if isinstance(given, (list, tuple)) else ()
        if connection.in_ is None and not any(formula_of(reader, x, {}, (*where, i)) for i, x in enumerate(every)):
            return None
        components = _components(reader, every, {}, where)
        return TorqueByFormulas(name, (connection.body,), connection.body, components, connection.in_ == "body")
    formula = formula_of(reader, connection.torque, names_of_turn(connection.body), (*path, "torque"))
    if formula is None:
        return None
    return TwistByFormula(name, (connection.body,), connection.body, None, formula, 1.0)


@definition_of.register
def field(connection: Field, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a field."""
    what = "force" if connection.acceleration is None else "acceleration"
    given = getattr(connection, what)
    every, bodies = [], tuple(reader.bodies) if connection.on is None else tuple(connection.on)
    for body in bodies:
        place = reader.place(body, path)
        factor = 1.0 if what == "force" else reader.bodies[body].mass
        every.append((place, _components(reader, given, names_of_place(place), (*path, what)), factor))
    return ForcesByFormulas(name, bodies, tuple(every))


@definition_of.register
def relation(connection: Relation, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a relation."""
    of, equals = (
        value_or_formula(reader, value, {}, (*path, what))
        for what, value in (("of", connection.of), ("equals", connection.equals))
    )
    named = {one.rpartition(".")[0]: None for one in (*of.inputs, *equals.inputs) if "." in one}
    places = tuple(reader.place(place, path) for place in named)
    bodies = tuple(dict.fromkeys(body for place in places for body in place.bodies))
    return RelationDefinition(name, bodies, of, equals, places)

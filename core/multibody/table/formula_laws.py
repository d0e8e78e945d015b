"""Forces that are formulas: what their names stand for in the coordinates, and the laws that they become."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import starmap

from core.errors import InvalidParameter, Path
from core.formulas import NOTHING, Node, names_of
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, coordinate, is_zero
from core.multibody.language.forces import AppliedForce, Damper, Field, Spring
from core.multibody.language.motion_formulas import (
    TIME,
    TURNS,
    MotionFormula,
    columns_of,
    motion_formula,
    names_of_bodies,
)
from core.multibody.laws.law import Input, Law
from core.multibody.table.connection_effects import Force, WorkTerm
from core.multibody.table.formulas_of_time import clock
from core.multibody.table.frames import Point
from core.multibody.table.law_pieces import entered
from core.multibody.table.measures import COMPONENTS, Measures
from core.multibody.table.rows import add_rows
from core.near_names import near_and_all

Own = Mapping[str, Input]
"""What names without a point stand for."""


def formula_at(measures: Measures, value: object, own: Own | Sequence[str], path: Path) -> MotionFormula | None:
    """Return the formula of the motion that stands somewhere, None for a number."""
    bodies = measures.coordinates.scene.bodies
    return motion_formula(value, measures.numerals, list(own), names_of_bodies(bodies, measures.dimension), path)


def written(measures: Measures, value: object, own: Own | Sequence[str], path: Path) -> MotionFormula:
    """Return a formula of the motion, or that of a number."""
    found = formula_at(measures, value, own, path)
    if found is not None:
        return found
    return of_number(measures.numerals.number(value, path))


def of_number(number: Ball) -> MotionFormula:
    """Return the formula of a number."""
    return MotionFormula(Node("number", number.str(_DIGITS, radius=False)), frozenset())


_DIGITS = 96
"""Digits of a number beside formulas: as many as the precision of the set-up has."""


def add_law(
    measures: Measures, name: str, formula: MotionFormula, own: Own, push: Mapping[int, Ball], path: Path
) -> int:
    """Add a law to the table and return its number.

    Parameters
    ----------
    own : mapping of str to Input
        What names without a point stand for.
    push : mapping of int to ball
        Force on each coordinate where the value is one.
    """
    numbers = measures.numerals.let
    inputs = {one: input_of(measures, one, own, path) for one in sorted(formula.names)}
    used = {one: numbers[one] for one in names_of(formula.root) if one in numbers}
    law = Law(name, path, formula.root, inputs, used, dict(push))
    measures.table.laws.append(entered(measures.table, law) if inputs else law)
    measures.conservative = False
    return len(measures.table.laws) - 1


def input_of(measures: Measures, name: str, own: Own, path: Path) -> Input:
    """Return what a name of a formula stands for."""
    if name in own:
        return own[name]
    if name == TIME:
        return Input(coordinate(clock(measures)))
    place, _, column = name.rpartition(".")
    if column in TURNS:
        return Input(measures.coordinates.turn_of(place, path), column == "rate")
    return of_place(measures.coordinates.point(place, path))[column]


def of_place(point: Point) -> dict[str, Input]:
    """Return what the names of a place stand for."""
    found: dict[str, Input] = {}
    for axis, form in zip(COMPONENTS, point.at, strict=False):
        found |= {axis: Input(form), f"v{axis}": Input(form, rate=True)}
    return found


def add_force(
    measures: Measures, name: str, point: Point, formulas: Sequence[MotionFormula], factor: Ball, path: Path
) -> list[int]:
    """Add a force on a place by its components, each times a factor; return the numbers of their laws."""
    found = []
    for i, (formula, component) in enumerate(zip(formulas, point.at, strict=True)):
        push = {key[0]: factor * x for key, x in component.items() if key}
        if formula.root != NOTHING:
            found.append(add_law(measures, name, formula, of_place(point), push, (*path, i)))
    return found


def force_by_formulas(connection: AppliedForce, measures: Measures, name: str, path: Path) -> bool:
    """Add a force that is given by formulas or along the axes of a body; return whether it is one."""
    where, given = (*path, "force"), connection.force
    names = columns_of(measures.dimension)
    if connection.in_ not in (None, "body"):
        raise InvalidParameter((*path, "in"), 'be "body", or be left out')
    if isinstance(given, (str, Mapping)) or not isinstance(given, Sequence) or len(given) != measures.dimension:
        return _without_axes(connection, path)
    every = [formula_at(measures, value, names, (*where, i)) for i, value in enumerate(given)]
    if connection.in_ is None and not any(every):
        return False
    point = measures.coordinates.point(connection.place, (*path, "place"))
    if point.body is None:
        raise InvalidParameter((*path, "place"), "belong to a body")
    formulas = [
        of_number(measures.numerals.number(value, (*where, i))) if formula is None else formula
        for i, (formula, value) in enumerate(zip(every, given, strict=True))
    ]
    if connection.in_ == "body":
        found = _along_axes(measures, name, point, formulas, path)
    else:
        found = add_force(measures, name, point, formulas, ONE, where)
    measures.works.append(WorkTerm(name, laws=found))
    return True


def _without_axes(connection: AppliedForce, path: Path) -> bool:
    if connection.in_ is not None:
        raise InvalidParameter((*path, "force"), "be a list of components where it turns with a body")
    return False


def _along_axes(
    measures: Measures, name: str, point: Point, formulas: Sequence[MotionFormula], path: Path
) -> list[int]:
    """Add a force along the axes of the body of a place: the products of its components and those of the axes."""
    assert point.body is not None, "a place of a body"
    if not measures.coordinates.frames[point.body].orients:
        raise InvalidParameter((*path, "in"), "be left out for a particle", remedy="give the body its inertia")
    unit = [[ONE if i == k else ZERO for i in range(measures.dimension)] for k in range(measures.dimension)]
    axes = [measures.coordinates.vector_of(point.body, components, path) for components in unit]
    found = []
    for k, (formula, axis) in enumerate(zip(formulas, axes, strict=True)):
        if formula.root == NOTHING:
            continue
        for form, component in zip(axis, point.at, strict=True):
            along = Node("*", inner=(formula.root, Node("name", _AXIS)))
            both = MotionFormula(along, formula.names | {_AXIS})
            push = {key[0]: x for key, x in component.items() if key}
            own = {**of_place(point), _AXIS: Input(form)}
            found.append(add_law(measures, name, both, own, push, (*path, "force", k)))
    return found


_AXIS = "component of the axis"
"""The name of a component of an axis of a body; no formula can call it."""


def spring_by_law(connection: Spring, measures: Measures, name: str, a: Point, b: Point, path: Path) -> None:
    """Add a spring whose pull is a formula."""
    if connection.stiffness is not None:
        raise InvalidParameter((*path, "law"), "be left out beside a stiffness")
    index, where = measures.length(name, a, b, path), (*path, "law")
    own = {"length": Input(coordinate(index)), "rate": Input(coordinate(index), rate=True)}
    if connection.rest_length is not None:
        rest = measures.numerals.number(connection.rest_length, (*path, "rest_length"))
        if rest < 0:
            raise InvalidParameter((*path, "rest_length"), "be at least 0 m")
        own["stretch"] = Input({(index,): ONE} if is_zero(rest) else {(index,): ONE, (): -rest})
    formula = written(measures, connection.law, own, where)
    _add_pull(measures, name, formula, own, index, where)


def damper_by_law(connection: Damper, measures: Measures, name: str, measured: Poly, unit: str, path: Path) -> None:
    """Add a damper whose force is a formula of the rate."""
    if connection.coefficient is not None:
        raise InvalidParameter((*path, "law"), "be left out beside a coefficient")
    where, own = (*path, "law"), {"rate": Input(measured, rate=True)}
    if unit == "N" or measures.dimension == 2:
        own["length" if unit == "N" else "angle"] = Input(measured)
    formula = written(measures, connection.law, own, where)
    push = {key[0]: -x for key, x in measured.items() if key}
    law = add_law(measures, name, formula, own, push, where)
    measures.works.append(WorkTerm(name, laws=[law]))
    suffix, sign = ("force", ONE) if unit == "N" else ("torque", -ONE)
    measures.forces.append(Force(f"{name}.{suffix}", unit, of_laws={law: sign}))


def _add_pull(measures: Measures, name: str, formula: MotionFormula, own: Own, length: int, path: Path) -> None:
    law = add_law(measures, name, formula, own, {length: -ONE}, path)
    measures.works.append(WorkTerm(name, laws=[law]))
    measures.forces.append(Force(f"{name}.force", "N", of_laws={law: ONE}))


@add_rows.register
def field(connection: Field, measures: Measures, name: str, path: Path) -> None:
    """Add a field: a force on the centres of bodies, or their mass times an acceleration."""
    given = {key: value for key in ("acceleration", "force") if (value := getattr(connection, key)) is not None}
    if len(given) != 1:
        raise InvalidParameter(path, "have an acceleration or a force")
    ((what, values),) = given.items()
    names, where = columns_of(measures.dimension), (*path, what)
    if isinstance(values, (str, Mapping)) or len(values) != measures.dimension:
        raise InvalidParameter(where, f"be a list of {measures.dimension} numbers or formulas")
    formulas = list(starmap(lambda i, value: written(measures, value, names, (*where, i)), enumerate(values)))
    laws: list[int] = []
    for k, body in enumerate(measures.coordinates.frames if connection.on is None else connection.on):
        at = path if connection.on is None else (*path, "on", k)
        if not isinstance(body, str) or body not in measures.coordinates.frames:
            raise InvalidParameter(
                at, "name a body of the scene", remedy=near_and_all(body, measures.coordinates.frames, "bodies")
            )
        point = measures.coordinates.point(body, at)
        mass = measures.table.mass.get((measures.coordinates.frames[body].position[0],) * 2, ZERO)
        factor = ONE if what == "force" else mass
        if not is_zero(factor):
            laws += add_force(measures, name, point, formulas, factor, where)
    measures.works.append(WorkTerm(name, laws=laws))

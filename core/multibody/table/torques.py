"""Torques on bodies: numbers and formulas, along the axes of space or of the body.

In space a body is three unit vectors: the forces (torque x e)/2 on each e have the torque as their moment, and no other
effect.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import permutations

from core.errors import InvalidParameter, Path
from core.formulas import NOTHING, Node
from core.multibody.algebra.polynomials import ONE, Ball, combined, coordinate, is_zero
from core.multibody.language.forces import Torque
from core.multibody.language.motion_formulas import TURNS, MotionFormula
from core.multibody.laws.law import Input
from core.multibody.table.connection_effects import Force, WorkTerm
from core.multibody.table.formula_laws import add_law, formula_at, written
from core.multibody.table.frames import Frame
from core.multibody.table.measures import Measures
from core.multibody.table.rows import add_rows
from core.near_names import near_and_all

_AXIS = "component of the axis"
"""The name of a component of an axis of a body; no formula can call it."""

SIGNS = {(0, 1, 2): 1, (1, 2, 0): 1, (2, 0, 1): 1, (0, 2, 1): -1, (2, 1, 0): -1, (1, 0, 2): -1}
"""Of the products of unit vectors: e_i x e_j = sign e_k."""


@add_rows.register
def torque(connection: Torque, measures: Measures, name: str, path: Path) -> None:
    """Add a torque on a body."""
    if measures.dimension == 2:
        _in_plane(connection, measures, name, path)
        return
    frame = measures.coordinates.frames.get(connection.body) if isinstance(connection.body, str) else None
    if frame is None or frame.axes is None:
        rigid = [one for one, entry in measures.coordinates.frames.items() if entry.axes is not None]
        remedy = near_and_all(connection.body, rigid, "rigid bodies") if rigid else "give the body its moments"
        raise InvalidParameter((*path, "body"), "name a rigid body of the scene", remedy=remedy)
    if connection.in_ not in (None, "body"):
        raise InvalidParameter((*path, "in"), 'be "body", or be left out')
    given, where = connection.torque, (*path, "torque")
    listed = isinstance(given, Sequence) and not isinstance(given, str) and len(given) == 3
    formulas = [formula_at(measures, x, (), (*where, i)) for i, x in enumerate(given)] if listed else []  # type: ignore[arg-type]
    if connection.in_ is None and not any(formulas):
        _constant(measures, name, frame, measures.numerals.vector(given, where, 3))
    elif not listed:
        raise InvalidParameter(where, "be a list of three components")
    else:
        _by_formulas(connection, measures, name, frame, where)


def _in_plane(connection: Torque, measures: Measures, name: str, path: Path) -> None:
    where, body = (*path, "torque"), connection.body
    if connection.in_ is not None:
        raise InvalidParameter((*path, "in"), "be left out in the plane, where a torque has one component")
    formula = formula_at(measures, connection.torque, TURNS, where)
    value = None if formula is not None else measures.numerals.number(connection.torque, where)
    if not isinstance(body, str) or body not in measures.coordinates.frames:
        remedy = near_and_all(body, measures.coordinates.frames, "bodies")
        raise InvalidParameter((*path, "body"), "name a body of the scene", remedy=remedy)
    turn = measures.coordinates.turn_of(body, (*path, "body"))
    index = next(iter(turn))[0]
    if formula is None:
        assert value is not None, "a torque is a number or a formula"
        measures.table.add_load(index, value)
        measures.works.append(WorkTerm(name, combined((-value, turn))))
        return
    law = add_law(measures, name, formula, {one: Input(turn, one == "rate") for one in TURNS}, {index: ONE}, where)
    measures.works.append(WorkTerm(name, laws=[law]))
    measures.forces.append(Force(f"{name}.torque", "N m", of_laws={law: ONE}))


def _constant(measures: Measures, name: str, frame: Frame, vector: Sequence[Ball]) -> None:
    assert frame.axes is not None, "a rigid body"
    terms: list[tuple[Ball, int, int]] = []
    for axis in frame.axes:
        for i, j, k in permutations(range(3)):
            half = SIGNS[i, j, k] * vector[i] / 2
            if not is_zero(half):
                measures.table.add_stiffness(axis[k], axis[j], -half)
                terms.append((half, axis[j], axis[k]))
    measures.works.append(WorkTerm(name, terms=terms))
    measures.conservative = False


def _by_formulas(connection: Torque, measures: Measures, name: str, frame: Frame, where: Path) -> None:
    assert frame.axes is not None, "a rigid body"
    assert not isinstance(connection.torque, (str, Mapping, int, float)), "a list"
    laws = []
    for i, value in enumerate(connection.torque):  # type: ignore[arg-type]
        formula = written(measures, value, (), (*where, i))
        if formula.root == NOTHING:
            continue
        along = MotionFormula(Node("*", inner=(formula.root, Node("name", _AXIS))), formula.names | {_AXIS})
        for _, j, k in (order for order in permutations(range(3)) if order[0] == i):
            half = SIGNS[i, j, k] * ONE / 2
            # Of space: components j and k of each axis; of the body: of the axes j and k each component.
            pairs = [(axis[j], axis[k]) for axis in frame.axes]
            if connection.in_ == "body":
                pairs = list(zip(frame.axes[k], frame.axes[j], strict=True))
            for seen, pushed in pairs:
                own = {_AXIS: Input(coordinate(seen))}
                laws.append(add_law(measures, name, along, own, {pushed: half}, (*where, i)))
    measures.works.append(WorkTerm(name, laws=laws))

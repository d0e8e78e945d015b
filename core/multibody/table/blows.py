"""Blows: what an impulse on a place, or an impulsive torque on a body, adds to the momenta of coordinates.

An impulse J on a place p adds J . dp/dq. In space a body is three unit vectors e: (J x e)/2 on each have the impulsive
torque J as their moment, and no other effect.
"""

from __future__ import annotations

from itertools import permutations

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import (
    ONE,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    gradient,
    is_zero,
)
from core.multibody.language.forces import Blow
from core.multibody.table.connection_effects import Push
from core.multibody.table.measures import COMPONENTS, Measures
from core.multibody.table.rows import add_rows
from core.multibody.table.torques import SIGNS
from core.near_names import near_and_all


@add_rows.register
def blow(connection: Blow, measures: Measures, name: str, path: Path) -> None:
    """Take note of a blow; it has no part in the table.

    Raises
    ------
    InvalidParameter
        Unless it acts on a place or a body that it can move.
    """
    if (connection.place is None) == (connection.body is None):
        raise InvalidParameter(path, "have a place, or a body in place of it")
    if connection.in_ not in (None, "body"):
        raise InvalidParameter((*path, "in"), 'be "body", or be left out')
    measures.conservative = False
    push = _on_place if connection.body is None else _on_body
    measures.blows[name] = push(connection, measures, path)


def _on_place(connection: Blow, measures: Measures, path: Path) -> Push:
    point = measures.coordinates.point(connection.place, (*path, "place"))
    if point.body is None:
        raise InvalidParameter((*path, "place"), "belong to a body")
    vector = measures.numerals.vector(connection.impulse, (*path, "impulse"), measures.dimension)
    along = [constant(x) for x in vector]
    if connection.in_ == "body":
        if not measures.coordinates.frames[point.body].orients:
            raise InvalidParameter((*path, "in"), "be left out for a particle", remedy="give the body its inertia")
        along = measures.coordinates.vector_of(point.body, vector, path)
    found: dict[int, Poly] = {}
    for component, form in zip(along, point.at, strict=True):
        for j, slope in gradient(form).items():
            _add(found, slope[()], {j: component})
    return Push(found, dict(zip(COMPONENTS, along, strict=False)))


def _on_body(connection: Blow, measures: Measures, path: Path) -> Push:
    where, body = (*path, "impulse"), connection.body
    if not isinstance(body, str) or body not in measures.coordinates.frames:
        remedy = near_and_all(body, measures.coordinates.frames, "bodies")
        raise InvalidParameter((*path, "body"), "name a body of the scene", remedy=remedy)
    if measures.dimension == 2:
        if connection.in_ is not None:
            raise InvalidParameter((*path, "in"), "be left out in the plane, where it has one component")
        value = measures.numerals.number(connection.impulse, where)
        turn = measures.coordinates.turn_of(body, (*path, "body"))
        return Push({next(iter(turn))[0]: constant(value)}, {"torque": constant(value)})
    frame = measures.coordinates.frames[body]
    if frame.axes is None:
        raise InvalidParameter((*path, "body"), "be a body that has moments", remedy="give the body its moments")
    vector = measures.numerals.vector(connection.impulse, where, 3)
    found: dict[int, Poly] = {}
    for i, j, k in permutations(range(3)):
        half = SIGNS[i, j, k] * vector[i] / 2
        if is_zero(half):
            continue
        pairs = [(axis[j], axis[k]) for axis in frame.axes]
        if connection.in_ == "body":
            pairs = list(zip(frame.axes[k], frame.axes[j], strict=True))
        for seen, pushed in pairs:
            _add(found, half, {pushed: coordinate(seen)})
    along = [constant(x) for x in vector]
    if connection.in_ == "body":
        along = measures.coordinates.vector_of(body, vector, path)
    return Push(found, {f"torque.{axis}": x for axis, x in zip(COMPONENTS, along, strict=True)})


def _add(found: LinearForm, factor: Ball, line: LinearForm) -> None:
    for j, poly in line.items():
        found[j] = combined((ONE, found.get(j, {})), (factor, poly))

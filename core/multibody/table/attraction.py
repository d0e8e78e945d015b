"""Forces by the inverse square of a distance: gravitation, and charges or a fixed centre by their strength.

With the weightless coordinates l, the distance, and w, where l w = 1, the potential -k/l is the load k on w: nothing
exceeds degree two, and the multipliers of the two rows carry the pull k w^2 to the places.
"""

from __future__ import annotations

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import Ball, entry, is_zero
from core.multibody.language.forces import Gravitation, InverseSquare
from core.multibody.table.connection_effects import Force, WorkTerm
from core.multibody.table.frames import Point
from core.multibody.table.measures import Measures
from core.multibody.table.rows import add_rows
from core.near_names import near_and_all


@add_rows.register
def gravitation(connection: Gravitation, measures: Measures, name: str, path: Path) -> None:
    """Let two bodies attract one another by their masses.

    Raises
    ------
    InvalidParameter
        Where an end is no body with mass, or the constant is not positive.
    """
    strength = measures.numerals.number(connection.constant, (*path, "constant"))
    if not strength > 0:
        raise InvalidParameter((*path, "constant"), "be greater than 0 m^3/(kg s^2)")
    for end in ("a", "b"):
        body = getattr(connection, end)
        frame = measures.coordinates.frames.get(body) if isinstance(body, str) else None
        if frame is None:
            remedy = f"{near_and_all(body, measures.coordinates.frames, 'bodies')}; use inverse-square for a place"
            raise InvalidParameter((*path, end), "name a body of the scene", remedy=remedy)
        mass = entry(measures.table.mass, (frame.position[0], frame.position[0]))
        if is_zero(mass):
            raise InvalidParameter((*path, end), f'name a body with mass, unlike "{body}"')
        strength = strength * mass
    point = measures.coordinates.point
    _attract(measures, name, (point(connection.a, path), point(connection.b, path)), strength, path)


@add_rows.register
def inverse_square(connection: InverseSquare, measures: Measures, name: str, path: Path) -> None:
    """Let two places attract one another by a strength over the square of their distance.

    Raises
    ------
    InvalidParameter
        Where the strength is zero, or the places cannot attract one another.
    """
    strength = measures.numerals.number(connection.strength, (*path, "strength"))
    if is_zero(strength):
        raise InvalidParameter((*path, "strength"), "differ from 0 N m^2")
    ends = [measures.coordinates.point(getattr(connection, end), (*path, end)) for end in ("a", "b")]
    _attract(measures, name, (ends[0], ends[1]), strength, path)


def _attract(measures: Measures, name: str, ends: tuple[Point, Point], strength: Ball, path: Path) -> None:
    index = measures.inverse(name, measures.length(name, *ends, path))
    measures.table.add_load(index, strength)
    measures.forces.append(Force(f"{name}.force", "N", [], {(index, index): strength}))
    measures.works.append(WorkTerm(name, {(index,): -strength}))

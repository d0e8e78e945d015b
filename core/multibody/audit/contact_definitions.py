"""From the description of a contact or of rolling to its definition."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.contacts import OnFace, OnRound, Stop
from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.joints import AXES
from core.multibody.audit.placement import Undefined
from core.multibody.audit.rolling import RollingOnBall, RollingOnCylinder, RollingOnFace, RollingOnRound
from core.multibody.audit.surfaces import Face, Round
from core.multibody.language.contacts import Contact, Rolling
from core.multibody.language.written import GROUND, Number


def touch_of(
    reader: Reader,
    name: str,
    path: Path,
    restitution: Number | None,
    friction: Number | Sequence[Number] | None = None,
) -> Touch:
    """Return the coefficients of a contact or a string."""
    static = kinetic = 0.0
    if isinstance(friction, Sequence) and not isinstance(friction, str):
        static, kinetic = (reader.number(x, (*path, "friction", i)) for i, x in enumerate(friction))
    elif friction is not None:
        static = kinetic = reader.number(friction, (*path, "friction"))
    names: tuple[str, ...] = ()
    if static and reader.dimension == 2:
        names = (f"{name}.friction",)
    elif static:
        names = tuple(f"{name}.friction.{axis}" for axis in AXES)
    bounces = 0.0 if restitution is None else reader.number(restitution, (*path, "restitution"))
    return Touch(static, kinetic, bounces, names)


@definition_of.register
def contact(connection: Contact, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a contact."""
    touch = touch_of(reader, name, path, connection.restitution, connection.friction)
    if connection.measure == "turn":
        least = connection.at_least is not None
        field = "at_least" if least else "at_most"
        limit = reader.number(getattr(connection, field), (*path, field))
        first, other = str(connection.a), None if connection.b in (None, GROUND) else str(connection.b)
        both = (first,) if other is None else (first, other)
        return Stop(name, both, first, other, limit, 1 if least else -1, touch)
    if connection.place is None:
        a, b = (reader.place(getattr(connection, end), (*path, end)) for end in "ab")
        radii = (reader.rim(connection.a), reader.rim(connection.b))
        return OnRound(name, (*a.bodies, *b.bodies), Round(a, b, radii), touch)
    place, radius, on = (
        reader.place(connection.place, (*path, "place")),
        reader.rim(connection.place),
        connection.surface,
    )
    where = (*path, "on")
    at = reader.place(on["at"], (*where, "at"))
    bodies = (*place.bodies, *at.bodies)
    if "radius" in on:
        return OnRound(name, bodies, Round(place, at, (radius, reader.number(on["radius"], (*where, "radius")))), touch)
    return OnFace(name, bodies, place, radius, _face(reader, on, where), touch)


@definition_of.register
def rolling(connection: Rolling, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of what rolls."""
    if connection.place is None:
        a, b = (reader.place(getattr(connection, end), (*path, end)) for end in "ab")
        first, second = reader.rim(connection.a), reader.rim(connection.b)
        around = Round(a, b, (first, -second if connection.inside else second))
        return RollingOnRound(name, (*a.bodies, *b.bodies), around)
    # In space a ball may roll whose centre is a place of it, and not its centre of mass.
    place, on = reader.place(connection.place, (*path, "place")), connection.surface
    radius = reader.rim(place.body)
    where = (*path, "on")
    at = reader.place(on["at"], (*where, "at"))
    bodies = (*place.bodies, *at.bodies)
    if "direction" in on:
        axis, size = (
            reader.unit(on["direction"], (*where, "direction")),
            reader.number(on["radius"], (*where, "radius")),
        )
        return RollingOnCylinder(name, bodies, place, radius, at, axis, size)
    if "radius" in on:
        around = Round(place, at, (radius, reader.number(on["radius"], (*where, "radius"))))
        return RollingOnRound(name, bodies, around) if reader.dimension == 2 else RollingOnBall(name, bodies, around)
    turning = reader.number(on["rate"], (*where, "rate")) if on.get("rate") is not None else 0.0
    return RollingOnFace(name, bodies, place, radius, _face(reader, on, where), turning)


def _face(reader: Reader, on: Any, where: Path) -> Face:
    at = reader.place(on["at"], (*where, "at"))
    if "normal" in on:
        return Face(at, reader.unit(on["normal"], (*where, "normal")))
    if reader.dimension != 2:
        raise Undefined("a face of space without a normal")
    c, s = reader.direction(on.get("slope"), (*where, "slope"))
    return Face(at, (-s, c))

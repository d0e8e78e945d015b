"""From the description of a connection that holds places or bodies to its definition."""

from __future__ import annotations

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.curves import track_by_formula
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.driven import DrivenRod, DrivenSlider
from core.multibody.audit.formula_definitions import value_or_formula
from core.multibody.audit.guides import is_rubbing, rubbing_slider, rubbing_track
from core.multibody.audit.joints import (
    Coincidence,
    OnCircle,
    OnParabola,
    OnPlane,
    RodDefinition,
    SliderDefinition,
    WeldDefinition,
    attitude_to,
    perpendicular,
)
from core.multibody.audit.placement import Numbers, Place, Placement, length
from core.multibody.language.connection import TwoEnded
from core.multibody.language.joints import BallJoint, GuideCurve, Pin, Rod, Slider, Weld


@definition_of.register
def pin(connection: Pin, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a pin."""
    a, b = ends_of(connection, reader, path)
    if connection.axis is None:
        return Coincidence(name, (*a.bodies, *b.bodies), a, b, None)
    axis = reader.unit(connection.axis, (*path, "axis"))
    axes = (in_body(reader.start, a.body, axis), in_body(reader.start, b.body, axis))
    return Coincidence(name, (*a.bodies, *b.bodies), a, b, axes)


@definition_of.register
def ball_joint(connection: BallJoint, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a ball joint."""
    a, b = ends_of(connection, reader, path)
    return Coincidence(name, (*a.bodies, *b.bodies), a, b, None)


@definition_of.register
def weld(connection: Weld, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a weld."""
    ends = a, b = ends_of(connection, reader, path)
    carrier = 1 if b.body is not None and reader.turns(b.body) else 0
    between = ends[1 - carrier].at(reader.start) - ends[carrier].at(reader.start)
    arm = in_body(reader.start, ends[carrier].body, tuple(between.tolist()))
    return WeldDefinition(name, (*a.bodies, *b.bodies), a, b, carrier, arm, _attitude(reader, a, b))


@definition_of.register
def slider(connection: Slider, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a slider."""
    a, b = ends_of(connection, reader, path)
    along: tuple[float, ...]
    if connection.direction is not None:
        along = reader.unit(connection.direction, (*path, "direction"))
    else:
        along = reader.direction(connection.slope, (*path, "slope"))
    if is_rubbing(connection, reader, name, path):
        return rubbing_slider(connection, reader, name, (a, b), along, path)
    bodies, normals, attitude = (*a.bodies, *b.bodies), perpendicular(along), _attitude(reader, a, b)
    if connection.drive is None:
        return SliderDefinition(name, bodies, a, b, normals, attitude)
    drive = value_or_formula(reader, connection.drive, {}, (*path, "drive"))
    return DrivenSlider(name, bodies, a, b, normals, attitude, along, drive=drive)


@definition_of.register
def rod(connection: Rod, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a rod."""
    a, b = ends_of(connection, reader, path)
    if connection.drive is not None:
        drive = value_or_formula(reader, connection.drive, {}, (*path, "drive"))
        return DrivenRod(name, (*a.bodies, *b.bodies), a, b, distance_at_start(reader, a, b), drive)
    given = connection.length
    size = distance_at_start(reader, a, b) if given is None else reader.number(given, (*path, "length"))
    return RodDefinition(name, (*a.bodies, *b.bodies), a, b, size)


@definition_of.register
def track(connection: GuideCurve, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a track."""
    where, on = (*path, "on"), connection.on
    by_formula = track_by_formula(connection, reader, name, path)
    if by_formula is not None:
        return by_formula
    place, at = reader.place(connection.place, (*path, "place")), reader.place(on["at"], (*where, "at"))
    bodies = (*place.bodies, *at.bodies)
    if is_rubbing(connection, reader, name, path):
        return rubbing_track(connection, reader, name, place, at, path)
    if "radius" in on:
        return OnCircle(name, bodies, place, at, reader.number(on["radius"], (*where, "radius")))
    if "normal" in on:
        return OnPlane(name, bodies, place, at, reader.unit(on["normal"], (*where, "normal")))
    if "direction" in on:
        direction = reader.unit(on["direction"], (*where, "direction"))
        return SliderDefinition(name, bodies, place, at, perpendicular(direction))
    c, s = reader.direction(on.get("slope"), (*where, "slope"))
    if "curvature" in on:
        return OnParabola(name, bodies, place, at, (c, s), reader.number(on["curvature"], (*where, "curvature")))
    return OnPlane(name, bodies, place, at, (-s, c))


def ends_of(connection: TwoEnded, reader: Reader, path: Path) -> tuple[Place, Place]:
    """Return the two places of a connection."""
    return reader.place(connection.a, (*path, "a")), reader.place(connection.b, (*path, "b"))


def distance_at_start(reader: Reader, a: Place, b: Place) -> float:
    """Return the distance of two places at the start (m)."""
    return float(length(b.at(reader.start) - a.at(reader.start)))


def in_body(placement: Placement, body: str | None, vector: tuple[float, ...]) -> tuple[float, ...]:
    """Return the components in the axes of a body of a vector that is given in space."""
    rotation = None if body is None else placement[body].rotation
    return vector if rotation is None else tuple((np.array(vector) @ rotation).tolist())


def _attitude(reader: Reader, a: Place, b: Place) -> Numbers | None:
    """Return the attitude of one body to another at the start, None where one is a particle."""
    for place in (a, b):
        if place.body is not None and not reader.turns(place.body):
            return None
    return attitude_to(reader.start, a.body, b.body)

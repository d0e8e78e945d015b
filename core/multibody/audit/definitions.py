"""The definitions of all connections of a description.

They are written from what a connection means and from the conventions of docs/describing-scenes.md alone, and share
nothing with the table of equations that answers are computed by.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

from core.multibody.audit.bodies import Path, Reader, RigidBody
from core.multibody.audit.contact_definitions import contact_of, rolling_of, touch_of
from core.multibody.audit.definition import Definition
from core.multibody.audit.joints import (
    Coincidence,
    OnCircle,
    OnParabola,
    OnPlane,
    Rod,
    Slider,
    Weld,
    attitude_to,
    perpendicular,
)
from core.multibody.audit.laws import (
    Attraction,
    ConstantForce,
    ConstantTorque,
    Damper,
    Motor,
    SpinningFrame,
    Spring,
    SpringWithoutLength,
    TorsionSpring,
    TurnDamper,
)
from core.multibody.audit.placement import LARGEST, LEAST, Place, Placement, Undefined, length
from core.multibody.audit.strings import Chain, Knot, Run, String, run_of
from core.multibody.language.scene import Scene
from core.multibody.language.written import GROUND


@dataclass(frozen=True)
class Description:
    """What a description says, in doubles.

    Attributes
    ----------
    dimension : int
    gravity : tuple of float
        m/s^2.
    bodies : mapping of str to RigidBody
    connections : tuple of Definition
    undefined : mapping of str to str
        Connections without a definition by their names, and what is missing.
    start : mapping of str to Pose
    """

    dimension: int
    gravity: tuple[float, ...]
    bodies: dict[str, RigidBody]
    connections: tuple[Definition, ...]
    undefined: dict[str, str]
    start: Placement

    @cached_property
    def places(self) -> float:
        """Largest component of a place of a body at the start (m)."""
        return max(float(np.abs(body.start.position).max()) for body in self.bodies.values())

    @cached_property
    def extent(self) -> float:
        """The same, or the largest size of a connection: what a place is known beside (m)."""
        return max(self.places, *(connection.reach + connection.arm for connection in self.connections), 0.0)

    @property
    def moderate(self) -> bool:
        """Whether its numbers are of sizes for which rates are formed to all digits."""
        numbers = [abs(x) for body in self.bodies.values() for x in (body.mass, *body.start.position.tolist()) if x]
        numbers.extend(connection.reach for connection in self.connections if connection.reach)
        numbers.extend(connection.mass for connection in self.connections if connection.mass)
        numbers.extend(abs(x) for x in self.gravity if x)
        return all(LEAST < x < LARGEST for x in numbers)


def description_of(scene: Scene) -> Description:
    """Return the bodies of a scene and the definitions of its connections.

    The scene has been read and found in order before: nothing is checked here.
    """
    reader = Reader(scene)
    found: list[Definition] = []
    undefined: dict[str, str] = {}
    for i, (name, connection) in enumerate(zip(scene.names(), scene.connections, strict=True)):
        try:
            found.append(defined(reader, name, connection, ("connections", i)))
        except Undefined as missing:
            undefined[name] = missing.what
    return Description(reader.dimension, reader.gravity, reader.bodies, tuple(found), undefined, reader.start)


def defined(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    """Return the definition of a connection.

    Raises
    ------
    Undefined
        Where there is none.
    """
    kind: str = connection.kind
    if kind == "contact":
        return contact_of(reader, name, connection, path)
    if kind == "rolling":
        return rolling_of(reader, name, connection, path)
    if kind == "track":
        return _track(reader, name, connection, path)
    if kind in ("string", "chain"):
        return (_string if kind == "string" else _chain)(reader, name, connection, path)
    if kind in ("torsion-spring", "motor") or (kind == "damper" and connection.measure == "turn"):
        return _turning(reader, name, connection, path)
    if kind == "spinning-frame":
        return _frame(reader, name, connection, path)
    if kind == "force":
        place = reader.place(connection.place, (*path, "place"))
        return ConstantForce(name, place.bodies, place, reader.vector(connection.force, (*path, "force")))
    if kind == "torque":
        where = (*path, "torque")
        given = connection.torque
        torque = reader.number(given, where) if reader.dimension == 2 else reader.vector(given, where)
        return ConstantTorque(name, (connection.body,), connection.body, torque)
    if kind in ("pin", "ball-joint", "weld", "slider", "rod", "spring", "damper", "gravitation", "inverse-square"):
        return _between(reader, name, connection, path)
    raise Undefined(kind)


def _between(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    """Return what is between two places."""
    kind: str = connection.kind
    a, b = (reader.place(getattr(connection, end), (*path, end)) for end in "ab")
    bodies = (*a.bodies, *b.bodies)
    if kind in ("pin", "ball-joint"):
        axis = None if kind != "pin" or connection.axis is None else reader.vector(connection.axis, (*path, "axis"))
        ends = (a.body, b.body)
        axes = None if axis is None else (_in_body(reader, ends[0], axis), _in_body(reader, ends[1], axis))
        return Coincidence(name, bodies, a, b, axes)
    if kind == "weld":
        return _weld(reader, name, a, b)
    if kind == "slider":
        if connection.direction is not None:
            along = reader.unit(connection.direction, (*path, "direction"))
        else:
            along = reader.direction(connection.slope, (*path, "slope"))
        return Slider(name, bodies, a, b, perpendicular(along), _attitude(reader, a, b))
    distance = float(length(b.at(reader.start) - a.at(reader.start)))
    if kind == "rod":
        given = connection.length
        return Rod(name, bodies, a, b, distance if given is None else reader.number(given, (*path, "length")))
    if kind == "damper":
        return Damper(name, bodies, a, b, reader.number(connection.coefficient, (*path, "coefficient")))
    if kind == "spring":
        stiffness = reader.number(connection.stiffness, (*path, "stiffness"))
        given = connection.rest_length
        rest = distance if given is None else reader.number(given, (*path, "rest_length"))
        if given is not None and rest == 0.0:
            return SpringWithoutLength(name, bodies, a, b, stiffness)
        return Spring(name, bodies, a, b, stiffness, rest)
    if kind == "inverse-square":
        return Attraction(name, bodies, a, b, reader.number(connection.strength, (*path, "strength")))
    masses = [reader.bodies[body].mass for body in bodies]
    constant = reader.number(connection.constant, (*path, "constant"))
    return Attraction(name, bodies, a, b, constant * masses[0] * masses[1])


def _in_body(reader: Reader, body: str | None, vector: tuple[float, ...]) -> tuple[float, ...]:
    """Return the components in the axes of a body of a vector that is given in space at the start."""
    rotation = None if body is None else reader.start[body].rotation
    return vector if rotation is None else tuple((np.array(vector) @ rotation).tolist())


def _attitude(reader: Reader, a: Place, b: Place) -> Any:
    """Return the attitude of one body to another at the start, None where one is a particle."""
    for place in (a, b):
        if place.body is not None and not reader.turns(place.body):
            return None
    return attitude_to(reader.start, a.body, b.body)


def _weld(reader: Reader, name: str, a: Place, b: Place) -> Weld:
    carrier = 1 if b.body is not None and reader.turns(b.body) else 0
    ends = (a, b)
    between = ends[1 - carrier].at(reader.start) - ends[carrier].at(reader.start)
    arm = _in_body(reader, ends[carrier].body, tuple(between.tolist()))
    return Weld(name, (*a.bodies, *b.bodies), a, b, carrier, arm, _attitude(reader, a, b))


def _track(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    where, on = (*path, "on"), connection.on
    place, at = reader.place(connection.place, (*path, "place")), reader.place(on["at"], (*where, "at"))
    bodies = (*place.bodies, *at.bodies)
    if "radius" in on:
        return OnCircle(name, bodies, place, at, reader.number(on["radius"], (*where, "radius")))
    if "normal" in on:
        return OnPlane(name, bodies, place, at, reader.unit(on["normal"], (*where, "normal")))
    if "direction" in on:
        direction = reader.unit(on["direction"], (*where, "direction"))
        return Slider(name, bodies, place, at, perpendicular(direction))
    c, s = reader.direction(on.get("slope"), (*where, "slope"))
    if "curvature" in on:
        return OnParabola(name, bodies, place, at, (c, s), reader.number(on["curvature"], (*where, "curvature")))
    return OnPlane(name, bodies, place, at, (-s, c))


def _turning(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    """Return what acts on the turn of a body relative to another."""
    a: str = connection.a
    b: str | None = None if connection.b == GROUND else connection.b
    bodies = (a,) if b is None else (a, b)
    if connection.kind == "motor":
        return Motor(name, bodies, a, b, reader.number(connection.rate, (*path, "rate")))
    if connection.kind == "damper":
        return TurnDamper(name, bodies, a, b, reader.number(connection.coefficient, (*path, "coefficient")))
    stiffness, given = reader.number(connection.stiffness, (*path, "stiffness")), connection.rest_angle
    spring = TorsionSpring(name, bodies, a, b, stiffness, 0.0)
    rest = float(spring.turn(reader.start)) if given is None else reader.number(given, (*path, "rest_angle"))
    return TorsionSpring(name, bodies, a, b, stiffness, rest)


def _frame(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    given = (0,) * reader.dimension if connection.at is None else connection.at
    across: tuple[float, ...] | None = None
    if reader.dimension == 2 and connection.about == "vertical":
        g = reader.gravity
        # Horizontal is at right angles to gravity, and the first axis without one.
        across = (1.0, 0.0) if not any(g) else (-g[1] / hypot(*g), g[0] / hypot(*g))
    bodies = tuple(reader.bodies.values())
    rate = reader.number(connection.rate, (*path, "rate"))
    return SpinningFrame(name, tuple(reader.bodies), rate, reader.vector(given, (*path, "at")), across, bodies)


def _string(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    knots: list[Knot] = []
    sides: list[tuple[str, ...]] = []
    for i, entry in enumerate(connection.through):
        place, radius = reader.place(entry, (*path, "through", i)), reader.rim(entry)
        slips = entry in connection.slips if isinstance(entry, str) else True
        knots.append(Knot(place, radius, None if slips or not radius else place.body))
        given = connection.sides.get(entry, ()) if isinstance(entry, str) else ()
        sides.append((given,) if isinstance(given, str) else tuple(given))
    runs: list[Run] = []
    given = None if connection.length is None else reader.number(connection.length, (*path, "length"))
    ends = [0, *(i for i in range(1, len(knots) - 1) if knots[i].drum is not None), len(knots) - 1]
    for number, (first, last) in enumerate(pairwise(ends)):
        pairs = tuple(
            (sides[i][-1] if sides[i] else None, sides[i + 1][0] if sides[i + 1] else None)
            for i in range(first, last)
        )  # fmt: skip
        part = name if len(ends) == 2 else f"{name}.{number + 1}"
        runs.append(run_of(part, tuple(knots[first : last + 1]), pairs, given, reader.start))
    bodies = tuple(dict.fromkeys(body for knot in knots for body in knot.place.bodies))
    return String(name, bodies, tuple(runs), touch_of(reader, name, connection, path))


def _chain(reader: Reader, name: str, connection: Any, path: Path) -> Definition:
    first, peg, last = (reader.place(entry, (*path, "through", i)) for i, entry in enumerate(connection.through))
    between = [end.at(reader.start) - peg.at(reader.start) for end in (first, last)]
    sizes = [float(length(d)) for d in between]
    ways = [tuple((d / size).tolist()) for d, size in zip(between, sizes, strict=True)]
    pulls = [float(np.dot(reader.gravity, way)) for way in ways]
    given = connection.length
    size = sum(sizes) if given is None else reader.number(given, (*path, "length"))
    density = reader.number(connection.density, (*path, "density"))
    bodies = (*first.bodies, *last.bodies)
    fall = float(np.dot(reader.gravity, peg.offset))
    ends, both = (first, last), (ways[0], ways[1])
    return Chain(name, bodies, ends, peg.offset, both, density, size, (pulls[0], pulls[1]), fall)


def kinds(connections: Sequence[Definition]) -> frozenset[str]:
    """Return the kinds of some connections."""
    return frozenset(connection.kind for connection in connections)

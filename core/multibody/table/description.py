"""From a description to its table: every body and connection in turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import perpendicular
from core.multibody.algebra.polynomials import ONE, Poly, constant, difference, evaluated, is_zero
from core.multibody.language.connection import Aspect, Surroundings
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.written import GROUND
from core.multibody.table import attraction, laws
from core.multibody.table.chains import chain
from core.multibody.table.connection_effects import WorkTerm
from core.multibody.table.contact_geometry import contact
from core.multibody.table.coordinates import Coordinates, dimension_of
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rolling
from core.multibody.table.rolling_in_space import rolling_in_space
from core.multibody.table.strings import string


@dataclass(frozen=True)
class Described:
    """A scene as a table, and what its rows mean."""

    scene: Scene
    measures: Measures
    paths: Mapping[str, Path]


def described(scene: Scene, numerals: Numerals | None = None, *, one_sided: bool = False) -> Described:
    """Return the table of a scene, its numbers read by `numerals` if given; the precision of balls is the caller's.

    If it is `one_sided`, strings are no rows but unilateral measures, as contacts are.

    Raises
    ------
    InvalidParameter
        With the paths to what cannot be: to a fault of every connection, where the bodies have none.
    """
    numerals = numerals or Numerals.of(scene.let, scene.numbers)
    names = scene.names()
    seen = _seen(scene, numerals)
    if one_sided and dimension_of(scene) == 2:
        # Angles are coordinates of their own, so that turns are counted across every event.
        seen = {name: what | {"turn"} if "direction" in what else what for name, what in seen.items()}
    coordinates = Coordinates(scene, numerals, seen)
    measures = Measures(coordinates, one_sided=one_sided)
    paths: dict[str, Path] = {name: ("bodies", name) for name in scene.bodies}
    paths["clock"] = ()
    faults = FaultsOfParts()
    for name, (i, connection) in zip(names, scene.numbered(), strict=True):
        paths[name] = ("connections", i)
        with faults.part():
            _connect(measures, name, connection, ("connections", i))
    faults.raised()
    if "gravity" not in paths:
        measures.works.extend(_weight(measures))
    return Described(scene, measures, paths)


def _weight(measures: Measures) -> list[WorkTerm]:
    """Return what gravity does, where there is any."""
    fall: Poly = dict(measures.fall)
    for frame in measures.coordinates.frames.values():
        for i, pull in zip(frame.position, measures.coordinates.gravity, strict=True):
            mass = measures.table.mass.get((i, i))
            if mass is not None and not is_zero(pull):
                fall[i,] = -mass * pull
    return [WorkTerm("gravity", fall)] if fall else []


def _seen(scene: Scene, numerals: Numerals) -> dict[str, set[str]]:
    """Return what of each body the connections see: places by name, and "direction", "turn", "orientation"."""
    found: dict[str, set[str]] = {name: set() for name in scene.bodies}
    plane = dimension_of(scene) == 2

    def see(place: object, *what: Aspect) -> None:
        if not isinstance(place, str):
            return
        body, _, spot = place.partition(".")
        if body in found:
            found[body].update(what)
            if spot and spot != "centre":
                found[body].add(spot)
                if plane:
                    found[body].add("direction")

    surroundings = Surroundings(scene.bodies, numerals, plane)
    for connection in scene.connections:
        for place in connection.places():
            see(place)
        for place, aspect in connection.aspects(surroundings):
            see(place, aspect)
    return found


def _connect(measures: Measures, name: str, connection: Any, path: Path) -> None:
    point, kind = measures.coordinates.point, connection.kind
    if kind == "string":
        string(measures, name, connection, path)
    elif kind == "chain":
        chain(measures, name, connection, path)
    elif kind == "rolling":
        (rolling if measures.dimension == 2 else rolling_in_space)(measures, name, connection, path)
    elif kind == "contact":
        contact(measures, name, connection, path)
    elif kind == "track":
        measures.on_curve(name, point(connection.place, (*path, "place")), connection.on, path)
    elif kind in ("pin", "ball-joint", "weld", "slider", "rod"):
        for end in ("a", "b"):
            if getattr(connection, end) == GROUND and kind != "weld":
                raise InvalidParameter((*path, end), "be a place: of the ground, its coordinates")
        a = point(connection.a, (*path, "a"))
        b = a if connection.b == GROUND else point(connection.b, (*path, "b"))
        _join(measures, name, connection, a, b, path)
    elif kind == "spring":
        laws.spring(measures, name, connection, path)
    elif kind == "torsion-spring":
        laws.torsion_spring(measures, name, connection, path)
    elif kind == "gravitation":
        attraction.gravitation(measures, name, connection, path)
    elif kind == "inverse-square":
        attraction.inverse_square(measures, name, connection, path)
    elif kind == "damper":
        laws.damper(measures, name, connection, path)
    elif kind == "motor":
        laws.motor(measures, name, connection, path)
    elif kind == "spinning-frame":
        laws.spinning_frame(measures, name, connection, path)
    elif kind == "force":
        laws.force(measures, name, connection, path)
    elif kind == "torque":
        laws.torque(measures, name, connection, path)


def _join(measures: Measures, name: str, connection: Any, a: Any, b: Any, path: Path) -> None:
    kind = connection.kind
    if kind == "rod":
        measures.rod(name, a, b, connection.length, path)
    elif kind == "slider":
        _slider(measures, name, connection, a, b, path)
    elif kind == "weld":
        _weld(measures, name, connection, a, b, path)
    else:
        if kind == "ball-joint" and measures.dimension == 2:
            raise InvalidParameter((*path, "kind"), 'be "pin" in the plane')
        measures.coincide(name, a, b, path)
        if kind == "pin" and connection.axis is not None:
            if measures.dimension == 2:
                raise InvalidParameter((*path, "axis"), "be left out in the plane")
            axis = measures.numerals.vector(connection.axis, (*path, "axis"), 3)
            perpendicular(axis, (*path, "axis"))
            frames = measures.coordinates.frames
            for body in (a.body, b.body):
                if body is not None and frames[body].axes is None:
                    raise InvalidParameter((*path, "axis"), f'hold bodies that have moments, unlike "{body}"')
            measures.aligned(name, a.body, b.body, axis, path)


def _slider(measures: Measures, name: str, connection: Any, a: Any, b: Any, path: Path) -> None:
    numerals, plane = measures.numerals, measures.dimension == 2
    if a.body == b.body:
        raise InvalidParameter(path, "connect two different bodies, or a body and the ground")
    if connection.direction is not None and connection.slope is not None:
        raise InvalidParameter((*path, "slope"), "be left out where a direction is given")
    if connection.direction is not None:
        along = numerals.vector(connection.direction, (*path, "direction"), measures.dimension)
    elif plane:
        along = numerals.angle(0 if connection.slope is None else connection.slope, (*path, "slope"))
    else:
        raise InvalidParameter((*path, "direction"), "be given")
    measures.slide(name, a, b, along, (*path, "direction"))
    measures.unturned(name, a, b, path)


def _weld(measures: Measures, name: str, connection: Any, a: Any, b: Any, path: Path) -> None:
    """Hold the vector from one place to the other, and the orientation, as they are at the start."""
    if connection.b == GROUND:
        b = measures.coordinates.point([0] * measures.dimension, path)
    if a.body == b.body:
        raise InvalidParameter(path, "connect two different bodies, or a body and the ground")
    carrier = b if b.body is not None and measures.coordinates.frames[b.body].orients else a
    other = a if carrier is b else b
    d = [difference(x, y) for x, y in zip(other.at, carrier.at, strict=True)]
    start = [evaluated(x, measures.table.q) for x in d]
    arm = measures.coordinates.vector_of(carrier.body, measures.in_body(carrier.body, start), path)
    sign = ONE if carrier is b else -ONE
    for axis, x, y in zip("xyz", d, arm, strict=False):
        row = measures.hold(name, difference(x, y))
        measures.force(f"{name}.{axis}", [(row, constant(sign))])
    measures.unturned(name, a, b, path)

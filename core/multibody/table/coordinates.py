"""From bodies to natural coordinates: positions, direction cosines where an orientation matters, angles of what turns.

In the plane a rigid body is (x, y, c, s) with M = diag(m, m, I, I) and c^2 + s^2 = 1, or an angle alone where nothing
sees its direction. In space it is its centre and three unit vectors, weighted by the integrals of the squares of body
coordinates; a symmetric top whose axis alone is seen is its centre and that axis, with the momentum about it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    coordinate,
    is_zero,
)
from core.multibody.language.body import SceneBody
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.inertia import inertia_of
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.shapes import shape_of
from core.multibody.language.written import GROUND
from core.multibody.table.frames import Frame, Given, Point
from core.multibody.table.spatial_orientation import SpatialOrientation
from core.multibody.table.table import Row, Table
from core.near_names import near_and_all


class Coordinates:
    """The table of the bodies alone, the places on them, and the velocities that the client gave."""

    def __init__(self, scene: Scene, numerals: Numerals, seen: Mapping[str, set[str]]) -> None:
        self.scene, self.numerals, self.table = scene, numerals, Table()
        self.dimension = dimension_of(scene)
        gravity = (0,) * self.dimension if scene.gravity is None else scene.gravity
        self.gravity = numerals.vector(gravity, ("gravity",), self.dimension)
        self.frames: dict[str, Frame] = {}
        self.given: list[Given] = []
        self.rounded: list[str] = []
        faults = FaultsOfParts()
        for name, body in scene.bodies.items():
            with faults.part():
                self._add(name, body, seen.get(name, set()))
        faults.raised()

    def point(self, place: object, path: Path) -> Point:
        """Return a place.

        Raises
        ------
        InvalidParameter
            If the description has no such body or place.
        """
        if not isinstance(place, str):
            fixed = self.numerals.vector(place, path, self.dimension)
            self.table.places.append(fixed)
            return Point([constant(value) for value in fixed], None)
        body, _, spot = place.partition(".")
        frame = self.frames.get(body)
        if frame is None:
            rule = f'name a body of the scene or a point of the ground, unlike "{place[:80]}"'
            raise InvalidParameter(path, rule, remedy=near_and_all(body, self.frames, "bodies"))
        centre = [coordinate(i) for i in frame.position]
        if spot in ("", "centre"):
            return Point(centre, body)
        if spot not in frame.places:
            rule = f'name a place of "{body}"; "{spot[:80]}" is none'
            raise InvalidParameter(path, rule, remedy=near_and_all(spot, ["centre", *frame.places], "places"))
        return Point(self._offset(frame, centre, frame.places[spot], path), body)

    def carried(self, body: str, offset: Sequence[Ball], path: Path) -> Point:
        """Return the point of a body at an offset from its centre of mass, in body axes (m)."""
        frame = self.frames[body]
        return Point(self._offset(frame, [coordinate(i) for i in frame.position], offset, path), body)

    @property
    def positions(self) -> list[list[int]]:
        """The coordinates that are the components of vectors in space: centres and axes."""
        found: list[list[int]] = []
        for frame in self.frames.values():
            found += [frame.position, *(frame.axes or ())]
            found += [] if frame.axis is None else [frame.axis[1]]
        return found

    @property
    def directions(self) -> list[list[int]]:
        """The coordinates that are cosine and sine of an angle of the plane."""
        return [list(frame.direction) for frame in self.frames.values() if frame.direction is not None]

    @property
    def vectors(self) -> list[list[int]]:
        """The coordinates that are the components of vectors: centres, axes and turns."""
        turns = [list(frame.turns) for frame in self.frames.values() if frame.turns is not None]
        return [*self.positions, *turns]

    def vector_of(self, body: str | None, components: Sequence[Ball], path: Path) -> list[Poly]:
        """Return a vector that is fixed in a body, given by its components in body axes; None is the ground."""
        nothing: list[Poly] = [{} for _ in range(self.dimension)]
        if body is None or not self.frames[body].orients:
            return [constant(value) for value in components]
        return self._offset(self.frames[body], nothing, components, path)

    def turn_of(self, body: object, path: Path) -> Poly:
        """Return the angle of a body in the plane; of the ground, zero."""
        if body == GROUND:
            return {}
        if not isinstance(body, str) or body not in self.frames:
            remedy = near_and_all(body, self.frames, "bodies")
            raise InvalidParameter(path, 'name a body of the scene, or "ground"', remedy=remedy)
        turn = self.frames[body].turn
        if turn is None:
            raise InvalidParameter(
                path, "name a body of the plane that can turn", remedy="give the body its inertia (zero is allowed)"
            )
        return coordinate(turn)

    def start_angle(self, body: str) -> Ball:
        """Return the angle of a body of the plane at the start, as it was given (rad)."""
        given = self.scene.bodies[body].angle
        return ZERO if given is None else self.numerals.number(given, ("bodies", body, "angle"))

    def _offset(self, frame: Frame, centre: list[Poly], xi: Sequence[Ball], path: Path) -> list[Poly]:
        if all(is_zero(value) for value in xi):
            return centre
        if self.dimension == 2:
            if frame.direction is None:
                raise InvalidParameter(
                    path, f'be a place that "{frame.name}" has: a particle is a point', remedy="give its inertia"
                )
            c, s = frame.direction
            first: Poly = {(c,): xi[0], (s,): -xi[1]}
            second: Poly = {(s,): xi[0], (c,): xi[1]}
            return [combined((ONE, centre[0]), (ONE, first)), combined((ONE, centre[1]), (ONE, second))]
        if frame.axis is not None:
            k, n = frame.axis
            return [combined((ONE, centre[i]), (xi[k], coordinate(n[i]))) for i in range(3)]
        if frame.axes is None:
            raise InvalidParameter(
                path, f'be a place that "{frame.name}" has: a particle is a point', remedy="give its moments"
            )
        return [
            combined((ONE, centre[i]), *((xi[k], coordinate(frame.axes[k][i])) for k in range(3))) for i in range(3)
        ]

    def _add(self, name: str, body: SceneBody, seen: set[str]) -> None:
        path, numerals, table = ("bodies", name), self.numerals, self.table
        mass, tensor = inertia_of(name, body, numerals, self.dimension)
        where = numerals.vector(body.at, (*path, "at"), self.dimension)
        position = [table.coordinate(f"{name}.{axis}", "m", value) for axis, value in zip("xyz", where, strict=False)]
        frame = Frame(name, position)
        self.frames[name] = frame
        for i, pull in zip(position, self.gravity, strict=True):
            if not is_zero(mass):
                table.add_mass(i, i, mass)
                if not is_zero(pull):
                    table.add_load(i, mass * pull)
        if body.shape is not None:
            frame.shape = shape_of(body.shape, numerals, (*path, "shape"), self.dimension)
            if body.rim is not None and frame.shape.round:
                frame.radius = frame.shape.outline.radius
        if body.radius is not None:
            frame.radius = numerals.number(body.radius, (*path, "radius"))
            if not frame.radius > 0:
                raise InvalidParameter((*path, "radius"), "be greater than 0 m")
            if self.dimension == 3 and body.body is not None and not body.body.may_be_round:
                raise InvalidParameter(
                    (*path, "radius"),
                    f'be left out of a body of kind "{body.body.kind}": what rolls or touches in space by a radius is '
                    "a ball",
                    remedy='let its "places" touch, or describe it in the plane',
                )
        table.places += [where, [x + (frame.radius or ZERO) for x in where]]
        for spot, vector in body.places.items():
            frame.places[spot] = numerals.vector(vector, (*path, "places", spot), self.dimension)
        if body.velocity is not None:
            for i, value in enumerate(numerals.vector(body.velocity, (*path, "velocity"), self.dimension)):
                self.given.append(Given({position[i]: ONE}, value, (*path, "velocity", i)))
        if self.dimension == 2:
            self._orient_in_plane(frame, body, tensor, seen)
        else:
            SpatialOrientation(self.table, self.numerals, self.given, self.rounded).orient(frame, body, tensor, seen)

    def _orient_in_plane(self, frame: Frame, body: SceneBody, inertia: Any, seen: set[str]) -> None:
        path, numerals, table, name = ("bodies", frame.name), self.numerals, self.table, frame.name
        if inertia is None:
            for entry in ("angle", "angular_velocity"):
                if getattr(body, entry) is not None:
                    raise InvalidParameter((*path, entry), "be left out of a particle", remedy="give its inertia")
            return
        angle = 0 if body.angle is None else body.angle
        omega = None
        if body.angular_velocity is not None:
            omega = numerals.number(body.angular_velocity, (*path, "angular_velocity"))
        # An angle costs nothing where nothing sees the direction: it is then the whole orientation.
        if "direction" in seen:
            cosine, sine = numerals.angle(angle, (*path, "angle"))
            c = table.coordinate(f"{name}.cos", "1", cosine)
            s = table.coordinate(f"{name}.sin", "1", sine)
            frame.direction, frame.orients = (c, s), True
            for i in (c, s):
                if not is_zero(inertia):
                    table.add_mass(i, i, inertia)
            table.rows.append(Row.held(name, {(c, c): ONE, (s, s): ONE, (): -ONE}))
            if omega is not None:
                self.given.append(Given({s: cosine, c: -sine}, omega, (*path, "angular_velocity")))
        if "turn" in seen or "direction" not in seen:
            frame.turn = turn = table.coordinate(f"{name}.angle", "rad", numerals.number(angle, (*path, "angle")))
            if frame.direction is not None:
                c, s = frame.direction
                table.rows.append(Row(name, None, {turn: {(): ONE}, s: {(c,): -ONE}, c: {(s,): ONE}}))
            else:
                if not is_zero(inertia):
                    table.add_mass(turn, turn, inertia)
                if omega is not None:
                    self.given.append(Given({turn: ONE}, omega, (*path, "angular_velocity")))


def dimension_of(scene: Scene) -> int:
    """Return 2 for a scene of the plane, 3 for one of space, as gravity or the first position says."""
    leading: Any = scene.gravity
    path: Path = ("gravity",)
    if leading is None:
        name, body = next(iter(scene.bodies.items()))
        leading, path = body.at, ("bodies", name, "at")
    if isinstance(leading, Mapping):
        return 2
    if isinstance(leading, str) or not isinstance(leading, Sequence) or len(leading) not in (2, 3):
        remedy = f"such as {'[0, -9.81]' if path == ('gravity',) else '[0, 0]'}"
        raise InvalidParameter(path, "have two components in the plane or three in space", remedy=remedy)
    return len(leading)

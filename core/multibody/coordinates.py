"""From bodies to natural coordinates: positions, direction cosines where an orientation matters, angles of what turns.

In the plane a rigid body is (x, y, c, s) with M = diag(m, m, I, I) and c^2 + s^2 = 1, or an angle alone where nothing
sees its direction. In space it is its centre and three unit vectors, weighted by the integrals of the squares of body
coordinates; a symmetric top whose axis alone is seen is its centre and that axis, with the momentum about it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import arb

from core.errors import InvalidParameter, Path
from core.multibody.connections import GROUND, Place
from core.multibody.inertia import inertia_of, symmetry_axes, three_vectors
from core.multibody.language import Scene, SceneBody
from core.multibody.numerals import Numerals
from core.multibody.polynomials import (
    ONE,
    ZERO,
    Ball,
    Poly,
    combined,
    constant,
    coordinate,
    dot,
    is_zero,
)
from core.multibody.table import Row, Table
from core.near_names import near_and_all

Rate = dict[int, Poly]
"""A linear form in the rates, with affine coefficients."""


@dataclass
class Frame:
    """The coordinates of one body.

    Attributes
    ----------
    position : list of int
        Of the centre of mass.
    direction : tuple of int or None
        In the plane, cosine and sine of the angle of its first axis.
    turn : int or None
        In the plane, the angle itself, unwrapped.
    axes : list of list of int, or None
        In space, the components of each body axis.
    axis : tuple (int, list of int) or None
        Of a symmetric top: which body axis, and its components.
    turns : tuple of int, or None
        In space, of a body that rolls: three coordinates whose rates are its angular velocity in space.
    start_axes : three lists of balls, or None
        Of a ball, which has no other coordinates: the body axes at the start.
    """

    name: str
    position: list[int]
    radius: Ball | None = None
    direction: tuple[int, int] | None = None
    turn: int | None = None
    axes: list[list[int]] | None = None
    axis: tuple[int, list[int]] | None = None
    turns: tuple[int, ...] | None = None
    start_axes: list[list[Ball]] | None = None
    spin_momentum: Ball = ZERO
    spin_energy: Ball = ZERO
    orients: bool = False
    places: dict[str, tuple[Ball, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Point:
    """A place: its components as affine polynomials, and the body that carries it."""

    at: list[Poly]
    body: str | None


@dataclass(frozen=True)
class Given:
    """A rate that the client states: a linear form that equals a value."""

    line: dict[int, Ball]
    value: Ball
    path: Path


class Coordinates:
    """The table of the bodies alone, the places on them, and the velocities that the client gave."""

    def __init__(self, scene: Scene, numerals: Numerals, seen: Mapping[str, set[str]]) -> None:
        self.scene, self.numerals, self.table = scene, numerals, Table()
        self.dimension = dimension_of(scene)
        gravity = (0,) * self.dimension if scene.gravity is None else scene.gravity
        self.gravity = numerals.vector(gravity, ("gravity",), self.dimension)
        self.frames: dict[str, Frame] = {}
        self.given: list[Given] = []
        for name, body in scene.bodies.items():
            self._add(name, body, seen.get(name, set()))

    def point(self, place: Place, path: Path) -> Point:
        """Return a place.

        Raises
        ------
        InvalidParameter
            If the description has no such body or place.
        """
        if not isinstance(place, str):
            fixed = self.numerals.vector(place, path, self.dimension)
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

    def vector_of(self, body: str | None, components: Sequence[Ball], path: Path) -> list[Poly]:
        """Return a vector that is fixed in a body, given by its components in body axes; None is the ground."""
        nothing: list[Poly] = [{} for _ in range(self.dimension)]
        if body is None or not self.frames[body].orients:
            return [constant(value) for value in components]
        return self._offset(self.frames[body], nothing, components, path)

    def turn_of(self, body: str, path: Path) -> Poly:
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
        if body.radius is not None:
            frame.radius = numerals.number(body.radius, (*path, "radius"))
            if not frame.radius > 0:
                raise InvalidParameter((*path, "radius"), "be greater than 0 m")
        for spot, vector in body.places.items():
            frame.places[spot] = numerals.vector(vector, (*path, "places", spot), self.dimension)
        if body.velocity is not None:
            for i, value in enumerate(numerals.vector(body.velocity, (*path, "velocity"), self.dimension)):
                self.given.append(Given({position[i]: ONE}, value, (*path, "velocity", i)))
        if self.dimension == 2:
            self._orient_in_plane(frame, body, tensor, seen)
        else:
            self._orient_in_space(frame, body, tensor, seen)

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

    def _orient_in_space(self, frame: Frame, body: SceneBody, tensor: Any, seen: set[str]) -> None:
        path, numerals, table, name = ("bodies", frame.name), self.numerals, self.table, frame.name
        if tensor is None:
            for entry in ("axes", "angular_velocity"):
                if getattr(body, entry) is not None:
                    raise InvalidParameter((*path, entry), "be left out of a particle", remedy="give its moments")
            return
        given = [[int(i == j) for j in range(3)] for i in range(3)] if body.axes is None else body.axes
        axes = [
            numerals.vector(row, (*path, "axes", i), 3) for i, row in enumerate(three_vectors(given, (*path, "axes")))
        ]
        _check_axes(axes, (*path, "axes"))
        omega = None
        if body.angular_velocity is not None:
            vector: Any = body.angular_velocity
            omega = numerals.vector(vector, (*path, "angular_velocity"), 3)
        spots = [frame.places[spot] for spot in seen if spot in frame.places]
        if "turn" in seen and "orientation" not in seen and not spots and len(symmetry_axes(tensor)) == 3:
            self._ball(frame, axes, tensor, omega)
            return
        for k in symmetry_axes(tensor) if not seen & {"orientation", "turn"} else ():
            if all(is_zero(xi[i]) for xi in spots for i in range(3) if i != k):
                self._top(frame, k, axes, tensor, omega)
                return
        # Unit vectors move as particles do whose masses are the integrals of products of body coordinates.
        half = (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 2
        frame.axes = [
            [table.coordinate(f"{name}.axis{a + 1}.{'xyz'[i]}", "1", axes[a][i]) for i in range(3)] for a in range(3)
        ]
        frame.orients = True
        for a in range(3):
            for b in range(a, 3):
                weight = (half if a == b else ZERO) - tensor[a][b]
                if not is_zero(weight):
                    for i in range(3):
                        table.add_mass(frame.axes[a][i], frame.axes[b][i], weight)
                first = [coordinate(i) for i in frame.axes[a]]
                second = [coordinate(i) for i in frame.axes[b]]
                table.rows.append(
                    Row.held(name, combined((ONE, dot(first, second)), (-ONE, constant(ONE if a == b else ZERO))))
                )
        if omega is not None:
            space = [sum((omega[a] * axes[a][i] for a in range(3)), ZERO) for i in range(3)]
            for a in range(3):
                rate = _cross(space, axes[a])
                for i in range(3):
                    self.given.append(Given({frame.axes[a][i]: ONE}, rate[i], (*path, "angular_velocity")))
        if "turn" in seen and "orientation" not in seen:
            self._turns(frame)

    def _turns(self, frame: Frame) -> None:
        """Add the coordinates whose rates are the angular velocity in space, half the sum of e x e'."""
        table, name = self.table, frame.name
        assert frame.axes is not None
        frame.turns = tuple(table.coordinate(f"{name}.turn.{x}", "rad", ZERO) for x in "xyz")
        for i, turn in enumerate(frame.turns):
            j, k = (i + 1) % 3, (i + 2) % 3
            rates: Rate = {turn: constant(ONE)}
            for axis in frame.axes:
                rates[axis[k]] = {(axis[j],): -ONE / 2}
                rates[axis[j]] = {(axis[k],): ONE / 2}
            table.rows.append(Row(name, None, rates))

    def _ball(self, frame: Frame, axes: Any, tensor: Any, omega: Any) -> None:
        """Describe a ball with equal moments by its angular velocity in space alone: I w' is the torque."""
        table, name = self.table, frame.name
        frame.turns = tuple(table.coordinate(f"{name}.turn.{x}", "rad", ZERO) for x in "xyz")
        frame.start_axes, frame.orients = axes, True
        for i, turn in enumerate(frame.turns):
            if not is_zero(tensor[0][0]):
                table.add_mass(turn, turn, tensor[0][0])
            if omega is not None:
                value = sum((omega[a] * axes[a][i] for a in range(3)), ZERO)
                self.given.append(Given({turn: ONE}, value, ("bodies", name, "angular_velocity", i)))

    def _top(self, frame: Frame, k: int, axes: Any, tensor: Any, omega: Any) -> None:
        """Describe a symmetric top by its axis n: I n'' = ... + p n x n', with p = I_3 omega_3 conserved."""
        table, name = self.table, frame.name
        n = [table.coordinate(f"{name}.axis.{'xyz'[i]}", "1", axes[k][i]) for i in range(3)]
        frame.axis, frame.orients = (k, n), True
        transverse = tensor[(k + 1) % 3][(k + 1) % 3]
        for i in n:
            if not is_zero(transverse):
                table.add_mass(i, i, transverse)
        table.rows.append(Row.held(name, {(n[0], n[0]): ONE, (n[1], n[1]): ONE, (n[2], n[2]): ONE, (): -ONE}))
        if omega is None:
            return
        p = tensor[k][k] * omega[k]
        frame.spin_momentum, frame.spin_energy = p, p * omega[k] / 2
        if not is_zero(p):
            for i in range(3):
                j, m = (i + 1) % 3, (i + 2) % 3
                table.add_gyration(n[i], n[j], n[m], p)
                table.add_gyration(n[i], n[m], n[j], -p)
        space = [sum((omega[a] * axes[a][i] for a in range(3)), ZERO) for i in range(3)]
        for i, value in enumerate(_cross(space, axes[k])):
            self.given.append(Given({n[i]: ONE}, value, ("bodies", name, "angular_velocity")))


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


def _cross(a: Sequence[Ball], b: Sequence[Ball]) -> list[Ball]:
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


def _check_axes(axes: Any, path: Path) -> None:
    tolerance = arb("1e-6")
    for a in range(3):
        for b in range(a + 1):
            product = sum((x * y for x, y in zip(axes[a], axes[b], strict=True)), ZERO)
            if not abs(product - (1 if a == b else 0)) < tolerance:
                raise InvalidParameter(path, "be unit vectors at right angles to one another")
    handed = sum((x * y for x, y in zip(axes[0], _cross(axes[1], axes[2]), strict=True)), ZERO)
    if handed < 0:
        raise InvalidParameter(path, "be right-handed")

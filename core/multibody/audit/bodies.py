"""The bodies of a description and its places, read into doubles."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from functools import cached_property
from math import hypot
from typing import Any, Generic, TypeVar

import numpy as np

from core.multibody.audit.formulas import FormulaValue, MovingPlace, by_time
from core.multibody.audit.placement import LARGEST, LEAST, Numbers, Place, Placement, Pose, turned
from core.multibody.language.inertia import inertia_of
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.shapes import shape_of
from core.multibody.language.written import GROUND

Path = tuple[str | int, ...]

BEGIN = np.zeros(())
"""Time of the start (s)."""


Corner = TypeVar("Corner")


@dataclass(frozen=True)
class Outline(Generic[Corner]):
    """Corners with what is within a radius of them, or with an ellipsoid about each along the body axes (m)."""

    corners: tuple[Corner, ...]
    radius: float
    semi_axes: tuple[float, ...] = ()


@dataclass(frozen=True)
class RigidBody:
    """One body.

    Attributes
    ----------
    mass : float
    inertia : ndarray, shape () in the plane and (3, 3) in space, or None
        About the centre of mass, in space in body axes (kg m^2); None of a particle.
    radius : float or None
    outline : Outline or None
        Of its shape, with its corners in body axes from the centre of mass (m).
    start : Pose
    velocity, angular_velocity : ndarray or None
        As far as they are given; in space the angular velocity is in body axes.
    places : mapping of str to tuple of float
    """

    name: str
    mass: float
    inertia: Numbers | None
    radius: float | None
    start: Pose
    velocity: Numbers | None = None
    angular_velocity: Numbers | None = None
    places: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    outline: Outline[tuple[float, ...]] | None = None

    @cached_property
    def moment(self) -> float:
        """Largest component of the inertia, 0 of a particle (kg m^2)."""
        return 0.0 if self.inertia is None else float(np.abs(self.inertia).max())


class Reader:
    """Reads numbers, bodies and places of a scene; what is wrong with them has been refused before.

    Parameters
    ----------
    scene : Scene
    instead : mapping of path to float
        Numbers in place of those that are written.
    answered : collection of str
        Contacts of which an answer has states.
    bodies : mapping of str to RigidBody, optional
        As they are at another time, in place of the start.
    begun : mapping of int to placement, optional
        Where the bodies were when connections began, by their numbers; others begin where the bodies are.

    Attributes
    ----------
    moderate : bool
        Whether the powers of the numbers that were read so far are doubles.
    dimension : int
    gravity : tuple of float
    bodies : mapping of str to RigidBody
    """

    def __init__(
        self,
        scene: Scene,
        instead: Mapping[Path, float] | None = None,
        answered: Collection[str] | None = None,
        bodies: Mapping[str, RigidBody] | None = None,
        begun: Mapping[int, Placement] | None = None,
    ) -> None:
        self.begun = begun or {}
        self.scene, self.answered, others = scene, answered, {}
        self.moderate = True
        if instead:
            exact = Numerals.of({}, "doubles")
            others = {path: exact.number(value, path) for path, value in instead.items()}
        self.numerals = Numerals.of(scene.let, scene.numbers, instead=others)
        self.dimension = _dimension(scene)
        self.gravity = self.vector((0,) * self.dimension if scene.gravity is None else scene.gravity, ("gravity",))
        self.bodies = dict(bodies) if bodies else {name: self._body(name) for name in scene.bodies}
        self.start: Placement = {name: body.start for name, body in self.bodies.items()}

    def number(self, value: object, path: Path) -> float:
        """Return a number as the nearest double."""
        # The double that was sent is the one nearest to its decimal.
        if isinstance(value, (float, int, Decimal)) and path not in self.numerals.instead:
            found = float(value)
        else:
            found = float(self.numerals.number(value, path))
        self.note_size(found, path)
        return found

    def note_size(self, number: float, path: Path) -> None:
        """Take note of a number whose powers are no doubles; a coordinate may be as small as a zero is."""
        size = abs(number)
        of_law = path[:1] == ("connections",) and not isinstance(path[-1], int)
        if size >= LARGEST or (of_law and 0.0 < size <= LEAST):
            self.moderate = False

    def vector(self, value: object, path: Path) -> tuple[float, ...]:
        """Return a vector of the dimension of the scene."""
        if isinstance(value, (list, tuple)):
            return tuple(self.number(x, (*path, i)) for i, x in enumerate(value))
        return tuple(float(x) for x in self.numerals.vector(value, path, self.dimension))

    def unit(self, value: object, path: Path) -> tuple[float, ...]:
        """Return the direction of a vector."""
        # The squares of its components may be no doubles.
        found = np.array([float(x) for x in self.numerals.vector(value, path, self.dimension)])
        return tuple((found / hypot(*found)).tolist())

    def direction(self, slope: object, path: Path) -> tuple[float, float]:
        """Return cosine and sine of a slope."""
        cosine, sine = self.numerals.angle(0 if slope is None else slope, path)
        return float(cosine), float(sine)

    def place(self, value: object, path: Path) -> Place:
        """Return a place: of a body, by name, or of the ground."""
        if not isinstance(value, str):
            return self._point(value, path)
        if value == GROUND:
            return Place(None, (0.0,) * self.dimension)
        body, _, spot = value.partition(".")
        if spot in ("", "centre"):
            return Place(body, (0.0,) * self.dimension)
        return Place(body, self.bodies[body].places[spot])

    def _point(self, value: object, path: Path) -> Place:
        """Return a point of the ground, which may move by formulas of time."""
        if isinstance(value, (list, tuple)):
            found = [by_time(x, self.numerals, self.start, (*path, i)) for i, x in enumerate(value)]
            if any(found):
                every = tuple(
                    FormulaValue.constant(self.number(x, (*path, i)), self.start) if own is None else own
                    for i, (x, own) in enumerate(zip(value, found, strict=True))
                )
                return MovingPlace(None, tuple(float(one.value(self.start, {})) for one in every), every)
        return Place(None, self.vector(value, path))

    def rim(self, value: object) -> float:
        """Return the radius of a body that is named as a whole; 0 of any other place."""
        body = self.bodies.get(value) if isinstance(value, str) else None
        return 0.0 if body is None or body.radius is None else body.radius

    def outline(self, value: object, path: Path) -> Outline[Place]:
        """Return what a body touches with as a whole; of a place, itself as the only corner."""
        body = self.bodies.get(value) if isinstance(value, str) else None
        if body is None or body.outline is None:
            return Outline((self.place(value, path),), self.rim(value))
        corners = tuple(Place(body.name, corner) for corner in body.outline.corners)
        return Outline(corners, body.outline.radius, body.outline.semi_axes)

    def turns(self, body: str | None) -> bool:
        """Return whether something is a body with inertia."""
        return body is not None and body in self.bodies and self.bodies[body].inertia is not None

    def _body(self, name: str) -> RigidBody:
        body, path = self.scene.bodies[name], ("bodies", name)
        mass, inertia = self._inertia(name)
        position = np.array(self.vector(body.at, (*path, "at")))
        tensor, start = None, Pose(position, time=BEGIN)
        if inertia is not None and self.dimension == 2:
            tensor = np.array(inertia)
            turn = np.array(0.0 if body.angle is None else self.number(body.angle, (*path, "angle")))
            start = Pose(position, turned(turn), turn, BEGIN)
        elif inertia is not None:
            tensor = np.array(inertia)
            start = Pose(position, self._attitude(body.axes, (*path, "axes")), time=BEGIN)
        omega: Any = body.angular_velocity
        if omega is not None:
            where = (*path, "angular_velocity")
            omega = np.array(self.number(omega, where) if self.dimension == 2 else self.vector(omega, where))
        return RigidBody(
            name,
            mass,
            tensor,
            self._rim(name),
            start,
            None if body.velocity is None else np.array(self.vector(body.velocity, (*path, "velocity"))),
            omega,
            {spot: self.vector(value, (*path, "places", spot)) for spot, value in body.places.items()},
            self._outline(name),
        )

    def _rim(self, name: str) -> float | None:
        body = self.scene.bodies[name]
        own = ("radius",) if body.radius is not None else ("shape", "radius")
        return None if body.rim is None else self.number(body.rim, ("bodies", name, *own))

    def _outline(self, name: str) -> Outline[tuple[float, ...]] | None:
        written = self.scene.bodies[name].shape
        if written is None:
            return None
        outline = shape_of(written, self.numerals, ("bodies", name, "shape"), self.dimension).outline
        corners = tuple(tuple(map(float, corner)) for corner in outline.corners)
        return Outline(corners, float(outline.radius), tuple(map(float, outline.semi_axes)))

    def _inertia(self, name: str) -> tuple[float, Any]:
        body, path = self.scene.bodies[name], ("bodies", name)
        of_shape = body.shape is not None and body.inertia is None and body.moments is None
        if body.body is not None or body.tensor is not None or body.mass is None or of_shape:
            mass, tensor = inertia_of(name, body, self.numerals, self.dimension)
            if tensor is not None and self.dimension == 2:
                return float(mass), float(tensor)
            return float(mass), None if tensor is None else [[float(x) for x in row] for row in tensor]
        own = self.number(body.mass, (*path, "mass"))
        if body.inertia is not None:
            return own, self.number(body.inertia, (*path, "inertia"))
        return own, None if body.moments is None else np.diag(self.vector(body.moments, (*path, "moments")))

    def _attitude(self, axes: Sequence[Any] | None, path: Path) -> Numbers:
        if axes is None:
            return np.eye(3)
        return np.array([self.vector(axis, (*path, i)) for i, axis in enumerate(axes)]).T


def _dimension(scene: Scene) -> int:
    """Return 2 in the plane and 3 in space, as gravity or the first position says."""
    leading: Any = next(iter(scene.bodies.values())).at if scene.gravity is None else scene.gravity
    return 2 if isinstance(leading, Mapping) else len(leading)

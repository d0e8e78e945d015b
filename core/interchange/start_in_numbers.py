"""A scene at its start as numbers in doubles: bodies in space, those of the plane with z = 0."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import precision
from core.errors import MechanicsError, NotApplicable, Path
from core.multibody.algebra.polynomials import BITS
from core.multibody.answer import SceneSolution
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.language.body import SceneBody
from core.multibody.language.inertia import inertia_of
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.written import GROUND
from core.multibody.solve import solve_scene
from core.multibody.table.coordinates import dimension_of


@dataclass(frozen=True)
class NumericBody:
    """A body at the start.

    Attributes
    ----------
    mass : float
        In kg.
    tensor : ndarray, shape (3, 3), or None
        Of inertia about the centre of mass, along the axes of the body (kg m^2); None of a particle.
    centre : ndarray, shape (3,)
        Centre of mass in space (m).
    rotation : ndarray, shape (3, 3)
        Its columns are the axes of the body.
    velocity, turning : ndarray, shape (3,)
        Of the centre of mass (m/s), and angular velocity in space (rad/s).
    places : mapping of str to ndarray, shape (3,)
        From the centre of mass, along the axes of the body (m).
    """

    mass: float
    tensor: Floats | None
    centre: Floats
    rotation: Floats
    velocity: Floats
    turning: Floats
    places: Mapping[str, Floats]

    def point(self, inside: Floats) -> Floats:
        """Return where in space a point of the body is."""
        return self.centre + self.rotation @ inside


REST = NumericBody(0.0, None, np.zeros(3), np.eye(3), np.zeros(3), np.zeros(3), {})
"""The ground, as if it were a body."""


def _start(scene: Scene) -> SceneSolution:
    """Return the start of a scene, which decides what velocities are that were left out."""
    try:
        return solve_scene(replace(scene, attitudes=True), (0.0,), ("trajectory",))
    except MechanicsError as fault:
        if fault.path[:1] not in (("times",), ("accuracy",)):
            raise
        # A document has neither: the scene itself has no start that doubles tell.
        raise NotApplicable(fault.detail) from fault


class NumericScene:
    """The bodies of a scene in doubles, and the numbers of its connections.

    Attributes
    ----------
    scene : Scene
        With the places that satisfy its connections.
    plane : bool
    gravity : ndarray, shape (3,)
    bodies : mapping of str to NumericBody
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = assembled(scene).scene
        trajectory = _start(self.scene).trajectory
        columns = {} if trajectory is None else trajectory.columns
        start = {name: np.atleast_1d(column.values[0]) for name, column in columns.items() if len(column.values)}
        with precision(BITS):
            self.numerals = Numerals.of(self.scene.let, self.scene.numbers)
            self.dimension = dimension_of(self.scene)
            self.plane = self.dimension == 2
            gravity = self.scene.gravity
            self.gravity = np.zeros(3) if gravity is None else self.vector(gravity, ("gravity",))
            self.bodies = {name: self._body(name, body, start) for name, body in self.scene.bodies.items()}

    def number(self, value: object, path: Path) -> float:
        """Return a number; raise `InvalidParameter` for a formula of the motion."""
        with precision(BITS):
            return float(self.numerals.number(value, path))

    def vector(self, value: object, path: Path) -> Floats:
        """Return a vector of space; of one of the plane z is 0."""
        with precision(BITS):
            found = [float(x) for x in self.numerals.vector(value, path, self.dimension)]
        return np.array([*found, 0.0][:3])

    def angle(self, value: object, path: Path) -> Floats:
        """Return the direction in the plane at an angle from the x axis."""
        with precision(BITS):
            return np.array([*map(float, self.numerals.angle(value, path)), 0.0])

    def place(self, place: object, path: Path) -> tuple[str | None, Floats]:
        """Return the body of a place, None for the ground, and where it is in space."""
        if not isinstance(place, str):
            return None, self.vector(place, path)
        if place == GROUND:
            return None, np.zeros(3)
        name, _, spot = place.partition(".")
        body = self.bodies[name]
        return name, body.centre if spot in ("", "centre") else body.point(body.places[spot])

    def carrier(self, name: str | None) -> NumericBody:
        """Return a body, or the ground."""
        return REST if name is None else self.bodies[name]

    def _body(self, name: str, body: SceneBody, start: Mapping[str, Floats]) -> NumericBody:
        path: Path = ("bodies", name)
        mass, inertia = inertia_of(name, body, self.numerals, self.dimension)
        rotation, tensor = np.eye(3), None
        if self.plane:
            if inertia is not None:
                # Moments of a ball: those across the plane's normal matter nothing, and these are always matter's.
                tensor = float(inertia) * np.eye(3)
                x, y, _ = self.angle(body.angle or 0, (*path, "angle"))
                rotation = np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])
        elif inertia is not None:
            tensor = np.array([[float(arb(x)) for x in row] for row in inertia])
            if body.axes is not None:
                rotation = np.array([self.vector(axis, (*path, "axes", i)) for i, axis in enumerate(body.axes)]).T
        velocity = np.zeros(3)
        given = start.get(f"{name}.velocity")
        if given is not None:
            velocity[: len(given)] = given
        elif body.velocity is not None:
            velocity = self.vector(body.velocity, (*path, "velocity"))
        return NumericBody(
            float(mass),
            tensor,
            self.vector(body.at, (*path, "at")),
            rotation,
            velocity,
            self._turning(name, body, rotation, start),
            {spot: self.vector(at, (*path, "places", spot)) for spot, at in body.places.items()},
        )

    def _turning(self, name: str, body: SceneBody, rotation: Floats, start: Mapping[str, Floats]) -> Floats:
        given, path = start.get(f"{name}.angular_velocity"), ("bodies", name, "angular_velocity")
        if given is not None:
            return np.array([0.0, 0.0, given[0]]) if self.plane else rotation @ given
        if body.angular_velocity is None:
            return np.zeros(3)
        if self.plane:
            return np.array([0.0, 0.0, self.number(body.angular_velocity, path)])
        return rotation @ self.vector(body.angular_velocity, path)

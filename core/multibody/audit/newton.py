"""The laws of Newton and Euler for every body, as the power of all forces in every virtual motion.

For the virtual velocity dv and spin dw of one body, with J its tensor and g gravity,

    m (a - g).dv + (J w' + w x J w).dw  =  sum of F x effort + loads:

one equation for each component. What holds bodies without a force in the answer, as the moment in a weld, may add
anything along the rates of what it holds: that part of the equations is taken out by projection.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.definitions import Description
from core.multibody.audit.placement import Motion, Numbers, Placement, Twist, cross

Forces = Mapping[str, Numbers]


@dataclass(frozen=True)
class Acceleration:
    """Acceleration of a body.

    Attributes
    ----------
    linear : ndarray, shape (d,)
        Of the centre of mass (m/s^2).
    angular : ndarray, shape () in the plane and (3,) in space, or None
        In space in the axes of space (rad/s^2).
    """

    linear: Numbers
    angular: Numbers | None


class Freedoms:
    """The components of the virtual motions of the bodies of a description, numbered.

    Attributes
    ----------
    where : mapping of str to (int, int)
        Numbers of the first component of velocity and of spin of every body; the second is -1 of a particle.
    count : int
    """

    def __init__(self, description: Description) -> None:
        self.dimension = description.dimension
        spins = 1 if description.dimension == 2 else 3
        self.where: dict[str, tuple[int, int]] = {}
        self.count = 0
        for name, body in description.bodies.items():
            turns = body.inertia is not None
            self.where[name] = (self.count, self.count + self.dimension if turns else -1)
            self.count += self.dimension + (spins if turns else 0)
        self.spins = spins
        self._virtual: dict[tuple[str, ...], tuple[list[int], Motion]] = {}

    def body(self, number: int) -> str:
        """Return the body to which a component belongs."""
        return max((first, name) for name, (first, _) in self.where.items() if first <= number)[1]

    def virtual(self, bodies: tuple[str, ...]) -> tuple[list[int], Motion]:
        """Return the components of some bodies, and the unit virtual motions along each; they are the first axis."""
        if bodies not in self._virtual:
            self._virtual[bodies] = self._made(bodies)
        return self._virtual[bodies]

    def _made(self, bodies: tuple[str, ...]) -> tuple[list[int], Motion]:
        numbers: list[int] = []
        for name in bodies:
            first, spin = self.where[name]
            numbers.extend(range(first, first + self.dimension))
            if spin >= 0:
                numbers.extend(range(spin, spin + self.spins))
        units = np.eye(self.count)[numbers][:, None, :]
        motion = {}
        for name in bodies:
            first, spin = self.where[name]
            velocity = units[..., first : first + self.dimension]
            turning = None
            if spin >= 0:
                turning = units[..., spin] if self.spins == 1 else units[..., spin : spin + 3]
            motion[name] = Twist(velocity, turning)
        return numbers, motion


@dataclass(frozen=True)
class Balance:
    """What is left over of the equations at some samples, shapes (freedoms, samples).

    Attributes
    ----------
    rest : ndarray
        Inertial terms less forces.
    size : ndarray
        Sum of the sizes of its terms.
    free : ndarray, shape (freedoms, freedoms, samples) or None
        Projection on what is not held by unanswered forces; None where nothing is.
    unsure : ndarray
        What the stated errors of the forces change them by.
    """

    rest: Numbers
    size: Numbers
    free: Numbers | None
    unsure: Numbers

    def left(self) -> Numbers:
        """Return what is left over apart from what unanswered forces may do, shape (freedoms, samples)."""
        return self.rest if self.free is None else np.einsum("ijt,jt->it", self.free, self.rest)

    def allowed(self, of_inertia: Numbers, rounding: float) -> Numbers:
        """Return what may be left over, from the errors of the inertial terms, of forces and of rounding."""
        found = of_inertia + self.unsure + rounding * self.size
        if self.free is not None:
            found = np.einsum("ijt,jt->it", np.abs(self.free), found)
        # Directions are known to rounding: a large force leaves some of it at right angles to its line.
        known: Numbers = found + rounding * self.size.max(axis=0, initial=0.0)
        return known


def balance(
    description: Description,
    placement: Placement,
    motion: Motion,
    accelerations: Mapping[str, Acceleration],
    forces: Forces,
    force_errors: Forces | None = None,
    freedoms: Freedoms | None = None,
) -> Balance:
    """Return what is left over of the equations of motion at some samples.

    Parameters
    ----------
    placement, motion, accelerations
        With one leading axis, the samples.
    forces : mapping of str to ndarray, shape (samples,)
        Those of the answer. Those that it does not determine are left out, or NaN, and projected out.
    force_errors : mapping of str to ndarray, shape (samples,)
    """
    freedoms = freedoms or Freedoms(description)
    samples = next(iter(placement.values())).position.shape[0]
    rest, size, unsure = (np.zeros((freedoms.count, samples)) for _ in range(3))
    for name, body in description.bodies.items():
        _add_inertia(rest, size, freedoms, body, description.gravity, placement, motion, accelerations[name])
    held: list[Numbers] = []
    for connection in description.connections:
        numbers, virtual = freedoms.virtual(connection.bodies)
        for name, effort in connection.efforts(placement, virtual).items():
            force, known = forces.get(name), 0.0 if force_errors is None else force_errors.get(name, 0.0)
            if force is None:
                held.append(_spread(effort, numbers, rest.shape))
                continue
            open_ = np.isnan(force)
            if open_.any():
                # A direction that vanishes holds nothing.
                held.append(_spread(effort * open_, numbers, rest.shape))
                force, known = np.where(open_, 0.0, force), np.where(open_, 0.0, known)
            power = effort * force
            rest[numbers] -= power
            size[numbers] += np.abs(power)
            unsure[numbers] += np.abs(effort) * known
        for line in connection.unanswered(placement, virtual):
            held.append(_spread(line, numbers, rest.shape))
        if connection.loads:
            load = connection.load(placement, motion, virtual)
            rest[numbers] -= load
            size[numbers] += np.abs(load)
    return Balance(rest, size, _free(held), unsure)


def _add_inertia(
    rest: Numbers,
    size: Numbers,
    freedoms: Freedoms,
    body: RigidBody,
    gravity: tuple[float, ...],
    placement: Placement,
    motion: Motion,
    acceleration: Acceleration,
) -> None:
    first, spin = freedoms.where[body.name]
    for i, g in enumerate(gravity):
        rest[first + i] += body.mass * (acceleration.linear[..., i] - g)
        size[first + i] += body.mass * (np.abs(acceleration.linear[..., i]) + abs(g))
    if body.inertia is None:
        return
    angular, twist = acceleration.angular, motion[body.name].spin
    assert angular is not None, "a body with inertia has an angular acceleration"
    if freedoms.spins == 1:
        rest[spin] += body.inertia * angular
        size[spin] += np.abs(body.inertia * angular)
        return
    rotation = placement[body.name].rotation
    assert rotation is not None, "the caller knows the attitude of what it balances"
    assert twist is not None, "a body with inertia has a spin"
    tensor = rotation @ body.inertia @ np.swapaxes(rotation, -1, -2)
    terms = (
        np.einsum("tij,tj->ti", tensor, angular),
        cross(twist, np.einsum("tij,tj->ti", tensor, twist)),
    )
    for term in terms:
        rest[spin : spin + 3] += term.T
    # Vectors that are parallel leave a product of rounding's size.
    largest = np.abs(tensor).max(axis=(-1, -2))
    size[spin : spin + 3] += largest * (np.abs(angular).max(axis=-1) + 6.0 * np.abs(twist).max(axis=-1) ** 2)


def _spread(row: Numbers, numbers: list[int], shape: tuple[int, ...]) -> Numbers:
    found = np.zeros(shape)
    found[numbers] = row
    return found


def _free(held: list[Numbers]) -> Numbers | None:
    """Return the projections on what is at right angles to all of the held directions, shape (n, n, samples)."""
    if not held:
        return None
    rows = np.stack(held, axis=0).transpose(2, 0, 1)
    size = np.linalg.norm(rows, axis=2, keepdims=True)
    rows = rows / np.where(size > 0.0, size, 1.0)
    _, values, directions = np.linalg.svd(rows, full_matrices=False)
    # Dependent rows leave singular values of rounding's size.
    kept = np.where((values > 1e-9)[..., None], directions, 0.0)
    projection: Numbers = np.eye(rows.shape[2]) - np.swapaxes(kept, 1, 2) @ kept
    return projection.transpose(1, 2, 0)

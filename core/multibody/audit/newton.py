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
from core.multibody.audit.placement import STEP, Motion, Numbers, Placement, Twist, cross

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
        self._virtual: dict[tuple[str, ...], tuple[list[int] | slice, Motion]] = {}

    def body(self, number: int) -> str:
        """Return the body to which a component belongs."""
        return max((first, name) for name, (first, _) in self.where.items() if first <= number)[1]

    def moving(self, body: str) -> slice:
        """Return the components of the velocity of a body."""
        first = self.where[body][0]
        return slice(first, first + self.dimension)

    def turning(self, body: str) -> slice:
        """Return the components of the spin of a body that has one."""
        first = self.where[body][1]
        return slice(first, first + self.spins)

    def virtual(self, bodies: tuple[str, ...]) -> tuple[list[int] | slice, Motion]:
        """Return the components of some bodies, and the unit virtual motions along each; they are the first axis."""
        if bodies not in self._virtual:
            self._virtual[bodies] = self._made(bodies)
        return self._virtual[bodies]

    def _made(self, bodies: tuple[str, ...]) -> tuple[list[int] | slice, Motion]:
        numbers: list[int] = []
        for name in bodies:
            first, spin = self.where[name]
            numbers.extend(range(first, first + self.dimension + (self.spins if spin >= 0 else 0)))
        units, motion, own = np.eye(len(numbers))[:, None], {}, 0
        for name in bodies:
            velocity, turning = units[..., own : own + self.dimension], None
            own += self.dimension
            if self.where[name][1] >= 0:
                turning = units[..., own] if self.spins == 1 else units[..., own : own + 3]
                own += self.spins
            motion[name] = Twist(velocity, turning)
        whole = numbers == list(range(numbers[0], numbers[0] + len(numbers))) if numbers else False
        return slice(numbers[0], numbers[0] + len(numbers)) if whole else numbers, motion


@dataclass(frozen=True)
class EquationBalance:
    """What is left over of the equations at some samples, shapes (freedoms, samples).

    Attributes
    ----------
    rest : ndarray
        Inertial terms less forces.
    size : ndarray
        Sum of the sizes of its terms.
    free : ndarray, shape (freedoms, freedoms, samples) or None
        Projection on what is not held by unanswered forces; None where nothing is.
    undecided : ndarray of bool, shape (samples,)
        Where a formula changes its piece, and neither its argument nor the rate of that tells the piece that follows.
    """

    rest: Numbers
    size: Numbers
    free: Numbers | None
    undecided: Numbers

    def left(self) -> Numbers:
        """Return what is left over apart from what unanswered forces may do, shape (freedoms, samples)."""
        return self.rest if self.free is None else np.einsum("ijt,jt->it", self.free, self.rest)

    def allowed(self, of_inertia: Numbers, rounding: float) -> Numbers:
        """Return what may be left over, from the errors of the inertial terms and of rounding."""
        found = of_inertia + rounding * self.size
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
    freedoms: Freedoms | None = None,
) -> EquationBalance:
    """Return what is left over of the equations of motion at some samples.

    Parameters
    ----------
    placement, motion, accelerations
        With one leading axis, the samples.
    forces : mapping of str to ndarray, shape (samples,)
        Those of the answer. Where one is left out, or NaN, it is what its law says; without a law it is projected out.
    """
    freedoms = freedoms or Freedoms(description)
    samples = next(iter(placement.values())).position.shape[0]
    rest, size = np.zeros((2, freedoms.count, samples))
    for name, body in description.bodies.items():
        _add_inertia(rest, size, freedoms, body, description.gravity, placement, motion, accelerations[name])
    held: list[Numbers] = []
    undecided = np.zeros(samples, dtype=bool)
    for connection in description.connections:
        numbers, virtual = freedoms.virtual(connection.bodies)
        now = connection.ahead(placement, motion), motion
        if connection.switches:
            now = now[0], _with_gains(motion, accelerations)
            undecided |= connection.undecided(*now)
        efforts = connection.efforts(placement, virtual)
        missing = {
            name: np.ones(samples, dtype=bool) if name not in forces else np.isnan(forces[name])
            for name in efforts
            if name not in forces or np.isnan(forces[name]).any()
        }
        laws = {name: value.real for name, value in connection.laws(*now).items()} if missing else {}
        for name, line in (connection.holding(placement, virtual) if missing else {}).items():
            if name in missing:
                # A direction that vanishes holds nothing.
                held.append(_spread(line * missing[name], numbers, rest.shape))
        for name, effort in efforts.items():
            force = forces.get(name)
            if name in missing:
                force = np.where(missing[name], laws.get(name, 0.0), 0.0 if force is None else force)
            power = effort * force
            rest[numbers] -= power
            size[numbers] += np.abs(power)
        for line in connection.unanswered(placement, virtual):
            held.append(_spread(line, numbers, rest.shape))
        if connection.loads:
            load = connection.load(*now, virtual).real
            rest[numbers] -= load
            size[numbers] += np.abs(load)
    return EquationBalance(rest, size, _free(held), undecided)


def _with_gains(motion: Motion, accelerations: Mapping[str, Acceleration]) -> Motion:
    """Return a motion that is moved by an imaginary step along the accelerations."""
    step, found = 1j * STEP, {}
    for name, twist in motion.items():
        gain = accelerations[name]
        spin = twist.spin if twist.spin is None or gain.angular is None else twist.spin + step * gain.angular
        found[name] = Twist(twist.velocity + step * gain.linear, spin)
    return found


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
    own, gain, pull = freedoms.moving(body.name), acceleration.linear.T, np.array(gravity)[:, None]
    rest[own] += body.mass * (gain - pull)
    size[own] += body.mass * (np.abs(gain) + np.abs(pull))
    if body.inertia is None:
        return
    angular, twist, own = acceleration.angular, motion[body.name].spin, freedoms.turning(body.name)
    assert angular is not None, "a body with inertia has an angular acceleration"
    if freedoms.spins == 1:
        moment = body.inertia * angular
        rest[own] += moment
        size[own] += np.abs(moment)
        return
    rotation = placement[body.name].rotation
    assert rotation is not None, "the caller knows the attitude of what it balances"
    assert twist is not None, "a body with inertia has a spin"
    tensor = rotation @ body.inertia @ np.swapaxes(rotation, -1, -2)
    gain, turning = (tensor @ np.stack([angular, twist], axis=-1)).transpose(2, 1, 0)
    rest[own] += gain + cross(twist, turning.T).T
    # Vectors that are parallel leave a product of rounding's size.
    largest = np.abs(tensor).max(axis=(-1, -2))
    size[own] += largest * (np.abs(angular).max(axis=-1) + 6.0 * np.abs(twist).max(axis=-1) ** 2)


def _spread(row: Numbers, numbers: list[int] | slice, shape: tuple[int, ...]) -> Numbers:
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

"""Where bodies are, how they move, and the rate of any function of the placement along a motion.

All arrays have leading axes of their own, say samples, or virtual motions by samples; shapes are given without them.
A function of the placement is written with analytic operations alone. Its rate is then the imaginary part that a
placement moved by an imaginary step gives it, to the last digit: there is no difference that cancels.

References
----------
W. Squire, G. Trapp, "Using complex variables to estimate derivatives of real functions", SIAM Review 40 (1998).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]
"""Doubles, or complex numbers where a rate is formed."""

STEP = 2.0**-450
"""Imaginary step (s): its square vanishes beside that of any length above 1e-120 at a speed of one, and its product
with such a length is still a normal double."""

LEAST, LARGEST = 1e-100, 1e70
"""Sizes of numbers between which rates are formed by imaginary steps, and fourth powers are doubles."""


class Pose(NamedTuple):
    """Where a body is.

    Attributes
    ----------
    position : ndarray, shape (d,)
        Of the centre of mass (m).
    rotation : ndarray, shape (d, d), or None
        Its columns are the body axes. None of a particle, and of a body whose attitude is not known.
    turn : ndarray, shape (), or None
        In the plane, the unwrapped angle (rad).
    time : ndarray, shape (), or None
        When it is there, from the start (s); None where that is not known.
    """

    position: Numbers
    rotation: Numbers | None = None
    turn: Numbers | None = None
    time: Numbers | None = None

    def at(self, rows: Numbers | slice | None) -> Pose:
        """Return some samples of it; for None, itself as one sample."""
        position, rotation, turn, time = self
        return Pose(
            position[rows],
            None if rotation is None else rotation[rows],
            None if turn is None else turn[rows],
            None if time is None else time[rows],
        )


class Twist(NamedTuple):
    """How a body moves.

    Attributes
    ----------
    velocity : ndarray, shape (d,)
        Of the centre of mass (m/s).
    spin : ndarray, shape () in the plane and (3,) in space, or None
        Angular velocity, in space in the axes of space (rad/s). None of a particle.
    """

    velocity: Numbers
    spin: Numbers | None = None

    def at(self, rows: Numbers | slice) -> Twist:
        """Return some samples of it."""
        return Twist(self.velocity[rows], None if self.spin is None else self.spin[rows])


QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])
"""The rotation of the plane by a right angle."""

Placement = Mapping[str, Pose]
Motion = Mapping[str, Twist]
"""Of bodies by name; those that are missing do not move."""

Measure = Callable[[Placement], Numbers]
"""A number that a placement has, such as a distance (without leading axes, shape ())."""


class Undefined(Exception):
    """A connection, or something that is needed of it, has no definition here: the laws that need it are not checked.

    Parameters
    ----------
    what : str
        Kind of the connection, and its variant.
    """

    def __init__(self, what: str) -> None:
        super().__init__(what)
        self.what = what


@dataclass(frozen=True)
class Place:
    """A point of a body, by its offset in body axes from the centre of mass; of the ground, by its coordinates."""

    body: str | None
    offset: tuple[float, ...]

    @property
    def quickness(self) -> float | None:
        """Largest rate of the formulas of time by which it moves (rad/s); None of a place that is fixed."""
        return None

    def at(self, placement: Placement) -> Numbers:
        """Return its coordinates in space (m), shape (d,).

        Raises
        ------
        Undefined
            Where it is not the centre of a body whose attitude is not known.
        """
        if self.body is None:
            return np.array(self.offset)
        pose = placement[self.body]
        return pose.position + self.arm(pose) if any(self.offset) else pose.position

    def velocity(self, placement: Placement, motion: Motion) -> Numbers:
        """Return its velocity in a motion, which may be a virtual one (m/s), shape (d,): v + w x r."""
        twist = None if self.body is None else motion.get(self.body)
        if twist is None:
            return np.zeros(len(self.offset))
        if twist.spin is None or not any(self.offset):
            return twist.velocity
        assert self.body is not None, "the ground does not move"
        arm = self.arm(placement[self.body])
        turning = twist.spin[..., None] * across(arm) if len(self.offset) == 2 else cross(twist.spin, arm)
        found: Numbers = twist.velocity + turning
        return found

    def arm(self, pose: Pose) -> Numbers:
        """Return the vector from the centre of mass to the place, shape (d,)."""
        return carried(pose, self.offset)

    @property
    def bodies(self) -> tuple[str, ...]:
        """The body that carries it, if any."""
        return () if self.body is None else (self.body,)


def carried(pose: Pose | None, components: tuple[float, ...]) -> Numbers:
    """Return a vector that is fixed in a body, or in the ground, in space.

    Raises
    ------
    Undefined
        Where the attitude of the body is not known.
    """
    if pose is None:
        return np.array(components)
    if pose.rotation is None:
        raise Undefined("a direction in a body whose attitude is not known")
    found: Numbers = pose.rotation @ np.array(components)
    return found


def turned(turn: Numbers) -> Numbers:
    """Return the rotation of the plane by an angle, shape (2, 2)."""
    found = np.empty((*turn.shape, 2, 2), dtype=turn.dtype)
    found[..., 0, 0] = found[..., 1, 1] = np.cos(turn)
    found[..., 1, 0] = np.sin(turn)
    found[..., 0, 1] = -found[..., 1, 0]
    return found


def dot(a: Numbers, b: Numbers) -> Numbers:
    """Return the scalar product along the last axis."""
    found: Numbers = np.add.reduce(a * b, axis=-1)
    return found


def across(v: Numbers) -> Numbers:
    """Return a vector of the plane, turned by a right angle counter-clockwise."""
    found = np.empty_like(v)
    found[..., 0], found[..., 1] = -v[..., 1], v[..., 0]
    return found


def cross(a: Numbers, b: Numbers) -> Numbers:
    """Return the vector product of two vectors of space along the last axis."""
    i, j = [1, 2, 0], [2, 0, 1]
    found: Numbers = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return found


def length(v: Numbers) -> Numbers:
    """Return the length of a vector that is not zero."""
    found: Numbers = np.sqrt(dot(v, v))
    return found


def angle(x: Numbers, y: Numbers) -> Numbers:
    """Return the angle of the vector (x, y), between -pi and pi, in doubles or with its rate as imaginary part."""
    plain: Numbers = np.arctan2(y.real, x.real)
    if not (np.iscomplexobj(x) or np.iscomplexobj(y)):
        return plain
    square = x.real * x.real + y.real * y.real
    found: Numbers = plain + 1j * (x.real * y.imag - y.real * x.imag) / square
    return found


def moved(placement: Placement, motion: Motion, *, in_time: bool = False) -> Placement:
    """Return a placement moved by an imaginary step along a motion; in time, too, unless the motion is virtual."""
    found = {**placement, **{name: _moved(placement[name], twist) for name, twist in motion.items()}}
    if not in_time:
        return found
    return {
        name: pose._replace(time=None if pose.time is None else pose.time + 1j * STEP) for name, pose in found.items()
    }


def _moved(pose: Pose, twist: Twist) -> Pose:
    step = 1j * STEP
    position = pose.position + step * twist.velocity
    if twist.spin is None:
        return Pose(position, pose.rotation, pose.turn, pose.time)
    turn = None if pose.turn is None else pose.turn + step * twist.spin
    if pose.rotation is None:
        return Pose(position, None, turn, pose.time)
    if pose.position.shape[-1] == 2:
        return Pose(
            position, pose.rotation + step * twist.spin[..., None, None] * (QUARTER @ pose.rotation), turn, pose.time
        )
    axes = np.swapaxes(pose.rotation, -1, -2)
    rates = np.swapaxes(cross(twist.spin[..., None, :], axes), -1, -2)
    return Pose(position, pose.rotation + step * rates, turn, pose.time)


def rate(measure: Measure, placement: Placement, motion: Motion) -> Numbers:
    """Return the rate of a measure along a motion, which may be a virtual one, shape ()."""
    return with_rate(measure, placement, motion)[1]


def with_rate(measure: Measure, placement: Placement, motion: Motion) -> tuple[Numbers, Numbers]:
    """Return a measure and its rate along a motion, both of shape ()."""
    found = measure(moved(placement, motion))
    value: Numbers = found.real
    change: Numbers = found.imag / STEP
    return value, change


def spin_of(motion: Motion, body: str | None) -> Numbers | float:
    """Return the angular velocity of a body; zero of the ground, of particles and of what does not move."""
    twist = None if body is None else motion.get(body)
    return 0.0 if twist is None or twist.spin is None else twist.spin

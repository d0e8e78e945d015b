"""Frames of reference as files write them: a rotation and an origin, in doubles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats

PARALLEL = 1e-9
"""Sine of the angle up to which two directions of a file, which have some ten digits, are parallel."""


@dataclass(frozen=True)
class Frame:
    """A frame in another.

    Attributes
    ----------
    rotation : ndarray, shape (3, 3)
        Its columns are the axes of the frame.
    origin : ndarray, shape (3,)
        In metres.
    """

    rotation: Floats
    origin: Floats

    def __matmul__(self, inner: Frame) -> Frame:
        """Return a frame that is given in this one, where this one is given."""
        return Frame(self.rotation @ inner.rotation, self.point(inner.origin))

    def point(self, place: Floats) -> Floats:
        """Return a point that is given in this frame."""
        return self.rotation @ place + self.origin

    def direction(self, vector: Floats) -> Floats:
        """Return a vector that is given in this frame."""
        return self.rotation @ vector

    def inside(self, place: Floats) -> Floats:
        """Return the coordinates in this frame of a point."""
        return self.rotation.T @ (place - self.origin)


def vector(numbers: Sequence[float] | Floats) -> Floats:
    """Return numbers as an array."""
    return np.array(numbers, np.float64)


def at(place: Sequence[float] | Floats, rotation: Floats | None = None) -> Frame:
    """Return the frame at a place, with the axes of the outer one unless a rotation is given."""
    return Frame(np.eye(3) if rotation is None else rotation, vector(place))


def unit(direction: Floats) -> Floats:
    """Return numbers of any size, not all zero, divided by their length."""
    # The squares of components of any size are doubles once the largest is about one; powers of two round nothing.
    scaled: Floats = np.ldexp(direction, -np.frexp(np.abs(direction).max())[1])
    return scaled / np.linalg.norm(scaled)


def turn_about(axis: Floats, angle: float) -> Floats:
    """Return the rotation by an angle about an axis of length one (Rodrigues)."""
    if angle == 0.0:
        return np.eye(3)
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: Floats = c * np.eye(3) + s * across + (1.0 - c) * np.outer(axis, axis)
    return rotation


def roll_pitch_yaw(angles: Sequence[float]) -> Floats:
    """Return the rotation of URDF and SDF: about the fixed axes x, y and z in this order."""
    x, y, z = np.eye(3)
    roll, pitch, yaw = angles
    return turn_about(z, yaw) @ turn_about(y, pitch) @ turn_about(x, roll)


def of_quaternion(numbers: Sequence[float] | Floats) -> Floats:
    """Return the rotation of a quaternion w, x, y, z of any length other than zero."""
    w, x, y, z = unit(vector(numbers))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def as_quaternion(rotation: Floats) -> Floats:
    """Return the quaternion w, x, y, z of a rotation, from its largest component (Shepperd 1978)."""
    trace = float(np.trace(rotation))
    choices = [trace, *np.diag(rotation)]
    k = int(np.argmax(choices))
    root = np.sqrt(1.0 + 2.0 * choices[k] - trace)
    found = np.zeros(4)
    if k == 0:
        found[:] = 1.0 + trace, *(rotation[[2, 0, 1], [1, 2, 0]] - rotation[[1, 2, 0], [2, 0, 1]])
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        found[0] = rotation[m, j] - rotation[j, m]
        found[1 + i] = root * root
        found[1 + j] = rotation[i, j] + rotation[j, i]
        found[1 + m] = rotation[i, m] + rotation[m, i]
    quaternion: Floats = found / (2.0 * root)
    return quaternion


def axes_from(normal: Floats) -> Floats:
    """Return the smallest rotation that takes the z axis to a direction."""
    z = unit(normal)
    across = np.cross([0.0, 0.0, 1.0], z)
    sine = float(np.linalg.norm(across))
    if sine == 0.0:
        return np.eye(3) if z[2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    return turn_about(across / sine, float(np.arctan2(sine, z[2])))


def parallel(a: Floats, b: Floats) -> bool:
    """Return whether two directions of length one are parallel or opposite."""
    return bool(np.linalg.norm(np.cross(a, b)) < PARALLEL)

"""Maximal coordinates: position and angle of every body of the plane, position and rotation in space.

Rates are velocities of centres of mass and angular velocities, in space in the axes of space. Particles do not turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.multibody.audit.bodies import Reader
from core.multibody.audit.placement import STEP, Placement, Pose, Twist

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Places and rates of all bodies.

    Attributes
    ----------
    position : ndarray, shape (b, d)
    turn : ndarray, shape (b,) in the plane (rad), (b, 3, 3) in space: columns are the body axes.
    rates : ndarray, shape (n,)
    """

    position: Floats
    turn: Floats
    rates: Floats


class Coordinates:
    """The coordinates of the bodies of a scene.

    Attributes
    ----------
    names : list of str
    dimension : int
    size : int
        Number n of rates.
    """

    def __init__(self, reader: Reader) -> None:
        self.names, self.dimension = list(reader.bodies), reader.dimension
        self.bodies = [reader.bodies[name] for name in self.names]
        d, b = self.dimension, len(self.names)
        self.width = d + (1 if d == 2 else 3)
        alive = np.ones((b, self.width), dtype=bool)
        for i, body in enumerate(self.bodies):
            alive[i, d:] = body.inertia is not None
        self.alive = alive
        self.size = int(alive.sum())
        ends = np.cumsum(alive.sum(axis=1))
        self.turning = [(i, slice(ends[i] - self.width + d, ends[i])) for i in range(b) if alive[i, -1]]
        self.masses = np.array([body.mass for body in self.bodies])
        self.rigid = np.array([body.inertia is not None for body in self.bodies])
        if d == 2:
            self.inertias = np.array([0.0 if body.inertia is None else float(body.inertia) for body in self.bodies])
        else:
            self.inertias = np.array([np.zeros((3, 3)) if x.inertia is None else x.inertia for x in self.bodies])

    def start(self) -> State:
        """Return the places as they are described, and no rates."""
        position = np.array([np.asarray(body.start.position, dtype=float) for body in self.bodies])
        if self.dimension == 2:
            turn = np.array([0.0 if body.start.turn is None else float(body.start.turn) for body in self.bodies])
        else:
            turn = np.array([np.eye(3) if x.start.rotation is None else x.start.rotation for x in self.bodies])
        return State(position, turn, np.zeros(self.size))

    def spread(self, rates: Floats) -> tuple[Floats, Floats]:
        """Return velocities (..., b, d) and spins (..., b) or (..., b, 3) of rates (..., n)."""
        full = np.zeros((*rates.shape[:-1], *self.alive.shape))
        full[..., self.alive] = rates
        spins = full[..., self.dimension] if self.dimension == 2 else full[..., self.dimension :]
        return full[..., : self.dimension], spins

    def motion(self, rates: Floats) -> dict[str, Twist]:
        """Return rates by body."""
        velocity, spin = self.spread(rates)
        where = (lambda x, i: x[..., i]) if self.dimension == 2 else (lambda x, i: x[..., i, :])
        return {
            name: Twist(velocity[..., i, :], where(spin, i) if self.rigid[i] else None)
            for i, name in enumerate(self.names)
        }

    def placement(self, state: State, rates: Floats | None = None, by: Floats | None = None) -> Placement:
        """Return the placement, or many: moved along rates by finite times, and by an imaginary step beside.

        Parameters
        ----------
        rates : ndarray, shape (k, n)
        by : ndarray, shape (k,)
            Times by which the places move along the rates (s).
        """
        position, turn = state.position, state.turn
        if rates is None or by is None:
            rotation = _rotations(turn) if self.dimension == 2 else turn
            return self._named(position, rotation, turn)
        velocity, spin = self.spread(rates)
        step = by + 1j * STEP
        position = position + step[:, None, None] * velocity
        if self.dimension == 2:
            turned = turn + step[:, None] * spin
            return self._named(position, _rotations(turned), turned)
        rotation = turn[None]
        moved = by != 0.0
        if moved.any():
            rotation = np.repeat(rotation, len(by), axis=0)
            rotation[moved] = rotations_by(by[moved, None, None] * spin[moved]) @ turn
        return self._named(position, rotation + 1j * STEP * (skew(spin) @ rotation), None)

    def advanced(self, state: State, change: Floats) -> State:
        """Return the state with its places moved by small changes, of shape (n,)."""
        move, angle = self.spread(change)
        turn = state.turn + angle if self.dimension == 2 else rotations_by(angle) @ state.turn
        return State(state.position + move, turn, state.rates)

    def _named(self, position: Floats, rotation: Floats, turn: Floats | None) -> Placement:
        flat = self.dimension == 2
        return {
            name: Pose(
                position[..., i, :],
                rotation[..., i, :, :] if self.rigid[i] else None,
                turn[..., i] if flat and turn is not None and self.rigid[i] else None,
            )
            for i, name in enumerate(self.names)
        }

    def inertia(self, state: State) -> Floats:
        """Return the mass matrix, shape (n, n)."""
        d = self.dimension
        full = np.zeros(self.alive.shape)
        full[:, :d] = self.masses[:, None]
        if d == 2:
            full[:, d] = self.inertias
            return np.diag(full[self.alive])
        found = np.diag(full[self.alive])
        tensors = state.turn @ self.inertias @ np.swapaxes(state.turn, -1, -2)
        for i, where in self.turning:
            found[where, where] = tensors[i]
        return found

    def gyroscopic(self, state: State) -> Floats:
        """Return the moments -w x J w of turning bodies in space, shape (n,)."""
        full = np.zeros(self.alive.shape)
        if self.dimension == 3:
            _, spin = self.spread(state.rates)
            momentum = np.einsum("bij,bjk,blk,bl->bi", state.turn, self.inertias, state.turn, spin)
            full[:, 3:] = -(skew(spin) @ momentum[..., None])[..., 0]
        return full[self.alive]

    def weights(self, gravity: Floats) -> Floats:
        """Return the forces of gravity, shape (n,)."""
        full = np.zeros(self.alive.shape)
        full[:, : self.dimension] = self.masses[:, None] * gravity
        return full[self.alive]

    def pack(self, state: State) -> Floats:
        """Return a state as one vector: attitudes in space as quaternions."""
        turn = state.turn if self.dimension == 2 else np.array([quaternion(x) for x in state.turn])
        return np.concatenate([state.position.ravel(), turn.ravel(), state.rates])

    def unpack(self, vector: Floats) -> State:
        """Return the state that a vector holds."""
        b, d = self.alive.shape[0], self.dimension
        position = vector[: b * d].reshape(b, d)
        if d == 2:
            return State(position, vector[2 * b : 3 * b], vector[3 * b :])
        q = vector[3 * b : 7 * b].reshape(b, 4)
        return State(position, _matrices(q / np.linalg.norm(q, axis=1)[:, None]), vector[7 * b :])

    def flow(self, vector: Floats, accelerations: Floats) -> Floats:
        """Return the rate of a packed state."""
        b = self.alive.shape[0]
        start = len(vector) - self.size
        velocity, spin = self.spread(vector[start:])
        if self.dimension == 2:
            return np.concatenate([velocity.ravel(), spin, accelerations])
        q = vector[3 * b : 7 * b].reshape(b, 4)
        w, v = q[:, :1], q[:, 1:]
        rate = 0.5 * np.concatenate(
            [-(spin * v).sum(axis=1)[:, None], w * spin + (skew(spin) @ v[..., None])[..., 0]], axis=1
        )
        return np.concatenate([velocity.ravel(), rate.ravel(), accelerations])


def skew(v: Floats) -> Floats:
    """Return the matrices of vector products, shape (..., 3, 3)."""
    found = np.zeros((*v.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., i, j], found[..., j, i] = -v[..., k], v[..., k]
    return found


def rotations_by(vector: Floats) -> Floats:
    """Return the rotations by vectors of angles (Rodrigues' formula)."""
    size = np.linalg.norm(vector, axis=-1)[..., None, None]
    k = skew(vector)
    return np.eye(3) + np.sinc(size / np.pi) * k + 0.5 * np.sinc(size / (2 * np.pi)) ** 2 * (k @ k)


def _rotations(turn: Floats) -> Floats:
    found = np.empty((*turn.shape, 2, 2), dtype=turn.dtype)
    found[..., 0, 0] = found[..., 1, 1] = np.cos(turn)
    found[..., 1, 0] = np.sin(turn)
    found[..., 0, 1] = -found[..., 1, 0]
    return found


def _matrices(q: Floats) -> Floats:
    w, v = q[:, 0], q[:, 1:]
    outer = v[:, :, None] * v[:, None, :]
    return (2 * w * w - 1)[:, None, None] * np.eye(3) + 2 * outer + 2 * w[:, None, None] * skew(v)


def quaternion(rotation: Floats) -> Floats:
    """Return the unit quaternion of a rotation, its largest component positive."""
    r = rotation
    full = np.array(
        [
            [1 + r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], 1 + r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 1 - r[0, 0] + r[1, 1] - r[2, 2], r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 1 - r[0, 0] - r[1, 1] + r[2, 2]],
        ]
    )
    row = full[int(np.argmax(full.diagonal()))]
    return row / np.linalg.norm(row)

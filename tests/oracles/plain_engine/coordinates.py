"""Maximal coordinates: position and angle of every body of the plane, position and rotation in space.

Rates are velocities of centres of mass and angular velocities, in space in the axes of space. Particles do not turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

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
    dimension, width : int
        Of a position; number of rates of a rigid body.
    alive : ndarray of bool, shape (b, width)
        Which rates the bodies have.
    size : int
        Number n of rates.
    """

    def __init__(self, reader: Reader) -> None:
        self.names, self.bodies = list(reader.bodies), list(reader.bodies.values())
        self.dimension = d = reader.dimension
        turns = 1 if d == 2 else 3
        self.width = d + turns
        self.rigid = [body.inertia is not None for body in self.bodies]
        self.alive = np.ones((len(self.bodies), self.width), dtype=bool)
        self.alive[np.logical_not(self.rigid), d:] = False
        self.size = int(self.alive.sum())
        self.masses = np.array([body.mass for body in self.bodies])
        none = np.zeros((turns, turns))
        self.inertias = np.array(
            [np.reshape(none if x.inertia is None else x.inertia, none.shape) for x in self.bodies]
        )

    def start(self) -> State:
        """Return the places as they are described, and no rates."""
        starts = [body.start for body in self.bodies]
        if self.dimension == 2:
            turn = np.array([0.0 if x.turn is None else float(x.turn) for x in starts])
        else:
            turn = np.array([np.eye(3) if x.rotation is None else x.rotation for x in starts])
        return State(np.array([np.asarray(x.position, dtype=float) for x in starts]), turn, np.zeros(self.size))

    def spread(self, rates: Floats) -> tuple[Floats, Floats]:
        """Return velocities (..., b, d) and spins (..., b) or (..., b, 3) of rates (..., n)."""
        full = np.zeros((*rates.shape[:-1], *self.alive.shape))
        full[..., self.alive] = rates
        spins = full[..., self.dimension :]
        return full[..., : self.dimension], spins[..., 0] if self.dimension == 2 else spins

    def motion(self, rates: Floats) -> dict[str, Twist]:
        """Return rates by body."""
        velocity, spin = (np.moveaxis(x, rates.ndim - 1, 0) for x in self.spread(rates))
        return {
            name: Twist(velocity[i], spin[i] if rigid else None)
            for i, (name, rigid) in enumerate(zip(self.names, self.rigid, strict=True))
        }

    def placement(self, state: State, rates: Floats | None = None, by: Floats | None = None) -> Placement:
        """Return the placement, or many: moved along rates by finite times, and by an imaginary step beside.

        Parameters
        ----------
        rates : ndarray, shape (k, n)
        by : ndarray, shape (k,)
            Times by which the places move along the rates (s).
        """
        position, turn = state.position[None], state.turn[None]
        if rates is not None and by is not None:
            velocity, spin = self.spread(rates)
            position = position + (by + 1j * STEP)[:, None, None] * velocity
            if self.dimension == 2:
                turn = turn + (by + 1j * STEP)[:, None] * spin
            else:
                turn = rotations_by(by[:, None, None] * spin) @ turn
                turn = turn + 1j * STEP * (skew(spin) @ turn)
        rotation = turn
        if self.dimension == 2:
            c, s = np.cos(turn), np.sin(turn)
            rotation = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
        if rates is None:
            position, rotation, turn = position[0], rotation[0], turn[0]
        flat = self.dimension == 2
        return {
            name: Pose(
                position[..., i, :],
                rotation[..., i, :, :] if self.rigid[i] else None,
                turn[..., i] if flat and self.rigid[i] else None,
            )
            for i, name in enumerate(self.names)
        }

    def advanced(self, state: State, change: Floats) -> State:
        """Return the state with its places moved by small changes, of shape (n,)."""
        move, angle = self.spread(change)
        turn = state.turn + angle if self.dimension == 2 else rotations_by(angle) @ state.turn
        return State(state.position + move, turn, state.rates)

    def _tensors(self, state: State) -> Floats:
        if self.dimension == 2:
            return self.inertias
        found: Floats = state.turn @ self.inertias @ np.swapaxes(state.turn, -1, -2)
        return found

    def inertia(self, state: State) -> Floats:
        """Return the mass matrix, shape (n, n)."""
        b, d = len(self.bodies), self.dimension
        full = np.zeros((b, self.width, b, self.width))
        each = np.arange(b)
        full[each, :d, each, :d] = self.masses[:, None, None] * np.eye(d)
        full[each, d:, each, d:] = self._tensors(state)
        alive = self.alive.ravel()
        return full.reshape(b * self.width, -1)[np.ix_(alive, alive)]

    def weights(self, state: State, gravity: Floats) -> Floats:
        """Return the forces of gravity, and in space the moments -w x J w of turning bodies, shape (n,)."""
        full = np.zeros(self.alive.shape)
        full[:, : self.dimension] = self.masses[:, None] * gravity
        if self.dimension == 3:
            _, spin = self.spread(state.rates)
            full[:, 3:] = -np.cross(spin, (self._tensors(state) @ spin[..., None])[..., 0])
        return full[self.alive]

    def pack(self, state: State) -> Floats:
        """Return a state as one vector."""
        return np.concatenate([state.position.ravel(), state.turn.ravel(), state.rates])

    def unpack(self, vector: Floats) -> State:
        """Return the state that a vector holds, with the rotations that are nearest to its matrices."""
        b, d = len(self.bodies), self.dimension
        position, turn = vector[: b * d].reshape(b, d), vector[b * d : len(vector) - self.size]
        if d == 3:
            u, _, vt = np.linalg.svd(turn.reshape(b, 3, 3))
            turn = u @ vt
        return State(position, turn, vector[len(vector) - self.size :])

    def flow(self, state: State, accelerations: Floats) -> Floats:
        """Return the rate of a packed state."""
        velocity, spin = self.spread(state.rates)
        return self.pack(State(velocity, spin if self.dimension == 2 else skew(spin) @ state.turn, accelerations))


def skew(v: Floats) -> Floats:
    """Return the matrices of vector products, shape (..., 3, 3)."""
    found = np.zeros((*v.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., i, j], found[..., j, i] = -v[..., k], v[..., k]
    return found


def rotations_by(vector: Floats) -> Floats:
    """Return the rotations by vectors of angles."""
    found: Floats = Rotation.from_rotvec(vector.reshape(-1, 3)).as_matrix().reshape(*vector.shape, 3)
    return found

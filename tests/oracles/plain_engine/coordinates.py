"""Maximal coordinates: position and angle of every body of the plane, position and rotation in space.

Rates are velocities of centres of mass and angular velocities, in space in the axes of space. Particles do not turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from core.multibody.audit.bodies import Reader
from core.multibody.audit.placement import STEP, Placement, Pose, Twist, cross, turned

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Places and rates of all bodies, and when they are there (s); places may have leading axes.

    Attributes
    ----------
    position : ndarray, shape (b, d)
    turn : ndarray, shape (b,) in the plane (rad), (b, 3, 3) in space: columns are the body axes.
    rates : ndarray, shape (n,)
    """

    position: Floats
    turn: Floats
    rates: Floats
    time: Any = 0.0


class Coordinates:
    """The coordinates of the bodies of a scene.

    Attributes
    ----------
    alive : ndarray of bool, shape (b, 3) in the plane, (b, 6) in space
        Which rates the bodies have.
    size : int
        Number n of rates.
    """

    def __init__(self, reader: Reader) -> None:
        self.names, self.bodies = list(reader.bodies), list(reader.bodies.values())
        self.dimension = d = reader.dimension
        self.flat = d == 2
        self.rigid = [body.inertia is not None for body in self.bodies]
        self.alive = np.ones((len(self.bodies), 3 if self.flat else 6), dtype=bool)
        self.alive[np.logical_not(self.rigid), d:] = False
        self.size = int(self.alive.sum())
        self.masses = np.array([body.mass for body in self.bodies])
        none = np.zeros((1, 1) if self.flat else (3, 3))
        self.inertias = np.array(
            [none if x.inertia is None else np.reshape(x.inertia, none.shape) for x in self.bodies]
        )

    def start(self) -> State:
        """Return the places as they are described, and no rates."""
        starts = [body.start for body in self.bodies]
        if self.flat:
            turn = np.array([0.0 if x.turn is None else float(x.turn) for x in starts])
        else:
            turn = np.array([np.eye(3) if x.rotation is None else x.rotation for x in starts])
        return State(np.array([np.asarray(x.position, dtype=float) for x in starts]), turn, np.zeros(self.size))

    def spread(self, rates: Floats) -> tuple[Floats, Floats]:
        """Return velocities (..., b, d) and spins (..., b) or (..., b, 3) of rates (..., n)."""
        full = np.zeros((*rates.shape[:-1], *self.alive.shape), dtype=rates.dtype)
        full[..., self.alive] = rates
        spins = full[..., self.dimension :]
        return full[..., : self.dimension], spins[..., 0] if self.flat else spins

    def motion(self, rates: Floats) -> dict[str, Twist]:
        """Return rates by body."""
        velocity, spin = self.spread(rates)
        return {
            name: Twist(velocity[..., i, :], None if not rigid else spin[..., i] if self.flat else spin[..., i, :])
            for i, (name, rigid) in enumerate(zip(self.names, self.rigid, strict=True))
        }

    def placement(self, state: State) -> Placement:
        """Return the places by body."""
        rotation = turned(state.turn) if self.flat else state.turn
        return {
            name: Pose(
                state.position[..., i, :],
                rotation[..., i, :, :] if rigid else None,
                state.turn[..., i] if rigid and self.flat else None,
                np.array(state.time),
            )
            for i, (name, rigid) in enumerate(zip(self.names, self.rigid, strict=True))
        }

    def moving(self, state: State, rates: Floats) -> Placement:
        """Return the places by body, moved by an imaginary step along rates, of shape (..., n)."""
        velocity, spin = self.spread(1j * STEP * rates)
        if self.flat:
            turn = state.turn + spin
        else:
            turn = state.turn + np.swapaxes(cross(spin[..., None, :], np.swapaxes(state.turn, -1, -2)), -1, -2)
        return self.placement(State(state.position + velocity, turn, rates, state.time + 1j * STEP))

    def advanced(self, state: State, change: Floats, later: Floats | float = 0.0) -> State:
        """Return the state with its places moved by changes, of shape (..., n), and so much later."""
        move, angle = self.spread(change)
        turn = state.turn + angle if self.flat else rotations_by(angle) @ state.turn
        return State(state.position + move, turn, state.rates, state.time + later)

    def inertia(self, state: State) -> Floats:
        """Return the mass matrix, shape (n, n)."""
        b, d, width = len(self.bodies), self.dimension, self.alive.shape[1]
        full, each = np.zeros((b, width, b, width)), np.arange(b)
        full[each, :d, each, :d] = self.masses[:, None, None] * np.eye(d)
        full[each, d:, each, d:] = self._tensors(state)
        alive = self.alive.ravel()
        return full.reshape(b * width, -1)[np.ix_(alive, alive)]

    def weights(self, state: State, gravity: Floats) -> Floats:
        """Return the forces of gravity, and in space the moments -w x J w of turning bodies, shape (n,)."""
        full = np.zeros(self.alive.shape)
        full[:, : self.dimension] = self.masses[:, None] * gravity
        if not self.flat:
            _, spin = self.spread(state.rates)
            full[:, 3:] = -cross(spin, (self._tensors(state) @ spin[..., None])[..., 0])
        return full[self.alive]

    def _tensors(self, state: State) -> Floats:
        if self.flat:
            return self.inertias
        found: Floats = state.turn @ self.inertias @ np.swapaxes(state.turn, -1, -2)
        return found

    def pack(self, state: State) -> Floats:
        """Return a state as one vector."""
        return np.concatenate([state.position.ravel(), state.turn.ravel(), state.rates, [state.time]])

    def unpack(self, vector: Floats) -> State:
        """Return the state that a vector holds, with the rotations that are nearest to its matrices."""
        b, d = len(self.bodies), self.dimension
        position, turn, rates = np.split(vector[:-1], [b * d, len(vector) - 1 - self.size])
        if not self.flat:
            u, _, vt = np.linalg.svd(turn.reshape(b, 3, 3))
            turn = u @ vt
        return State(position.reshape(b, d), turn, rates, float(vector[-1]))

    def flow(self, state: State, accelerations: Floats) -> Floats:
        """Return the rate of a packed state."""
        velocity, spin = self.spread(state.rates)
        axes = np.swapaxes(state.turn, -1, -2) if not self.flat else state.turn
        turn = spin if self.flat else np.swapaxes(cross(spin[:, None, :], axes), -1, -2)
        return self.pack(State(velocity, turn, accelerations, 1.0))


def rotations_by(vector: Floats) -> Floats:
    """Return the rotations by vectors of angles."""
    found: Floats = Rotation.from_rotvec(vector.reshape(-1, 3)).as_matrix().reshape(*vector.shape, 3)
    return found

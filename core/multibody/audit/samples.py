"""Samples of an answer as placements, motions and forces, each with the error that the answer states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.definitions import Description
from core.multibody.audit.placement import Motion, Numbers, Placement, Pose, Twist, cross, turned
from core.systems.trajectory import Column

Columns = Mapping[str, Column]


POSITION, ATTITUDE, VELOCITY, SPIN = range(4)
"""Numbers of the stated errors of a body, of vectors of their length (m, rad, m/s, rad/s)."""

EPSILON = 2.0**-52
"""Distance of neighbouring doubles, relative to them: a place is rounded by half of it, the difference of two by it."""

_DIAGONAL = 3.0**0.5
"""A vector is at most so many times as long as its largest component."""


@dataclass(frozen=True)
class Samples:
    """Some rows of an answer, or of several.

    Attributes
    ----------
    times : ndarray, shape (n,)
    placement, motion : mapping
        With the samples as leading axis. Bodies of which the attitude is not answered have no rotation, and those of
        which the spin is not answered no spin.
    forces : mapping of str to ndarray, shape (n,)
        NaN where a force is not answered at a sample.
    errors : mapping of str to ndarray, shape (n, 4)
        Stated errors of each body.
    force_errors : mapping of str to ndarray, shape (n,)
    placed : set of str
        Bodies of which the attitude is answered, of tops that of the axis.
    """

    times: Numbers
    placement: Placement
    motion: Motion
    forces: Mapping[str, Numbers]
    errors: Mapping[str, Numbers]
    force_errors: Mapping[str, Numbers]
    placed: frozenset[str] = frozenset()

    @property
    def leading(self) -> int:
        """How many axes the samples have: 1, or 2 where they are perturbed."""
        return max(pose.position.ndim for pose in self.placement.values()) - 1

    def at(self, rows: Numbers | slice) -> Samples:
        """Return some of the samples, by a mask, their numbers or a slice."""
        placement = {name: pose.at(rows) for name, pose in self.placement.items()}
        motion = {name: twist.at(rows) for name, twist in self.motion.items()}
        forces = {name: values[rows] for name, values in self.forces.items()}
        errors = {name: values[rows] for name, values in self.errors.items()}
        force_errors = {name: values[rows] for name, values in self.force_errors.items()}
        return Samples(self.times[rows], placement, motion, forces, errors, force_errors, self.placed)

    def with_first_forces(self, given: Mapping[str, Numbers], known: Mapping[str, float]) -> Samples:
        """Return the samples with the forces of the first replaced by given ones of one sample, and their errors."""
        forces, errors = dict(self.forces), dict(self.force_errors)
        for name, first in given.items():
            then = self.forces.get(name, np.full(len(self.times), np.nan))
            forces[name] = np.concatenate([first, then[1:]])
            off = self.force_errors.get(name, np.zeros(len(self.times)))
            errors[name] = np.concatenate([[known[name]], off[1:]])
        return replace(self, forces=forces, force_errors=errors)

    def flattened(self) -> Samples:
        """Return samples of which everything is perturbed with their two axes in one."""

        def flat(x: Numbers | None) -> Numbers | None:
            return None if x is None else x.reshape(-1, *x.shape[2:])

        placement = {name: Pose(*map(flat, pose)) for name, pose in self.placement.items()}  # type: ignore[arg-type]
        motion = {name: Twist(*map(flat, twist)) for name, twist in self.motion.items()}  # type: ignore[arg-type]
        forces = {name: values.reshape(-1) for name, values in self.forces.items()}
        return Samples(self.times, placement, motion, forces, self.errors, self.force_errors)

    def of(self, bodies: Iterable[str]) -> Motion:
        """Return the motion of some bodies."""
        return {name: self.motion[name] for name in bodies}

    def spun(self, name: str) -> bool:
        """Return whether all that turns of a body is known."""
        return self.motion[name].spin is not None

    def given_first(self, extent: float) -> Samples:
        """Return the samples with the first as the description gives it: wrong by the rounding to doubles alone.

        Parameters
        ----------
        extent : float
            Largest coordinate of anything (m): directions are known as well as the differences of coordinates are.
        """
        errors = {}
        for name, stated in self.errors.items():
            errors[name] = stated.copy()
            twist = self.motion[name]
            spin = 0.0 if twist.spin is None else float(np.abs(twist.spin[0]).max())
            sizes = {POSITION: extent, ATTITUDE: 1.0, VELOCITY: float(np.abs(twist.velocity[0]).max()), SPIN: spin}
            for number, size in sizes.items():
                errors[name][0, number] = EPSILON * size
        return replace(self, errors=errors)

    def perturbed(self, bodies: Iterable[str], forces: Iterable[str] = ()) -> Samples:
        """Return the samples with one input after another changed by its stated error.

        Arrays get a first axis, of which entry 0 is without any change.
        """
        bodies, forces = tuple(bodies), tuple(forces)
        changes = [change for name in bodies for change in self._changes(name)] + [
            (name, "force", 0) for name in forces
        ]
        count = len(changes) + 1
        placement, motion = dict(self.placement), dict(self.motion)
        for name in bodies:
            placement[name], motion[name] = self._changed(name, changes, count)
        moved = dict(self.forces)
        for name in forces:
            values = np.repeat(self.forces[name][None], count, axis=0)
            values[1 + changes.index((name, "force", 0))] += self.force_errors[name]
            moved[name] = values
        return Samples(self.times, placement, motion, moved, self.errors, self.force_errors)

    def _changes(self, name: str) -> list[tuple[str, str, int]]:
        pose, twist = self.placement[name], self.motion[name]
        d = pose.position.shape[-1]
        found = [(name, what, i) for what in ("position", "velocity") for i in range(d)]
        spins = 1 if d == 2 else 3
        if pose.rotation is not None:
            found.extend((name, "attitude", i) for i in range(spins))
        if twist.spin is not None:
            found.extend((name, "spin", i) for i in range(spins))
        return found

    def _changed(self, name: str, changes: Sequence[tuple[str, str, int]], count: int) -> tuple[Pose, Twist]:
        pose, twist, error = self.placement[name], self.motion[name], self.errors[name]
        position, velocity, rotation, turn, time, spin = (
            None if x is None else np.repeat(x[None], count, axis=0)
            for x in (pose.position, twist.velocity, pose.rotation, pose.turn, pose.time, twist.spin)
        )
        assert position is not None, "every body has a position"
        assert velocity is not None, "every body has a velocity"
        plane = position.shape[-1] == 2
        for p, (body, what, i) in enumerate(changes, start=1):
            if body != name:
                continue
            if what == "position":
                position[p, ..., i] += error[:, POSITION]
            elif what == "velocity":
                velocity[p, ..., i] += error[:, VELOCITY]
            elif what == "spin" and spin is not None:
                spin[(p, ..., i) if not plane else p] += error[:, SPIN]
            elif what == "attitude" and rotation is not None:
                if turn is not None:
                    turn[p] += error[:, ATTITUDE]
                rotation[p] += error[:, ATTITUDE, None, None] * _tilted(rotation[p], i)
        return Pose(position, rotation, turn, time), Twist(velocity, spin)


def _tilted(rotation: Numbers, i: int) -> Numbers:
    """Return the rate of a rotation that turns about axis i of space, in the plane about its normal."""
    if rotation.shape[-1] == 2:
        return np.stack([-rotation[..., 1, :], rotation[..., 0, :]], axis=-2)
    axis = np.eye(3)[i]
    return np.swapaxes(cross(np.broadcast_to(axis, rotation.shape), np.swapaxes(rotation, -1, -2)), -1, -2)


def joined(parts: Sequence[tuple[Placement, Motion]]) -> tuple[Placement, Motion]:
    """Return placements and motions of the same bodies one after another; what one of them lacks is left out."""

    def every(values: tuple[Numbers | None, ...]) -> Numbers | None:
        given = [value for value in values if value is not None]
        return np.concatenate(given) if len(given) == len(values) else None

    placement, motion = {}, {}
    for name in parts[0][0]:
        poses, twists = [where[name] for where, _ in parts], [how[name] for _, how in parts]
        placement[name] = Pose(*map(every, zip(*poses, strict=True)))  # type: ignore[arg-type]
        motion[name] = Twist(*map(every, zip(*twists, strict=True)))  # type: ignore[arg-type]
    return placement, motion


@dataclass(frozen=True)
class Part:
    """Some rows of columns, with their times, shape (n,)."""

    times: Numbers
    columns: Columns
    rows: Numbers | slice

    def values(self, name: str) -> Numbers:
        """Return the values of a column at the rows."""
        return self.columns[name].values[self.rows]


def samples_of(description: Description, parts: Sequence[Part]) -> Samples:
    """Return samples of the columns of an answer, or of several with the same bodies, one after another.

    Raises
    ------
    KeyError
        Where the columns are not those of a trajectory.
    """
    joined = _Joined(parts)
    placement, motion, errors = {}, {}, {}
    for name, body in description.bodies.items():
        pose, motion[name], stated = _body(body, description, joined)
        placement[name] = pose._replace(time=joined.times)
        errors[name] = np.repeat(np.array(stated).T, joined.counts, axis=0)
    forces: dict[str, Numbers] = {}
    force_errors: dict[str, Numbers] = {}
    for key in dict.fromkeys(key for part in parts for key in part.columns):
        column = next(part.columns[key] for part in parts if key in part.columns)
        if column.unit in ("N", "N m") and column.values.ndim == 1:
            forces[key], force_errors[key] = joined.force(key)
    columns = parts[0].columns
    placed = frozenset(name for name in placement if f"{name}.attitude" in columns or f"{name}.axis" in columns)
    return Samples(joined.times, placement, motion, forces, errors, force_errors, placed)


class _Joined:
    """The columns of several parts, one after another."""

    def __init__(self, parts: Sequence[Part]) -> None:
        self.parts, own = parts, [part.times for part in parts]
        self.counts = [len(times) for times in own]
        self.times: Numbers = own[0] if len(own) == 1 else np.concatenate(own)

    def __contains__(self, name: str) -> bool:
        return name in self.parts[0].columns

    def column(self, name: str) -> tuple[Numbers, Numbers]:
        """Return the values of a column, and its error in each of the parts."""
        own = [part.values(name) for part in self.parts]
        errors = np.array([part.columns[name].error for part in self.parts])
        return own[0] if len(own) == 1 else np.concatenate(own), errors

    def force(self, name: str) -> tuple[Numbers, Numbers]:
        """Return the values of a force and its errors, NaN in the parts that do not have it."""
        values, errors = [], []
        for part, count in zip(self.parts, self.counts, strict=True):
            column = part.columns.get(name)
            values.append(np.full(count, np.nan) if column is None else column.values[part.rows])
            errors.append(np.nan if column is None else column.error)
        return np.concatenate(values), np.repeat(errors, self.counts)


def _body(body: RigidBody, description: Description, of: _Joined) -> tuple[Pose, Twist, list[Numbers]]:
    """Return the samples of a body, and its stated errors in each part: of place, attitude, velocity and spin."""
    name, none = body.name, np.zeros(len(of.parts))
    (position, away), (velocity, speed) = of.column(f"{name}.position"), of.column(f"{name}.velocity")
    if body.inertia is None:
        return Pose(position), Twist(velocity), [away, none, speed, none]
    if description.dimension == 2:
        (turn, tilt), (rate, off) = of.column(f"{name}.angle"), of.column(f"{name}.angular_velocity")
        return Pose(position, turned(turn), turn), Twist(velocity, rate), [away, tilt, speed, off]
    if f"{name}.attitude" in of:
        (attitude, tilt), (rate, off) = of.column(f"{name}.attitude"), of.column(f"{name}.angular_velocity")
        rotation = rotation_of(attitude)
        spin = (rotation @ rate[:, :, None])[:, :, 0]
        # A quaternion that is wrong by e turns by 2e; the spin, which is given in body axes, turns with it.
        off = off + 2.0 * tilt * float(np.abs(spin).max(initial=0.0)) * _DIAGONAL
        return Pose(position, rotation), Twist(velocity, spin), [away, 2.0 * tilt, speed, off]
    if f"{name}.axis" in of:
        axis, tilt = of.column(f"{name}.axis")
        rotation = _around(axis, axis_of_top(body, description))
        return Pose(position, rotation), Twist(velocity), [away, tilt, speed, none]
    rate, off = of.column(f"{name}.angular_velocity_in_space")
    # A ball with equal moments: its attitude is not answered, and its tensor is the same in all.
    still = np.broadcast_to(np.eye(3), (len(position), 3, 3))
    return Pose(position, still), Twist(velocity, rate), [away, none, speed, off]


def rotation_of(quaternion: Numbers) -> Numbers:
    """Return the rotation of a unit quaternion (w, x, y, z), shape (n, 3, 3)."""
    w, x, y, z = quaternion.T
    found = np.empty((len(quaternion), 3, 3))
    for i, (a, b, c) in enumerate(((x, y, z), (y, z, x), (z, x, y))):
        j = (i + 1) % 3
        found[:, i, i] = 1.0 - 2.0 * (b * b + c * c)
        found[:, i, j], found[:, j, i] = 2.0 * (a * b - w * c), 2.0 * (a * b + w * c)
    return found


def axis_of_top(body: RigidBody, description: Description) -> int:
    """Return the body axis about which a body is symmetric, and on which its places are that connections use."""
    assert body.inertia is not None, "a top has moments"
    moments = np.diag(body.inertia)
    places = [*description.elsewhere, *(place for one in description.connections for place in one.places)]
    used = {place.offset for place in places if place.body == body.name}
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        if moments[i] == moments[j] and all(offset[i] == 0.0 == offset[j] for offset in used):
            return k
    raise AssertionError("the axis of a body is answered where it has one")


def _around(axis: Numbers, k: int) -> Numbers:
    """Return rotations whose axis k has a direction, shape (n, 3, 3); the others are any that complete it."""
    size = np.linalg.norm(axis, axis=1, keepdims=True)
    n = axis / size
    away = np.eye(3)[np.argmin(np.abs(n), axis=1)]
    first = cross(n, away)
    first = first / np.linalg.norm(first, axis=1, keepdims=True)
    columns = [n, first, cross(n, first)]
    return np.stack([columns[(i - k) % 3] for i in range(3)], axis=-1)

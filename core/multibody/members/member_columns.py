"""The columns of many members at once, with their errors: those of `trajectory.columns` for each of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.multibody.motion.whole import spread
from core.multibody.search.bands import FLOOR
from core.multibody.table.frames import Frame
from core.multibody.trajectory.column_errors import FINEST, ROUNDED
from core.multibody.trajectory.columns import MARGIN


@dataclass(frozen=True)
class MemberStates:
    """States of members at the same times, as `motion.motion.States` has them.

    Attributes
    ----------
    q, v : ndarray, shape (members, t, n)
    q_error, v_error : ndarray, shape (members, t, n)
    turns : ndarray of int, shape (members, t, d)
        Whole turns of the directions since the start, beside the principal angle from there.
    """

    q: Floats
    v: Floats
    q_error: Floats
    v_error: Floats
    turns: Integers

    def during(self, times: slice) -> MemberStates:
        """Return the states at some of the times."""
        return self._with(lambda x: x[:, times])

    def of(self, members: Integers) -> MemberStates:
        """Return the states of some members, by a mask."""
        return self._with(lambda x: x[members])

    def _with(self, change: Callable[[Any], Any]) -> MemberStates:
        return MemberStates(*map(change, (self.q, self.v, self.q_error, self.v_error, self.turns)))


@dataclass(frozen=True)
class MemberColumn:
    """One quantity of all members.

    Attributes
    ----------
    values : ndarray, shape (members, t) or (members, t, k)
    unit : str
    error, largest : ndarray, shape (members,)
        Error of any sample, and the largest magnitude.
    scale : ndarray, shape (members,)
        What the error is relative to, zero where that is not known beside the samples.
    """

    values: Floats
    unit: str
    error: Floats
    largest: Floats
    scale: Floats

    def of(self, members: Integers) -> MemberColumn:
        """Return the quantity of some members, by a mask or their rows."""
        own = (self.error[members], self.largest[members], self.scale[members])
        return MemberColumn(self.values[members], self.unit, *own)


@kernel()
def spread_members(slopes: Floats, offsets: Floats, z: Floats) -> Floats:
    """Return the coordinates as described of members, by `motion.whole.spread`; z of shape (members, t, n, 2)."""
    out = np.empty((z.shape[0], z.shape[1], slopes.shape[1], 2))
    for k in range(z.shape[0]):
        out[k] = spread(slopes[k], offsets[k], z[k])
    return out


def member_columns(frames: Mapping[str, Frame], states: MemberStates, starts: Floats) -> dict[str, MemberColumn]:
    """Return what every body does.

    Parameters
    ----------
    starts : ndarray, shape (members, d, 3)
        Of the directions that are followed: their components at the start, and the angle that was given.
    """
    found: dict[str, MemberColumn] = {}
    number = 0
    for name, frame in frames.items():
        found[f"{name}.position"] = _vector(states.q, states.q_error, frame.position, "m")
        found[f"{name}.velocity"] = _vector(states.v, states.v_error, frame.position, "m/s")
        if frame.turn is not None:
            found[f"{name}.angle"] = _scalar(states.q, states.q_error, frame.turn, "rad")
            found[f"{name}.angular_velocity"] = _scalar(states.v, states.v_error, frame.turn, "rad/s")
        elif frame.direction is not None:
            found[f"{name}.angle"] = _angle(states, frame.direction, starts[:, number], states.turns[..., number])
            found[f"{name}.angular_velocity"] = _turning(states, frame.direction)
            number += 1
        elif frame.axis is not None:
            found[f"{name}.axis"] = _vector(states.q, states.q_error, frame.axis[1], "1")
        elif frame.turns is not None:
            where = list(frame.turns)
            found[f"{name}.angular_velocity_in_space"] = _vector(states.v, states.v_error, where, "rad/s")
    return found


def _vector(values: Floats, errors: Floats, where: list[int], unit: str) -> MemberColumn:
    return _column(values[..., where], unit, _lengths(errors[..., where]))


def _scalar(values: Floats, errors: Floats, index: int, unit: str) -> MemberColumn:
    return _column(values[..., index], unit, errors[..., index])


def _angle(states: MemberStates, direction: tuple[int, int], start: Floats, turns: Integers) -> MemberColumn:
    i, j = direction
    principal = principal_angle(states.q[..., i], states.q[..., j], start[:, None, 0], start[:, None, 1])
    values = start[:, None, 2] + (principal + 2 * math.pi * turns)
    return _column(values, "rad", states.q_error[..., i] + states.q_error[..., j])


def principal_angle(c: Floats, s: Floats, start_c: Floats, start_s: Floats) -> Floats:
    """Return the angle from a direction at the start, between minus and plus half a turn."""
    found: Floats = np.arctan2(start_c * s - start_s * c, start_c * c + start_s * s)
    return found


def _turning(states: MemberStates, direction: tuple[int, int]) -> MemberColumn:
    i, j = direction
    q, v, dq, dv = states.q, states.v, states.q_error, states.v_error
    values = q[..., i] * v[..., j] - q[..., j] * v[..., i]
    errors = dv[..., i] + dv[..., j] + np.abs(v[..., j]) * dq[..., i] + np.abs(v[..., i]) * dq[..., j]
    return _column(values, "rad/s", errors)


def _column(values: Floats, unit: str, errors: Floats) -> MemberColumn:
    size = np.abs(values) if values.ndim == 2 else _lengths(values)
    error = MARGIN * errors.max(axis=1, initial=0.0) + FINEST * size.max(axis=1, initial=0.0)
    return MemberColumn(values, unit, error, _largest(values), np.zeros(len(values)))


def _lengths(rows: Floats) -> Floats:
    found: Floats = np.sqrt(np.add.reduce(rows * rows, axis=-1))
    return found


def _largest(values: Floats) -> Floats:
    """Return the largest magnitude of each member, as `Column.largest` does."""
    greatest: Floats = np.abs(values).reshape(len(values), -1).max(axis=1, initial=0.0)
    if values.ndim == 2:
        return greatest
    _, exponent = np.frexp(greatest)
    size = _lengths(np.ldexp(values, -exponent[:, None, None])).max(axis=1, initial=0.0)
    found: Floats = size * np.ldexp(1.0, exponent - 1) * 2.0
    return found


def with_natural_sizes(
    columns: Mapping[str, MemberColumn], others: Mapping[str, MemberColumn]
) -> dict[str, MemberColumn]:
    """Return columns with how large they are at other times, where they are small: see `trajectory.column_errors`."""
    largest, unknown = _sizes(columns)
    found = {}
    for name, column in columns.items():
        other = others[name]
        small = unknown[column.unit] > ROUNDED * largest[column.unit]
        known = small & (other.largest > other.error)
        found[name] = replace(column, scale=np.where(known, np.maximum(column.scale, other.largest), column.scale))
    return found


def scales_of(columns: Mapping[str, MemberColumn]) -> dict[str, Floats]:
    """Return what the errors are relative to, by unit: see `trajectory.column_errors.scales_of`."""
    largest, unknown = _sizes(columns)
    for column in columns.values():
        largest[column.unit] = np.maximum(largest[column.unit], column.scale)
    none = np.zeros_like(next(iter(largest.values())))
    away, speed = largest.get("m", none), largest.get("m/s", none)
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = np.where(away > 0.0, speed / away, 0.0)
    for unit, scale in (("rad", 1.0 + none), ("rad/s", rate)):
        if unit in largest:
            lost = largest[unit] <= np.maximum(unknown[unit], FLOOR * scale)
            largest[unit] = np.where(lost, np.maximum(largest[unit], scale), largest[unit])
    return largest


def worst(columns: Mapping[str, MemberColumn], scales: Mapping[str, Floats]) -> Floats:
    """Return the largest error of each member, relative to the scales."""
    found = np.zeros_like(next(iter(scales.values())))
    with np.errstate(divide="ignore", invalid="ignore"):
        for column in columns.values():
            scale = scales[column.unit]
            found = np.maximum(found, np.where(scale > 0.0, column.error / scale, 0.0))
    return found


def _sizes(columns: Mapping[str, MemberColumn]) -> tuple[dict[str, Floats], dict[str, Floats]]:
    largest: dict[str, Floats] = {}
    unknown: dict[str, Floats] = {}
    for column in columns.values():
        unit = column.unit
        largest[unit] = np.maximum(largest.get(unit, 0.0), column.largest)
        unknown[unit] = np.maximum(unknown.get(unit, 0.0), column.error)
    return largest, unknown

"""Many members of one scene, followed together: their motion in lanes, its columns and their errors.

A member that a plan does not hold, that ends, or whose error is larger than requested is left to be answered by itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, Integers
from core.multibody.equations.packed import two_to
from core.multibody.members.lane_doubles import follow_in_doubles
from core.multibody.members.lane_pairs import follow_in_pairs
from core.multibody.members.member_columns import (
    MemberColumn,
    MemberStates,
    member_columns,
    principal_angle,
    scales_of,
    spread_members,
    with_natural_sizes,
    worst,
)
from core.multibody.members.member_audit import MemberWindows, windows_of
from core.multibody.members.plan import Plan, Plans, Setup
from core.multibody.motion.numerical import (
    DOUBLES_SHARE,
    ORDER,
    REFERENCE_ORDER,
    REFERENCE_TOLERANCE,
    TOLERANCE,
)
from core.multibody.search.bands import FLOOR
from core.multibody.trajectory.column_errors import PLACES_BETWEEN

SMALLEST = 1e-250
"""Numbers below which scaling by powers of two might lose digits."""

NOTHING_LEFT = 1e-9
"""Angle (rad) from half a turn within which the turns of a direction are counted by itself."""


@dataclass(frozen=True)
class Followed:
    """Members that were followed, of one form.

    Attributes
    ----------
    members : ndarray of int
        Their numbers.
    columns : dict of str to MemberColumn
        At the times of the question.
    scales : mapping of str to ndarray
        What errors are relative to, by unit.
    error : ndarray, shape (members,)
        The largest error relative to these.
    checked : dict of str to MemberColumn
        At the times of the audit.
    windows : MemberWindows
        These times.
    written : ndarray, shape (members, k)
        The places of bodies as they are written, each with its angle where it has one.
    states_alone : ndarray of bool, shape (members,)
        Whether places, attitudes and velocities alone differ from those of other such members.
    """

    members: Integers
    columns: dict[str, MemberColumn]
    scales: Mapping[str, Floats]
    error: Floats
    checked: dict[str, MemberColumn]
    windows: MemberWindows
    written: Floats
    states_alone: Integers


@dataclass
class _Group:
    """Members whose tables have one form."""

    plan: Plan
    setups: list[Setup]
    members: list[int]
    outputs: list[tuple[float, ...]]


def followed(plans: Plans, numbers: Floats, times: Floats, accuracy: float) -> list[Followed]:
    """Follow members and return those whose errors are as small as requested.

    Parameters
    ----------
    numbers : ndarray, shape (members, k)
        What each has at the places of the plans.
    times : ndarray, shape (t,)
        Not negative, not all zero (s).
    """
    groups: dict[tuple[object, ...], _Group] = {}
    for k, row in enumerate(numbers.tolist()):
        found = plans.of(row)
        if found is None or any(0.0 < abs(x) < SMALLEST for x in found[2][::2]):
            continue
        plan, setup, outputs = found
        key = (id(plan), *(x if isinstance(x, int) else x.tobytes() for x in setup.form))
        group = groups.setdefault(key, _Group(plan, [], [], []))
        group.setups.append(setup)
        group.members.append(k)
        group.outputs.append(outputs)
    with np.errstate(over="ignore", invalid="ignore"):
        return [_of_group(group, numbers[group.members], times, accuracy) for group in groups.values()]


def _of_group(group: _Group, numbers: Floats, times: Floats, accuracy: float) -> Followed:
    members, outputs = np.array(group.members), np.array(group.outputs)
    count, form = len(members), group.setups[0].form
    rows, slopes, offsets, starts, written = _filled(group, outputs)
    ups = np.array([setup.units.up for setup in group.setups])
    clock = np.array([two_to(setup.units.time) for setup in group.setups])
    last = float(times.max())
    windows = windows_of(numbers, clock, last)
    asked = np.concatenate([times, last * PLACES_BETWEEN])
    every = np.concatenate([np.tile(asked, (count, 1)), windows.times], axis=1)
    order = np.argsort(every, axis=1, kind="stable")
    scaled = np.take_along_axis(every, order, axis=1) * (1.0 / clock)[:, None]
    ends = last * (1.0 / clock)
    back = np.argsort(order, axis=1, kind="stable")
    directions = [one for one in group.plan.frames.values() if one.turn is None and one.direction is not None]
    seen = np.zeros((count, len(directions), 2, form.n + 1))
    for d, frame in enumerate(directions):
        assert frame.direction is not None
        own = np.concatenate([slopes[..., 0] * ups[:, None], offsets[..., :1]], axis=2)[:, list(frame.direction)]
        c, s = starts[:, d, 0, 0, None], starts[:, d, 1, 0, None]
        seen[:, d, 0], seen[:, d, 1] = c * own[:, 0] + s * own[:, 1], c * own[:, 1] - s * own[:, 0]
    shape = (count, every.shape[1], form.n)
    q, v = np.zeros(shape), np.zeros(shape)
    turns = np.zeros((*shape[:2], len(directions)), dtype=np.int64)
    first, second = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    follow_in_doubles(form, rows, ends, ORDER, TOLERANCE, scaled, seen, q, v, turns, first)
    other, rate = np.zeros((*shape, 2)), np.zeros((*shape, 2))
    follow_in_pairs(form, rows, ends, REFERENCE_ORDER, REFERENCE_TOLERANCE, scaled, other, rate, second)
    states = _states(slopes, offsets, ups, clock, (q, v), (other, rate), turns)
    states = MemberStates(*(np.take_along_axis(x, back[:, :, None], axis=1) for x in _parts(states)))
    values = starts[..., 0]
    parts = [slice(0, len(times)), slice(len(times), len(asked)), slice(len(asked), every.shape[1])]
    columns, between, checked = (member_columns(group.plan.frames, _at(states, part), values) for part in parts)
    columns = with_natural_sizes(columns, between)
    scales = scales_of(columns)
    error = worst(columns, scales)
    keep = (first == 1) & (second == 1) & (error <= accuracy) & _countable(states, directions, values)
    for column in (*columns.values(), *checked.values()):
        keep &= np.isfinite(column.values).reshape(count, -1).all(axis=1) & np.isfinite(column.error)
    return Followed(
        members[keep],
        {name: column.of(keep) for name, column in columns.items()},
        {unit: scale[keep] for unit, scale in scales.items()},
        error[keep],
        {name: column.of(keep) for name, column in checked.items()},
        windows.at(keep),
        written[keep, :, 0],
        np.array([setup.states_alone for setup in group.setups])[keep],
    )


def _filled(group: _Group, outputs: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Return the numbers of the tables of all members, their slopes and offsets, and the starts of directions."""
    names = ("numbers", "slopes", "offsets", "starts", "written")
    found = [np.empty((len(outputs), *getattr(group.setups[0], name).values.shape)) for name in names]
    for setup in {id(one): one for one in group.setups}.values():
        own = np.array([one is setup for one in group.setups])
        for array, name in zip(found, names, strict=True):
            array[own] = getattr(setup, name).filled(outputs[own])
    return found[0], found[1], found[2], found[3], found[4]


def _states(
    slopes: Floats,
    offsets: Floats,
    ups: Floats,
    clock: Floats,
    doubles: tuple[Floats, Floats],
    pairs: tuple[Floats, Floats],
    turns: Integers,
) -> MemberStates:
    """Return the states as described with their errors, as `motion.numerical`, `Whole.states` and phases form them."""
    up, slow = ups[:, None, :, None], (1.0 / clock)[:, None, None, None]
    none = np.zeros_like(offsets)
    tails = [np.stack([x, np.zeros_like(x)], axis=-1) for x in doubles]
    z, w = tails[0] * up, tails[1] * up * slow
    other, rate = pairs[0] * up, pairs[1] * up * slow
    size = np.abs(slopes[..., 0]).swapaxes(1, 2)
    q, v = spread_members(slopes, offsets, z)[..., 0], spread_members(slopes, none, w)[..., 0]
    errors = [_apart(a, b, ups) @ size for a, b in ((z, other), (w, rate))]
    return MemberStates(q, v, errors[0] + FLOOR * np.abs(q), errors[1] + FLOOR * np.abs(v), turns)


def _apart(first: Floats, second: Floats, ups: Floats) -> Floats:
    """Return how far doubles are from pairs: `Numerical._apart`."""
    up = ups[:, None]
    each = np.abs((first[..., 0] - second[..., 0]) + (first[..., 1] - second[..., 1]))
    found: Floats = each + DOUBLES_SHARE * np.max(each / up, axis=2, initial=0.0, keepdims=True) * up
    return found


def _parts(states: MemberStates) -> tuple[Floats, Floats, Floats, Floats, Integers]:
    return states.q, states.v, states.q_error, states.v_error, states.turns


def _at(states: MemberStates, part: slice) -> MemberStates:
    return MemberStates(*(x[:, part] for x in _parts(states)))


def _countable(states: MemberStates, directions: Sequence[object], starts: Floats) -> Integers:
    """Return of which members no direction is opposite to its start at any of the times."""
    found = np.ones(len(states.q), dtype=bool)
    for d, frame in enumerate(directions):
        i, j = frame.direction  # type: ignore[attr-defined]
        start = starts[:, d, None]
        principal = principal_angle(states.q[..., i], states.q[..., j], start[..., 0], start[..., 1])
        found &= (np.abs(principal) < np.pi - NOTHING_LEFT).all(axis=1)
    return found

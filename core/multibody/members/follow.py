"""Many members of one scene, followed together: their motion in lanes, its columns and their errors.

A member that a plan does not hold, that ends, or whose error is larger than requested is left to be answered by itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats, Integers
from core.multibody.equations.packed import two_to
from core.multibody.members.lane_doubles import follow_in_doubles
from core.multibody.members.lane_motion import Follow
from core.multibody.members.lane_pairs import follow_in_pairs
from core.multibody.members.lane_table import LaneForm
from core.multibody.members.member_audit import TIMES, MemberWindows, windows_of
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
from core.multibody.members.plan import Plan, Plans, Setup
from core.multibody.motion.numerical import DOUBLES_SHARE, FINE_MARGIN, FINE_SHARE, GROWTH
from core.multibody.motion.series_run import (
    CHECK_ORDER,
    CHECK_TOLERANCE,
    FINE_ORDER,
    FINE_TOLERANCE,
    ORDER,
    REFERENCE_ORDER,
    REFERENCE_TOLERANCE,
    TOLERANCE,
)
from core.multibody.search.bands import FLOOR
from core.multibody.table.frames import Frame
from core.multibody.trajectory.column_errors import FINEST, PLACES_BETWEEN

SMALLEST = 1e-250
"""Numbers below which scaling by powers of two might lose digits."""

TIMES_BESIDE = len(PLACES_BETWEEN) + TIMES
"""Times at which a member is followed beside those of its question: those of natural sizes and of the audit."""

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
    """

    members: Integers
    columns: dict[str, MemberColumn]
    scales: Mapping[str, Floats]
    error: Floats
    checked: dict[str, MemberColumn]
    windows: MemberWindows

    def of(self, members: Integers) -> Followed:
        """Return those of some members, by a mask."""
        return Followed(
            self.members[members],
            {name: column.of(members) for name, column in self.columns.items()},
            {unit: scale[members] for unit, scale in self.scales.items()},
            self.error[members],
            {name: column.of(members) for name, column in self.checked.items()},
            self.windows.at(members),
        )


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
        key = (plan.bodies, *(x if isinstance(x, int) else x.tobytes() for x in setup.form))
        group = groups.setdefault(key, _Group(plan, [], [], []))
        group.setups.append(setup)
        group.members.append(k)
        group.outputs.append(outputs)
    with np.errstate(over="ignore", invalid="ignore"):
        every = [_of_group(group, numbers[group.members], times, accuracy) for group in groups.values()]
    return [one for of_group in every for one in of_group if len(one.members)]


@dataclass(frozen=True)
class _Tables:
    """Tables of members of one form, with the times at which they are wanted.

    Attributes
    ----------
    members : ndarray of int
    rows, slopes, offsets, starts : ndarray
        By `plan.Setup`.
    ups : ndarray, shape (members, n)
        What coordinates of the arrays are multiplied by.
    clock : ndarray, shape (members,)
        Units of time (s), powers of two.
    windows : MemberWindows
    times : ndarray, shape (members, t)
        Those of the question, those that tell natural sizes, those of the windows (s).
    seen : ndarray
        As `lane_motion.following` tells.
    """

    members: Integers
    rows: Floats
    slopes: Floats
    offsets: Floats
    starts: Floats
    ups: Floats
    clock: Floats
    windows: MemberWindows
    times: Floats
    seen: Floats

    def at(self, members: Integers) -> _Tables:
        """Return those of some members."""
        return _Tables(
            self.members[members],
            self.rows[members],
            self.slopes[members],
            self.offsets[members],
            self.starts[members],
            self.ups[members],
            self.clock[members],
            self.windows.at(members),
            self.times[members],
            self.seen[members],
        )


@dataclass(frozen=True)
class _Reduced:
    """Coordinates and rates of the reduced table in SI units.

    Attributes
    ----------
    q, v : ndarray, shape (members, t, n, 2)
    q_error, v_error : ndarray, shape (members, t, n)
    known : ndarray of bool, shape (members,)
        Of which members both runs have reached the end.
    """

    q: Floats
    v: Floats
    q_error: Floats
    v_error: Floats
    known: Integers


Run = tuple[Floats, Floats, Integers]
"""Coordinates and rates in the units of tables, of shape (members, t, n, 2), and 1 for those who reached the end."""


def _of_group(group: _Group, numbers: Floats, times: Floats, accuracy: float) -> list[Followed]:
    """Follow members of one form in doubles, and in pairs those for which that is too rough."""
    form, frames = group.setups[0].form, group.plan.frames
    tables = _tables(group, numbers, times)
    doubles, turns = _run(follow_in_doubles, form, tables, ORDER, TOLERANCE)
    tables = replace(tables, seen=tables.seen[:, :0])
    reference, _ = _run(follow_in_pairs, form, tables, REFERENCE_ORDER, REFERENCE_TOLERANCE)
    reduced = _measured(tables, doubles, reference, DOUBLES_SHARE)
    coarse = _states(tables, reduced, turns)
    found, known = _columns(frames, tables, len(times), coarse, coarse, reduced.known)
    rough = known & ~(found.error <= accuracy)
    first = found.of(known & (found.error <= accuracy))
    if not rough.any() or accuracy < FINEST:
        return [first]
    rest = tables.at(rough)
    fine, _ = _run(follow_in_pairs, form, rest, FINE_ORDER, FINE_TOLERANCE)
    check, _ = _run(follow_in_pairs, form, rest, CHECK_ORDER, CHECK_TOLERANCE)
    pairs = _measured(rest, fine, check, FINE_SHARE)
    pairs = replace(
        pairs,
        q_error=FINE_MARGIN * pairs.q_error + GROWTH * reduced.q_error[rough],
        v_error=FINE_MARGIN * pairs.v_error + GROWTH * reduced.v_error[rough],
    )
    states = _states(rest, pairs, turns[rough])
    finer, known = _columns(frames, rest, len(times), states, coarse.of(rough), pairs.known)
    return [first, finer.of(known & (finer.error <= accuracy))]


def _tables(group: _Group, numbers: Floats, times: Floats) -> _Tables:
    """Return the tables of the members of a group."""
    count = len(group.members)
    rows, slopes, offsets, starts = _filled(group)
    ups = np.array([setup.units.up for setup in group.setups])
    clock = np.array([two_to(setup.units.time) for setup in group.setups])
    last = float(times.max())
    windows = windows_of(numbers, clock, last)
    asked = np.concatenate([times, last * PLACES_BETWEEN])
    every = np.concatenate([np.tile(asked, (count, 1)), windows.times], axis=1)
    directions = _directions(group.plan.frames)
    seen = np.zeros((count, len(directions), 2, slopes.shape[2] + 1))
    for d, direction in enumerate(directions):
        own = np.concatenate([slopes[..., 0] * ups[:, None], offsets[..., :1]], axis=2)[:, list(direction)]
        c, s = starts[:, d, 0, 0, None], starts[:, d, 1, 0, None]
        seen[:, d, 0], seen[:, d, 1] = c * own[:, 0] + s * own[:, 1], c * own[:, 1] - s * own[:, 0]
    members = np.array(group.members)
    return _Tables(members, rows, slopes, offsets, starts, ups, clock, windows, every, seen)


def _directions(frames: Mapping[str, Frame]) -> list[tuple[int, int]]:
    """Return the directions whose turns are counted."""
    return [one.direction for one in frames.values() if one.turn is None and one.direction is not None]


def _filled(group: _Group) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the numbers of the tables of all members, their slopes and offsets, and the starts of directions."""
    names = ("numbers", "slopes", "offsets", "starts")
    found = [np.empty((len(group.members), *getattr(group.setups[0], name).values.shape)) for name in names]
    for setup in {id(one): one for one in group.setups}.values():
        own = np.array([one is setup for one in group.setups])
        # Those of other plans have other outputs.
        outputs = np.array([group.outputs[k] for k in np.flatnonzero(own).tolist()])
        for array, name in zip(found, names, strict=True):
            array[own] = getattr(setup, name).filled(outputs)
    return found[0], found[1], found[2], found[3]


def _scaled(tables: _Tables) -> tuple[Floats, Floats, Integers]:
    """Return ascending times in the units of the tables, the last of each member, and where those asked for are."""
    order = np.argsort(tables.times, axis=1, kind="stable")
    scaled = np.take_along_axis(tables.times, order, axis=1) * (1.0 / tables.clock)[:, None]
    return scaled, np.ascontiguousarray(scaled[:, -1]), np.argsort(order, axis=1, kind="stable")


def _run(follow: Follow, form: LaneForm, tables: _Tables, order: int, tolerance: float) -> tuple[Run, Integers]:
    """Return a run at the times of the tables, and the turns of directions, shape (members, t, d)."""
    scaled, ends, back = _scaled(tables)
    shape = (*scaled.shape, form.n, 2)
    q, v, reached = np.zeros(shape), np.zeros(shape), np.zeros(len(scaled), dtype=np.int64)
    turns = np.zeros((*scaled.shape, tables.seen.shape[1]), dtype=np.int64)
    follow(form, tables.rows, ends, order, tolerance, scaled, tables.seen, q, v, turns, reached)
    q, v = (np.take_along_axis(x, back[:, :, None, None], axis=1) for x in (q, v))
    return (q, v, reached), np.take_along_axis(turns, back[:, :, None], axis=1)


def _measured(tables: _Tables, run: Run, other: Run, share: float) -> _Reduced:
    """Return the states of a run, and how far they are from another: `Numerical.by` and `Numerical.states`."""
    up, slow = tables.ups[:, None, :, None], (1.0 / tables.clock)[:, None, None, None]
    (q, v), (other_q, other_v) = ((q * up, v * up * slow) for q, v, _ in (run, other))
    q_error, v_error = (_apart(a, b, tables.ups[:, None], share) for a, b in ((q, other_q), (v, other_v)))
    return _Reduced(q, v, q_error, v_error, (run[2] & other[2]) == 1)


def _apart(first: Floats, second: Floats, up: Floats, share: float) -> Floats:
    """Return how far coordinates are from one another, with a share of the largest: `Numerical._apart`."""
    each = np.abs((first[..., 0] - second[..., 0]) + (first[..., 1] - second[..., 1]))
    found: Floats = each + share * np.max(each / up, axis=2, initial=0.0, keepdims=True) * up
    return found


def _states(tables: _Tables, reduced: _Reduced, turns: Integers) -> MemberStates:
    """Return the states as described: `Whole.states`, and what phases know of them."""
    slopes, offsets = tables.slopes, tables.offsets
    size = np.abs(slopes[..., 0]).swapaxes(1, 2)
    q = spread_members(slopes, offsets, reduced.q)[..., 0]
    v = spread_members(slopes, np.zeros_like(offsets), reduced.v)[..., 0]
    q_error, v_error = reduced.q_error @ size + FLOOR * np.abs(q), reduced.v_error @ size + FLOOR * np.abs(v)
    return MemberStates(q, v, q_error, v_error, turns)


def _columns(
    frames: Mapping[str, Frame],
    tables: _Tables,
    asked: int,
    states: MemberStates,
    coarse: MemberStates,
    reached: Integers,
) -> tuple[Followed, Integers]:
    """Return the columns of members, and of which of them they are known.

    Parameters
    ----------
    asked : int
        How many of the times are those of the question.
    coarse : MemberStates
        Those that tell natural sizes.
    """
    between = slice(asked, asked + len(PLACES_BETWEEN))
    values = tables.starts[..., 0]
    columns = member_columns(frames, states.during(slice(0, asked)), values)
    columns = with_natural_sizes(columns, member_columns(frames, coarse.during(between), values))
    checked = member_columns(frames, states.during(slice(between.stop, None)), values)
    scales = scales_of(columns)
    known = reached & _countable(states, _directions(frames), values)
    for column in (*columns.values(), *checked.values()):
        finite = np.isfinite(column.values).reshape(len(values), -1).all(axis=1)
        known = known & finite & np.isfinite(column.error)
    return Followed(tables.members, columns, scales, worst(columns, scales), checked, tables.windows), known


def _countable(states: MemberStates, directions: Sequence[tuple[int, int]], starts: Floats) -> Integers:
    """Return of which members no direction is opposite to its start at any of the times."""
    found = np.ones(len(states.q), dtype=bool)
    for d, (i, j) in enumerate(directions):
        start = starts[:, d, None]
        principal = principal_angle(states.q[..., i], states.q[..., j], start[..., 0], start[..., 1])
        found &= (np.abs(principal) < np.pi - NOTHING_LEFT).all(axis=1)
    return found

"""The audit of many members at once: their samples are rows of one set, held against the description.

What connections hold, kinematics, the equations of motion in windows, energy and the start are looked at for every
member, with the definitions that `audit.audit` uses for one. Every member is described by itself. Rows of one set are
those whose descriptions say the same of all but the places of bodies at the start. A set in which anything fails is
answered one by one.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, is_dataclass, replace

import numpy as np

from core.arrays import Floats, Integers
from core.multibody.audit.balanced import Accelerated, check_balance
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic, potential, size_of
from core.multibody.audit.failure import ROUNDING, Ledger, propagated
from core.multibody.audit.laws_at_samples import Sizes, check_samples, measured
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.placement import LARGEST, Pose, Twist, moved
from core.multibody.audit.samples import Part, Samples, samples_of
from core.multibody.audit.start import check_places
from core.multibody.audit.windows import GRID, NODES, check_windows, nodes
from core.multibody.members.member_columns import MemberColumn
from core.systems.trajectory import Column

WINDOWS = 2
"""Windows of every member, each at a time drawn from its numbers."""

SHARE = 2.0**-5
"""Half the width of a window in the unit of time of a table, in which its motion turns by some radians."""

TIMES = 1 + WINDOWS * NODES
"""Times at which a member is audited: the start, and those of windows."""

TOGETHER = 64
"""Members in one set, those of like errors: the largest error of a set is allowed for each."""


NOWHERE = Pose(np.zeros(0))
"""Where a body begins of which that is not said."""


@dataclass(frozen=True)
class MemberWindows:
    """Times at which members are audited: the start, and those of windows.

    Attributes
    ----------
    times : ndarray, shape (members, TIMES)
    halves : ndarray, shape (members, windows)
    """

    times: Floats
    halves: Floats

    def at(self, members: Integers) -> MemberWindows:
        """Return those of some members."""
        return MemberWindows(self.times[members], self.halves[members])


def windows_of(numbers: Floats, clock: Floats, last: float) -> MemberWindows:
    """Return windows of members at times that their numbers decide, the same whoever else is a member.

    Parameters
    ----------
    numbers : ndarray, shape (members, k)
    clock : ndarray, shape (members,)
        Units of time (s), powers of two.
    last : float
        Time up to which the motion is known (s).
    """
    half = np.minimum(SHARE * clock, 2.0 ** (np.frexp(last)[1] - 4))[:, None]
    middle = half * 1.01 + _draws(numbers) * (last - 2.02 * half)
    # A multiple of a share of a power of two: the times of the samples are doubles.
    middle = np.round(middle / half * GRID) * (half / GRID)
    halves = np.repeat(half, WINDOWS, axis=1)
    times = np.concatenate([nodes(middle[:, k : k + 1], half) for k in range(WINDOWS)], axis=1)
    return MemberWindows(np.concatenate([np.zeros((len(numbers), 1)), times], axis=1), halves)


def _draws(numbers: Floats) -> Floats:
    """Return numbers between 0 and 1 that look random, shape (members, windows): splitmix64 of the bits."""
    found = np.zeros((len(numbers), WINDOWS))
    with np.errstate(over="ignore"):
        for k in range(WINDOWS):
            state = np.full(len(numbers), k + 1, dtype=np.uint64)
            for column in np.ascontiguousarray(numbers).view(np.uint64).T:
                state = (state ^ column) + np.uint64(0x9E3779B97F4A7C15)
                state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
                state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
                state ^= state >> np.uint64(31)
            found[:, k] = (state >> np.uint64(11)) * 2.0**-53
    return found


def sets_of(descriptions: Sequence[Description], error: Floats) -> Iterator[tuple[Integers, Description]]:
    """Yield rows of members that are audited together, of like errors, and a description in which all begin.

    Those are left out whose numbers are too large or small for an audit.
    """
    alike: dict[Hashable, list[int]] = {}
    for row in np.argsort(error, kind="stable").tolist():
        if descriptions[row].moderate:
            alike.setdefault(_content(_anywhere(descriptions[row])), []).append(row)
    for rows in alike.values():
        for k in range(0, len(rows), TOGETHER):
            some = rows[k : k + TOGETHER]
            starts = [descriptions[row].start for row in some]
            start = {name: _stacked([one[name] for one in starts]) for name in starts[0]}
            yield np.array(some), replace(_anywhere(descriptions[some[0]]), start=start)


def _anywhere(description: Description) -> Description:
    """Return a description that does not say where bodies begin, nor how fast."""
    bodies = {
        name: replace(body, start=NOWHERE, velocity=None, angular_velocity=None)
        for name, body in description.bodies.items()
    }
    return replace(description, bodies=bodies, start={})


def _stacked(poses: Sequence[Pose]) -> Pose:
    """Return poses of one body as samples of one."""
    return Pose(*(None if parts[0] is None else np.stack(parts) for parts in zip(*poses, strict=True)))  # type: ignore[arg-type]


def _content(value: object) -> Hashable:
    """Return what tells values apart: the contents of dataclasses and arrays; of anything else unknown, which it is."""
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, tuple):
        return type(value), *map(_content, value)
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, dict):
        return tuple((key, _content(one)) for key, one in value.items())
    if is_dataclass(value):
        return type(value), *(_content(getattr(value, name)) for name in value.__dataclass_fields__)
    return id(value)


def keep_the_laws(description: Description, columns: Mapping[str, MemberColumn], windows: MemberWindows) -> bool:
    """Return whether members of one description keep all laws that are checked.

    Parameters
    ----------
    description : Description
        By `sets_of`.
    columns : mapping of str to MemberColumn
        At the times of the windows.
    """
    if any(one.mass or one.opens for one in description.connections):
        # What needs forces, or is not audited at all, is answered by itself.
        return False
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        samples = samples_of(description, [_part(columns, windows)])
        sizes = Sizes(description, samples)
        if not max(sizes.extent, sizes.fastest) < LARGEST:
            return False
        ledger, count = Ledger(ROUNDING), windows.times.shape[1]
        ahead = moved(samples.placement, samples.motion, in_time=True)
        check_samples(ledger, measured(description, ahead), samples, {}, sizes)
        starts = np.arange(0, len(samples.times), count)
        check_places(ledger, description, samples.at(starts))
        inner = np.flatnonzero(np.arange(len(samples.times)) % count)
        freedoms, some = Freedoms(description), samples.at(inner)
        placed = {name: pose.at(inner) for name, pose in ahead.items()}
        halves = windows.halves.ravel().tolist()
        gains = check_windows(ledger, description, freedoms, some, placed, halves, sizes.extent)
        spun = {name: Twist(some.motion[name].velocity, spin) for name, spin in gains.spins.items()}
        some = replace(some, motion={**some.motion, **spun})
        check_balance(ledger, description, freedoms, Accelerated(some, gains.accelerations, gains.unsure, False))
        if not any(connection.works() for connection in description.connections):
            _check_energy(ledger, description, samples, count)
    return ledger.worst is None


def _part(columns: Mapping[str, MemberColumn], windows: MemberWindows) -> Part:
    """Return the samples of all members one after another, with the largest errors of any."""
    shared = {
        name: Column(
            column.values.reshape(-1, *column.values.shape[2:]),
            column.unit,
            float(column.error.max()),
            "measured against pairs",
        )
        for name, column in columns.items()
    }
    return Part(windows.times.ravel(), shared, slice(None))


def _check_energy(ledger: Ledger, description: Description, samples: Samples, count: int) -> None:
    """Require the energy of every member to stay that of its start."""
    moving = kinetic(description, samples)
    size = size_of(description, samples, moving)
    first = np.repeat(np.arange(0, len(samples.times), count), count)
    total = np.broadcast_to(moving + potential(description, samples), samples.times.shape)
    value, floor = np.abs(total - total[first]), 4.0 * ledger.rounding * (size + size[first])
    if (value <= floor).all():
        return

    def change(at: Samples) -> Floats:
        found = kinetic(description, at) + potential(description, at)
        lost: Floats = found - found[..., first]
        return lost

    allowed = floor + propagated(samples, tuple(description.bodies), (), change)[:, 0]
    ledger.compare("energy", "", samples.times, value, allowed)

"""Many free rotations of one body, sampled at the same times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.errors import BudgetExceeded, InvalidParameter, MechanicsError, Path
from core.notices import Notice
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.error_statements import rest_of
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits
from core.systems.solve import checked_times, solve
from core.systems.trajectory import Trajectory
from core.work import spend

MOST_NAMED = 8
"""Members that a warning names by their indices."""

WORK_OF_A_MEMBER = 20
"""Units of work (`core.work`): the constants of a motion are set up for each member."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Trajectories of several starts.

    Attributes
    ----------
    time : ndarray, shape (n,)
        s.
    members : tuple of Trajectory
        One per start, each with its own model, period and statement of error.
    """

    time: Floats
    members: tuple[Trajectory, ...]

    @property
    def angular_velocity(self) -> Floats:
        """Angular velocities in body axes, shape (m, n, 3), 24 bytes a sample (rad/s)."""
        return np.stack([member.state for member in self.members])

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """What the members have to say, each kind once: in the words of the member of largest error, and of how many.

        Members that say the same in other figures say one thing: a client counts kinds, and looks the figures up.
        """
        grouped: dict[tuple[str, Path], list[tuple[int, Notice]]] = {}
        for k, member in enumerate(self.members):
            for notice in member.warnings:
                grouped.setdefault((notice.code, notice.path), []).append((k, notice))
        return tuple(self.merged(members) for members in grouped.values())

    def merged(self, grouped: Sequence[tuple[int, Notice]]) -> Notice:
        """Return one notice for what members, each with its index, say alike."""
        which = list(dict.fromkeys(k for k, _ in grouped))
        worst, notice = max(grouped, key=lambda entry: self.members[entry[0]].accuracy.error)
        everyone = len(which) == len(self.members)
        if everyone and len({entry.detail for _, entry in grouped}) == 1:
            return notice
        named = ", ".join(map(str, which[:MOST_NAMED])) + (", ..." if len(which) > MOST_NAMED else "")
        of = f"all {len(which)} members" if everyone else f"{len(which)} of {len(self.members)} members ({named})"
        most = "" if len(which) == 1 else f"; of these member {worst} has the largest error"
        return Notice(notice.code, f"{notice.detail} [{of}{most}]", notice.path)

    @property
    def error(self) -> float:
        """Largest stated error of any member."""
        return max(member.accuracy.error for member in self.members)


def ensemble(
    body: MassProperties,
    angular_velocities: Floats,
    times: Floats,
    *,
    accuracy: float = 1e-9,
    method: AbstractMethod | None = None,
    digits: Digits | None = None,
    budget: Budget | None = None,
) -> Ensemble:
    """Solve one body from several starts, shape (m, 3), at times, shape (n,); see `core.systems.solve.solve`.

    Raises
    ------
    BudgetExceeded
        If all members together need more samples or evaluations than the budget has.
    MechanicsError
        As `solve`, with the path of the member's start.
    """
    budget = budget or Budget()
    instants = checked_times(times, budget)
    if len(angular_velocities) == 0:
        raise InvalidParameter("angular_velocities", "have at least one row")
    total = instants.size * len(angular_velocities)
    if total > budget.samples:
        remedy = "ask for fewer times or fewer starts, or in several questions"
        raise BudgetExceeded("samples", total, budget.samples, path=("times",), remedy=remedy)
    members: list[Trajectory] = []
    spent = 0
    for k, start in enumerate(angular_velocities):
        spend(WORK_OF_A_MEMBER)
        try:
            rest = rest_of(budget, spent)
            system = TorqueFree(body, start)
            member = solve(system, instants, accuracy=accuracy, method=method, digits=digits, budget=rest)
            member = replace(member, warnings=(*member.warnings, *system.moment_notices))
            spent += member.work.evaluations + member.work.evaluations_for_error
            members.append(member)
        except MechanicsError as fault:
            if fault.path[:1] == ("angular_velocity",):
                fault.path = ("angular_velocities", k, *fault.path[1:])
            raise
    return Ensemble(instants, tuple(members))

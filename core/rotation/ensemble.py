"""Many free rotations of one body, sampled at the same times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.bodies.mass_properties import MassProperties
from core.errors import BudgetExceeded, InvalidParameter, MechanicsError
from core.integration.budget import Budget
from core.integration.error_statements import rest_of
from core.integration.methods.method import AbstractMethod
from core.integration.solve import checked_times, solve
from core.integration.system import Floats
from core.integration.trajectory import Trajectory
from core.rotation.torque_free import TorqueFree


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
    budget: Budget | None = None,
) -> Ensemble:
    """Solve one body from several starts, shape (m, 3), at times, shape (n,); see `core.integration.solve.solve`.

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
        try:
            rest = rest_of(budget, spent)
            member = solve(TorqueFree(body, start), instants, accuracy=accuracy, method=method, budget=rest)
            spent += member.work.evaluations + member.work.evaluations_for_error
            members.append(member)
        except MechanicsError as fault:
            if fault.path[:1] == ("angular_velocity",):
                fault.path = ("angular_velocities", k, *fault.path[1:])
            raise
    return Ensemble(instants, tuple(members))

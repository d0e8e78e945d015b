"""A question about a described scene, as its parts and its motion are given it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.arrays import Floats
from core.errors import BudgetExceeded
from core.multibody.language.scene import Scene
from core.multibody.table.coordinates import dimension_of
from core.multibody.trajectory.occurrences import ExtremesOf, ValueSearch
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.question import System
from core.systems.rounding import Digits
from core.systems.solve import solve
from core.systems.trajectory import Trajectory

MOST_NUMBERS = 5_000_000
"""Numbers that the places and velocities of one trajectory may have: 40 MB."""

Output = str | ValueSearch | ExtremesOf


def require_affordable(samples: int, scene: Scene) -> None:
    """Raise `BudgetExceeded` for more samples of a scene than one trajectory may have.

    It is known from the description, before anything is computed: the components of the bodies' places are counted.
    """
    # A component and its rate are two doubles each, a value and its tail.
    most = MOST_NUMBERS // (4 * dimension_of(scene) * len(scene.bodies))
    if samples > most:
        raise BudgetExceeded("samples", samples, most, path=("times",), remedy="ask for fewer times")


@dataclass(frozen=True)
class SceneRequest:
    """What is requested of a scene; the attributes are the parameters of `core.multibody.solve.solve_scene`."""

    times: Floats
    outputs: Sequence[Output]
    accuracy: float
    method: AbstractMethod | None
    input_uncertainty: float | None
    digits: Digits | None
    budget: Budget

    def solved(self, system: System) -> Trajectory | None:
        """Return the trajectory of a system, None without times."""
        if not len(self.times):
            return None
        return solve(
            system,
            self.times,
            accuracy=self.accuracy,
            method=self.method,
            input_uncertainty=self.input_uncertainty,
            digits=self.digits,
            budget=self.budget,
        )

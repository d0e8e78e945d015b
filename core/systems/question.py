"""A question about a motion, and what a system is: anything that has one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from core.arrays import Floats
from core.systems.budget import Budget
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class MotionQuestion:
    """A question about a motion, checked by `core.systems.solve.solve`, whose parameters the attributes are.

    Attributes
    ----------
    times : ndarray, shape (n,)
        Finite, n > 0.
    """

    times: Floats
    accuracy: float = 1e-9
    method: AbstractMethod | None = None
    input_uncertainty: float | None = None
    budget: Budget = field(default_factory=Budget)

    @property
    def integrator(self) -> AbstractMethod | None:
        """The method that is named, unless it is the closed form."""
        return None if isinstance(self.method, ClosedFormEvaluation) else self.method


class System(Protocol):
    """A free rotation, a named scene, a described scene: what has a motion from a given state at t = 0."""

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return samples with a statement of their error.

        Raises
        ------
        MechanicsError
            For what cannot be answered to the accuracy that is requested; a method that is named is answered whatever
            its error.
        """

"""The exact solution as a member of the catalogue."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from core.arrays import Floats
from core.errors import NotApplicable
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod, Family, Integration
from core.systems.system import InitialValueProblem
from core.systems.trajectory import Work
from core.work import spend


@dataclass(frozen=True)
class ClosedFormEvaluation(AbstractMethod):
    """Evaluate the closed form of the motion at each time, at a cost that does not depend on the time."""

    kind: Literal["closed-form"] = "closed-form"

    order: ClassVar[None] = None
    family: ClassVar[Family] = "closed form"
    between_steps: ClassVar[str] = "There are no steps: the closed form is evaluated at every time by itself."
    on_constraints: ClassVar[str] = "The closed form of a scene meets its constraints."
    when_to_use: ClassVar[str] = (
        "Always, where a closed form exists: it is accurate to the last digit at any time and faster than every "
        "integrator that reaches an error of 1e-3."
    )

    def integrate(self, system: InitialValueProblem, times: Floats, budget: Budget | None = None) -> Integration:
        """Return the states of `system` at `times`; see `AbstractMethod.integrate`."""
        exact = system.closed_form()
        if exact is None:
            raise NotApplicable(
                f"{system.model.name} has no closed form",
                path=("kind",),
                remedy="use dormand-prince-853, or leave the method to the service",
            )
        spend(times.size)
        return Integration(exact.sample(times), Work(times.size))

    def finer(self) -> None:
        """Return None: there is nothing more accurate in double precision."""
        return None

"""Symmetric splitting: exact flows of the parts of an equation, composed there and back.

References
----------
G. Strang, "On the construction and comparison of difference schemes", SIAM Journal on Numerical Analysis 5 (1968) 506.
E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, sections II.5 and VII.5.3
(the rigid body).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.errors import NotApplicable
from core.systems.methods.fixed_step import FixedStep, steps_by
from core.systems.methods.method import Family, Invariance
from core.systems.system import PART_FLOW, InitialValueProblem, Splitting


@kernel(steps_by(PART_FLOW))
def _advance(
    flow: Any,
    project: Any,
    start: float,
    h: float,
    count: int,
    carried: Floats,
    work: Floats,
    parameters: Floats,
    tally: Integers,
) -> int:
    # A step of n parts takes 2 n - 1 flows.
    last = (tally[1] - 1) // 2
    state = carried[0]
    for _ in range(count):
        for part in range(last):
            flow(part, 0.5 * h, state, parameters)
        flow(last, h, state, parameters)
        for part in range(last - 1, -1, -1):
            flow(part, 0.5 * h, state, parameters)
    return 0


@dataclass(frozen=True)
class SymmetricSplitting(FixedStep):
    """Strang's composition of the flows that the system offers; for a free body, of rotations about its axes.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: Literal["symmetric-splitting"] = "symmetric-splitting"

    order: ClassVar[int] = 2
    compiled: ClassVar[Any] = staticmethod(_advance)
    family: ClassVar[Family] = "structure-preserving"
    preserves: ClassVar[tuple[Invariance, ...]] = ("invariants of every part", "time symmetry")
    when_to_use: ClassVar[str] = (
        "For long runs at low cost that must keep the angular momentum to round-off and the energy within a narrow "
        "band for ever; it solves no implicit equation, and its phase error is of second order."
    )

    def _evaluations_per_step(self, system: InitialValueProblem) -> int:
        return 2 * self._splitting(system).parts - 1

    def _law(self, system: InitialValueProblem) -> Any:
        return self._splitting(system).flow

    def _splitting(self, system: InitialValueProblem) -> Splitting:
        splitting = system.structure.splitting
        if splitting is None:
            raise NotApplicable(
                f"{system.model.name} offers no splitting into parts with exact flows",
                path=("kind",),
                remedy="use implicit-midpoint, which needs the equation of motion alone",
            )
        return splitting

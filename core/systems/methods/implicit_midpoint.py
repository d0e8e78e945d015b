"""The implicit midpoint rule: one Gauss stage, which keeps every quadratic invariant.

The stage equation is iterated until rounding stops it, so that what the rule keeps is kept to round-off.

References
----------
E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, sections IV.2.1 (quadratic
invariants) and VIII.6 (when to stop the iteration).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import two_sum
from core.systems.methods.fixed_step import NO_CONVERGENCE, OUT_OF_BUDGET, FixedStep, steps_by
from core.systems.methods.method import PROJECTED, Family, Invariance
from core.systems.system import VECTOR_FIELD, InitialValueProblem

ITERATIONS = 100


@kernel(steps_by(VECTOR_FIELD))
def _advance(
    field: Any,
    project: Any,
    start: float,
    h: float,
    count: int,
    carried: Floats,
    work: Floats,
    parameters: Floats,
    tally: Integers,
) -> int:
    state, tail, slope = carried[0], carried[1], carried[2]
    new, middle = work[0], work[1]
    constrained = tally[2] == 1
    for j in range(count):
        t = start + (j + 0.5) * h
        last, spent = np.inf, 0
        while True:
            for k in range(state.size):
                middle[k] = state[k] + 0.5 * h * slope[k]
            field(t, middle, parameters, new)
            spent += 1
            change, size = 0.0, 0.0
            for k in range(state.size):
                change = max(change, abs(h * (new[k] - slope[k])))
                size = max(size, abs(state[k]), abs(middle[k]))
                slope[k] = new[k]
            # Beside the round-off of the state, a change that no longer falls is round-off and nothing else.
            if change == 0.0 or (change >= last and change <= 1e-13 * size):
                break
            if spent >= ITERATIONS or not change < np.inf:
                return NO_CONVERGENCE
            last = change
        tally[0] -= spent - 1
        if tally[0] < 0:
            return OUT_OF_BUDGET
        for k in range(state.size):
            # The rounding of the sum is carried on, which keeps the invariants from drifting.
            state[k], tail[k] = two_sum(state[k], h * slope[k] + tail[k])
        if constrained:
            project(state, parameters)
    return 0


@dataclass(frozen=True)
class ImplicitMidpoint(FixedStep):
    """The implicit midpoint rule: w[i+1] = w[i] + h f(t[i] + h/2, (w[i] + w[i+1])/2).

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: Literal["implicit-midpoint"] = "implicit-midpoint"

    order: ClassVar[int] = 2
    compiled: ClassVar[Any] = staticmethod(_advance)
    work_vectors: ClassVar[int] = 2
    family: ClassVar[Family] = "implicit"
    preserves: ClassVar[tuple[Invariance, ...]] = ("quadratic invariants", "time symmetry")
    on_constraints: ClassVar[str] = PROJECTED
    when_to_use: ClassVar[str] = (
        "For long runs in which energy and angular momentum must not drift at all; the phase still does, in proportion "
        "to the square of the step."
    )

    def _carried(self, system: InitialValueProblem, start: Floats) -> tuple[Floats, int]:
        # The slope of the last step is the first guess; for the first step it is the one at the start.
        carried = np.zeros((3, start.size))
        carried[0] = start
        system.equation(0.0, start, system.parameters, carried[2])
        return carried, 1

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

from core.compiled import kernel
from core.double_double import two_sum
from core.quantities import Duration, check
from core.systems.methods.fixed_step import NO_CONVERGENCE, OUT_OF_BUDGET, OVERFLOW, FixedStep, keep, march_by, replace
from core.systems.methods.method import PROJECTED, Family, Invariance
from core.systems.system import VECTOR_FIELD, Floats, InitialValueProblem, Integers

ITERATIONS = 100


@kernel(march_by(VECTOR_FIELD))
def _march(
    field: Any,
    project: Any,
    begin: Floats,
    step: Floats,
    count: Integers,
    state: Floats,
    parameters: Floats,
    samples: Floats,
    tally: Integers,
) -> int:
    slope, new, middle = np.empty_like(state), np.empty_like(state), np.empty_like(state)
    tail = np.zeros_like(state)
    grid, grid_tail, grid_slope = np.empty_like(state), np.empty_like(state), np.empty_like(state)
    constrained = tally[3] == 1
    # The slope of the last step is the first guess; for the first step it is the one at the start.
    field(begin[0, 0], state, parameters, slope)
    tally[0] -= 1
    for i in range(len(count)):
        for run in range(2):
            replace(grid, state)
            replace(grid_tail, tail)
            replace(grid_slope, slope)
            h = step[i, run]
            for j in range(count[i, run]):
                t = begin[i, run] + (j + 0.5) * h
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
                        tally[1] = NO_CONVERGENCE
                        return i
                    last = change
                tally[0] -= spent - 1
                if tally[0] < 0:
                    tally[1] = OUT_OF_BUDGET
                    return i
                for k in range(state.size):
                    # The rounding of the sum is carried on, which keeps the invariants from drifting.
                    state[k], tail[k] = two_sum(state[k], h * slope[k] + tail[k])
                if constrained:
                    project(state, parameters)
        if not keep(state, i, samples):
            tally[1] = OVERFLOW
            return i
        replace(state, grid)
        replace(tail, grid_tail)
        replace(slope, grid_slope)
    return len(count)


@dataclass(frozen=True)
class ImplicitMidpoint(FixedStep):
    """The implicit midpoint rule: w[i+1] = w[i] + h f(t[i] + h/2, (w[i] + w[i+1])/2).

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    step: Duration
    kind: Literal["implicit-midpoint"] = "implicit-midpoint"

    order: ClassVar[int] = 2
    family: ClassVar[Family] = "implicit"
    preserves: ClassVar[tuple[Invariance, ...]] = ("quadratic invariants", "time symmetry")
    on_constraints: ClassVar[str] = PROJECTED
    when_to_use: ClassVar[str] = (
        "For long runs in which energy and angular momentum must not drift at all; the phase still does, in proportion "
        "to the square of the step."
    )

    def __post_init__(self) -> None:
        check(self)

    def _evaluations_per_step(self, system: InitialValueProblem) -> int:
        return 1

    def _compiled(self) -> Any:
        return _march

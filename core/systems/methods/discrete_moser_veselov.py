"""Discrete mechanics: steps that come from a discrete principle of least action, not from an equation of motion.

References
----------
J. Moser, A. P. Veselov, "Discrete versions of some classical integrable systems and factorization of matrix
polynomials", Communications in Mathematical Physics 139 (1991) 217.
E. Hairer, G. Vilmart, "Preprocessed discrete Moser-Veselov algorithm for the full dynamics of the rigid body", Journal
of Physics A 39 (2006) 13225 (its first integrals, its order, and the step by quaternions).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from core.compiled import kernel
from core.double_double import two_sum
from core.errors import NotApplicable
from core.quantities import Duration, check
from core.systems.methods.fixed_step import NO_CONVERGENCE, OVERFLOW, FixedStep, keep, march_by, replace
from core.systems.methods.method import Family, Invariance
from core.systems.system import DISCRETE_STEP, Floats, InitialValueProblem, Integers


@kernel(march_by(DISCRETE_STEP))
def _march(
    advance: Any,
    project: Any,
    begin: Floats,
    step: Floats,
    count: Integers,
    state: Floats,
    parameters: Floats,
    samples: Floats,
    tally: Integers,
) -> int:
    increment, tail = np.empty_like(state), np.zeros_like(state)
    grid, grid_tail = np.empty_like(state), np.empty_like(state)
    for i in range(len(count)):
        for run in range(2):
            replace(grid, state)
            replace(grid_tail, tail)
            for _ in range(count[i, run]):
                if not advance(step[i, run], state, parameters, increment):
                    tally[1] = NO_CONVERGENCE
                    return i
                for k in range(state.size):
                    # The rounding of the sum is carried on, which keeps the first integrals from drifting.
                    state[k], tail[k] = two_sum(state[k], increment[k] + tail[k])
        if not keep(state, i, samples):
            tally[1] = OVERFLOW
            return i
        replace(state, grid)
        replace(tail, grid_tail)
    return len(count)


@dataclass(frozen=True)
class DiscreteMoserVeselov(FixedStep):
    """The discrete mechanics that the system offers; for a free body, Moser and Veselov's.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    step: Duration
    kind: Literal["discrete-moser-veselov"] = "discrete-moser-veselov"

    order: ClassVar[int] = 2
    family: ClassVar[Family] = "structure-preserving"
    preserves: ClassVar[tuple[Invariance, ...]] = ("every first integral", "time symmetry")
    when_to_use: ClassVar[str] = (
        "To stay on the true polhode to round-off for ever: energy and angular momentum are both kept, and all of the "
        "error is in the phase, which is of second order."
    )

    def __post_init__(self) -> None:
        check(self)

    def _evaluations_per_step(self, system: InitialValueProblem) -> int:
        self._law(system)
        return 1

    def _compiled(self) -> Any:
        return _march

    def _law(self, system: InitialValueProblem) -> Any:
        discrete = system.structure.discrete
        if discrete is None:
            raise NotApplicable(
                f"{system.model.name} offers no discrete mechanics",
                path=("kind",),
                remedy="use implicit-midpoint, which needs the equation of motion alone",
            )
        return discrete

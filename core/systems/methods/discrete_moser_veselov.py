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

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import two_sum
from core.errors import NotApplicable
from core.systems.methods.fixed_step import NO_CONVERGENCE, FixedStep, steps_by
from core.systems.methods.method import Family, Invariance
from core.systems.system import DISCRETE_STEP, InitialValueProblem


@kernel(steps_by(DISCRETE_STEP))
def _advance(
    advance: Any,
    project: Any,
    start: float,
    h: float,
    count: int,
    carried: Floats,
    work: Floats,
    parameters: Floats,
    tally: Integers,
) -> int:
    state, tail, increment = carried[0], carried[1], work[0]
    for _ in range(count):
        if not advance(h, state, parameters, increment):
            return NO_CONVERGENCE
        for k in range(state.size):
            # The rounding of the sum is carried on, which keeps the first integrals from drifting.
            state[k], tail[k] = two_sum(state[k], increment[k] + tail[k])
    return 0


@dataclass(frozen=True)
class DiscreteMoserVeselov(FixedStep):
    """The discrete mechanics that the system offers; for a free body, Moser and Veselov's.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: Literal["discrete-moser-veselov"] = "discrete-moser-veselov"

    order: ClassVar[int] = 2
    compiled: ClassVar[Any] = staticmethod(_advance)
    work_vectors: ClassVar[int] = 1
    family: ClassVar[Family] = "structure-preserving"
    preserves: ClassVar[tuple[Invariance, ...]] = ("every first integral", "time symmetry")
    when_to_use: ClassVar[str] = (
        "To stay on the true polhode to round-off for ever: energy and angular momentum are both kept, and all of the "
        "error is in the phase, which is of second order."
    )

    def _carried(self, system: InitialValueProblem, start: Floats) -> tuple[Floats, int]:
        return np.stack([start, np.zeros_like(start)]), 0

    def _law(self, system: InitialValueProblem) -> Any:
        discrete = system.structure.discrete
        if discrete is None:
            raise NotApplicable(
                f"{system.model.name} offers no discrete mechanics",
                path=("kind",),
                remedy="use implicit-midpoint, which needs the equation of motion alone",
            )
        return discrete

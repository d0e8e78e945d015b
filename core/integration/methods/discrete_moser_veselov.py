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
from numba import types

from core.compiled import kernel
from core.errors import NotApplicable
from core.integration.methods.fixed_step import NO_CONVERGENCE, OVERFLOW, FixedStep, keep
from core.integration.methods.method import Family, Invariance
from core.integration.system import DISCRETE_STEP, Floats, Integers, System
from core.quantities import Duration, check

_doubles = types.float64[::1]
_integers = types.int64[::1]
_STEP_MARCH = types.int64(
    types.FunctionType(DISCRETE_STEP),
    _doubles,
    _doubles,
    _integers,
    _doubles,
    _doubles,
    types.float64[:, ::1],
    _integers,
)


@kernel(_STEP_MARCH)
def _march(
    advance: Any,
    begin: Floats,
    step: Floats,
    count: Integers,
    state: Floats,
    parameters: Floats,
    samples: Floats,
    tally: Integers,
) -> int:
    increment, tail = np.empty_like(state), np.zeros_like(state)
    for i in range(count.size):
        for _ in range(count[i]):
            if not advance(step[i], state, parameters, increment):
                tally[1] = NO_CONVERGENCE
                return i
            for k in range(state.size):
                # Compensated: the rounding of the sum is carried on, which keeps the first integrals from drifting.
                added = increment[k] + tail[k]
                old = state[k]
                state[k] = old + added
                taken = state[k] - old
                tail[k] = (old - (state[k] - taken)) + (added - taken)
        if not keep(state, i, samples):
            tally[1] = OVERFLOW
            return i
    return count.size


@dataclass(frozen=True)
class DiscreteMoserVeselov(FixedStep):
    """The discrete mechanics that the system offers; for a free body, Moser and Veselov's.

    Parameters
    ----------
    step : float
        Longest step (s).
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

    def _evaluations_per_step(self, system: System) -> int:
        self._vector_field(system)
        return 1

    def _compiled(self, system: System) -> Any:
        return _march

    def _vector_field(self, system: System) -> Any:
        discrete = system.structure.discrete
        if discrete is None:
            raise NotApplicable(
                f"{system.model.name} offers no discrete mechanics",
                path=("kind",),
                remedy="use implicit-midpoint, which needs the equation of motion alone",
            )
        return discrete

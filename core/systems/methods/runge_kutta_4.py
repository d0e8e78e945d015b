"""The classical Runge-Kutta method of order four.

References
----------
W. Kutta, "Beitrag zur näherungsweisen Integration totaler Differentialgleichungen", Zeitschrift für Mathematik und
Physik 46 (1901) 435.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.systems.methods.fixed_step import FixedStep, steps_by
from core.systems.methods.method import PROJECTED, Family
from core.systems.system import VECTOR_FIELD


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
    state, stage = carried[0], work[0]
    k1, k2, k3, k4 = work[1], work[2], work[3], work[4]
    constrained = tally[2] == 1
    for j in range(count):
        t = start + j * h
        field(t, state, parameters, k1)
        for k in range(state.size):
            stage[k] = state[k] + 0.5 * h * k1[k]
        field(t + 0.5 * h, stage, parameters, k2)
        for k in range(state.size):
            stage[k] = state[k] + 0.5 * h * k2[k]
        field(t + 0.5 * h, stage, parameters, k3)
        for k in range(state.size):
            stage[k] = state[k] + h * k3[k]
        field(t + h, stage, parameters, k4)
        for k in range(state.size):
            state[k] += h * ((k1[k] + k4[k]) + 2 * (k2[k] + k3[k])) / 6
        if constrained:
            project(state, parameters)
    return 0


@dataclass(frozen=True)
class RungeKutta4(FixedStep):
    """The classical Runge-Kutta method.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: Literal["runge-kutta-4"] = "runge-kutta-4"

    order: ClassVar[int] = 4
    compiled: ClassVar[Any] = staticmethod(_advance)
    evaluations: ClassVar[int] = 4
    work_vectors: ClassVar[int] = 5
    family: ClassVar[Family] = "explicit"
    on_constraints: ClassVar[str] = PROJECTED
    when_to_use: ClassVar[str] = (
        "For moderate accuracy (1e-3 to 1e-8) over a few periods at a fixed cost per step, and as the yardstick that "
        "most readers know."
    )

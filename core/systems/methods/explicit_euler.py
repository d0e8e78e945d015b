"""Forward Euler: the slope at the start of a step is taken for all of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.systems.methods.fixed_step import ONE_STEP, FixedStep, steps_by
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
    state, slope = carried[0], work[0]
    constrained = tally[2] == 1
    for j in range(count):
        field(start + j * h, state, parameters, slope)
        for k in range(state.size):
            state[k] += h * slope[k]
        if constrained:
            project(state, parameters)
    return 0


@dataclass(frozen=True)
class ExplicitEuler(FixedStep):
    """Forward Euler: w[i+1] = w[i] + h f(t[i], w[i]).

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: Literal["explicit-euler"] = "explicit-euler"

    order: ClassVar[int] = 1
    compiled: ClassVar[Any] = staticmethod(_advance)
    work_vectors: ClassVar[int] = 1
    family: ClassVar[Family] = "explicit"
    between_steps: ClassVar[str] = ONE_STEP + " For this method that is the straight line to the next grid point."
    on_constraints: ClassVar[str] = PROJECTED
    when_to_use: ClassVar[str] = (
        "To see what the simplest first-order method does: on a free body its energy grows at "
        "every step, and ten times less error costs ten times more steps."
    )

"""Fixed-step methods that students write and the service does not offer: they are only recognised.

References
----------
E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, section I.1.2 (symplectic
Euler); E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993, section
II.1 (the methods of Runge and of Heun).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.systems.methods.fixed_step import FixedStep, steps_by
from core.systems.methods.method import Family
from core.systems.system import VECTOR_FIELD, InitialValueProblem


@kernel(steps_by(VECTOR_FIELD))
def _advance_in_turn(
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
    for j in range(count):
        for k in range(state.size):
            field(start + j * h, state, parameters, slope)
            state[k] += h * slope[k]
    return 0


@kernel(steps_by(VECTOR_FIELD))
def _advance_by_midpoint(
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
    state, slope, stage = carried[0], work[0], work[1]
    for j in range(count):
        t = start + j * h
        field(t, state, parameters, slope)
        for k in range(state.size):
            stage[k] = state[k] + 0.5 * h * slope[k]
        field(t + 0.5 * h, stage, parameters, slope)
        for k in range(state.size):
            state[k] += h * slope[k]
    return 0


@kernel(steps_by(VECTOR_FIELD))
def _advance_by_mean_slope(
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
    state, slope, later, stage = carried[0], work[0], work[1], work[2]
    for j in range(count):
        t = start + j * h
        field(t, state, parameters, slope)
        for k in range(state.size):
            stage[k] = state[k] + h * slope[k]
        field(t + h, stage, parameters, later)
        for k in range(state.size):
            state[k] += 0.5 * h * (slope[k] + later[k])
    return 0


@dataclass(frozen=True)
class SemiImplicitEuler(FixedStep):
    """Euler's method in which each component is advanced with those before it already new.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: str = "semi-implicit-euler"

    order: ClassVar[int] = 1
    compiled: ClassVar[Any] = staticmethod(_advance_in_turn)
    family: ClassVar[Family] = "explicit"
    work_vectors: ClassVar[int] = 1

    def _evaluations_per_step(self, system: InitialValueProblem) -> int:
        return int(system.initial_state.size)


@dataclass(frozen=True)
class ExplicitMidpoint(FixedStep):
    """Runge's method of order two: the slope halfway through an Euler step.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: str = "explicit-midpoint"

    order: ClassVar[int] = 2
    compiled: ClassVar[Any] = staticmethod(_advance_by_midpoint)
    evaluations: ClassVar[int] = 2
    family: ClassVar[Family] = "explicit"
    work_vectors: ClassVar[int] = 2


@dataclass(frozen=True)
class Heun(FixedStep):
    """Heun's method of order two: the mean of the slopes before and after an Euler step.

    Parameters
    ----------
    step : float
        Length of the steps, from t = 0 (s).
    """

    kind: str = "heun"

    order: ClassVar[int] = 2
    compiled: ClassVar[Any] = staticmethod(_advance_by_mean_slope)
    evaluations: ClassVar[int] = 2
    family: ClassVar[Family] = "explicit"
    work_vectors: ClassVar[int] = 3

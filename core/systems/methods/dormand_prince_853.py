"""Dormand and Prince's explicit Runge-Kutta method of order eight, with a step chosen by its error estimates.

The estimate is Hairer's combination of a fifth and a third order one, and so is the controller: safety factor 0.9,
between 1/3 and 6 from step to step, no growth right after a rejection. Three things differ from the published code.
Errors are compared with the largest component of the state, so the tolerance is relative and nothing depends on units.
The first step is chosen in units of the motion's own time, size over speed, or from the horizon where there is none.
Time and state are summed with their roundings carried on, so that many small steps lose no more than few large ones.
A system with constraints is projected onto them at the end of every step that is taken.

Samples inside a step come from the interpolant of order seven, at three further evaluations per step that has any.

References
----------
J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", Journal of Computational and Applied
Mathematics 6 (1980) 19.
E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993, sections II.4
(control of the step), II.5 (the method) and II.6 (the interpolant).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numba import types

from core.arrays import Floats, Integers
from core.compiled import entry, kernel
from core.double_double import two_sum
from core.errors import InvalidParameter
from core.quantities import Quantity
from core.systems.methods.dormand_prince_tableau import ERROR_3 as E3
from core.systems.methods.dormand_prince_tableau import ERROR_5 as E5
from core.systems.methods.dormand_prince_tableau import INTERPOLANT, STAGES, A, B, C
from core.systems.methods.method import PROJECTED, Family, Leg, StepChoosing, Units
from core.systems.system import PROJECTION, VECTOR_FIELD, InitialValueProblem, unconstrained

SMALLEST_TOLERANCE = 1e-16
"""Below this the estimate sees nothing but round-off; the samples stop improving from about 1e-15 on."""

DONE, OUT_OF_BUDGET, STEP_VANISHED = 0, 1, 2

_field = types.FunctionType(VECTOR_FIELD)
_projection = types.FunctionType(PROJECTION)
_row = types.float64[::1]
_rows = types.float64[:, ::1]


@kernel()
def _largest(vector: Floats) -> float:
    """Return the largest magnitude of any entry, infinity if one is not finite."""
    largest = 0.0
    for k in range(vector.size):
        if not math.isfinite(vector[k]):
            return math.inf
        largest = max(largest, abs(vector[k]))
    return largest


@kernel()
def _first_step(
    field: Any,
    state: Floats,
    parameters: Floats,
    tolerance: float,
    horizon: float,
    slope: Floats,
    stage: Floats,
    other: Floats,
) -> float:
    """Return the first step to be tried, with the sign of the horizon; `slope` is the one at the start."""
    size, speed, most = _largest(state), _largest(slope), abs(horizon)
    if speed == 0.0:
        return 0.01 * horizon
    own = min(size / speed, most) if size > 0.0 else most
    trial = math.copysign(0.01 * own, horizon)
    for k in range(state.size):
        stage[k] = state[k] + trial * slope[k]
    field(trial, stage, parameters, other)
    for k in range(state.size):
        other[k] -= slope[k]
    # How much the slope turns over the motion's own time, relative to the slope.
    bend = _largest(other) / speed * 100
    return math.copysign(min(own * (0.01 * tolerance / max(1.0, bend)) ** 0.125, most), horizon)


@kernel()
def _fill_stages(
    field: Any,
    now: float,
    step: float,
    state: Floats,
    parameters: Floats,
    stages: Floats,
    first: int,
    end: int,
    stage: Floats,
    slope: Floats,
) -> None:
    """Evaluate the stages from `first` to before `end`; `stages` holds one row per component of the state."""
    for i in range(first, end):
        for k in range(state.size):
            total = 0.0
            for j in range(i):
                total += A[i, j] * stages[k, j]
            stage[k] = state[k] + step * total
        field(now + C[i] * step, stage, parameters, slope)
        for k in range(state.size):
            stages[k, i] = slope[k]


@kernel()
def _advance(step: float, state: Floats, tail: Floats, stages: Floats, new: Floats, new_tail: Floats) -> float:
    """Fill in the state at the end of the step and return the estimated error relative to the largest component."""
    size, fifth, third = 0.0, 0.0, 0.0
    for k in range(state.size):
        total, e5, e3 = 0.0, 0.0, 0.0
        for i in range(STAGES):
            total += B[i] * stages[k, i]
            e5 += E5[i] * stages[k, i]
            e3 += E3[i] * stages[k, i]
        new[k], new_tail[k] = two_sum(state[k], step * total + tail[k])
        if not (math.isfinite(new[k]) and math.isfinite(e5) and math.isfinite(e3)):
            return math.inf
        size = max(size, abs(state[k]), abs(new[k]))
        fifth = max(fifth, abs(step * e5))
        third = max(third, abs(step * e3))
    if fifth == 0.0:
        return 0.0
    fifth, third = fifth / size, third / size
    return fifth * (fifth / math.hypot(fifth, 0.1 * third))


@kernel()
def _fit(step: float, state: Floats, new: Floats, stages: Floats, fitted: Floats) -> None:
    """Fill in the coefficients of the interpolant of a step whose sixteen stages are known."""
    for k in range(state.size):
        change = new[k] - state[k]
        fitted[k, 0] = change
        fitted[k, 1] = step * stages[k, 0] - change
        fitted[k, 2] = 2 * change - step * (stages[k, 12] + stages[k, 0])
        for i in range(4):
            total = 0.0
            for j in range(16):
                total += INTERPOLANT[i, j] * stages[k, j]
            fitted[k, 3 + i] = step * total


@entry(
    types.int64(
        _field, _projection, types.boolean, _row, types.float64, _row, _row, types.int64, _rows, types.int64[::1], _row
    ),
)
def _march(
    field: Any,
    project: Any,
    constrained: bool,
    targets: Floats,
    tolerance: float,
    start: Floats,
    parameters: Floats,
    limit: int,
    samples: Floats,
    tally: Integers,
    reached: Floats,
) -> int:
    n = start.size
    state, tail, new, new_tail = start.copy(), np.zeros(n), np.empty(n), np.empty(n)
    slope, stage, stages, fitted = np.empty(n), np.empty(n), np.empty((n, 16)), np.empty((n, 7))
    horizon = targets[targets.size - 1]
    now, rest, sample, largest_factor = 0.0, 0.0, 0, 6.0
    field(now, state, parameters, slope)
    for k in range(n):
        stages[k, 0] = slope[k]
    step = _first_step(field, state, parameters, tolerance, horizon, slope, stage, new)
    tally[0] = 2
    while sample < targets.size:
        reached[0] = now
        # One step may take eleven evaluations, one at its end and three for its interpolant.
        if tally[0] + STAGES + 3 > limit:
            return OUT_OF_BUDGET
        left = (horizon - now) - rest
        last = abs(step) >= abs(left)
        if last:
            step = left
        elif abs(step) > 0.5 * abs(left):
            # Two equal steps to the end rather than one and a sliver.
            step = 0.5 * left
        if abs(step) <= 4.5e-16 * abs(now) or step == 0.0:
            return STEP_VANISHED
        _fill_stages(field, now, step, state, parameters, stages, 1, STAGES, stage, slope)
        error = _advance(step, state, tail, stages, new, new_tail) / tolerance
        tally[0] += STAGES - 1
        if error <= 1.0:
            then, then_rest = (horizon, 0.0) if last else two_sum(now, step + rest)
            if constrained:
                project(new, parameters)
            field(then, new, parameters, slope)
            tally[0] += 1
            if not math.isfinite(_largest(slope)):
                error = math.inf
        if not error <= 1.0:
            tally[2] += 1
            largest_factor = 1.0
            step *= max(1 / 3, 0.9 * error**-0.125)
            continue
        tally[1] += 1
        for k in range(n):
            stages[k, 12] = slope[k]
        known = False
        while sample < targets.size:
            x = ((targets[sample] - now) - rest) / step
            if x > 1.0 or (x == 1.0 and not last):
                break
            if last and sample == targets.size - 1:
                for k in range(n):
                    samples[sample, k] = new[k]
            else:
                if not known:
                    _fill_stages(field, now, step, state, parameters, stages, 13, 16, stage, slope)
                    _fit(step, state, new, stages, fitted)
                    tally[0] += 3
                    known = True
                for k in range(n):
                    y = fitted[k, 6] * x
                    y = (y + fitted[k, 5]) * (1 - x)
                    y = (y + fitted[k, 4]) * x
                    y = (y + fitted[k, 3]) * (1 - x)
                    y = (y + fitted[k, 2]) * x
                    y = (y + fitted[k, 1]) * (1 - x)
                    samples[sample, k] = state[k] + (y + fitted[k, 0]) * x
            sample += 1
        now, rest = then, then_rest
        for k in range(n):
            state[k], tail[k] = new[k], new_tail[k]
            stages[k, 0] = stages[k, 12]
        step *= min(largest_factor, max(1 / 3, 0.9 * error**-0.125))
        largest_factor = 6.0
    return DONE


@dataclass(frozen=True)
class DormandPrince853(StepChoosing):
    """Dormand and Prince's method of order 8(5,3).

    Parameters
    ----------
    tolerance : float
        Largest estimated error of a step, relative to the largest component of the state. The error of the motion is
        the sum of what the steps contribute, and grows with the horizon.
    """

    tolerance: Annotated[float, Quantity("1", at_least=SMALLEST_TOLERANCE, below=1)]
    kind: Literal["dormand-prince-853"] = "dormand-prince-853"

    order: ClassVar[int] = 8
    family: ClassVar[Family] = "explicit"
    smallest: ClassVar[float] = SMALLEST_TOLERANCE
    between_steps: ClassVar[str] = (
        "By the method's own interpolant of order seven, at three further evaluations in every step with a sample. "
        "The steps do not depend on the samples; only the last one ends at the farthest."
    )
    on_constraints: ClassVar[str] = PROJECTED
    when_to_use: ClassVar[str] = (
        "The default where there is no closed form: smooth motions to errors from 1e-4 down to 1e-13, with as many "
        "samples as wanted at little extra cost."
    )

    def _march(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        samples = np.empty((targets.size, start.size))
        tally, reached = np.zeros(3, np.int64), np.zeros(1)
        project = system.structure.projection
        outcome = _march(
            system.equation,
            project,
            project is not unconstrained,
            targets,
            self.tolerance,
            start,
            system.parameters,
            limit,
            samples,
            tally,
            reached,
        )
        if outcome == OUT_OF_BUDGET:
            raise self._out_of_budget(int(tally[0]), limit, float(reached[0]) / float(targets[-1]))
        if outcome == STEP_VANISHED:
            time = units.given_time(float(reached[0]))
            rule = f"be within reach: at t = {time:.6g} s no step is short enough to meet it"
            raise InvalidParameter(
                "tolerance", rule, remedy="ask for earlier times: the solution may cease to exist there"
            )
        return Leg(samples, int(tally[0]), int(tally[1]), int(tally[2]))

"""Methods whose step is chosen by the client: the plan of the steps, and the base that runs it.

The interval between consecutive samples is divided into the fewest equal steps that are no longer than the chosen one,
so every sample is a point of the method and none is interpolated. An interval that is a whole number of chosen steps,
up to the rounding of the times, gets exactly the chosen step: on an equally spaced grid whose spacing is the step, the
method goes from grid point to grid point.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np
from numba import types

from core.compiled import kernel
from core.double_double import dd_add, two_prod
from core.errors import InvalidParameter
from core.quantities import Duration
from core.systems.methods.method import Leg, Marching, Units
from core.systems.system import Floats, Integers, System

_doubles = types.float64[::1]
_integers = types.int64[::1]


def march_by(law: Any) -> Any:
    """Return the signature of a compiled march by a law of motion that is itself compiled with the signature `law`.

    Its arguments are (law, begin, step, count, state, parameters, samples to be filled in, tally). `begin`, `step` and
    `count` hold the start, the signed length and the number of the steps of each interval. The result is the number of
    samples that were reached. ``tally[0]`` holds the evaluations that are left beyond the declared ones, and is counted
    down by methods that need such; ``tally[1]`` says why a march stopped early; ``tally[2]`` holds the declared
    evaluations of each step.

    Every method has the two loops of its march to itself: handing a step and its arrays to a common march was measured
    to cost 5 to 30 ns a step, where a step of forward Euler takes 9.
    """
    samples = types.float64[:, ::1]
    return types.int64(types.FunctionType(law), _doubles, _doubles, _integers, _doubles, _doubles, samples, _integers)


OVERFLOW, NO_CONVERGENCE, OUT_OF_BUDGET = 1, 2, 3


@kernel(types.float64(_doubles, types.float64, _doubles, _doubles, _integers))
def plan(targets: Floats, step: float, begin: Floats, length: Floats, count: Integers) -> float:
    """Lay out the steps to `targets` and return their number; stop at an interval that needs more than 2**53."""
    now, tail, total = 0.0, 0.0, 0.0
    for i in range(targets.size):
        distance = (targets[i] - now) - tail
        # Four roundings are what a time and its predecessor may each be off when they come from start + i * spacing.
        slack = 4 * 2.220446049250313e-16 * abs(targets[i])
        begin[i] = now
        if abs(distance) <= slack:
            length[i], count[i] = 0.0, 0
            continue
        if abs(abs(distance) - step) <= slack:
            needed, size = 1.0, math.copysign(step, distance)
        else:
            needed = max(1.0, np.ceil((abs(distance) - slack) / step))
            if not needed <= 9007199254740992.0:
                return float(needed)
            whole = abs(abs(distance) - needed * step) <= slack
            size = math.copysign(step if whole else abs(distance) / needed, distance)
        length[i] = size
        count[i] = int(needed)
        total += needed
        covered, rest = two_prod(size, needed)
        now, tail = dd_add(now, tail, covered, rest)
    return total


@kernel(types.boolean(_doubles, types.int64, types.float64[:, ::1]))
def keep(state: Floats, i: int, samples: Floats) -> bool:
    """Store a state as a sample and tell whether all of it is finite."""
    finite = True
    for k in range(state.size):
        samples[i, k] = state[k]
        finite = finite and math.isfinite(state[k])
    return finite


class FixedStep(Marching):
    """Base of the methods with a fixed step.

    A subclass gives its compiled march and the evaluations that each step needs at least; the base plans the steps,
    refuses what is over the budget before running it, and counts.
    """

    step: Duration
    setting: ClassVar[str] = "step"

    def finer(self) -> Halved:
        """Return the same method with every step halved.

        That is not half the `step`: where samples lie closer than the step, they rule, and halving it changes nothing.
        """
        return Halved(self)

    @abstractmethod
    def _evaluations_per_step(self, system: System) -> int:
        """Return the evaluations that every step needs, as long as iterations need no more."""

    @abstractmethod
    def _compiled(self) -> Any:
        """Return the compiled march, to be called as `march_by` says."""

    def _law(self, system: System) -> Any:
        """Return what the march evaluates: the equation of motion, unless the method goes by another law.

        Raises
        ------
        NotApplicable
            If the system has no such law.
        """
        return system.equation

    def _march(self, system: System, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        return self._march_divided(system, start, targets, limit, units, 1)

    def _march_divided(
        self, system: System, start: Floats, targets: Floats, limit: int, units: Units, parts: int
    ) -> Leg:
        """March as `_march` does, with every planned step divided into `parts`."""
        begin, length = np.empty_like(targets), np.empty_like(targets)
        count = np.empty(targets.size, np.int64)
        steps = parts * plan(targets, units.duration(self.step), begin, length, count)
        each = self._evaluations_per_step(system)
        if steps * each > limit:
            raise self._over_budget(steps * each, limit)
        length /= parts
        count *= parts
        declared = int(steps) * each
        samples = np.empty((targets.size, start.size))
        tally = np.array([limit - declared, 0, each])
        march = self._compiled()
        reached = march(self._law(system), begin, length, count, start.copy(), system.parameters, samples, tally)
        if tally[1]:
            time = units.given_time(float(targets[reached]))
            raise self._failure(int(tally[1]), time, int(count[:reached].sum()) / steps, limit)
        return Leg(samples, limit - int(tally[0]), int(steps), 0)

    def _failure(self, why: int, time: float, fraction: float, limit: int) -> Exception:
        if why == OVERFLOW:
            return self._overflow(time, "use a smaller step, or a method of higher order")
        if why == NO_CONVERGENCE:
            rule = f"be small enough that the implicit step can be iterated; it could not before t = {time:.6g} s"
            return InvalidParameter(self.setting, rule, remedy="use a smaller step, or radau")
        return self._out_of_budget(limit, limit, fraction)


class Halved(Marching):
    """A method with a fixed step, each of whose steps is taken as two."""

    setting: ClassVar[str] = "step"

    def __init__(self, method: FixedStep) -> None:
        self.method, self.kind = method, method.kind

    def finer(self) -> None:
        """Return None: it is there to compare with, not to go on from."""
        return None

    def _march(self, system: System, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        return self.method._march_divided(system, start, targets, limit, units, 2)

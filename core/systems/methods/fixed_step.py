"""Methods whose step is chosen by the client: the grid that they march on, samples between its points, and their base.

A method marches in steps of the chosen length from the initial state, forwards and backwards in time, and nothing else
moves the march: its states at the grid points n h are the same whatever times are asked for. A time that is a grid
point up to its own rounding is answered with the state there. A time between two grid points is answered by the
method's own continuous extension: one further step, of the remaining length, from the grid point before it. Such a step
has the local error of the method, so that samples keep its order, and it conserves what every step of the method does;
the march goes on from the grid point as if it had not been taken. The state of a system with constraints is projected
onto them after every step.

References
----------
E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993, section II.6
(continuous extensions).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import types

from core.arrays import Floats, Integers
from core.compiled import entry, kernel
from core.double_double import two_prod
from core.errors import InvalidParameter
from core.quantities import Duration
from core.systems.methods.method import Leg, Marching, Units
from core.systems.system import DISCRETE_STEP, PART_FLOW, PROJECTION, VECTOR_FIELD, InitialValueProblem, unconstrained

_doubles = types.float64[::1]
_integers = types.int64[::1]
_table = types.float64[:, ::1]
_counts = types.int64[:, ::1]


def steps_by(law: Any) -> Any:
    """Return the signature of a method's compiled steps by a law of motion that is compiled with the signature `law`.

    Its arguments are (law, projection, start, step, count, carried, work, parameters, tally): `count` steps of the
    signed length `step` from the time `start`. The rows of `carried` go from step to step, the first of them is the
    state; those of `work` are scratch. The projection puts the state onto the constraints after each step, if
    ``tally[2]`` says there are any. ``tally[0]`` holds the evaluations that are left beyond the declared ones, and is
    counted down by methods that need such; ``tally[1]`` holds the declared evaluations of each step. The result is 0,
    or why the steps end early.
    """
    return types.int64(
        types.FunctionType(law),
        types.FunctionType(PROJECTION),
        types.float64,
        types.float64,
        types.int64,
        _table,
        _table,
        _doubles,
        _integers,
    )


def _march_by(law: Any) -> Any:
    """Return the signature of the march whose steps go by a law of motion of the signature `law`."""
    return types.int64(
        types.FunctionType(steps_by(law)),
        types.FunctionType(law),
        types.FunctionType(PROJECTION),
        _table,
        _table,
        _counts,
        _table,
        _table,
        _doubles,
        _table,
        _integers,
    )


OVERFLOW, NO_CONVERGENCE, OUT_OF_BUDGET = 1, 2, 3


@kernel()
def lay_out(targets: Floats, step: float, parts: int, begin: Floats, length: Floats, count: Integers) -> float:
    """Lay out the steps to `targets`, of one sign and growing magnitude, and return their number.

    Each step is divided into `parts`. With more than 2**53 steps the layout is not complete: they cannot be numbered.
    """
    done, further = 0.0, 0.0
    for i in range(targets.size):
        distance = abs(targets[i])
        whole = np.floor(distance / step)
        if not whole <= 9007199254740992.0:
            return float(parts * whole)
        # Four roundings are what a time may be off that comes from start + i * spacing.
        slack = 4 * 2.220446049250313e-16 * distance
        covered, rest = two_prod(whole, step)
        left = (distance - covered) - rest
        if left >= step - slack:
            whole, left = whole + 1.0, 0.0
        elif left <= slack:
            # Also where the quotient was rounded up to the next grid point.
            left = 0.0
        signed = math.copysign(step, targets[i])
        begin[i, 0], length[i, 0], count[i, 0] = done * signed, signed / parts, parts * int(whole - done)
        begin[i, 1], length[i, 1], count[i, 1] = whole * signed, math.copysign(left, targets[i]) / parts, 0
        if left > 0.0:
            count[i, 1] = parts
            further += parts
        done = whole
    return parts * done + further


@entry(*(_march_by(law) for law in (VECTOR_FIELD, PART_FLOW, DISCRETE_STEP)))
def _march(
    advance: Any,
    law: Any,
    project: Any,
    begin: Floats,
    step: Floats,
    count: Integers,
    carried: Floats,
    work: Floats,
    parameters: Floats,
    samples: Floats,
    tally: Integers,
) -> int:
    """March over the samples and return how many were reached; ``tally[3]`` says why it stopped early.

    `begin`, `step` and `count`, shape (n, 2), hold for each sample the start, the signed length and the number of two
    runs of steps: along the grid, and from the grid to the sample. The march goes on from the state between the two.
    """
    for i in range(len(count)):
        tally[3] = advance(law, project, begin[i, 0], step[i, 0], count[i, 0], carried, work, parameters, tally)
        if tally[3]:
            return i
        grid = carried.copy()
        if count[i, 1]:
            tally[3] = advance(law, project, begin[i, 1], step[i, 1], count[i, 1], carried, work, parameters, tally)
            if tally[3]:
                return i
        finite = True
        for k in range(samples.shape[1]):
            samples[i, k] = carried[0, k]
            finite = finite and math.isfinite(carried[0, k])
        if not finite:
            tally[3] = OVERFLOW
            return i
        for r in range(carried.shape[0]):
            for k in range(carried.shape[1]):
                carried[r, k] = grid[r, k]
    return len(count)


ONE_STEP = (
    "By the method's own continuous extension: one further step, of the remaining length, from the grid point before "
    "the sample. It has the order and the invariants of the method, and the march goes on from the grid point."
)
"""How these methods sample between the points of their grid."""


@dataclass(frozen=True)
class FixedStep(Marching):
    """Base of the methods with a fixed step.

    A subclass gives its compiled steps and the evaluations that each step needs at least; the base lays out the steps,
    refuses what is over the budget before running it, and counts.

    Attributes
    ----------
    compiled : callable
        The compiled steps, to be called as `steps_by` says.
    evaluations : int
        What every step needs, as long as iterations need no more.
    work_vectors : int
        How many vectors of the state's size a step needs as scratch.
    """

    step: Duration
    setting: ClassVar[str] = "step"
    between_steps: ClassVar[str] = ONE_STEP
    compiled: ClassVar[Any]
    evaluations: ClassVar[int] = 1
    work_vectors: ClassVar[int] = 0

    @property
    def grid_step(self) -> float:
        """Length of the steps of the grid (s)."""
        return self.step

    def finer(self) -> Halved:
        """Return the same method with every step taken as two, those from grid points to samples too.

        That is not the method with half the `step`, by which a sample within the first half of the first step would be
        reached in the same single step.
        """
        return Halved(self)

    def _evaluations_per_step(self, system: InitialValueProblem) -> int:
        """Return `evaluations`, unless they depend on the system."""
        return self.evaluations

    def _carried(self, system: InitialValueProblem, start: Floats) -> tuple[Floats, int]:
        """Return what the first step starts from, with the state as its first row, and the evaluations it took."""
        return start[None].copy(), 0

    def _law(self, system: InitialValueProblem) -> Any:
        """Return what the steps evaluate: the equation of motion, unless the method goes by another law.

        Raises
        ------
        NotApplicable
            If the system has no such law.
        """
        return system.equation

    def _march(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        return self._march_divided(system, start, targets, limit, units, 1)

    def _march_divided(
        self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units, parts: int
    ) -> Leg:
        """March as `_march` does, with every step divided into `parts`."""
        shape = (targets.size, 2)
        begin, length, count = np.empty(shape), np.empty(shape), np.empty(shape, np.int64)
        law = self._law(system)
        total = lay_out(targets, units.duration(self.step), parts, begin, length, count)
        each = self._evaluations_per_step(system)
        if total * each > limit:
            raise self._over_budget(total * each, limit)
        declared = int(total) * each
        samples = np.empty((targets.size, start.size))
        projection = system.structure.projection
        carried, spent = self._carried(system, start)
        work = np.empty((self.work_vectors, start.size))
        tally = np.array([limit - declared - spent, each, projection is not unconstrained, 0])
        reached = _march(
            self.compiled, law, projection, begin, length, count, carried, work, system.parameters, samples, tally
        )
        if tally[3]:
            time = units.given_time(float(targets[reached]))
            raise self._failure(int(tally[3]), time, int(count[:reached].sum()) / total, limit)
        return Leg(samples, limit - int(tally[0]), int(count[:, 0].sum()), 0)

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
    between_steps: ClassVar[str] = ONE_STEP

    def __init__(self, method: FixedStep) -> None:
        self.method, self.kind = method, method.kind

    @property
    def grid_step(self) -> float:
        """Length of the steps of the grid (s)."""
        return 0.5 * self.method.step

    def finer(self) -> None:
        """Return None: it is there to compare with, not to go on from."""
        return None

    def _march(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        return self.method._march_divided(system, start, targets, limit, units, 2)

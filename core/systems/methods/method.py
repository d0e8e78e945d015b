"""What every method is: a question's choice of how to compute a motion, with its order, its family and its work."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from numba import types

from core.arrays import Floats
from core.compiled import entry
from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.quantities import check
from core.systems.budget import Budget
from core.systems.system import PROJECTION, InitialValueProblem, unconstrained
from core.systems.trajectory import Work
from core.work import WorkLimitReached, remaining, spend

Family = Literal["closed form", "explicit", "implicit", "structure-preserving"]
Invariance = Literal["every first integral", "quadratic invariants", "invariants of every part", "time symmetry"]

EXTREME = 300
"""Exponents of two beyond which states are brought near one: cubes of what lies within stay doubles."""

PROJECTED = (
    "The state is projected onto the constraints after every step, and so are samples. The order remains; of what the "
    "method preserves otherwise, nothing is promised."
)
"""What methods do that march by the equation of motion alone."""

LONGEST, SHORTEST = float(np.finfo(np.float64).max), float(np.finfo(np.float64).smallest_subnormal)


@dataclass(frozen=True, eq=False)
class Integration:
    """What a method returns.

    Attributes
    ----------
    states : ndarray, shape (n, k)
        One finite row per requested time, in the order of the request.
    work : Work
    """

    states: Floats
    work: Work


class AbstractMethod(ABC):
    """A method with its setting.

    Subclasses are frozen dataclasses with a field `kind`, by which requests tell them apart, and at most one other
    field, the setting.

    Attributes
    ----------
    order : int or None
        The error falls with this power of the step (of the mean step, for methods that choose their steps);
        None if it has no fixed order.
    family : str
        ``"closed form"``, ``"explicit"``, ``"implicit"`` or ``"structure-preserving"``.
    preserves : tuple of str
        What the method keeps to round-off, whatever its step.
    between_steps : str
        How samples come about whose times lie between the ends of steps.
    on_constraints : str
        How constraints, such as those of a described scene, are enforced.
    when_to_use : str
        One sentence.
    """

    kind: str
    order: ClassVar[int | None]
    family: ClassVar[Family]
    preserves: ClassVar[tuple[Invariance, ...]] = ()
    between_steps: ClassVar[str]
    on_constraints: ClassVar[str] = "Not for systems with constraints."
    when_to_use: ClassVar[str]

    def __post_init__(self) -> None:
        check(self)

    @classmethod
    def is_installed(cls) -> bool:
        """Return whether what the method runs on is installed."""
        return True

    @abstractmethod
    def integrate(self, system: InitialValueProblem, times: Floats, budget: Budget | None = None) -> Integration:
        """Return the states of `system` at `times`.

        Parameters
        ----------
        system : InitialValueProblem
        times : ndarray, shape (n,)
            Measured from the initial state, of either sign, in any order, repeated or not (s).
        budget : Budget, optional
            Evaluations that may be spent; the default of `Budget` if omitted.

        Raises
        ------
        BudgetExceeded
            Before running where the work can be predicted, otherwise as soon as the limit is met.
        NotApplicable
            If the system lacks what the method needs.
        InvalidParameter
            If the method fails with this setting: the states overflow, an implicit equation has no solution that
            iteration finds, the step shrinks below the resolution of time. A failure of the method does not end the
            motion, so it is an error and no event: no sample of such a run is handed on.
        """

    @abstractmethod
    def finer(self) -> AbstractMethod | None:
        """Return the same method made clearly more accurate at every place, None if it cannot be."""

    def coarser(self) -> AbstractMethod | None:
        """Return the same method made clearly less accurate, None if it cannot be; asked where `finer` has none."""
        return None


@entry(types.void(types.FunctionType(PROJECTION), types.float64[:, ::1], types.float64[::1]))
def _project(projection: Any, states: Floats, parameters: Floats) -> None:
    """Put samples onto the constraints, which what lies between steps leaves."""
    for s in range(states.shape[0]):
        projection(states[s], parameters)


class Leg(NamedTuple):
    """The part of an integration on one side of the start."""

    states: Floats
    evaluations: int
    steps: int
    rejected: int


class Units(NamedTuple):
    """Powers of two by which states and times are divided, so that products of extreme states stay doubles.

    Attributes
    ----------
    state, time : int
        Exponents; zero unless the start is extreme and the system says how its motion scales.
    """

    state: int = 0
    time: int = 0

    @classmethod
    def of(cls, system: InitialValueProblem, start: Floats) -> Units:
        """Return the units for a start: those in which its largest component is about one, where it is extreme."""
        exponent = math.frexp(float(np.abs(start).max()))[1]
        degree = system.structure.degree
        if degree is None or abs(exponent) <= EXTREME:
            return cls()
        return cls(exponent, -exponent * (degree - 1))

    def states(self, given: Floats) -> Floats:
        """Return states in these units."""
        return np.ldexp(given, -self.state) if self.state else given

    def given_states(self, states: Floats) -> Floats:
        """Return states in the units of the question."""
        return np.ldexp(states, self.state) if self.state else states

    def times(self, given: Floats) -> Floats:
        """Return times in these units; beyond the range of doubles they are infinite or zero."""
        if not self.time:
            return given
        with np.errstate(over="ignore", under="ignore"):
            return np.ldexp(given, -self.time)

    def duration(self, given: float) -> float:
        """Return a positive duration in these units, a double that is neither zero nor infinite."""
        return max(min(float(self.times(np.array([given]))[0]), LONGEST), SHORTEST) if self.time else given

    def given_time(self, time: float) -> float:
        """Return a time in the units of the question."""
        return math.ldexp(time, self.time)


class Marching(AbstractMethod):
    """Base of the methods that march from the initial state, out to either side of it.

    It sorts the times and counts; a subclass marches to targets that it meets in order. Times are visited once each,
    so repeated times cost nothing and the order of the request changes no sample.
    """

    setting: ClassVar[str]

    @property
    def grid_step(self) -> float | None:
        """Length of the steps (s), None for methods that choose them."""
        return None

    def integrate(self, system: InitialValueProblem, times: Floats, budget: Budget | None = None) -> Integration:
        """Return the states of `system` at `times`; see `AbstractMethod.integrate`."""
        budget = budget or Budget()
        start = np.ascontiguousarray(system.initial_state, dtype=np.float64)
        units = Units.of(system, start)
        begin, times = units.states(start), units.times(times)
        self._require_finite_start(system, begin)
        if not np.isfinite(times).all():
            # So many turns that not even their number is a double.
            raise self._over_budget(math.inf, budget.evaluations)
        states = np.empty((times.size, start.size))
        states[times == 0.0] = begin
        allowed = budget.evaluations // system.structure.weight
        evaluations = steps = rejected = 0
        for side in (np.flatnonzero(times > 0.0), np.flatnonzero(times < 0.0)):
            if not side.size:
                continue
            # A slice where it can be: numpy copies rows by index ten times slower.
            run = side[-1] - side[0] + 1 == side.size
            place = slice(side[0], side[-1] + 1) if run else side
            targets, rows = _outwards(times[place])
            leg = self._limited(system, begin, targets, allowed - evaluations, units)
            states[place] = leg.states if rows is None else leg.states[rows]
            evaluations += leg.evaluations
            steps += leg.steps
            rejected += leg.rejected
        if system.structure.projection is not unconstrained:
            _project(system.structure.projection, states, system.parameters)
            lost = ~np.isfinite(states).all(axis=1)
            if lost.any():
                raise self._off_constraints(units.given_time(float(np.abs(times[lost]).min())))
        return Integration(
            units.given_states(states), Work(times.size, evaluations, steps, rejected, step=self.grid_step)
        )

    def _limited(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        """March within the work that may be done here as well as within the budget."""
        weight = system.structure.weight
        left = remaining() / weight
        try:
            leg = self._march(system, start, targets, int(min(limit, max(0.0, left))), units)
        except BudgetExceeded:
            if left < limit:
                raise WorkLimitReached from None
            raise
        spend(leg.evaluations * weight)
        return leg

    @abstractmethod
    def _march(self, system: InitialValueProblem, start: Floats, targets: Floats, limit: int, units: Units) -> Leg:
        """Return the states at `targets`, which have one sign, differ, and grow in magnitude; all are in `units`."""

    def _require_finite_start(self, system: InitialValueProblem, start: Floats) -> None:
        slope = np.empty_like(start)
        system.equation(0.0, start, system.parameters, slope)
        if not np.isfinite(slope).all():
            raise NotApplicable(
                "the rate of change of the initial state lies outside the range of double precision",
                path=("kind",),
                remedy="choose units in which it does not, or use the closed form",
            )

    def _overflow(self, time: float, remedy: str) -> InvalidParameter:
        rule = f"be small enough that the states stay in the double range; they left it before t = {time:.6g} s"
        return InvalidParameter(self.setting, rule, remedy=remedy)

    def _off_constraints(self, time: float) -> InvalidParameter:
        rule = f"be small enough that the states stay near the constraints; they left them before t = {time:.6g} s"
        return InvalidParameter(self.setting, rule, remedy=f"use a smaller {self.setting}")

    def _over_budget(self, needed: float, limit: int) -> BudgetExceeded:
        remedy = f"use a larger {self.setting}, or ask for earlier times"
        return BudgetExceeded("evaluations", max(needed, limit + 1.0), limit, path=(self.setting,), remedy=remedy)

    def _out_of_budget(self, spent: int, limit: int, fraction: float) -> BudgetExceeded:
        """Return the refusal of a run that was stopped after a fraction of the way, with the work it would need."""
        return self._over_budget(spent / fraction if fraction > 0 else 0.0, limit)


class StepChoosing(Marching):
    """Base of the methods that choose their steps by a tolerance.

    Attributes
    ----------
    smallest : float
        The smallest tolerance that is admissible.
    """

    tolerance: float
    setting: ClassVar[str] = "tolerance"
    smallest: ClassVar[float]

    def finer(self) -> Self | None:
        """Return the same method with a sixteenth of the tolerance, None where a quarter cannot be had."""
        if self.tolerance < 4 * self.smallest:
            return None
        return replace(self, tolerance=max(self.tolerance / 16, self.smallest))  # type: ignore[type-var]

    def coarser(self) -> Self | None:
        """Return the same method with sixteen times the tolerance, None where that says nothing any more."""
        return replace(self, tolerance=self.tolerance * 16) if self.tolerance < 1 / 16 else None  # type: ignore[type-var]


def _outwards(times: Floats) -> tuple[Floats, np.ndarray[tuple[int], np.dtype[np.intp]] | None]:
    """Return the distinct times by growing magnitude, and for each of `times` its place among them."""
    if (np.diff(np.abs(times)) > 0).all():
        return np.ascontiguousarray(times), None
    distinct, rows = np.unique(np.abs(times), return_inverse=True)
    return np.copysign(distinct, times[0]), rows

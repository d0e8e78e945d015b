"""Error against cost: what each method, with each setting, makes of one question.

Errors are measured against the closed form where there is one, otherwise against what the system itself knows of its
motion (`KnownMotion`), otherwise against an integrator at the end of double precision, whose own estimated error is
added. Costs are counted, which is the same on every machine, and on request timed as well. The conventions are those of
work-precision diagrams: the reference is far below the tightest error, times are medians of repeated runs, and a method
that fails with a setting is listed with its reason.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from core.arrays import Floats
from core.errors import AccuracyUnreachable, InvalidParameter, MechanicsError
from core.systems.budget import Budget
from core.systems.error_statements import bound_of, drifts, estimated, known_norm, measured
from core.systems.methods import (
    ClosedFormEvaluation,
    DiscreteMoserVeselov,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Method,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.methods.dormand_prince_853 import SMALLEST_TOLERANCE
from core.systems.methods.from_scipy import has_scipy
from core.systems.solve import checked_times
from core.systems.system import InitialValueProblem

STEPS_PER_OWN_TIME = tuple(4 * 2**k for k in range(9))
TOLERANCES = tuple(10.0**-k for k in range(3, 15, 2))
SCIPY_TOLERANCES = tuple(10.0**-k for k in range(3, 10, 2))
DEFAULT_RUNS = 1 + 5 * len(STEPS_PER_OWN_TIME) + len(TOLERANCES) + 2 * len(SCIPY_TOLERANCES)
"""How many methods and settings `default_methods` has at most."""
LARGEST_FITTED = 0.1
"""Above this the error has not yet begun to fall with its order."""
ABOVE_FLOOR = 10.0
"""Errors within this factor of the floor hold round-off, and are not fitted."""


@runtime_checkable
class KnownMotion(InitialValueProblem, Protocol):
    """A system without a closed form whose motion is known better than an integrator would find it."""

    def reference(self, times: Floats) -> tuple[str, Floats, float]:
        """Return how the motion is known, its states at times of shape (t,), and their largest error as a norm."""


@dataclass(frozen=True)
class Measurement:
    """One method with one setting.

    Attributes
    ----------
    method : Method
    error, final_error : float or None
        Largest norm of any sample's error, and of the one farthest from the start, relative to the largest norm of the
        whole motion, as in `core.systems.trajectory.Accuracy`. None if the method failed.
    component_errors : tuple of float
        Largest error of each component, relative to the largest magnitude that this component takes.
    drifts : dict of str to float
        Of the conserved quantities: not an error.
    evaluations, steps : int
    seconds : float or None
        Median; None if nothing was timed.
    failure : str or None
        Why there is no answer.
    """

    method: Method
    error: float | None = None
    final_error: float | None = None
    component_errors: tuple[float, ...] = ()
    drifts: dict[str, float] | None = None
    evaluations: int = 0
    steps: int = 0
    seconds: float | None = None
    failure: str | None = None


@dataclass(frozen=True)
class Curve:
    """All settings of one method, cheapest first.

    Attributes
    ----------
    kind : str
    declared_order : int or None
    fitted_order : float or None
        Slope of the logarithm of the error over that of the steps, between the coarse settings and the floor; None with
        fewer than two settings there.
    floor : float or None
        Round-off floor: the smallest error, where more work brings none smaller; None if it was not met.
    measurements : tuple of Measurement
    """

    kind: str
    declared_order: int | None
    fitted_order: float | None
    floor: float | None
    measurements: tuple[Measurement, ...]


@dataclass(frozen=True)
class Recommendation:
    """The cheapest setting that was measured to reach the accuracy, or None with what was reached at best."""

    method: Method | None
    reason: str


@dataclass(frozen=True)
class WorkPrecision:
    """Error against cost on one question.

    Attributes
    ----------
    reference : str
        ``"closed form"``, ``"pairs of doubles"``, or the kind of the integrator that stood in for them.
    reference_error : float
        Contained in every error that is stated.
    curves : tuple of Curve
    pareto_front : tuple of Measurement
        Those that no other beats in both error and evaluations, cheapest first.
    recommendation : Recommendation
    """

    reference: str
    reference_error: float
    curves: tuple[Curve, ...]
    pareto_front: tuple[Measurement, ...]
    recommendation: Recommendation


def work_precision(
    system: InitialValueProblem,
    times: ArrayLike,
    methods: Sequence[Method] | None = None,
    *,
    accuracy: float = 1e-9,
    repeats: int = 0,
    budget: Budget | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> WorkPrecision:
    """Measure methods on one question.

    Parameters
    ----------
    system : InitialValueProblem
    times : array_like, shape (n,)
        As in `solve`.
    methods : sequence of Method, optional
        With their settings, in any order; a ladder of every method that the system admits if omitted.
    accuracy : float
        What the recommendation is for.
    repeats : int
        How often each run is timed; nothing is if 0, and the result is the same whenever it is asked for.
    budget : Budget, optional
        For every single run. One that exceeds it is listed as failed.
    clock : callable
        Returns seconds.

    Raises
    ------
    InvalidParameter
        For times as in `solve`, no methods at all, or one with the same settings twice.
    AccuracyUnreachable
        If no reference can be had.
    """
    budget = budget or Budget()
    instants = checked_times(times, budget)
    chosen = default_methods(system, instants) if methods is None else tuple(methods)
    check_distinct(chosen)
    reference = _reference(system, instants, budget)
    found = [_measure(system, instants, method, reference, repeats, budget, clock) for method in chosen]
    ordered = sorted(found, key=lambda one: (one.method.kind, one.evaluations, -(one.error or math.inf)))
    curves = tuple(_curve(kind, tuple(group)) for kind, group in groupby(ordered, key=lambda one: one.method.kind))
    return WorkPrecision(reference.kind, reference.error, curves, pareto_front(found), _recommended(found, accuracy))


def check_distinct(methods: Sequence[Method]) -> None:
    """Raise `InvalidParameter` for no methods at all, or one with the same settings twice."""
    if not methods:
        raise InvalidParameter(
            "methods", "name at least one method", remedy="leave it out for a ladder of every method"
        )
    for k, method in enumerate(methods):
        if method in methods[:k]:
            rule = f"differ from methods/{methods.index(method)}, which is the same method with the same settings"
            raise InvalidParameter(
                ("methods", k), rule, remedy="give each setting once; repeats says how often it is timed"
            )


def default_methods(system: InitialValueProblem, times: Floats) -> tuple[Method, ...]:
    """Return every method that is installed and that the system admits, with a ladder of settings.

    Steps are fractions of the motion's own time, the size of the state over its rate of change, or of the horizon where
    that is shorter or the start is at rest.
    """
    slope = np.empty_like(system.initial_state)
    system.equation(0.0, system.initial_state, system.parameters, slope)
    size, speed = float(np.abs(system.initial_state).max()), float(np.abs(slope).max())
    horizon = float(np.abs(times).max()) or 1.0
    own = min(size / speed, horizon) if size > 0.0 and speed > 0.0 else horizon
    found: list[Method] = [] if system.closed_form() is None else [ClosedFormEvaluation()]
    for number in STEPS_PER_OWN_TIME:
        step = own / number
        found += [ExplicitEuler(step), RungeKutta4(step), ImplicitMidpoint(step)]
        if system.structure.splitting is not None:
            found.append(SymmetricSplitting(step))
        if system.structure.discrete is not None:
            found.append(DiscreteMoserVeselov(step))
    found += [DormandPrince853(tolerance) for tolerance in TOLERANCES]
    if has_scipy():
        for tolerance in SCIPY_TOLERANCES:
            found += [Lsoda(tolerance), Radau(tolerance)]
    return tuple(found)


def pareto_front(measurements: Sequence[Measurement]) -> tuple[Measurement, ...]:
    """Return those that no other beats in both error and evaluations, cheapest first."""
    front: list[Measurement] = []
    best = math.inf
    for one in sorted(measurements, key=lambda one: (one.evaluations, one.error or 0.0)):
        if one.error is not None and one.error < best:
            front.append(one)
            best = one.error
    return tuple(front)


class _Reference(NamedTuple):
    """States to compare with, what they may be wrong by, and the norm that errors are relative to."""

    kind: str
    states: Floats
    error: float
    largest_norm: float


def _reference(system: InitialValueProblem, times: Floats, budget: Budget) -> _Reference:
    exact = system.closed_form()
    if exact is not None:
        return _Reference("closed form", exact.sample(times), bound_of(exact, times), exact.largest_norm)
    if isinstance(system, KnownMotion):
        kind, states, largest = system.reference(times)
        norm = known_norm(states, system.initial_state)
        return _known(_Reference(kind, states, largest / norm if norm > 0.0 else 0.0, norm))
    method = DormandPrince853(10 * SMALLEST_TOLERANCE)
    run = method.integrate(system, times, budget)
    error = estimated(method, system, times, run, budget, run.work.evaluations).errors.largest
    return _known(_Reference(method.kind, run.states, error, known_norm(run.states, system.initial_state)))


def _known(reference: _Reference) -> _Reference:
    if reference.error > LARGEST_FITTED:
        raise AccuracyUnreachable(
            LARGEST_FITTED,
            reference.error,
            "no reference can be had this far from the start",
            path=("times",),
            remedy="ask for earlier times",
        )
    return reference


def _measure(
    system: InitialValueProblem,
    times: Floats,
    method: Method,
    reference: _Reference,
    repeats: int,
    budget: Budget,
    clock: Callable[[], float],
) -> Measurement:
    try:
        run = method.integrate(system, times, budget)
        # The closed form is not measured against itself: its error is its own bound, which is all that is added.
        errors = measured(run.states, reference.states, times, reference.largest_norm).beyond(reference.error)
    except MechanicsError as fault:
        return Measurement(method, failure=fault.detail)
    seconds = []
    for _ in range(repeats):
        start = clock()
        method.integrate(system, times, budget)
        seconds.append(clock() - start)
    return Measurement(
        method,
        errors.largest,
        errors.final,
        errors.components,
        drifts(system, run.states),
        run.work.evaluations,
        run.work.steps,
        statistics.median(seconds) if seconds else None,
    )


def _curve(kind: str, measurements: tuple[Measurement, ...]) -> Curve:
    order = measurements[0].method.order
    points = [(one.steps, one.error) for one in measurements if one.error is not None and one.steps > 0]
    floor = _floor(points, order)
    lowest = ABOVE_FLOOR * floor if floor is not None else 0.0
    fitted = [(steps, error) for steps, error in points if lowest < error < LARGEST_FITTED]
    slope = None
    if len({steps for steps, _ in fitted}) > 1:
        logarithms = np.log(np.array(fitted))
        slope = -float(np.polyfit(logarithms[:, 0], logarithms[:, 1], 1)[0])
    return Curve(kind, order, slope, floor, measurements)


def _floor(points: list[tuple[int, float]], order: int | None) -> float | None:
    """Return the smallest error if the last (steps, error), the points being listed by steps, no longer falls.

    It should fall with the order; it is taken to have stopped where it does not do so with half of it.
    """
    if len(points) < 2 or points[-1][1] > LARGEST_FITTED:
        return None
    (steps, error), (last_steps, last_error) = min(points[:-1], key=lambda point: point[1]), points[-1]
    expected = (steps / last_steps) ** ((order or 1) / 2)
    return min(error, last_error) if last_error > expected * error else None


def _recommended(measurements: Sequence[Measurement], accuracy: float) -> Recommendation:
    reached = [one for one in measurements if one.error is not None and one.error <= accuracy]
    if not reached:
        best = min((one.error for one in measurements if one.error is not None), default=math.inf)
        return Recommendation(None, f"no setting reached {accuracy:.3g}; the smallest error was {best:.3g}")
    timed = all(one.seconds is not None for one in reached)
    cheapest = min(reached, key=lambda one: (one.seconds if timed and one.seconds is not None else 0, one.evaluations))
    why = "in the shortest median time" if timed else "with the fewest evaluations"
    reason = f"{cheapest.method.kind} reached {cheapest.error:.3g}, where {accuracy:.3g} was asked for, {why}"
    return Recommendation(cheapest.method, reason)

"""The period of a free body as an experiment: integrate until the motion is back near its start, compare with theory.

The first return to a ball around the start is not the period. It differs by three amounts that add up exactly: the ball
is entered early, the grid of samples sees it late, and the method is not where the motion is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Annotated

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, MechanicsError
from core.quantities import Duration, Quantity, Unit, check
from core.rotation.free_rotation import FreeRotation
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.error_statements import bound_of, drifts, measured
from core.systems.methods import Method
from core.systems.trajectory import Work
from core.work import spend

SampleCount = Annotated[int, Quantity("1", at_least=3, at_most=10**9)]
Distance = Annotated[float, Quantity("rad s^-1", above=0)]


@dataclass(frozen=True)
class Measure:
    """How the period is to be measured.

    Attributes
    ----------
    method : Method
        Of integration.
    duration : float
        Of the experiment, from the given state (s).
    samples : int
        Equally spaced over the duration, both ends included.
    tolerance : float
        The motion has returned when its angular velocity is nearer to the initial one than this (rad/s).
    """

    method: Method
    duration: Duration
    samples: SampleCount
    tolerance: Distance

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Crossing:
    """Where the method's samples cross, on the first return, the plane through the start across the initial motion.

    Attributes
    ----------
    time : float
        The period that the method itself has (H. Poincaré's return time), by linear interpolation (s).
    distance : float
        How far it misses the start (rad/s).
    """

    time: Annotated[float, Unit("s")]
    distance: Annotated[float, Unit("rad s^-1")]


@dataclass(frozen=True)
class MeasuredPeriod:
    """What the experiment found, and why it differs from theory.

    Attributes
    ----------
    time : float or None
        Of the first sample within the tolerance after the motion had left it; None if there is none (s).
    grid_point : int or None
        Number of that sample, the start being 0.
    theory : float or None
        The period; None if the motion has none (s).
    relative_difference : float or None
        ``time/theory - 1``.
    from_tolerance, from_grid, from_method : float or None
        Their sum is ``time - theory``: how much before (negative) the end of the period the true motion comes within
        the tolerance; how much later the next sample is; how much later the method's samples come within it (s).
    crossing : Crossing or None
        The method's own period.
    error : float
        Largest error of the method's samples up to the return (or the end), relative to the largest norm of the whole
        motion.
    drifts : dict
        Largest relative change of energy and momentum over the same samples.
    explanation : str
        All this in words.
    work : Work
        What it cost.
    """

    time: Annotated[float, Unit("s")] | None
    grid_point: int | None
    theory: Annotated[float, Unit("s")] | None
    relative_difference: Annotated[float, Unit("1")] | None
    from_tolerance: Annotated[float, Unit("s")] | None
    from_grid: Annotated[float, Unit("s")] | None
    from_method: Annotated[float, Unit("s")] | None
    crossing: Crossing | None
    error: Annotated[float, Unit("1")]
    drifts: dict[str, Annotated[float, Unit("1")]]
    explanation: str
    work: Work


def measure_period(system: TorqueFree, measure: Measure, budget: Budget | None = None) -> MeasuredPeriod:
    """Integrate, find the first return, compare with the closed form.

    Raises
    ------
    BudgetExceeded
        For more samples or evaluations than one question may have.
    InvalidParameter
        If the method fails with its setting, or the samples are so many that they do not differ.
    AccuracyUnreachable
        If the duration is beyond the reach of the closed form.
    NotApplicable
        If the samples are so far from the motion that their error leaves the range of doubles.
    """
    budget = budget or Budget()
    if measure.samples > budget.samples:
        raise BudgetExceeded(
            "samples", measure.samples, budget.samples, path=("measure", "samples"), remedy="take fewer samples"
        )
    spend(measure.samples)
    times = np.linspace(0.0, measure.duration, measure.samples)
    if times[1] == 0.0:
        raise InvalidParameter(("measure", "duration"), "be long enough for its samples to differ")
    rotation = system.closed_form()
    try:
        exact = rotation.sample(times)
    except AccuracyUnreachable as fault:
        fault.path = ("measure", "duration")
        raise
    try:
        run = measure.method.integrate(system, times, budget)
        distances = _distances(run.states, system.initial_state)
        back = first_return(distances, measure.tolerance)
        seen = slice(0, back + 1 if back is not None else None)
        own = bound_of(rotation, times[seen])
        error = measured(run.states[seen], exact[seen], times[seen], rotation.largest_norm).beyond(own).largest
    except AccuracyUnreachable as fault:
        fault.path = ("measure", "duration")
        raise
    except InvalidParameter as fault:
        raise fault.inside("measure", "method") from fault
    except MechanicsError as fault:
        fault.path = ("measure", "method", *fault.path)
        raise
    exact_back = first_return(_distances(exact, system.initial_state), measure.tolerance)

    theory = rotation.period
    theory = theory if theory is not None and theory < inf else None
    time = float(times[back]) if back is not None else None
    found = MeasuredPeriod(
        time=time,
        grid_point=back,
        theory=theory,
        relative_difference=(time - theory) / theory if time is not None and theory is not None else None,
        from_tolerance=None,
        from_grid=None,
        from_method=None,
        crossing=_crossing(system, times, run.states, back) if back is not None else None,
        error=error,
        drifts=dict(drifts(system, run.states[seen])),
        explanation="",
        work=run.work,
    )
    if time is not None and theory is not None and exact_back is not None:
        entry = _entry(rotation, float(times[exact_back - 1]), float(times[exact_back]), measure.tolerance)
        on_grid = float(times[exact_back])
        found = replace(found, from_tolerance=entry - theory, from_grid=on_grid - entry, from_method=time - on_grid)
    return replace(found, explanation=_in_words(found, measure, distances))


def first_return(distances: Floats, tolerance: float) -> int | None:
    """Return the number of the first sample nearer than `tolerance` after one that was not, None if there is none."""
    left = distances >= tolerance
    if not left.any():
        return None
    out = int(np.argmax(left))
    inside = ~left[out:]
    return out + int(np.argmax(inside)) if inside.any() else None


def _distances(states: Floats, start: Floats) -> Floats:
    # Without squares that leave the range of doubles.
    x, y, z = (states[:, k] - start[k] for k in range(3))
    distances: Floats = np.hypot(np.hypot(x, y), z)
    return distances


def _nearest_again(distances: Floats) -> float | None:
    """Return the least distance after the samples first stopped moving away, None if they never did."""
    approaching = np.diff(distances) < 0.0
    return float(distances[1 + int(np.argmax(approaching)) :].min()) if approaching.any() else None


def _entry(rotation: FreeRotation, outside: float, inside: float, tolerance: float) -> float:
    """Return when the exact motion comes within the tolerance, between two samples, by bisection to the last bit."""
    start = rotation.angular_velocity
    while outside < (middle := 0.5 * (outside + inside)) < inside:
        near = _distances(rotation.sample(np.array([middle])), start)[0] < tolerance
        outside, inside = (outside, middle) if near else (middle, inside)
    return inside


def _crossing(system: TorqueFree, times: Floats, states: Floats, back: int) -> Crossing | None:
    start = system.initial_state
    # Euler's equations are quadratic: the direction of the motion is the same in units that keep them in range.
    unit = float(np.abs(start).max())
    slope = np.empty(3)
    system.equation(0.0, start / unit, system.parameters, slope)
    ahead = ((states - start) / unit) @ (slope / np.abs(slope).max())
    k = back
    while 0 < k < ahead.size - 1 and not ahead[k - 1] < 0.0 <= ahead[k]:
        k += 1 if ahead[k] < 0.0 else -1
    if not ahead[k - 1] < 0.0 <= ahead[k]:
        return None
    share = float(ahead[k - 1] / (ahead[k - 1] - ahead[k]))
    there = states[k - 1] + share * (states[k] - states[k - 1])
    return Crossing(
        float(times[k - 1] + share * (times[k] - times[k - 1])), float(_distances(there[None, :], start)[0])
    )


def _in_words(found: MeasuredPeriod, measure: Measure, distances: Floats) -> str:
    kind = measure.method.kind
    if found.time is None:
        if not (distances >= measure.tolerance).any():
            return (
                f"No sample is {measure.tolerance:g} rad/s away from the start (the farthest is "
                f"{distances.max():.6g} rad/s), so nothing can return; take a smaller tolerance or a longer duration."
            )
        nearest = _nearest_again(distances)
        if nearest is None:
            return f"The samples of {kind} are still moving away from the start at the end; take a longer duration."
        return (
            f"Having left the start, no sample of {kind} comes within {measure.tolerance:g} rad/s of it again; the "
            f"nearest is {nearest:.6g} rad/s away. "
            + (
                "The motion has no period."
                if found.theory is None
                else f"The period is {found.theory:.10g} s: a longer duration, more samples, a larger tolerance or a "
                "more accurate method may show it."
            )
        )
    said = [
        f"Sample {found.grid_point}, at t = {found.time!r} s, is the first within {measure.tolerance:g} rad/s of the "
        "start."
    ]
    if found.theory is None or found.relative_difference is None:
        said.append("The motion has no period: what came back is the method, or a tolerance that is too large.")
        return " ".join(said)
    difference = found.time - found.theory
    said.append(
        f"The period is {found.theory!r} s: the measurement is {difference:+.4g} s or "
        f"{100 * found.relative_difference:+.3g} % off."
    )
    if found.from_tolerance is None or found.from_grid is None or found.from_method is None:
        said.append("The exact motion, sampled at the same times, does not come back within the tolerance.")
        return " ".join(said)
    later = "later" if found.from_method > 0.0 else "earlier"
    method = (
        f"{abs(found.from_method):.4g} s {later} than the exact motion" if found.from_method else "at that sample too"
    )
    said.append(
        f"Three amounts add up to that. Tolerance: the exact motion enters the ball {-found.from_tolerance:.4g} s "
        f"before its period ends. Grid: the next sample is {found.from_grid:.4g} s after that. Method: {kind} is in it "
        f"{method}."
    )
    largest = max(abs(found.from_tolerance), abs(found.from_grid), abs(found.from_method))
    if abs(difference) < 0.5 * largest:
        said.append("That they nearly cancel is a coincidence, and says nothing of how good the method is.")
    if found.crossing is not None:
        rate = 100.0 * (found.crossing.time / found.theory - 1.0)
        said.append(
            f"By its own rate the method completes the period at {found.crossing.time:.8g} s ({rate:+.2g} %); there it "
            f"misses the start by {found.crossing.distance:.3g} rad/s, its energy having changed by "
            f"{100 * found.drifts['energy']:.3g} % on the way."
        )
    return " ".join(said)

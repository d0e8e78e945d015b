"""A student's samples of a free rotation: how wrong they are, since when, and which integrator they come from.

An integrator of order p has an error proportional to step^p. From one run the step follows for which its error has the
size of the samples' error; for explicit Euler it follows from the energy that the samples gain, too, by its identity
dE = h^2/2 sum I_i f_i^2 for each step. Steps near it (parts of the spacing of the samples, round numbers, and the
number itself) are then run: what explains the error to a thousandth is what the samples are consistent with.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from math import floor, isfinite, log10
from typing import Any

import numpy as np

from core.assessment.compare import Floats
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ExplicitEuler, ImplicitMidpoint, RungeKutta4, SymmetricSplitting

METHODS = (ExplicitEuler, RungeKutta4, ImplicitMidpoint, SymmetricSplitting)

EXPLAINED = 1e-3
"""Share of the error that may be left unexplained by a method that the samples are consistent with."""

ROUNDS = 3
"""Times that a step is corrected by the error that it leads to."""

ALIKE = 0.5
"""Cosine between a method's errors at two steps: near 1 for short ones, where the error is step^p times one function of
time. Errors of another origin are nearly orthogonal to them."""

NEAR = 0.3
"""Share of the error that the best likely step may leave unexplained for a step near it to be looked for."""

ROUNDED = 1e-12
"""Error, of the largest rate, that is explained by rounding."""

LARGEST = np.finfo(np.float64).max.item()

MOST_EVALUATIONS = 200_000
"""Of each run of a method; a step that needs more is not looked for."""


@dataclass(frozen=True)
class Consistent:
    """A method by which the samples come out, confirmed by running it.

    Attributes
    ----------
    method : str
        Kind, or "exact" for samples whose error is that of their rounding.
    step : float or None
        Length of the steps (s).
    unexplained : float
        Largest norm of the difference that is left (rad/s).
    """

    method: str
    step: float | None
    unexplained: float


@dataclass(frozen=True)
class SampleErrors:
    """How wrong samples are.

    Attributes
    ----------
    largest : float
        Largest norm of the error (rad/s).
    final : float
        At the time farthest from the start (rad/s).
    within_until : float or None
        First time, outwards from the start, at which the error is beyond the tolerance (s); None if at none.
    energy_drift, angular_momentum_drift : float or None
        Largest relative change against the start; None at rest.
    """

    largest: float
    final: float
    within_until: float | None
    energy_drift: float | None
    angular_momentum_drift: float | None


def errors_of_samples(system: TorqueFree, times: Floats, rows: Floats, right: Floats, tolerance: float) -> SampleErrors:
    """Return how wrong samples of the angular velocity are.

    Parameters
    ----------
    system : TorqueFree
    times : ndarray, shape (n,)
        In any order (s).
    rows, right : ndarray, shape (n, 3)
        The samples and the exact motion, in body axes (rad/s).
    tolerance : float
        Largest error that is accepted (rad/s).
    """
    errors = _norms(rows - right)
    outwards = np.argsort(np.abs(times), kind="stable")
    beyond = outwards[errors[outwards] > tolerance]
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        momenta = rows @ system.tensor
        start = system.tensor @ system.angular_velocity
        energy = _drift((rows * momenta).sum(axis=1), float(system.angular_velocity @ start))
        momentum = _drift(_norms(momenta), float(np.linalg.norm(start)))
    return SampleErrors(
        float(errors.max()),
        float(errors[outwards[-1]]),
        float(times[beyond[0]]) if beyond.size else None,
        energy,
        momentum,
    )


def _norms(rows: Floats) -> Floats:
    """Return the lengths of rows, at most the largest double: runs with far too long steps grow beyond all bounds."""
    with np.errstate(over="ignore", invalid="ignore"):
        sizes = np.abs(rows).max(axis=1)
        units = np.where(sizes > 0.0, sizes, 1.0)
        norms: Floats = np.nan_to_num(units * np.sqrt(((rows / units[:, None]) ** 2).sum(axis=1)), nan=LARGEST)
    return norms


def _drift(values: Floats, start: float) -> float | None:
    worst = float(np.abs(values / start - 1.0).max()) if start else float("nan")
    return worst if isfinite(worst) else None


def consistent_method(system: TorqueFree, times: Floats, rows: Floats, right: Floats) -> Consistent | None:
    """Return a method that explains samples with an error, the parameters being those of `errors_of_samples`."""
    error = float(_norms(rows - right).max())
    coarse = 2.0 * _resolution(rows)
    if error <= ROUNDED * float(np.abs(right).max()) + coarse:
        return Consistent("exact", None, error)
    for member in METHODS:
        search = _Search(member, system, times, rows, right, EXPLAINED * error + coarse)
        found = search.found()
        if found is not None:
            return found
    return None


class _Search:
    """Looks for the step with which one method gives the samples."""

    def __init__(
        self, member: Any, system: TorqueFree, times: Floats, rows: Floats, right: Floats, enough: float
    ) -> None:
        self._member, self._system, self._times, self._rows, self._right = member, system, times, rows, right
        self._enough, self._tried = enough, dict[float, float]()

    def found(self) -> Consistent | None:
        spacing = _spacing(self._times)
        if spacing == 0.0:
            return None
        error, step = float(_norms(self._rows - self._right).max()), spacing
        for corrected in range(ROUNDS):
            if self._unexplained(step) <= self._enough:
                return self._consistent(step)
            own, alike = self._error(step)
            if not 0.0 < own < float("inf"):
                step /= 8.0
                continue
            step *= (error / own) ** (1.0 / self._member.order)
            if alike < ALIKE:
                # A step that is far too long shows little yet; one of about this error does.
                if corrected:
                    return None
                continue
            for candidate in _candidates(step, spacing):
                if self._unexplained(candidate) <= self._enough:
                    return self._consistent(candidate)
        best = min(self._tried, key=lambda one: self._tried[one])
        if self._tried[best] > NEAR * error:
            return None
        refined = _refined(self._unexplained, best)
        return self._consistent(refined) if self._unexplained(refined) <= self._enough else None

    def _consistent(self, step: float) -> Consistent:
        return Consistent(self._member.kind, step, self._tried[step])

    def _unexplained(self, step: float) -> float:
        if step not in self._tried:
            states = _run(self._member, step, self._system, self._times)
            self._tried[step] = float("inf") if states is None else float(_norms(states - self._rows).max())
        return self._tried[step]

    def _error(self, step: float) -> tuple[float, float]:
        """Return the method's own largest error, and the cosine between its errors and those of the samples."""
        states = _run(self._member, step, self._system, self._times)
        if states is None:
            return 0.0, 0.0
        own, given = states - self._right, self._rows - self._right
        largest = float(_norms(own).max())
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            unit, other = own / largest, given / float(_norms(given).max())
            alike = float((unit * other).sum() / np.sqrt((unit**2).sum() * (other**2).sum()))
        return largest, alike


def _candidates(step: float, spacing: float) -> Iterator[float]:
    """Yield likely steps near one: parts and multiples of the spacing, round numbers, parts of a second, the step."""
    parts = spacing / step
    for count in {max(1, floor(parts) + k) for k in (-1, 0, 1, 2)}:
        yield spacing / count
    if parts < 1.0:
        yield spacing * round(1.0 / parts)
    digit = 10.0 ** (floor(log10(step)) - 1)
    for offset in (-1, 0, 1):
        yield float(f"{(round(step / digit) + offset) * digit:.2g}")
        yield 1.0 / max(1, round(1.0 / step) + offset)
    yield step


def _refined(unexplained: Any, step: float) -> float:
    """Return the step near one that leaves the least unexplained, by golden section."""
    low, high, golden = 0.9 * step, 1.1 * step, 0.6180339887498949
    for _ in range(40):
        left, right = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, right) if unexplained(left) <= unexplained(right) else (left, high)
    best = 0.5 * (low + high)
    return best if unexplained(best) <= unexplained(step) else step


def _run(member: Any, step: float, system: TorqueFree, times: Floats) -> Floats | None:
    if not (step > 0.0 and isfinite(step)):
        return None
    with suppress(MechanicsError):
        # A run of another method than the samples' may leave the range of doubles.
        states: Floats = member(step).integrate(system, times, Budget(evaluations=MOST_EVALUATIONS)).states
        return states if np.isfinite(states).all() else None
    return None


def _spacing(times: Floats) -> float:
    """Return the median distance of neighbouring times, the start among them (s)."""
    apart = np.diff(np.unique(np.append(times, 0.0)))
    return float(np.median(apart)) if apart.size else 0.0


def _resolution(rows: Floats) -> float:
    """Return half a unit of the last decimal place that any of the numbers has, 0 for numbers with all their digits."""
    for places in range(13):
        if np.array_equal(np.round(rows, places), rows):
            return 0.5 * 10.0**-places
    return 0.0

"""The least squares: from several starts where ranges are given, by SciPy's trust-region method with our slopes."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import NotApplicable
from core.fits.problem import Problem
from core.fits.unknowns import Unknown
from core.studies.sobol import SobolPoints
from core.work import spend

UNITS_OF_IMPORT = 20_000
"""Of work (`core.work`): importing takes 0.2 s, which no event loop may wait."""

STARTS = 16
"""Points of the ranges at which the loss is looked at, for each number that has a range."""
MOST_STARTS = 64
FOLLOWED = 3
"""Of these, the best ones from which the least loss is sought."""

SHARES = (0.125, 0.25, 0.5, 1.0)
"""Of the span of the times: rows that are fitted one set after the other where all at once lead nowhere."""
POOR = 4.0
"""Mean square of residuals, in standard deviations, above which the numbers found are not believed to be the best."""
POOR_SHARE = 0.1
"""The same of the square of the spread of the data, where deviations are not known."""

CONVERGED = 1e-10
"""Relative change of the loss, or of the numbers, at which the search ends; polishing follows."""
MOST_EVALUATIONS = 100
POLISHED = 1e-4
"""Last step, in standard errors; what remains is less, and is part of the model's error."""
MOST_POLISHING = 6
LOST = 1e-12
"""Share of a loss below which two losses cannot be told apart: a sum of squares of ten thousand rows rounds by it."""


def scipy_module(name: str) -> Any:
    """Return a module of SciPy.

    Raises
    ------
    NotApplicable
        If SciPy is not installed.
    """
    if f"scipy.{name}" not in sys.modules:
        spend(UNITS_OF_IMPORT)
    try:
        return import_module(f"scipy.{name}")
    except ModuleNotFoundError:
        remedy = "install polhode[scipy]: pip install 'polhode[scipy]'"
        raise NotApplicable("fits need SciPy, which is not installed with this service", remedy=remedy) from None


def starts(problem: Problem, unknown: Sequence[Unknown]) -> list[Floats]:
    """Return the numbers from which to search, the best first.

    Raises
    ------
    MechanicsError
        Why the question has no answer with the given start, where it has none with any.
    """
    ranged = [k for k, one in enumerate(unknown) if one.between is not None]
    if not ranged:
        problem.residuals(problem.start)
        return [problem.start]
    candidates = [problem.start]
    points = SobolPoints(len(ranged), np.random.default_rng(0)).points(0, min(MOST_STARTS, STARTS * len(ranged)))
    for point in points:
        candidate = problem.start.copy()
        for k, share in zip(ranged, point, strict=True):
            low, high = unknown[k].between or (0.0, 0.0)
            candidate[k] = low + share * (high - low)
        candidates.append(candidate)
    costs = [problem.cost(problem.finite_residuals(candidate)) for candidate in candidates]
    if not np.isfinite(costs).any():
        problem.residuals(problem.start)
    order = [k for k in np.argsort(costs, kind="stable").tolist() if np.isfinite(costs[k])]
    return [candidates[k] for k in order[:FOLLOWED]]


def sought(problem: Problem, unknown: Sequence[Unknown]) -> list[tuple[Floats, float]]:
    """Return the numbers of least loss near each start, and their losses, the best first.

    Late rows of a motion that repeats or is chaotic have many minima. Where none that is found explains the data, the
    early rows are fitted first, and their numbers are the start for more.
    """
    begun = starts(problem, unknown)
    ends = [least(problem, one) for one in begun]
    limit = (POOR if problem.data.deviations is not None else POOR_SHARE) * problem.rows
    if min(cost for _, cost in ends) > limit and problem.data.times is not None:
        numbers, cost = begun[0], np.inf
        for share in SHARES:
            numbers, cost = least(problem.within(share), numbers)
        ends.append((numbers, cost))
    return sorted(ends, key=lambda end: end[1])


def least(problem: Problem, start: Floats) -> tuple[Floats, float]:
    """Return the numbers of least loss near a start, and that loss."""
    scales = problem.scales
    room = np.isfinite(problem.upper) | np.isfinite(problem.lower)
    inside = np.clip(start, problem.lower, problem.upper)
    found = scipy_module("optimize").least_squares(
        lambda scaled: problem.finite_residuals(scaled * scales),
        inside / scales,
        jac=lambda scaled: problem.slopes(scaled * scales, central=False) * scales,
        bounds=(problem.lower / scales, problem.upper / scales) if room.any() else (-np.inf, np.inf),
        method="trf",
        ftol=CONVERGED,
        xtol=CONVERGED,
        gtol=None,
        loss="linear" if problem.robust is None else problem.rho,
        max_nfev=MOST_EVALUATIONS,
    )
    numbers = np.asarray(found.x * scales)
    return numbers, problem.cost(problem.finite_residuals(numbers))


def polished(problem: Problem, numbers: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the numbers after further steps with accurate slopes, the slopes, and how far the least loss may be.

    A number at an end of its range stays there. Slopes are formed anew for each step: with large residuals it is their
    change that decides where the least loss is. Steps shrink by at least half each, or are not taken, since near the
    least loss the losses themselves are rounded: what follows a step is then no more than the step, and what follows
    one before which the search ends no more than the step twice.
    """
    held = problem.at_ends(numbers)
    residuals = problem.residuals(numbers)
    longest = np.inf
    for _ in range(MOST_POLISHING):
        slopes = problem.slopes(numbers, central=True)
        cost = problem.cost(residuals)
        weights = np.sqrt(problem.rho(residuals**2)[1])[:, None]
        scaled = np.where(held, 0.0, slopes * problem.scales) * weights
        if not (np.isfinite(scaled).all() and np.isfinite(residuals).all()):
            # LAPACK would write to the standard output of the service.
            raise OverflowError("the slopes leave the range of doubles")
        change = -np.linalg.lstsq(scaled, residuals * weights[:, 0], rcond=problem.slope_error)[0]
        length = float(np.linalg.norm(scaled @ change))
        after = np.clip(numbers + change * problem.scales, problem.lower, problem.upper)
        found = problem.finite_residuals(after)
        if not (length <= longest and problem.cost(found) <= cost + LOST * cost):
            return numbers, slopes, 2.0 * np.abs(change * problem.scales)
        numbers, residuals, longest = after, found, 0.5 * length
        deviation = 1.0 if problem.data.deviations is not None else (cost / problem.rows) ** 0.5
        if length <= POLISHED * deviation:
            break
    return numbers, slopes, np.abs(change * problem.scales)

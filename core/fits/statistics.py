"""What least squares say of the numbers: covariance, what the data do not determine, and the errors of the motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.arrays import Floats
from core.fits.problem import Problem
from core.fits.search import scipy_module

CONFIDENCE = 0.95
"""Of intervals."""
CHANCE_OF_ONE = 0.01
"""Chance that among normal residuals there is one that counts as an outlier."""
INVOLVED = 1e-3
"""Share of a direction from which on a number belongs to it."""


@dataclass(frozen=True)
class Undetermined:
    """A direction in which the numbers may be changed without the data showing it.

    Attributes
    ----------
    direction : ndarray, shape (k,)
        Changes of the numbers over their scales, the largest 1.
    uncertainty : float or None
        Standard error along it, over the scales; None where nothing limits it.
    """

    direction: Floats
    uncertainty: float | None


@dataclass(frozen=True)
class Statistics:
    """What is known of the numbers.

    Attributes
    ----------
    covariance, correlation : ndarray, shape (k, k)
    standard_errors : ndarray, shape (k,)
        Roots of the variances, also where these are too small for doubles.
    determined : ndarray of bool, shape (k,)
        Which of them the data determine; the others have no error.
    undetermined : list of Undetermined
    chi_squared : float
        Sum of the squares of the residuals in their standard deviations, priors taken in; in SI units where deviations
        are estimated.
    degrees_of_freedom : int
    probability : float or None
        With which chi-squared is larger by chance; None where deviations are estimated, or nothing is left to test.
    deviation : float
        Standard deviation of one number that is estimated, in SI units; 1 where deviations are known.
    model_error : ndarray, shape (k,)
        What errors of the computed figures, and the end of the search, may add.
    half_widths : ndarray, shape (k,)
        Of the intervals.
    outliers : list of int
        Places of complete rows.
    """

    covariance: Floats
    correlation: Floats
    standard_errors: Floats
    determined: np.ndarray[Any, np.dtype[np.bool_]]
    undetermined: list[Undetermined]
    chi_squared: float
    degrees_of_freedom: int
    probability: float | None
    deviation: float
    model_error: Floats
    half_widths: Floats
    outliers: list[int]

    @property
    def finite(self) -> bool:
        """Whether all of it is in the range of doubles."""
        arrays = (self.covariance, self.correlation, self.model_error, self.half_widths, self.standard_errors)
        return all(np.isfinite(one).all() for one in (*arrays, self.chi_squared, self.deviation))


def statistics(problem: Problem, numbers: Floats, slopes: Floats, left: Floats, errors: Sequence[float]) -> Statistics:
    """Return what is known of the numbers of least squares.

    Parameters
    ----------
    numbers : ndarray, shape (k,)
    slopes : ndarray, shape (n, k)
        Of the residuals.
    left : ndarray, shape (k,)
        By how much the search may have missed the least squares.
    errors : sequence of float
        Bounds of the errors of the figures of each column.
    """
    special = scipy_module("special")
    residuals = problem.residuals(numbers)
    count = len(numbers)
    chi_squared = float(residuals @ residuals)
    scales = problem.scales.copy()
    own = numbers[problem.model.relative]
    scales[problem.model.relative] = np.where(own == 0.0, scales[problem.model.relative], np.abs(own))
    _, singular, rows = np.linalg.svd(slopes * scales, full_matrices=False)
    seen = singular > problem.slope_error * max(singular[0], 1e-300)
    freedom = len(residuals) - int(np.count_nonzero(seen))
    known = problem.data.deviations is not None
    deviation = 1.0 if known else _deviation(residuals, freedom)
    robust = problem.robust
    factor = 1.0 if robust is None else robust.variance_factor(residuals[: problem.rows] / deviation, count)
    # Deviations of combinations that are independent, in columns; their lengths by row are those of the numbers.
    apart = rows[seen].T / (singular[seen] / np.min(singular[seen], initial=np.inf))
    lengths = np.linalg.norm(apart, axis=1)
    unit_rows = apart / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    correlation = unit_rows @ unit_rows.T
    standard_errors = lengths * (deviation * factor**0.5 / np.min(singular[seen], initial=np.inf)) * scales
    lost = rows[~seen]
    determined = ~np.any(np.abs(lost) > INVOLVED, axis=0) if len(lost) else np.ones(count, dtype=bool)
    # The worst case: every error of a row has the sign that moves the number most.
    inverse = (rows[seen].T / singular[seen] ** 2) @ rows[seen]
    gains = np.abs((inverse * np.outer(scales, scales)) @ slopes[: problem.rows].T)
    by_row = (np.asarray(errors) * problem.weights).ravel()
    model_error = gains @ by_row + left
    quantile = float(special.ndtri(0.5 + 0.5 * CONFIDENCE))
    if not known and freedom > 0:
        quantile = float(special.stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE))
    half = quantile * standard_errors + model_error
    limit = float(special.ndtri(1.0 - 0.5 * CHANCE_OF_ONE / problem.rows)) * deviation
    beyond = np.abs(residuals[: problem.rows]).reshape(problem.data.values.shape) > limit
    probability = float(special.chdtrc(freedom, chi_squared)) if known and freedom > 0 else None
    poor = [
        Undetermined(_largest_one(row), float(deviation * factor**0.5 / value))
        for row, value, kept in zip(rows, singular, seen, strict=True)
        if kept and deviation * factor**0.5 / value > 1.0
    ]
    return Statistics(
        np.outer(standard_errors, standard_errors) * correlation,
        correlation,
        standard_errors,
        determined,
        [*(Undetermined(_largest_one(row), None) for row in lost), *poor],
        chi_squared * problem.unit**2,
        freedom,
        probability,
        deviation * problem.unit,
        model_error,
        half,
        np.flatnonzero(beyond.any(axis=1)).tolist() if deviation > 0.0 else [],
    )


def _deviation(residuals: Floats, freedom: int) -> float:
    """Return the deviation of one measurement that residuals show."""
    return float(np.sqrt(residuals @ residuals / freedom)) if freedom > 0 else 0.0


def _largest_one(row: Floats) -> Floats:
    return np.asarray(row / row[np.argmax(np.abs(row))])

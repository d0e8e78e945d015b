"""A least-squares problem: residuals in standard deviations, priors as rows more, and their slopes."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import MechanicsError
from core.fits.losses import Robust
from core.fits.model import Model
from core.fits.observations import Observations
from core.fits.unknowns import Unknown

LEAST_ERROR = 2.0**-50
"""Relative error of a figure at best."""
MOST_ERROR = 1e-9
"""The same at most, for steps: the larger errors of coarse methods change smoothly with the numbers."""
AT_END = 1e-6
"""Share of a range within which a number is at its end."""


class Problem:
    """Residuals of data as functions of scaled numbers.

    Parameters
    ----------
    model : Model
    data : Observations
    unknown : sequence of Unknown
        The first of the model's numbers.
    start : ndarray, shape (k,)
        Of all numbers.
    robust : Robust or None
    error : float
        Relative error of the figures.
    """

    def __init__(
        self,
        model: Model,
        data: Observations,
        unknown: Sequence[Unknown],
        start: Floats,
        robust: Robust | None,
        error: float,
    ) -> None:
        self.model, self.data, self.robust, self.start = model, data, robust, start
        spread = np.std(data.values, axis=0)
        largest = np.max(np.abs(data.values), axis=0)
        spread = np.where(spread > 0.0, spread, np.where(largest > 0.0, largest, 1.0))
        self.unit = float(spread[0]) if data.deviations is None else 1.0
        """Of the residuals: standard deviations, or the spread of the only column where that is to be estimated."""
        self.weights = np.full_like(data.values, 1.0 / self.unit) if data.deviations is None else 1.0 / data.deviations
        self.priors = [(k, one.prior) for k, one in enumerate(unknown) if one.prior is not None]
        self.scales = np.array(
            [*(_scale(one, value) for one, value in zip(unknown, start, strict=False)), *model.scales]
        )
        self.lower, self.upper = np.full(len(start), -np.inf), np.full(len(start), np.inf)
        for k, one in enumerate(unknown):
            if one.between is not None:
                self.lower[k], self.upper[k] = one.between
        error = min(max(error, LEAST_ERROR), MOST_ERROR)
        # Where the error of a difference quotient is least: that of the figures over the step beside the step itself,
        # or beside its square if it is taken to either side.
        count = model.count
        self._forward, self._central = self.scales[:count] * error**0.5, self.scales[:count] * error ** (1.0 / 3.0)
        self.slope_error = max(1e-8, 10.0 * error ** (2.0 / 3.0))

    def within(self, share: float) -> Problem:
        """Return the problem of the rows whose times are nearest to the start, the others counting nothing.

        Parameters
        ----------
        share : float
            Of the span of the times.
        """
        if self.data.times is None or share >= 1.0:
            return self
        away = np.abs(self.data.times)
        early = copy(self)
        early.weights = np.where((away <= share * np.max(away))[:, None], self.weights, 0.0)
        return early

    @property
    def rows(self) -> int:
        """Number of measurements."""
        return int(self.data.values.size)

    def residuals(self, numbers: Floats) -> Floats:
        """Return data minus figures over their deviations, then those of the priors; raises `MechanicsError`."""
        away = (self.data.values - self.model.shown(numbers)) * self.weights
        own = [(prior.value - numbers[k]) / prior.standard_deviation for k, prior in self.priors]
        return np.concatenate([away.ravel(), own])

    def finite_residuals(self, numbers: Floats) -> Floats:
        """Return the same, infinite where there is no answer: no step leads there."""
        try:
            return self.residuals(numbers)
        except MechanicsError:
            return np.full(self.rows + len(self.priors), np.inf)

    def slopes(self, numbers: Floats, *, central: bool) -> Floats:
        """Return the slopes of the residuals, shape (n, k)."""
        steps = self._central if central else self._forward
        shown = self.model.slopes(numbers, steps, central=central)
        away = -(shown * self.weights[..., None]).reshape(self.rows, -1)
        own = np.zeros((len(self.priors), len(numbers)))
        for row, (k, prior) in enumerate(self.priors):
            own[row, k] = -1.0 / prior.standard_deviation
        return np.concatenate([away, own])

    def rho(self, z: Floats) -> Floats:
        """Return the loss of squared residuals and its derivatives, shape (3, n); priors count by their squares."""
        plain = np.stack([z, np.ones_like(z), np.zeros_like(z)])
        if self.robust is not None:
            width = self.robust.width
            found = self.robust.rho(z[: self.rows] / width**2)
            plain[:, : self.rows] = found * np.array([[width**2], [1.0], [width**-2]])
        return plain

    def at_ends(self, numbers: Floats) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Return which numbers are at an end of their range: the search comes as near as it is told from it."""
        ranged = np.isfinite(self.upper)
        near = np.where(ranged, AT_END * (self.upper - self.lower), 0.0)
        return np.asarray(ranged & ((numbers - self.lower <= near) | (self.upper - numbers <= near)))

    def cost(self, residuals: Floats) -> float:
        """Return the sum of the losses."""
        if not np.isfinite(residuals).all():
            return float("inf")
        return float(np.sum(self.rho(residuals**2)[0]))


def _scale(unknown: Unknown, value: float) -> float:
    """Return the size of changes of a number that matter."""
    if value:
        return abs(float(value))
    if unknown.prior is not None:
        return unknown.prior.standard_deviation
    return 1.0 if unknown.between is None else 0.5 * (unknown.between[1] - unknown.between[0])

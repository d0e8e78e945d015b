"""Samples of a free rotation that are not right: how wrong they are, since when, how late, and what they conserve."""

from __future__ import annotations

from functools import cached_property
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.assessment.compare import norms
from core.assessment.sample_findings import SampleErrors
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree

SHIFTS = 64
"""Shifts of up to half a period to either side that are tried before the best is refined."""

SEEN = 64
"""Samples, evenly spread, by which shifts are compared before that."""

NEWTON = 6
"""Times that a shift is corrected."""

ALIGNED = 0.5
"""Share of the error that a shift may leave for the samples to count as late or early."""

LOST = 0.5
"""Share of the largest rate that the error reaches where samples circle another axis."""


class ExactSamples:
    """The exact motion at some times, with which samples at the same times are compared.

    Parameters
    ----------
    system : TorqueFree
    times : ndarray, shape (n,)
        In any order (s).
    right : ndarray, shape (n, 3)
        The exact motion, in body axes (rad/s).
    """

    def __init__(self, system: TorqueFree, times: Floats, right: Floats) -> None:
        self._system, self._times, self._right = system, times, right
        self._outwards = np.argsort(np.abs(times), kind="stable")
        self._some = np.unique(np.linspace(0, len(times) - 1, min(SEEN, len(times))).astype(np.intp))

    def errors(self, rows: Floats, tolerance: float) -> SampleErrors:
        """Return how wrong samples of the angular velocity are.

        Parameters
        ----------
        rows : ndarray, shape (n, 3)
            In body axes (rad/s).
        tolerance : float
            Largest error that is accepted (rad/s).
        """
        system, errors = self._system, norms(rows - self._right)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            momenta = rows @ system.tensor
            start = system.tensor @ system.angular_velocity
            energies, square = np.einsum("ij,ij->i", rows, momenta), np.einsum("ij,ij->i", momenta, momenta)
            twice = float(system.angular_velocity @ start)
            middle = float(np.linalg.eigvalsh(system.tensor)[1])
            # Positive where the axis of largest moment is circled, negative for that of the smallest.
            other = np.sign(square - middle * energies) * np.sign(float(start @ start) - middle * twice) < 0.0
            energy = _drift(energies, twice)
            momentum = _drift(norms(momenta), float(np.linalg.norm(start)))
        beyond = errors > tolerance
        # Near the separatrix errors that scatter cross it, too, and lead nowhere.
        lost = errors.max() > LOST * norms(self._right).max()
        return SampleErrors(
            float(errors.max()),
            float(errors[self._outwards[-1]]),
            self._first(beyond),
            energy,
            momentum,
            self._phase_lag(rows, float(errors.max())),
            self._first(other & beyond) if lost and all(system.body.principal_of_motion.apart) else None,
        )

    def _first(self, where: NDArray[np.bool_]) -> float | None:
        found = self._outwards[where[self._outwards]]
        return float(self._times[found[0]]) if found.size else None

    @cached_property
    def _shifted(self) -> tuple[Floats, Floats] | None:
        """Shifts, shape (k,), and the motion at some of the times shifted by each, shape (k, m, 3)."""
        motion = self._system.closed_form()
        if motion.period is None:
            return None
        lags = motion.period / SHIFTS * np.arange(-SHIFTS // 2, SHIFTS // 2 + 1, dtype=np.float64)
        try:
            rows = motion.sample((self._times[self._some] - lags[:, None]).ravel())
        except MechanicsError:
            return None
        return lags, rows.reshape(len(lags), -1, 3)

    def _phase_lag(self, rows: Floats, error: float) -> float | None:
        """Return the time by which samples are late: motion(times - lag) is nearest to them, in the mean square."""
        if self._shifted is None or not 0.0 < error < 1e100:
            return None
        lags, motions = self._shifted
        motion, inverse = self._system.closed_form(), np.linalg.inv(self._system.tensor)
        times, given = self._times[self._some], rows[self._some]
        lag = float(lags[np.square(motions - given).sum(axis=(1, 2)).argmin()])
        for _ in range(NEWTON):
            here = motion.sample(times - lag)
            slope = np.cross(here @ self._system.tensor, here) @ inverse
            size = float((slope * slope).sum())
            # Gauss and Newton: the shift by which the motion, taken as straight, comes nearest.
            lag += float(((here - given) * slope).sum()) / size if size > 0.0 else 0.0
        if not abs(lag) <= lags[-1] + lags[1] - lags[0]:
            return None
        return lag if float(norms(motion.sample(self._times - lag) - rows).max()) <= ALIGNED * error else None


def _drift(values: Floats, start: float) -> float | None:
    worst = float(np.abs(values / start - 1.0).max()) if start else float("nan")
    return worst if isfinite(worst) else None

"""The true samples, by ball arithmetic at 50 digits, and confirmed by mpmath at 50 digits along another way."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np

from benchmarks.peers.cases import Case
from core.arrays import Floats
from core.certified.free_rotation import CertifiedRotation
from tests.oracles.free_rotation import reference_angular_velocity, reference_attitude

DIGITS = 50
CHUNK = 5000
CONFIRMED = 11
TOLERATED = 1e-30


def reference(case: Case, times: Floats) -> Floats:
    """Return the samples as pairs of doubles, value and tail, shape (n, k, 2): right to about 1e-32."""
    motion = CertifiedRotation.of_moments(case.moments, case.start)
    rows = []
    for first in range(0, times.size, CHUNK):
        instants = times[first : first + CHUNK].tolist()
        rows += motion.attitude(instants, DIGITS) if case.attitude else motion.angular_velocity(instants, DIGITS)
    return np.array([[_pair(Fraction(x)) for x in row] for row in rows])


def confirmed(case: Case, times: Floats, pairs: Floats) -> float:
    """Return by how much mpmath's closed form differs from a few of the samples at most, relative to the largest.

    Raises
    ------
    ArithmeticError
        If that is more than the pairs can have rounded.
    """
    rows = np.linspace(0, times.size - 1, CONFIRMED).astype(int).tolist()
    oracle = reference_attitude if case.attitude else reference_angular_velocity
    other = oracle(case.moments, case.start, times[rows].tolist(), digits=DIGITS)
    with mpmath.workdps(DIGITS):
        size = max(mpmath.norm(row) for row in other)
        apart = max(
            mpmath.norm([x - mpmath.mpf(float(v)) - mpmath.mpf(float(t)) for x, (v, t) in zip(row, pair, strict=True)])
            for row, pair in zip(other, pairs[rows], strict=True)
        )
        if apart > TOLERATED * size:
            raise ArithmeticError(f"{case.name}: the two references differ by {mpmath.nstr(apart / size, 3)}")
        return float(apart / size)


def _pair(exact: Fraction) -> tuple[float, float]:
    value = float(exact)
    return value, float(exact - Fraction(value))

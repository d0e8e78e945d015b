"""What limits the steps of a Taylor series: what decays fast, where a motion is stiff, and what oscillates fast."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.multibody.equations.packed import Packed
from core.multibody.motion.linearised import linearised_at

LONGEST = 10.0
"""Power of e by which what limits the steps of a series decays in a step at most: where next to nothing is left."""
DEAREST = 4.0
"""Steps of a series that take as long as one of collocation."""
PER_STEP = 2.0
"""Angle by which what has not decayed turns, or power of e by which it decays, in a step of collocation."""
LIMITING = 1.0
"""Power of e by which what limits the steps of a series decays in a step at least: those of order 24 to 32 take two."""
DECAYED = 48.0
"""Power of e by which decays what need not be followed any longer: 2^-70."""
MANY = 512
"""Steps from which on it is said what takes them: a twentieth of a second in pairs of doubles for a few coordinates."""
FASTER = 32.0
"""How much faster than another motion what oscillates is at least, to be told from it."""
NOTHING = 2.0**-20
"""Share of the fastest rate below which one is the rounding of zero, whose square root it may be."""
LARGEST = 400
"""Coordinates and rows up to which it is asked: the eigenvalues of more take seconds."""


def rates_of_decay(table: Packed, q: Floats, v: Floats) -> Floats | None:
    """Return the eigenvalues of the motion beside a state of shape (n, 2), as rows (real part, size).

    They are those of the linearised equation for frozen coefficients; None where it is singular.
    """
    n, size = len(table.load), len(table.load) + len(table.rate)
    if size > LARGEST:
        return None
    at = linearised_at(table, q, v)
    try:
        gains = -np.linalg.solve(at.mass, np.concatenate([at.stiffness, at.damping], axis=1))[:n]
    except np.linalg.LinAlgError:
        return None
    if not np.isfinite(gains).all():
        return None
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:], matrix[n:] = np.eye(n), gains
    found = np.linalg.eigvals(matrix)
    return np.stack([found.real, np.abs(found)], axis=1)


def limiting_decay(rates: Floats | None, time: float, steps: float | None = None) -> float | None:
    """Return how fast decays what limits the steps of a series, per unit of time; None where the motion is not stiff.

    Parameters
    ----------
    rates : ndarray, shape (k, 2), or None
        Of `rates_of_decay`.
    time : float
        Duration of the whole motion.
    steps : float, optional
        How many steps of a series it would take; if omitted, as many as the fastest decay needs at least.
    """
    if rates is None:
        return None
    decays = np.maximum(-rates[:, 0], 0.0)
    powers = float(np.max(decays, initial=0.0)) * time
    steps = powers / LONGEST if steps is None else steps
    if powers <= LIMITING * steps:
        return None
    # What grows or persists is followed for the whole time, what decays until nothing is left of it.
    lasting = np.minimum(time, DECAYED / np.maximum(decays, DECAYED / time))
    if DEAREST * float(np.max(rates[:, 1] * lasting, initial=0.0)) / PER_STEP > steps:
        return None
    return float(np.max(decays))


def limiting_oscillation(rates: Floats | None, time: float, steps: float) -> float | None:
    """Return the angular frequency of what takes most of the steps of a series; None where all motion does."""
    if rates is None or not len(rates):
        return None
    real, size = rates[np.argmax(rates[:, 1])]
    slower = rates[rates[:, 1] > NOTHING * size, 1]
    frequency = float(np.sqrt(max(size * size - real * real, 0.0)))
    if frequency * abs(time) < LIMITING * steps or size < FASTER * np.min(slower, initial=size):
        return None
    return frequency

"""The motion of an answer about free rotation, held against its equations between the samples, and its period.

In body axes I w' + w x I w = 0, and the attitude q has q' = q w/2. Rates in time are those of the polynomial through
seven samples. After the period the angular velocity is that of the start, and not after a half, a third or a fifth.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite, ulp

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable, SelfCheckFailed
from core.rotation.self_check import LARGEST, LEAST

STEPS = np.arange(-3.0, 4.0)
WEIGHTS = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60.0
"""Rate of a function from its values at whole steps."""

TURN = 2.0**-6
"""Angle between samples, of the quickest turning (rad)."""

KNOWN = 1e-8
"""Share to which rates are known: the sixth power of the angle, over 140, times what the moments make of it."""

FRACTIONS = np.array([1.0, 2.0, 3.0, 5.0])
"""Parts of the period."""

SOON = 0.01
"""Share of the period after which the angular velocity has left the start, where parts of the period are compared."""

TOLD_APART = 1e3
"""By how many times what is known of it."""

COARSE = 2.0**-24
"""Share of its time below which a step is too small beside the doubles."""

BORDER = 2.0**-40
"""Share of the largest moment by which the others may lack, by rounding, of what a real body has.

The angular velocity of a real body changes at most as fast as it turns; otherwise it is not held against its equations.
"""

Sampled = Callable[[Floats], Floats]
"""From times, shape (n,), to angular velocities in body axes (n, 3) or quaternions (n, 4)."""

Known = Callable[[Floats], float]
"""From times to a bound of the errors of what is sampled there (rad/s, or as the angle of a turn)."""


def check_motion(
    tensor: Floats,
    start: Floats,
    time: float,
    rates: tuple[Sampled, Known],
    attitudes: tuple[Sampled, Known] | None,
    period: float | None,
) -> None:
    """Check the motion about a time, and after its period.

    Parameters
    ----------
    tensor : ndarray, shape (3, 3)
        Of inertia in body axes, in any unit.
    start : ndarray, shape (3,)
        Angular velocity at t = 0, in body axes (rad/s).
    time : float
        About which rates are formed (s).
    rates, attitudes : tuple of two callables
        Samples, and how wrong they may be.
    period : float or None
        Of the angular velocity (s).

    Raises
    ------
    SelfCheckFailed
        If a law does not hold within the stated errors.
    """
    size, most = float(np.abs(start).max()), float(np.abs(tensor).max())
    if not (LEAST < size < LARGEST and LEAST < most < LARGEST):
        return
    try:
        _check_equations(tensor / most, size, time, rates, attitudes)
        if period is not None and isfinite(period):
            _check_period(start, rates, period)
    except AccuracyUnreachable:
        # What is not known there is not compared.
        return


def _check_equations(
    tensor: Floats, size: float, time: float, rates: tuple[Sampled, Known], attitudes: tuple[Sampled, Known] | None
) -> None:
    step = TURN / (2.0 * size)
    if not step > COARSE * abs(time):
        return
    least, middle, greatest = np.linalg.eigvalsh(tensor).tolist()
    if least + middle < greatest * (1.0 - BORDER):
        return
    times = time + step * STEPS
    # The steps as they are in doubles.
    step = float(times[4] - times[2]) / 2.0
    w, error = rates[0](times), rates[1](times)
    here, gained, fastest = w[3], WEIGHTS @ w / step, float(np.linalg.norm(w, axis=1).max())
    late = ulp(float(np.abs(times).max())) / step
    known = (KNOWN + late) * fastest + 2.0 * error
    momentum = tensor @ here
    residual = tensor @ gained + np.cross(here, momentum)
    # The norm of a tensor is at most three times its largest component.
    _compare("Euler's equations", time, float(np.abs(residual).max()), 3.0 * known * (1.0 / step + 4.0 * fastest))
    if attitudes is None:
        return
    q, tilt = attitudes[0](times), attitudes[1](times)
    (a, x, y, z), (p, q1, q2) = q[3], here
    expected = 0.5 * np.array(
        [-x * p - y * q1 - z * q2, a * p + y * q2 - z * q1, a * q1 + z * p - x * q2, a * q2 + x * q1 - y * p]
    )
    off = float(np.abs(WEIGHTS @ q / step - expected).max())
    _compare(
        "attitude against angular velocity", time, off, (KNOWN + late + 2.0 * tilt) / step + error + fastest * tilt
    )


def _check_period(start: Floats, rates: tuple[Sampled, Known], period: float) -> None:
    times = period / FRACTIONS
    w, error = rates[0](times), rates[1](times)
    away = np.abs(w - start).max(axis=1)
    beside, soon = rates[0](np.array([period * (1.0 + 2.0**-20), period * SOON]))
    # The period is a double: how fast the angular velocity changes there.
    late = ulp(period) * float(np.abs(beside - w[0]).max()) / (period * 2.0**-20)
    allowed = 4.0 * error + 4.0 * late + 2.0**-46 * float(np.abs(start).max())
    _compare("the angular velocity returns after the period", period, float(away[0]), allowed)
    if float(np.abs(soon - start).max()) < TOLD_APART * allowed:
        # Beside an axis where it would stay it is seen at the same place after some parts.
        return
    for part, distance in zip(FRACTIONS[1:].tolist(), away[1:].tolist(), strict=True):
        if distance <= allowed:
            law = f"the angular velocity differs after 1/{part:.0f} of the period"
            raise SelfCheckFailed(law, "", period / part, 1.0, 0.0)


def _compare(law: str, time: float, residual: float, allowed: float) -> None:
    # What leaves the range of doubles is no residual.
    if residual > allowed:
        raise SelfCheckFailed(law, "", time, residual, allowed)

"""Samples of a free rotation held against its conservation laws, within their stated errors.

Energy and angular momentum follow from the samples and the tensor alone, and with attitudes the angular momentum is
fixed in space. An error e of the angular velocity, relative to the largest norm n of the motion, changes I w by at most
I_max e n, and the energy by that times the rate; an error of the attitude turns L by as much.
"""

from __future__ import annotations

import math
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.compiled import kernel
from core.errors import SelfCheckFailed

MOST_SAMPLES = 16
"""Samples that are checked, spread over all of them."""

ROUNDING = 2.0**-46
"""Share of the terms of a law that its evaluation in doubles may lose."""

_WIDTH = 3.0
"""The norm of a tensor is at most so many times its largest component."""

LEAST, LARGEST = 1e-140, 1e140
"""Between which the numbers of a motion are checked: beyond, squares leave the range of doubles."""


def check_rotation(
    tensor: Floats,
    start: Floats,
    times: Floats,
    rates: Floats,
    error: float,
    attitudes: Floats | None = None,
    attitude_error: float = 0.0,
) -> None:
    """Check samples of a free rotation.

    Parameters
    ----------
    tensor : ndarray, shape (3, 3)
        Of inertia in body axes, in any unit.
    start : ndarray, shape (3,)
        Angular velocity at t = 0, in body axes (rad/s).
    times : ndarray, shape (n,)
    rates : ndarray, shape (n, 3)
        Angular velocities, in body axes (rad/s).
    error : float
        Stated largest error of any of them (rad/s).
    attitudes : ndarray, shape (n, 4), optional
        Quaternions [w, x, y, z], body to space.
    attitude_error : float
        Stated, as the angle of a turn (rad).

    Raises
    ------
    SelfCheckFailed
        If a law does not hold within the stated errors.
    """
    count = len(times)
    size, most = float(np.abs(start).max()), float(np.abs(tensor).max())
    if not count or not (LEAST < size < LARGEST and LEAST < most < LARGEST and isfinite(error)):
        return
    turns = np.empty((0, 4)) if attitudes is None else attitudes
    worst = _worst(tensor, start, rates, turns, attitudes is not None, MOST_SAMPLES, size, most)
    known = _WIDTH * (error / size + ROUNDING * worst.fastest)
    length = worst.length
    for law, (residual, k), allowed in (
        ("energy", worst.energy, 2.0 * known * (worst.fastest + error / size)),
        ("angular momentum", worst.momentum, known),
        (
            "angular momentum fixed in space",
            worst.in_space,
            2.0 * (known + (attitude_error + ROUNDING) * (length + known)),
        ),
    ):
        # What leaves the range of doubles is no residual.
        if residual > allowed:
            raise SelfCheckFailed(law, "", float(times[k]), residual, allowed)


class _Worst(NamedTuple):
    """Largest residuals, each with its sample; the fastest rate and the length of the angular momentum, scaled."""

    energy: tuple[float, int]
    momentum: tuple[float, int]
    in_space: tuple[float, int]
    fastest: float
    length: float


@kernel()
def _worst(
    tensor: NDArray[np.float64],
    start: NDArray[np.float64],
    rates: NDArray[np.float64],
    turns: NDArray[np.float64],
    turned: bool,
    samples: int,
    size: float,
    most: float,
) -> _Worst:
    """Return the largest residuals of samples spread evenly.

    Rates are in units of `size`, the tensor in those of `most`. In space, momenta are compared with that of the first.
    """
    first = np.zeros(3)
    twice = length = 0.0
    for i in range(3):
        for j in range(3):
            first[i] += tensor[i, j] / most * (start[j] / size)
    for i in range(3):
        twice += first[i] * (start[i] / size)
        length += first[i] * first[i]
    length = math.sqrt(length)
    energy = momentum = in_space = fastest = 0.0
    at_energy = at_momentum = at_space = 0
    held, here = np.zeros(3), np.zeros(3)
    count = min(samples, len(rates))
    for s in range(count):
        k = s * (len(rates) - 1) // max(count - 1, 1)
        total = speed = square = 0.0
        for i in range(3):
            here[i] = 0.0
            for j in range(3):
                here[i] += tensor[i, j] / most * (rates[k, j] / size)
            total += here[i] * (rates[k, i] / size)
            speed += (rates[k, i] / size) ** 2
            square += here[i] * here[i]
        fastest = max(fastest, math.sqrt(speed))
        if abs(total - twice) > energy:
            energy, at_energy = abs(total - twice), k
        if abs(math.sqrt(square) - length) > momentum:
            momentum, at_momentum = abs(math.sqrt(square) - length), k
        if not turned:
            continue
        # v + 2 w (u x v) + 2 u x (u x v)
        w, x, y, z = turns[k, 0], turns[k, 1], turns[k, 2], turns[k, 3]
        a, b, c = y * here[2] - z * here[1], z * here[0] - x * here[2], x * here[1] - y * here[0]
        p = here[0] + 2.0 * (w * a + y * c - z * b)
        q = here[1] + 2.0 * (w * b + z * a - x * c)
        r = here[2] + 2.0 * (w * c + x * b - y * a)
        if s == 0:
            held[0], held[1], held[2] = p, q, r
        apart = math.sqrt((p - held[0]) ** 2 + (q - held[1]) ** 2 + (r - held[2]) ** 2)
        if apart > in_space:
            in_space, at_space = apart, k
    return _Worst((energy, at_energy), (momentum, at_momentum), (in_space, at_space), fastest, length)

"""The first-order error of the angular velocity phase by phase, with the signs of all its parts, compiled.

At the amplitude phi, Delta^2 = 1 - m sin^2 phi, input by input,

    dw_c = dA_c cos phi - A_c sin phi Delta Q        dw_b = dA_b sin phi + A_b cos phi Delta Q
    dw_d = dA_d Delta - A_d (m sin phi cos phi Q + sin^2 phi dm/2 Delta)
    Q = dphi_0/Delta_0 + (u - u_0) dlog p - (F_m(phi) - F_m(phi_0)) dm,   F_m = integral of sin^2/2 Delta^3

is the change of the motion when it comes to phi for the first time; half a period, 2K, later Q has grown by
2K (dlog p - K'/K dm), and the rest is the same. The derivation is in docs/physics/error-statements.md.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import kernel

STEPS = 32
"""Phases to either side of the start, over half a period."""

LARGEST_MODULUS = 0.9
"""Beyond this m the phases would have to lie closer where Delta is small."""

BETWEEN = 1.05
"""What may lie between two phases is larger than at both by less: their distance is a tenth of a radian."""

_NODES = (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0))


@kernel()
def phase_errors(A_c: float, A_b: float, A_d: float, m: float, start: float, k1: float, table: Floats) -> Floats:
    """Return distance in u, error and slope of the motion, shape (2 STEPS + 1, 3), forwards and then backwards.

    Parameters
    ----------
    A_c, A_b, A_d, m, start, k1 : float
        Amplitudes, parameter, amplitude phi at t = 0, complementary modulus.
    table : ndarray, shape (n, 6)
        Of `add_constants`.
    """
    out = np.zeros((2 * STEPS + 2, 3))
    for side in range(2):
        way = 1.0 - 2.0 * side
        step = way * math.pi / STEPS
        u, f = 0.0, 0.0
        for j in range(STEPS + 1):
            phi = start + j * step
            if j > 0:
                for node in _NODES:
                    x = math.sin(phi - step * node)
                    d = math.sqrt(1.0 - m * x * x)
                    u += 0.5 * step / d
                    f += 0.25 * step * x * x / (d * d * d)
            s, c = math.sin(phi), math.cos(phi)
            delta = math.sqrt(1.0 - m * s * s)
            first, second, third = 0.0, 0.0, 0.0
            for k in range(table.shape[0]):
                dm = table[k, 5] * k1
                q = table[k, 3] + u * table[k, 4] - f * dm
                first += abs(table[k, 0] * c - A_c * s * delta * q)
                second += abs(table[k, 1] * s + A_b * c * delta * q)
                third += abs(table[k, 2] * delta - A_d * (m * s * c * q + 0.5 * s * s * dm / delta))
            row = side * (STEPS + 1) + j
            out[row, 0] = abs(u)
            out[row, 1] = math.sqrt(first * first + second * second + third * third)
            x, y, z = A_c * s * delta, A_b * c * delta, A_d * m * s * c
            out[row, 2] = math.sqrt(x * x + y * y + z * z)
    return out


@kernel()
def largest_until(phases: Floats, angle: float, half_period: float, frequency: float) -> float:
    """Return the largest error up to |u - u_0| = `angle`, `frequency` being the sum of |dlog f| over the inputs."""
    largest, rows = 0.0, phases.shape[0] // 2
    for row in range(phases.shape[0]):
        # In every half period one phase more than is reached: the horizon may lie between two.
        before = phases[row - 1, 0] if row % rows > 0 else 0.0
        if before > angle:
            continue
        passes = max(0.0, math.floor((angle - before) / half_period))
        largest = max(largest, phases[row, 1] + passes * half_period * frequency * phases[row, 2])
    return BETWEEN * largest

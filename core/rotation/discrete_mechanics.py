"""Moser and Veselov's discrete mechanics of the free rigid body, in quaternions.

A step of duration h turns the body by a unit quaternion (r, e), with angular momenta before and after it in body axes

    h/2 M  = r I e + e x I e,        h/2 M' = r I e - e x I e,        r^2 + |e|^2 = 1.

As I e is at right angles to e x I e, |M'| = |M|; as e is too, M'.I^-1 M' = M.I^-1 M. Momentum and energy are both
kept, so that the state stays on its polhode, and only how fast it moves along it is wrong, in second order of h.

References
----------
J. Moser, A. P. Veselov, Communications in Mathematical Physics 139 (1991) 217, section 1.4.
E. Hairer, G. Vilmart, Journal of Physics A 39 (2006) 13225, section 2, where D = (tr I)/2 - I.
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.systems.system import DISCRETE_STEP

ITERATIONS = 50


@kernel()
def _half_turn(moments: Floats, half: Floats, e: Floats) -> bool:
    """Solve r I e + e x I e = `half` for e by Newton's method, from where `e` begins, until rounding stops it."""
    a, b, c = moments[0], moments[1], moments[2]
    last = math.inf
    for _ in range(ITERATIONS):
        x, y, z = e[0], e[1], e[2]
        square = 1.0 - (x * x + y * y + z * z)
        if not square > 0.0:
            return False
        r = math.sqrt(square)
        # Residual divided by the moments, row by row, so that a small one is not lost beside a large one.
        fx = r * x + (c - b) / a * y * z - half[0] / a
        fy = r * y + (a - c) / b * z * x - half[1] / b
        fz = r * z + (b - a) / c * x * y - half[2] / c
        xx, xy, xz = r - x * x / r, (c - b) / a * z - x * y / r, (c - b) / a * y - x * z / r
        yx, yy, yz = (a - c) / b * z - y * x / r, r - y * y / r, (a - c) / b * x - y * z / r
        zx, zy, zz = (b - a) / c * y - z * x / r, (b - a) / c * x - z * y / r, r - z * z / r
        cx, cy, cz = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
        determinant = xx * cx + xy * cy + xz * cz
        if not abs(determinant) > 0.0:
            return False
        dx = (fx * cx + fy * (xz * zy - xy * zz) + fz * (xy * yz - xz * yy)) / determinant
        dy = (fx * cy + fy * (xx * zz - xz * zx) + fz * (xz * yx - xx * yz)) / determinant
        dz = (fx * cz + fy * (xy * zx - xx * zy) + fz * (xx * yy - xy * yx)) / determinant
        e[0], e[1], e[2] = x - dx, y - dy, z - dz
        change, size = max(abs(dx), abs(dy), abs(dz)), max(abs(x), abs(y), abs(z))
        # Beside the round-off of e, a change that no longer falls is round-off and nothing else.
        if change == 0.0 or (change >= last and change <= 1e-13 * size):
            return True
        last = change
    return False


@kernel(DISCRETE_STEP)
def moser_veselov(duration: float, state: Floats, parameters: Floats, increment: Floats) -> bool:
    """Fill in the change of the angular velocity; the parameters begin with three moments and nine axes."""
    half, e, turned = np.empty(3), np.empty(3), np.empty(3)
    for k in range(3):
        rate = parameters[3 + k] * state[0] + parameters[6 + k] * state[1] + parameters[9 + k] * state[2]
        e[k] = 0.5 * duration * rate
        half[k] = parameters[k] * e[k]
    if not _half_turn(parameters[:3], half, e):
        return False
    factor = -4.0 / duration
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        turned[k] = factor * ((parameters[j] - parameters[i]) / parameters[k]) * e[i] * e[j]
    for k in range(3):
        row = 3 + 3 * k
        increment[k] = parameters[row] * turned[0] + parameters[row + 1] * turned[1] + parameters[row + 2] * turned[2]
    return True

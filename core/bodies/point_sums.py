"""Mass, centre of mass and second moments of many point masses in double-double, compiled."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add, dd_div, dd_mul, dd_mul_d, dd_sub


@kernel()
def first_moments(masses: Floats, positions: Floats, tails: Floats, out: Floats) -> None:
    """Fill `out`, shape (2, 4), with the total mass and the centre of mass, and their tails."""
    for n in range(masses.size):
        out[0, 0], out[1, 0] = dd_add(out[0, 0], out[1, 0], masses[n], 0.0)
        for j in range(3):
            h, low = dd_mul_d(positions[n, j], tails[n, j], masses[n])
            out[0, j + 1], out[1, j + 1] = dd_add(out[0, j + 1], out[1, j + 1], h, low)
    for j in range(3):
        out[0, j + 1], out[1, j + 1] = dd_div(out[0, j + 1], out[1, j + 1], out[0, 0], out[1, 0])


@kernel()
def second_moments(masses: Floats, positions: Floats, tails: Floats, center: Floats, out: Floats) -> None:
    """Fill `out`, shape (2, 3, 3), with the sums of m d_i d_j about `center`, shape (2, 4), and their tails."""
    dh, dl = np.empty(3), np.empty(3)
    for n in range(masses.size):
        for j in range(3):
            dh[j], dl[j] = dd_sub(positions[n, j], tails[n, j], center[0, j + 1], center[1, j + 1])
        for i in range(3):
            mh, ml = dd_mul_d(dh[i], dl[i], masses[n])
            for j in range(i, 3):
                h, low = dd_mul(mh, ml, dh[j], dl[j])
                out[0, i, j], out[1, i, j] = dd_add(out[0, i, j], out[1, i, j], h, low)
    for i in range(3):
        for j in range(i):
            out[0, i, j], out[1, i, j] = out[0, j, i], out[1, j, i]

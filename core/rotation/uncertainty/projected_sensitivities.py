"""Sensitivities of principal moments and of components along the axes, from those of a tensor, compiled.

With principal axes v and P = v^T dI v, the moments change by P_jj, and the axes turn by P_jk/(I_k - I_j) in the plane
of j and k (perturbation theory: G. H. Golub, C. F. Van Loan, "Matrix Computations", 4th ed., sections 7.2.2 and 8.1).
"""

from __future__ import annotations

import math

import numpy as np

from core.arrays import Floats
from core.compiled import kernel


@kernel()
def given_moment_sensitivities(moments: Floats, components: Floats) -> tuple[Floats, Floats, Floats]:
    """Return changes of moments, components and axes by moments and components themselves: (6, 3), (6, 3), (6,)."""
    dI, dw = np.zeros((6, 3)), np.zeros((6, 3))
    for k in range(3):
        dI[k, k], dw[3 + k, k] = moments[k], components[k]
    return dI, dw, np.zeros(6)


@kernel()
def projected_sensitivities(
    low: float, high: float, components: Floats, axes: Floats, velocity: Floats, tensors: Floats
) -> tuple[Floats, Floats, Floats, Floats, float]:
    """Return the same by the numbers that describe a tensor, shape (n, 3, 3), and by those of the start.

    Parameters
    ----------
    low, high : float
        The gaps between the moments.
    components, velocity : ndarray, shape (3,)
        The start along the principal axes, and along the body's.
    axes : ndarray, shape (3, 3)
        Principal axes, as columns in body axes.

    Returns
    -------
    moments, components : ndarray, shape (n + 3, 3)
    turns : ndarray, shape (n + 3,)
    crossed : ndarray, shape (3, n)
        P_jk in the planes (0, 1), (1, 2), (2, 0) of equal moments, where the axes are free; else 0.
    own : float
        Sum of the norms of the changes of the tensor.
    """
    n = tensors.shape[0]
    dI, dw, turns = np.zeros((n + 3, 3)), np.zeros((n + 3, 3)), np.zeros(n + 3)
    crossed, own, p = np.zeros((3, n)), 0.0, np.empty((3, 3))
    for row in range(n):
        size, turned = 0.0, 0.0
        for j in range(3):
            for k in range(j, 3):
                p[j, k] = 0.0
                for a in range(3):
                    for b in range(3):
                        p[j, k] += axes[a, j] * tensors[row, a, b] * axes[b, k]
                size += p[j, k] * p[j, k] * (1.0 if j == k else 2.0)
            dI[row, j] = p[j, j]
        own += math.sqrt(size)
        for plane in range(3):
            j, k = plane, (plane + 1) % 3
            gap = (low, high, -low - high)[plane]
            across = p[min(j, k), max(j, k)]
            if gap == 0.0:
                crossed[plane, row] = across
                continue
            turn = across / gap
            dw[row, k] += turn * components[j]
            dw[row, j] -= turn * components[k]
            turned += turn * turn
        turns[row] = math.sqrt(turned)
    for a in range(3):
        for k in range(3):
            dw[n + a, k] = velocity[a] * axes[a, k]
    return dI, dw, turns, crossed, own

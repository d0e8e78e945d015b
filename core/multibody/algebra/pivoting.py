"""Which columns of a matrix are independent: its QR factorisation with pivoting, by the modified Gram-Schmidt process.

References
----------
P. Businger, G. H. Golub, "Linear least squares solutions by Householder transformations", Numerische Mathematik 7
(1965) 269. A. Bjoerck, "Numerics of Gram-Schmidt orthogonalization", Linear Algebra and its Applications 197-198 (1994)
297.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats


def pivoted(matrix: Floats) -> tuple[NDArray[np.intp], Floats]:
    """Return the columns of a matrix, each the farthest from the span of those before it, and these distances.

    Returns
    -------
    order : ndarray, shape (n,)
        Numbers of all columns; the first of those that are equally far away comes first.
    pivots : ndarray, shape (min(m, n),)
        Distances, falling; of columns that depend on those before, rounding remains.
    """
    left, order = matrix.copy(), np.arange(matrix.shape[1])
    pivots = np.zeros(min(matrix.shape))
    for k in range(len(pivots)):
        # Norms are formed anew: taken off step by step, what rounding leaves would be taken for a distance.
        norms = np.linalg.norm(left[:, k:], axis=0)
        farthest = k + int(np.argmax(norms))
        pivots[k] = norms[farthest - k]
        if not pivots[k] > 0.0:
            break
        order[[k, farthest]] = order[[farthest, k]]
        left[:, [k, farthest]] = left[:, [farthest, k]]
        direction = left[:, k] / pivots[k]
        left[:, k + 1 :] -= np.outer(direction, direction @ left[:, k + 1 :])
    return order, pivots

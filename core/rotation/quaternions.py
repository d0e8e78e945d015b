"""Quaternions [w, x, y, z] in the longest floats at hand, for what is formed once and multiplies every sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Extended = NDArray[np.longdouble]


def left(q: Extended) -> Extended:
    """Return the matrix L(q), shape (4, 4), of q p = L(q) p."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])


def right(q: Extended) -> Extended:
    """Return the matrix R(q), shape (4, 4), of p q = R(q) p."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, z, -y], [y, -z, w, x], [z, y, -x, w]])


def unit(q: Extended) -> Extended:
    """Return q/|q|."""
    shortened = q / np.max(np.abs(q))
    normalised: Extended = shortened / np.sqrt(np.sum(shortened * shortened))
    return normalised


def quaternion_of(m: Extended) -> Extended:
    """Return the quaternion of a rotation matrix, shape (3, 3), by its largest component (S. W. Shepperd, 1978)."""
    diagonal = [
        1 + m[0, 0] + m[1, 1] + m[2, 2],
        1 + m[0, 0] - m[1, 1] - m[2, 2],
        1 - m[0, 0] + m[1, 1] - m[2, 2],
        1 - m[0, 0] - m[1, 1] + m[2, 2],
    ]
    a, b, c = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    d, e, f = m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] + m[1, 2]
    s = diagonal
    rows = [[s[0], a, b, c], [a, s[1], d, e], [b, d, s[2], f], [c, e, f, s[3]]]
    return unit(np.array(rows[int(np.argmax(diagonal))]))

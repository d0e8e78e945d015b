"""Attitudes and angular velocities from the axes of a body, in doubles and in balls."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.multibody.algebra.polynomials import ONE, ZERO, Ball

Axes = Sequence[Sequence[Ball]]
"""Components in space of the three body axes, or their rates."""


def dot(a: Sequence[Ball], b: Sequence[Ball]) -> Ball:
    """Return the scalar product of two vectors."""
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def angular_velocity(axes: Axes, rates: Axes) -> list[Ball]:
    """Return the angular velocity in body axes (rad/s)."""
    return [dot(rates[(k + 1) % 3], axes[(k + 2) % 3]) for k in range(3)]


def quaternion(axes: Axes) -> list[Ball]:
    """Return the unit quaternion of body axes in space, by the largest of its components, the first not negative."""
    r = [[axes[k][i] for k in range(3)] for i in range(3)]
    squares = [
        ONE + r[0][0] + r[1][1] + r[2][2],
        ONE + r[0][0] - r[1][1] - r[2][2],
        ONE - r[0][0] + r[1][1] - r[2][2],
        ONE - r[0][0] - r[1][1] + r[2][2],
    ]
    k = max(range(4), key=lambda i: float(squares[i]))
    if k == 0:
        row = [squares[0], r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]
    else:
        i, j, l = k - 1, k % 3, (k + 1) % 3  # noqa: E741
        row = [ZERO] * 4
        row[0], row[1 + i] = r[l][j] - r[j][l], squares[k]
        row[1 + j], row[1 + l] = r[j][i] + r[i][j], r[l][i] + r[i][l]
    size = dot(row, row).sqrt()
    way = -1 if row[0] < 0 else 1
    return [way * x / size for x in row]


def quaternions(axes: Floats) -> Floats:
    """Return unit quaternions [w, x, y, z], w >= 0, of body axes in space: axes[t, k] is the body axis k.

    By the largest of the four components, which never cancels (S. W. Shepperd, 1978).
    """
    r = np.swapaxes(axes, 1, 2)
    trace = np.trace(r, axis1=1, axis2=2)
    squares = np.stack([trace, r[:, 0, 0], r[:, 1, 1], r[:, 2, 2]], axis=1)
    out = np.empty((len(r), 4))
    for s, k in enumerate(np.argmax(squares, axis=1)):
        m = r[s]
        if k == 0:
            row = [1 + trace[s], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]
        else:
            i = int(k) - 1
            j, l = (i + 1) % 3, (i + 2) % 3  # noqa: E741
            row = [0.0] * 4
            row[0] = m[l, j] - m[j, l]
            row[1 + i] = 1 + m[i, i] - m[j, j] - m[l, l]
            row[1 + j] = m[j, i] + m[i, j]
            row[1 + l] = m[l, i] + m[i, l]
        vector = np.array(row) / np.linalg.norm(row)
        out[s] = -vector if vector[0] < 0.0 else vector
    return out

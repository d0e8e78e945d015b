"""Attitudes and angular velocities from the axes of a body, in doubles and in balls."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from flint import arb

from core.arrays import Floats
from core.multibody.algebra.directions import scalar_product
from core.multibody.algebra.polynomials import Ball

Axes = Sequence[Sequence[Ball]]
"""Components in space of the three body axes, or their rates."""


def angular_velocity(axes: Axes, rates: Axes) -> list[Ball]:
    """Return the angular velocity in body axes (rad/s)."""
    return [scalar_product(rates[(k + 1) % 3], axes[(k + 2) % 3]) for k in range(3)]


def quaternion(axes: Axes, root: Callable[[Ball], Ball] = arb.sqrt) -> list[Ball]:
    """Return the unit quaternion [w, x, y, z], w >= 0, of body axes in space, in balls or in other numbers with a root.

    By the largest of the four components, which never cancels (S. W. Shepperd, 1978).
    """
    r = [[axes[k][i] for k in range(3)] for i in range(3)]
    squares = [
        1 + r[0][0] + r[1][1] + r[2][2],
        1 + r[0][0] - r[1][1] - r[2][2],
        1 - r[0][0] + r[1][1] - r[2][2],
        1 - r[0][0] - r[1][1] + r[2][2],
    ]
    products = [
        [squares[0], r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]],
        [r[2][1] - r[1][2], squares[1], r[1][0] + r[0][1], r[0][2] + r[2][0]],
        [r[0][2] - r[2][0], r[1][0] + r[0][1], squares[2], r[2][1] + r[1][2]],
        [r[1][0] - r[0][1], r[0][2] + r[2][0], r[2][1] + r[1][2], squares[3]],
    ]
    row = products[max(range(4), key=lambda k: float(squares[k]))]
    size = root(row[0] * row[0] + row[1] * row[1] + row[2] * row[2] + row[3] * row[3])
    return [-x / size for x in row] if row[0] < 0 else [x / size for x in row]


def quaternions(axes: Floats) -> Floats:
    """Return unit quaternions of body axes in space in doubles: axes[t, k] is the body axis k."""
    return np.array([quaternion(one, math.sqrt) for one in axes.tolist()]).reshape(-1, 4)

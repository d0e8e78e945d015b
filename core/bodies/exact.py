"""Rational mechanics of mass: exact while it is computed, rounded once to a pair of doubles.

A double is a rational number, and mass properties of solids and of their assemblies are rational in their dimensions
(times a power of pi where a density is given), so no cancellation can spoil them, at any scale or offset.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from core.errors import InvalidParameter

Floats = NDArray[np.float64]
Vector = Sequence[Fraction]
Matrix = Sequence[Sequence[Fraction]]

# Abramowitz and Stegun, "Handbook of Mathematical Functions", table 1.1, extended: 200 bits.
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")


def pair(number: Fraction) -> tuple[float, float]:
    """Return the nearest double and the nearest double to what is then missing.

    Raises
    ------
    InvalidParameter
        If the number is too large for a double, or not zero and too small for one.
    """
    try:
        value = float(number)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value) or (value == 0.0 and number != 0):
        raise InvalidParameter(
            (),
            "have mass, centre of mass and moments of inertia within the range of doubles, 5e-324 to 1.8e308",
            remedy="use units in which the numbers are nearer to one",
        )
    return value, float(number - Fraction(value))


def pairs(numbers: Vector | Matrix) -> tuple[Floats, Floats]:
    """Return values and tails of a vector, shape (3,), or a matrix, shape (3, 3), as arrays that cannot be written."""
    shape = (3, 3) if isinstance(numbers[0], Sequence) else (3,)
    flat = [x for row in numbers for x in row] if isinstance(numbers[0], Sequence) else list(numbers)  # type: ignore[union-attr, arg-type]
    value, tail = np.array([pair(x) for x in flat]).T.reshape(2, *shape)  # type: ignore[arg-type]
    value.setflags(write=False)
    tail.setflags(write=False)
    return value, tail


def exact_vector(value: Floats, tail: Floats | None) -> list[Fraction]:
    """Return value + tail, shape (3,)."""
    found = [Fraction(float(x)) for x in value]
    return found if tail is None else [x + Fraction(float(t)) for x, t in zip(found, tail, strict=True)]


def exact_matrix(value: Floats, tail: Floats) -> list[list[Fraction]]:
    """Return value + tail, shape (3, 3)."""
    return [exact_vector(v, t) for v, t in zip(value, tail, strict=True)]


def parallel_axis(mass: Fraction, offset: Vector, inertia: Matrix) -> list[list[Fraction]]:
    """Return the tensor about a point at `offset` from the centre of mass: I + m (d.d 1 - d d^T)."""
    square = sum(x * x for x in offset)
    return [
        [inertia[i][j] + mass * ((square if i == j else 0) - offset[i] * offset[j]) for j in range(3)] for i in range(3)
    ]


def rotation(quaternion: Sequence[float]) -> list[list[Fraction]]:
    """Return the rotation matrix of a quaternion [w, x, y, z] of any length but zero, exactly orthogonal.

    The Euler-Rodrigues matrix divided by the squared length is rational in the components.
    """
    w, x, y, z = (Fraction(float(q)) for q in quaternion)
    n = w * w + x * x + y * y + z * z
    return [
        [(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n],
        [2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n],
        [2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n],
    ]


def rotated(matrix: Matrix, turn: Matrix) -> list[list[Fraction]]:
    """Return R A R^T."""
    half = [[sum((turn[i][k] * matrix[k][j] for k in range(3)), Fraction(0)) for j in range(3)] for i in range(3)]
    return [[sum((half[i][k] * turn[j][k] for k in range(3)), Fraction(0)) for j in range(3)] for i in range(3)]

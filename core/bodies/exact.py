"""Rational mechanics of mass: exact while it is computed, rounded once to a pair of doubles.

A double is a rational number, and mass properties of solids and of their assemblies are rational in their dimensions
(times a power of pi where a density is given), so cancellation causes no error, at any scale or offset.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter

Vector = Sequence[Fraction]
Matrix = Sequence[Sequence[Fraction]]

# Abramowitz and Stegun, "Handbook of Mathematical Functions", table 1.1, extended: 200 bits.
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")


SMALLEST = 2.0**-1022
"""Below this a double has fewer than 53 bits."""


def pair(number: Fraction) -> tuple[float, float]:
    """Return the nearest double, and the double nearest to the remainder.

    Raises
    ------
    InvalidParameter
        If the number is too large for a double.
    """
    try:
        value = float(number)
    except OverflowError:
        raise _out_of_range() from None
    return value, float(number - Fraction(value))


def size_pair(number: Fraction) -> tuple[float, float]:
    """Return the same for a mass or a moment, which must not be subnormal.

    Raises
    ------
    InvalidParameter
        If the number is too large for a double, or not zero and too small for 53 bits.
    """
    value, tail = pair(number)
    if number != 0 and abs(value) < SMALLEST:
        raise _out_of_range()
    return value, tail


def _out_of_range() -> InvalidParameter:
    return InvalidParameter(
        (),
        "have mass, centre of mass and moments of inertia within the range of doubles, 2.3e-308 to 1.8e308",
        remedy="use units in which the numbers are nearer to one",
    )


def vector_pairs(numbers: Vector) -> tuple[Floats, Floats]:
    """Return values and tails of a vector, shape (3,), as read-only arrays."""
    return _frozen([pair(x) for x in numbers], 3)


def tensor_pairs(numbers: Matrix) -> tuple[Floats, Floats]:
    """Return values and tails of a tensor of inertia, shape (3, 3), as read-only arrays."""
    found = [
        size_pair(x) if i == j else pair(x) for i, row in enumerate(numbers) for j, x in enumerate(row)
    ]  # fmt: skip
    return _frozen(found, 3, 3)


def _frozen(found: list[tuple[float, float]], *shape: int) -> tuple[Floats, Floats]:
    value = np.array([v for v, _ in found]).reshape(shape)
    tail = np.array([t for _, t in found]).reshape(shape)
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


def rotation(quaternion: Sequence[float | Fraction]) -> list[list[Fraction]]:
    """Return the rotation matrix of a quaternion [w, x, y, z] of any length but zero, exactly orthogonal.

    The Euler-Rodrigues matrix divided by the squared length is rational in the components.
    """
    w, x, y, z = (Fraction(q) for q in quaternion)
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

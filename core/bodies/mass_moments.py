"""Moments of mass of order zero, one and two about one point, which are additive over the parts of a composite.

They are integers in units of 2^-4096. Rational numbers would be exact, but their denominators multiply with every
attitude, and a thousand parts would take minutes. Here a quotient is rounded once, by less than one unit. A later
factor (the square of a distance, at most 2^2048) leaves this error below 2^-2000, far below half of any double. The
resulting pairs of doubles are therefore those of exact arithmetic, whatever cancels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from core.arrays import Floats
from core.bodies.exact import Matrix, Vector

BITS = 4096
UNRESOLVED = 1 << (BITS - 2000)
"""Moments below this are rounding errors."""

_LEAST = 1074
"""Every double is a multiple of 2^-1074."""

_SHARE = Fraction(1, 2**256)
_NOTHING = Fraction(1, 2**1500)

Integers = tuple[int, ...]


@dataclass(frozen=True)
class MassMoments:
    """Integrals of dm, r dm and r r^T dm, in units of 2^-4096 (kg, kg m, kg m^2).

    Attributes
    ----------
    mass : int
        Negative for a hole.
    first : tuple of 3 int
    second : tuple of 6 int
        xx, xy, xz, yy, yz, zz.
    """

    mass: int = 0
    first: Integers = (0, 0, 0)
    second: Integers = (0, 0, 0, 0, 0, 0)

    @classmethod
    def of(cls, mass: Fraction, center: Vector, inertia: Matrix) -> MassMoments:
        """Return the moments about the origin of a body with a given inertia about its centre of mass."""
        half = (inertia[0][0] + inertia[1][1] + inertia[2][2]) / 2
        first = [mass * x for x in center]
        second = [(half if i == j else 0) - inertia[i][j] + first[i] * center[j] for i in range(3) for j in range(i, 3)]
        return cls(_fixed(mass), tuple(map(_fixed, first)), tuple(map(_fixed, second)))

    def __add__(self, other: MassMoments) -> MassMoments:
        return MassMoments(
            self.mass + other.mass,
            tuple(a + b for a, b in zip(self.first, other.first, strict=True)),
            tuple(a + b for a, b in zip(self.second, other.second, strict=True)),
        )

    def __neg__(self) -> MassMoments:
        return MassMoments(-self.mass, tuple(-x for x in self.first), tuple(-x for x in self.second))

    def turned(self, quaternion: Sequence[float]) -> MassMoments:
        """Return the moments after a rotation about the origin by a quaternion [w, x, y, z] of any length but zero."""
        w, x, y, z = _whole(quaternion)
        if x == y == z == 0:
            return self
        n = w * w + x * x + y * y + z * z
        # Euler and Rodrigues; the entries are n times those of the rotation matrix.
        turn = (
            (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
        )
        xx, xy, xz, yy, yz, zz = self.second
        columns = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        half = [[_dot(row, column) for column in columns] for row in turn]
        return MassMoments(
            self.mass,
            tuple(_dot(row, self.first) // n for row in turn),
            tuple(_dot(half[i], turn[j]) // (n * n) for i in range(3) for j in range(i, 3)),
        )

    def moved(self, offset: Sequence[float]) -> MassMoments:
        """Return the moments after a displacement (m)."""
        if not any(offset):
            return self
        d = [int(Fraction(float(x)) * (1 << _LEAST)) for x in offset]
        s, m = self.first, self.mass
        shift = [(m * x) >> _LEAST for x in d]
        pairs = [(i, j) for i in range(3) for j in range(i, 3)]
        more = [((s[i] * d[j] + d[i] * s[j] << _LEAST) + m * d[i] * d[j]) >> (2 * _LEAST) for i, j in pairs]
        return MassMoments(
            m,
            tuple(a + b for a, b in zip(s, shift, strict=True)),
            tuple(a + b for a, b in zip(self.second, more, strict=True)),
        )

    @property
    def massive(self) -> bool:
        """Whether the mass is positive."""
        return self.mass > UNRESOLVED

    @property
    def spread(self) -> Fraction:
        """The integral of r^2 dm about the origin (kg m^2)."""
        xx, _, _, yy, _, zz = self.second
        return Fraction(xx + yy + zz, 1 << BITS)

    def properties(self) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
        """Return mass, centre of mass and inertia about it; the mass must be positive.

        A component of the tensor that no double can express and that is below 2^-256 of the trace is zero, and moments
        that differ by as little as their rounding are equal.
        """
        m, s = self.mass, self.first
        center = [_or_zero(Fraction(x, m)) for x in s]
        pairs = [(i, j) for i in range(3) for j in range(i, 3)]
        central = {
            (i, j): Fraction(m * value - s[i] * s[j], m << BITS)
            for (i, j), value in zip(pairs, self.second, strict=True)
        }
        trace = central[0, 0] + central[1, 1] + central[2, 2]
        for j, k in ((0, 1), (0, 2), (1, 2)):
            if abs(central[j, j] - central[k, k]) < _NOTHING * trace:
                central[k, k] = central[j, j]
        inertia = [[(trace if i == j else 0) - central[min(i, j), max(i, j)] for j in range(3)] for i in range(3)]
        least = _SHARE * abs(trace)
        return (
            Fraction(m, 1 << BITS),
            center,
            [[_or_zero(x) if abs(x) < least else x for x in row] for row in inertia],
        )

    def within(self, mass: int, length: int) -> tuple[float, Floats, Floats]:
        """Return all three in units of 2^mass kg and 2^length m, rounded to doubles, of shapes (), (3,) and (3, 3)."""

        def rounded(number: int, exponent: int) -> float:
            return float(Fraction(number, 1 << BITS) / Fraction(2) ** exponent)

        xx, xy, xz, yy, yz, zz = (rounded(x, mass + 2 * length) for x in self.second)
        return (
            rounded(self.mass, mass),
            np.array([rounded(x, mass + length) for x in self.first]),
            np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
        )


def _fixed(number: Fraction) -> int:
    return (number.numerator << BITS) // number.denominator


def _or_zero(number: Fraction) -> Fraction:
    """Return zero for a number smaller than every double."""
    return number if abs(number) * (1 << (_LEAST + 1)) >= 1 else Fraction(0)


def _whole(numbers: Sequence[float]) -> list[int]:
    """Return doubles times a common power of two, as integers without a common factor of two."""
    whole = [int(Fraction(float(x)) * (1 << _LEAST)) for x in numbers]
    common = 0
    for x in whole:
        common |= x
    shift = (common & -common).bit_length() - 1
    return [x >> shift for x in whole]


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

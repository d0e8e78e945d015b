"""Inertia in rational numbers, and what can be decided about it without rounding anything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeVar

from flint import arb

from core.bodies.measured import THIN_ROD
from core.bodies.principal_inertia import Symmetry
from core.digits.exact_inputs import Number, exact_numbers
from core.errors import InvalidParameter

Vector = tuple[Fraction, Fraction, Fraction]
Matrix = tuple[Vector, Vector, Vector]

Exact = TypeVar("Exact", Fraction, arb)


@dataclass(frozen=True)
class ExactInertia:
    """A tensor of inertia whose components are rational numbers.

    Attributes
    ----------
    tensor : tuple of 3 rows of 3 fractions
        Symmetric, no moment negative and at most one zero, in body axes about the point of rotation (kg m^2).
    """

    tensor: Matrix

    def __post_init__(self) -> None:
        trace, minors, determinant = _symmetric_functions(self.tensor)
        # All roots of a real cubic that has three are positive if and only if its signs alternate (Descartes).
        if not (trace > 0 and minors > 0 and determinant >= 0):
            raise _without_extent()

    @classmethod
    def of_moments(cls, moments: Sequence[Number]) -> ExactInertia:
        """Return a body given by principal moments along its axes, shape (3,)."""
        a, b, c = exact_numbers(moments, ("moments",), 3)
        zero = Fraction(0)
        for i, moment in enumerate((a, b, c)):
            if moment < 0:
                raise InvalidParameter(("moments", i), "be at least 0 kg m^2")
        if (a, b, c).count(zero) > 1:
            raise InvalidParameter("moments", "have at most one moment of 0 kg m^2", remedy=THIN_ROD)
        return cls(((a, zero, zero), (zero, b, zero), (zero, zero, c)))

    @property
    def is_line(self) -> bool:
        """Whether one moment is zero: matter along a line, which can only turn across itself."""
        return self.determinant_at(Fraction(0)) == 0

    def require_extent(self) -> None:
        """Raise `InvalidParameter` at the question's body if a moment is zero."""
        if self.is_line:
            raise _without_extent().inside("body")

    @property
    def diagonal(self) -> bool:
        """Whether the body axes are principal axes."""
        return not any(self.tensor[i][j] for i, j in ((0, 1), (0, 2), (1, 2)))

    @property
    def trace(self) -> Fraction:
        """A + B + C."""
        return self.tensor[0][0] + self.tensor[1][1] + self.tensor[2][2]

    @cached_property
    def minors(self) -> Fraction:
        """AB + BC + CA."""
        return _symmetric_functions(self.tensor)[1]

    def determinant_at(self, x: Fraction) -> Fraction:
        """Return (A - x)(B - x)(C - x), which vanishes at the principal moments and nowhere else."""
        return _determinant(self.tensor, x)

    @cached_property
    def rational_moments(self) -> tuple[Fraction, ...] | None:
        """Principal moments in ascending order where two of them coincide or the axes are principal, else None.

        A double root of a cubic with rational coefficients is rational, and then so is the third.
        """
        if self.diagonal:
            return tuple(sorted(self.tensor[i][i] for i in range(3)))
        s, q, r = self.trace, self.minors, self.determinant_at(Fraction(0))
        # Of x^3 - s x^2 + q x - r: discriminant, and the double root by Euclid's algorithm.
        if 18 * s * q * r - 4 * s**3 * r + s * s * q * q - 4 * q**3 - 27 * r * r != 0:
            return None
        double = (s * q - 9 * r) / (2 * (s * s - 3 * q))
        return tuple(sorted((double, double, s - 2 * double)))

    @property
    def equal_moments(self) -> int:
        """How many principal moments coincide: 3, 2, or 1 where all differ."""
        moments = self.rational_moments
        return 1 if moments is None else 4 - len(set(moments))

    @property
    def symmetry(self) -> Symmetry:
        """Class of the principal moments, decided exactly."""
        moments = self.rational_moments
        if moments is None or len(set(moments)) == 3:
            return "triaxial"
        if moments[0] == 0:
            return "linear"
        if moments[0] == moments[2]:
            return "spherical"
        return "oblate" if moments[0] == moments[1] else "prolate"

    def momentum(self, angular_velocity: Vector) -> Vector:
        """Return I w."""
        x, y, z = (sum((i * w for i, w in zip(row, angular_velocity, strict=True)), Fraction(0)) for row in self.tensor)
        return x, y, z


def _without_extent() -> InvalidParameter:
    return InvalidParameter(
        (),
        "have three moments of inertia greater than 0 to rotate freely",
        remedy="give a body with extent in at least two directions",
    )


def symmetric(tensor: Sequence[Sequence[Number]]) -> Matrix:
    """Return a tensor in rational numbers.

    Raises
    ------
    InvalidParameter
        If it has not 3 rows of 3 numbers, or is not exactly symmetric.
    """
    if isinstance(tensor, str) or len(tensor) != 3:
        raise InvalidParameter("tensor", "have 3 rows")
    x, y, z = (triple(exact_numbers(row, ("tensor", i), 3)) for i, row in enumerate(tensor))
    found: Matrix = (x, y, z)
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if found[i][j] != found[j][i]:
            raise InvalidParameter(
                ("tensor", j, i),
                f"equal tensor/{i}/{j}: the tensor is symmetric",
                remedy="give both components alike; with digits nothing is taken for rounding",
            )
    return found


def of_matter(tensor: Matrix) -> bool:
    """Return whether matter can have a tensor of inertia: no principal moment exceeds the sum of the other two.

    At most one moment can exceed half the trace, so the sign of (A - s)(B - s)(C - s) at s = trace/2 tells.
    """
    return _determinant(tensor, (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 2) <= 0


def semidefinite(tensor: Matrix) -> bool:
    """Return whether no principal moment is negative."""
    return all(x >= 0 for x in _symmetric_functions(tensor))


def _determinant(tensor: Matrix, x: Fraction) -> Fraction:
    (a, b, c), (_, d, e), (_, _, f) = tensor
    a, d, f = a - x, d - x, f - x
    return a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)


def _symmetric_functions(tensor: Matrix) -> tuple[Fraction, Fraction, Fraction]:
    """Return A + B + C, AB + BC + CA and ABC."""
    (a, b, c), (_, d, e), (_, _, f) = tensor
    minors = a * d - b * b + a * f - c * c + d * f - e * e
    return a + d + f, minors, _determinant(tensor, Fraction(0))


def cross(u: Sequence[Exact], v: Sequence[Exact]) -> tuple[Exact, Exact, Exact]:
    """Return u x v."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def triple(values: Sequence[Exact]) -> tuple[Exact, Exact, Exact]:
    """Return three numbers as a vector."""
    x, y, z = values
    return x, y, z

"""Inertia in rational numbers, and what can be decided about it without rounding anything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from core.bodies.exact import parallel_axis
from core.bodies.principal_inertia import Symmetry
from core.certified.exact_inputs import Number, exact, exact_numbers
from core.errors import InvalidParameter

Vector = tuple[Fraction, Fraction, Fraction]
Matrix = tuple[Vector, Vector, Vector]

LONGEST_LIST = 100_000


@dataclass(frozen=True)
class ExactInertia:
    """A tensor of inertia whose components are rational numbers.

    Attributes
    ----------
    tensor : tuple of 3 rows of 3 fractions
        Symmetric, positive definite, in body axes about the point of rotation (kg m^2).
    """

    tensor: Matrix

    def __post_init__(self) -> None:
        a, b, d = self.tensor[0][0], self.tensor[0][1], self.tensor[1][1]
        for i, j in ((0, 1), (0, 2), (1, 2)):
            if self.tensor[i][j] != self.tensor[j][i]:
                raise InvalidParameter(("tensor", j, i), f"equal tensor/{i}/{j}: the tensor is symmetric")
        # Sylvester's criterion: positive definite if and only if the leading minors are positive.
        if not (a > 0 and a * d - b * b > 0 and self.determinant_at(Fraction(0)) > 0):
            raise InvalidParameter(
                (),
                "have three moments of inertia greater than 0 to rotate freely",
                remedy="give a body with extent in at least two directions",
            )

    @classmethod
    def of_moments(cls, moments: Sequence[Number]) -> ExactInertia:
        """Return a body given by principal moments along its axes, shape (3,)."""
        a, b, c = exact_numbers(moments, ("moments",), 3)
        zero = Fraction(0)
        for i, moment in enumerate((a, b, c)):
            if moment <= 0:
                raise InvalidParameter(("moments", i), "be greater than 0 kg m^2")
        return cls(((a, zero, zero), (zero, b, zero), (zero, zero, c)))

    @classmethod
    def of_tensor(cls, tensor: Sequence[Sequence[Number]]) -> ExactInertia:
        """Return a body given by its tensor, shape (3, 3), off-diagonal components -(integral of x y dm)."""
        if isinstance(tensor, str) or len(tensor) != 3:
            raise InvalidParameter("tensor", "have 3 rows")
        x, y, z = (_triple(exact_numbers(row, ("tensor", i), 3)) for i, row in enumerate(tensor))
        return cls((x, y, z))

    @classmethod
    def of_point_masses(
        cls, masses: Number | Sequence[Number], positions: Sequence[Sequence[Number]], about_origin: bool = False
    ) -> ExactInertia:
        """Return the inertia of points about their centre of mass, or about the origin.

        Parameters
        ----------
        masses : number or sequence of n numbers
            One number for n equal masses (kg).
        positions : sequence of n sequences of 3 numbers
            (m).
        """
        if len(positions) > LONGEST_LIST:
            raise InvalidParameter("positions", f"have at most {LONGEST_LIST} entries")
        points = [_triple(exact_numbers(point, ("positions", i), 3)) for i, point in enumerate(positions)]
        if isinstance(masses, Sequence) and not isinstance(masses, str):
            weights = exact_numbers(masses, ("masses",), len(points))
        else:
            weights = (exact(masses, "masses"),) * len(points)
        for i, weight in enumerate(weights):
            if weight <= 0:
                raise InvalidParameter(("masses", i), "be greater than 0 kg")
        if not points:
            raise InvalidParameter("positions", "have at least one entry")
        total = sum(weights, Fraction(0))
        center = [sum((m * p[k] for m, p in zip(weights, points, strict=True)), Fraction(0)) / total for k in range(3)]
        nothing = [[Fraction(0)] * 3 for _ in range(3)]
        about = nothing
        for m, p in zip(weights, points, strict=True):
            offset = p if about_origin else [p[k] - center[k] for k in range(3)]
            about = [
                [x + y for x, y in zip(row, more, strict=True)]
                for row, more in zip(about, parallel_axis(m, offset, nothing), strict=True)
            ]
        x, y, z = (_triple(row) for row in about)
        return cls((x, y, z))

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
        (a, b, c), (_, d, e), (_, _, f) = self.tensor
        return a * d - b * b + a * f - c * c + d * f - e * e

    def determinant_at(self, x: Fraction) -> Fraction:
        """Return (A - x)(B - x)(C - x), which vanishes at the principal moments and nowhere else."""
        (a, b, c), (_, d, e), (_, _, f) = self.tensor
        a, d, f = a - x, d - x, f - x
        return a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)

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
        if moments[0] == moments[2]:
            return "spherical"
        return "oblate" if moments[0] == moments[1] else "prolate"

    @property
    def physical(self) -> bool:
        """Whether matter can have this inertia: no moment exceeds the sum of the other two.

        At most one moment can exceed half the trace, so the sign of (A - s)(B - s)(C - s) at s = trace/2 tells.
        """
        return self.determinant_at(self.trace / 2) <= 0

    def momentum(self, angular_velocity: Vector) -> Vector:
        """Return I w."""
        x, y, z = (sum((i * w for i, w in zip(row, angular_velocity, strict=True)), Fraction(0)) for row in self.tensor)
        return x, y, z


def cross(u: Sequence[Fraction], v: Sequence[Fraction]) -> Vector:
    """Return u x v."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def _triple(values: Sequence[Fraction]) -> Vector:
    x, y, z = values
    return x, y, z

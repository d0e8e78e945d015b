"""Principal moments and principal axes of a tensor of inertia."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from core.arrays import Floats
from core.bodies.exact import Matrix, exact_matrix
from core.errors import InvalidParameter

Symmetry = Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]

EPSILON = 2.0**-52
EQUAL = 16.0 * EPSILON
"""Moments that differ by less than this share of the largest are called equal; inputs that are doubles say no more."""

RESOLUTION = 2.0**-96
"""Differences of derived moments, and derived components, below this share of the largest are those of rounding."""


NOTHING = Fraction(1, 2**3000)
"""A share that is below any that doubles can make, and above the rounding of `core.bodies.mass_moments`."""


class Rounding(NamedTuple):
    """What is known of the components of a tensor of inertia, each the sum of two doubles.

    Attributes
    ----------
    share : float
        What a component may be wrong by, as a share of itself where zeros are exact, else of the largest component.
    exact_zeros : bool
        Whether components that are zero, and moments that are equal, are so exactly: then the axes of a diagonal tensor
        are exact as well.
    """

    share: float
    exact_zeros: bool


GIVEN = Rounding(0.0, True)
"""The components are the numbers that were given."""

ROUNDED_ONCE = Rounding(2.0**-103, True)
"""Each component is a rational number, rounded to a pair of doubles."""

DERIVED = Rounding(2.0**-100, False)
"""Moments and axes of a tensor that is not diagonal."""


def summed(terms: int) -> Rounding:
    """Return what is known of sums of so many terms in double-double.

    A term is right to 16 units of 2^-106 and an addition to 3 of the sum so far (Joldes, Muller, Popescu 2017).
    """
    return Rounding(max(DERIVED.share, 2.0**-104 * (terms + 16)), False)


ZEROS = np.zeros((3, 3))
ZEROS.setflags(write=False)

_NO_TAILS = ZEROS[0]


def _along_body_axes(order: tuple[int, int, int], sign: float) -> Floats:
    axes = np.zeros((3, 3))
    for column, row in enumerate(order):
        axes[row, column] = 1.0
    axes[order[2], 2] = sign
    axes.setflags(write=False)
    return axes


_EVEN, _ODD = ((0, 1, 2), (1, 2, 0), (2, 0, 1)), ((0, 2, 1), (1, 0, 2), (2, 1, 0))
_PERMUTED = {order: _along_body_axes(order, 1.0) for order in _EVEN} | {
    order: _along_body_axes(order, -1.0) for order in _ODD
}
"""Right-handed axes by the body axes along which they lie, up to sign."""


class KnownTensor(NamedTuple):
    """A tensor of inertia in rational numbers, as exact as those of the body, and in doubles of order one."""

    components: Matrix
    near_one: list[list[float]]

    def turns_steadily(self, angular_velocity: Floats) -> bool:
        """Return whether a rotation about an angular velocity, shape (3,), is steady: I w along w, exactly."""
        # First in doubles, of order one.
        (a, d, e), (_, b, f), (_, _, c) = self.near_one
        x, y, z = angular_velocity.tolist()
        size = max(abs(x), abs(y), abs(z)) or 1.0
        x, y, z = x / size, y / size, z / size
        p, q, r = a * x + d * y + e * z, d * x + b * y + f * z, e * x + f * y + c * z
        if max(abs(q * z - r * y), abs(r * x - p * z), abs(p * y - q * x)) > 2.0**-40:
            return False
        w = [Fraction(float(x)) for x in angular_velocity]
        rows = [[i * v for i, v in zip(row, w, strict=True)] for row in self.components]
        momentum = [sum(row, Fraction(0)) for row in rows]
        least = NOTHING * max(abs(term) for row in rows for term in row) * max(map(abs, w))
        return all(abs(momentum[j] * w[k] - momentum[k] * w[j]) <= least for j, k in ((0, 1), (1, 2), (2, 0)))


@dataclass(frozen=True, eq=False)
class PrincipalInertia:
    """Principal moments of inertia and the axes to which they belong, with 106 bits each.

    Attributes
    ----------
    moments, moments_tail : ndarray, shape (3,)
        Ascending; the moment is the unevaluated sum of both (kg m^2).
    axes, axes_tail : ndarray, shape (3, 3)
        Columns are the principal axes in body axes, right-handed (determinant +1), so that
        ``inertia = axes @ diag(moments) @ axes.T``. Where moments coincide any choice within their plane is one.
    rounding : Rounding
        What is known of moments and axes; with exact zeros the axes are body axes, exactly.
    tensor : KnownTensor, optional
        The tensor from which moments and axes were derived, where it is not diagonal but exact.
    """

    moments: Floats
    moments_tail: Floats
    axes: Floats
    axes_tail: Floats
    rounding: Rounding = GIVEN
    tensor: KnownTensor | None = None

    @classmethod
    def of(
        cls,
        inertia: Floats,
        inertia_tail: Floats | None = None,
        rounding: Rounding = GIVEN,
        exact: Matrix | None = None,
    ) -> PrincipalInertia:
        """Diagonalise a symmetric tensor given as the sum of two arrays of shape (3, 3).

        What is known of the components is `rounding`; before they were rounded they may have been `exact`.

        A diagonal tensor is only sorted: its moments stay as they are and its axes are an exact signed permutation.
        Otherwise moments are right to about 1e-30 of the largest (decoupled ones to 1e-31 of themselves) and
        those of a graded tensor to their own size. A moment below that resolution is stated as zero: its
        digits, and its sign, would be those of rounding.

        Raises
        ------
        InvalidParameter
            If a moment is too large for a double.
        """
        tail = ZEROS if inertia_tail is None else inertia_tail
        (a, d, e), (_, b, f), (_, _, c) = inertia.tolist()
        if d == 0.0 and e == 0.0 and f == 0.0:
            return cls.along_body_axes((a, b, c), tail, rounding)
        found = cls._diagonalised(inertia, tail)
        share = max(DERIVED.share, rounding.share)
        if exact is None and rounding == GIVEN:
            exact = exact_matrix(inertia, tail)
        exponent = math.frexp(float(np.max(np.abs(inertia))))[1]
        known = None if exact is None else KnownTensor(exact, np.ldexp(inertia, -exponent).tolist())
        return replace(found, rounding=Rounding(share, False), tensor=known)

    @classmethod
    def along_body_axes(
        cls, values: tuple[float, float, float], tail: Floats = ZEROS, rounding: Rounding = GIVEN
    ) -> PrincipalInertia:
        """Return the principal inertia of a diagonal tensor with these moments, their tails on the diagonal of `tail`.

        The moments are only sorted: they stay as they are, and the axes are an exact signed permutation.
        """
        if tail is ZEROS:
            order = sorted((0, 1, 2), key=values.__getitem__)
            tails = _NO_TAILS
        else:
            along = np.diagonal(tail).tolist()
            order = sorted((0, 1, 2), key=lambda i: (values[i], along[i]))
            tails = np.array([along[i] for i in order])
            tails.setflags(write=False)
        i, j, k = order
        moments = np.array((values[i], values[j], values[k]))
        moments.setflags(write=False)
        return cls(moments, tails, _PERMUTED[i, j, k], ZEROS, rounding)

    @classmethod
    def _diagonalised(cls, inertia: Floats, tail: Floats) -> PrincipalInertia:
        # Compiled code is fetched only for the tensors that need it.
        from core.bodies.jacobi import jacobi

        exponent = math.frexp(float(np.max(np.abs(inertia))))[1]
        a, e = np.ldexp(inertia, -exponent), np.ldexp(tail, -exponent)
        values, tails, vectors, vector_tails = jacobi(a, e)
        unresolved = np.abs(values) <= _resolution(a, vectors)
        values[unresolved], tails[unresolved] = 0.0, 0.0
        try:
            moments = [math.ldexp(float(x), exponent) for x in values]
        except OverflowError:
            raise InvalidParameter(
                (),
                "have principal moments within the range of doubles, up to 1.8e308 kg m^2",
                remedy="use units in which the numbers are nearer to one",
            ) from None
        return cls._sorted(moments, [math.ldexp(float(x), exponent) for x in tails], vectors, vector_tails)

    @classmethod
    def _sorted(
        cls, values: list[float], tails: list[float], vectors: Floats, vector_tails: Floats
    ) -> PrincipalInertia:
        order = sorted(range(3), key=lambda i: (values[i], tails[i]))
        axes, axes_tail = vectors[:, order], vector_tails[:, order]
        signs = [math.copysign(1.0, axes[np.argmax(np.abs(axes[:, k])), k]) for k in (0, 1)]
        signs.append((1.0 if tuple(order) in _EVEN else -1.0) * signs[0] * signs[1])
        axes, axes_tail = np.ascontiguousarray(axes * signs + 0.0), np.ascontiguousarray(axes_tail * signs + 0.0)
        found = cls(np.array([values[i] for i in order]), np.array([tails[i] for i in order]), axes, axes_tail)
        for array in (found.moments, found.moments_tail, found.axes, found.axes_tail):
            array.setflags(write=False)
        return found

    @cached_property
    def apart(self) -> tuple[bool, bool]:
        """Whether the middle moment is known to differ from the smallest, and the largest from the middle one.

        This is what every motion goes by. Moments that were given, or rounded once, differ if they are not the same; of
        derived ones a difference below the resolution is that of rounding.
        """
        i, tail = self.moments.tolist(), self.moments_tail.tolist()
        if self.rounding.exact_zeros:
            return (i[0], tail[0]) != (i[1], tail[1]), (i[1], tail[1]) != (i[2], tail[2])
        # With the tails: over many turns a difference far below an ulp is seen.
        low, high = ((i[k + 1] - i[k]) + (tail[k + 1] - tail[k]) for k in (0, 1))
        return low > RESOLUTION * i[2], high > RESOLUTION * i[2]

    @property
    def nearly_equal(self) -> bool:
        """Whether two moments that are known to differ do so by less than 16 eps of the largest."""
        low, middle, high = self.moments.tolist()
        first, second = self.apart
        return (first and middle - low <= EQUAL * high) or (second and high - middle <= EQUAL * high)

    @property
    def symmetry(self) -> Symmetry:
        """The class of the body, by a test free of scale: moments within 16 eps of the largest are equal.

        ``"spherical"`` three equal; ``"oblate"`` the two smaller equal (coin); ``"prolate"`` the two larger equal
        (American football); ``"linear"`` prolate with a smallest moment below 16 eps of the largest (needle);
        ``"triaxial"`` three distinct; ``"point"`` all zero.
        """
        low, middle, high = self.moments.tolist()
        size = max(abs(low), abs(high))
        if size == 0.0:
            return "point"
        lower, upper = middle - low <= EQUAL * size, high - middle <= EQUAL * size
        if lower and upper:
            return "spherical"
        if upper:
            return "linear" if abs(low) <= EQUAL * size else "prolate"
        return "oblate" if lower else "triaxial"


def _resolution(tensor: Floats, vectors: Floats) -> Floats:
    """Return, per eigenvalue, what one part in 2^102 of each component of the tensor would move it.

    An eigenvalue is v.A.v, so its share of the rounding of A is |v|.|A|.|v|: nothing for an axis that is decoupled
    from the large components.
    """
    v = np.abs(vectors)
    share: Floats = 2.0**-102 * np.einsum("ik,ij,jk->k", v, np.abs(tensor), v)
    return share

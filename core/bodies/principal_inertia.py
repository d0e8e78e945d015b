"""Principal moments and principal axes of a tensor of inertia."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.errors import InvalidParameter

Floats = NDArray[np.float64]
Symmetry = Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]

EPSILON = 2.0**-52
EQUAL = 16.0 * EPSILON
"""Moments that differ by less than this share of the largest are called equal; inputs that are doubles say no more."""

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
    """

    moments: Floats
    moments_tail: Floats
    axes: Floats
    axes_tail: Floats

    @classmethod
    def of(cls, inertia: Floats, inertia_tail: Floats | None = None) -> PrincipalInertia:
        """Diagonalise a symmetric tensor given as the sum of two arrays of shape (3, 3).

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
            return cls.along_body_axes((a, b, c), tail)
        return cls._diagonalised(inertia, tail)

    @classmethod
    def along_body_axes(cls, values: tuple[float, float, float], tail: Floats = ZEROS) -> PrincipalInertia:
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
        return cls(moments, tails, _PERMUTED[i, j, k], ZEROS)

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

"""Scrambled Sobol points: any stretch of the sequence, without those before it.

Point n is the exclusive or of a shift and of the direction numbers whose digits the Gray code of n has. The direction
numbers are scrambled by random lower triangular matrices over the field of two elements, which moves every point and
keeps how evenly they lie.

References
----------
S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM Journal on Scientific
Computing 30 (2008) 2635 (the direction numbers, of `new-joe-kuo-6.21201`). J. Matousek, "On the L2-discrepancy for
anchored boxes", Journal of Complexity 14 (1998) 527 (the scrambling).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats

BITS = 30
"""Binary digits of a coordinate; there are two to this power of points."""

_PRIMITIVE = (1, 3, 7, 11, 13, 19, 25, 37, 41, 47, 55, 59, 61, 67, 91, 97, 103, 109, 115, 131)
"""Coefficients of the primitive polynomial of each dimension as binary digits, the first for the leading power."""

_FIRST = (
    (1,),
    (1,),
    (1, 3),
    (1, 3, 1),
    (1, 1, 1),
    (1, 1, 3, 3),
    (1, 3, 5, 13),
    (1, 1, 5, 5, 17),
    (1, 1, 5, 5, 5),
    (1, 1, 7, 11, 19),
    (1, 1, 5, 1, 1),
    (1, 1, 1, 3, 11),
    (1, 3, 5, 5, 31),
    (1, 3, 3, 9, 7, 49),
    (1, 1, 1, 15, 21, 21),
    (1, 3, 1, 13, 27, 49),
    (1, 1, 1, 15, 7, 5),
    (1, 3, 1, 15, 13, 25),
    (1, 1, 5, 5, 19, 61),
    (1, 3, 7, 11, 23, 15, 103),
)
"""First direction numbers of each dimension, as many as the degree of its polynomial."""

MOST_DIMENSIONS = len(_FIRST)

Digits = NDArray[np.uint32]


class SobolPoints:
    """Scrambled Sobol points of a number of dimensions.

    Parameters
    ----------
    dimensions : int
        At most `MOST_DIMENSIONS`.
    chance : numpy.random.Generator
        Draws the scrambling.
    """

    def __init__(self, dimensions: int, chance: np.random.Generator) -> None:
        drawn = chance.integers(2, size=(dimensions, BITS), dtype=np.uint32)
        self._shift: Digits = drawn @ (np.uint32(1) << np.arange(BITS, dtype=np.uint32))
        matrices = np.tril(chance.integers(2, size=(dimensions, BITS, BITS), dtype=np.uint32))
        matrices[:, range(BITS), range(BITS)] = 1
        digits = np.array([_direction_digits(k) for k in range(dimensions)], dtype=np.uint32)
        scrambled = (digits @ matrices.transpose(0, 2, 1)) & 1
        self._directions: Digits = scrambled @ (np.uint32(1) << np.arange(BITS - 1, -1, -1, dtype=np.uint32))

    def points(self, start: int, stop: int) -> Floats:
        """Return the points from number `start` up to `stop`, from 0 to 1, shape (stop - start, dimensions)."""
        numbers = np.arange(start, stop, dtype=np.uint32)
        gray = numbers ^ (numbers >> np.uint32(1))
        found = np.tile(self._shift, (len(numbers), 1))
        for bit in range((stop - 1).bit_length()):
            found ^= ((gray >> np.uint32(bit)) & np.uint32(1))[:, None] * self._directions[:, bit]
        return np.ldexp(found, -BITS)


def _direction_digits(dimension: int) -> list[list[int]]:
    """Return the binary digits after the point of the direction numbers of a dimension, shape (BITS, BITS)."""
    if dimension == 0:
        numbers = [1] * BITS
    else:
        polynomial, numbers = _PRIMITIVE[dimension], list(_FIRST[dimension])
        degree = len(numbers)
        for k in range(degree, BITS):
            new = numbers[k - degree]
            for j in range(1, degree + 1):
                if (polynomial >> (degree - j)) & 1:
                    new ^= numbers[k - j] << j
            numbers.append(new)
    return [
        [(number << (BITS - 1 - k)) >> (BITS - 1 - place) & 1 for place in range(BITS)]
        for k, number in enumerate(numbers)
    ]

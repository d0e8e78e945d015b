"""Arrays of doubles and of integers, as annotations, and how large they are; shapes are in the docstrings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def largest_magnitude(values: Floats) -> float:
    """Return the largest magnitude among numbers, zero of none."""
    # Methods: numpy's functions of these names take five times as long on the few numbers of an answer.
    return float(np.abs(values).max(initial=0.0))


def row_lengths(rows: Floats) -> Floats:
    """Return the Euclidean length of every row of an array of shape (n, k)."""
    found: Floats = np.sqrt((rows * rows).sum(axis=1))
    return found

"""Arrays of doubles, complex numbers and integers, as annotations, and how large they are; docstrings give shapes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Integers = NDArray[np.int64]


def largest_magnitude(values: Floats) -> float:
    """Return the largest magnitude among numbers, zero of none."""
    return largest(np.abs(values))


def largest(values: Floats) -> float:
    """Return the largest of numbers that are not negative, zero of none."""
    # By the reduction itself: numpy's methods and functions of these names come to it through Python, which takes as
    # long again, or five times as long, on the few numbers of an answer.
    return float(np.maximum.reduce(values, axis=None, initial=0.0))


def row_lengths(rows: Floats) -> Floats:
    """Return the Euclidean length of every row of an array of shape (n, k)."""
    found: Floats = np.sqrt(np.add.reduce(rows * rows, axis=1))
    return found

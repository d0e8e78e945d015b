"""What is asked of every peer: bodies, starts, horizons, and 10000 samples each."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats

SAMPLES = 10_000

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Case:
    """One question.

    Attributes
    ----------
    name : str
    moments, start : tuple of 3 floats
        Principal moments, and the angular velocity along their axes at t = 0. ExtractedArrays as exact.
    stop : float
        The samples are evenly spaced from 0 to here.
    note : str
        Where it comes from.
    attitude : bool
        Whether the samples are quaternions [w, x, y, z], body to space, from [1, 0, 0, 0], or angular velocities.
    """

    name: str
    moments: Triple
    start: Triple
    stop: float
    note: str
    attitude: bool = False

    @property
    def times(self) -> Floats:
        """Times of the samples, shape (10000,)."""
        return np.linspace(0.0, self.stop, SAMPLES)

    @property
    def coefficients(self) -> Triple:
        """The three factors of Euler's equations, x' = p y z, y' = q z x, z' = r x y."""
        a, b, c = self.moments
        return (b - c) / a, (c - a) / b, (a - b) / c


A123 = Case("A123", (1.0, 2.0, 3.0), (0.1, 1.0, 0.1), 20.0, "moments 1, 2, 3, spun about the middle axis")
T_HANDLE = Case(
    "T-handle",
    (837.2, 714.0, 437.7),
    (1.0, 10.0, 1.0),
    20.0,
    "moments of the tumbling T-handle, 7 flips",
)
NEAR_SEPARATRIX = Case(
    "near separatrix",
    (1.0, 2.0, 3.0),
    (1e-8, 1.0, 1.001e-8),
    100.0,
    "a spin about the middle axis but for 1e-8 along the others, 1 - m = 2e-16",
)
LONG = Case("long", A123.moments, A123.start, 1e4, "A123 for 500 times as long")
SCIML = Case(
    "SciML",
    (1.0, 4.0, 6.0),
    (1.0, 0.0, 0.9),
    10.0,
    "the rigid-body problem of SciMLBenchmarks, coefficients (-2, 1.25, -0.5): moments 1, 4, 6, more than any body has",
)
DETEST_B5 = Case(
    "DETEST B5",
    (2.0, 3.0, 1.0),
    (0.0, 0.51**0.5, 3.0**0.5),
    20.0,
    "y' = (y2 y3, -y1 y3, -0.51 y1 y2) from (0, 1, 1): moments 2, 3, 1 with w = (√1.53 y1, √0.51 y2, √3 y3)",
)
ATTITUDES = tuple(replace(case, name=f"{case.name}, attitude", attitude=True) for case in (A123, T_HANDLE))
CASES = (A123, T_HANDLE, NEAR_SEPARATRIX, LONG, SCIML, DETEST_B5, *ATTITUDES)

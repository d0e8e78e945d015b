"""Rates of the linearised equation about each principal axis, compiled; see `core.rotation.stability`.

There are at most ten operations in double-double with separate exponents, each accurate to 4 2^-106, and one final
rounding. The rates are the nearest doubles, unless the exact value is within 1e-13 units in the last place of the
midpoint between two doubles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import sc_abs, sc_div, sc_mul, sc_sqrt, scaled
from core.rotation.closed_form.circulation import difference
from core.rotation.precession.figures import stated


class LinearRates(NamedTuple):
    """Rates about one axis; `OUT_OF_RANGE` if a rate is outside the range of normal doubles (1/s)."""

    turning: float
    """Rate of the rotation itself (rad/s)."""
    size: float
    """Magnitude of the two eigenvalues that may differ from 0."""
    drift: float
    """If the moment is equal to exactly one other: linear rate of drift per unit of disturbance."""


@kernel()
def linear_rates(
    i: NDArray[np.float64], it: NDArray[np.float64], rate: float
) -> tuple[LinearRates, LinearRates, LinearRates]:
    """Return the rates about the axes of three moments i + it in ascending order, all positive."""
    W = sc_abs(scaled(rate, 0.0, 0))
    A, B, C = scaled(i[0], it[0], 0), scaled(i[1], it[1], 0), scaled(i[2], it[2], 0)
    AB, BC, AC = difference(i, it, 1, 0), difference(i, it, 2, 1), difference(i, it, 2, 0)
    a = stated(sc_mul(W, sc_sqrt(sc_div(sc_mul(AB, AC), sc_mul(B, C)))))
    b = stated(sc_mul(W, sc_sqrt(sc_div(sc_mul(AB, BC), sc_mul(A, C)))))
    c = stated(sc_mul(W, sc_sqrt(sc_div(sc_mul(AC, BC), sc_mul(A, B)))))
    low, high = 0.0, 0.0
    if AB.high == 0.0:
        low = stated(sc_div(sc_mul(W, AC), A))
    elif BC.high == 0.0:
        high = stated(sc_div(sc_mul(W, AC), C))
    middle = low if AB.high == 0.0 else high
    return LinearRates(rate, a, low), LinearRates(rate, b, middle), LinearRates(rate, c, high)

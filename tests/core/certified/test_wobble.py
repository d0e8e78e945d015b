"""The bounds of a wobble's figures against 60 digits of mpmath."""

from __future__ import annotations

from typing import Any

import mpmath
from hypothesis import given
from hypothesis import strategies as st

from core.certified.wobble import wobble_errors
from core.rotation.wobble import (
    SOLAR_DAY_IN_ROTATIONS,
    Wobble,
    from_ellipticity,
    from_period,
    rotations_of_ellipticity,
    rotations_of_period,
)

DAYS = st.sampled_from(("sidereal", "solar"))


def expect_bounded(wobble: Wobble, errors: dict[str, Any], asymmetry: Any, day: str) -> None:
    """Compare with the shape of the body, found from its moments 2 a^2 and a^2 + c^2 with a = 1."""
    with mpmath.workdps(700):
        c = mpmath.sqrt(2 / (1 + asymmetry) - 1)
        unit = mpmath.mpf(SOLAR_DAY_IN_ROTATIONS) if day == "solar" else mpmath.mpf(1)
        true = {
            "period": 1 / asymmetry / unit,
            "rotations": 1 / asymmetry,
            "asymmetry": asymmetry,
            "ellipticity": 1 / c,
            "flattening": 1 - c,
        }
        for name, figure in true.items():
            wrong = abs(mpmath.mpf(getattr(wobble, name)) - figure)
            assert wrong <= errors[name], name
            # No bound is wider than a unit in the last place, or than the working precision of the bounds.
            assert errors[name] <= 2.0**-51 * abs(figure) + 1e-70, name


@given(period=st.floats(1.01, 1e300), day=DAYS)
def test_bounds_from_a_period(period: float, day: Any) -> None:
    rotations = rotations_of_period(period, day)
    with mpmath.workdps(700):
        unit = mpmath.mpf(SOLAR_DAY_IN_ROTATIONS) if day == "solar" else mpmath.mpf(1)
        asymmetry = 1 / (mpmath.mpf(period) * unit)
    expect_bounded(from_period(period, day), wobble_errors(from_period(period, day), rotations), asymmetry, day)


@given(ratio=st.floats(1.0, 1e7, exclude_min=True), day=DAYS)
def test_bounds_from_a_ratio_of_axes(ratio: float, day: Any) -> None:
    wobble, rotations = from_ellipticity(ratio, day), rotations_of_ellipticity(ratio)
    with mpmath.workdps(700):
        c = 1 / mpmath.mpf(ratio)
        asymmetry = (1 - c * c) / (1 + c * c)
    expect_bounded(wobble, wobble_errors(wobble, rotations), asymmetry, day)

"""Wobble against what follows from Euler's equations by rational arithmetic, and against the source's slip."""

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import InvalidParameter
from core.rotation.wobble import EARTH, from_ellipticity, from_period


def test_four_hundred_and_thirty_days():
    sidereal, solar = from_period(430.0), from_period(430.0, "solar")
    assert sidereal.asymmetry == float(Fraction(1, 430))
    assert sidereal.ellipticity == pytest.approx(1.00232829, abs=5e-9)
    assert solar.asymmetry == pytest.approx(0.00231923, abs=5e-9)
    assert solar.ellipticity == pytest.approx(1.00232193, abs=5e-9)


def test_it_is_not_the_root_of_the_ratio_of_moments():
    assert abs(from_period(430.0).ellipticity - math.sqrt(1 + 1 / 430)) > 1e-3


def test_earth_s_figures_agree_with_each_other():
    assert from_period(EARTH.rigid_period_sidereal).asymmetry == pytest.approx(EARTH.asymmetry, rel=2e-5)
    assert from_period(EARTH.rigid_period_solar, "solar").asymmetry == pytest.approx(EARTH.asymmetry, rel=2e-5)
    assert from_ellipticity(EARTH.axis_ratio).asymmetry == pytest.approx(EARTH.asymmetry_of_shape, abs=5e-9)
    flattening, dynamical = 1 / 298.257223563, 0.0032737949
    assert pytest.approx(1 / (1 - flattening), abs=5e-9) == EARTH.axis_ratio
    assert pytest.approx(dynamical / (1 - dynamical), abs=5e-9) == EARTH.asymmetry
    # The model's shape for Earth's own asymmetry is not Earth's: its density is not a scaled sphere's.
    assert from_period(1 / EARTH.asymmetry).ellipticity < EARTH.axis_ratio - 5e-5


@given(st.floats(1.001, 1e12), st.sampled_from(["sidereal", "solar"]))
@settings(deadline=None, derandomize=True)
def test_there_and_back(period, day):
    there = from_period(period, day)
    assert there.flattening == pytest.approx(1 - 1 / there.ellipticity, rel=1e-9, abs=1e-15)
    # a/c - 1 has lost the digits below an ulp of one.
    back = from_ellipticity(there.ellipticity, day)
    assert back.period == pytest.approx(period, rel=4e-16 * there.rotations + 1e-14)


def test_ellipsoid_of_that_shape_has_that_asymmetry():
    shape = from_period(430.0)
    a, c = shape.ellipticity, 1.0
    assert (2 * a * a) / (a * a + c * c) - 1 == pytest.approx(shape.asymmetry, rel=1e-12)


def test_what_no_body_does_is_refused():
    for period in (0.0, -1.0, 0.5, 1.0, math.nan, math.inf):
        with pytest.raises(InvalidParameter):
            from_period(period)
    for ratio in (1.0, 0.5, math.inf, math.nan):
        with pytest.raises(InvalidParameter):
            from_ellipticity(ratio)

"""Tolerances, against their definitions in exact decimal arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.assessment.comparisons import Data, DecDig, Interval, RelAbs, SigFig
from core.errors import InvalidParameter

sizes = st.floats(1e-12, 1e12)


def test_an_absolute_tolerance_is_a_share_of_the_scale_unless_it_is_given() -> None:
    # A true moment of 1e-9 kg m^2: with 1e-8 as it stands, 0 would be accepted.
    assert RelAbs().tolerance(1e-9, 1e-9, 0.0) == pytest.approx(1e-11, rel=1e-5)
    assert RelAbs(rtol=0.0).tolerance(0.0, 5.0, 0.0) == 5e-8
    assert RelAbs(rtol=0.1, atol=1.0).tolerance(2.0, 99.0, 0.0) == pytest.approx(1.2)


@given(size=sizes, digits=st.integers(1, 15))
def test_significant_figures_are_those_of_the_written_decimal(size: float, digits: int) -> None:
    width = Fraction(SigFig(digits).tolerance(size, size, 0.0)) / Fraction(51, 100)
    # The unit of the last digit is that power of ten of which the number has as many digits.
    assert 10 ** (digits - 1) * (1 - Fraction(1, 10**12)) <= Fraction(size) / width
    assert Fraction(size) / width < 10**digits * (1 + Fraction(1, 10**12))
    assert Fraction(str(float(f"{float(width):.6e}"))).numerator in {1, *(10**k for k in range(1, 13))}


def test_a_number_just_below_a_power_of_ten_has_one_digit_less() -> None:
    assert SigFig(1).tolerance(999999999999.998, 1.0, 0.0) == pytest.approx(5.1e10)


def test_significant_figures_of_zero_are_those_of_its_scale() -> None:
    assert SigFig(3).tolerance(0.0, 20.0, 0.0) == pytest.approx(0.051)
    assert SigFig(3).tolerance(0.0, 0.0, 0.0) == 0.0


@given(digits=st.integers(-12, 12), size=sizes)
def test_decimal_places_do_not_depend_on_the_size(digits: int, size: float) -> None:
    assert DecDig(digits).tolerance(size, size, 0.0) == 0.51 * 10.0**-digits


def test_data_accept_a_multiple_of_what_is_propagated() -> None:
    assert Data().tolerance(1.0, 1.0, 0.25) == 0.25
    assert Data(factor=2.0).tolerance(1.0, 1.0, 0.25) == 0.5


def test_limits_have_no_tolerance_and_an_order() -> None:
    assert math.isinf(Interval(1.0, 2.0).tolerance(1.0, 1.0, 0.0))
    with pytest.raises(InvalidParameter) as fault:
        Interval(2.0, 1.0)
    assert fault.value.path == ("upper",)


@pytest.mark.parametrize(
    "make",
    [
        lambda: RelAbs(rtol=math.nan),
        lambda: RelAbs(atol=-1.0),
        lambda: RelAbs(rtol=1.0),
        lambda: SigFig(0),
        lambda: SigFig(16),
        lambda: DecDig(301),
        lambda: DecDig(-16),
        lambda: Data(factor=0.0),
        lambda: Interval(math.nan, 1.0),
        lambda: Interval(0.0, math.inf),
    ],
)
def test_what_is_no_tolerance_is_refused(make) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InvalidParameter):
        make()

from decimal import Decimal, localcontext
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import Undetermined, precision
from core.digits.decimals import decimal, decimal_of_fraction, floor_below, numeral, place_of
from core.digits.exact_inputs import enclosed

anything = st.builds(
    lambda top, bottom, exponent: Fraction(top, bottom) * Fraction(10) ** exponent,
    st.integers(-(10**60), 10**60),
    st.integers(1, 10**60),
    st.integers(-400, 400),
)


def significant(written: str) -> int:
    return len(written.lower().split("e")[0].replace("-", "").replace(".", "").lstrip("0"))


def unit(written: str) -> Fraction:
    """Return one unit of the last digit."""
    exponent = Decimal(written).as_tuple().exponent
    assert isinstance(exponent, int)
    return Fraction(10) ** exponent


@settings(deadline=None, derandomize=True)
@given(anything, st.integers(1, 60), st.integers(2, 400))
def test_a_ball_gives_digits_that_hold_for_all_of_it_or_none(number: Fraction, digits: int, bits: int):
    with precision(bits):
        ball = enclosed(number)
        try:
            written = decimal(ball, digits)
        except Undetermined:
            # With 20 bits to spare there is nothing to be in doubt about.
            assert bits < digits * 3.33 + 20
            return
    assert abs(Fraction(written) - number) <= Fraction(51, 100) * unit(written) or number == 0
    assert number == 0 or significant(written) == digits


@settings(deadline=None, derandomize=True)
@given(anything, st.integers(1, 60))
def test_fractions_are_rounded_to_nearest(number: Fraction, digits: int):
    written = decimal_of_fraction(number, digits)
    with localcontext() as context:
        context.prec = digits
        context.Emax, context.Emin = 999999, -999999
        assert Decimal(written) == Decimal(number.numerator) / Decimal(number.denominator)
    assert number == 0 or significant(written) == digits


@pytest.mark.parametrize(
    ("number", "written"),
    [
        ("0.99999999", "1.000"),
        ("-0.99999999", "-1.000"),
        ("123456", "1.235e5"),
        ("1234", "1234"),
        ("0.00012345678", "0.0001235"),
        ("0.000012345678", "1.235e-5"),
        ("99999", "1.000e5"),
        ("9999.9", "1.000e4"),
        ("0", "0"),
        ("0.5", "0.5000"),
    ],
)
def test_numerals(number: str, written: str):
    with precision(100):
        assert decimal(arb(number), 4) == written
    assert decimal_of_fraction(Fraction(number), 4) == written
    assert float(written) == pytest.approx(float(number), rel=1e-3)


@pytest.mark.parametrize(("number", "written"), [("2.5", "2"), ("3.5", "4"), ("-0.45", "-0.4"), ("95", "1e2")])
def test_fractions_between_two_numerals_become_the_even_one(number: str, written: str):
    assert Decimal(decimal_of_fraction(Fraction(number), 1)) == Decimal(written)


def test_numbers_indistinguishable_from_zero_are_printed_to_the_floor_or_not_at_all():
    with precision(100):
        around = arb(0, "1e-25")
        with pytest.raises(Undetermined):
            decimal(around, 16)
        assert decimal(around, 16, -20) == "0e-20"
        with pytest.raises(Undetermined):
            decimal(around, 16, -26)
        assert decimal(arb("1.23456789e-18") + around, 16, -20) == "1.23e-18"
        assert decimal(arb("0.6e-20"), 16, -20) == "1e-20"
        with pytest.raises(Undetermined):
            decimal(arb("nan"), 16, -20)
        # Expanded in decimals this would have 400 million digits.
        assert decimal((arb(-(10**9))).exp(), 16, -20) == "0e-20"


def test_a_rounding_that_the_ball_straddles_is_within_the_statement():
    with precision(100):
        assert decimal(arb("1.2345", "1e-7"), 4) in ("1.234", "1.235")
        with pytest.raises(Undetermined):
            decimal(arb("1.2345", "1e-4"), 4)


def test_places():
    assert numeral(0, -7, 4, False) == "0e-7"
    with precision(100):
        assert place_of(arb(12345)) == 4
        assert floor_below(arb("1e-300"), 30) in (-360, -361)

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.digits.exact_inputs import LARGEST_EXPONENT, LONGEST_NUMERAL, enclosed, evenly_spaced, exact, exact_numbers
from core.errors import InvalidParameter


@pytest.mark.parametrize(
    ("given_as", "is_"),
    [
        ("0.1", Fraction(1, 10)),
        (0.1, Fraction(3602879701896397, 36028797018963968)),
        ("-12.50", Fraction(-25, 2)),
        ("6.02e23", Fraction(602 * 10**21)),
        (".5E-3", Fraction(1, 2000)),
        ("7.", Fraction(7)),
        (3, Fraction(3)),
        (5e-324, Fraction(1, 2**1074)),
        (Fraction(1, 3), Fraction(1, 3)),
    ],
)
def test_numbers_are_exact(given_as, is_):
    assert exact(given_as, "x") == is_


def test_the_longest_numerals_are_read_to_the_last_digit():
    written = "0." + "1" * (LONGEST_NUMERAL - 2)
    assert exact(written, "x") == Fraction(10 ** (LONGEST_NUMERAL - 2) // 9, 10 ** (LONGEST_NUMERAL - 2))
    with pytest.raises(InvalidParameter):
        exact(written + "1", "x")


NO_NUMERALS = ["", "1/3", "nan", "inf", "1_000", " 1", "0x10", "1e", "١", "1" * 2000, "1e1001", "1e-999999", "--1"]
NO_NUMBERS = [None, True, 1j, math.inf, -math.inf, math.nan, [1]]


@pytest.mark.parametrize("wrong", [*NO_NUMERALS, *NO_NUMBERS])
def test_what_is_no_number_is_refused_with_its_place(wrong):
    with pytest.raises(InvalidParameter) as caught:
        exact_numbers([1.0, wrong], ("moments",))
    assert caught.value.path == ("moments", 1)


def test_lists_are_counted():
    assert exact_numbers(["1", 2], ("x",), 2) == (1, 2)
    for wrong in ("12", 3.0, [1.0]):
        with pytest.raises(InvalidParameter):
            exact_numbers(wrong, ("x",), 2)  # type: ignore[arg-type]


@settings(deadline=None, derandomize=True)
@given(st.fractions(), st.integers(2, 2000))
def test_the_ball_holds_the_number(number: Fraction, bits: int):
    with precision(bits):
        ball = enclosed(number)
        low, high = ball.lower(), ball.upper()
    with precision(4000):
        # Compared as integers, over the common denominator.
        top, bottom = number.numerator, number.denominator
        assert low * bottom <= top <= high * bottom


def test_the_largest_exponents_are_cheap_and_exact():
    assert exact(f"1e{LARGEST_EXPONENT}", "x") == 10**LARGEST_EXPONENT
    assert exact(f"1e-{LARGEST_EXPONENT}", "x") * 10**LARGEST_EXPONENT == 1


def test_evenly_spaced_numbers_are_exactly_so():
    assert evenly_spaced(Fraction(0), Fraction(1), 4) == (0, Fraction(1, 3), Fraction(2, 3), 1)
    assert evenly_spaced(Fraction(2), Fraction(1), 2) == (2, 1)
    assert evenly_spaced(Fraction(5), Fraction(1), 1) == (5,)

"""Double-double arithmetic against mpmath at 60 digits, and exactly where it must be exact."""

from fractions import Fraction

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core import double_double as dd
from tests.drawn import draws

UNIT = mpmath.mpf(2) ** -106
ordinary = st.floats(1e-100, 1e100) | st.floats(-1e100, -1e-100)
pairs = st.tuples(ordinary, st.floats(-1, 1)).map(lambda p: dd.fast_two_sum(p[0], p[0] * p[1] * 2.0**-54))


def value(pair: tuple[float, float]) -> mpmath.mpf:
    return mpmath.mpf(pair[0]) + mpmath.mpf(pair[1])


@pytest.fixture(autouse=True)
def _sixty_digits():
    with mpmath.workdps(60):
        yield


@given(ordinary, ordinary)
@settings(deadline=None, derandomize=True)
def test_sums_and_products_of_doubles_are_exact(a, b):
    for exact, (h, low) in (
        (Fraction(a) + Fraction(b), dd.two_sum(a, b)),
        (Fraction(a) * Fraction(b), dd.two_prod(a, b)),
    ):
        assert Fraction(h) + Fraction(low) == exact
        assert h == float(exact)


@given(pairs, pairs)
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_operations_are_right_to_two_units_of_106_bits(a, b):
    x, y = value(a), value(b)
    assert abs(value(dd.dd_mul(*a, *b)) - x * y) <= 3 * UNIT * abs(x * y)
    assert abs(value(dd.dd_div(*a, *b)) - x / y) <= 3 * UNIT * abs(x / y)
    assert abs(value(dd.dd_div_d(*a, b[0])) - x / b[0]) <= 3 * UNIT * abs(x / b[0])
    assert abs(value(dd.dd_add(*a, *b)) - (x + y)) <= 3 * UNIT * (abs(x) + abs(y))
    if x > 0:
        assert abs(value(dd.dd_sqrt(*a)) - mpmath.sqrt(x)) <= 3 * UNIT * mpmath.sqrt(x)


@given(st.floats(-600, 600), st.floats(-1, 1))
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_exponential(x, tail):
    pair = dd.fast_two_sum(x, x * tail * 2.0**-54)
    exact = mpmath.exp(value(pair))
    assert abs(value(dd.dd_exp(*pair)) - exact) <= (8 + abs(x)) * UNIT * exact


@given(st.floats(5e-324, 1.7e308), st.floats(5e-324, 1.7e308))
@settings(deadline=None, derandomize=True)
def test_scaled_numbers_neither_overflow_nor_underflow(a, b):
    def exact(s):
        return (mpmath.mpf(s.high) + mpmath.mpf(s.low)) * mpmath.mpf(2) ** s.exponent

    p, q = dd.scaled(a, 0.0, 0), dd.scaled(b, 0.0, 0)
    x, y = mpmath.mpf(a), mpmath.mpf(b)
    for got, want in (
        (dd.sc_mul(dd.sc_mul(p, p), q), x * x * y),
        (dd.sc_div(p, dd.sc_mul(q, q)), x / y / y),
        (dd.sc_sqrt(p), mpmath.sqrt(x)),
        (dd.sc_add(p, q), x + y),
    ):
        assert abs(exact(got) - want) <= 8 * UNIT * want


def test_scaled_number_returns_to_the_doubles_it_came_from():
    for x in (5e-324, 1e-310, 1.0, 1.7e308):
        assert dd.sc_pair(dd.scaled(x, 0.0, 0)) == (x, 0.0)

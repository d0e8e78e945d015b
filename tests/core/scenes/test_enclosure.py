"""Balls and how they become doubles: enclosures, signs, the account of what rounding cost."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import pytest
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.scenes.enclosure import (
    BITS,
    SMALLEST_NORMAL,
    UNIT_ROUNDOFF,
    ZERO,
    Rounding,
    angle_of,
    as_pair,
    exact,
    exact_pair,
    rf,
    sign,
    smaller,
    square_root,
)
from tests.drawn import draws

doubles = st.floats(allow_nan=False, allow_infinity=False)


def middle(ball: arb) -> Fraction:
    mantissa, exponent = (int(x) for x in ball.mid().man_exp())
    return Fraction(mantissa) * Fraction(2) ** exponent


@settings(deadline=None, derandomize=True)
@given(doubles, st.fractions())
def test_numbers_are_enclosed(x: float, y: Fraction) -> None:
    with precision(BITS):
        assert exact(x).is_exact()
        assert middle(exact(x)) == Fraction(x)
        assert sign(exact(x)) == (x > 0) - (x < 0)
        ball = exact(y)
        assert abs(middle(ball) - y) <= middle(ball.rad())
        # One unit in the last of so many bits.
        assert abs(middle(ball) - y) <= abs(y) / 2 ** (BITS - 1)
        assert [middle(b) for b in exact_pair((x, 2.0))] == [Fraction(x), 2]


@settings(deadline=None, derandomize=True)
@given(st.fractions(-10, 10, max_denominator=10**30).filter(lambda x: abs(x) > Fraction(1, 10**9)))
def test_a_pair_of_doubles_has_106_bits(x: Fraction) -> None:
    with precision(BITS):
        high, low = as_pair(exact(x))
    assert high == float(x)
    assert abs(Fraction(high) + Fraction(low) - x) <= abs(x) * Fraction(2) ** -106


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(*3 * [st.floats(1e-3, 1e3)], st.floats(-math.pi, math.pi), st.floats(0.1, 9.0))
def test_functions_of_balls(x: float, y: float, z: float, angle: float, size: float) -> None:
    with precision(BITS), mpmath.workdps(90):
        for found, want in (
            (rf(exact(x), exact(y), exact(z)), mpmath.elliprf(x, y, z)),
            (square_root(exact(x)), mpmath.sqrt(x)),
            (angle_of(exact(size) * exact(angle).sin(), exact(size) * exact(angle).cos()), mpmath.mpf(angle)),
        ):
            assert abs(mpmath.mpf(found.mid().str(95, radius=False)) - want) <= mpmath.mpf(10) ** -85 * (1 + abs(want))


def test_what_cannot_be_distinguished_from_zero() -> None:
    doubtful = arb("0 +/- 1e-90")
    assert sign(doubtful) == 0
    assert square_root(doubtful).is_zero()
    assert square_root(arb(-1)).is_zero()


def test_never_is_later_than_any_instant() -> None:
    assert smaller(None, None) is None
    assert smaller(ZERO, None) is ZERO
    assert smaller(None, ZERO) is ZERO
    assert smaller(arb(2), arb(1)) == arb(1)
    assert smaller(arb(1), arb(2)) == arb(1)


def test_rounding_keeps_account() -> None:
    rounding = Rounding(frozenset())
    assert rounding({"a": (exact(0.5), [ZERO, None]), "b": "text"}) == {"a": [0.5, [0.0, None]], "b": "text"}
    assert rounding.error == UNIT_ROUNDOFF
    assert rounding.sharp
    with precision(BITS):
        rounding(arb("1 +/- 1e-10"))
    # The radius, as a share of the number.
    assert rounding.error == pytest.approx(1e-10, rel=1e-5)
    assert not rounding.sharp


@pytest.mark.parametrize("text", ["1e400", "-1e309", "1e-308", "-1e-400"])
def test_values_outside_the_normal_doubles_are_left_out_and_reported_with_their_path(text: str) -> None:
    rounding = Rounding(frozenset())
    assert rounding({"deep": [arb(1), arb(text)]}, ("answer",)) == {"deep": [1.0, None]}
    (notice,) = rounding.notices
    assert notice.code == "outside-double-range"
    assert "answer/deep/1" in notice.detail


def test_the_smallest_normal_double_is_accepted() -> None:
    rounding = Rounding(frozenset())
    assert rounding(exact(SMALLEST_NORMAL)) == 2.0**-1022
    assert not rounding.notices


def test_a_zero_in_doubt_is_vague_an_exact_one_is_not() -> None:
    rounding = Rounding(frozenset())
    assert rounding(ZERO) == 0.0
    assert rounding.sharp
    assert rounding(arb("0 +/- 1e-300")) == 0.0
    assert not rounding.sharp

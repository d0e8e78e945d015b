"""Roots of quadratics and the times at which margins are left, against formulas at 500 digits and exact cases."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import pytest
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.scenes.enclosure import BITS, exact
from core.scenes.quadratics import advanced, exit_time, real_roots
from tests.core.scenes.oracles import relative
from tests.drawn import draws


@pytest.mark.parametrize(
    "coefficients",
    [(1, -3, 2), (1e-200, 1, -1), (1, 1e200, 1), (0, 2, -8), (1, 0, -4), (1e100, -2e100, 1e100), (3, 5, 0)],
)
def test_roots_of_quadratics(coefficients: tuple[float, float, float]) -> None:
    with precision(BITS), mp.workdps(500):
        found = sorted(float(root) for root in real_roots(*map(exact, coefficients)))
        a, b, c = (mp.mpf(v) for v in coefficients)
        if a == 0:
            true = [-c / b]
        else:
            root = mp.sqrt(b * b - 4 * a * c)
            true = sorted([(-b - root) / (2 * a), (-b + root) / (2 * a)])
        assert len(found) == len(true)
        for value, exactly in zip(found, true, strict=True):
            assert relative(value, exactly) < 2e-16
        assert real_roots(exact(1), exact(0), exact(1)) == []


@pytest.mark.parametrize(
    ("value", "rate", "acceleration", "time"),
    [
        (1.0, -1.0, 0.0, 1.0),
        (1.0, 1.0, 1.0, None),
        (1.0, -1.0, 1.0, None),
        (1.0, -2.0, 2.0, None),
        (1.5, -2.0, 1.0, 1.0),
        (0.0, 1.0, -2.0, 1.0),
        (0.0, -1.0, 5.0, 0.0),
        (0.0, 0.0, -1.0, 0.0),
        (0.0, 0.0, 1.0, None),
        (0.0, 1.0, 1.0, None),
        (2.0, 0.0, -1.0, 2.0),
        (2.0, 3.0, -1.0, 3 + math.sqrt(13)),
        (1e-300, -1.0, 1e-300, 1e-300),
    ],
)
def test_when_a_margin_is_left(value: float, rate: float, acceleration: float, time: float | None) -> None:
    with precision(BITS):
        found = exit_time(exact(value), exact(rate), exact(acceleration))
        assert (None if found is None else float(found)) == (time if time is None else pytest.approx(time, rel=1e-15))


root = st.fractions(-1000, 1000, max_denominator=10**6)


@settings(deadline=None, derandomize=True, max_examples=draws(80))
@given(root, root, st.fractions(Fraction(1, 10**6), 10**6), st.sampled_from([-1, 1]))
def test_rational_roots_are_enclosed(first: Fraction, second: Fraction, lead: Fraction, sign: int) -> None:
    """a (x - p)(x - q), whose roots are known without a formula."""
    a = sign * lead
    with precision(BITS):
        found = real_roots(exact(a), exact(-a * (first + second)), exact(a * first * second))
        if first == second:
            # The discriminant may be zero: one ball, or two, around the double root.
            assert all(abs(x - exact(first)) < arb(2) ** -100 for x in found)
            return
        assert len(found) == 2
        for want in (first, second):
            assert any(x.overlaps(exact(want)) and x.rad() < arb(2) ** -200 for x in found)


@settings(deadline=None, derandomize=True, max_examples=draws(150))
@given(*3 * [st.fractions(-50, 50, max_denominator=100)])
def test_a_margin_is_left_where_it_first_turns_negative(value: Fraction, rate: Fraction, bend: Fraction) -> None:
    """By the sign of the margin in rational arithmetic, shortly before and after the stated time."""

    def margin(t: Fraction) -> Fraction:
        return value + t * (rate + bend * t / 2)

    if value < 0:
        return
    with precision(BITS):
        found = exit_time(exact(value), exact(rate), exact(bend))
        shortly = Fraction(1, 10**9)
        if found is None:
            lowest = -rate / bend if bend > 0 and rate < 0 else Fraction(0)
            assert min(margin(t) for t in (Fraction(0), lowest, Fraction(10**9))) >= 0
            return
        time = Fraction(float(found))
        assert margin(time * (1 + shortly) + shortly) < 0
        # Nothing is left before: a quadratic that is not negative at three places of [0, t) and lowest between.
        for part in (Fraction(0), Fraction(1, 3), Fraction(2, 3), 1 - shortly):
            assert margin(time * part) >= 0
        assert abs(float(advanced(exact(value), exact(rate), exact(bend), found))) < 1e-60

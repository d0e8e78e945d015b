"""Elliptic integrals in pairs of doubles: against mpmath at 60 digits, their definitions, and each other.

u = 2^-53 throughout, so that 2^-106 = u^2. The pair operations are right to 3 u^2 (sum), 4 u^2 (product) and 3 u^2
(root) of themselves (Joldes, Muller, Popescu 2017), and every sum here is one of positive terms.
"""

from __future__ import annotations

import math
import random

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.elliptic.integrals import agm_dd, rf_of_roots
from tests.drawn import draws

U = 2.0**-53
SQUARE = 2.0**-106

AGM_STEPS, AGM_STEP = 14, 5 * SQUARE
"""k = 1e-285 takes 9 steps to lose its exponent and 5 to converge; each rounds a mean by at most 4 u^2/2 + 3 u^2."""

RF_STEPS, RF_STEP = 22, 8 * SQUARE
"""Duplications for arguments 1e-300 to 1e300, and half of the 16 u^2 (three roots, a product and sums) of each."""


def number(high: float, low: float) -> mpmath.mpf:
    return mpmath.mpf(high) + mpmath.mpf(low)


@pytest.fixture(autouse=True)
def _sixty_digits():
    with mpmath.workdps(60):
        yield


decades = st.floats(-300, 0).map(lambda e: 10.0**e)
halves = st.floats(2.0**-20, 0.5)
small = decades.filter(lambda x: x <= 0.5) | halves
"""The smaller of m and m1, down to 1e-300."""


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(st.floats(-285, 0).map(lambda e: 10.0**e), st.floats(-1, 1))
def test_arithmetic_geometric_mean(k: float, part: float) -> None:
    tail = part * 0.49 * math.ulp(k) if k > 1e-270 else 0.0
    want = mpmath.agm(1, number(k, tail))
    assert abs(number(*agm_dd(k, tail)) - want) <= AGM_STEPS * AGM_STEP * want


far_below = st.floats(-280, 0).map(lambda e: 10.0**e)
"""Roots beside one of order one: the squares leave the range of doubles, the tails of the roots do not."""
roots = st.floats(-60, 60).map(lambda e: 10.0**e)


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(far_below | st.just(0.0), far_below, st.floats(0.1, 10.0), st.permutations(range(3)))
def test_carlson_s_integral_of_roots_in_any_order(a: float, b: float, c: float, order: list[int]) -> None:
    values = [(a, b, c)[k] for k in order]
    got = number(*rf_of_roots(values[0], 0.0, values[1], 0.0, values[2], 0.0))
    want = mpmath.elliprf(*(mpmath.mpf(x) ** 2 for x in values))
    # The series of degree seven, spread 5e-5, leaves out less than (5e-5)^8 = 4e-35.
    assert abs(got - want) <= RF_STEPS * RF_STEP * want


def test_carlson_s_integral_against_its_definition() -> None:
    """DLMF 19.16.1 with t = e^s: the trapezoidal rule converges exponentially on the whole line."""
    rng = random.Random("definition")
    with mpmath.workdps(40):
        for _ in range(4):
            a, b, c = (rng.uniform(0.3, 3.0) for _ in range(3))
            x, y, z = (mpmath.mpf(r) ** 2 for r in (a, b, c))
            h = mpmath.mpf(1) / 16
            points = [mpmath.exp(h * n) for n in range(-1300, 2600)]
            terms = (t / mpmath.sqrt((t + x) * (t + y) * (t + z)) for t in points)
            want = h * mpmath.fsum(terms) / 2
            got = number(*rf_of_roots(a, 0.0, b, 0.0, c, 0.0))
            # Ends cut off at e^-80 of the whole; the poles, at distance pi, let the rule err by e^(-2 pi^2/h) only.
            assert abs(got - want) <= RF_STEPS * RF_STEP * want + mpmath.exp(-75)


@settings(deadline=None, derandomize=True)
@given(roots, roots, roots, st.integers(-60, 60))
def test_carlson_s_integral_is_homogeneous_to_the_last_bit(a: float, b: float, c: float, k: int) -> None:
    # R_F(4^k x, ...) = 2^-k R_F(x, ...): powers of two are exact, and every branch is one of ratios.
    f = math.ldexp(1.0, k)
    high, low = rf_of_roots(a, 0.0, b, 0.0, c, 0.0)
    assert rf_of_roots(f * a, 0.0, f * b, 0.0, f * c, 0.0) == (high / f, low / f)


@settings(deadline=None, derandomize=True)
@given(st.floats(1e-100, 1e100), st.floats(1e-100, 1e100))
def test_complete_carlson_is_the_mean(b: float, c: float) -> None:
    """DLMF 19.20.5, two algorithms of the module against each other: R_F(0, b^2, c^2) = pi/(2 agm(b, c))."""
    low, high = min(b, c), max(b, c)
    got = number(*rf_of_roots(0.0, 0.0, b, 0.0, c, 0.0))
    with mpmath.workdps(60):
        ratio = number(low, 0.0) / high
        h = float(ratio)
        mean = number(*agm_dd(h, float(ratio - h))) * high
        want = mpmath.pi / (2 * mean)
        assert abs(got - want) <= (AGM_STEPS * AGM_STEP + RF_STEPS * RF_STEP) * want

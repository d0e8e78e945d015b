"""Rates of the linearised equation against Euler's equation itself, differentiated in rational arithmetic.

Euler's field is quadratic, so its central difference is its derivative exactly. The square of the eigenvalues about an
axis is the product of the two entries that couple the other axes; the code has no matrix.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.rotation.precession.figures import OUT_OF_RANGE
from core.rotation.stability.linearised import linear_rates
from tests.drawn import draws

size = st.floats(-150, 150).map(lambda e: 10.0**e) | st.floats(0.5, 2.0)
part = st.floats(-0.5, 0.5)
rates = st.floats(-150, 150).map(lambda e: 10.0**e).flatmap(lambda x: st.sampled_from([x, -x]))


def field(moments, w) -> list[Fraction]:
    return [(moments[i - 2] - moments[i - 1]) / moments[i] * w[i - 2] * w[i - 1] for i in range(3)]


def derivative(moments, spin, along: int, of: int) -> Fraction:
    """Return d w_of' / d w_along, by a central difference."""
    above, below = list(spin), list(spin)
    above[along] += 1
    below[along] -= 1
    return (field(moments, above)[of] - field(moments, below)[of]) / 2


def is_nearest(found: float, square: Fraction) -> bool:
    """Tell whether a double is the one nearest to the root of a number, to 1e-13 of an ulp."""
    half = Fraction(math.ulp(found)) / 2 * (1 + Fraction(1, 10**13))
    # Below a power of two the next double is nearer: half an ulp bounds that side too.
    low, high = max(Fraction(0), Fraction(found) - half), Fraction(found) + half
    return low * low <= square <= high * high


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(st.tuples(size, size, size), part, rates)
def test_rates_are_the_nearest_doubles(moments, share, rate) -> None:
    i = np.array(sorted(moments))
    it = share * np.spacing(i)
    exact = [Fraction(a) + Fraction(b) for a, b in zip(i.tolist(), it.tolist(), strict=True)]
    for axis, found in enumerate(linear_rates(i, it, rate)):
        assert found.turning == rate
        spin = [Fraction(rate) if k == axis else Fraction(0) for k in range(3)]
        j, k = (axis + 1) % 3, (axis + 2) % 3
        square = abs(derivative(exact, spin, j, k) * derivative(exact, spin, k, j))
        assert all(derivative(exact, spin, n, n) == 0 for n in range(3))
        if found.size == OUT_OF_RANGE:
            # No normal double: below 2^-1022 or beyond the largest.
            assert square < Fraction(2) ** -2044 or square > Fraction(2) ** 2047
        elif square == 0:
            assert found.size == 0.0
        else:
            assert is_nearest(found.size, square)


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(st.tuples(size, size), part, rates, st.booleans())
def test_two_equal_moments_have_a_jordan_block_whose_entry_is_the_drift(moments, share, rate, lower) -> None:
    low, high = sorted(moments)
    i = np.array((low, low, high) if lower else (low, high, high))
    it = share * np.spacing(i)
    exact = [Fraction(a) + Fraction(b) for a, b in zip(i.tolist(), it.tolist(), strict=True)]
    for axis, found in enumerate(linear_rates(i, it, rate)):
        spin = [Fraction(rate) if k == axis else Fraction(0) for k in range(3)]
        j, k = (axis + 1) % 3, (axis + 2) % 3
        entries = [abs(derivative(exact, spin, j, k)), abs(derivative(exact, spin, k, j))]
        block = entries[0] * entries[1] == 0
        want = max(entries) if block else Fraction(0)
        if found.drift == OUT_OF_RANGE:
            assert want < Fraction(2) ** -1022 or want > Fraction(2) ** 1023
        elif want == 0:
            assert found.drift == 0.0
        else:
            assert is_nearest(found.drift, want * want)
        assert block == (found.size == 0.0)


def test_a_sphere_has_no_rates_at_all() -> None:
    for found in linear_rates(np.array([2.0, 2.0, 2.0]), np.zeros(3), 5.0):
        assert found == (5.0, 0.0, 0.0)

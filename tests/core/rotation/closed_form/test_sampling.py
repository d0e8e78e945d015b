"""What samples are made of: a quotient by a shared reciprocal, a turn into the body, the largest time."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.double_double import Scaled
from core.rotation.closed_form.constants_of_motion import constants_of_motion
from core.rotation.closed_form.sampling import largest_magnitude, quotient, sample_components, turn_into_body
from tests.drawn import draws

U = Fraction(2) ** -53
ZERO = np.zeros(3)
size = st.floats(1e-100, 1e100)


@settings(deadline=None, derandomize=True, max_examples=draws(500))
@given(size | st.floats(0.5, 1.0), size | st.floats(0.5, 1.0))
def test_a_quotient_by_a_reciprocal_is_as_good_as_a_division(above: float, below: float) -> None:
    over = 1.0 / below
    lost = float(1 - Fraction(over) * Fraction(below))
    want = Fraction(above) / Fraction(below)
    # What the reciprocal lost is at most u and given exactly; the product rounds, the sum rounds: u, and u of what
    # is left of the first rounding, which nothing takes back.
    assert abs(Fraction(quotient(above, over, lost)) - want) <= 2 * U * (1 + 4 * U) * want


def test_a_reciprocal_that_lost_its_last_place_is_made_good() -> None:
    """1/49 is off by most of half an ulp: 49 (1/49) is not 1 in doubles, the quotient is."""
    over = 1.0 / 49.0
    assert 49.0 * over != 1.0
    assert quotient(49.0, over, float(1 - Fraction(over) * 49)) == 1.0


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(
    st.lists(st.floats(-1.0, 1.0), min_size=9, max_size=9), st.lists(st.tuples(*3 * [st.floats(-1.0, 1.0)]), max_size=9)
)
def test_turning_into_the_body_rounds_three_times(entries, vectors) -> None:
    axes = np.array(entries).reshape(3, 3)
    out = np.array(vectors).reshape(-1, 3).T.copy()
    turn_into_body(axes, out)
    for n, vector in enumerate(vectors):
        for j in range(3):
            terms = [Fraction(axes[j, k]) * Fraction(vector[k]) for k in range(3)]
            bound = 3 * U * sum(abs(t) for t in terms) + 3 * Fraction(5e-324)
            assert abs(Fraction(float(out[j, n])) - sum(terms)) <= bound


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=30))
def test_largest_magnitude(times) -> None:
    assert largest_magnitude(np.array(times, dtype=float)) == max(map(abs, times), default=0.0)


@pytest.mark.parametrize("n", range(1, 10))
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_one_time_that_is_not_finite_is_found_wherever_it_stands(n: int, bad: float) -> None:
    for place in range(n):
        times = np.linspace(-1.0, 2.0, n)
        times[place] = bad
        assert largest_magnitude(times) == np.inf


@pytest.mark.parametrize(
    ("rates", "decided"),
    [((0.1, 1.0, 1.5), False), ((1.5, 1.0, 0.1), False), ((1e-7, 1.0, 2e-7), False), ((6.0, 1.0, 7.0), True)],
    ids=["circular", "other-axis", "near-the-separatrix", "separatrix"],
)
def test_energy_and_momentum_of_the_samples(rates, decided) -> None:
    """Neither enters a sample: each component stands for itself."""
    moments = np.array([14.0, 21.0, 24.0])
    motion = constants_of_motion(moments, ZERO, np.array(rates), ZERO, decided, Scaled(0.0, 0.0, 0))
    times = np.linspace(-1e4, 1e4, 2001)
    c, b, d = np.empty((3, times.size))
    sample_components(motion, times, c, b, d)
    along = (moments[2 - motion.circled], moments[1], moments[motion.circled])
    for power in (1, 2):
        terms = [i**power * x * x for i, x in zip(along, (c, b, d), strict=True)]
        want = sum(i**power * w * w for i, w in zip(moments, rates, strict=True))
        # Components to 10.7 u (docs/accuracy.md states 4 u of the largest rate), squared.
        assert np.abs(sum(terms) / want - 1).max() <= 2 * 11 * float(U)

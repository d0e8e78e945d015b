"""Points about the middle of their box: the same points, exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.recentred import Recentred
from tests.drawn import draws

# Of one axis, and at most 2^900 apart in size, so that nothing falls below the smallest double when it is scaled.
anywhere = st.floats(-1e150, 1e150).filter(lambda x: x == 0.0 or abs(x) > 1e-110)
tiny = st.floats(-1e-300, 1e-300)
huge = st.floats(-1.7976931348623157e308, 1.7976931348623157e308).filter(lambda x: x == 0.0 or abs(x) > 1e50)
nearby = st.tuples(st.floats(1e8, 1e9), st.integers(0, 2**20)).map(lambda p: p[0] + p[1] * 2.0**-20)
shared = st.just(3.7e5)
axis = st.sampled_from([anywhere, tiny, huge, nearby, shared])


def rows(data: st.DataObject) -> np.ndarray:
    n = data.draw(st.integers(1, 8))
    columns = [data.draw(st.lists(data.draw(axis), min_size=n, max_size=n)) for _ in range(3)]
    return np.array(columns).T.copy()


@settings(deadline=None, derandomize=True, max_examples=draws(80))
@given(st.data())
def test_no_point_moves_by_anything(data: st.DataObject) -> None:
    points = rows(data)
    about = Recentred.on(points)
    for k in range(3):
        unit = about.unit[k]
        # A power of two.
        assert unit.numerator & (unit.numerator - 1) == 0
        assert unit.denominator & (unit.denominator - 1) == 0
        for n, point in enumerate(points):
            value = Fraction(float(about.high[n, k])) + Fraction(float(about.low[n, k]))
            assert about.reference[k] + unit * value == Fraction(float(point[k]))
            assert abs(about.high[n, k]) < 1
            # The tail of a pair: no more than half a unit in the last place of its head.
            assert abs(about.low[n, k]) <= 0.5 * np.spacing(abs(about.high[n, k]))
        largest = np.abs(about.high[:, k]).max()
        assert largest >= 0.5 or largest == 0.0


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 5))
def test_a_coordinate_that_all_share_is_zero(x: float, n: int) -> None:
    about = Recentred.on(np.full((n, 3), x))
    assert not about.high.any()
    assert not about.low.any()
    assert about.reference == [Fraction(x)] * 3


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.lists(st.tuples(anywhere, anywhere, anywhere), min_size=2, max_size=6))
def test_the_reference_is_the_middle_of_the_box(points) -> None:
    about = Recentred.on(np.array(points))
    for k, column in enumerate(zip(*points, strict=True)):
        exact = (Fraction(min(column)) + Fraction(max(column))) / 2
        assert abs(about.reference[k] - exact) <= Fraction(2) ** -53 * max(abs(Fraction(x)) for x in column)

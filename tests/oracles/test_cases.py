"""The list of cases: the same every time, and covering what it claims to cover."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import isfinite

from .cases import cases
from .free_rotation import free_motion
from .motion import Constant, Moving

CASES = list(cases())
MOVING = [m for m in (free_motion(c.moments, c.angular_velocity, digits=20) for c in CASES) if isinstance(m, Moving)]


def test_the_list_is_the_same_every_time_and_can_be_lengthened() -> None:
    longer = list(cases(extra=3))
    assert longer[:-3] == CASES
    assert len({case.name for case in longer}) == len(CASES) + 3


def test_every_number_is_finite_and_times_are_signed_and_unordered() -> None:
    for case in CASES:
        assert all(map(isfinite, (*case.moments, *case.angular_velocity, *case.times)))
        assert all(moment > 0 for moment in case.moments)
        assert min(case.times) < 0 < max(case.times)
        assert any(one > other for one, other in pairwise(case.times))


def test_every_order_is_circled_both_ways() -> None:
    generic = [m.polhode for m in MOVING if m.polhode.m1]
    assert len({(p.axes, p.direction, p.signs) for p in generic}) >= 36


def test_the_extremes_are_reached() -> None:
    polhodes = [motion.polhode for motion in MOVING]
    assert sum(p.m1 == 0 for p in polhodes) >= 12
    assert sum(p.m == 0 for p in polhodes) >= 6
    assert sum(0 < p.m1 < Fraction(10) ** -299 for p in polhodes) >= 2
    assert sum(0 < p.m < Fraction(10) ** -290 for p in polhodes) >= 2
    assert max(max(p.moments) / min(p.moments) for p in polhodes) > 9 * 10**11
    assert len(CASES) - len(MOVING) >= 10


def test_constants_are_found_exactly() -> None:
    assert isinstance(free_motion((2.0, 2.0, 1.0), (0.1, -0.3, 0.0)), Constant)
    assert isinstance(free_motion((2.0, 2.0, 1.0), (0.1, -0.3, 5e-324)), Moving)

"""The quantities of a precession are the nearest doubles, against the oracle at 50 digits, or `UNRESOLVED`."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from core.bodies.mass_properties import diagonal
from core.rotation.precession.precession import precession
from tests.drawn import draws
from tests.oracles.free_rotation import period, precession_per_period

ULP = 2.0**-52


def of(moments, angular_velocity):
    return precession(diagonal(moments), tuple(angular_velocity))


size = st.floats(0.1, 10.0)
decade = st.integers(-140, 140).map(lambda n: 10.0**n)
slant = st.floats(-3.0, 3.0).map(lambda x: math.copysign(10.0 ** -abs(x), x))


@settings(deadline=None, max_examples=draws(150), derandomize=True)
@given(st.tuples(size, size, size, decade), st.tuples(slant, slant, slant, decade))
def test_figures_of_three_moments_are_the_nearest_doubles(moments, start):
    """At any magnitude; half a unit in the last place, and a thousandth of it for the oracle and the margin."""
    moments = tuple(moments[3] * x for x in moments[:3])
    start = tuple(start[3] * x for x in start[:3])
    found = of(moments, start)
    assume(found.symmetry == "triaxial")
    with mp.workdps(50):
        duration, angle = period(moments, start), precession_per_period(moments, start)
        for got, want in (
            (found.period, duration),
            (found.flip_interval, duration / 2),
            (found.precession_per_period, angle),
            (found.mean_precession_rate, angle / duration),
        ):
            assert abs(got - want) <= 0.5005 * math.ulp(got)


@settings(deadline=None, max_examples=draws(150), derandomize=True)
@given(st.tuples(size, size, decade), st.tuples(slant, slant, slant, decade), st.integers(0, 2))
def test_rates_of_symmetric_bodies_are_the_nearest_doubles(moments, start, axis):
    equal, single = (moments[2] * x for x in moments[:2])
    assume(equal != single)
    start = [start[3] * x for x in start[:3]]
    found = of(tuple(single if n == axis else equal for n in range(3)), start)
    assume(found.symmetry in ("oblate", "prolate"))
    with mp.workdps(50):
        i, i3, w3 = mpf(equal), mpf(single), mpf(start[axis])
        across = mp.sqrt(sum(mpf(x) ** 2 for n, x in enumerate(start) if n != axis))
        body_rate, space_rate = (i3 - i) / i * w3, mp.sqrt((i * across) ** 2 + (i3 * w3) ** 2) / i
        for got, want in (
            (found.body_rate, body_rate),
            (found.space_rate, space_rate),
            (found.period, 2 * mp.pi / abs(body_rate)),
            (found.precession_per_period, 2 * mp.pi * space_rate / abs(body_rate)),
        ):
            assert abs(got - want) <= 0.5005 * math.ulp(got)
        for got, want in (
            (found.axis_to_angular_momentum, mp.atan2(i * across, i3 * w3)),
            (found.axis_to_angular_velocity, mp.atan2(across, w3)),
        ):
            assert abs(got - want) <= math.ulp(got)


def test_the_angle_of_a_needle_is_accurate_or_unresolved():
    """Nearly all of a turn cancels: the body rate is nearly the spin itself."""
    for ratio in (1e-6, 1e-10, 1e-13):
        moments, start = (ratio, 1.0, 1.5), (1.0, 1e-3 * ratio, 0.0)
        with mp.workdps(60):
            want = precession_per_period(moments, start)
            got = of(moments, start).precession_per_period
            assert want < 10 * ratio
            assert abs(got - want) <= ULP * want
    lost = of((1e-15, 1.0, 1.5), (1.0, 1e-18, 0.0))
    assert (lost.precession_per_period, lost.mean_precession_rate) == (None, None)
    assert "too small" in lost.absent["precession_per_period"]
    assert "unresolved" in {notice.code for notice in lost.warnings}


@pytest.mark.parametrize(
    ("moments", "start", "stated"),
    [
        (
            (5.649098649909295e-42, 1.0, 1.000000002203651),
            (2.3330336393231372e-262, 1.0, 1.1812226683584236e-278),
            False,
        ),
        (
            (4.688637130473924e-33, 1.0, 1131647503901742.0),
            (1.4082126548487349e-214, 1.0, 8.520800245600288e-246),
            False,
        ),
        (
            (2.7611672325965384e-33, 1.0, 1.3248329352401351),
            (5.313593228585812e-227, 1.0, 4.249615023393171e-243),
            False,
        ),
        (
            (1.5813829061514072e-32, 1.0, 1.0000044851487366),
            (1.7155287074969192e-247, 1.0, 1.0186549762638169e-260),
            True,
        ),
        ((7.25347155063186e-29, 1.0, 3.069661013165937), (0.026165030044537956, 1.0, 1.7137760878370272e-28), True),
    ],
)
def test_more_of_a_turn_cancels_next_to_the_separatrix(moments, start, stated):
    """A quarter period of K = 600 turns by hundreds of radians there and back."""
    found = of(moments, start)
    assert (found.precession_per_period is not None) is stated
    assert (found.mean_precession_rate is not None) is stated
    if stated:
        with mp.workdps(60):
            want = precession_per_period(moments, start)
            assert abs(found.precession_per_period - want) <= math.ulp(found.precession_per_period)


def test_a_period_too_short_for_a_double_is_not_called_zero():
    found = of((1e58, 1e-162, 1e211), (1e298, 1e207, 1e-258))
    assert (found.period, found.flip_interval) == (None, None)
    assert "range" in found.absent["period"]
    assert {notice.code for notice in found.warnings} >= {"out-of-range"}


units = st.integers(-40, 40)


@settings(deadline=None, max_examples=draws(300), derandomize=True)
@given(
    st.floats(1.0, 1.9), st.tuples(units, units, st.integers(-15, 15)), st.booleans(), st.tuples(slant, slant, slant)
)
def test_figures_of_moments_that_differ_by_rounding_are_the_nearest_doubles(size, apart, coin, start):
    """All three may nearly be equal; half a unit in the last place, and a thousandth of it."""
    moments = (size + apart[0] * ULP, size + apart[2] * ULP, size + apart[1] * ULP if coin else 2.0 * size)
    start = tuple(x * 10.0 ** (3 * n) for n, x in enumerate(start))
    found = of(moments, start)
    assume(found.symmetry != "spherical" and found.regime == "periodic" and len(set(moments)) == 3)
    with mp.workdps(50):
        duration, angle = period(moments, start), precession_per_period(moments, start)
        for got, want in (
            (found.period, duration),
            (found.precession_per_period, angle),
            (found.mean_precession_rate, angle / duration),
        ):
            assert abs(got - want) <= 0.5005 * math.ulp(got)
        if found.body_rate is not None:
            assert abs(abs(found.body_rate) * duration - 2 * mp.pi) <= 2 * mp.pi * 2.0**-31

"""Precession against the oracle, against Montgomery's theorem by quadrature, and in Euler's exact figures."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from core.bodies.composite import Composite, Part
from core.bodies.exact import rotation
from core.bodies.mass_properties import MassProperties, diagonal
from core.bodies.solids import Cylinder, Disc
from core.errors import InvalidParameter
from core.rotation.precession.precession import FIGURES, precession
from tests.drawn import draws
from tests.oracles.cases import T_HANDLE, T_HANDLE_ORIGIN
from tests.oracles.free_rotation import flip_interval, free_motion, period, precession_per_period

ULP = 2.0**-52
TRIAXIAL = [
    ((1.0, 2.0, 3.0), (1.0, 1.0, 1.0)),
    ((1.0, 2.0, 3.0), (2.0, 0.3, -0.4)),
    (T_HANDLE, (1.0, 10.0, 1.0)),
    ((2.0, 1.0, 0.5), (0.1, 1.0, 0.2)),
]


def of(moments, angular_velocity):
    return precession(diagonal(moments), np.array(angular_velocity, dtype=float))


@pytest.mark.parametrize(("moments", "start"), TRIAXIAL)
def test_three_distinct_moments_against_the_oracle(moments, start):
    found = of(moments, start)
    assert (found.symmetry, found.regime) == ("triaxial", "periodic")
    for got, want in (
        (found.period, period(moments, start)),
        (found.flip_interval, flip_interval(moments, start)),
        (found.precession_per_period, precession_per_period(moments, start)),
        (found.mean_precession_rate, precession_per_period(moments, start) / period(moments, start)),
    ):
        assert abs(got - want) <= 2 * ULP * want
    assert found.body_rate is None
    assert "no axis is one of symmetry" in found.absent["body_rate"]


@pytest.mark.parametrize(("moments", "start"), TRIAXIAL)
def test_montgomery(moments, start):
    """Phi = 2 E T / L - Omega modulo a turn, the solid angle by the trapezium rule, which converges exponentially."""
    with mp.workdps(30):
        duration = period(moments, start)
        i, w0 = [mpf(x) for x in moments], [mpf(x) for x in start]
        twice_energy = sum(a * b * b for a, b in zip(i, w0, strict=True))
        size = mp.sqrt(sum((a * b) ** 2 for a, b in zip(i, w0, strict=True)))
        axis = int(np.argmax(of(moments, start).axis))
        j, k = (axis + 1) % 3, (axis + 2) % 3
        count = 256
        motion = free_motion(moments, start, [float(duration)], 30)
        total = mpf(0)
        for n in range(count):
            w = motion.angular_velocity(Fraction(float(duration * n / count)))
            m = [a * b / size for a, b in zip(i, w, strict=True)]
            pull = [(i[(q + 1) % 3] - i[(q + 2) % 3]) * w[(q + 1) % 3] * w[(q + 2) % 3] / size for q in range(3)]
            # The solid angle about the circled axis: the integral of (1 -+ m_d) d(azimuth).
            pole = mp.sign(m[axis])
            azimuth_rate = (m[j] * pull[k] - m[k] * pull[j]) / (m[j] ** 2 + m[k] ** 2)
            total += pole * (1 - pole * m[axis]) * azimuth_rate
        solid_angle = total * duration / count
        turns = (of(moments, start).precession_per_period - (twice_energy * duration / size - solid_angle)) / (
            2 * mp.pi
        )
        assert abs(turns - mp.nint(turns)) < 1e-13


def test_the_t_handle_about_its_centre_of_mass_and_not_about_the_origin():
    right, wrong = of(T_HANDLE, (1.0, 10.0, 1.0)), of(T_HANDLE_ORIGIN, (1.0, 10.0, 1.0))
    assert right.flip_interval == pytest.approx(2.453763074, abs=5e-10)
    assert wrong.flip_interval == pytest.approx(2.8039392955, abs=5e-10)
    assert abs(wrong.flip_interval - flip_interval(T_HANDLE_ORIGIN, (1.0, 10.0, 1.0))) <= ULP * 2.0


rates = st.floats(-100.0, 100.0).filter(lambda x: abs(x) > 1e-3)


@settings(deadline=None, max_examples=draws(80), derandomize=True)
@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.tuples(rates, rates, rates), st.integers(0, 2))
def test_symmetric_bodies_are_eulers_to_two_ulps(equal, single, start, axis):
    assume(abs(equal - single) > 1e-3)
    moments = [equal] * 3
    moments[axis] = single
    found = of(tuple(moments), start)
    assert list(np.nonzero(found.axis)[0]) == [axis]
    with mp.workdps(60):
        i, i3, w3 = mpf(equal), mpf(single), mpf(start[axis])
        across = mp.sqrt(sum(mpf(x) ** 2 for n, x in enumerate(start) if n != axis))
        size = mp.sqrt((i * across) ** 2 + (i3 * w3) ** 2)
        # The angle between the vectors themselves, by the cross product, at 60 digits.
        between = mp.atan2(abs(i * across * w3 - i3 * w3 * across), i * across**2 + i3 * w3**2)
        wanted = {
            "body_rate": (i3 - i) / i * w3,
            "space_rate": size / i,
            "period": 2 * mp.pi * i / abs((i3 - i) * w3),
            "precession_per_period": 2 * mp.pi * size / abs((i3 - i) * w3),
            "mean_precession_rate": size / i,
            "axis_to_angular_momentum": mp.atan2(i * across, i3 * w3),
            "axis_to_angular_velocity": mp.atan2(across, w3),
            "angular_momentum_to_angular_velocity": between,
        }
        for name, want in wanted.items():
            assert abs(getattr(found, name) - want) <= 2 * ULP * abs(want), name
    # L and w seen from the axis, on the side of it to which the body spins.
    to_momentum = math.sin(found.axis_to_angular_momentum)
    oblate = single > equal
    assert found.symmetry == ("oblate" if oblate else "prolate")
    assert (to_momentum < math.sin(found.axis_to_angular_velocity)) is oblate
    assert ("angular momentum lies between" in found.order_of_directions) is oblate
    assert found.flip_interval is None


def test_symmetric_figures_agree_with_the_elliptic_closed_form_of_a_nearly_symmetric_body():
    near, exact = of((1.0, 1.0 + 1e-13, 2.0), (1.0, 0.5, 1.5)), of((1.0, 1.0, 2.0), (1.0, 0.5, 1.5))
    assert near.symmetry == "triaxial"
    for name in ("period", "precession_per_period", "mean_precession_rate"):
        assert getattr(near, name) == pytest.approx(getattr(exact, name), rel=1e-12)


def test_wrong_answers_are_not_given():
    # The denominator is the moment across the axis; with the moment along it the rate is half as large.
    assert of((2.0, 1.0, 1.0), (1.0, 1.0, 1.0)).body_rate == 1.0
    assert of((1.0, 1.0, 2.0), (0.0, 1.0, -3.0)).body_rate == -3.0
    disc = of((1.0, 1.0, 2.0), (1e-6, 0.0, 5.0))
    assert disc.space_rate == pytest.approx(10.0, rel=1e-12)


@pytest.mark.parametrize("moments", [(1.0, 1.0, 2.0), (1.0, 2.0, 3.0), (1.0, 3.0, 3.0)])
@pytest.mark.parametrize("size", [1e-150, 1e150])
@pytest.mark.parametrize("rate", [1e-150, 1e150])
def test_free_of_scale(moments, size, rate):
    unit, found = of(moments, (1.0, 0.5, 2.0)), of(tuple(size * x for x in moments), (rate, 0.5 * rate, 2.0 * rate))
    assert not found.warnings
    powers = {"period": -1, "flip_interval": -1, "body_rate": 1, "space_rate": 1, "mean_precession_rate": 1}
    for name in FIGURES:
        got, want = getattr(found, name), getattr(unit, name)
        assert (got is None) is (want is None)
        if want is not None:
            assert got == pytest.approx(want * rate ** powers.get(name, 0), rel=1e-14)


def test_values_outside_the_range_of_doubles_are_none_with_a_warning():
    found = of((1.0, 1.0, 1.0 + 1e-12), (1e-300, 0.0, 1e-300))
    assert found.period is None
    assert {notice.detail.split()[0] for notice in found.warnings} >= {"period", "body_rate"}
    assert "range" in found.absent["period"]


def test_separatrix_has_no_period_and_a_limit_of_its_rate():
    found = of((14.0, 21.0, 24.0), (6.0, 2.0, 7.0))
    assert (found.regime, found.period, found.flip_interval) == ("separatrix", None, None)
    assert "never returns" in found.absent["period"]
    momentum = math.hypot(14.0 * 6.0, 21.0 * 2.0, 24.0 * 7.0)
    assert found.mean_precession_rate == pytest.approx(momentum / 21.0, rel=4e-16)


@pytest.mark.parametrize(
    ("moments", "start", "regime"),
    [
        ((1.0, 2.0, 3.0), (0.0, 0.0, 0.0), "rest"),
        ((1.0, 2.0, 3.0), (0.0, 1.0, 0.0), "steady"),
        ((1.0, 1.0, 1.0), (1.0, 2.0, 3.0), "steady"),
        ((1.0, 1.0, 2.0), (1.0, 2.0, 0.0), "steady"),
        ((1.0, 1.0, 2.0), (0.0, 0.0, 2.0), "steady"),
    ],
)
def test_what_does_not_exist_is_none_with_a_reason(moments, start, regime):
    found = of(moments, start)
    assert found.regime == regime
    assert found.period is None
    for name in FIGURES:
        assert (getattr(found, name) is None) is (name in found.absent)
        assert found.absent.get(name) != ""


def test_coin_in_turned_axes():
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    tensor = turn @ np.diag([1.0, 1.0, 2.0]) @ turn.T
    body = MassProperties(0.5 * (tensor + tensor.T), np.zeros((3, 3)))
    found, straight = precession(body, turn @ np.array([1.0, 1.0, 1.0])), of((1.0, 1.0, 2.0), (1.0, 1.0, 1.0))
    for name in FIGURES:
        want = getattr(straight, name)
        assert getattr(found, name) == (None if want is None else pytest.approx(want, rel=1e-14))
    assert found.axis == pytest.approx(turn[:, 2], abs=1e-15)


@pytest.mark.parametrize("kind", [Disc(radius=0.3, mass=2.0), Cylinder(radius=0.2, height=1.1, mass=3.3)])
@pytest.mark.parametrize(
    "attitude", [(0.3, 0.1, -0.7, 0.2), (0.7, 0.1, 0.2, 0.9), (1e-3, 1.0, 2e-5, 0.3), (1.0, 2.0, 3.0, 4.0)]
)
def test_a_turned_solid_moves_as_it_does_along_its_axes(kind, attitude):
    """What rounding leaves between its equal moments, 1e-31 of them, is no difference."""
    turn = np.array([[float(x) for x in row] for row in rotation(attitude)])
    spin = np.array([1.0, 0.5, 2.0])
    straight = precession(kind.mass_properties(), spin)
    turned = precession(Composite((Part(kind, attitude=attitude),)).mass_properties(), turn @ spin)
    assert turned.warnings == ()
    # The axis may point the other way, to the positive side of another body axis.
    side = np.sign(np.dot(turned.axis, turn @ straight.axis))
    assert turned.body_rate == pytest.approx(side * straight.body_rate, rel=1e-14)
    for name in ("space_rate", "period", "precession_per_period", "angular_momentum_to_angular_velocity"):
        assert getattr(turned, name) == pytest.approx(getattr(straight, name), rel=1e-14), name


def test_moments_equal_within_rounding_give_a_warning():
    found = of((1.0, 1.0 + ULP, 2.0), (1.0, 1.0, -1.0))
    assert [notice.code for notice in found.warnings] == ["moments-equal-within-rounding"]
    assert found.body_rate == pytest.approx(-1.0, rel=1e-15)
    # A spin in the plane of the two moments hangs on what little they differ by.
    beyond = of((1.0, 1.0 + ULP, 2.0), (1.0, 1.0, 1e-12))
    want = mpmath.mpf(period((1.0, 1.0 + ULP, 2.0), (1.0, 1.0, 1e-12)))
    assert abs(beyond.period - want) <= 2 * ULP * want
    assert beyond.body_rate is None
    assert [notice.code for notice in beyond.warnings] == ["moments-nearly-equal"]


@pytest.mark.parametrize("moments", [(1.0, 1.0 + 15 * ULP, 2.0), (1.0, 2.0 - 12 * ULP, 2.0)])
@pytest.mark.parametrize("along", [4.2e-8, 8e-8, 3e-7, 1e-5, 1e-3, 0.1, 1.0])
def test_the_period_is_that_of_the_moments_as_given_however_nearly_equal(moments, along):
    start = (1.0, 1.0, along) if moments[1] < 1.5 else (along, 1.0, 1.0)
    found = of(moments, start)
    want = mpmath.mpf(period(moments, start))
    assert abs(found.period - want) <= 2 * ULP * want
    # Where a rate is stated, the angular velocity goes round at that rate.
    if found.body_rate is not None:
        assert abs(found.body_rate) * found.period == pytest.approx(2.0 * math.pi, rel=1e-9)


@pytest.mark.parametrize("start", [(math.nan, 0.0, 1.0), (math.inf, 0.0, 1.0), (1.0, 2.0)])
def test_refusals(start):
    with pytest.raises(InvalidParameter, match="angular_velocity"):
        of((1.0, 2.0, 3.0), start)
    with pytest.raises(InvalidParameter, match="greater than 0"):
        of((0.0, 1.0, 1.0), (1.0, 1.0, 1.0))

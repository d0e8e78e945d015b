"""Attitude against the independent oracle: Euler's angles and an integral of the third kind, no theta functions."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import PrincipalInertia
from core.errors import AccuracyUnreachable, InvalidParameter
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.free_rotation import FreeRotation
from tests.drawn import draws
from tests.oracles.cases import Case, cases
from tests.oracles.free_rotation import precession_per_period, reference_attitude
from tests.oracles.motion import product

# One case turns its attitude more often than can be counted; it has its own test.
UNCOUNTABLE = "lot 3"
CASES = [case for case in cases() if case.name != UNCOUNTABLE]


def attitude(moments, angular_velocity, start=(1.0, 0.0, 0.0, 0.0)) -> FreeAttitude:
    inertia = PrincipalInertia.of(np.diag(np.array(moments)))
    return FreeAttitude(FreeRotation(inertia, np.array(angular_velocity, dtype=float)), np.array(start))


def matrix(q: np.ndarray) -> np.ndarray:
    w, x, y, z = q
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_right_to_the_last_digits_with_the_sign_of_continuity(case: Case):
    times = np.array(case.times)
    turned = reference_attitude(case.moments, case.angular_velocity, case.times)
    for start in ((1.0, 0.0, 0.0, 0.0), (0.3, -0.5, 2.0, 0.1)):
        turning = attitude(case.moments, case.angular_velocity, start)
        with mpmath.workdps(60):
            unit = [mpmath.mpf(x) / mpmath.norm(start) for x in start]
            # Twice the distance of the quaternions is how far a unit vector is turned wrongly.
            error = max(
                2 * float(mpmath.norm([g - w for g, w in zip(map(float, a), product(unit, b), strict=True)]))
                for a, b in zip(turning.sample(times), turned, strict=True)
            )
        assert error <= turning.error(times)
        assert error <= 12 * 2.0**-53


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_precession_per_period(case: Case):
    got = attitude(case.moments, case.angular_velocity).precession_per_period
    want = precession_per_period(case.moments, case.angular_velocity)
    assert (got is None) == (want is None)
    if got is not None and want is not None:
        assert abs(got - want) <= 2.0**-52 * want


def test_turns_that_cannot_be_counted_are_refused():
    case = next(case for case in cases() if case.name == UNCOUNTABLE)
    with pytest.raises(AccuracyUnreachable):
        attitude(case.moments, case.angular_velocity).sample(np.array(case.times))
    with pytest.raises(AccuracyUnreachable):
        attitude((1, 1, 1), (0, 0, 1)).sample(np.array([1e17]))


def test_a_zero_quaternion_is_refused():
    with pytest.raises(InvalidParameter):
        attitude((1, 2, 3), (1, 1, 1), (0.0, 0.0, 0.0, 0.0))


positive = st.floats(1e-2, 1e2)
spin = st.floats(-10, 10)


@given(st.tuples(positive, positive, positive), st.tuples(spin, spin, spin), st.floats(-1e3, 1e3))
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_angular_momentum_stands_still_in_space(moments, start, time):
    turning = attitude(moments, start)
    times = np.array([0.0, time])
    try:
        bound = turning.error(times) + turning.rotation.error(times)
    except AccuracyUnreachable:
        # Constants of the attitude leave the doubles only where a rate is next to the smallest of them.
        assert min(abs(rate) for rate in start if rate) < 1e-290
        return
    momentum = turning.rotation.sample(times) * np.array(moments)
    space = [matrix(q) @ m for q, m in zip(turning.sample(times), momentum, strict=True)]
    size = np.array(moments).max() * turning.rotation.largest_norm
    assert np.linalg.norm(space[1] - space[0]) <= 4 * size * bound + 1e-300


def test_angular_velocity_is_what_turns_it():
    """q' = q (0, w)/2, by central differences in time."""
    turning = attitude((1.0, 2.0, 3.0), (0.3, 1.0, 0.2))
    h = 1e-5
    for time in np.linspace(-20, 20, 41):
        before, now, after = turning.sample(np.array([time - h, time, time + h]))
        w, x, y, z = now
        a, b, c = turning.rotation.sample(np.array([time]))[0]
        slope = 0.5 * np.array(
            [-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
        )
        assert (after - before) / (2 * h) == pytest.approx(slope, abs=1e-9)


def test_oblique_axes_change_the_description_not_the_motion():
    """A body described in axes turned by Q moves as the same body: R' = Q R Q^T."""
    rng = np.random.default_rng(7)
    q = rng.normal(size=4)
    turn = matrix(q / np.linalg.norm(q))
    tensor = turn @ np.diag([1.0, 2.0, 3.5]) @ turn.T
    tensor = 0.5 * (tensor + tensor.T)
    start = np.array([0.2, 1.1, -0.3])
    straight = attitude((1.0, 2.0, 3.5), start)
    oblique = FreeAttitude(FreeRotation(PrincipalInertia.of(tensor), turn @ start), np.array([1.0, 0, 0, 0]))
    times = np.linspace(-7, 9, 33)
    for a, b in zip(straight.sample(times), oblique.sample(times), strict=True):
        assert matrix(b) == pytest.approx(turn @ matrix(a) @ turn.T, abs=1e-13)
    assert oblique.rotation.sample(times) == pytest.approx(straight.rotation.sample(times) @ turn.T, abs=1e-13)


def test_the_slowest_rotation_has_a_horizon() -> None:
    """A rate below which there is no double, of which no turn is ever counted."""
    inertia = PrincipalInertia.of(np.diag([1.0, 2.0, 2.5]))
    rotation = FreeRotation(inertia, np.array([0.0, 5e-324, 0.0]))
    horizon = FreeAttitude(rotation, np.array([1.0, 0.0, 0.0, 0.0])).horizon_of(1e-6)
    assert horizon is None or horizon > 0.0

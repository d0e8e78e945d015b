"""The closed form against the independent oracle (mpmath, Landen ladders, exact rational set-up) on all its cases."""

import math
from itertools import permutations

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import PrincipalInertia, diagonal
from core.certified.free_rotation import CertifiedRotation
from core.errors import AccuracyUnreachable, InvalidParameter
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession.precession import precession
from core.rotation.torque_free import TorqueFree
from tests.drawn import draws, sampled
from tests.oracles.cases import T_HANDLE, T_HANDLE_ORIGIN, Case, cases
from tests.oracles.free_rotation import (
    flip_interval,
    half_ulp_sensitivity,
    largest_rate,
    period,
    reference_angular_velocity,
)

CASES = list(cases())
SOME = sampled(CASES, __name__)


def rotation(moments, angular_velocity) -> FreeRotation:
    return FreeRotation(PrincipalInertia.of(np.diag(np.array(moments))), np.array(angular_velocity, dtype=float))


def true_error(got: np.ndarray, want: list) -> float:
    """Return the largest norm of the difference of rows."""
    with mpmath.workdps(60):
        return max(
            float(mpmath.norm([g - w for g, w in zip(map(float, a), b, strict=True)]))
            for a, b in zip(got, want, strict=True)
        )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_right_to_the_last_digits_and_the_statement_true(case: Case):
    motion = rotation(case.moments, case.angular_velocity)
    times = np.array(case.times)
    want = reference_angular_velocity(case.moments, case.angular_velocity, case.times)
    size = float(largest_rate(case.moments, case.angular_velocity))
    error = true_error(motion.sample(times), want)
    assert error <= motion.error(times) * size
    # Far below what the question's own half ulps allow, 8 times their sensitivities and 2e-15.
    assert error <= 5 * 2.0**-53 * size


@pytest.mark.parametrize("case", SOME, ids=lambda case: case.name)
def test_inherited_error_covers_half_an_ulp_of_every_input(case: Case):
    motion = rotation(case.moments, case.angular_velocity)
    size = float(largest_rate(case.moments, case.angular_velocity)) or 1.0
    moved = half_ulp_sensitivity(case.moments, case.angular_velocity, case.times)
    for time, change in zip(case.times, moved, strict=True):
        # The six inputs are moved one by one and the lengths of the changes added. The statement adds each component by
        # itself, which no signs of the inputs exceed, and is smaller than the sum of lengths by sqrt(3) at most.
        assert min(change / size, 2.0) <= math.sqrt(3) * motion.inherited(np.array([time])) * (1 + 1e-12)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_period_and_flip(case: Case):
    motion = rotation(case.moments, case.angular_velocity)
    for got, want in (
        (motion.period, period(case.moments, case.angular_velocity)),
        (motion.flip_interval, flip_interval(case.moments, case.angular_velocity)),
    ):
        assert (got is None) == (want is None)
        if got is not None and want is not None:
            assert abs(got - want) <= 4 * 2.0**-53 * want


def test_stated_error_is_not_far_above_the_true_one():
    ratios = []
    for case in SOME:
        motion = rotation(case.moments, case.angular_velocity)
        times = np.array(case.times)
        want = reference_angular_velocity(case.moments, case.angular_velocity, case.times)
        error = true_error(motion.sample(times), want) / float(largest_rate(case.moments, case.angular_velocity) or 1)
        if error > 0:
            ratios.append(motion.error(times) / error)
    assert 1.0 <= np.median(ratios) <= 5.0


def test_flip_intervals_of_the_t_handle():
    assert rotation(T_HANDLE_ORIGIN, (1, 10, 1)).flip_interval == pytest.approx(2.803939295, abs=1e-9)
    assert rotation(T_HANDLE, (1, 10, 1)).flip_interval == pytest.approx(2.453763074, abs=1e-9)
    assert rotation(T_HANDLE, (0.01, 10, 0)).flip_interval == pytest.approx(5.639808, abs=5e-7)


def test_separatrix_of_integers_is_recognised():
    motion = rotation((14, 21, 24), (6, 1, 7))
    assert motion.model.regime == "separatrix"
    assert motion.period is None
    assert motion.sample(np.array([1e6]))[0] == pytest.approx([0, 9, 0], abs=1e-14)


def test_cost_does_not_depend_on_the_horizon_nor_values_on_company():
    motion = rotation(T_HANDLE, (1, 10, 1))
    near, far = np.linspace(0, 20, 257), np.linspace(0, 20, 257) + 1e10
    together = motion.sample(np.concatenate([near, far[::-1], [0.0]]))
    assert np.array_equal(together[:257], motion.sample(near))
    assert np.array_equal(together[257:514], motion.sample(far[::-1]))


def test_at_the_start_it_is_the_start():
    for case in CASES:
        start = rotation(case.moments, case.angular_velocity).sample(np.zeros(1))[0]
        assert start == pytest.approx(
            case.angular_velocity, rel=1e-14, abs=4e-16 * max(map(abs, case.angular_velocity))
        )


positive = st.floats(1e-3, 1e3)
# Hairs next to the middle axis below 1e-285 of the spin are refused, as a test of its own says.
spin = st.floats(-1e2, 1e2).filter(lambda x: x == 0.0 or abs(x) > 1e-200)


@given(st.tuples(positive, positive, positive), st.tuples(spin, spin, spin), st.floats(-1e6, 1e6))
@settings(deadline=None, derandomize=True, max_examples=draws(300))
def test_energy_and_momentum_stay_for_any_body_and_start(moments, start, time):
    motion = rotation(moments, start)
    i, w = np.array(moments), motion.sample(np.array([time, 0.0]))
    for power in (1, 2):
        now, then = (i**power * w * w).sum(axis=1)
        # Each component is right to a few units of the largest rate, which may carry the largest moment.
        slack = 2 * (i**power).max() * motion.largest_norm**2 * motion.error(np.array([time]))
        assert abs(now - then) <= 2 * slack + 1e-300


@given(st.tuples(positive, positive, positive), st.tuples(spin, spin, spin), st.floats(0, 1e3), st.floats(0, 1e3))
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_going_on_from_where_one_is_gives_the_same_motion(moments, start, first, second):
    whole = rotation(moments, start)
    there = whole.sample(np.array([first]))[0]
    onwards = rotation(moments, there)
    gap = np.linalg.norm(onwards.sample(np.array([second]))[0] - whole.sample(np.array([first + second]))[0])
    # The way-point is rounded, so what half an ulp there does is inherited; first + second is rounded too.
    times = np.array([first + second])
    allowed = 4 * onwards.inherited(times, 2.0**-50) + 4 * whole.inherited(times, 2.0**-52) + 4 * whole.error(times)
    assert gap <= allowed * whole.largest_norm + 1e-300


def test_beyond_what_can_be_right_is_refused():
    motion = rotation((1, 2, 3), (0.3, 0.2, 0.1))
    with pytest.raises(AccuracyUnreachable) as caught:
        motion.sample(np.array([0.0, 1e17]))
    assert caught.value.path == ("times",)
    with pytest.raises(InvalidParameter):
        motion.sample(np.array([math.nan]))
    with pytest.raises(AccuracyUnreachable):
        rotation((1, 2, 3), (1e-300, 1.0, 1e-300)).sample(np.zeros(1))


@pytest.mark.parametrize("tiny", [5e-324, 1e-310, 1e-300])
def test_a_precession_slower_than_doubles_count_is_still_right(tiny):
    """A spin in the plane of two equal moments, but for a subnormal hair out of it."""
    motion = rotation((1, 1, 2), (1.0, 1.0, tiny))
    times = np.array([0.0, 1e5, 1e300])
    want = reference_angular_velocity((1, 1, 2), (1.0, 1.0, tiny), list(times))
    assert true_error(motion.sample(times), want) <= motion.error(times) * motion.largest_norm


def test_a_line_of_matter_has_no_free_rotation():
    with pytest.raises(InvalidParameter):
        rotation((0.0, 1.0, 1.0), (1, 1, 1))


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("moments", [*permutations((1.0, 2.0, 3.0)), (1.0, 1.0, 2.0), (2.0, 1.0, 2.0), (1.0, 1.0, 1.0)])
def test_a_steady_spin_is_called_unstable_as_its_growing_neighbours_say(moments, axis):
    """Against the linearised equation: lambda^2 = (I - J)(K - I)/(J K) and, where it vanishes, the drift of a rate."""
    own, others = moments[axis], [moments[k] for k in range(3) if k != axis]
    square = (own - others[0]) * (others[1] - own)
    unstable = square > 0 or (square == 0 and len(set(moments)) == 2)
    start = [-2.5 if k == axis else 0.0 for k in range(3)]
    system = TorqueFree(diagonal(moments), np.array(start))
    model = system.closed_form().model
    assert model.regime == ("unstable steady rotation" if unstable else "steady rotation")
    assert ("unstable" in model.why) == unstable
    codes = ["unstable-axis"] if unstable else []
    assert [notice.code for notice in system.warnings] == codes
    assert [notice.code for notice in precession(diagonal(moments), tuple(start)).warnings] == codes
    exact = CertifiedRotation.of_moments(moments, start)
    assert exact.model == model
    assert exact.warnings == system.warnings


def oblique(tensor, angular_velocity) -> FreeRotation:
    return FreeRotation(PrincipalInertia.of(np.array(tensor, dtype=float)), np.array(angular_velocity, dtype=float))


@pytest.mark.parametrize(
    ("tensor", "start", "stable"),
    [
        ([[1.5, -0.5, 0], [-0.5, 1.5, 0], [0, 0, 2]], [-1, 1, 0], False),
        ([[1.5, -0.5, 0], [-0.5, 1.5, 0], [0, 0, 2]], [1, 1, 0], True),
        ([[2, 0.5, 0.5], [0.5, 2, 0.5], [0.5, 0.5, 2]], [1, -1, 0], False),
        ([[2, 0.5, 0.5], [0.5, 2, 0.5], [0.5, 0.5, 2]], [1, 1, -2], False),
        ([[9.5, 1, 1], [1, 11, 2], [1, 2, 11]], [1, 2, 2], True),
    ],
)
def test_a_spin_along_or_across_an_oblique_axis_of_symmetry_is_steady(tensor, start, stable):
    """The axes are irrational, so components that are zero, and moments that are equal, come out as rounding."""
    motion = oblique(tensor, start)
    assert motion.model.regime == ("steady rotation" if stable else "unstable steady rotation")
    assert motion.period is None
    assert motion.flip_interval is None
    times = np.array([0.0, 1.0, 1e4])
    assert np.array_equal(motion.sample(times), np.array([start] * 3, dtype=float))
    assert motion.error(times) < 1e-15


def test_equal_moments_of_an_oblique_body_leave_no_middle_axis():
    assert oblique([[2, -1, 0], [-1, 2, 0], [0, 0, 3]], [1, 2, 3]).flip_interval is None


@pytest.mark.parametrize("hair", [1e-6, 1e-9, 1e-12, 1e-15])
def test_statement_stays_small_next_to_the_plane_of_two_equal_moments(hair):
    motion = oblique([[1.5, -0.5, 0], [-0.5, 1.5, 0], [0, 0, 2]], [-1 + hair, 1 + hair, 0])
    assert motion.error(np.array([1.0])) < 2e-15
    aligned = rotation((1.7, 1.29, 1.29), (hair, 0.16, 2.27))
    assert aligned.period is not None
    assert aligned.error(np.array([10 * aligned.period])) < 1e-15


def test_separatrix_ends_on_the_middle_axis():
    assert np.array_equal(rotation((14, 21, 24), (6, 1, 7)).sample(np.array([1e30])), [[0.0, 9.0, 0.0]])


def test_statement_knows_that_a_small_derived_moment_is_less_certain():
    """A needle at an oblique angle: its small moment is a difference of the tensor's components."""
    tensor = [
        [1.0415484914355613, -0.03280548195824137, -0.15864470978192788],
        [-0.03280548195824137, 0.5340873921809889, 0.7007660918928423],
        [-0.15864470978192788, 0.7007660918928423, 0.9323175298923454],
    ]
    start = [536818.8257068855, -6300822.800501727, 4827288.08088468]
    motion = oblique(tensor, start)
    # At 60 digits, from the eigenvalues and eigenvectors of the exact tensor.
    want = np.array([319548.09364619812, -3750658.9311049625, 2873514.8561610978])
    times = np.array([1672.19587116517])
    error = np.linalg.norm(motion.sample(times)[0] - want) / motion.largest_norm
    assert 1e-9 < error < motion.error(times)


def test_a_line_of_matter_may_turn_across_itself():
    motion = oblique([[1, 0, 0], [0, 1, 0], [0, 0, 0]], [1, 1, 0])
    assert np.array_equal(motion.sample(np.array([5.0])), [[1.0, 1.0, 0.0]])
    with pytest.raises(InvalidParameter):
        oblique([[1, 0, 0], [0, 1, 0], [0, 0, 0]], [1, 1, 1])

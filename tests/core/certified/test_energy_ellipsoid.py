from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.certified.energy_ellipsoid import certified_polhode, certified_semi_axes
from core.certified.exact_inertia import ExactInertia
from core.certified.free_rotation import CertifiedRotation
from core.errors import InvalidParameter, NotApplicable


def test_semi_axes():
    assert certified_semi_axes(ExactInertia.of_moments([2, "0.5", 8]), 1, 16) == [
        "2.000000000000000",
        "1.000000000000000",
        "0.5000000000000000",
    ]
    with mp.workdps(40):
        tensor = [[2, 1, 0], [1, 3, 1], [0, 1, 5]]
        moments = sorted(mp.eigsy(mp.matrix(tensor), eigvals_only=True))
        found = certified_semi_axes(ExactInertia.of_tensor(tensor), "0.7", 30)
        for axis, moment in zip(found, moments, strict=True):
            assert abs(mpf(axis) - mp.sqrt(mpf("1.4") / moment)) < mpf("1e-29")
    for wrong in (0, "-1", "x"):
        with pytest.raises(InvalidParameter):
            certified_semi_axes(ExactInertia.of_moments([1, 2, 3]), wrong, 16)


@pytest.mark.parametrize(
    ("inertia", "rates"),
    [
        (ExactInertia.of_moments([1, 2, 3]), ("0.1", "1", "0.1")),
        (ExactInertia.of_moments([3, 1, 2]), ("0.1", "-1", "0.1")),
        (ExactInertia.of_moments([1, 1, 2]), ("0.1", "-1", "0.1")),
        (ExactInertia.of_moments([14, 21, 24]), (6, -1, 7)),
        (ExactInertia.of_tensor([[2, 1, 0], [1, 3, 1], [0, 1, 5]]), ("0.3", "-1", "0.2")),
    ],
)
def test_points_lie_on_both_ellipsoids(inertia, rates):
    motion = CertifiedRotation.of(inertia, rates)
    points = certified_polhode(motion, 9, 50)
    assert len({tuple(p) for p in points}) == 9
    for point in points:
        w = [Fraction(x) for x in point]
        m = [sum(i * x for i, x in zip(row, w, strict=True)) for row in inertia.tensor]
        assert abs(sum(x * y for x, y in zip(m, w, strict=True)) / motion.start.twice_energy - 1) < Fraction(1, 10**47)
        assert abs(sum(x * x for x in m) / motion.start.squared_momentum - 1) < Fraction(1, 10**47)


def test_a_closed_polhode_is_gone_round_once_in_the_direction_of_the_motion():
    motion = CertifiedRotation.of_moments([1, 2, 3], ["0.1", "1", "0.1"])
    points = certified_polhode(motion, 8, 30)
    period = motion.period(40)
    assert period is not None
    again = CertifiedRotation.of_moments([1, 2, 3], points[0])
    step = Fraction(period) / 8
    for k, row in enumerate(again.angular_velocity([step * k for k in range(8)], 20)):
        assert [float(x) for x in row] == pytest.approx([float(x) for x in points[k]], abs=1e-14)


def test_what_does_not_move_has_no_polhode():
    with pytest.raises(NotApplicable):
        certified_polhode(CertifiedRotation.of_moments([1, 2, 3], [0, 1, 0]), 8, 16)
    with pytest.raises(InvalidParameter):
        certified_polhode(CertifiedRotation.of_moments([1, 2, 3], [0, 1, 1]), 1, 16)

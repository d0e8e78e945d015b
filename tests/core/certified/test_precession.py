from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.bodies.exact import rotated, rotation
from core.bodies.exact_inertia import ExactInertia
from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from tests.core.bodies.exact_tensors import of_tensor
from tests.drawn import sampled
from tests.oracles.cases import Case, cases
from tests.oracles.free_rotation import precession_per_period

CASES = sampled(cases(), __name__)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_angle_per_period_against_integrals_of_the_third_kind(case: Case):
    found = certified_precession(CertifiedRotation.of_moments(case.moments, case.angular_velocity), 42)
    want = precession_per_period(case.moments, case.angular_velocity, 46)
    assert (found.precession_per_period is None) == (want is None)
    if found.precession_per_period is not None and found.period is not None and want is not None:
        with mp.workdps(60):
            assert abs(mpf(found.precession_per_period) - want) <= mpf("1e-41") * want
            assert abs(mpf(str(found.mean_precession_rate)) * mpf(found.period) - want) <= mpf("1e-40") * want


@pytest.mark.parametrize("oblique", [False, True], ids=["principal axes", "oblique axes"])
@pytest.mark.parametrize(
    ("moments", "rates", "body_rate"),
    [
        ((2, 2, 3), ("3", "4", "-0.5"), "-0.2500000000000000000"),
        ((2, 2, 1), ("3", "4", "-0.5"), "0.2500000000000000000"),
        ((3, 2, 2), ("0.7", "0.1", "0.2"), "0.3500000000000000000"),
    ],
)
def test_symmetric_bodies(moments, rates, body_rate, oblique):
    """Source: (I3 - I)/I w3; L/I; tan(axis, L) = I w_perp/(I3 w3), tan(axis, omega) = w_perp/w3."""
    w = [Fraction(x) for x in rates]
    axis = 0 if moments[1] == moments[2] else 2
    single, equal = moments[axis], moments[1]
    inertia = ExactInertia.of_moments(moments)
    if oblique:
        matrix = rotation((10, 1, -1, 2))
        inertia = of_tensor(rotated(inertia.tensor, matrix))
        seen = [sum(r * x for r, x in zip(row, w, strict=True)) for row in matrix]
    else:
        seen = w
    found = certified_precession(CertifiedRotation.of(inertia, seen), 19)
    assert found.body_rate == body_rate
    assert found.flip_interval is None
    with mp.workdps(30):
        along = mpf(w[axis].numerator) / w[axis].denominator
        across2 = sum((x * x for k, x in enumerate(w) if k != axis), Fraction(0))
        across = mp.sqrt(mpf(across2.numerator) / across2.denominator)
        momentum = mp.hypot(single * along, equal * across)
        assert abs(mpf(found.space_rate or 0) - momentum / equal) < mpf("1e-17")
        assert abs(mpf(found.axis_to_angular_momentum or 0) - mp.atan2(equal * across, single * along)) < mpf("1e-17")
        assert abs(mpf(found.axis_to_angular_velocity or 0) - mp.atan2(across, along)) < mpf("1e-17")
        # The axis of symmetry goes round the angular momentum at the space rate, always in the positive sense.
        assert found.mean_precession_rate == found.space_rate


def test_steady_rotation_and_separatrix_have_no_period():
    still = certified_precession(CertifiedRotation.of_moments([1, 2, 3], [0, 1, 0]), 16)
    assert (still.regime, still.period, still.mean_precession_rate, still.body_rate) == ("steady", None, None, None)
    once = certified_precession(CertifiedRotation.of_moments([14, 21, 24], [6, 1, 7]), 16)
    assert (once.regime, once.period, once.precession_per_period) == ("separatrix", None, None)
    # The limit of the rate: L/I of the middle axis, L^2 = 84^2 + 21^2 + 168^2 = 189^2.
    assert once.mean_precession_rate == "9.000000000000000"

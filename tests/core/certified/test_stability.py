from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.bodies.exact import rotated, rotation
from core.bodies.exact_inertia import ExactInertia
from core.certified.stability import certified_stability
from core.errors import InvalidParameter, NotApplicable
from tests.core.bodies.exact_tensors import of_tensor


@pytest.mark.parametrize("oblique", [False, True])
def test_eigenvalues_are_those_of_the_linearised_equations(oblique):
    moments, rate = [Fraction(x) for x in ("1.5", "2", "3.1")], Fraction("0.7")
    inertia = ExactInertia.of_moments(moments)
    if oblique:
        inertia = of_tensor(rotated(inertia.tensor, rotation((1, 2, 3, 4))))
    found = certified_stability(inertia, "-0.7", 40).equilibria[:3]
    assert [e.kind for e in found] == ["center", "saddle", "center"]
    with mp.workdps(50):
        for i, equilibrium in enumerate(found):
            # d(dw)/dt for a small dw beside a rotation about axis i, by differentiating Euler's equations.
            jacobian = mp.zeros(3)
            for k in range(3):
                a, b = (k + 1) % 3, (k + 2) % 3
                factor = (moments[a] - moments[b]) / moments[k]
                if a == i:
                    jacobian[k, b] = mpf(factor.numerator) / factor.denominator * mpf(7) / 10
                if b == i:
                    jacobian[k, a] = mpf(factor.numerator) / factor.denominator * mpf(7) / 10
            values = mp.eig(jacobian, left=False, right=False)
            largest = max(values, key=abs)
            assert abs(abs(largest) - mpf(rate_of(equilibrium))) < mpf("1e-38")
            assert (abs(largest.real) > abs(largest.imag)) == (equilibrium.kind == "saddle")
            assert abs(mpf(equilibrium.moment) - mpf(moments[i].numerator) / moments[i].denominator) < mpf("1e-38")
    assert rate > 0


def rate_of(equilibrium):
    return max((x for pair in equilibrium.eigenvalues for x in pair), key=float)


def test_irrational_moments():
    found = certified_stability(of_tensor([[2, 1, 0], [1, 3, 1], [0, 1, 5]]), 1, 30).equilibria[:3]
    total = sum(Fraction(e.moment) for e in found)
    assert abs(total - 10) < Fraction(1, 10**28)
    assert [e.kind for e in found] == ["center", "saddle", "center"]


def test_degenerate_equilibria_are_decided_exactly():
    kinds = [e.kind for e in certified_stability(ExactInertia.of_moments([1, 2, 1]), 1, 16).equilibria[:3]]
    assert kinds == ["degenerate", "degenerate", "center"]
    assert {e.kind for e in certified_stability(ExactInertia.of_moments([2, 2, 2]), 1, 16).equilibria} == {"degenerate"}
    assert {e.kind for e in certified_stability(ExactInertia.of_moments([1, 2, 3]), 0, 16).equilibria} == {"degenerate"}
    near = certified_stability(ExactInertia.of_moments([1, "1." + "0" * 60 + "1", 2]), 1, 20).equilibria[:3]
    assert [e.kind for e in near] == ["center", "saddle", "center"]
    # lambda^2 = (I2 - I1)(I3 - I2)/(I1 I3), 1e-61/2 to 60 digits.
    assert near[1].growth_rate == "2.2360679774997896964e-31"


def test_a_rate_is_a_number():
    with pytest.raises(InvalidParameter) as caught:
        certified_stability(ExactInertia.of_moments([1, 2, 3]), "fast", 16)
    assert caught.value.path == ("rate",)


def test_a_spin_in_the_plane_of_equal_moments_drifts():
    """W' about the third axis is (B - C)/A W per unit of rate there; here (1 - 2)/1 0.3."""
    found = certified_stability(ExactInertia.of_moments([1, 1, 2]), "0.3", 16).equilibria
    assert [e.drift_rate for e in found] == ["0.3000000000000000", "0.3000000000000000", "0", "0"]
    assert [e.stable for e in found] == [False, False, True, True]


def test_the_state_of_rest_is_listed_last():
    rest = certified_stability(ExactInertia.of_moments([1, 2, 3]), 1, 16).equilibria[3]
    assert (rest.axis, rest.moment, rest.stable, rest.attitude) == (None, None, True, "unstable")


def test_flips_of_oblique_axes_are_those_of_principal_ones():
    """Moments 1, 3, 5 along turned axes, which the tensor does not show to be rational, against the exact ones."""
    tensor = [[2, 1, 0], [1, 2, 0], [0, 0, 5]]
    for disturbance in (("0.1", "0.2"), ("0.2", "0.1"), ("1e-40", 0), (0, "-1e-40")):
        oblique = certified_stability(of_tensor(tensor), "0.7", 40, disturbance).flip
        plain = certified_stability(ExactInertia.of_moments([1, 3, 5]), "0.7", 40, disturbance).flip
        assert oblique == plain
        assert oblique.interval is not None
    for rate, disturbance in ((1, (0, 0)), (0, (0, 1)), (0, (0, 0))):
        still = certified_stability(of_tensor(tensor), rate, 40, disturbance).flip
        assert still.interval is None
        assert still.reason.startswith("it never turns over")
    with pytest.raises(NotApplicable):
        certified_stability(ExactInertia.of_moments([1, 1, 2]), 1, 16, (1, 1))


def test_axes_are_unit_eigenvectors_on_the_positive_side():
    tensor = [["2", "1", "1"], ["1", "3", "0.5"], ["1", "0.5", "4"]]
    for equilibrium in certified_stability(of_tensor(tensor), 1, 40).equilibria[:3]:
        axis = [Fraction(x) for x in equilibrium.axis]
        assert abs(sum(x * x for x in axis) - 1) < Fraction(1, 10**39)
        assert max(axis, key=abs) > 0
        for row, x in zip(tensor, axis, strict=True):
            image = sum(Fraction(i) * y for i, y in zip(row, axis, strict=True))
            assert abs(image - Fraction(equilibrium.moment) * x) < Fraction(1, 10**37)
    # Equally near to two body axes: the first counts.
    along = certified_stability(of_tensor([[2, 1, 0], [1, 2, 0], [0, 0, 5]]), 1, 16).equilibria
    assert along[0].axis == ["0.7071067811865475", "-0.7071067811865475", "0"]


def test_matter_along_a_line_has_no_equilibria_of_free_rotation():
    with pytest.raises(InvalidParameter):
        certified_stability(of_tensor([[1, 0, 0], [0, 1, 0], [0, 0, 0]]), 1, 16)

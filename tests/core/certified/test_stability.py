from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.bodies.exact import rotated, rotation
from core.certified.exact_inertia import ExactInertia
from core.certified.stability import certified_stability
from core.errors import InvalidParameter


@pytest.mark.parametrize("oblique", [False, True])
def test_eigenvalues_are_those_of_the_linearised_equations(oblique):
    moments, rate = [Fraction(x) for x in ("1.5", "2", "3.1")], Fraction("0.7")
    inertia = ExactInertia.of_moments(moments)
    if oblique:
        inertia = ExactInertia.of_tensor(rotated(inertia.tensor, rotation((1, 2, 3, 4))))
    found = certified_stability(inertia, "-0.7", 40)
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
            assert abs(abs(largest) - mpf(equilibrium.rate)) < mpf("1e-38")
            assert (abs(largest.real) > abs(largest.imag)) == (equilibrium.kind == "saddle")
            assert abs(mpf(equilibrium.moment) - mpf(moments[i].numerator) / moments[i].denominator) < mpf("1e-38")
    assert rate > 0


def test_irrational_moments():
    found = certified_stability(ExactInertia.of_tensor([[2, 1, 0], [1, 3, 1], [0, 1, 5]]), 1, 30)
    total = sum(Fraction(e.moment) for e in found)
    assert abs(total - 10) < Fraction(1, 10**28)
    assert [e.kind for e in found] == ["center", "saddle", "center"]


def test_degenerate_equilibria_are_decided_exactly():
    kinds = [e.kind for e in certified_stability(ExactInertia.of_moments([1, 2, 1]), 1, 16)]
    assert kinds == ["degenerate", "degenerate", "center"]
    assert {e.kind for e in certified_stability(ExactInertia.of_moments([2, 2, 2]), 1, 16)} == {"degenerate"}
    assert {e.kind for e in certified_stability(ExactInertia.of_moments([1, 2, 3]), 0, 16)} == {"degenerate"}
    near = certified_stability(ExactInertia.of_moments([1, "1." + "0" * 60 + "1", 2]), 1, 20)
    assert [e.kind for e in near] == ["center", "saddle", "center"]
    # lambda^2 = (I2 - I1)(I3 - I2)/(I1 I3), 1e-61/2 to 60 digits.
    assert near[1].rate == "2.2360679774997896964e-31"


def test_a_rate_is_a_number():
    with pytest.raises(InvalidParameter) as caught:
        certified_stability(ExactInertia.of_moments([1, 2, 3]), "fast", 16)
    assert caught.value.path == ("rate",)

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.exact_inertia import ExactInertia, cross, of_matter
from core.bodies.exact_mass import ExactMass
from core.errors import InvalidParameter
from tests.core.bodies.exact_tensors import of_tensor

small = st.integers(-9, 9)


@settings(deadline=None, derandomize=True)
@given(st.lists(st.tuples(small, small, small), min_size=4, max_size=6, unique=True))
def test_moments_are_roots_of_the_cubic(points):
    try:
        inertia = ExactMass.of_point_masses(1, points).of_motion
    except InvalidParameter:
        return
    moments = np.linalg.eigvalsh(np.array(inertia.tensor, dtype=float))
    product = np.prod(moments)
    assert float(inertia.determinant_at(Fraction(0))) == pytest.approx(product, rel=1e-9)
    assert float(inertia.minors) == pytest.approx(moments[0] * moments[1] + moments[2] * (moments[0] + moments[1]))
    if inertia.rational_moments is not None:
        assert [float(x) for x in inertia.rational_moments] == pytest.approx(moments)
        assert all(inertia.determinant_at(x) == 0 for x in inertia.rational_moments)
    gaps = np.diff(moments) > 1e-6 * moments[2]
    assert inertia.equal_moments == 3 - int(gaps.sum())


def test_a_double_moment_is_recognised_in_oblique_axes():
    inertia = of_tensor([[2, 1, 1], [1, 2, 1], [1, 1, 2]])
    assert inertia.rational_moments == (1, 1, 4)
    assert inertia.equal_moments == 2
    missed = of_tensor([[2, 1, 1], [1, 2, 1], [1, 1, "2.0000000000000000000000000000001"]])
    assert missed.rational_moments is None
    assert missed.equal_moments == 1
    assert ExactInertia.of_moments(["0.3", "0.3", "0.3"]).equal_moments == 3


@pytest.mark.parametrize(
    ("build", "path"),
    [
        (lambda: ExactInertia.of_moments([1, -1, 1]), ("moments", 1)),
        (lambda: ExactInertia.of_moments([0, "0", 1]), ("moments",)),
        (lambda: ExactInertia.of_moments([1, 2]), ("moments",)),
        (lambda: ExactInertia.of_moments([1, 2, "x"]), ("moments", 2)),
        (lambda: of_tensor([[1, 2, 0], [2, 1, 0], [0, 0, 1]]), ()),
        (lambda: of_tensor([[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]]), ("tensor", 1, 0)),
        (lambda: of_tensor([[1, 0], [0, 1]]), ("tensor",)),
        (lambda: ExactMass.of_point_masses(1, [(0, 0, 0), (0, 0, 0)]).of_motion, ()),
        (lambda: of_tensor([[1, 0, 0], [0, 1, 0], [0, 0, "-1e-300"]]), ()),
        (lambda: ExactMass.of_point_masses(1, [(0, 0, 0), (1, 1, 1)]).of_motion.require_extent(), ("body",)),
        (lambda: ExactMass.of_point_masses([1, -1], [(0, 0, 0), (1, 1, 1)]), ("masses", 1)),
        (lambda: ExactMass.of_point_masses([1], [(0, 0, 0), (1, 1, 1)]), ("masses",)),
        (lambda: ExactMass.of_point_masses(1, []), ("positions",)),
    ],
)
def test_what_is_no_body_is_refused(build, path):
    with pytest.raises(InvalidParameter) as caught:
        build()
    assert caught.value.path == path


def test_momentum_and_cross_product():
    inertia = of_tensor([[2, 1, 0], [1, 3, 0], [0, 0, 5]])
    assert inertia.momentum((Fraction(1), Fraction(2), Fraction(3))) == (4, 7, 15)
    assert cross((Fraction(1), Fraction(0), Fraction(0)), (Fraction(0), Fraction(1), Fraction(0))) == (0, 0, 1)


@pytest.mark.parametrize(
    ("moments", "symmetry", "physical"),
    [
        (("1", "1", "1"), "spherical", True),
        (("2", "1", "2"), "prolate", True),
        (("1", "1", "2"), "oblate", True),
        (("1", "1", "2.0000000000000000000001"), "oblate", False),
        (("1", "1.0000000000000000000001", "2"), "triaxial", True),
        (("1", "0.3", "0.7"), "triaxial", True),
        (("1", "0.3", "0.6999999999999999999"), "triaxial", False),
    ],
)
def test_symmetry_and_the_triangle_of_moments_are_decided_exactly(moments, symmetry, physical):
    inertia = ExactInertia.of_moments(moments)
    assert (inertia.symmetry, of_matter(inertia.tensor)) == (symmetry, physical)
    # Turned by a rational rotation, the tensor is full and its moments are the same.
    (a, _, _), (_, b, _), (_, _, c) = inertia.tensor
    s, t = Fraction(3, 5), Fraction(4, 5)
    turned = ((s * s * a + t * t * b, s * t * (a - b), 0), (s * t * (a - b), t * t * a + s * s * b, 0), (0, 0, c))
    same = of_tensor(turned)
    assert of_matter(same.tensor) == physical
    assert same.symmetry == symmetry

"""Parallel axes against rational arithmetic, unknown properties, and warnings."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.composite import Composite, Part
from core.bodies.exact_mass import ExactMass
from core.bodies.mass_properties import Condition, MassProperties, diagonal
from core.bodies.measured import SUMMED_EXACTLY, InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.mesh import Mesh
from core.bodies.solids import Cuboid
from core.errors import InvalidParameter, NotApplicable
from core.notices import Notice
from tests.drawn import draws

THIRD = Fraction(1, 3)
TENSOR = [[Fraction(2, 3), Fraction(1, 7), Fraction(0)], [Fraction(1, 7), THIRD, THIRD / 4], [0, THIRD / 4, THIRD * 2]]


def body(center: tuple[float, float, float] = (1.0, -2.0, 0.5)) -> MassProperties:
    return MassProperties.from_exact(THIRD, [Fraction(x) for x in center], TENSOR)  # type: ignore[arg-type]


def test_a_fraction_is_stored_with_106_bits() -> None:
    found = body()
    assert abs(found.exact_mass - THIRD) < THIRD / 2**106
    assert abs(found.exact_inertia[0][1] - Fraction(1, 7)) < Fraction(1, 7) / 2**106
    assert found.mass == 1 / 3


@settings(deadline=None, max_examples=draws(60))
@given(st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3))
def test_the_parallel_axis_theorem(point: list[float]) -> None:
    found = body()
    value, tail = found.inertia_about(point)
    # Steiner, by components: I_xx grows by m (dy^2 + dz^2), I_xy by -m dx dy.
    x, y, z = (Fraction(p) - c for p, c in zip(point, found.exact_center_of_mass, strict=True))
    more = [[y * y + z * z, -x * y, -x * z], [-x * y, x * x + z * z, -y * z], [-x * z, -y * z, x * x + y * y]]
    for i in range(3):
        for j in range(3):
            want = found.exact_inertia[i][j] + found.exact_mass * more[i][j]
            have = Fraction(float(value[i, j])) + Fraction(float(tail[i, j]))
            assert abs(have - want) <= abs(want) / 2**105 + Fraction(1, 2**1074)


def test_about_the_origin_agrees_with_point_masses_about_it() -> None:
    positions = np.array([[0.3, 1.0, -2.0], [1.5, 0.1, 0.4], [-0.6, 0.2, 1.1]])
    found = PointMasses(2.0, positions).mass_properties()
    about = sum(2.0 * (r @ r * np.eye(3) - np.outer(r, r)) for r in positions)
    assert found.inertia_about_origin == pytest.approx(about, abs=1e-14)


def test_about_the_centre_of_mass_nothing_changes() -> None:
    found = body()
    assert found.center_of_mass is not None
    assert np.array_equal(found.inertia_about(found.center_of_mass)[0], found.inertia)


def test_what_is_not_known_is_not_invented() -> None:
    found = diagonal((1.0, 2.0, 2.5))
    assert found.mass is None
    assert found.about_origin is None
    assert found.principal_about_origin is None
    for unknown in (
        lambda: found.exact_mass,
        lambda: found.exact_center_of_mass,
        lambda: found.inertia_about((0, 0, 0)),
    ):
        with pytest.raises(NotApplicable) as caught:
            unknown()
        assert caught.value.remedy
    assert "positive-mass" not in {condition.name for condition in found.validity.report}


def test_further_warnings_and_conditions_are_adopted() -> None:
    notice, condition = Notice("seen", "something was seen", ("here",)), Condition("round", False, "it is not round")
    found = body().with_warnings((notice,), (condition,))
    assert found.warnings == (notice,)
    assert condition in found.validity.violations
    assert not found.validity.physical
    assert np.array_equal(found.inertia, body().inertia)


def test_the_report_has_a_condition_for_the_mass() -> None:
    report = {condition.name: condition for condition in body().validity.report}
    assert report["positive-mass"].holds
    assert "0.333333 kg" in report["positive-mass"].detail


def test_a_body_without_mass_has_no_positive_mass() -> None:
    report = {condition.name: condition for condition in replace(body(), mass=0.0).validity.report}
    assert not report["positive-mass"].holds


def test_an_unphysical_tensor_is_reported_at_its_field() -> None:
    judged = diagonal((2.0, 1.0, 0.5)).with_validity_warning("moments")
    assert [(notice.code, notice.path) for notice in judged.warnings] == [("unphysical-inertia", ("moments",))]
    assert "2 <= 0.5 + 1" in judged.warnings[0].detail
    sound = diagonal((2.0, 1.0, 1.5))
    assert sound.with_validity_warning("moments") is sound


@pytest.mark.parametrize("size", [Fraction(10) ** 309, Fraction(1, 10**330)])
def test_figures_outside_the_range_of_doubles_are_refused(size: Fraction) -> None:
    tensor = [[size if i == j else Fraction(0) for j in range(3)] for i in range(3)]
    with pytest.raises(InvalidParameter, match="range of doubles"):
        MassProperties.from_exact(Fraction(1), [Fraction(0)] * 3, tensor)
    with pytest.raises(InvalidParameter, match="range of doubles"):
        MassProperties.from_exact(size, [Fraction(0)] * 3, TENSOR)  # type: ignore[arg-type]


def test_a_product_of_inertia_below_every_double_is_zero() -> None:
    tiny = Fraction(1, 10**330)
    tensor = [[Fraction(1, 10**300) if i == j else tiny for j in range(3)] for i in range(3)]
    found = MassProperties.from_exact(Fraction(1), [tiny] * 3, tensor)
    assert not found.inertia[np.triu_indices(3, 1)].any()
    assert found.center_of_mass is not None
    assert not found.center_of_mass.any()


def test_it_is_known_which_figures_are_exact():
    cuboid = Cuboid(edges=(0.1, 0.2, 0.3), mass=1.0)
    few = PointMasses(1.0, [[1, 0, 0], [-1, 0, 0], [0, 2, 0], [0, -2, 0]])
    many = PointMasses(1.0, np.random.default_rng(1).normal(size=(SUMMED_EXACTLY + 1, 3)))
    tetrahedron = Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], mass=1.0
    )
    for body in (PrincipalMoments((1.0, 2.0, 3.0)), InertiaTensor(((1.0, 0.1, 0.0), (0.1, 2.0, 0.0), (0.0, 0.0, 2.5)))):
        assert body.mass_properties().rounding.share == 0.0
    for body in (cuboid, few, Composite((Part(cuboid), Part(few, position=(0.0, 0.0, 1.0))))):
        rounding = body.mass_properties().rounding
        assert rounding.exact_zeros
        assert 0.0 < rounding.share < 2.0**-100
    for body in (many, tetrahedron, Composite((Part(cuboid), Part(tetrahedron)))):
        rounding = body.mass_properties().rounding
        assert not rounding.exact_zeros
        assert 2.0**-101 < rounding.share < 2.0**-90
    # A hole that leaves little of a mesh leaves its rounding.
    inside = Mesh(0.999 * tetrahedron.vertices, tetrahedron.faces, density=-6.0)
    left = Composite((Part(tetrahedron), Part(inside))).mass_properties().rounding
    assert left.share > 50.0 * tetrahedron.mass_properties().rounding.share


def test_moments_too_near_for_pairs_of_doubles_are_not_called_equal():
    needle = Cuboid(edges=(1e30, 1.0, 2.0), mass=1.0).mass_properties()
    assert not needle.rounding.exact_zeros
    assert not Cuboid(edges=(1e30, 1.0, 2.0), mass=1.0).mass_properties().principal.rounding.exact_zeros
    assert Cuboid(edges=(1e30, 2.0, 2.0), mass=1.0).mass_properties().rounding.exact_zeros


def test_axes_about_a_pin_are_exact_where_the_centre_of_mass_lies_on_one():
    part = Cuboid(edges=(0.1, 0.2, 0.3), mass=1.0)
    on_axis = Composite((Part(part, position=(0.0, 0.0, 1.0)),), about="origin").mass_properties()
    beside = Composite((Part(part, position=(0.0, 0.5, 1.0)),), about="origin").mass_properties()
    assert on_axis.principal_of_motion.rounding.exact_zeros
    assert not beside.principal_of_motion.rounding.exact_zeros


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.integers(2, 40), st.integers(0, 2**32), st.sampled_from((1e-140, 1.0, 1e140)))
def test_few_points_summed_exactly(count, seed, size):
    rng = np.random.default_rng(seed)
    masses, positions = rng.uniform(0.1, 3.0, count), size * rng.normal(size=(count, 3))
    found = PointMasses(masses.tolist(), positions).mass_properties()
    exact = ExactMass.of_point_masses(masses.tolist(), positions.tolist())
    assert found.exact_mass == pytest.approx(exact.mass, rel=1e-30)
    for row, wanted in zip(found.exact_inertia, exact.inertia, strict=True):
        for x, y in zip(row, wanted, strict=True):
            assert abs(x - y) <= Fraction(2) ** -105 * abs(y)

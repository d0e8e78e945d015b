"""Point masses against sums of fractions, the T-handle's published figures; tensors and moments as given; refusals."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from core.bodies.exact import SMALLEST
from core.bodies.exact_inertia import ExactInertia
from core.bodies.mass_properties import diagonal
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.certified.free_rotation import CertifiedRotation
from core.errors import InvalidParameter, MechanicsError, UnphysicalInertia
from core.rotation.precession.precession import precession
from core.rotation.torque_free import TorqueFree
from tests.drawn import draws

PAIR = Fraction(1, 10**29)
"""What a value and a tail are right to, as a share of the largest component."""


def t_handle(angles: int = 20) -> NDArray[np.float64]:
    """Return the points of the source: a tube of 10 x 20 along z and one of 5 x 20 along y, both of radius 1."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 20)[:angles], np.linspace(0, 1, 10))
    tube = np.array([np.cos(angle), np.sin(angle), 5 * height])
    bar = tube - np.array([0.0, 0.0, 2.5]).reshape(3, 1, 1)
    stem = np.array([tube[0, :5], tube[2, :5], tube[1, :5]])
    return np.concatenate((bar, stem), 1).reshape(3, -1).T


def exact(
    masses: Sequence[float], positions: Sequence[Sequence[float]]
) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
    m = [Fraction(float(x)) for x in masses]
    r = [[Fraction(float(x)) for x in row] for row in positions]
    total = sum(m, Fraction(0))
    center = [sum((a * x[k] for a, x in zip(m, r, strict=True)), Fraction(0)) / total for k in range(3)]
    d = [[x - c for x, c in zip(row, center, strict=True)] for row in r]
    inertia = [
        [
            sum(
                (a * ((sum(y * y for y in x) if i == j else 0) - x[i] * x[j]) for a, x in zip(m, d, strict=True)),
                Fraction(0),
            )
            for j in range(3)
        ]
        for i in range(3)
    ]
    return total, center, inertia


def judge(masses: Sequence[float], positions: Any) -> None:
    found = PointMasses(list(masses), positions).mass_properties()
    rows = np.asarray(positions).tolist()
    total, center, inertia = exact(masses, rows)
    box = max(Fraction(max(column)) - Fraction(min(column)) for column in zip(*rows, strict=True))
    assert abs(found.exact_mass - total) <= PAIR * total
    for have, want in zip(found.exact_center_of_mass, center, strict=True):
        assert abs(have - want) <= PAIR * box + abs(want) / 2**104
    size = max(abs(x) for row in inertia for x in row)
    for have_row, want_row in zip(found.exact_inertia, inertia, strict=True):
        for have, want in zip(have_row, want_row, strict=True):
            assert abs(have - want) <= PAIR * size


coordinate = st.floats(-1, 1, allow_subnormal=False)


@settings(deadline=None, max_examples=draws(80))
@given(
    st.lists(st.tuples(st.floats(1e-3, 1e3), coordinate, coordinate, coordinate), min_size=2, max_size=12),
    st.sampled_from([0.0, 1e6, 1e9]),
    st.integers(-450, 450),
)
def test_any_points_at_any_place_and_scale(points: list[tuple[float, ...]], offset: float, exponent: int) -> None:
    positions = np.ldexp(np.array([p[1:] for p in points]) + offset, exponent)
    assume(float(np.ptp(positions, axis=0).max()) > np.ldexp(1e-9, exponent))
    masses = [p[0] for p in points]
    _, _, inertia = exact(masses, positions.tolist())
    if any(0 < inertia[i][i] < SMALLEST for i in range(3)):
        # Of a needle this small, the moment about itself has no 53 bits left.
        with pytest.raises(InvalidParameter, match="within the range of doubles"):
            PointMasses(masses, positions).mass_properties()
    else:
        judge(masses, positions)


def test_the_t_handle() -> None:
    found = PointMasses(1.0, t_handle()).mass_properties()
    assert found.mass == 300
    assert found.center_of_mass == pytest.approx([1 / 20, 10 / 27, 0], abs=1e-15)
    figures = [395.782921811, 713.509259259, 795.792181070]
    assert found.principal.moments == pytest.approx(figures, abs=6e-10)
    assert np.diag(found.inertia)[::-1] == pytest.approx(figures, abs=6e-10)
    about_origin = [437.685185185, 714.008200689, 837.195503014]
    assert found.principal_about_origin is not None
    assert found.principal_about_origin.moments == pytest.approx(about_origin, abs=6e-10)
    assert found.principal_of_motion is found.principal
    assert found.symmetry == "triaxial"
    assert found.validity.physical
    judge([1.0] * 300, t_handle())


def test_the_t_handle_without_its_seam() -> None:
    positions = t_handle(19)
    assert len(positions) == 285
    found = PointMasses(1.0, positions).mass_properties()
    assert found.principal.moments == pytest.approx([374.331275720, 673.796296296, 763.127572016], abs=6e-10)


def test_a_body_that_is_pinned_turns_about_the_origin() -> None:
    free, pinned = (
        PointMasses(1.0, t_handle(), about=about).mass_properties() for about in ("center-of-mass", "origin")
    )
    assert pinned.about == "origin"
    assert np.array_equal(free.inertia, pinned.inertia)
    assert pinned.principal_of_motion is pinned.principal_about_origin
    assert pinned.principal_of_motion.moments[0] == pytest.approx(437.685185185, abs=6e-10)


@pytest.mark.parametrize("scale", [1e-150, 1e-100, 1e100, 1e150])
def test_the_t_handle_at_any_scale(scale: float) -> None:
    moments = PointMasses(1.0, t_handle() * scale).mass_properties().principal.moments
    reference = PointMasses(1.0, t_handle()).mass_properties().principal.moments
    assert moments / scale / scale == pytest.approx(reference, rel=1e-13)


@pytest.mark.parametrize("count", [1, 2, 7])
def test_points_at_one_place_have_no_inertia_at_all(count: int) -> None:
    found = PointMasses(0.7, [[0.1, 0.2, 0.3]] * count).mass_properties()
    assert not found.inertia.any()
    assert not found.inertia_tail.any()
    assert found.symmetry == "point"
    assert found.validity.physical
    assert found.center_of_mass is not None
    assert found.center_of_mass.tolist() == [0.1, 0.2, 0.3]


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 1, 1), (1, 2, 3), (-7, 11, 13)])
@pytest.mark.parametrize("offset", [(0, 0, 0), (0.1, 0.7, -0.3)])
@pytest.mark.parametrize("count", [2, 3, 1000])
def test_points_on_a_line_are_a_needle(direction: tuple[int, ...], offset: tuple[float, ...], count: int) -> None:
    positions = np.arange(count)[:, None] * np.array(direction) + np.array(offset)
    found = PointMasses(1.5, positions).mass_properties()
    low, middle, high = found.principal.moments
    assert abs(low) <= 1e-15 * high
    assert middle == pytest.approx(high, rel=1e-14)
    assert found.symmetry == "linear"
    assert found.validity.physical
    length = float(np.dot(direction, direction))
    assert high == pytest.approx(1.5 * length * count * (count**2 - 1) / 12, rel=1e-12)


def test_exactly_collinear_points_have_a_smallest_moment_of_exactly_zero() -> None:
    positions = np.arange(1001)[:, None] * np.array([1.0, 2.0, 3.0])
    assert PointMasses(0.3, positions).mass_properties().principal.moments[0] == 0.0


def test_points_in_a_plane_are_a_lamina() -> None:
    found = PointMasses([1.0, 2.0, 3.0], [[0, 0, 5], [1, 0, 5], [0, 2, 5]]).mass_properties()
    low, middle, high = found.principal.moments
    assert high == pytest.approx(low + middle, rel=1e-15)
    assert found.validity.physical


def test_a_light_point_far_from_a_heavy_one_is_not_lost() -> None:
    found = PointMasses([1.0, 1e-200], [[0.3, 0, 0], [1.3, 0, 0]]).mass_properties()
    assert np.diag(found.inertia).tolist() == pytest.approx([0.0, 1e-200, 1e-200], rel=1e-15)


NAN = float("nan")


@pytest.mark.parametrize(
    ("masses", "positions", "path", "words"),
    [
        (1.0, [], ("positions",), "entries"),
        (1.0, [[0, 0, 0], [1, 2]], ("positions", 1), "list of 3"),
        (1.0, [[0, 0, NAN]], ("positions", 0, 2), "finite"),
        (1.0, [[0, 0, "1"]], ("positions", 0, 2), "number"),
        (1.0, [[0, True, 1]], ("positions", 0, 1), "number"),
        (1.0, [[0, 10**400, 1]], ("positions", 0, 1), "range of doubles"),
        (1.0, "here", ("positions",), "list"),
        (0.0, [[0, 0, 0]], ("masses",), "greater than 0"),
        (True, [[0, 0, 0]], ("masses",), "number"),
        (None, [[0, 0, 0]], ("masses",), "number"),
        ([1.0, -1.0], [[0, 0, 0], [1, 0, 0]], ("masses", 1), "greater than 0"),
        ([1.0, 1.0], [[0, 0, 0]], ("masses",), "one entry for each of the 1 positions, not 2"),
        ([1e300, 1e-300], [[0, 0, 0], [1, 0, 0]], ("masses",), "factor"),
        (1.0, [[1e200, 0, 0], [0, 0, 0]], (), "range of doubles"),
        (1.0, [[1e-200, 0, 0], [0, 0, 0]], (), "range of doubles"),
    ],
)
def test_points_that_are_refused(masses: Any, positions: Any, path: tuple[str | int, ...], words: str) -> None:
    with pytest.raises(InvalidParameter, match=words) as caught:
        PointMasses(masses, positions).mass_properties()
    assert caught.value.path == path


def test_an_unknown_point_of_rotation_is_refused() -> None:
    with pytest.raises(InvalidParameter) as caught:
        PointMasses(1.0, [[0, 0, 0]], about="corner")  # type: ignore[arg-type]
    assert caught.value.path == ("about",)


def test_positions_cannot_be_written() -> None:
    body = PointMasses([1.0, 2.0], [[0, 0, 0], [1, 0, 0]])
    for array in (body.masses, body.positions):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 3.0  # type: ignore[index]


def rows(tensor: Any) -> Any:
    return tuple(map(tuple, np.asarray(tensor, dtype=float).tolist()))


def test_moments_stay_in_their_order_and_a_triple_of_no_body_is_answered_with_a_warning() -> None:
    found = PrincipalMoments((2.0, 1.0, 0.5)).mass_properties()
    assert np.array_equal(found.inertia, np.diag([2.0, 1.0, 0.5]))
    assert found.principal.moments.tolist() == [0.5, 1.0, 2.0]
    assert found.mass is None
    assert found.inertia_about_origin is None
    assert [(notice.code, notice.path) for notice in found.warnings] == [("unphysical-inertia", ("moments",))]
    assert not found.validity.physical
    assert not PrincipalMoments((1.0, 2.0, 3.0)).mass_properties().warnings
    assert PrincipalMoments((1e-16, 1e-16, 5e-16)).mass_properties().warnings


@pytest.mark.parametrize(
    "given",
    [(2, 3, 4), [2.0, 3.0, 4.0], (np.float32(2), 3.0, 4.0), (Fraction(2), 3, 4.0), (2**53 + 1, 2**60, 2**60)],
)
def test_moments_of_any_type_become_doubles(given: Any) -> None:
    found, again = (PrincipalMoments(x).mass_properties() for x in (given, tuple(float(x) for x in given)))
    for properties in (found, again, diagonal(given)):
        assert properties.inertia.dtype == properties.principal.moments.dtype == np.float64
        assert properties.principal.moments.tolist() == [float(x) for x in given]


@pytest.mark.parametrize("bad", [-1.0, -5e-324, NAN, float("inf"), True, "1", None])
def test_moments_that_are_refused(bad: Any) -> None:
    with pytest.raises(InvalidParameter) as caught:
        PrincipalMoments((1.0, bad, 1.0))
    assert caught.value.path == ("moments", 1)


@pytest.mark.parametrize("moments", [(0.0, 0.0, 1.0), (0.0, -0.0, 0.0), (1.0, 0.0, 0.0)])
def test_two_moments_of_zero_are_refused(moments: Any) -> None:
    with pytest.raises(InvalidParameter) as caught:
        PrincipalMoments(moments)
    assert caught.value.path == ("moments",)
    assert "thin rod" in str(caught.value.remedy)


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(
    size=st.floats(1e-100, 1e100),
    along=st.integers(0, 2),
    spin=st.tuples(*[st.sampled_from([-1.5, -0.0, 0.0, 2.0])] * 3),
)
def test_a_thin_rod_has_mass_properties_and_turns_across_itself_alone(size: float, along: int, spin: Any) -> None:
    moments: Any = tuple(0.0 if k == along else size for k in range(3))
    found = PrincipalMoments(moments).mass_properties()
    # The same rod as two point masses, half the moment each at one metre from the middle.
    ends: Any = tuple(tuple(side if k == along else 0.0 for k in range(3)) for side in (-1.0, 1.0))
    points = PointMasses((size / 2, size / 2), ends).mass_properties()
    assert found.symmetry == points.symmetry == "linear"
    assert found.validity.physical
    assert found.principal.moments.tolist() == pytest.approx(points.principal.moments.tolist(), rel=1e-15)
    exact = ExactInertia.of_moments(moments)
    if spin[along] == 0.0:
        for body in (found, points):
            rotation = TorqueFree(body, np.array(spin)).closed_form()
            assert rotation.sample(np.array([3.0])).tolist() == [list(spin)]
        assert CertifiedRotation.of(exact, spin).regime in ("steady", "rest")
        return
    for turned in (
        lambda: TorqueFree(found, np.array(spin)),
        lambda: TorqueFree(points, np.array(spin)),
        lambda: precession(found, spin),
        lambda: CertifiedRotation.of(exact, spin),
    ):
        with pytest.raises(InvalidParameter, match="three moments of inertia greater than 0"):
            turned()


@settings(deadline=None, max_examples=draws(60))
@given(st.integers(0, 2**32), st.integers(-900, 900))
def test_rounding_does_not_make_a_needle_impossible(seed: int, exponent: int) -> None:
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    tensor = np.ldexp(np.eye(3) - np.outer(axis, axis), exponent)
    found = InertiaTensor(rows(tensor)).mass_properties()
    size = np.ldexp(1.0, exponent)
    assert abs(found.principal.moments[0]) <= 1e-15 * size
    assert found.symmetry == "linear"
    assert found.validity.physical
    codes = [notice.code for notice in found.warnings]
    assert codes == (["moment-below-rounding"] if found.principal.moments[0] < 0 else [])


def test_a_negative_moment_is_refused() -> None:
    for tensor in (np.diag([-1e-3, 1, 1]), [[1, 2, 0], [2, 1, 0], [0, 0, 1]], np.diag([1, 1, -1e-13])):
        with pytest.raises(UnphysicalInertia) as caught:
            InertiaTensor(rows(tensor)).mass_properties()
        assert caught.value.path == ("tensor",)


def test_components_that_differ_by_rounding_are_replaced_by_their_mean_with_a_warning() -> None:
    tensor = np.diag([3.0, 4.0, 5.0])
    tensor[0, 1], tensor[1, 0] = 0.1, np.nextafter(0.1, 1)
    found = InertiaTensor(rows(tensor)).mass_properties()
    assert found.exact_inertia[0][1] == found.exact_inertia[1][0]
    assert found.exact_inertia[0][1] == (Fraction(tensor[0, 1]) + Fraction(tensor[1, 0])) / 2
    assert [notice.code for notice in found.warnings] == ["asymmetric-tensor"]


@pytest.mark.parametrize(("i", "j"), [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize("scale", [1e-300, 1.0, 1.7e308 / 4])
def test_an_asymmetric_tensor_is_refused_at_the_component(i: int, j: int, scale: float) -> None:
    tensor = np.diag([3.0, 4.0, 3.5])
    tensor[i, j] = 1e-14
    with pytest.raises(InvalidParameter, match="symmetric") as caught:
        InertiaTensor(rows(tensor * scale))
    assert caught.value.path == ("tensor", j, i)


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"tensor": rows(np.zeros((3, 3)))}, ("tensor",)),
        ({"tensor": rows(np.eye(3))[:2]}, ("tensor",)),
        ({"tensor": ((1.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))}, ("tensor", 0)),
        ({"tensor": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, NAN, 1.0))}, ("tensor", 2, 1)),
        ({"tensor": rows(1.7e308 * (1.5 * np.eye(3) - 0.5))}, ("tensor",)),
        ({"mass": 0.0}, ("mass",)),
        ({"center_of_mass": (0.0, NAN, 0.0)}, ("center_of_mass", 1)),
    ],
)
def test_tensors_that_are_refused(changes: dict[str, Any], path: tuple[str | int, ...]) -> None:
    with pytest.raises(MechanicsError) as caught:
        InertiaTensor(**{"tensor": rows(np.eye(3)), **changes}).mass_properties()
    assert caught.value.path == path

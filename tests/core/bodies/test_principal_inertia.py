"""Principal moments and axes against mpmath's symmetric eigenvalue solver at 80 digits, on the exact doubles."""

from __future__ import annotations

import itertools

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.principal_inertia import GIVEN, ROUNDED_ONCE, PrincipalInertia, summed
from core.errors import InvalidParameter
from tests.drawn import draws

CONTEXT = mp.mp.clone()
CONTEXT.dps = 80


def exact(value: np.ndarray, tail: np.ndarray) -> mp.matrix:
    return CONTEXT.matrix(value.tolist()) + CONTEXT.matrix(tail.tolist())


def largest(matrix: mp.matrix) -> mp.mpf:
    return max(abs(x) for x in matrix)


def judge(tensor: np.ndarray, tail: np.ndarray) -> tuple[PrincipalInertia, list[mp.mpf]]:
    """Return the decomposition, having checked that it is one, and the errors of its moments over the largest."""
    found = PrincipalInertia.of(tensor, tail)
    given_tensor = exact(tensor, tail)
    axes = exact(found.axes, found.axes_tail)
    moments = exact(found.moments, found.moments_tail)
    size = largest(given_tensor)
    assert largest(axes.T * axes - CONTEXT.eye(3)) < 1e-30
    assert abs(CONTEXT.det(axes) - 1) < 1e-30
    assert largest(axes * CONTEXT.diag(list(moments)) * axes.T - given_tensor) < 1e-30 * size
    true = sorted(CONTEXT.eigsy(given_tensor, eigvals_only=True))
    return found, [abs(m - t) / size for m, t in zip(moments, true, strict=True)]


def symmetric(rng: np.random.Generator) -> np.ndarray:
    a = rng.normal(size=(3, 3))
    return np.triu(a) + np.triu(a, 1).T


@settings(deadline=None, max_examples=draws(150))
@given(st.integers(0, 2**32), st.integers(-900, 900), st.booleans())
def test_any_symmetric_tensor_at_any_scale(seed: int, exponent: int, tailed: bool) -> None:
    rng = np.random.default_rng(seed)
    tensor = symmetric(rng)
    tail = tensor * symmetric(rng) * 2.0**-56 if tailed else np.zeros((3, 3))
    _, errors = judge(np.ldexp(tensor, exponent), np.ldexp(tail, exponent))
    assert max(errors) < 1e-30


@settings(deadline=None, max_examples=draws(100))
@given(st.integers(0, 2**32), st.floats(-12, 0), st.floats(-12, 0))
def test_small_moments_of_a_graded_tensor_are_right_to_their_own_size(seed: int, p: float, q: float) -> None:
    # D H D with H well conditioned: Demmel and Veselic (1992) bound the relative error by the condition of H alone.
    rng = np.random.default_rng(seed)
    h = np.eye(3) + 0.3 * np.triu(rng.uniform(-1, 1, (3, 3)), 1)
    h = np.triu(h) + np.triu(h, 1).T
    d = np.array([1.0, 10.0**p, 10.0 ** (p + q)])[rng.permutation(3)]
    tensor = d[:, None] * h * d
    tensor = np.triu(tensor) + np.triu(tensor, 1).T
    found, _ = judge(tensor, np.zeros((3, 3)))
    true = sorted(CONTEXT.eigsy(exact(tensor, np.zeros((3, 3))), eigvals_only=True))
    for moment, t in zip(exact(found.moments, found.moments_tail), true, strict=True):
        assert abs(moment - t) < 1e-28 * t


@pytest.mark.parametrize("order", list(itertools.permutations((0.1, 0.7, 3.3))))
def test_a_diagonal_tensor_is_only_sorted(order: tuple[float, ...]) -> None:
    tail = np.diag([1e-18, -2e-18, 3e-18])
    found, errors = judge(np.diag(order), tail)
    assert max(errors) == 0
    assert found.moments.tolist() == sorted(order)
    assert set(np.abs(found.axes).ravel().tolist()) == {0.0, 1.0}
    assert not found.axes_tail.any()


def test_axes_in_ascending_order_already_are_the_identity() -> None:
    assert (PrincipalInertia.of(np.diag([1.0, 1.0, 2.0])).axes == np.eye(3)).all()


@pytest.mark.parametrize("alone", [0, 1, 2])
def test_a_decoupled_moment_stays_as_it_is(alone: int) -> None:
    tensor = np.zeros((3, 3))
    i, j = (k for k in range(3) if k != alone)
    tensor[alone, alone], tensor[i, i], tensor[j, j], tensor[i, j], tensor[j, i] = 1e-40 / 3, 2.0, 1.0, 0.5, 0.5
    found = PrincipalInertia.of(tensor)
    assert found.moments[0] == 1e-40 / 3
    assert found.moments_tail[0] == 0.0
    assert np.abs(found.axes[:, 0]).tolist() == [float(k == alone) for k in range(3)]


def test_an_unresolved_moment_is_zero_and_a_resolved_one_is_not() -> None:
    along = np.array([1.0, 2.0, 3.0])
    needle = 14.0 * np.eye(3) - np.outer(along, along)
    assert PrincipalInertia.of(needle).moments[0] == 0.0
    resolved = PrincipalInertia.of(needle, 1e-25 * np.eye(3))
    assert abs(resolved.moments[0] - 1e-25) < 1e-29


@pytest.mark.parametrize(
    ("moments", "name"),
    [
        ((2, 2, 2), "spherical"),
        ((1, 1, 2), "oblate"),
        ((1, 2, 2), "prolate"),
        ((2, 1, 3), "triaxial"),
        ((1e-20, 1, 1), "linear"),
        ((0, 1, 1), "linear"),
        ((0, 0, 0), "point"),
        ((1, 1 + 2**-52, 2), "oblate"),
        ((1, 1 + 1e-13, 2), "triaxial"),
    ],
)
@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_symmetry_is_free_of_scale(moments: tuple[float, ...], name: str, scale: float) -> None:
    assert PrincipalInertia.of(np.diag(moments) * scale).symmetry == name


def test_arrays_cannot_be_written() -> None:
    found = PrincipalInertia.of(np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 1.0]]))
    with pytest.raises(ValueError, match="read-only"):
        found.moments[0] = 0.0


@settings(deadline=None, max_examples=draws(80))
@given(st.integers(0, 2**32), st.integers(4, 60), st.booleans())
def test_nearly_equal_moments(seed: int, bits: int, lower: bool) -> None:
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    near = 1.0 + 2.0**-bits
    tensor = axes @ np.diag([1.0, near, 1.7] if lower else [0.3, 1.0, near]) @ axes.T
    tensor = np.triu(tensor) + np.triu(tensor, 1).T
    found, errors = judge(tensor, np.zeros((3, 3)))
    assert max(errors) < 1e-30
    gap = found.moments[1] - found.moments[0] if lower else found.moments[2] - found.moments[1]
    assert gap == pytest.approx(2.0**-bits, abs=4e-15)


@settings(deadline=None, max_examples=draws(80))
@given(st.integers(0, 2**32), st.sampled_from([(0, 1), (0, 2), (1, 2)]), st.floats(-40, 0))
def test_one_product_of_inertia_and_tails(seed: int, place: tuple[int, int], size: float) -> None:
    rng = np.random.default_rng(seed)
    tensor, tail = np.diag(rng.uniform(0.5, 2.0, 3)), np.zeros((3, 3))
    i, j = place
    tensor[i, j] = tensor[j, i] = 10.0**size * rng.uniform(-0.4, 0.4)
    tail = tensor * symmetric(rng) * 2.0**-56
    found, errors = judge(tensor, tail)
    assert max(errors) < 1e-30
    alone = 3 - i - j
    column = int(np.argmax(np.abs(found.axes[alone])))
    assert found.moments[column] == tensor[alone, alone]
    assert found.moments_tail[column] == tail[alone, alone]
    assert not found.axes[[i, j], column].any()


def test_moments_beyond_the_range_of_doubles_are_refused() -> None:
    tensor = 1.7e308 * (1.5 * np.eye(3) - 0.5)
    with pytest.raises(InvalidParameter, match="range of doubles"):
        PrincipalInertia.of(tensor)
    assert PrincipalInertia.of(tensor / 4).moments[2] == pytest.approx(1.5 / 4 * 1.7e308, rel=1e-15)


def test_moments_that_are_given_differ_if_they_are_not_the_same() -> None:
    found = PrincipalInertia.of(np.diag([1.0, 1.0 + 2.0**-52, 2.0]))
    assert found.rounding == GIVEN
    assert found.apart == (True, True)
    assert found.nearly_equal
    assert PrincipalInertia.of(np.diag([2.0, 1.0, 2.0])).apart == (True, False)
    # Of a tail alone, too.
    tailed = PrincipalInertia.of(np.diag([1.0, 1.0, 2.0]), np.diag([0.0, 1e-30, 0.0]))
    assert tailed.apart == (True, True)
    assert not PrincipalInertia.of(np.diag([1.0, 1.5, 2.0])).nearly_equal


@pytest.mark.parametrize(("bits", "apart"), [(60, True), (94, True), (98, False), (104, False)])
def test_derived_moments_differ_beyond_their_resolution(bits: int, apart: bool) -> None:
    g = 2.0**-bits
    found = PrincipalInertia.of(np.array([[1.0, g, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 2.0]]))
    assert not found.rounding.exact_zeros
    assert found.apart == (apart, True)
    # Diagonal sums are derived as well, though their axes are those of the body.
    summed_up = PrincipalInertia.of(np.eye(3), np.diag([0.0, g, 2.0 * g]), summed(10))
    assert summed_up.apart == (apart, apart)
    assert PrincipalInertia.of(np.eye(3), np.diag([0.0, g, 2.0 * g]), ROUNDED_ONCE).apart == (True, True)


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_a_start_along_an_axis_of_a_tensor_is_recognised_exactly(scale: float) -> None:
    # Moments 11, 12, 18 along (4, -1, 8)/9, (-4, -8, 1)/9, (7, -4, -4)/9, times 81.
    axes = np.array([[4, -4, 7], [-1, -8, -4], [8, 1, -4]], dtype=float)
    tensor = scale * (axes @ np.diag([11.0, 12.0, 18.0]) @ axes.T)
    known = PrincipalInertia.of(scale * np.round(tensor / scale)).tensor
    assert known is not None
    if scale == 1.0:
        for axis in axes.T:
            assert known.turns_steadily(3e-150 * axis / 3e-150)
            assert not known.turns_steadily(axis + np.array([0.0, 2.0**-50, 0.0]))
    assert not known.turns_steadily(np.array([1.0, 2.0, 3.0]))
    assert known.turns_steadily(np.zeros(3))

"""Jacobi's rotations against eigenvalues at 60 digits, and by exact identities of their results.

u^2 = 2^-106. A rotation turns a component by at most eight operations on pairs, each right to 4 u^2, and cyclic sweeps
of a 3 x 3 tensor end after at most six of three rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", 8.5).
"""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.jacobi import jacobi
from tests.drawn import draws

SQUARE = 2.0**-106
TURN = 8 * 4 * SQUARE
ALL_TURNS = 18 * TURN

entry = st.floats(-1.0, 1.0)
parts = st.floats(-0.5, 0.5)
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
tensors = st.lists(st.tuples(entry, parts), min_size=6, max_size=6)


def symmetric(entries: list[float]) -> np.ndarray:
    out = np.empty((3, 3))
    for (i, j), x in zip(PLACES, entries, strict=True):
        out[i, j] = out[j, i] = x
    return out


def with_tails(entries: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    values = symmetric([x for x, _ in entries])
    return values, symmetric([part * float(np.spacing(abs(x))) for x, part in entries])


def exact(value: np.ndarray, tail: np.ndarray) -> list:
    return [Fraction(float(h)) + Fraction(float(t)) for h, t in zip(value.ravel(), tail.ravel(), strict=True)]


def matrix(value: np.ndarray, tail: np.ndarray) -> list[list[Fraction]]:
    flat = exact(value, tail)
    return [flat[:3], flat[3:6], flat[6:]]


def of_mpmath(a: list[list[Fraction]]) -> mpmath.matrix:
    return mpmath.matrix([[mpmath.mpf(x.numerator) / x.denominator for x in row] for row in a])


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(tensors)
def test_eigenvalues_of_any_tensor(entries: list[tuple[float, float]]) -> None:
    a, e = with_tails(entries)
    values, tails, _, _ = jacobi(a, e)
    with mpmath.workdps(60):
        full = of_mpmath(matrix(a, e))
        wanted = sorted(mpmath.eigsy(full, eigvals_only=True))
        got = sorted(mpmath.mpf(x.numerator) / x.denominator for x in exact(values, tails))
        size = mpmath.norm(full)
        # Weyl: an eigenvalue moves by no more than the tensor does; entries below the normal range lose their tails.
        for g, w in zip(got, wanted, strict=True):
            assert abs(g - w) <= ALL_TURNS * size + 5e-324


@settings(deadline=None, derandomize=True, max_examples=draws(150))
@given(tensors)
def test_eigenvectors_are_a_right_handed_frame_in_which_the_tensor_is_diagonal(entries) -> None:
    a, e = with_tails(entries)
    values, tails, vectors, vector_tails = jacobi(a, e)
    full, frame, lam = matrix(a, e), matrix(vectors, vector_tails), exact(values, tails)
    size = max(abs(x) for row in full for x in row)
    few = Fraction(2 * ALL_TURNS)
    for i in range(3):
        for j in range(3):
            scalar = sum(frame[k][i] * frame[k][j] for k in range(3))
            assert abs(scalar - (i == j)) <= few
            image = sum(full[i][k] * frame[k][j] for k in range(3))
            assert abs(image - lam[j] * frame[i][j]) <= 9 * few * size + Fraction(5e-324)
    x, y, z = ([frame[k][i] for k in range(3)] for i in range(3))
    determinant = sum(x[i] * (y[i - 2] * z[i - 1] - y[i - 1] * z[i - 2]) for i in range(3))
    assert abs(determinant - 1) <= 9 * few
    # Trace and determinant of the tensor, which no rotation looks at.
    assert abs(sum(lam) - sum(full[i][i] for i in range(3))) <= 9 * few * size + 3 * Fraction(5e-324)


grades = st.tuples(*3 * [st.floats(-40, 0).map(lambda p: 10.0**p)])
well = st.tuples(*3 * [st.floats(-0.3, 0.3)])


@settings(deadline=None, derandomize=True, max_examples=draws(150))
@given(grades, well)
def test_small_eigenvalues_of_a_graded_positive_tensor_are_accurate_relative_to_their_size(scale, cross) -> None:
    """Demmel and Veselic: tensor D A D, A near to 1, D of any grades; the error is relative to each eigenvalue."""
    unit = symmetric([1.0, 1.0, 1.0, *cross])
    a = unit * np.outer(scale, scale)
    a /= np.abs(a).max()
    a = (a + a.T) / 2
    values, tails, _, _ = jacobi(a, np.zeros((3, 3)))
    with mpmath.workdps(220):
        wanted = sorted(mpmath.eigsy(of_mpmath(matrix(a, np.zeros((3, 3)))), eigvals_only=True))
        got = sorted(mpmath.mpf(x.numerator) / x.denominator for x in exact(values, tails))
        # 1/smallest eigenvalue of A is at most 1/(1 - 0.6).
        for g, w in zip(got, wanted, strict=True):
            assert abs(g - w) <= ALL_TURNS / 0.4 * abs(w)


@settings(deadline=None, derandomize=True, max_examples=draws(100))
@given(st.permutations(range(3)), st.tuples(entry, entry, entry, entry))
def test_an_axis_that_is_decoupled_is_left_to_the_last_bit(order, numbers) -> None:
    i, j, k = order
    a = np.zeros((3, 3))
    a[i, i], a[j, j], a[k, k], a[i, j] = numbers
    a[j, i] = a[i, j]
    tail = np.zeros((3, 3))
    tail[k, k] = 0.25 * float(np.spacing(abs(a[k, k])))
    values, tails, vectors, vector_tails = jacobi(a, tail)
    assert (values[k], tails[k]) == (a[k, k], tail[k, k])
    assert np.array_equal(vectors[:, k], np.eye(3)[k])
    assert np.array_equal(vectors[k], np.eye(3)[k])
    assert not vector_tails[:, k].any()


def test_a_diagonal_tensor_is_returned_as_it_is() -> None:
    a = np.diag([3.0, 1.0, 2.0])
    values, tails, vectors, vector_tails = jacobi(a, np.zeros((3, 3)))
    assert values.tolist() == [3.0, 1.0, 2.0]
    assert np.array_equal(vectors, np.eye(3))
    assert not tails.any()
    assert not vector_tails.any()


def test_equal_moments_in_oblique_axes() -> None:
    """1 + n n: one axis of symmetry (1, 2, 2)/3, eigenvalues 2, 1, 1 exactly."""
    n = np.array([1.0, 2.0, 2.0])
    a = (9 * np.eye(3) + np.outer(n, n)) / 32
    values, tails, vectors, vector_tails = jacobi(a, np.zeros((3, 3)))
    got = exact(values, tails)
    order = sorted(range(3), key=got.__getitem__)
    for k, want in zip(order, (9, 9, 18), strict=True):
        assert abs(got[k] - Fraction(want, 32)) <= Fraction(ALL_TURNS)
    axis = exact(vectors[:, order[2]].copy(), vector_tails[:, order[2]].copy())
    assert abs(abs(sum(x * y for x, y in zip(axis, (1, 2, 2), strict=True))) - 3) <= 9 * Fraction(ALL_TURNS)

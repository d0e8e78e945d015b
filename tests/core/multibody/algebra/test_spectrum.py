"""Roots and vectors of matrices against closed forms and against the library's own enclosures."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from flint import acb_mat, arb, arb_mat
from hypothesis import given
from hypothesis import strategies as st

from core.balls import precision
from core.multibody.algebra.spectrum import spectrum


def fixed_chain(size: int) -> arb_mat:
    """Return the second difference with both ends held, whose roots are 2 - 2 cos(k pi/(n + 1))."""
    return arb_mat([[2 * (i == j) - (abs(i - j) == 1) for j in range(size)] for i in range(size)])


@pytest.mark.parametrize(("size", "bits"), [(1, 320), (2, 320), (7, 320), (40, 320), (5, 3400)])
def test_a_chain_has_the_roots_of_its_closed_form(size: int, bits: int) -> None:
    with precision(bits), mpmath.workprec(bits + 40):
        found = spectrum(fixed_chain(size))
        assert found is not None
        ordered = sorted(found[0], key=float)
        for k, root in enumerate(ordered, start=1):
            right = 2 - 2 * mpmath.cos(k * mpmath.pi / (size + 1))
            assert abs(arb(mpmath.nstr(right, bits // 3)) - root) < arb(2) ** (12 - bits * 9 // 10)
            assert root.rad() < arb(2) ** (40 - bits)


def test_vectors_are_vectors() -> None:
    with precision(320):
        matrix = fixed_chain(9)
        roots, vectors = spectrum(matrix) or pytest.fail("no spectrum")
        left, right = (matrix * vectors).tolist(), vectors.tolist()
        for row, column in zip(left, right, strict=True):
            for k, root in enumerate(roots):
                assert row[k].overlaps(root * column[k])
                assert row[k].rad() < 1e-80


numbers = st.integers(-9, 9).map(lambda n: n / 4)


@given(st.lists(st.lists(numbers, min_size=4, max_size=4), min_size=4, max_size=4))
def test_enclosures_overlap_those_of_the_library(rows: list[list[float]]) -> None:
    with precision(320):
        found = spectrum(arb_mat(rows))
        if found is None:
            # Roots that doubles cannot tell apart.
            values = np.linalg.eigvals(np.array(rows))
            gaps = np.abs(values[:, None] - values) + np.eye(4)
            conditions = np.linalg.cond(np.linalg.eig(np.array(rows))[1])
            assert gaps.min() < 1e-3 or conditions > 1e3 or not np.any(rows)
            return
        others = list(acb_mat(rows).eig(multiple=True))
        assert len(found[0]) == 4
        for root in found[0]:
            assert any(abs(root - other) < 1e-60 for other in others)
        if all(isinstance(root, arb) for root in found[0]):
            return
        complex_ones = [root for root in found[0] if root.imag != 0]
        assert sum(root.imag > 0 for root in complex_ones) == sum(root.imag < 0 for root in complex_ones)


@pytest.mark.parametrize("rows", [[[1, 0], [0, 1]], [[0, 1], [0, 0]], [[0, 0], [0, 0]], [[1, 1], [0, 1]]])
def test_coinciding_roots_have_no_spectrum(rows: list[list[int]]) -> None:
    with precision(320):
        assert spectrum(arb_mat(rows)) is None

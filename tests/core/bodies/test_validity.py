"""The validity report: which condition fails, by how much, for which moments, whatever the scale."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.principal_inertia import PrincipalInertia
from core.bodies.validity import TOLERANCE, Validity
from tests.drawn import draws

SCALES = [1e-300, 1e-16, 1.0, 1e150, 1e300]


def judge(*moments: float) -> Validity:
    return Validity.of(PrincipalInertia.of(np.diag(np.array(moments, dtype=float))))


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize(
    "moments", [(1, 1, 1), (1, 1, 2), (0, 1, 1), (0.1, 0.2, 0.30000000000000004), (1, 2, 3), (0, 0, 0), (1e-18, 1, 1)]
)
def test_matter_passes_at_any_scale(moments: tuple[float, ...], scale: float) -> None:
    assert judge(*(scale * m for m in moments)).physical


@pytest.mark.parametrize("scale", SCALES)
def test_the_excess_is_a_share_of_the_trace(scale: float) -> None:
    report = judge(scale, scale, 5 * scale)
    (failed,) = report.violations
    assert not report.physical
    assert failed.name == "triangle-inequality"
    assert failed.excess == pytest.approx(3 / 7, rel=1e-15)
    assert failed.tolerance == TOLERANCE
    assert failed.moments == (5 * scale, scale, scale)


def test_a_negative_moment_is_named() -> None:
    names = [condition.name for condition in judge(-1, 2, 3).violations]
    assert "positive-moments" in names


@settings(deadline=None, max_examples=draws(200))
@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3, st.floats(0.01, 1)), min_size=1, max_size=6), st.integers(-400, 400))
def test_any_points_are_matter(points: list[tuple[float, float, float, float]], exponent: int) -> None:
    r, m = np.ldexp(np.array(points)[:, :3], exponent), np.array(points)[:, 3]
    second = np.einsum("n,ni,nj->ij", m, r, r)
    assert Validity.of(PrincipalInertia.of(np.trace(second) * np.eye(3) - second)).physical


def test_what_is_just_beyond_rounding_fails() -> None:
    assert judge(1, 1, 2 * (1 + 20 * TOLERANCE)).physical is False
    assert judge(1, 1, 2 * (1 + TOLERANCE / 4)).physical is True

"""Polhodes: every point on the energy and on the momentum ellipsoid, in exact rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import diagonal
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.free_rotation import FreeRotation
from core.rotation.surfaces.polhodes import polhode, separatrix
from tests.drawn import draws, sampled
from tests.oracles.cases import cases

positive = st.floats(1e-2, 1e2)
spin = st.floats(-10, 10)


def sums(moments, w) -> tuple[Fraction, Fraction]:
    i = [Fraction(x) for x in moments]
    v = [Fraction(float(x)) for x in w]
    return sum(a * b * b for a, b in zip(i, v, strict=True)), sum((a * b) ** 2 for a, b in zip(i, v, strict=True))


def worst(moments, start, points) -> float:
    energy, momentum = sums(moments, start)
    return max(
        float(max(abs(e / energy - 1), abs(m / momentum - 1))) for e, m in (sums(moments, point) for point in points)
    )


@given(st.tuples(positive, positive, positive), st.tuples(spin, spin, spin))
@settings(deadline=None, derandomize=True, max_examples=draws(150))
def test_every_point_is_on_both_surfaces(moments, start):
    if not any(start):
        return
    curve = polhode(diagonal(moments), np.array(start), 24)
    assert worst(moments, start, curve.points) < 1e-14


@pytest.mark.parametrize(
    "case", [c for c in sampled(cases(), __name__) if any(c.angular_velocity)], ids=lambda case: case.name
)
def test_in_every_regime(case):
    curve = polhode(diagonal(case.moments), np.array(case.angular_velocity), 16)
    assert worst(case.moments, case.angular_velocity, curve.points) < 1e-14
    if curve.closed:
        assert np.array_equal(curve.points[0], curve.points[-1])
    else:
        assert curve.points.shape == (1, 3)


def test_it_is_the_curve_of_the_motion():
    """Every sampled state lies within the spacing of the drawn curve."""
    body, start = diagonal((1.0, 2.0, 3.0)), np.array([0.1, 1.0, 0.15])
    curve = polhode(body, start, 2000).points
    motion = FreeRotation(body.principal, start)
    assert motion.period is not None
    for state in motion.sample(np.linspace(0, motion.period, 50)):
        assert np.linalg.norm(curve - state, axis=1).min() < 3e-3


def test_points_are_spaced_well_next_to_the_separatrix():
    curve = polhode(diagonal((1.0, 2.0, 3.0)), np.array([1e-8, 1.0, 1.2e-8]), 100).points
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    assert steps.max() < 3 * np.median(steps)


def test_separatrix_separates():
    moments = (2.0, 1.0, 0.5)
    curves = separatrix(diagonal(moments), 1.0, 64)
    assert len(curves) == 2
    for curve in curves:
        for point in curve.points:
            energy, momentum = sums(moments, point)
            assert abs(energy / 2 - 1) < 1e-14
            # L^2 = 2 E I_middle
            assert abs(momentum / 2 - 1) < 1e-14
    assert not np.allclose(curves[0].points, curves[1].points)


def test_no_separatrix_with_two_equal_moments():
    assert separatrix(diagonal((1.0, 1.0, 2.0)), 1.0) == ()


def test_counts_are_limited():
    with pytest.raises(InvalidParameter):
        polhode(diagonal((1.0, 2.0, 3.0)), np.ones(3), 7)
    assert len(polhode(diagonal((1.0, 2.0, 3.0)), np.ones(3), 8).points) >= 8
    with pytest.raises(BudgetExceeded):
        separatrix(diagonal((1.0, 2.0, 3.0)), 1.0, 10**7)

"""Sensitivities of principal moments and components against those of the moved tensor, at 60 digits."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.exact import rotation
from core.rotation.uncertainty.projected_sensitivities import given_moment_sensitivities, projected_sensitivities
from tests.drawn import draws

U = 2.0**-53
STEP = mpmath.mpf(10) ** -20
quaternion = st.tuples(*4 * [st.integers(-20, 20)]).filter(any)
entry = st.floats(-1.0, 1.0)
gap = st.floats(0.1, 1.0)


def tensor_of(entries) -> np.ndarray:
    a, b, c, d, e, f = entries
    return np.array([[a, d, e], [d, b, f], [e, f, c]])


def along(axes: mpmath.matrix, moments, change: mpmath.matrix, velocity) -> tuple[list, list, mpmath.matrix]:
    """Return moments, components and axes of the tensor axes diag(moments) axes^T + change."""
    full = axes * mpmath.diag(moments) * axes.T + change
    values, vectors = mpmath.eigsy((full + full.T) / 2)
    for k in range(3):
        if sum(vectors[n, k] * axes[n, k] for n in range(3)) < 0:
            vectors[:, k] = -vectors[:, k]
    return list(values), [sum(vectors[n, k] * velocity[n] for n in range(3)) for k in range(3)], vectors


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(quaternion, gap, gap, st.tuples(entry, entry, entry), st.tuples(*6 * [entry]))
def test_perturbation_of_first_order(q, low, high, velocity, entries) -> None:
    exact = rotation([Fraction(x) for x in q])
    change = tensor_of(entries)
    with mpmath.workdps(60):
        axes = mpmath.matrix([[mpmath.mpf(x.numerator) / x.denominator for x in row] for row in exact])
        rounded = np.array([[float(x) for x in row] for row in exact])
        w = [mpmath.mpf(x) for x in velocity]
        moments = [mpmath.mpf(1), 1 + mpmath.mpf(low), 1 + mpmath.mpf(low) + mpmath.mpf(high)]
        components = [sum(axes[n, k] * w[n] for n in range(3)) for k in range(3)]
        dI, dw, turns, crossed, own = projected_sensitivities(
            low, high, np.array([float(x) for x in components]), rounded, np.array(velocity), change[None]
        )
        moved = mpmath.matrix(change.tolist())
        above, below = along(axes, moments, STEP * moved, w), along(axes, moments, -STEP * moved, w)
        # Sums of nine products of axes, a quotient by a gap and a product with a component: thirty roundings.
        few = 30 * 3 * U / min(low, high)
        for k in range(3):
            assert abs(dI[0, k] - (above[0][k] - below[0][k]) / (2 * STEP)) <= few
            assert abs(dw[0, k] - (above[1][k] - below[1][k]) / (2 * STEP)) <= 6 * few
        # A turn by a small vector changes the three axes by sqrt 2 of its length together.
        slopes = (above[2] - below[2]) / (2 * STEP)
        turn = mpmath.sqrt(sum(slopes[i, j] ** 2 for i in range(3) for j in range(3)) / 2)
        assert abs(turns[0] - turn) <= 6 * few
    assert not crossed.any()
    assert abs(own - np.linalg.norm(change)) <= 30 * U * 3
    # The start's own components: each along every axis.
    assert np.array_equal(dw[1:], np.array(velocity)[:, None] * rounded)
    assert not dI[1:].any()
    assert not turns[1:].any()


def test_axes_within_equal_moments_are_free() -> None:
    change = tensor_of((0.1, 0.2, 0.3, 0.5, 0.25, -0.125))
    spin = np.array([1.0, 2.0, 4.0])
    dI, dw, turns, crossed, _ = projected_sensitivities(0.0, 2.0, spin, np.eye(3), spin, change[None])
    assert crossed[:, 0].tolist() == [0.5, 0.0, 0.0]
    assert dI[0].tolist() == [0.1, 0.2, 0.3]
    # The axes turn by P_12/(I_2 - I_1) and P_20/(I_0 - I_2) only.
    one, two = -0.125 / 2.0, 0.25 / -2.0
    assert dw[0].tolist() == [two * 4.0, -one * 4.0, one * 2.0 - two * 1.0]
    assert turns[0] == (one**2 + two**2) ** 0.5


def test_moments_and_components_that_were_given_move_alone() -> None:
    dI, dw, turns = given_moment_sensitivities(np.array([1.0, 2.0, 3.0]), np.array([0.5, 0.0, -4.0]))
    assert dI.tolist() == [*np.diag([1.0, 2.0, 3.0]).tolist(), *np.zeros((3, 3)).tolist()]
    assert dw.tolist() == [*np.zeros((3, 3)).tolist(), *np.diag([0.5, 0.0, -4.0]).tolist()]
    assert not turns.any()

"""From body axes to principal axes and back, against rational arithmetic.

u^2 = 2^-106: the components are sums of three products of a pair with a double, each right to 2 u^2, each sum to 3 u^2
(Joldes, Muller, Popescu 2017).
"""

from __future__ import annotations

from fractions import Fraction
from itertools import permutations, product
from math import isqrt

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.exact import rotation
from core.bodies.mass_properties import PrincipalInertia
from core.bodies.principal_inertia import RESOLUTION
from core.rotation.closed_form.principal_frame import PrincipalFrame, resolve
from core.rotation.free_rotation import FreeRotation
from tests.drawn import draws, sampled
from tests.oracles.free_rotation import reference_angular_velocity

SQUARE = Fraction(2) ** -106
ZEROS = np.zeros((3, 3))

component = st.floats(-1.0, 1.0).map(lambda x: x if abs(x) > 1e-30 else 0.0)
quaternion = st.tuples(*4 * [st.integers(-50, 50)]).filter(any)
SIGNED = [(order, signs) for order in permutations(range(3)) for signs in product((1.0, -1.0), repeat=3)]


def pair(x: Fraction) -> tuple[float, float]:
    high = float(x)
    return high, float(x - Fraction(high))


def frame_of(q) -> tuple[np.ndarray, np.ndarray]:
    """Return the rotation by a quaternion of whole numbers, to 106 bits."""
    rows = [[pair(x) for x in row] for row in rotation([Fraction(x) for x in q])]
    return np.array([[x for x, _ in row] for row in rows]), np.array([[x for _, x in row] for row in rows])


def resolved(axes, axes_tail, moments, moments_tail, vector, derived=True) -> np.ndarray:
    out = np.empty((4, 3))
    resolve(axes, axes_tail, np.array(moments), np.array(moments_tail), *vector, derived, out)
    return out


def whole(high: float, low: float) -> Fraction:
    return Fraction(float(high)) + Fraction(float(low))


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(quaternion, st.tuples(component, component, component))
def test_components_along_oblique_axes(q, vector) -> None:
    axes, tail = frame_of(q)
    out = resolved(axes, tail, (1.0, 2.0, 3.0), (1e-17, 1e-17, 1e-17), vector)
    exact = [[whole(axes[j, k], tail[j, k]) * Fraction(vector[j]) for j in range(3)] for k in range(3)]
    largest = max(abs(sum(terms)) for terms in exact)
    for k, terms in enumerate(exact):
        got, size = whole(out[2, k], out[3, k]), sum(abs(x) for x in terms)
        rounded = (2 + 3 + 3) * SQUARE * size
        if got == 0 and sum(terms) != 0:
            assert abs(sum(terms)) <= Fraction(RESOLUTION) * largest * 2 + rounded
        else:
            assert abs(got - sum(terms)) <= rounded
    assert out[:2].tolist() == [[1.0, 2.0, 3.0], [1e-17, 1e-17, 1e-17]]


@pytest.mark.parametrize(("order", "signs"), sampled(SIGNED, __name__))
def test_along_body_axes_nothing_is_rounded_and_nothing_is_taken_as_noise(order, signs) -> None:
    axes = np.zeros((3, 3))
    for k, (row, sign) in enumerate(zip(order, signs, strict=True)):
        axes[row, k] = sign
    frame = PrincipalFrame(axes, ZEROS)
    assert frame.aligned
    assert frame.rows == list(order)
    assert frame.signs == list(signs)
    vector = (1.0, -1e-290, 1e290)
    moments = (1.0, 1.0 + 2.0**-52, 1e300)
    out = resolved(axes, ZEROS, moments, (0.0, 0.0, 0.0), vector, derived=False)
    assert out[0].tolist() == list(moments)
    assert out[2].tolist() == [sign * vector[row] for row, sign in zip(order, signs, strict=True)]
    assert not out[1].any()
    assert not out[3].any()
    body = frame.to_body(np.array([[1.5, -2.5, 1e-300], out[2]]))
    assert np.array_equal(body, np.array([[1.5, -2.5, 1e-300], out[2]]) @ axes.T)
    assert tuple(body[1]) == vector


def test_oblique_axes_are_not_aligned() -> None:
    axes, tail = frame_of((5, 1, 2, 3))
    assert not PrincipalFrame(axes, tail).aligned
    # One tail that is not zero, or one entry that is not, and they are not the body's.
    assert not PrincipalFrame(np.eye(3), np.diag([1e-40, 0.0, 0.0])).aligned
    vectors = np.array([[1.0, 2.0, 3.0], [0.5, -0.25, 0.0]])
    assert np.array_equal(PrincipalFrame(axes, tail).to_body(vectors), vectors @ axes.T)


@pytest.mark.parametrize("places", [(0, 1), (1, 2)])
@pytest.mark.parametrize("bits", [20, 52, 54, 60, 90, 95, 97, 100])
def test_moments_are_equal_below_the_resolution_and_only_there(places, bits) -> None:
    """Differences in the tails count: a body that is not symmetric by 2^-60 is out of step after 2^60 radians."""
    first, second = places
    gap = Fraction(2) ** -bits
    moments = [Fraction(1)] * 3
    moments[2] = Fraction(1) if second == 2 else Fraction(2)
    moments[0] = Fraction(1) if first == 0 else Fraction(1, 2)
    moments[first] -= gap
    moments[second] += gap
    axes, tail = frame_of((5, 1, 2, 3))
    pairs = [pair(x) for x in moments]
    out = resolved(axes, tail, [h for h, _ in pairs], [low for _, low in pairs], (0.3, 0.4, 1.0))
    same = tuple(out[:2, first]) == tuple(out[:2, second])
    assert same == (2 * gap <= Fraction(RESOLUTION) * max(moments))
    if not same:
        assert [tuple(out[:2, k]) for k in range(3)] == pairs


def test_components_below_the_resolution_are_noise() -> None:
    axes, tail = frame_of((1, 1, 1, 1))
    for small, kept in ((2.0**-95, True), (2.0**-97, False)):
        out = resolved(axes, tail, (1.0, 2.0, 3.0), (1e-17, 0.0, 0.0), (1.0, small, 0.25))
        assert bool(np.count_nonzero(out[2]) == 3) == kept


@pytest.mark.parametrize("bits", [50, 54, 56, 60])
def test_the_stated_error_covers_a_body_that_is_symmetric_in_doubles_only(bits) -> None:
    """Tensor ((1, g, 0), (g, 1, 0), (0, 0, 2)): moments 1 - g and 1 + g along the diagonals, the same double."""
    g = 2.0**-bits
    rotating = FreeRotation(
        PrincipalInertia.of(np.array([[1.0, g, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 2.0]])), np.array([0.25, 0.5, 1.0])
    )
    times = np.array([0.0, 1e6, 1e12])
    # Along (1, -1, 0) and (1, 1, 0); 1/sqrt 2 enters only the size of both components, to 300 bits.
    root = Fraction(isqrt(2 << 600), 2 << 300)
    start = [-root / 4, root * 3 / 4, Fraction(1)]
    wanted = reference_angular_velocity((1 - Fraction(g), 1 + Fraction(g), Fraction(2)), start, times.tolist())
    with mpmath.workdps(50):
        for got, (a, b, c) in zip(rotating.sample(times), wanted, strict=True):
            body = ((a + b) / mpmath.sqrt(2), (b - a) / mpmath.sqrt(2), c)
            off = mpmath.norm([float(x) - y for x, y in zip(got, body, strict=True)])
            assert off <= rotating.error(times) * rotating.largest_norm

"""Angles of directions, against complex numbers."""

from __future__ import annotations

import cmath

import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ZERO


@pytest.mark.parametrize("angle", [-3.1, -2, -1, 0, 0.5, 1.6, 3, 3.14])
@pytest.mark.parametrize("length", [1e-30, 1, 7e40])
def test_the_angle_of_a_direction_of_any_length(angle: float, length: float) -> None:
    direction = cmath.rect(length, angle)
    assert abs(float(polar_angle(arb(direction.real), arb(direction.imag))) - angle) < 1e-15


@pytest.mark.parametrize(("side", "expected"), [(1, 0), (-1, cmath.pi)])
@pytest.mark.parametrize("sine", [ZERO, arb(0, 1e-20), arb(1e-20, 2e-20), arb(-1e-20, 2e-20)])
def test_what_is_not_told_from_half_a_turn_has_a_narrow_angle(side: int, expected: float, sine: arb) -> None:
    with precision(128):
        found = polar_angle(arb(side), sine)
    assert float(found.rad()) < 1e-19
    assert abs(float(found) - expected) < 1e-15


def test_beside_half_a_turn_the_sign_tells_the_side() -> None:
    assert polar_angle(arb(-1), arb(-1e-20, 1e-21)) < -3
    assert polar_angle(arb(-1), arb(1e-20, 1e-21)) > 3

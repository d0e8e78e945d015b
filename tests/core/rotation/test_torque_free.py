"""A body held away from its centre of mass is said not to be free."""

import numpy as np
import pytest

from core.bodies.composite import Composite, Part
from core.bodies.examples import t_handle_points
from core.bodies.measured import PointMasses, PrincipalMoments
from core.bodies.solids import Ball
from core.rotation.torque_free import TorqueFree

CROSS = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 2, 0], [0, -2, 0], [0, 0, 3], [0, 0, -3]])


def codes(body):
    notices = TorqueFree(body.mass_properties(), np.array([1.0, 10.0, 1.0])).warnings
    return [(notice.code, notice.path) for notice in notices]


@pytest.mark.parametrize("size", [1e-60, 1.0, 1e60])
def test_points_held_away_from_their_center_of_mass_are_not_free(size):
    assert codes(PointMasses(1.0, size * (CROSS + np.array([1e-3, 0, 0])), about="origin")) == [
        ("not-free", ("body", "about"))
    ]


@pytest.mark.parametrize("size", [1e-60, 1.0, 1e60])
def test_points_held_at_their_center_of_mass_are_free(size):
    assert codes(PointMasses(1.0, size * CROSS, about="origin")) == []
    # The rounding of positions moves the centre of mass by some 1e-17 of the size.
    angle = 2 * np.pi * np.arange(7) / 7
    ring = size * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    center = PointMasses(1.0, ring).mass_properties().center_of_mass
    assert 0.0 < np.abs(center).max() < 1e-15 * size
    assert codes(PointMasses(1.0, ring, about="origin")) == []


def test_a_composite_is_judged_the_same_way():
    parts = (Part(Ball(radius=1.0, mass=1.0), (0.0, 0.0, 1.0)), Part(Ball(radius=1.0, mass=2.0)))
    assert codes(Composite(parts, about="origin")) == [("not-free", ("body", "about"))]
    assert codes(Composite(parts)) == []
    assert codes(Composite(parts[1:], about="origin")) == []


def test_free_bodies_have_nothing_to_be_told():
    assert codes(t_handle_points()) == []
    assert codes(PrincipalMoments((1.0, 2.0, 2.5))) == []


def test_the_distance_is_named():
    body = PointMasses(1.0, CROSS + np.array([0.25, 0, 0]), about="origin").mass_properties()
    (notice,) = TorqueFree(body, np.array([1.0, 0.0, 0.0])).warnings
    assert "0.25 m" in notice.detail

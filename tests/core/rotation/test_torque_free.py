"""Ranges of energy and angular momentum; the warning `not-free` for a body pinned away from its centre of mass."""

import numpy as np
import pytest

from core.bodies.composite import Composite, Part
from core.bodies.measured import PointMasses, PrincipalMoments
from core.bodies.solids import Ball
from core.rotation.torque_free import TorqueFree
from core.systems.error_statements import drifts
from tests.core.bodies.example_bodies import t_handle_points

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


def test_a_composite_is_validated_the_same_way():
    parts = (Part(Ball(radius=1.0, mass=1.0), (0.0, 0.0, 1.0)), Part(Ball(radius=1.0, mass=2.0)))
    assert codes(Composite(parts, about="origin")) == [("not-free", ("body", "about"))]
    assert codes(Composite(parts)) == []
    assert codes(Composite(parts[1:], about="origin")) == []


def test_free_bodies_have_no_warnings():
    assert codes(t_handle_points()) == []
    assert codes(PrincipalMoments((1.0, 2.0, 2.5))) == []


def test_the_distance_is_named():
    body = PointMasses(1.0, CROSS + np.array([0.25, 0, 0]), about="origin").mass_properties()
    (notice,) = TorqueFree(body, np.array([1.0, 0.0, 0.0])).warnings
    assert "0.25 m" in notice.detail


@pytest.mark.parametrize("scale", [5e-324, 1e-300, 1.0, 1e300])
@pytest.mark.parametrize("count", [1, 511, 512, 1025])
@pytest.mark.parametrize("body", [PrincipalMoments((3.0, 1.0, 2.5)), t_handle_points()])
def test_drifts_are_the_largest_changes_of_energy_and_momentum(body, count, scale):
    """Against longdoubles, whose exponents reach much further, sample by sample."""
    properties = body.mass_properties()
    rows = np.random.default_rng(count).integers(1, 9, (count, 3)) * scale
    system = TorqueFree(properties, np.array([3.0, 5.0, 2.0]) * scale)
    tensor = properties.inertia.astype(np.longdouble)
    w = np.vstack([system.angular_velocity, rows]).astype(np.longdouble)
    m = w @ tensor
    energy, momentum = (w * m).sum(axis=1) / 2, np.sqrt((m * m).sum(axis=1))
    found = drifts(system, rows)
    for name, values in (("energy", energy), ("angular_momentum", momentum)):
        want = np.abs(values[1:] - values[0]).max() / values[0]
        assert found[name] == pytest.approx(float(want), rel=1e-13, abs=1e-15)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [0, 600, 1029])
def test_a_state_that_is_not_finite_has_no_drift(bad, place):
    rows = np.ones((1030, 3))
    rows[place, 1] = bad
    assert drifts(TorqueFree(PrincipalMoments((3.0, 1.0, 2.5)).mass_properties(), np.ones(3)), rows) == {}

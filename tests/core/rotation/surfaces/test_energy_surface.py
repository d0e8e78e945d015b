"""The energy ellipsoid: vertices on it in exact arithmetic, a mesh that closes, scales at both ends of the doubles."""

import itertools
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import MassProperties, diagonal
from core.bodies.principal_inertia import ZEROS
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from tests.drawn import draws

positive = st.floats(1e-3, 1e3)


def energy_of(moments, w) -> Fraction:
    return sum((Fraction(i) * Fraction(float(x)) ** 2 for i, x in zip(moments, w, strict=True)), Fraction(0)) / 2


@given(st.tuples(positive, positive, positive), positive)
@settings(deadline=None, derandomize=True, max_examples=draws(60))
def test_every_vertex_is_on_the_surface(moments, energy):
    surface = EnergyEllipsoid.of(diagonal(moments), energy)
    x, y, z = surface.grid(7)
    vertices = [*surface.triangles(2).vertices, *zip(x.flat, y.flat, z.flat, strict=True)]
    for vertex in vertices:
        assert abs(energy_of(moments, vertex) / Fraction(energy) - 1) < 2e-15


@pytest.mark.parametrize("resolution", [1, 2, 5, 16])
def test_mesh_is_watertight_and_outward(resolution):
    mesh = EnergyEllipsoid.of(diagonal((2.0, 1.0, 0.5)), 1.0).triangles(resolution)
    assert mesh.faces.shape == (20 * resolution**2, 3)
    assert mesh.vertices.shape == (10 * resolution**2 + 2, 3)
    assert mesh.quality.watertight
    assert mesh.quality.euler_characteristic == 2
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    heights = np.einsum("ij,ij->i", a, np.cross(b, c))
    assert heights.min() > 0
    exact = 4 / 3 * math.pi * math.prod(math.sqrt(2.0 / i) for i in (2.0, 1.0, 0.5))
    assert heights.sum() / 6 == pytest.approx(mesh.quality.volume_ratio * exact, rel=1e-13)


def test_grid_is_the_sphere_stretched_along_the_body_axes():
    x, y, z = EnergyEllipsoid.of(diagonal((2.0, 1.0, 0.5)), 1.0).grid(20)
    theta, phi = np.meshgrid(np.linspace(0, np.pi, 20), np.linspace(0, 2 * np.pi, 40))
    assert x == pytest.approx(math.sqrt(2 / 2.0) * np.sin(theta) * np.cos(phi), abs=1e-15)
    assert y == pytest.approx(math.sqrt(2 / 1.0) * np.sin(theta) * np.sin(phi), abs=1e-15)
    assert z == pytest.approx(math.sqrt(2 / 0.5) * np.cos(theta), abs=1e-15)
    for coordinate in (x, y, z):
        assert np.array_equal(coordinate[0], coordinate[-1])
        for pole in (coordinate[:, 0], coordinate[:, -1]):
            assert np.ptp(pole) == 0.0


@pytest.mark.parametrize("moments", [(2.0, 1.0, 0.5), (1e-6, 1.0, 1.0), (1e150, 2e150, 3e150)])
def test_quality_is_that_of_the_triangles_themselves(moments):
    mesh = EnergyEllipsoid.of(diagonal(moments), 1.0).triangles(4)
    smallest, longest = mpmath.pi, mpmath.mpf(0)
    with mpmath.workdps(40):
        for face in mesh.faces:
            corners = [mpmath.matrix([mpmath.mpf(float(x)) for x in mesh.vertices[k]]) for k in face]
            a, b, c = (mpmath.norm(corners[k] - corners[k - 1]) for k in range(3))
            longest = max(longest, a, b, c)
            # The law of cosines.
            angles = [
                mpmath.acos((q * q + r * r - p * p) / (2 * q * r)) for p, q, r in ((a, b, c), (b, c, a), (c, a, b))
            ]
            smallest = min(smallest, *angles)
        assert abs(mesh.quality.longest_edge / longest - 1) < 1e-14
        assert abs(mesh.quality.smallest_angle / smallest - 1) < 1e-13


def test_volume_converges_with_the_square_of_the_resolution():
    surface = EnergyEllipsoid.of(diagonal((2.0, 1.0, 0.5)), 1.0)
    missing = [1 - surface.triangles(n).quality.volume_ratio for n in (8, 16, 32)]
    for coarse, fine in itertools.pairwise(missing):
        assert coarse / fine == pytest.approx(4, rel=0.03)


def test_semi_axes_are_in_the_order_of_the_body_axes():
    surface = EnergyEllipsoid.of(diagonal((0.5, 8.0, 2.0)), 1.0)
    assert surface.semi_axes == pytest.approx([2.0, 0.5, 1.0])
    assert np.array_equal(surface.axes, np.eye(3))


def test_oblique_axes_are_followed():
    c, s = math.cos(0.4), math.sin(0.4)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    tensor = turn @ np.diag([1.0, 2.0, 3.0]) @ turn.T
    body = MassProperties(0.5 * (tensor + tensor.T), ZEROS)
    vertices = EnergyEllipsoid.of(body, 1.5).triangles(3).vertices
    assert np.einsum("ni,ij,nj->n", vertices, tensor, vertices) == pytest.approx(np.full(len(vertices), 3.0), rel=1e-14)


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_scales(scale):
    surface = EnergyEllipsoid.of(diagonal((scale, 2 * scale, 3 * scale)), scale)
    assert surface.semi_axes == pytest.approx([math.sqrt(2), 1.0, math.sqrt(2 / 3)], rel=1e-15)


def test_through_a_state_has_its_energy():
    body = diagonal((1.0, 2.0, 3.0))
    assert EnergyEllipsoid.through(body, np.array([1.0, 1.0, 1.0])).energy == pytest.approx(3.0, rel=1e-15)


def test_what_has_no_surface_is_refused():
    body = diagonal((1.0, 2.0, 3.0))
    for energy in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InvalidParameter):
            EnergyEllipsoid.of(body, energy)
    with pytest.raises(InvalidParameter):
        EnergyEllipsoid.through(body, np.zeros(3))
    with pytest.raises(InvalidParameter):
        EnergyEllipsoid.through(diagonal((1e150, 2e150, 3e150)), np.array([1e150, 0, 0]))
    surface = EnergyEllipsoid.of(body, 1.0)
    with pytest.raises(InvalidParameter):
        surface.triangles(0)
    with pytest.raises(BudgetExceeded):
        surface.grid(10_000)

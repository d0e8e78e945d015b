from fractions import Fraction
from itertools import chain

import numpy as np
import pytest
from mpmath import mp, mpf

from core.bodies.exact_inertia import ExactInertia
from core.bodies.measured import InertiaTensor, PrincipalMoments
from core.certified.ellipsoid_mesh import certified_grid, certified_triangles
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from tests.core.certified.test_energy_ellipsoid import OBLIQUE, quadrics

PLAIN = ExactInertia.of_moments([3, 1, 2])


@pytest.mark.parametrize(
    ("exact", "body"),
    [
        (PLAIN, PrincipalMoments((3.0, 1.0, 2.0))),
        (OBLIQUE, InertiaTensor(((2.0, 1.0, 0.0), (1.0, 3.0, 1.0), (0.0, 1.0, 5.0)))),
    ],
    ids=["principal axes", "oblique axes"],
)
def test_surfaces_are_those_in_doubles_with_more_digits(exact, body):
    surface, rough = CertifiedEllipsoid.of(exact, "1.5"), EnergyEllipsoid.of(body.mass_properties(), 1.5)
    found, wanted = certified_triangles(surface, 3, 40), rough.triangles(3)
    assert np.array_equal(found.faces, wanted.faces)
    assert np.abs(np.array(found.vertices, dtype=float) - wanted.vertices).max() < 4e-15
    assert (found.quality.watertight, found.quality.euler_characteristic) == (True, 2)
    for name in ("volume_ratio", "smallest_angle", "longest_edge"):
        assert float(getattr(found.quality, name)) == pytest.approx(getattr(wanted.quality, name), rel=1e-13)
    for columns, rough_columns in zip(certified_grid(surface, 4, 40), rough.grid(4), strict=True):
        assert np.abs(np.array(columns, dtype=float) - rough_columns).max() < 4e-15
    points = [*found.vertices, *zip(*map(chain.from_iterable, certified_grid(surface, 4, 40)), strict=True)]
    for point in points:
        assert abs(quadrics(exact, list(point))[0] - 3) < Fraction(1, 10**38)


def test_the_icosahedron_by_its_textbook_figures():
    """Of a ball of radius one: the edge 4/sqrt(10 + 2 sqrt 5), equilateral faces, volume 5 (3 + sqrt 5)/12 edge^3.

    H. S. M. Coxeter, "Regular Polytopes", 3rd ed., table I.
    """
    quality = certified_triangles(CertifiedEllipsoid.of(ExactInertia.of_moments([2, 2, 2]), 1), 1, 50).quality
    with mp.workdps(60):
        edge = 4 / mp.sqrt(10 + 2 * mp.sqrt(5))
        assert abs(mpf(quality.longest_edge) - edge) < mpf("1e-49")
        assert abs(mpf(quality.smallest_angle) - mp.pi / 3) < mpf("1e-49")
        assert abs(mpf(quality.volume_ratio) - 5 * (3 + mp.sqrt(5)) / 12 * edge**3 / (4 * mp.pi / 3)) < mpf("1e-49")


def test_limits():
    surface = CertifiedEllipsoid.of(PLAIN, 1)
    for ask, error in (
        (lambda: certified_triangles(surface, 0, 16), InvalidParameter),
        (lambda: certified_triangles(surface, 201, 16), BudgetExceeded),
        (lambda: certified_triangles(surface, 200, 16), BudgetExceeded),
        (lambda: certified_grid(surface, 1, 16), InvalidParameter),
        (lambda: certified_grid(surface, 200, 1000), BudgetExceeded),
    ):
        with pytest.raises(error):
            ask()

"""The bounds of rounded mass properties against 60 digits of mpmath, which diagonalises by another algorithm."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from core.bodies.composite import Composite, Part
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.mesh import Mesh
from core.bodies.rounding_errors import rounding_errors

FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]


def true_properties(masses: Any, positions: Any) -> dict[str, Any]:
    """Return the properties of point masses by their definitions."""
    m, r = [mpmath.mpf(x) for x in masses], [[mpmath.mpf(x) for x in row] for row in positions]
    total = sum(m)
    center = [sum(a * x[k] for a, x in zip(m, r, strict=True)) / total for k in range(3)]

    def tensor(about: Any) -> Any:
        found = mpmath.zeros(3)
        for a, x in zip(m, r, strict=True):
            d = [x[k] - about[k] for k in range(3)]
            for i in range(3):
                for j in range(3):
                    found[i, j] += a * ((sum(y * y for y in d) if i == j else 0) - d[i] * d[j])
        return found

    return {"mass": total, "center_of_mass": center, "inertia": tensor(center), "about_origin": tensor([0, 0, 0])}


def expect_bounded(properties: Any, true: dict[str, Any]) -> None:
    errors = rounding_errors(properties)
    assert abs(properties.mass - true["mass"]) <= errors["mass"]
    for k in range(3):
        wrong = abs(mpmath.mpf(properties.center_of_mass[k]) - true["center_of_mass"][k])
        assert wrong <= errors["center_of_mass"][k]
    for name, tensor, value, principal in (
        ("", true["inertia"], properties.inertia, properties.principal),
        ("_about_origin", true["about_origin"], properties.inertia_about_origin, properties.principal_about_origin),
    ):
        for i in range(3):
            for j in range(3):
                assert abs(mpmath.mpf(value[i, j]) - tensor[i, j]) <= errors[f"inertia{name}"][i, j]
        moments, axes = mpmath.eigsy(tensor)
        bounds = errors[f"principal{name}"]
        for k in range(3):
            assert abs(mpmath.mpf(principal.moments[k]) - moments[k]) <= bounds["moments"][k]
            column = [mpmath.mpf(x) for x in principal.axes[:, k]]
            sign = 1 if sum(axes[i, k] * column[i] for i in range(3)) > 0 else -1
            for i in range(3):
                assert abs(column[i] - sign * axes[i, k]) <= bounds["axes"][i, k]
        # Half a unit in the last place and hardly more; far away two moments about the origin are nearly equal.
        assert (bounds["moments"] <= 2.0**-52 * principal.moments).all()
        assert bounds["axes"].max() < 1e-14


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("count", [3, 450])
def test_points(count: int, offset: float) -> None:
    chance = np.random.default_rng(count)
    masses, positions = chance.uniform(1.0, 3.0, count), chance.normal(size=(count, 3)) * [1.0, 2.0, 0.3] + offset
    with mpmath.workdps(60):
        expect_bounded(PointMasses(masses, positions).mass_properties(), true_properties(masses, positions))


def test_a_composite_of_many_points() -> None:
    chance = np.random.default_rng(8)
    masses, positions = chance.uniform(1.0, 3.0, 450), chance.normal(size=(450, 3)) * [1.0, 2.0, 0.3]
    parts = (
        Part(PointMasses(masses, positions), position=(3.0, -1.0, 2.0)),
        Part(PointMasses([7.0], [[1.0, 1.0, 9.0]])),
    )
    moved = np.concatenate([positions, [[1.0, 1.0, 9.0]]]).astype(object)
    with mpmath.workdps(60):
        for row in moved[:450]:
            row[:] = [mpmath.mpf(x) + shift for x, shift in zip(row, (3, -1, 2), strict=True)]
        expect_bounded(Composite(parts).mass_properties(), true_properties([*masses, 7.0], moved))


def test_a_tetrahedron() -> None:
    # A tetrahedron has the moments of mass of 1/20 of it at each corner and 4/5 at the middle (E. J. Routh, "Dynamics
    # of a System of Rigid Bodies", elementary part, article 39).
    corners = np.random.default_rng(5).normal((10.0, 20.0, 30.0), size=(4, 3))
    a, b, c = corners[1:] - corners[0]
    faces = FACES if np.cross(a, b) @ c > 0 else [face[::-1] for face in FACES]
    with mpmath.workdps(60):
        exact = [[mpmath.mpf(x) for x in row] for row in corners]
        (a, b, c) = ([x - y for x, y in zip(exact[k], exact[0], strict=True)] for k in (1, 2, 3))
        volume = abs(mpmath.det(mpmath.matrix([a, b, c]))) / 6
        middle = [sum(row[k] for row in exact) / 4 for k in range(3)]
        masses = [volume * 3 / 20] * 4 + [volume * 12 / 5]
        expect_bounded(Mesh(corners, faces, density=3.0).mass_properties(), true_properties(masses, [*exact, middle]))


def test_what_was_given_is_exact() -> None:
    errors = rounding_errors(PrincipalMoments((3.0, 0.1, 3.0)).mass_properties())
    assert not errors["principal"]["moments"].any()
    assert not errors["principal"]["axes"].any()
    assert errors["mass"] is None
    tensor = InertiaTensor(
        ((2.0, 0.5, 0.0), (0.5, 3.0, 0.1), (0.0, 0.1, 4.0)), mass=2.0, center_of_mass=(1.0, 0.1, 0.0)
    )
    errors = rounding_errors(tensor.mass_properties())
    assert errors["mass"] == 0.0
    assert not errors["inertia"].any()
    assert not errors["center_of_mass"].any()
    assert errors["inertia_about_origin"].any()

"""Solids against their volume and surface integrals, evaluated numerically to 40 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import pytest
from mpmath import mp, mpf

from core.bodies.solids import (
    Ball,
    Capsule,
    Cone,
    Cuboid,
    Cylinder,
    CylindricalShell,
    Disc,
    Ellipsoid,
    Hemisphere,
    Rod,
    SphericalShell,
    Torus,
)
from core.errors import InvalidParameter

Number = Any
Profile = Callable[[Number], Number]


class Integrals(NamedTuple):
    """Content, height of the centre of mass, and moments about the centre of mass per mass."""

    content: Number
    height: Number
    moments: tuple[Number, Number, Number]


def _from_moments(content: Number, z: Number, xx: Number, yy: Number, zz: Number) -> Integrals:
    """Return the same from the integrals of 1, z, x^2, y^2 and z^2."""
    height = z / content
    xx, yy, zz = xx / content, yy / content, zz / content - height**2
    return Integrals(content, height, (yy + zz, xx + zz, xx + yy))


def slices(low: Number, high: Number, area: Profile, xx: Profile, yy: Profile, *cuts: Number) -> Integrals:
    """Integrate over slices across z, of known area and second moments of area."""
    ends = [low, *cuts, high]
    return _from_moments(
        mp.quad(area, ends),
        mp.quad(lambda z: z * area(z), ends),
        mp.quad(xx, ends),
        mp.quad(yy, ends),
        mp.quad(lambda z: z * z * area(z), ends),
    )


def revolution(
    low: Number, high: Number, outer: Profile, *cuts: Number, inner: Profile = lambda z: mpf(0)
) -> Integrals:
    """Integrate a body of revolution about z between two profiles, by annuli."""

    def second(z: Number) -> Number:
        return mp.pi * (outer(z) ** 4 - inner(z) ** 4) / 4

    return slices(low, high, lambda z: mp.pi * (outer(z) ** 2 - inner(z) ** 2), second, second, *cuts)


def surface(low: Number, high: Number, radius: Profile, slant: Profile) -> Integrals:
    """Integrate a surface of revolution about z, by hoops; slant is the arc length per height."""

    def second(z: Number) -> Number:
        return mp.pi * radius(z) ** 3 * slant(z)

    return slices(low, high, lambda z: 2 * mp.pi * radius(z) * slant(z), second, second)


def half_chord(radius: Number, z: Number) -> Number:
    return mp.sqrt(max(radius * radius - z * z, mpf(0)))


def _ellipsoid(a: Number, b: Number, c: Number) -> Integrals:
    def share(z: Number) -> Number:
        return 1 - (z / c) ** 2

    # Elliptic slices: area pi a' b', second moments pi a'^3 b'/4 and pi a' b'^3/4.
    return slices(
        -c, c, lambda z: mp.pi * a * b * share(z),
        lambda z: mp.pi * a**3 * b * share(z) ** 2 / 4, lambda z: mp.pi * a * b**3 * share(z) ** 2 / 4,
    )  # fmt: skip


def _capsule(r: Number, length: Number) -> Integrals:
    h = length / 2
    return revolution(-h - r, h + r, lambda z: half_chord(r, max(abs(z) - h, mpf(0))), -h, h)


def _torus(major: Number, minor: Number) -> Integrals:
    # Slices across z end in square roots; with z = r sin(t) the integrands are smooth.
    def wall(t: Number) -> tuple[Number, Number, Number, Number]:
        half, z = minor * mp.cos(t), minor * mp.sin(t)
        outer, inner = major + half, major - half
        return mp.pi * (outer**2 - inner**2) * half, z, mp.pi * (outer**4 - inner**4) / 4 * half, z * z

    ends = [-mp.pi / 2, mp.pi / 2]
    second = mp.quad(lambda t: wall(t)[2], ends)
    return _from_moments(
        mp.quad(lambda t: wall(t)[0], ends),
        mp.quad(lambda t: wall(t)[0] * wall(t)[1], ends),
        second,
        second,
        mp.quad(lambda t: wall(t)[0] * wall(t)[3], ends),
    )


def _spherical_shell(inner: Number, outer: Number) -> Integrals:
    if inner == outer:
        return surface(-outer, outer, lambda z: half_chord(outer, z), lambda z: outer / half_chord(outer, z))
    return revolution(
        -outer, outer, lambda z: half_chord(outer, z), -inner, inner,
        inner=lambda z: half_chord(inner, z) if abs(z) < inner else mpf(0),
    )  # fmt: skip


ORACLES: dict[str, Callable[..., Integrals]] = {
    "ball": lambda radius: revolution(-radius, radius, lambda z: half_chord(radius, z)),
    "cuboid": lambda a, b, c: slices(-c / 2, c / 2, lambda z: a * b, lambda z: a**3 * b / 12, lambda z: a * b**3 / 12),
    "cylinder": lambda radius, height: revolution(-height / 2, height / 2, lambda z: radius),
    "ellipsoid": _ellipsoid,
    "cone": lambda radius, height: revolution(mpf(0), height, lambda z: radius * (1 - z / height)),
    "spherical-shell": _spherical_shell,
    "cylindrical-shell": lambda inner, outer, height: (
        surface(-height / 2, height / 2, lambda z: outer, lambda z: mpf(1))
        if inner == outer
        else revolution(-height / 2, height / 2, lambda z: outer, inner=lambda z: inner)
    ),
    "torus": _torus,
    "capsule": _capsule,
    "hemisphere": lambda radius: revolution(mpf(0), radius, lambda z: half_chord(radius, z)),
}

CASES: tuple[tuple[type, dict[str, Any], str, tuple[float, ...]], ...] = (
    (Ball, {"radius": 0.7}, "ball", (0.7,)),
    (Cuboid, {"edges": (0.3, 1.1, 2.7)}, "cuboid", (0.3, 1.1, 2.7)),
    (Cuboid, {"edges": (1e-9, 1.1, 1e9)}, "cuboid", (1e-9, 1.1, 1e9)),
    (Cylinder, {"radius": 0.4, "height": 1.3}, "cylinder", (0.4, 1.3)),
    (Cylinder, {"radius": 3e8, "height": 1e-7}, "cylinder", (3e8, 1e-7)),
    (Rod, {"length": 1.3, "radius": 0.01}, "cylinder", (0.01, 1.3)),
    (Disc, {"radius": 0.6, "thickness": 0.003}, "cylinder", (0.6, 0.003)),
    (Ellipsoid, {"semi_axes": (0.3, 1.1, 2.7)}, "ellipsoid", (0.3, 1.1, 2.7)),
    (Cone, {"radius": 0.8, "height": 1.7}, "cone", (0.8, 1.7)),
    (SphericalShell, {"inner_radius": 0.9, "outer_radius": 1.3}, "spherical-shell", (0.9, 1.3)),
    (SphericalShell, {"inner_radius": 0.0, "outer_radius": 1.3}, "ball", (1.3,)),
    (SphericalShell, {"inner_radius": 1.3, "outer_radius": 1.3}, "spherical-shell", (1.3, 1.3)),
    (CylindricalShell, {"inner_radius": 0.2, "outer_radius": 0.3, "height": 2.2}, "cylindrical-shell", (0.2, 0.3, 2.2)),
    (CylindricalShell, {"inner_radius": 0.3, "outer_radius": 0.3, "height": 2.2}, "cylindrical-shell", (0.3, 0.3, 2.2)),
    (CylindricalShell, {"inner_radius": 0.0, "outer_radius": 0.3, "height": 2.2}, "cylinder", (0.3, 2.2)),
    (Torus, {"ring_radius": 1.9, "tube_radius": 0.35}, "torus", (1.9, 0.35)),
    (Torus, {"ring_radius": 0.35, "tube_radius": 0.35}, "torus", (0.35, 0.35)),
    (Capsule, {"radius": 0.6, "length": 1.7}, "capsule", (0.6, 1.7)),
    (Capsule, {"radius": 0.6, "length": 0.0}, "ball", (0.6,)),
    (Hemisphere, {"radius": 1.1}, "hemisphere", (1.1,)),
)

case = pytest.mark.parametrize(("solid", "dimensions", "oracle", "arguments"), CASES)


def both(value: float, tail: float) -> Number:
    return mpf(value) + mpf(tail)


def close(found: Number, expected: Number, scale: Number) -> bool:
    return bool(abs(found - expected) <= mpf(10) ** -30 * scale)


def massive(dimensions: dict[str, Any]) -> bool:
    """Return whether a density by volume makes a mass."""
    return dimensions.get("inner_radius") != dimensions.get("outer_radius", -1.0)


@pytest.mark.parametrize(
    ("solid", "dimensions", "oracle", "arguments", "given"),
    [(*entry, given) for entry in CASES for given in ("mass", "density") if given == "mass" or massive(entry[1])],
)
def test_a_solid_is_its_integral(
    solid: type, dimensions: dict[str, Any], oracle: str, arguments: tuple[float, ...], given: str
) -> None:
    with mp.workdps(40):
        integrals = ORACLES[oracle](*map(mpf, arguments))
        amount = 2.3
        found = solid(**dimensions, **{given: amount}).mass_properties()
        mass = mpf(amount) * (integrals.content if given == "density" else 1)
        assert close(both(found.mass, found.mass_tail), mass, mass)
        size = mp.sqrt(sum(integrals.moments))
        assert close(both(found.center_of_mass[2], found.center_of_mass_tail[2]), integrals.height, size)
        assert not found.center_of_mass[:2].any()
        for k, moment in enumerate(integrals.moments):
            assert close(both(found.inertia[k, k], found.inertia_tail[k, k]), mass * moment, mass * moment)
        assert all(found.inertia[i, j] == 0.0 for i in range(3) for j in range(3) if i != j)
        assert found.validity.physical


def test_every_kind_of_solid_has_a_case() -> None:
    kinds = {solid for solid, *_ in CASES}
    assert len(kinds) == 12


def test_what_is_infinitely_thin() -> None:
    # Known by line and surface integrals: m l^2/12, and m r^2/4 across with m r^2/2 along the axis.
    rod = Rod(length=3.0, mass=4.0).mass_properties()
    assert rod.inertia.diagonal().tolist() == [3.0, 3.0, 0.0]
    assert rod.symmetry == "linear"
    disc = Disc(radius=3.0, mass=4.0).mass_properties()
    assert disc.inertia.diagonal().tolist() == [9.0, 9.0, 18.0]
    assert rod.validity.physical
    assert disc.validity.physical


@pytest.mark.parametrize(
    "build",
    [
        lambda: Rod(length=1.0, density=1.0).mass_properties(),
        lambda: Disc(radius=1.0, density=1.0).mass_properties(),
        lambda: SphericalShell(outer_radius=1.0, inner_radius=1.0, density=1.0).mass_properties(),
        lambda: CylindricalShell(outer_radius=1.0, inner_radius=1.0, height=1.0, density=1.0).mass_properties(),
    ],
)
def test_what_has_no_volume_has_no_density(build: Callable[[], Any]) -> None:
    with pytest.raises(InvalidParameter) as refused:
        build()
    assert refused.value.path == ("density",)
    assert refused.value.remedy is not None
    assert "mass" in refused.value.remedy


@pytest.mark.parametrize("given", [{}, {"mass": 1.0, "density": 1.0}])
@case
def test_exactly_one_of_mass_and_density(
    solid: type, dimensions: dict[str, Any], oracle: str, arguments: Any, given: dict[str, float]
) -> None:
    with pytest.raises(InvalidParameter, match="mass") as refused:
        solid(**dimensions, **given)
    assert "density" in str(refused.value)


@case
def test_dimensions_out_of_range_are_refused_by_name(
    solid: type, dimensions: dict[str, Any], oracle: str, arguments: Any
) -> None:
    for name, value in dimensions.items():
        for bad in (-1.0, float("nan"), float("inf"), True, "1"):
            wrong = (value[0], bad, value[2]) if isinstance(value, tuple) else bad
            with pytest.raises(InvalidParameter) as refused:
                solid(**{**dimensions, name: wrong}, mass=1.0)
            assert refused.value.path == ((name, 1) if isinstance(value, tuple) else (name,))


@case
@pytest.mark.parametrize("name", ["mass", "density"])
@pytest.mark.parametrize("bad", [0.0, -0.0, float("nan"), float("inf"), False, "2"])
def test_mass_and_density_out_of_range_are_refused_by_name(
    solid: type, dimensions: dict[str, Any], oracle: str, arguments: Any, name: str, bad: Any
) -> None:
    with pytest.raises(InvalidParameter) as refused:
        solid(**dimensions, **{name: bad})
    assert refused.value.path == (name,)


@case
def test_a_hole_is_nothing_by_itself(solid: type, dimensions: dict[str, Any], oracle: str, arguments: Any) -> None:
    with pytest.raises(InvalidParameter) as refused:
        solid(**dimensions, mass=-1.0).mass_properties()
    assert refused.value.path == ("mass",)
    assert "composite" in str(refused.value.remedy)


def test_radii_in_the_wrong_order() -> None:
    for build, path in (
        (lambda: SphericalShell(outer_radius=1.0, inner_radius=1.5, mass=1.0), "inner_radius"),
        (lambda: CylindricalShell(outer_radius=1.0, inner_radius=1.5, height=1.0, mass=1.0), "inner_radius"),
        (lambda: Torus(ring_radius=1.0, tube_radius=1.5, mass=1.0), "tube_radius"),
    ):
        with pytest.raises(InvalidParameter) as refused:
            build()
        assert refused.value.path == (path,)


@pytest.mark.parametrize(("radius", "mass"), [(1e-200, 1.0), (1e200, 1.0), (1e-100, 1e-200)])
def test_moments_beyond_the_range_of_doubles_are_refused(radius: float, mass: float) -> None:
    with pytest.raises(InvalidParameter, match="range of doubles"):
        Ball(radius=radius, mass=mass).mass_properties()


@pytest.mark.parametrize("wall", [2.0**-20, 2.0**-52])
def test_a_thin_wall_has_all_its_digits(wall: float) -> None:
    # The difference of fifth powers over that of third powers would lose them all.
    with mp.workdps(60):
        a, b = mpf(1 + wall), mpf(1)
        expected = mpf(2) / 5 * (a**5 - b**5) / (a**3 - b**3)
        found = SphericalShell(outer_radius=1 + wall, inner_radius=1.0, mass=1.0).mass_properties()
        assert close(both(found.inertia[0, 0], found.inertia_tail[0, 0]), expected, expected)

"""The energy ellipsoid as a triangle mesh or a grid, to any number of digits."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from flint import arb, fmpq

from core.bodies.exact_inertia import cross
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.certified.free_rotation import Rows
from core.digits.adaptive_precision import bits_for, check_digits, each_determined, until_determined
from core.digits.decimals import decimal, decimals
from core.rotation.exact_start import Balls, dot
from core.rotation.surfaces.energy_surface import CORNERS, Faces, check_resolution, geodesic, topology


@dataclass(frozen=True)
class CertifiedMeshQuality:
    """Quality of the mesh; see `core.rotation.surfaces.energy_surface.MeshQuality`."""

    watertight: bool
    euler_characteristic: int
    volume_ratio: str
    smallest_angle: str
    longest_edge: str


@dataclass(frozen=True, eq=False)
class CertifiedMesh:
    """Vertices, n rows of 3 numerals (rad/s), and faces, shape (m, 3), counter-clockwise seen from outside."""

    vertices: Rows
    faces: Faces
    quality: CertifiedMeshQuality


def certified_triangles(surface: CertifiedEllipsoid, resolution: int, digits: int) -> CertifiedMesh:
    """Return the triangles of `EnergyEllipsoid.triangles`, every vertex on the ellipsoid.

    Raises
    ------
    InvalidParameter, BudgetExceeded
        For a resolution below 1 or above 200, digits outside 16 to 1000, or more digits than one answer may have.
    """
    check_resolution(resolution, 1)
    check_digits(digits, 3 * (10 * resolution**2 + 2))
    sphere = geodesic(resolution)
    corners, weights, faces = (array.tolist() for array in sphere)
    solid = CORNERS.tolist()
    bits = bits_for(digits)

    def directions() -> Callable[[int], Balls]:
        g = (1 + arb(5).sqrt()) / 2

        def component(n: int, k: int) -> arb:
            # An integer and a multiple of g, so components that vanish are exactly zero.
            whole, multiple = (
                sum(w * solid[c][part][k] for w, c in zip(weights[n], corners[n], strict=True)) for part in range(2)
            )
            return whole + multiple * g if multiple else arb(whole)

        def at(n: int) -> Balls:
            x, y, z = (component(n, k) for k in range(3))
            norm = (x * x + y * y + z * z).sqrt()
            return x / norm, y / norm, z / norm

        return at

    def vertices() -> Callable[[int], list[str]]:
        direction, on_surface, floor = directions(), _mapped(surface), _floor(surface, digits)
        return lambda n: decimals(on_surface(direction(n)), digits, floor)

    def quality() -> tuple[str, str, str]:
        direction, on_surface = directions(), _mapped(surface)
        unit = [direction(n) for n in range(len(weights))]
        points = [on_surface(d) for d in unit]
        # A linear map takes the sphere to the ellipsoid, so the volume ratio is the same.
        volume = sum((dot(unit[a], cross(unit[b], unit[c])) for a, b, c in faces), arb(0))
        triangles = [(points[a], points[b], points[c]) for a, b, c in faces]
        angle = _extreme(arb.min, (x for triangle in triangles for x in _angles(*triangle)))
        square = _extreme(arb.max, (x for triangle in triangles for x in _squares(*triangle)))
        return decimal(volume / (8 * arb.pi()), digits), decimal(angle, digits), decimal(square.sqrt(), digits)

    rows = each_determined(vertices, len(weights), bits)
    return CertifiedMesh(
        rows,
        sphere.faces,
        CertifiedMeshQuality(*topology(len(weights), sphere.faces), *until_determined(quality, bits)),
    )


def certified_grid(surface: CertifiedEllipsoid, resolution: int, digits: int) -> tuple[Rows, Rows, Rows]:
    """Return x, y and z over longitude and colatitude, as `EnergyEllipsoid.grid` does.

    Raises
    ------
    InvalidParameter, BudgetExceeded
        For a resolution below 2 or above 200, digits outside 16 to 1000, or more digits than one answer may have.
    """
    check_resolution(resolution, 2)
    check_digits(digits, 6 * resolution**2)

    def points() -> Callable[[int], list[str]]:
        on_surface, floor = _mapped(surface), _floor(surface, digits)
        rings = [arb.sin_cos_pi_fmpq(fmpq(j, resolution - 1)) for j in range(resolution)]
        around = [arb.sin_cos_pi_fmpq(fmpq(2 * i, 2 * resolution - 1)) for i in range(2 * resolution)]

        def at(n: int) -> list[str]:
            (sine, cosine), (ring, height) = around[n // resolution], rings[n % resolution]
            return decimals(on_surface((cosine * ring, sine * ring, height)), digits, floor)

        return at

    rows = each_determined(points, 2 * resolution**2, bits_for(digits))
    x, y, z = (
        [[row[k] for row in rows[i * resolution : (i + 1) * resolution]] for i in range(2 * resolution)]
        for k in range(3)
    )
    return x, y, z


def _mapped(surface: CertifiedEllipsoid) -> Callable[[Balls], Balls]:
    """Return the map from unit vectors to the surface, both in body axes, at the current precision."""
    semi, axes = surface.semi_axis_balls(), surface.axis_balls()
    if surface.inertia.diagonal:
        return lambda d: (semi[0] * d[0], semi[1] * d[1], semi[2] * d[2])
    columns: list[Balls] = [(axes[0][k], axes[1][k], axes[2][k]) for k in range(3)]

    def mapped(d: Balls) -> Balls:
        along = [s * dot(column, d) for s, column in zip(semi, columns, strict=True)]
        x, y, z = (sum((row[k] * along[k] for k in range(3)), arb(0)) for row in axes)
        return x, y, z

    return mapped


def _floor(surface: CertifiedEllipsoid, digits: int) -> int:
    return surface.floor_of_points(_extreme(arb.max, surface.semi_axis_balls()), digits)


def _extreme(of: Callable[[arb, arb], arb], values: Iterable[arb]) -> arb:
    """Return a ball that encloses the smallest or largest of the numbers in balls."""
    found = None
    for value in values:
        found = value if found is None else of(found, value)
    assert found is not None
    return found


def _angles(a: Balls, b: Balls, c: Balls) -> Iterable[arb]:
    for x, y, z in ((a, b, c), (b, c, a), (c, a, b)):
        u, v = _minus(y, x), _minus(z, x)
        across = cross(u, v)
        yield arb.atan2(dot(across, across).sqrt(), dot(u, v))


def _squares(a: Balls, b: Balls, c: Balls) -> Iterable[arb]:
    for x, y in ((a, b), (b, c), (c, a)):
        side = _minus(y, x)
        yield dot(side, side)


def _minus(u: Balls, v: Balls) -> Balls:
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]

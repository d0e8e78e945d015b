"""The ellipsoid of constant kinetic energy in angular-velocity space: semi-axes, a watertight mesh, a grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.closed_form.principal_frame import PrincipalFrame
from core.work import spend

Faces = NDArray[np.int64]

FINEST = 200
"""Largest resolution of a mesh or grid: 800000 triangles, or 400 x 200 points."""


@dataclass(frozen=True)
class MeshQuality:
    """Quality of the mesh as an approximation of the ellipsoid.

    Attributes
    ----------
    watertight : bool
        Whether every edge belongs to two triangles that traverse it in opposite directions.
    euler_characteristic : int
        Vertices less edges plus faces; 2 for a closed surface without holes.
    volume_ratio : float
        Volume inside the triangles over that of the ellipsoid, below one.
    smallest_angle : float
        Of any triangle (rad).
    longest_edge : float
        Of any triangle (rad/s).
    """

    watertight: bool
    euler_characteristic: int
    volume_ratio: float
    smallest_angle: float
    longest_edge: float


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices, shape (n, 3), and faces, shape (m, 3), counter-clockwise seen from outside."""

    vertices: Floats
    faces: Faces
    quality: MeshQuality


@dataclass(frozen=True, eq=False)
class EnergyEllipsoid:
    """The surface w.I.w = 2E.

    Attributes
    ----------
    semi_axes : ndarray, shape (3,)
        sqrt(2E/I_i) along the body axes if these are principal, otherwise along the principal axes with ascending
        moments (rad/s).
    axes : ndarray, shape (3, 3)
        Columns are the axes of the ellipsoid, in body axes.
    energy : float
        J.
    """

    semi_axes: Floats
    axes: Floats
    energy: float

    @classmethod
    def of(cls, body: MassProperties, energy: float) -> EnergyEllipsoid:
        """Return the ellipsoid of a body at an energy greater than 0 (J).

        Raises
        ------
        InvalidParameter
            If the energy is not positive, a moment is zero, or a semi-axis leaves the range of doubles.
        """
        if not (math.isfinite(energy) and energy > 0.0):
            raise InvalidParameter("energy", "be finite and greater than 0 J")
        principal = body.principal_of_motion
        if not principal.moments[0] > 0.0:
            raise InvalidParameter(
                "body", "have three moments of inertia greater than 0 for its energy surface to close"
            )
        # 2E/I with a separate exponent, which is even for the root.
        axes = []
        for moment in principal.moments.tolist():
            (e, p), (i, q) = math.frexp(2.0 * energy if energy < 1e308 else energy), math.frexp(moment)
            exponent = p - q + (0 if energy < 1e308 else 1)
            odd = exponent % 2
            axes.append(_ldexp(math.sqrt(e / i * 2.0**odd), (exponent - odd) // 2))
        frame = PrincipalFrame(principal.axes, principal.axes_tail)
        if frame.aligned:
            return cls(np.array([axes[frame.rows.index(k)] for k in range(3)]), np.eye(3), energy)
        return cls(np.array(axes), principal.axes, energy)

    @classmethod
    def through(cls, body: MassProperties, angular_velocity: Floats) -> EnergyEllipsoid:
        """Return the ellipsoid through an angular velocity, shape (3,).

        Raises
        ------
        InvalidParameter
            If the body is at rest, or the energy leaves the range of doubles.
        """
        largest = float(np.max(np.abs(angular_velocity)))
        if largest == 0.0:
            raise InvalidParameter("angular_velocity", "not be zero: at rest there is no energy surface")
        principal = body.principal_of_motion
        rate, size = math.frexp(largest)[1], math.frexp(float(principal.moments[2]))[1]
        w = principal.axes.T @ np.ldexp(angular_velocity, -rate)
        i = np.ldexp(principal.moments, -size)
        mantissa, exponent = math.frexp(0.5 * float((i * w * w).sum()))
        return cls.of(body, _ldexp(mantissa, exponent + size + 2 * rate, "angular_velocity"))

    def points(self, directions: Floats) -> Floats:
        """Return the images of unit vectors, shape (n, 3), on the surface, both in body axes.

        The map stretches along the principal axes; if they are the body axes, component i by sqrt(2E/I_i).
        """
        scaled = (directions @ self.axes) * self.semi_axes
        # One correction removes the rounding of the direction's length from the energy.
        shape = scaled / self.semi_axes
        scaled *= 1.5 - 0.5 * (shape * shape).sum(axis=1, keepdims=True)
        points: Floats = scaled @ self.axes.T
        return points

    def triangles(self, resolution: int) -> TriangleMesh:
        """Return an icosahedron with edges divided into `resolution` parts, projected on the sphere and stretched.

        Raises
        ------
        InvalidParameter
            If the resolution is below 1.
        BudgetExceeded
            If it is above 200.
        """
        directions, faces = _geodesic_sphere(resolution)
        vertices = self.points(directions)
        return TriangleMesh(vertices, faces, _quality(directions, vertices, faces))

    def grid(self, resolution: int) -> tuple[Floats, Floats, Floats]:
        """Return x, y and z, each of shape (2 resolution, resolution), over longitude and colatitude.

        Colatitude from the body's z axis increases from 0 to pi along rows, longitude from its x axis from 0 to 2 pi
        along columns, both ends included.
        """
        check_resolution(resolution, 2)
        colatitude, longitude = np.linspace(0.0, np.pi, resolution), np.linspace(0.0, 2.0 * np.pi, 2 * resolution)
        # The seam is closed and the poles are points, exactly.
        cosine, sine = np.cos(longitude), np.sin(longitude)
        cosine[-1], sine[-1] = cosine[0], sine[0]
        ring = np.sin(colatitude)
        ring[0] = ring[-1] = 0.0
        sphere = np.stack(
            [np.outer(cosine, ring), np.outer(sine, ring), np.outer(np.ones(2 * resolution), np.cos(colatitude))],
            axis=-1,
        )
        points = self.points(sphere.reshape(-1, 3)).reshape(sphere.shape)
        return points[..., 0], points[..., 1], points[..., 2]


def _ldexp(mantissa: float, exponent: int, name: str = "energy") -> float:
    if not -1021 <= exponent <= 1023:
        raise InvalidParameter(
            name, "give an energy and semi-axes within the range of doubles", remedy="choose other units"
        )
    return math.ldexp(mantissa, exponent)


def check_resolution(resolution: int, least: int) -> None:
    """Raise `InvalidParameter` for a resolution below `least`, `BudgetExceeded` for one above 200."""
    if resolution < least:
        raise InvalidParameter("resolution", f"be at least {least}")
    if resolution > FINEST:
        raise BudgetExceeded(
            "subdivisions", resolution, FINEST, path=("resolution",), remedy="ask for a coarser surface"
        )
    spend(20 * resolution * resolution)


class Geodesic(NamedTuple):
    """An icosahedron with divided edges and shared vertices, before projection on the sphere.

    Attributes
    ----------
    corners : ndarray, shape (n, 3)
        Of the icosahedron; each vertex is a mean of three of them.
    weights : ndarray, shape (n, 3)
        Integer weights of the three corners.
    faces : ndarray, shape (m, 3)
        Indices of vertices.
    """

    corners: Faces
    weights: Faces
    faces: Faces


CORNERS = np.array(
    [
        ((-1, 0, 0), (0, 1, 0)), ((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, -1, 0)), ((1, 0, 0), (0, -1, 0)),
        ((0, -1, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1)), ((0, -1, 0), (0, 0, -1)), ((0, 1, 0), (0, 0, -1)),
        ((0, 0, -1), (1, 0, 0)), ((0, 0, 1), (1, 0, 0)), ((0, 0, -1), (-1, 0, 0)), ((0, 0, 1), (-1, 0, 0)),
    ]
)  # fmt: skip
"""Corners of an icosahedron, shape (12, 2, 3): the first vector plus the golden ratio times the second."""
CORNERS.setflags(write=False)


def geodesic(parts: int) -> Geodesic:
    """Return an icosahedron with every edge divided into so many parts; see `EnergyEllipsoid.triangles`.

    Raises
    ------
    InvalidParameter, BudgetExceeded
        For fewer parts than 1 or more than 200.
    """
    check_resolution(parts, 1)
    solid = [
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
        (11, 10, 2), (10, 7, 6), (7, 1, 8),
        (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1),
    ]  # fmt: skip
    # Each vertex is created once: first the corners, then those inside the edges, then those inside the faces.
    edges = sorted({(min(p, q), max(p, q)) for a, b, c in solid for p, q in ((a, b), (b, c), (c, a))})
    along = np.arange(1, parts)
    count = len(CORNERS)
    first_of = {edge: count + k * (parts - 1) for k, edge in enumerate(edges)}
    every = np.arange(count)
    corners = [np.stack([every, every, every], axis=1)]
    weights = [np.tile([parts, 0, 0], (count, 1))]
    for first, last in edges:
        corners.append(np.tile([first, last, first], (parts - 1, 1)))
        weights.append(np.stack([parts - along, along, 0 * along], axis=1))
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(parts + 1), np.arange(parts + 1), indexing="ij"))
    i, j = i[i + j <= parts], j[i + j <= parts]
    inner = (i > 0) & (j > 0) & (i + j < parts)
    local = np.full((parts + 1, parts + 1), -1, dtype=np.int64)
    steps = np.arange(1, parts)

    def edge(p: int, q: int) -> Faces:
        forward = first_of[(min(p, q), max(p, q))] + steps - 1
        return forward if p < q else forward[::-1]

    upright = i + j < parts
    inverted = i + j < parts - 1
    next_inside = count + len(edges) * (parts - 1)
    faces = []
    for a, b, c in solid:
        local[0, 0], local[parts, 0], local[0, parts] = a, b, c
        local[steps, 0], local[0, steps], local[parts - steps, steps] = edge(a, b), edge(a, c), edge(b, c)
        local[i[inner], j[inner]] = next_inside + np.arange(inner.sum())
        next_inside += int(inner.sum())
        corners.append(np.tile([a, b, c], (int(inner.sum()), 1)))
        weights.append(np.stack([(parts - i - j)[inner], i[inner], j[inner]], axis=1))
        p, q = i[upright], j[upright]
        faces.append(np.stack([local[p, q], local[p + 1, q], local[p, q + 1]], axis=1))
        p, q = i[inverted], j[inverted]
        faces.append(np.stack([local[p + 1, q], local[p + 1, q + 1], local[p, q + 1]], axis=1))
    return Geodesic(np.concatenate(corners), np.concatenate(weights), np.concatenate(faces))


def _geodesic_sphere(parts: int) -> tuple[Floats, Faces]:
    """Return unit vectors and faces."""
    found = geodesic(parts)
    corners = CORNERS[:, 0] + 0.5 * (1.0 + math.sqrt(5.0)) * CORNERS[:, 1]
    vertices = np.zeros((len(found.weights), 3))
    for k in range(3):
        vertices += found.weights[:, k, None] * corners[found.corners[:, k]]
    return vertices / np.sqrt((vertices * vertices).sum(axis=1))[:, None], found.faces


def topology(vertices: int, faces: Faces) -> tuple[bool, int]:
    """Return whether the surface of so many vertices is watertight, and its Euler characteristic."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = np.sort(edges[:, 0] * vertices + edges[:, 1])
    back = np.sort(edges[:, 1] * vertices + edges[:, 0])
    watertight = bool(np.all(np.diff(there) > 0) and np.array_equal(there, back))
    return watertight, vertices - len(edges) // 2 + len(faces)


def _quality(directions: Floats, vertices: Floats, faces: Faces) -> MeshQuality:
    a, b, c = (directions[faces[:, k]] for k in range(3))
    # A linear map takes the sphere to the ellipsoid, so the volume ratio is the same.
    inside = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
    # In units in which products of two lengths do not overflow or underflow.
    unit = math.ldexp(1.0, math.frexp(float(np.abs(vertices).max()))[1] - 1)
    a, b, c = (vertices[faces[:, k]] / unit for k in range(3))

    def angle(x: Floats, y: Floats, z: Floats) -> float:
        u, v = y - x, z - x
        return float(np.min(np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v))))

    return MeshQuality(
        *topology(len(directions), faces),
        inside / (4.0 / 3.0 * math.pi),
        min(angle(a, b, c), angle(b, c, a), angle(c, a, b)),
        unit * max(float(np.linalg.norm(x - y, axis=1).max()) for x, y in ((a, b), (b, c), (c, a))),
    )

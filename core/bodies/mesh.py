"""A uniform solid inside a closed surface of triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np

from core.arrays import Floats, Integers
from core.bodies.closed_surface import closed
from core.bodies.mass_properties import MassProperties
from core.bodies.principal_inertia import DERIVED, Rounding
from core.bodies.recentred import Recentred
from core.bodies.uniform import Shape, Uniform
from core.bodies.validity import Condition
from core.errors import InvalidParameter, UnphysicalInertia
from core.notices import Notice
from core.quantities import Quantity
from core.rows import Rows

VERTICES = Rows(3, Quantity("m"), at_least=4)
FACES = Rows(3, Quantity("1", at_least=0), at_least=4, whole=True)

UNRESOLVED = Fraction(2) ** -40
"""A volume is rejected if the rounding error of its sum may be a larger fraction of it."""


@dataclass(frozen=True, eq=False)
class Mesh(Uniform):
    """A uniform solid given by its surface, a list of triangles.

    Every edge belongs to exactly two triangles, which traverse it in opposite directions. There may be several closed
    surfaces; those that face inwards bound cavities. Intersections of triangles are not checked: a region that is
    enclosed twice counts twice.

    Attributes
    ----------
    vertices : array_like, shape (n, 3)
        In body axes (m). Vertices at the same position count as one; vertices that no face uses are ignored.
    faces : array_like of int, shape (m, 3)
        Indices of the vertices of each triangle, from 0, counter-clockwise as seen from outside.
    """

    vertices: Annotated[Any, VERTICES]
    faces: Annotated[Any, FACES]
    kind: Literal["mesh"] = "mesh"

    def validate(self) -> None:
        """Convert vertices and faces to arrays; raise for a surface that is not closed or not consistently oriented."""
        object.__setattr__(self, "vertices", VERTICES.read(("vertices",), self.vertices))
        object.__setattr__(self, "faces", FACES.read(("faces",), self.faces))
        assert self._closed.size

    @cached_property
    def _closed(self) -> Integers:
        return closed(self.vertices, self.faces)

    @cached_property
    def _solid(self) -> _Solid:
        return _Solid.inside(self.vertices, self._closed)

    @property
    def rounding(self) -> Rounding:
        """Rounding of the inertia tensor, which is a sum over the faces."""
        return Rounding(max(DERIVED.share, self._solid.share), False)

    def shape(self) -> Shape:
        """Return volume, centre of mass and inertia per mass.

        Raises
        ------
        InvalidParameter
            If the surface encloses no volume.
        """
        products = self._solid.products
        trace = products[0][0] + products[1][1] + products[2][2]
        inertia = [[(trace if i == j else 0) - products[i][j] for j in range(3)] for i in range(3)]
        return Shape(self._solid.volume, 0, self._solid.centroid, inertia)

    def mass_properties(self) -> MassProperties:
        """Return the mass properties.

        Raises
        ------
        InvalidParameter
            If the surface encloses no volume, or a result is outside the range of doubles.
        UnphysicalInertia
            If no mass distribution has the resulting moments. Then the surface intersects itself, or a closed part
            that faces inwards is not inside another.
        """
        found = super().mass_properties()
        volume = float(self._solid.volume)
        conditions = (
            Condition("closed-surface", True, f"each of {3 * len(self.faces) // 2} edges belongs to two faces"),
            Condition("consistent-orientation", True, "neighbouring faces run along their edge in opposite directions"),
            Condition("positive-volume", True, f"the volume is {volume:.6g} m^3; self-intersection is not looked for"),
        )
        failed = "; ".join(condition.detail for condition in found.validity.violations)
        if failed:
            raise UnphysicalInertia(
                "faces",
                f"bound a solid: no real body has the moments of its volume, which violate {failed}",
                remedy="turn separate surfaces outwards, and take apart surfaces that pass through each other",
            )
        weighed = 0.0 if self.density is None else self._solid.share * float(found.exact_mass)
        found = replace(found, mass_error=weighed, center_of_mass_error=self._solid.centroid_error)
        return found.with_warnings(self._solid.notices, conditions)


@dataclass(frozen=True)
class _Solid:
    """Volume (m^3), centroid (m) and mean of d_i d_j over the solid, d from the centroid (m^2).

    `share` is the error bound of the means, relative to the largest; `centroid_error` that of a coordinate (m).
    """

    volume: Fraction
    centroid: Sequence[Fraction]
    products: Sequence[Sequence[Fraction]]
    share: float
    centroid_error: float
    notices: tuple[Notice, ...]

    @classmethod
    def inside(cls, vertices: Floats, faces: Integers) -> _Solid:
        # Compiled code is imported only for the bodies that need it.
        from core.bodies.surface_integrals import connected_surfaces, faces_without_area, signed_tetrahedra

        surface = np.empty(len(vertices), dtype=np.int64)
        surfaces = connected_surfaces(faces, surface)
        used = surface >= 0
        # A vertex that no face uses may be anywhere; the position of another keeps it from enlarging the box.
        local = Recentred.on(np.where(used[:, None], vertices, vertices[faces[0, 0]]))
        sums, volumes = np.zeros((2, 10)), np.zeros(surfaces)
        magnitude = signed_tetrahedra(local.high, local.low, faces, surface, sums, volumes)
        # Error bound of the sums for coordinates of at most 1: 40 units of 2^-106 for the term of a face, and 3 units
        # of the partial sum for an addition (Joldes, Muller, Popescu 2017).
        rounding = Fraction(2) ** -104 * (len(faces) + 16) * Fraction(magnitude)
        exact = [Fraction(float(h)) + Fraction(float(t)) for h, t in sums.T]
        if abs(exact[0]) * UNRESOLVED <= rounding:
            raise InvalidParameter(
                "faces",
                "enclose a volume, and that of this surface is zero to within the rounding of its sum",
                remedy="check that the surface is not flat; a lamina is a disc, a cuboid or points",
            )
        notices = [*_flat(*faces_without_area(local.high, faces))]
        if exact[0] < 0:
            exact, volumes = [-x for x in exact], -volumes
            notices.append(
                Notice(
                    "inverted-mesh",
                    "the faces run clockwise as seen from outside; all of them were taken the other way round",
                    ("faces",),
                )
            )
        notices += [*_inward(volumes, magnitude), *_thin(float(rounding / exact[0]))]

        volume = exact[0] / 6
        noise = rounding / volume
        mean = [_resolved(x / 24 / volume, noise) for x in exact[1:4]]
        xx, yy, zz, xy, xz, yz = (x / 120 / volume for x in exact[4:])
        about_middle = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        about_mean = [[about_middle[i][j] - mean[i] * mean[j] for j in range(3)] for i in range(3)]
        u = local.unit
        widest = max(u[k] * u[k] * about_mean[k][k] for k in range(3))
        return cls(
            volume * u[0] * u[1] * u[2],
            [o + s * c for o, s, c in zip(local.reference, u, mean, strict=True)],
            [
                [u[i] * u[j] * (about_mean[i][j] if i == j else _resolved(about_mean[i][j], noise)) for j in range(3)]
                for i in range(3)
            ],
            float(noise * max(u) ** 2 / widest) if widest > 0 else 1.0,
            float(noise * max(u)),
            tuple(notices),
        )


def _resolved(number: Fraction, rounding: Fraction) -> Fraction:
    """Return a sum whose terms cancel, or zero if it is smaller than its rounding error."""
    return number if abs(number) > rounding else Fraction(0)


def _flat(count: int, first: int) -> list[Notice]:
    if not count:
        return []
    detail = f"{count} faces have no area and add nothing (the first is faces/{first})"
    return [Notice("degenerate-faces", detail, ("faces", int(first)))]


def _inward(volumes: Floats, magnitude: float) -> list[Notice]:
    inward = int(np.count_nonzero(volumes < -1e-14 * magnitude))
    if not inward:
        return []
    detail = (
        f"{inward} of {volumes.size} closed surfaces are turned inwards and taken as cavities; "
        "whether they lie inside the others is not checked"
    )
    return [Notice("inward-surfaces", detail, ("faces",))]


def _thin(error: float) -> list[Notice]:
    if error < 2.0**-53:
        return []
    detail = (
        "the volume is a small difference of large terms, as of a leaf or needle that lies askew; "
        f"the figures are right to {error:.1g} of themselves"
    )
    return [Notice("thin-mesh", detail, ("vertices",))]

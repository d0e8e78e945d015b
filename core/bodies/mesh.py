"""Solids bounded by triangles: exact integrals over the surface, about the centre of mass."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from core.bodies.mass_properties import MassProperties
from core.bodies.uniform import Shape, Uniform
from core.bodies.validity import Condition
from core.errors import InvalidParameter, OpenMesh
from core.notices import Notice
from core.quantities import Quantity, Rows

VERTICES = Rows(3, Quantity("m"), at_least=4)
FACES = Rows(3, Quantity("1", at_least=0), at_least=4, whole=True)

UNRESOLVED = 2.0**-90
"""A volume below this share of the cube of the mesh's extent is not told from that of a flat sheet."""


@dataclass(frozen=True)
class MeshReport:
    """What a closed mesh is.

    Attributes
    ----------
    vertices, triangles : int
        As given.
    volume : float
        Enclosed (m^3); positive.
    inward : bool
        Whether the triangles were wound clockwise as seen from outside, so that their signs had to be turned.
    """

    vertices: int
    triangles: int
    volume: float
    inward: bool


@dataclass(frozen=True, eq=False)
class Mesh(Uniform):
    """A uniform solid bounded by triangles.

    The surface must be closed and wound alike throughout: counter-clockwise as seen from outside. Shells wound the other
    way round inside are cavities. Whether it intersects itself is not examined.

    Attributes
    ----------
    vertices : array_like, shape (n, 3)
        (m); kept as an array that cannot be written. Vertices at equal places count as one.
    faces : array_like, shape (m, 3)
        Indices of vertices, from 0; kept as an array that cannot be written.
    """

    vertices: Annotated[Any, VERTICES]
    faces: Annotated[Any, FACES]
    kind: Literal["mesh"] = "mesh"

    def validate(self) -> None:
        """Store vertices and faces as arrays; refuse indices that lead nowhere."""
        object.__setattr__(self, "vertices", VERTICES.read(("vertices",), self.vertices))
        object.__setattr__(self, "faces", FACES.read(("faces",), self.faces))
        if int(self.faces.max()) >= len(self.vertices):
            i, j = (int(k) for k in np.argwhere(self.faces >= len(self.vertices))[0])
            raise InvalidParameter(("faces", i, j), f"be less than {len(self.vertices)}, the number of vertices")

    @cached_property
    def _integrals(self) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
        """Signed volume, centre of mass, second moments about it; exact to about 30 digits.

        Raises
        ------
        OpenMesh
            If edges belong to an odd number of triangles.
        InvalidParameter
            If neighbouring triangles are wound differently, or no volume is enclosed.
        """
        # Compiled code is fetched only for the bodies that need it.
        from core.bodies.mesh_integrals import mesh_integrals

        _require_closed(self.vertices, self.faces)
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        # Halved first, as the sum and the difference of two doubles may exceed their range.
        middle, half = low / 2 + high / 2, float((high / 2 - low / 2).max())
        exponent = int(np.frexp(half)[1])
        scaled = np.ldexp(self.vertices, -exponent)
        out = np.zeros((2, 10))
        mesh_integrals(scaled, self.faces, np.ldexp(middle, -exponent), out)
        volume, *rest = (Fraction(float(v)) + Fraction(float(t)) for v, t in out.T)
        if half == 0.0 or abs(volume) <= UNRESOLVED:
            raise InvalidParameter("faces", "enclose a volume greater than 0, not a flat sheet")
        unit = Fraction(2) ** exponent
        xx, yy, zz, xy, xz, yz = (unit**5 * s for s in rest[3:])
        return unit**3 * volume, [unit * c for c in rest[:3]], [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]

    def shape(self) -> Shape:
        """Return volume, centre of mass and inertia per mass."""
        volume, center, second = self._integrals
        trace = second[0][0] + second[1][1] + second[2][2]
        inertia = [[((trace if i == j else 0) - second[i][j]) / volume for j in range(3)] for i in range(3)]
        return Shape(abs(volume), 0, center, inertia)

    @property
    def report(self) -> MeshReport:
        """Closedness (an open mesh raises), orientation and volume."""
        volume = self._integrals[0]
        return MeshReport(len(self.vertices), len(self.faces), float(abs(volume)), volume < 0)

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body; a mesh wound inwards is turned and warned of."""
        found = super().mass_properties()
        report = self.report
        wound = "inwards, and were turned" if report.inward else "outwards"
        conditions = (
            Condition("closed-mesh", True, f"{report.triangles} triangles enclose a volume"),
            Condition("outward-mesh", True, f"the triangles were wound {wound}"),
            Condition("positive-volume", True, f"the volume is {report.volume:.6g} m^3"),
        )
        inverted = Notice(
            "inverted-mesh",
            "the triangles are wound clockwise as seen from outside; the signs of their volumes were turned",
            ("faces",),
        )
        return found.told((inverted,) if report.inward else (), conditions)


def _require_closed(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
    """Raise unless every edge is run through as often one way as the other: the surface then has no boundary."""
    open_edges, unlike = _boundary(faces, len(vertices))
    if open_edges or unlike:
        # Triangles that do not share indices may still share places, as in the STL format. Adding zero joins -0 to 0.
        place = np.unique(vertices + 0.0, axis=0, return_inverse=True)[1].reshape(-1)
        open_edges, unlike = _boundary(place[faces], len(vertices))
    if open_edges:
        raise OpenMesh(
            "faces",
            f"enclose a volume: {open_edges} edges belong to an odd number of triangles",
            remedy="close the holes of the mesh",
        )
    if unlike:
        raise InvalidParameter(
            "faces",
            f"be wound alike: {unlike} edges are run through in the same direction by their triangles",
            remedy="wind every triangle counter-clockwise as seen from outside",
        )


def _boundary(faces: NDArray[np.int64], count: int) -> tuple[int, int]:
    """Return how many edges belong to an odd number of triangles, and how many others have unequal directions."""
    start, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    proper = start != end
    start, end = start[proper], end[proper]
    key = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    key, sign = key[order], np.where(start < end, 1, -1)[order]
    if key.size == 0:
        return 0, 0
    first = np.flatnonzero(np.r_[True, key[1:] != key[:-1]])
    net, uses = np.add.reduceat(sign, first), np.diff(np.r_[first, key.size])
    odd = uses % 2 == 1
    return int(odd.sum()), int(((net != 0) & ~odd).sum())

"""Rigid bodies. The union `Body` is the catalogue, from which validation, OpenAPI and contract tests are derived."""

from __future__ import annotations

from typing import Annotated

from core.bodies.composite import Composite
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.mesh import Mesh
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
from core.quantities import TaggedBy

Body = Annotated[
    PrincipalMoments
    | InertiaTensor
    | PointMasses
    | Ball
    | Cuboid
    | Cylinder
    | Rod
    | Ellipsoid
    | Cone
    | SphericalShell
    | CylindricalShell
    | Disc
    | Torus
    | Capsule
    | Hemisphere
    | Composite
    | Mesh,
    TaggedBy("kind"),
]

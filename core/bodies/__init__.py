"""What has mass. The union `Body` is the catalogue: validation, OpenAPI and the contract tests follow from it."""

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

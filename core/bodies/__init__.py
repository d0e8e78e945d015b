"""What has mass. The union `Body` is the catalogue: validation, OpenAPI and the contract tests follow from it."""

from __future__ import annotations

from typing import Annotated

from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.quantities import TaggedBy

Body = Annotated[PrincipalMoments | InertiaTensor | PointMasses, TaggedBy("kind")]

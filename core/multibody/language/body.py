"""A body of a described scene, as a frozen dataclass that holds what was written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Any

from core.bodies import Body
from core.multibody.language.declared_units import Measured, Members, Named
from core.multibody.language.written import Angle, Direction, Length, Number, Vector

SIZES = ("at", "corners", "depth", "height", "length", "radius", "semi_axes", "width")
"""Members of a shape that are lengths."""

MOMENT_OF_INERTIA = Measured("kg m^2")
"""The unit of moments of inertia."""


@dataclass(frozen=True)
class SceneBody:
    """What has mass: a particle, a rigid body of the plane or of space, a symmetric top.

    Attributes
    ----------
    mass : number
        In kg; 0 where something else moves with the body.
    at : vector
        Centre of mass (m).
    velocity : vector, optional
        Of the centre of mass (m/s); what is left out follows from the connections.
    inertia : number, optional
        In the plane: about the centre of mass (kg m^2). Without it the body is a particle.
    moments : vector, optional
        In space: principal moments about the centre of mass, in body axes (kg m^2).
    tensor : three vectors, optional
        In space: tensor of inertia about the centre of mass, in body axes (kg m^2).
    body : Body of core.bodies, optional
        In space, in place of `mass` and `moments`: its mass properties, about its centre of mass.
    radius : number, optional
        Of the rim on which it rolls and around which strings wind (m); without it that of a disc or ball about the
        centre of mass.
    shape : mapping, optional
        What touches: ``{"kind": "disc" | "ball", "radius"}``, ``{"kind": "box", "width", "height", "depth"}`` (in the
        plane without depth), ``{"kind": "polygon", "corners"}`` (convex, counter-clockwise),
        ``{"kind": "capsule", "radius", "length"}`` (between the centres of its caps),
        ``{"kind": "cylinder", "radius", "height"}``, ``{"kind": "ellipsoid", "semi_axes"}``, each with its centre `at`
        in body axes, at the centre of mass if left out. In the plane the width of a box and the length of a capsule lie
        along the first axis of the body; in space the axes of discs and cylinders and the length of capsules along the
        third. A mass without inertia is that of the homogeneous solid.
    angle : number, optional
        In the plane: of the body's first axis, counter-clockwise (rad).
    axes : three vectors, optional
        In space: directions of the body axes; the identity if left out.
    angular_velocity : number or vector, optional
        Rad/s; in space in body axes.
    places : mapping of str to vector
        Points of the body, in body axes from its centre of mass (m).
    """

    at: Annotated[Vector, Measured("m")]
    mass: Annotated[Number, Measured("kg")] | None = None
    velocity: Annotated[Vector, Measured("m/s")] | None = None
    inertia: Annotated[Number, MOMENT_OF_INERTIA] | None = None
    moments: Annotated[Vector, MOMENT_OF_INERTIA] | None = None
    tensor: Sequence[Annotated[Vector, MOMENT_OF_INERTIA]] | None = None
    body: Body | None = None
    radius: Length | None = None
    shape: Annotated[Mapping[str, Any], Members(dict.fromkeys(SIZES, "m"))] | None = None
    angle: Angle | None = None
    axes: Sequence[Direction] | None = None
    angular_velocity: Annotated[Number | Vector, Measured("rad/s")] | None = None
    places: Annotated[Mapping[str, Vector], Named("m")] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def rigid(self) -> bool:
        """Whether it has inertia of its own or of its shape, and so an orientation."""
        own = (self.inertia, self.moments, self.tensor, self.body, self.shape)
        return any(entry is not None for entry in own)

    @property
    def rim(self) -> Number | None:
        """The radius on which it rolls: its own, or that of a disc or ball whose centre is the centre of mass."""
        if self.radius is None and self.round and self.shape is not None:
            return self.shape.get("radius")
        return self.radius

    @property
    def round(self) -> bool:
        """Whether its shape is a disc of the plane or a ball, whose centre is the centre of mass."""
        if not isinstance(self.shape, Mapping):
            return False
        at, kind = self.shape.get("at") or (), self.shape.get("kind")
        if kind == "disc" and isinstance(self.at, Sequence) and len(self.at) == 3:
            return False
        return kind in ("disc", "ball") and isinstance(at, Sequence) and all(x == 0 for x in at)

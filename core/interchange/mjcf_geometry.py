"""Inertia and shapes of the bodies of MJCF from their geometries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from core.bodies import Body
from core.bodies.composite import Composite, Part
from core.bodies.solids import Ball, Capsule, Cuboid, Cylinder, Ellipsoid
from core.errors import InvalidParameter
from core.interchange.draft import DraftBody
from core.interchange.frames import Frame, as_quaternion, vector
from core.interchange.inertia import COMPONENTS, inertia_tensor
from core.interchange.mjcf_elements import Compiler, sizes
from core.interchange.xml_reading import Element, fault, shortened

WATER = 1000.0
"""Density of geometries that state none (kg/m^3), as MuJoCo has it."""

SOLIDS = ("sphere", "capsule", "cylinder", "box", "ellipsoid")
"""Types of geometries that are taken."""


def add_inertia(body: DraftBody, element: Element, geoms: Sequence[Element], compiler: Compiler) -> None:
    """Give a body the inertia that is stated, or that of its geometries."""
    inertial = element.first("inertial")
    if inertial is not None and not (geoms and compiler.inertia_from_geoms == "true"):
        own = compiler.frame(inertial)
        body.mass, body.centre = inertial.number("mass"), own.origin
        if "fullinertia" in inertial.attributes:
            given = dict(zip(COMPONENTS, inertial.numbers("fullinertia", 6), strict=True))
            tensor = inertia_tensor(given.__getitem__)
        else:
            tensor = np.diag(inertial.numbers("diaginertia", 3))
        body.tensor = own.rotation @ tensor @ own.rotation.T
        return
    if compiler.inertia_from_geoms == "false":
        return
    parts = [
        Part(_solid(geom), tuple(frame.origin), tuple(as_quaternion(frame.rotation)))
        for geom in geoms
        if geom.get("mass") != "0" and (frame := compiler.geom_frame(geom))
    ]
    if parts:
        try:
            properties = Composite(tuple(parts)).mass_properties()
        except InvalidParameter as wrong:
            raise fault(element, f"must have geometries that {wrong.rule}") from wrong
        body.mass = float(properties.exact_mass)
        body.centre = vector([float(x) for x in properties.exact_center_of_mass])
        body.tensor = np.array([[float(x) for x in row] for row in properties.exact_inertia])


def _solid(geom: Element) -> Body:
    mass = geom.number("mass") if "mass" in geom.attributes else None
    density = geom.number("density", WATER) if mass is None else None
    match geom.get("type", "sphere"):
        case "sphere":
            return Ball(radius=sizes(geom, 1)[0], mass=mass, density=density)
        case "capsule":
            radius, half = sizes(geom, 2)
            return Capsule(radius=radius, length=2 * half, mass=mass, density=density)
        case "cylinder":
            radius, half = sizes(geom, 2)
            return Cylinder(radius=radius, height=2 * half, mass=mass, density=density)
        case "box":
            x, y, z = sizes(geom, 3)
            return Cuboid(edges=(2 * x, 2 * y, 2 * z), mass=mass, density=density)
        case "ellipsoid":
            a, b, c = sizes(geom, 3)
            return Ellipsoid(semi_axes=(a, b, c), mass=mass, density=density)
        case other:
            raise fault(
                geom,
                f"must be one of {', '.join(SOLIDS)} where a body has no <inertial>, not {shortened(other)}",
                remedy="give the body an <inertial>",
            )


def add_shape(body: DraftBody, geom: Element, compiler: Compiler) -> None:
    """Give a body the shape of a geometry, and its axes."""
    own = compiler.geom_frame(geom)
    body.frame = Frame(body.frame.rotation @ own.rotation, body.frame.origin)
    body.centre = own.rotation.T @ body.centre
    body.tensor = own.rotation.T @ body.tensor @ own.rotation
    shape = _shape(geom)
    apart = own.rotation.T @ own.origin - body.centre
    # The digits of doubles: a geometry is at its own centre of mass.
    if np.abs(apart).max() > 1e-15 * max(1.0, float(np.abs(own.origin).max())):
        shape["at"] = [float(x) for x in apart]
    body.shape = shape


def _shape(geom: Element) -> dict[str, Any]:
    match geom.get("type", "sphere"):
        case "sphere":
            return {"kind": "ball", "radius": sizes(geom, 1)[0]}
        case "capsule" | "cylinder" as kind:
            radius, half = sizes(geom, 2)
            return {"kind": kind, "radius": radius, "length" if kind == "capsule" else "height": 2 * half}
        case "box":
            x, y, z = sizes(geom, 3)
            return {"kind": "box", "width": 2 * x, "height": 2 * y, "depth": 2 * z}
    return {"kind": "ellipsoid", "semi_axes": list(sizes(geom, 3))}

"""What touches, written as geometries of MJCF: planes of the ground, shapes of bodies, balls for points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter, NotApplicable, Path
from core.interchange.frames import as_quaternion, unit
from core.interchange.mjcf_tree import Tree
from core.interchange.start_in_numbers import NumericScene
from core.multibody.language.connection import carrier_of

POINT = 1e-4
"""Radius of the ball that stands for a place that touches (m): MuJoCo knows no contacts of points."""


def numbers_of(values: Sequence[float] | Floats) -> str:
    """Return numbers with all their digits, a negative zero as zero.

    Raises
    ------
    NotApplicable
        Where one left the range of doubles.
    """
    if not np.isfinite(values).all():
        raise NotApplicable("numbers of the document leave the range of doubles")
    return " ".join(repr(float(x) + 0.0).removesuffix(".0") for x in values)


class Geometries:
    """Adds geometries to the elements of bodies.

    Parameters
    ----------
    numbers : NumericScene
    tree : Tree
    elements : mapping of (str or None) to Element
        Of the bodies; None is the ground.
    """

    def __init__(self, numbers: NumericScene, tree: Tree, elements: Mapping[str | None, ElementTree.Element]) -> None:
        self.numbers, self.tree, self.elements, self.count = numbers, tree, elements, 0

    def face(self, on: Mapping[str, Any], path: Path) -> tuple[str | None, Floats, Floats]:
        """Return who carries a plane, a point of it and the direction of its free side."""
        name, at = self.numbers.place(carrier_of(on), (*path, "at"))
        rotation = self.numbers.carrier(name).rotation
        if "normal" in on:
            normal = rotation @ self.numbers.vector(on["normal"], (*path, "normal"))
        else:
            x, y, _ = self.numbers.angle(on.get("slope", 0), (*path, "slope"))
            normal = rotation @ np.array([-y, x, 0.0])
        return name, at, unit(normal)

    def of(self, place: object, path: Path, normal: Floats | None) -> str:
        """Add what touches at a place: the shape of a body, its rim, or a ball for a point."""
        name, at = self.numbers.place(place, path)
        body = self.numbers.scene.bodies[name] if name is not None and place == name else None
        if body is None or (body.shape is None and body.radius is None):
            # The ball touches where the place is, at the start.
            centre = at if normal is None else at + POINT * normal
            return self.add(name, centre, np.eye(3), type="sphere", size=repr(POINT))
        assert name is not None, "a body has a name"
        own, numbers = self.numbers.bodies[name], self.numbers
        if body.shape is None or body.shape.get("kind") in ("disc", "ball"):
            if body.shape is not None and not numbers.plane and body.shape.get("kind") == "disc":
                raise InvalidParameter(path, "a disc of space")
            radius = body.radius if body.shape is None else body.shape.get("radius")
            return self.add(name, at, np.eye(3), type="sphere", size=repr(numbers.number(radius, path)))
        shape = body.shape
        centre = own.point(numbers.vector(shape["at"], path)) if "at" in shape else own.centre
        sizes = {
            key: numbers.number(shape[key], path) for key in shape if key not in ("kind", "at", "semi_axes", "corners")
        }
        # In the plane a capsule lies along the first axis; a box is as deep as it is wide, which nothing sees.
        lying = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]) if numbers.plane else np.eye(3)
        match shape["kind"]:
            case "box":
                half = [sizes["width"] / 2, sizes["height"] / 2, sizes.get("depth", sizes["width"]) / 2]
                return self.add(name, centre, own.rotation, type="box", size=numbers_of(half))
            case "capsule":
                size = numbers_of([sizes["radius"], sizes["length"] / 2])
                return self.add(name, centre, own.rotation @ lying, type="capsule", size=size)
            case "cylinder":
                size = numbers_of([sizes["radius"], sizes["height"] / 2])
                return self.add(name, centre, own.rotation, type="cylinder", size=size)
            case "ellipsoid":
                axes = numbers.vector(shape["semi_axes"], path)
                return self.add(name, centre, own.rotation, type="ellipsoid", size=numbers_of(axes))
        raise InvalidParameter(path, f"a {shape['kind']}")

    def add(self, name: str | None, at: Floats, rotation: Floats, **attributes: str) -> str:
        """Add a geometry to a body or the ground, and return its name."""
        frame, origin = np.eye(3), np.zeros(3)
        if name is not None:
            frame, origin = self.tree.bodies[name].rotation, self.numbers.bodies[name].centre
        self.count += 1
        called = f"geom-{self.count}"
        turn = numbers_of(as_quaternion(frame.T @ rotation))
        bits = {"contype": "0", "conaffinity": "0"}
        where = {"name": called, "pos": numbers_of(frame.T @ (at - origin)), "quat": turn}
        ElementTree.SubElement(self.elements[name], "geom", {**where, **attributes, **bits})
        return called

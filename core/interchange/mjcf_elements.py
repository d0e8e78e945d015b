"""Elements of MJCF with their defaults, orientations and angles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from core.arrays import Floats
from core.interchange import frames
from core.interchange.frames import Frame, at, axes_from, of_quaternion, turn_about, vector
from core.interchange.xml_reading import Element, fault, numbers_in, shortened

MAIN = "main"
"""The name of the outermost class of defaults."""


@dataclass(frozen=True)
class Compiler:
    """How the numbers of a document are meant.

    Attributes
    ----------
    angle : float
        Radians of its unit of angle.
    sequence : str
        Axes of Euler angles, in capitals those of space.
    defaults : mapping of str to (mapping of str to (mapping of str to str))
        By class and name of element.
    inertia_from_geoms : {"auto", "true", "false"}
        Whether bodies have the inertia of their geometries: those that state none, all, or none.
    """

    angle: float
    sequence: str
    defaults: Mapping[str, Mapping[str, Mapping[str, str]]]
    inertia_from_geoms: str

    @classmethod
    def of(cls, root: Element) -> Compiler:
        """Read what a document says of itself."""
        settings: dict[str, str] = {}
        for element in root.all("compiler"):
            settings |= element.attributes
            if element.get("coordinate", "local") != "local":
                raise fault(element, 'must have coordinate="local"')
        sequence = settings.get("eulerseq", "xyz")
        if len(sequence) != 3 or set(sequence.lower()) - set("xyz"):
            raise fault(root, f"must have an eulerseq of three axes, not {shortened(sequence)}")
        inertia = settings.get("inertiafromgeom", "auto")
        if inertia not in ("auto", "true", "false"):
            raise fault(root, f"must have an inertiafromgeom of auto, true or false, not {shortened(inertia)}")
        defaults: dict[str, dict[str, dict[str, str]]] = {MAIN: {}}
        for element in root.all("default"):
            _add_class(element, element.get("class", MAIN), {}, defaults)
        angle = 1.0 if settings.get("angle", "degree") == "radian" else pi / 180.0
        return cls(angle, sequence, defaults, inertia)

    def complete(self, element: Element, inherited: str) -> Element:
        """Return an element with the defaults of its class, or of the class that its body hands down."""
        name = element.get("class", inherited)
        if name not in self.defaults:
            raise fault(element, f"must name a class of <default>, unlike {shortened(name)}")
        given = self.defaults[name].get(element.name, {})
        return replace(element, attributes={**given, **element.attributes}) if given else element

    def frame(self, element: Element) -> Frame:
        """Return the frame of an element by its place and one of its forms of orientation."""
        return at(element.numbers("pos", 3, (0.0, 0.0, 0.0)), self._rotation(element))

    def _rotation(self, element: Element) -> Floats:
        if "quat" in element.attributes:
            quaternion = element.numbers("quat", 4)
            if not any(quaternion):
                raise fault(element, "must have a quaternion other than zero")
            return of_quaternion(quaternion)
        if "axisangle" in element.attributes:
            *axis, angle = element.numbers("axisangle", 4)
            return turn_about(unit(element, vector(axis)), angle * self.angle)
        if "euler" in element.attributes:
            found = np.eye(3)
            for letter, angle in zip(self.sequence, element.numbers("euler", 3), strict=True):
                turn = turn_about(np.eye(3)["xyz".index(letter.lower())], angle * self.angle)
                found = turn @ found if letter.isupper() else found @ turn
            return found
        if "xyaxes" in element.attributes:
            numbers = vector(element.numbers("xyaxes", 6))
            x = unit(element, numbers[:3])
            y = unit(element, numbers[3:] - x * float(x @ numbers[3:]))
            return np.column_stack([x, y, np.cross(x, y)])
        if "zaxis" in element.attributes:
            return axes_from(unit(element, vector(element.numbers("zaxis", 3))))
        return np.eye(3)

    def geom_frame(self, geom: Element) -> Frame:
        """Return the frame of a geometry, also by the ends of its axis."""
        if "fromto" not in geom.attributes:
            return self.frame(geom)
        ends = vector(geom.numbers("fromto", 6))
        # The axis points from the second end to the first.
        return at(list((ends[:3] + ends[3:]) / 2), axes_from(unit(geom, ends[:3] - ends[3:])))


def unit(element: Element, direction: Floats) -> Floats:
    """Return a direction with length one."""
    if not direction.any():
        raise fault(element, "must have axes other than zero")
    return frames.unit(direction)


def flag(element: Element, name: str) -> bool:
    """Return whether an attribute is "true"."""
    return element.get(name) == "true"


def limited(element: Element) -> bool:
    """Return whether a joint or tendon has limits: as it says, or where it has a range."""
    return flag(element, "limited") or (element.get("limited", "auto") == "auto" and "range" in element.attributes)


def sizes(geom: Element, count: int) -> tuple[float, ...]:
    """Return the first sizes of a geometry, of which more may be given."""
    if "fromto" in geom.attributes and count == 2:
        ends = vector(geom.numbers("fromto", 6))
        return *_first_sizes(geom, 1), float(np.linalg.norm(ends[3:] - ends[:3])) / 2
    return _first_sizes(geom, count)


def _first_sizes(geom: Element, count: int) -> tuple[float, ...]:
    found = numbers_in(geom, geom.required("size"), "size", None)[:count]
    if len(found) < count or min(found) <= 0.0:
        raise fault(geom, f"must have {count} positive sizes")
    return found


def _add_class(
    element: Element, name: str, outer: Mapping[str, Mapping[str, str]], found: dict[str, dict[str, dict[str, str]]]
) -> None:
    own = {kind: dict(attributes) for kind, attributes in outer.items()}
    for child in element.children:
        if child.name != "default":
            own[child.name] = {**own.get(child.name, {}), **child.attributes}
    found[name] = own
    for inner in element.all("default"):
        _add_class(inner, inner.required("class"), own, found)

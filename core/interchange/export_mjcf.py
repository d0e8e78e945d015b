"""A scene written as MJCF: a tree of bodies with joints, what closes loops as equalities, strings as tendons.

MuJoCo's joints hold exactly; its equalities, limits of tendons and contacts are soft, and are written as stiff as
its time step allows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from functools import singledispatchmethod
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import numpy as np

from core.errors import InvalidParameter, Path, pointer_of
from core.interchange.frames import as_quaternion, axes_from
from core.interchange.left_out import LeftOutOfScene
from core.interchange.mjcf_geometries import Geometries, numbers_of
from core.interchange.mjcf_tree import Tree, TreeBody, rates_of
from core.interchange.start_in_numbers import NumericScene
from core.multibody.formulation.unused_names import unused
from core.multibody.language.connection import Connection, Surroundings, carrier_of
from core.multibody.language.contacts import Contact, Rolling
from core.multibody.language.forces import AppliedForce, Damper, Spring, Torque, TorsionSpring
from core.multibody.language.joints import BallJoint, GuideCurve, Pin, Rod, Weld
from core.multibody.language.scene import Scene, at_start
from core.multibody.language.strings import String

STEP = 0.0005
"""Time step (s): a tenth of what MuJoCo's documents advise, as equalities are as stiff as it allows."""

MARGIN = "1e-12"
"""Gap up to which MuJoCo lets act what touches or is taut (m): what does so at the start does it to rounding."""

WORLD = "world"
"""The name of the ground in MJCF, which no body may have."""

WRITTEN = {
    *("a", "b", "place", "on", "axis", "axes", "slope", "direction", "length", "through", "name", "stiffness"),
    *("rest_length", "law", "coefficient", "measure", "force", "in_", "torque", "body", "rest_angle", "drive", "sides"),
}
"""Fields of connections that are written, or whose connection is left out as a whole."""


def export_mjcf(scene: Scene) -> tuple[str, list[LeftOutOfScene]]:
    """Return a scene as the text of an MJCF document, and what it leaves out.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    NotApplicable
        Where its numbers leave the range of doubles.
    """
    # What leaves the range of doubles is refused where it is written.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        first = at_start(scene)
        writing = _Writing(NumericScene(first))
        acting = {number for number, _ in first.numbered()}
        for name, (number, _) in zip(scene.names(), scene.numbered(), strict=True):
            if number not in acting:
                writing.leave_out(("connections", number), name, "MJCF has the connections of the start alone")
        return writing.text(), writing.left_out


class _Writing:
    """A document as it grows."""

    def __init__(self, numbers: NumericScene) -> None:
        self.numbers, self.tree = numbers, Tree(numbers)
        self.left_out: list[LeftOutOfScene] = []
        self.surroundings = Surroundings(numbers.scene.bodies, numbers.numerals, numbers.plane)
        self.root = ElementTree.Element("mujoco", model="scene")
        self._add(self.root, "compiler", angle="radian", inertiafromgeom="false")
        settings = {"timestep": repr(STEP), "integrator": "RK4", "tolerance": "1e-12", "iterations": "200"}
        self._add(self.root, "option", gravity=numbers_of(numbers.gravity), cone="elliptic", **settings)
        stiff = {"solref": f"{2 * STEP!r} 1", "solimp": "0.9999 0.9999 0.001"}
        default = self._add(self.root, "default")
        self._add(default, "equality", **stiff)
        self._add(default, "tendon", solreflimit=stiff["solref"], solimplimit=stiff["solimp"])
        self._add(default, "pair", **stiff)
        self.world = self._add(self.root, "worldbody")
        self.sections = {
            name: self._add(self.root, name) for name in ("contact", "equality", "tendon", "actuator", "keyframe")
        }
        self.elements: dict[str | None, ElementTree.Element] = {None: self.world}
        self.joints: dict[str, list[ElementTree.Element]] = {}
        self.joint_names: set[str] = set()
        self.names = {name: name for name in numbers.bodies}
        if WORLD in self.names:
            self.names[WORLD] = unused(f"{WORLD}-", self.names, first="1")
            why = f"the ground has this name in MJCF: the body is called {self.names[WORLD]}"
            self.leave_out(("bodies", WORLD), WORLD, why, changes_motion=False)
        self.sites: dict[tuple[str | None, tuple[float, ...]], str] = {}
        self.geometries = Geometries(numbers, self.tree, self.elements)
        rates: list[float] = []
        for body in self.tree.walk():
            self._body(body)
            rates += rates_of(numbers, self.tree, body)
        if any(rates):
            self._add(self.sections["keyframe"], "key", name="start", qvel=numbers_of(rates))
        for name, (i, connection) in zip(numbers.scene.names(), numbers.scene.numbered(), strict=True):
            path = ("connections", i)
            try:
                self.write(connection, name, path)
            except InvalidParameter as fault:
                self.leave_out(path, name, f"MJCF has a number where this must {fault.rule}")
            self._say_unsaid(connection, name, path)

    def text(self) -> str:
        for section in self.sections.values():
            if len(section) == 0:
                self.root.remove(section)
        ElementTree.indent(self.root)
        return ElementTree.tostring(self.root, encoding="unicode") + "\n"

    def _say_unsaid(self, one: Connection, name: str, path: Path) -> None:
        """Leave out the fields that no part of this writes, such as the friction of a joint."""
        for entry in fields(one):
            said = WRITTEN | ({"friction"} if isinstance(one, Contact) else set())
            if entry.name not in said and getattr(one, entry.name) not in (entry.default, None):
                self.leave_out((*path, entry.name.rstrip("_")), name, f"MJCF is not told its {entry.name.rstrip('_')}")

    @staticmethod
    def _add(parent: ElementTree.Element, tag: str, **attributes: str) -> ElementTree.Element:
        return ElementTree.SubElement(parent, tag, {name.rstrip("_"): value for name, value in attributes.items()})

    def leave_out(self, path: Path, what: str, why: str, *, changes_motion: bool = True) -> None:
        self.left_out.append(LeftOutOfScene(pointer_of(path), what, why, changes_motion))

    def _body(self, body: TreeBody) -> None:
        own = self.numbers.bodies[body.name]
        parent, rotation = self.numbers.carrier(body.parent).centre, np.eye(3)
        if body.parent is not None:
            rotation = self.tree.bodies[body.parent].rotation
        place, turn = rotation.T @ (own.centre - parent), rotation.T @ body.rotation
        attributes = {"name": self.names[body.name], "pos": numbers_of(place)}
        if not np.array_equal(turn, np.eye(3)):
            attributes["quat"] = numbers_of(as_quaternion(turn))
        element = self._add(self.elements[body.parent], "body", **attributes)
        self.elements[body.name] = element
        self._inertial(body, element)
        self.joints[body.name] = []
        for k, joint in enumerate(body.joints):
            called = body.name if len(body.joints) == 1 else f"{body.name}-{k + 1}"
            called = unused(called, self.joint_names)
            self.joint_names.add(called)
            if joint.kind == "free":
                self.joints[body.name].append(self._add(element, "freejoint", name=called))
                continue
            at = {"pos": numbers_of(body.rotation.T @ (joint.at - own.centre))}
            if joint.kind != "ball":
                at["axis"] = numbers_of(body.rotation.T @ joint.axis)
            self.joints[body.name].append(self._add(element, "joint", name=called, type=joint.kind, **at))

    def _inertial(self, body: TreeBody, element: ElementTree.Element) -> None:
        own = self.numbers.bodies[body.name]
        inertial = {"pos": "0 0 0", "mass": repr(own.mass)}
        tensor = np.zeros((3, 3)) if own.tensor is None else own.tensor
        slides = bool(body.joints) and all(joint.kind == "slide" for joint in body.joints)
        if own.tensor is None and slides:
            # What slides and does not turn has no use for its moments; MuJoCo wants some of all that has joints.
            tensor = own.mass * np.eye(3)
        if (tensor - np.diag(np.diag(tensor))).any():
            inertial["fullinertia"] = numbers_of([*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]])
        else:
            inertial["diaginertia"] = numbers_of(np.diag(tensor))
        self._add(element, "inertial", **inertial)
        if own.mass == 0.0 or (own.tensor is not None and not np.diag(tensor).all()):
            why = "MuJoCo moves nothing without mass and moments: it refuses the model, or needs some"
            self.leave_out(("bodies", body.name), body.name, why)

    def site(self, place: object, path: Path) -> str:
        """Return the name of a site at a place, which is made where there is none."""
        name, at = self.numbers.place(place, path)
        inside = at if name is None else self.tree.bodies[name].rotation.T @ (at - self.numbers.bodies[name].centre)
        key = name, tuple(float(x) for x in inside)
        if key not in self.sites:
            self.sites[key] = f"site-{len(self.sites) + 1}"
            self._add(self.elements[name], "site", name=self.sites[key], pos=numbers_of(inside))
        return self.sites[key]

    def tendon(self, name: str, places: Sequence[object], path: Path, **attributes: str) -> None:
        tendon = self._add(self.sections["tendon"], "spatial", name=name, **attributes)
        for place in places:
            self._add(tendon, "site", site=self.site(place, path))

    def hinge_between(self, a: str, b: str) -> tuple[ElementTree.Element, float] | None:
        """Return the hinge that is the turn of `a` relative to `b`, and its sign; None where no joint is that."""
        for child, parent, sign in ((a, b, 1.0), (b, a, -1.0)):
            body = self.tree.bodies.get(child)
            if body is None or (body.parent or "ground") != parent:
                continue
            hinges = [one for one in self.joints[child] if one.get("type") == "hinge"]
            if len(hinges) == 1 and all(joint.kind != "ball" for joint in body.joints):
                return hinges[0], sign
        return None

    @singledispatchmethod
    def write(self, one: Connection, name: str, path: Path) -> None:
        """Write a connection that is no joint of the tree."""
        if path[1] not in self.tree.joined:
            self.leave_out(path, name, f"MJCF has nothing for {one.kind} here")
        elif getattr(one, "drive", None) is not None:
            self.leave_out(path, name, "a joint that moves by time needs an actuator and a controller")

    @write.register
    def _(self, one: Pin, name: str, path: Path) -> None:
        if path[1] not in self.tree.joined:
            self.connect(one.a, one.b, name, path)
            if one.axis is not None:
                self.leave_out(path, name, "in a loop MuJoCo holds the place alone, not the axis")

    @write.register
    def _(self, one: BallJoint, name: str, path: Path) -> None:
        if path[1] not in self.tree.joined:
            self.connect(one.a, one.b, name, path)

    def connect(self, a: object, b: object, name: str, path: Path) -> None:
        (first, at), (second, _) = self.numbers.place(a, path), self.numbers.place(b, path)
        if first is None:
            first, second = second, first
        assert first is not None, "a connection of the ground with itself is refused"
        inside = self.tree.bodies[first].rotation.T @ (at - self.numbers.bodies[first].centre)
        bodies = {"body1": self.names[first]} | ({} if second is None else {"body2": self.names[second]})
        self._add(self.sections["equality"], "connect", name=name, anchor=numbers_of(inside), **bodies)

    @write.register
    def _(self, one: Weld, name: str, path: Path) -> None:
        if path[1] not in self.tree.joined:
            two = [self.numbers.place(end, path)[0] for end in (one.a, one.b)]
            held = sorted(two, key=lambda x: x is None)
            bodies = {f"body{k + 1}": self.names[body] for k, body in enumerate(held) if body}
            self._add(self.sections["equality"], "weld", name=name, **bodies)

    @write.register
    def _(self, one: Rod, name: str, path: Path) -> None:
        if one.drive is not None:
            self.leave_out(path, name, "a length that changes by time needs an actuator and a controller")
        self.tendon(name, (one.a, one.b), path)
        self._add(self.sections["equality"], "tendon", name=name, tendon1=name)

    @write.register
    def _(self, one: GuideCurve, name: str, path: Path) -> None:
        if path[1] in self.tree.joined:
            return
        if set(one.on) != {"at", "radius"}:
            self.leave_out(path, name, "MJCF has no such curve or surface for a place in a loop")
            return
        # A circle of the plane or a sphere: its radius is a rod to its centre.
        self.tendon(name, (one.place, carrier_of(one.on)), path)
        self._add(self.sections["equality"], "tendon", name=name, tendon1=name)

    @write.register
    def _(self, one: String, name: str, path: Path) -> None:
        if one.drive is not None:
            self.leave_out(path, name, "a length that changes by time needs an actuator and a controller")
        drums = [place for place in one.through if isinstance(place, dict) or self.surroundings.rim(place)]
        if drums or len(one.through) < 2:
            self.leave_out(path, name, "MuJoCo has no strings that wind on drums or rub on pegs")
            return
        points = [self.numbers.place(place, path)[1] for place in one.through]
        length = sum(float(np.linalg.norm(q - p)) for p, q in pairwise(points))
        given = one.length
        length = length if given is None else self.numbers.number(given, (*path, "length"))
        self.tendon(name, one.through, path, limited="true", range=f"0 {length!r}", margin=MARGIN)

    @write.register
    def _(self, one: Spring, name: str, path: Path) -> None:
        if one.law is not None or one.stiffness is None:
            self.leave_out(path, name, "MuJoCo's springs are linear")
            return
        points = [self.numbers.place(end, path)[1] for end in (one.a, one.b)]
        length = float(np.linalg.norm(points[1] - points[0]))
        if one.rest_length is not None:
            length = self.numbers.number(one.rest_length, (*path, "rest_length"))
        stiffness = self.numbers.number(one.stiffness, (*path, "stiffness"))
        self.tendon(name, (one.a, one.b), path, stiffness=repr(stiffness), springlength=repr(length))

    @write.register
    def _(self, one: Damper, name: str, path: Path) -> None:
        if one.law is not None or one.coefficient is None:
            self.leave_out(path, name, "MuJoCo's dampers are linear")
            return
        damping = self.numbers.number(one.coefficient, (*path, "coefficient"))
        if one.measure == "length":
            self.tendon(name, (one.a, one.b), path, damping=repr(damping))
            return
        hinge = self.hinge_between(str(one.a), str(one.b))
        if hinge is None:
            self.leave_out(path, name, "no joint of the tree is this turn")
        else:
            hinge[0].set("damping", repr(damping))

    @write.register
    def _(self, one: TorsionSpring, name: str, path: Path) -> None:
        hinge = self.hinge_between(one.a, one.b)
        if hinge is None:
            self.leave_out(path, name, "no joint of the tree is this turn")
            return
        scene, turn = self.numbers.scene, 0.0
        for body, sign in ((one.a, -1.0), (one.b, 1.0)):
            angle = None if body == "ground" else scene.bodies[body].angle
            turn += 0.0 if angle is None else sign * self.numbers.number(angle, ("bodies", body, "angle"))
        rest = 0.0 if one.rest_angle is None else self.numbers.number(one.rest_angle, (*path, "rest_angle")) + turn
        hinge[0].set("stiffness", repr(self.numbers.number(one.stiffness, (*path, "stiffness"))))
        hinge[0].set("springref", repr(hinge[1] * rest))

    @write.register
    def _(self, one: AppliedForce, name: str, path: Path) -> None:
        force = self.numbers.vector(one.force, (*path, "force"))
        self.actuator(name, one.place, [*force, 0.0, 0.0, 0.0], path, fixed=one.in_ is None)

    @write.register
    def _(self, one: Torque, name: str, path: Path) -> None:
        if self.numbers.plane:
            torque = np.array([0.0, 0.0, self.numbers.number(one.torque, (*path, "torque"))])
        elif one.in_ is None:
            self.leave_out(path, name, "MuJoCo's torques turn with the body")
            return
        else:
            torque = self.numbers.vector(one.torque, (*path, "torque"))
        self.actuator(name, one.body, [0.0, 0.0, 0.0, *torque], path, fixed=False)

    def actuator(self, name: str, place: object, gear: Sequence[float], path: Path, *, fixed: bool) -> None:
        """Add what acts at a site with constant components, along the axes of space if these are fixed."""
        attributes = {"gear": numbers_of(gear), "gaintype": "fixed", "gainprm": "0", "biastype": "affine"}
        if fixed:
            attributes["refsite"] = self.site([0] * self.numbers.dimension, path)
        self._add(
            self.sections["actuator"], "general", name=name, site=self.site(place, path), biasprm="1 0 0", **attributes
        )

    @write.register
    def _(self, one: Rolling, name: str, path: Path) -> None:
        if path[1] not in self.tree.joined or one.place is None:
            self.leave_out(path, name, "MuJoCo rolls by friction of soft contacts, which slip a little")
            return
        # Looking along the slope the body is on the left: where it moves forward it turns clockwise.
        radius = self.numbers.number(self.numbers.scene.bodies[one.place].rim, path)
        slide, hinge = (str(joint.get("name")) for joint in self.joints[one.place])
        coefficients = f"0 {-radius!r} 0 0 0"
        joints = {"joint1": slide, "joint2": hinge}
        self._add(self.sections["equality"], "joint", name=name, polycoef=coefficients, **joints)

    @write.register
    def _(self, one: Contact, name: str, path: Path) -> None:
        faces = {"at", "slope"}, {"at", "normal"}, {"at"}
        if one.measure != "gap" or (one.place is not None and set(one.surface) not in faces):
            self.leave_out(path, name, "contacts are of places and shapes with planes and with one another")
            return
        places = (one.place,) if one.place is not None else (one.a, one.b)
        normal = None
        if one.place is not None:
            carrier, at, normal = self.geometries.face(one.surface, (*path, "on"))
            if carrier is not None:
                self.leave_out(path, name, "MuJoCo has planes on the ground alone")
                return
        geoms = [self.geometries.of(place, path, normal) for place in places]
        if normal is not None:
            geoms.append(self.geometries.add(None, at, axes_from(normal), type="plane", size="0 0 1"))
        rubs: Any = one.friction
        sliding = rubs[-1] if isinstance(rubs, (list, tuple)) else rubs
        if isinstance(rubs, (list, tuple)) and rubs[0] != sliding:
            self.leave_out((*path, "friction", 0), name, "MuJoCo has one coefficient, of sticking and of sliding")
        friction = 0.0 if sliding is None else self.numbers.number(sliding, (*path, "friction"))
        pair = {"condim": "3" if friction else "1", "friction": numbers_of([friction, friction, 0.0, 0.0, 0.0])}
        pair["margin"] = MARGIN
        self._add(self.sections["contact"], "pair", name=name, geom1=geoms[0], geom2=geoms[1], **pair)
        self.leave_out(path, name, "MuJoCo's contacts are soft, and have no restitution of their own")

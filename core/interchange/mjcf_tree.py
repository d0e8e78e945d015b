"""The tree of bodies and joints of MJCF for a scene: which connections are joints, and which close loops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.interchange.frames import unit
from core.interchange.start_in_numbers import NumericBody, NumericScene
from core.multibody.language.connection import Connection, carrier_of
from core.multibody.language.contacts import Rolling
from core.multibody.language.joints import BallJoint, Cylindrical, GuideCurve, Pin, Slider, Universal, Weld

NORMAL = np.array([0.0, 0.0, 1.0])
"""The axis about which what lies in the plane turns."""


@dataclass(frozen=True)
class TreeJoint:
    """A joint of MJCF.

    Attributes
    ----------
    kind : {"hinge", "slide", "ball", "free"}
    at, axis : ndarray, shape (3,)
        In space at the start (m).
    """

    kind: Literal["hinge", "slide", "ball", "free"]
    at: Floats
    axis: Floats


@dataclass
class TreeBody:
    """A body of the tree.

    Attributes
    ----------
    name : str
    parent : str or None
    joints : sequence of TreeJoint
    connection : int or None
        Number of the connection that the joints are.
    rotation : ndarray, shape (3, 3)
        Of its frame at the start, whose origin is the centre of mass.
    turning : ndarray, shape (3,)
        Angular velocity of the frame in space (rad/s).
    """

    name: str
    parent: str | None
    joints: Sequence[TreeJoint]
    connection: int | None
    rotation: Floats
    turning: Floats
    children: list[TreeBody] = field(default_factory=list)


@dataclass(frozen=True)
class _Edge:
    number: int
    connection: Connection
    a: str | None
    b: str | None


class Tree:
    """Bodies in the order in which MJCF nests them.

    Attributes
    ----------
    roots : list of TreeBody
    bodies : dict of str to TreeBody
    """

    def __init__(self, numbers: NumericScene) -> None:
        self.numbers = numbers
        self.roots: list[TreeBody] = []
        self.bodies: dict[str, TreeBody] = {}
        edges = list(self._edges())
        self._grow(edges)
        for name in numbers.bodies:
            if name not in self.bodies:
                self._add(name, None, self._free(numbers.bodies[name]), None)
                self._grow(edges)

    def walk(self) -> Iterator[TreeBody]:
        """Return the bodies in the order of the coordinates of MuJoCo."""
        waiting = list(reversed(self.roots))
        while waiting:
            body = waiting.pop()
            yield body
            waiting += reversed(body.children)

    @property
    def joined(self) -> set[int]:
        """Numbers of the connections that are joints."""
        return {body.connection for body in self.bodies.values() if body.connection is not None}

    def _edges(self) -> Iterator[_Edge]:
        """Return the connections that may be joints, last those that may close a loop as well."""
        later = []
        for i, one in self.numbers.scene.numbered():
            if isinstance(one, (Pin, BallJoint, Weld, Slider, Cylindrical, Universal)):
                ends = (self.numbers.place(end, ("connections", i))[0] for end in (one.a, one.b))
                edge = _Edge(i, one, *ends)
                if isinstance(one, (Slider, Cylindrical, Universal)):
                    yield edge
                else:
                    later.append(edge)
            elif isinstance(one, GuideCurve) and set(one.on) <= {"at", "slope", "direction", "normal"}:
                name, _ = self.numbers.place(one.place, ("connections", i, "place"))
                yield _Edge(i, one, name, self.numbers.place(carrier_of(one.on), ("connections", i, "on"))[0])
            elif isinstance(one, Rolling) and self._on_straight_ground(one):
                yield _Edge(i, one, one.place, None)
        yield from later

    def _on_straight_ground(self, one: Rolling) -> bool:
        return (
            self.numbers.plane
            and one.place is not None
            and set(one.surface) <= {"at", "slope"}
            and not isinstance(carrier_of(one.surface), str)
        )

    def _grow(self, edges: Sequence[_Edge]) -> None:
        """Add what joints carry, until they carry nothing more."""
        grown = True
        while grown:
            grown = False
            for edge in edges:
                for child, parent in ((edge.a, edge.b), (edge.b, edge.a)):
                    guided = isinstance(edge.connection, (GuideCurve, Rolling))
                    if child is None or child in self.bodies or (guided and child != edge.a):
                        continue
                    if parent is None or parent in self.bodies:
                        self._add(child, parent, self._joints(edge, child), edge.number)
                        grown = True
                        break

    def _add(self, name: str, parent: str | None, joints: Sequence[TreeJoint], number: int | None) -> None:
        own, carrier = self.numbers.bodies[name], None if parent is None else self.bodies[parent]
        rotation, turning = own.rotation, own.turning
        if own.tensor is None:
            # A particle has no direction: its frame turns with what carries it.
            rotation = np.eye(3) if carrier is None else carrier.rotation
            turning = np.zeros(3) if carrier is None else carrier.turning
        body = TreeBody(name, parent, joints, number, rotation, turning)
        self.bodies[name] = body
        (self.roots if carrier is None else carrier.children).append(body)

    def _free(self, body: NumericBody) -> list[TreeJoint]:
        if not self.numbers.plane and body.tensor is not None:
            return [TreeJoint("free", body.centre, NORMAL)]
        slides = [TreeJoint("slide", body.centre, axis) for axis in np.eye(3)[: self.numbers.dimension]]
        return slides + ([TreeJoint("hinge", body.centre, NORMAL)] if body.tensor is not None else [])

    def _joints(self, edge: _Edge, child: str) -> list[TreeJoint]:
        """Return the joints that a connection is for the body that it carries."""
        numbers, one, path = self.numbers, edge.connection, ("connections", edge.number)
        rigid = numbers.bodies[child].tensor is not None
        if isinstance(one, Rolling):
            along = numbers.angle(one.surface.get("slope", 0), path)
            centre = numbers.bodies[child].centre
            return [TreeJoint("slide", centre, along), TreeJoint("hinge", centre, NORMAL)]
        if isinstance(one, GuideCurve):
            _, at = numbers.place(one.place, path)
            turns = [TreeJoint("hinge" if numbers.plane else "ball", at, NORMAL)] if rigid else []
            return [*(TreeJoint("slide", at, axis) for axis in self._ways(one, edge)), *turns]
        assert isinstance(one, (Pin, BallJoint, Weld, Slider, Cylindrical, Universal)), "edges are of these"
        _, at = numbers.place(one.a if edge.a == child else one.b, path)
        if isinstance(one, Slider):
            return [TreeJoint("slide", at, self._along(one, edge))]
        if isinstance(one, Weld) or not rigid:
            return []
        if isinstance(one, Cylindrical):
            axis = unit(numbers.vector(one.axis, (*path, "axis")))
            return [TreeJoint("slide", at, axis), TreeJoint("hinge", at, axis)]
        if isinstance(one, Universal):
            axes = [unit(numbers.vector(axis, (*path, "axes"))) for axis in one.axes]
            # MuJoCo's first joint is fixed in the parent.
            return [TreeJoint("hinge", at, axis) for axis in (axes[::-1] if edge.a == child else axes)]
        if numbers.plane:
            return [TreeJoint("hinge", at, NORMAL)]
        if isinstance(one, Pin) and one.axis is not None:
            return [TreeJoint("hinge", at, unit(numbers.vector(one.axis, (*path, "axis"))))]
        return [TreeJoint("ball", at, NORMAL)]

    def _ways(self, one: GuideCurve, edge: _Edge) -> list[Floats]:
        """Return the directions in which a place may move on a line or plane, in space."""
        path, on = ("connections", edge.number, "on"), one.on
        rotation = self.numbers.carrier(edge.b).rotation
        if "normal" in on:
            normal = rotation @ unit(self.numbers.vector(on["normal"], (*path, "normal")))
            least = np.eye(3)[int(np.argmin(np.abs(normal)))]
            first = unit(np.cross(normal, least))
            return [first, np.cross(normal, first)]
        if "direction" in on:
            return [rotation @ unit(self.numbers.vector(on["direction"], (*path, "direction")))]
        return [rotation @ self.numbers.angle(on.get("slope", 0), (*path, "slope"))]

    def _along(self, one: Slider, edge: _Edge) -> Floats:
        path = ("connections", edge.number)
        if one.direction is not None:
            inside = unit(self.numbers.vector(one.direction, (*path, "direction")))
        else:
            inside = self.numbers.angle(0 if one.slope is None else one.slope, (*path, "slope"))
        return self.numbers.carrier(edge.b).rotation @ inside


def rates_of(numbers: NumericScene, tree: Tree, body: TreeBody) -> list[float]:
    """Return the rates of the joints of a body as MuJoCo has them in `qvel`."""
    own = numbers.bodies[body.name]
    parent = numbers.carrier(body.parent)
    carried = np.zeros(3) if body.parent is None else tree.bodies[body.parent].turning
    found: list[float] = []
    for joint in body.joints:
        relative = body.turning - carried
        if joint.kind == "free":
            found += [*own.velocity, *(body.rotation.T @ own.turning)]
        elif joint.kind == "ball":
            found += list(body.rotation.T @ relative)
        elif joint.kind == "hinge":
            found.append(float(joint.axis @ relative))
        else:
            mine = own.velocity + np.cross(body.turning, joint.at - own.centre)
            theirs = parent.velocity + np.cross(carried, joint.at - parent.centre)
            found.append(float(joint.axis @ (mine - theirs)))
    return [float(x) for x in found]

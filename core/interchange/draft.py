"""What was read of a file, before it is written as a scene: bodies at their places, joints between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from core.arrays import Floats
from core.interchange.frames import Frame
from core.interchange.left_out import LeftOutOfFile
from core.interchange.xml_reading import Element, no_model, shortened

JointKind = Literal[
    "weld",
    "hinge",
    "slide",
    "ball",
    "universal",
    "cylindrical",
    "on-line",
    "on-plane",
    "particle",
    "planar",
    "planar-particle",
    "hinge-on-line",
]
"""How a body may move relative to its parent, from which it is free without a joint: a hinge turns about its axis, a
slide moves along it; `on-line` and `on-plane` are a point of the body on a line or plane, about which it turns freely;
a particle moves and does not turn. `planar` are two slides and a turn in their plane, `planar-particle` two slides
alone; `hinge-on-line` is a point of the body on a line, about which it turns across that."""

MOST_BODIES = 400
"""Bodies of a document with those that are fixed to others: four for each that a scene may have."""

OF_THE_PLANE = ("planar", "hinge-on-line")
"""Joints that only a scene of the plane has."""


@dataclass
class DraftBody:
    """A body.

    Attributes
    ----------
    name : str
    frame : Frame
        Of the body in space; all else of it is given in this frame.
    mass : float
        In kg.
    centre : ndarray, shape (3,)
        Centre of mass (m).
    tensor : ndarray, shape (3, 3)
        Of inertia about the centre of mass (kg m^2).
    line : int
    velocity, angular_velocity : ndarray, shape (3,)
        Of the origin of the frame and of the body, along the axes of space (m/s, rad/s).
    shape : dict or None
        As in a scene.
    """

    name: str
    frame: Frame
    mass: float
    centre: Floats
    tensor: Floats
    line: int
    velocity: Floats = field(default_factory=lambda: np.zeros(3))
    angular_velocity: Floats = field(default_factory=lambda: np.zeros(3))
    shape: dict[str, Any] | None = None

    @property
    def massive(self) -> bool:
        """Whether it has mass or inertia."""
        return self.mass != 0.0 or bool(self.tensor.any())


@dataclass
class DraftJoint:
    """A joint of a body with its parent.

    Attributes
    ----------
    name : str
    kind : str
    parent : str or None
        None is the ground.
    child : str
    at : ndarray, shape (3,)
        In space at the start (m).
    axes : sequence of ndarray, shape (3,)
        Along the axes of space at the start: of a hinge, slide or cylindrical joint one, of a universal joint that of
        the parent and that of the child, of a line its direction, of a plane its normal, of a hinge on a line the
        direction and the axis.
    line : int
    damping, stiffness : float
        Of a hinge N m s/rad and N m/rad, of a slide N s/m and N/m.
    rest : float
        Turn or way from the start at which the stiffness has no force (rad, m).
    """

    name: str
    kind: JointKind
    parent: str | None
    child: str
    at: Floats
    axes: Sequence[Floats]
    line: int
    damping: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0


Ended = tuple[str | None, Floats]
"""A place: the body, or None for the ground, and the point in space at the start."""


@dataclass
class DraftConnection:
    """Another connection between places.

    Attributes
    ----------
    name : str
    places : mapping of str to place, or list of places
        By the field of the connection.
    fields : dict
        Those that are no places, and the kind.
    line : int
    """

    name: str
    places: dict[str, Ended | list[Ended]]
    fields: dict[str, Any]
    line: int


@dataclass(frozen=True)
class DraftContact:
    """A fixed plane that a body with a shape may touch.

    Attributes
    ----------
    body : str
    at, normal : ndarray, shape (3,)
        A point of the plane, and its free side (m).
    friction : float
        Coefficient of sliding.
    line : int
    """

    body: str
    at: Floats
    normal: Floats
    friction: float
    line: int


@dataclass
class Draft:
    """A model that was read.

    Attributes
    ----------
    gravity : ndarray, shape (3,)
    bodies : dict of str to DraftBody
    joints : list of DraftJoint
    connections : list of DraftConnection
    contacts : list of DraftContact
    left_out : list of LeftOutOfFile
    moves : bool
        Whether velocities are given.
    above : dict of str to DraftJoint
        The joint of each body with its parent, as `join` enters it.
    """

    gravity: Floats
    bodies: dict[str, DraftBody] = field(default_factory=dict)
    joints: list[DraftJoint] = field(default_factory=list)
    connections: list[DraftConnection] = field(default_factory=list)
    contacts: list[DraftContact] = field(default_factory=list)
    left_out: list[LeftOutOfFile] = field(default_factory=list)
    moves: bool = False
    above: dict[str, DraftJoint] = field(default_factory=dict)

    def add(self, body: DraftBody) -> None:
        """Enter a body.

        Raises
        ------
        InvalidParameter
            For one more than is read, with its line.
        """
        if len(self.bodies) >= MOST_BODIES:
            raise no_model(body.line, f"it has more than {MOST_BODIES} links or bodies")
        self.bodies[body.name] = body

    def join(self, joint: DraftJoint) -> None:
        """Enter the joint of a body that has none yet.

        Raises
        ------
        InvalidParameter
            Where the parent is carried by the child, with the line.
        """
        self.joints.append(joint)
        self.above[joint.child] = joint
        parent = joint.parent
        while parent is not None:
            if parent == joint.child:
                raise no_model(joint.line, f"joints {shortened(joint.name)} and those above it carry one another")
            parent = self.above[parent].parent if parent in self.above else None

    def carrier(self, name: str | None) -> str | None:
        """Return the body of which another is a part: massless, or welded to the ground; None is the ground."""
        welded: list[str] = []
        while name is not None and name in self.above and self.above[name].kind == "weld":
            welded.append(name)
            name = self.above[name].parent
        # What is welded to the ground does not move, whatever its mass.
        return None if name is None else next((one for one in welded if self.bodies[one].massive), name)

    def leave_out(self, element: Element, why: str, *, changes_motion: bool = True) -> None:
        """Say that an element is not taken."""
        name = element.get("name")
        what = f"{element.name} {name}" if name else element.name
        self.left_out.append(LeftOutOfFile(element.line, what[:100], why, changes_motion))

"""SDF read: the links of one model or of the models of a world, joints with their axes and springs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.interchange.draft import Draft, DraftBody, DraftJoint, JointKind
from core.interchange.frames import Frame, at, roll_pitch_yaw, unit, vector
from core.interchange.inertia import MOMENTS, inertia_tensor
from core.interchange.xml_reading import Element, by_name, fault, numbers_in, shortened

GRAVITY = (0.0, 0.0, -9.8)
"""Gravity of a world that states none (m/s^2), as SDF has it."""

KINDS: Mapping[str, JointKind] = {
    **{"revolute": "hinge", "continuous": "hinge", "prismatic": "slide"},
    **{"ball": "ball", "fixed": "weld", "universal": "universal"},
}
"""Types of joints that are taken, and what they are here."""

WITHOUT_MOTION = (
    "visual",
    "sensor",
    "light",
    "gui",
    "scene",
    "physics",
    "audio",
    "static",
    "pose",
    "atmosphere",
    "name",
)
"""Elements that say nothing of the motion, or are read elsewhere."""


def read_sdf(root: Element) -> Draft:
    """Return the model of an SDF document; what is not held by a joint is free, and a static model is the ground."""
    world = root.first("world")
    gravity = None if world is None else world.first("gravity")
    draft = Draft(vector(GRAVITY if gravity is None else numbers_in(gravity, gravity.text, "gravity", 3)))
    carrier = root if world is None else world
    models = list(carrier.all("model"))
    if not models:
        raise fault(carrier, "must have a <model>")
    for child in carrier.children:
        if child.name not in ("model", "gravity", *WITHOUT_MOTION):
            draft.leave_out(child, "only models and gravity are read of a world")
    for name, model in by_name(models).items() if len(models) > 1 else [("", models[0])]:
        # SDF has :: between the names of a model and of what is in it, and in no name.
        _Model(model, draft, f"{name}::" if name else "")
    return draft


class _Model:
    """A model and its frames."""

    def __init__(self, model: Element, draft: Draft, prefix: str) -> None:
        self.draft, self.prefix = draft, prefix
        self.frames = {"__model__": self.pose(model, at((0.0, 0.0, 0.0)))}
        static = _said(model, "static") == "true"
        for name, link in by_name(model.all("link")).items():
            if name in ("world", "__model__"):
                raise fault(link, "must have a name that SDF does not keep for itself")
            frame = self.pose(link, self.frames["__model__"])
            self.frames[name] = frame
            if not static:
                body = self.body(link, frame)
                if body.name in draft.bodies:
                    raise fault(link, f"must have a name of its own in the world, unlike {shortened(body.name)}")
                draft.add(body)
        # The joints of what is the ground hold nothing that moves.
        for joint in () if static else by_name(model.all("joint")).values():
            self.joint(joint)
        if model.get("placement_frame"):
            draft.leave_out(model, "its pose is taken as that of the model, not of its placement_frame")
        for child in model.children:
            if child.name not in ("link", "joint", *WITHOUT_MOTION):
                draft.leave_out(child, "only links and joints are read of a model")

    def pose(self, element: Element, default: Frame) -> Frame:
        """Return the frame that a <pose> gives, relative to another that is read already."""
        pose = element.first("pose")
        if pose is None or not pose.text:
            return default
        numbers = list(numbers_in(pose, pose.text, "pose", 6))
        if pose.get("rotation_format", "euler_rpy") != "euler_rpy":
            raise fault(pose, 'must have rotation_format="euler_rpy"')
        if pose.get("degrees") == "true":
            numbers[3:] = np.radians(numbers[3:])
        relative = pose.get("relative_to")
        if relative and relative not in self.frames:
            raise fault(pose, f"must be relative to the model or a link before it, unlike {shortened(relative)}")
        outer = self.frames[relative] if relative else default
        return outer @ at(numbers[:3], roll_pitch_yaw(numbers[3:]))

    def body(self, link: Element, frame: Frame) -> DraftBody:
        mass, centre, tensor = 0.0, np.zeros(3), np.zeros((3, 3))
        inertial = link.first("inertial")
        if inertial is not None:
            own = self.pose(inertial, at((0.0, 0.0, 0.0)))
            mass, centre = _number(inertial, "mass", 1.0), own.origin
            inertia = inertial.first("inertia")
            tensor = np.eye(3)
            if inertia is not None:
                tensor = inertia_tensor(lambda name: _number(inertia, name, float(name in MOMENTS)))
            tensor = own.rotation @ tensor @ own.rotation.T
        for child in link.children:
            if child.name == "collision":
                self.draft.leave_out(child, "what touches is described by contacts of a scene")
            elif child.name not in ("inertial", *WITHOUT_MOTION):
                self.draft.leave_out(child, "of a link, its pose and inertia are read")
        return DraftBody(self.prefix + link.required("name"), frame, mass, centre, tensor, link.line)

    def end(self, joint: Element, which: str) -> str | None:
        """Return the link at an end of a joint, None for the world."""
        name = _said(joint, which)
        if name == "world":
            return None
        if name not in self.frames:
            raise fault(joint, f"must have a link of the model as its {which}, unlike {shortened(name)}")
        return name

    def joint(self, joint: Element) -> None:
        parent, child = self.end(joint, "parent"), self.end(joint, "child")
        kind, type_name = KINDS.get(joint.required("type")), joint.get("type")
        if kind is None:
            raise fault(joint, f"must be one of {', '.join(KINDS)}, not {shortened(type_name)}")
        if child is None or self.prefix + child not in self.draft.bodies:
            raise fault(joint, "must not move the ground")
        if self.prefix + child in self.draft.above:
            raise fault(joint, f"must be the only joint of which {shortened(child)} is the child")
        frame = self.pose(joint, self.frames[child])
        axes, first = [], joint.first("axis")
        for name in ("axis", "axis2")[: {"hinge": 1, "slide": 1, "universal": 2}.get(kind, 0)]:
            axis = joint.first(name)
            xyz = None if axis is None else axis.first("xyz")
            direction = vector((0.0, 0.0, 1.0) if xyz is None else numbers_in(xyz, xyz.text, "xyz", 3))
            if not direction.any():
                raise fault(joint, "must have axes other than zero")
            seen_in = "" if xyz is None else xyz.get("expressed_in")
            if seen_in and seen_in not in self.frames:
                raise fault(joint, f"must have axes in the model or a link, unlike {shortened(seen_in)}")
            outer = self.frames[seen_in] if seen_in else frame
            axes.append(outer.direction(unit(direction)))
        dynamics = None if first is None else first.first("dynamics")
        carrier = None if parent is None else self.prefix + parent
        made = DraftJoint(
            self.prefix + joint.required("name"),
            kind,
            carrier if carrier in self.draft.bodies else None,
            self.prefix + child,
            frame.origin,
            axes,
            joint.line,
        )
        self.draft.join(made)
        if dynamics is not None and kind in ("hinge", "slide"):
            made.damping, made.stiffness = _number(dynamics, "damping", 0.0), _number(dynamics, "spring_stiffness", 0.0)
            made.rest = _number(dynamics, "spring_reference", 0.0)
        if dynamics is not None and (_number(dynamics, "friction", 0.0) or kind not in ("hinge", "slide")):
            self.draft.leave_out(dynamics, "the friction of a joint, and the damping of a ball, are not described")
        limit = None if first is None else first.first("limit")
        if limit is not None and {child.name for child in limit.children} & {"lower", "upper"}:
            self.draft.leave_out(limit, "the joint may go beyond it")


def _said(element: Element, name: str) -> str:
    child = element.first(name)
    return "" if child is None else child.text


def _number(element: Element, name: str, default: float) -> float:
    child = element.first(name)
    return default if child is None else numbers_in(child, child.text, name, 1)[0]

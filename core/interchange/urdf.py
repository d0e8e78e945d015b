"""URDF read: links with their inertia, joints with their axes and damping."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.interchange.draft import Draft, DraftBody, DraftJoint, JointKind
from core.interchange.frames import Frame, at, roll_pitch_yaw, unit, vector
from core.interchange.inertia import MOMENTS, inertia_tensor
from core.interchange.xml_reading import Element, by_name, fault, shortened

GRAVITY = (0.0, 0.0, -9.81)
"""URDF has no gravity; its z axis points up."""

KINDS: Mapping[str, JointKind] = {"revolute": "hinge", "continuous": "hinge", "prismatic": "slide", "fixed": "weld"}
"""Types of joints that are taken, and what they are here; `floating` is none."""

WORLD = "world"
"""The name of the link that is the ground, by convention."""

IGNORED = ("visual", "material", "transmission", "gazebo")
"""Elements that say nothing of the motion."""


def read_urdf(root: Element) -> Draft:
    """Return the model of a URDF document.

    A link "world" is the ground, and so is a first link without mass; another first link is free.
    """
    draft = Draft(vector(GRAVITY))
    links = by_name(root.all("link"))
    parents: dict[str, Element] = {}
    for joint in by_name(root.all("joint")).values():
        child = _end(joint, "child", links)
        if child in parents:
            raise fault(joint, f"must be the only joint of which {shortened(child)} is the child")
        parents[child] = joint
    for other in root.children:
        if other.name not in ("link", "joint"):
            draft.leave_out(other, "it is no link or joint", changes_motion=other.name not in IGNORED)
    frames: dict[str, Frame] = {}
    for name in links:
        _place(name, links, parents, frames)
    for name, link in links.items():
        body = _body(link, frames[name], draft)
        ground = name == WORLD or (name not in parents and not body.massive)
        if not ground:
            draft.add(body)
        elif body.massive:
            draft.leave_out(link, "it is the ground, and its inertia moves nothing", changes_motion=False)
    for name, joint in parents.items():
        _joint(name, joint, draft, frames[name])
    return draft


def _end(joint: Element, which: str, links: Mapping[str, Element]) -> str:
    element = joint.first(which)
    if element is None:
        raise fault(joint, f"must have a <{which}>")
    name = element.required("link")
    if name not in links:
        raise fault(element, f"must name a link of the model, unlike {shortened(name)}")
    return name


def _place(name: str, links: Mapping[str, Element], parents: Mapping[str, Element], frames: dict[str, Frame]) -> Frame:
    """Return the frame of a link in that of its root; a tree has one way there."""
    way: list[str] = []
    while name not in frames:
        if name in way:
            raise fault(links[name], "must not be carried by itself")
        way.append(name)
        if name not in parents:
            frames[name] = at((0.0, 0.0, 0.0))
            break
        name = _end(parents[name], "parent", links)
    for inner in reversed(way):
        if inner in parents:
            frames[inner] = frames[_end(parents[inner], "parent", links)] @ _origin(parents[inner])
    return frames[way[0] if way else name]


def _origin(element: Element) -> Frame:
    origin = element.first("origin")
    if origin is None:
        return at((0.0, 0.0, 0.0))
    angles = origin.numbers("rpy", 3, (0.0, 0.0, 0.0))
    return at(origin.numbers("xyz", 3, (0.0, 0.0, 0.0)), roll_pitch_yaw(angles))


def _body(link: Element, frame: Frame, draft: Draft) -> DraftBody:
    mass, centre, tensor = 0.0, np.zeros(3), np.zeros((3, 3))
    inertial = link.first("inertial")
    if inertial is not None:
        own = _origin(inertial)
        centre = own.origin
        element = inertial.first("mass")
        mass = 0.0 if element is None else element.number("value")
        inertia = inertial.first("inertia")
        if inertia is not None:
            tensor = inertia_tensor(lambda name: inertia.number(name, None if name in MOMENTS else 0.0))
            tensor = own.rotation @ tensor @ own.rotation.T
    for child in link.children:
        if child.name == "collision":
            draft.leave_out(child, "what touches is described by contacts of a scene")
        elif child.name != "inertial":
            draft.leave_out(child, "it is not seen by mechanics", changes_motion=child.name not in IGNORED)
    return DraftBody(link.required("name"), frame, mass, centre, tensor, link.line)


def _joint(name: str, joint: Element, draft: Draft, frame: Frame) -> None:
    type_name, parent = joint.required("type"), joint.first("parent")
    assert parent is not None, "read before"
    if name not in draft.bodies:
        raise fault(joint, "must not move the ground")
    if type_name == "floating":
        return
    if type_name not in KINDS:
        raise fault(joint, f"must be one of {', '.join((*KINDS, 'floating'))}, not {shortened(type_name)}")
    axis_element, kind = joint.first("axis"), KINDS[type_name]
    axis = vector((1.0, 0.0, 0.0) if axis_element is None else axis_element.numbers("xyz", 3))
    if kind != "weld" and not axis.any():
        raise fault(joint, "must have an axis other than zero")
    axes = [] if kind == "weld" else [frame.direction(unit(axis))]
    dynamics, carrier = joint.first("dynamics"), parent.required("link")
    damping = 0.0 if dynamics is None else dynamics.number("damping", 0.0)
    draft.join(
        DraftJoint(
            joint.required("name"),
            kind,
            carrier if carrier in draft.bodies else None,
            name,
            frame.origin,
            axes,
            joint.line,
            damping,
        )
    )
    if dynamics is not None and dynamics.number("friction", 0.0):
        draft.leave_out(dynamics, "the friction of the joint is a constant torque or force, which is not described")
    for child in joint.all("limit"):
        ends = [word for word in ("lower", "upper") if child.get(word)] if type_name != "continuous" else []
        why = "the joint may go beyond it" if ends else "limits of effort and rate are those of a drive"
        draft.leave_out(child, why, changes_motion=bool(ends))
    for child in joint.all("mimic"):
        draft.leave_out(child, "the joint moves by itself")
    for child in joint.all("calibration", "safety_controller"):
        draft.leave_out(child, "it says nothing of the motion", changes_motion=False)

"""Joints of MJCF: what they do to the frame of a body, and which joint of a scene several of one body are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.arrays import Floats
from core.interchange.draft import Draft, DraftJoint, JointKind
from core.interchange.frames import Frame, of_quaternion, parallel, turn_about, vector
from core.interchange.mjcf_elements import Compiler, limited, unit
from core.interchange.xml_reading import Element, fault, shortened

Take = Callable[[list[float] | None, int], Floats | None]
"""Takes numbers of the keyframe: the next so many, None without a keyframe."""

COUNTS = {"hinge": (1, 1), "slide": (1, 1), "ball": (4, 3), "free": (7, 6)}
"""Numbers of each type of joint in `qpos` and in `qvel`."""

PERPENDICULAR = 1e-9
"""Cosine up to which two axes of a file, which have some ten digits, are at right angles."""


ONE_POINT = 1e-9
"""Distance up to which two places of a file, which has some ten digits of metres, are one (m)."""


class Keyframe(Protocol):
    """Numbers of the joints in the order of the tree, None without a keyframe."""

    places: list[float] | None
    rates: list[float] | None


@dataclass(frozen=True)
class Moving:
    """A frame that moves: velocity of its origin and angular velocity, along the axes of space."""

    frame: Frame
    velocity: Floats
    turning: Floats


@dataclass(frozen=True)
class PlacedJoint:
    """A joint at the start.

    Attributes
    ----------
    element : Element
    kind : str
    at, axis : ndarray, shape (3,)
        In space.
    value, rest : float
        Of a hinge or slide, and where its spring has no force (rad, m).
    """

    element: Element
    kind: str
    at: Floats
    axis: Floats
    value: float
    rest: float


def moved(
    parent: Moving, local: Frame, elements: Sequence[Element], compiler: Compiler, take: Take, key: Keyframe
) -> tuple[Moving, list[PlacedJoint]]:
    """Return the frame of a body at the start and how it moves, and its joints there."""
    frame, joints, rates = parent.frame @ local, list[PlacedJoint](), list[Floats | None]()
    for element in elements:
        kind = "free" if element.name == "freejoint" else element.get("type", "hinge")
        if kind not in COUNTS:
            raise fault(element, f"must be one of {', '.join(COUNTS)}, not {shortened(kind)}")
        if kind == "free" and len(elements) > 1:
            raise fault(element, "must be the only joint of its body")
        given = take(key.places, COUNTS[kind][0])
        rates.append(take(key.rates, COUNTS[kind][1]))
        place = frame.point(vector(element.numbers("pos", 3, (0.0, 0.0, 0.0))))
        axis = frame.direction(unit(element, vector(element.numbers("axis", 3, (0.0, 0.0, 1.0)))))
        angular = compiler.angle if kind == "hinge" else 1.0
        start = element.number("ref", 0.0) * angular
        value = start if given is None else float(given[0])
        if kind == "hinge":
            frame = _turned(frame, place, turn_about(axis, value - start))
        elif kind == "slide":
            frame = Frame(frame.rotation, frame.origin + axis * (value - start))
        elif given is not None and not given[-4:].any():
            raise fault(element, "must have a quaternion other than zero in qpos")
        elif kind == "ball" and given is not None:
            frame = _turned(frame, place, frame.rotation @ of_quaternion(given) @ frame.rotation.T)
        elif kind == "free" and given is not None:
            frame = Frame(of_quaternion(given[3:]), given[:3])
        rest = element.number("springref", 0.0) * angular
        joints.append(PlacedJoint(element, kind, place, axis, value, rest))
    turning = parent.turning
    velocity = parent.velocity + np.cross(turning, frame.origin - parent.frame.origin)
    for joint, rate in zip(joints, rates, strict=True):
        if rate is None:
            continue
        if joint.kind == "free":
            velocity, turning = rate[:3], frame.rotation @ rate[3:]
        elif joint.kind == "slide":
            velocity = velocity + joint.axis * rate[0]
        else:
            own = joint.axis * rate[0] if joint.kind == "hinge" else frame.rotation @ rate
            turning, velocity = turning + own, velocity + np.cross(own, frame.origin - joint.at)
    return Moving(frame, velocity, turning), joints


def _turned(frame: Frame, about: Floats, rotation: Floats) -> Frame:
    return Frame(rotation @ frame.rotation, about + rotation @ (frame.origin - about))


def joined(
    draft: Draft, body: Element, name: str, parent: str | None, joints: Sequence[PlacedJoint], frame: Frame
) -> None:
    """Enter the joint that the joints of a body are together.

    Raises
    ------
    InvalidParameter
        For joints of which a scene has none.
    """
    kinds = " ".join(joint.kind for joint in joints)
    if kinds == "free":
        return
    together = _together(kinds, joints, frame.origin)
    if together is None or (parent is not None and together[0] in ("particle", "planar", "planar-particle")):
        remedy = "slides before turns; two hinges at right angles through one point; no massless bodies are made"
        raise fault(body, f"must have joints that a scene has, unlike {kinds}", remedy)
    kind, axes, place = together
    called = joints[0].element.get("name") if joints else ""
    made = DraftJoint(called or f"{name}-joint", kind, parent, name, place, axes, body.line)
    draft.join(made)
    for joint in joints:
        _add_forces(draft, made, joint, alone=joint.kind == ("hinge" if kind == "hinge-on-line" else kind))


def _together(
    kinds: str, joints: Sequence[PlacedJoint], origin: Floats
) -> tuple[JointKind, list[Floats], Floats] | None:
    """Return kind, axes and place of the joint that joints in a row are, None where there is none."""
    axes, place = [joint.axis for joint in joints], joints[-1].at if joints else origin
    match kinds:
        case "":
            return "weld", [], origin
        case "hinge":
            return "hinge", axes, place
        case "slide":
            return "slide", axes, place
        case "ball":
            return "ball", [], place
        case "slide slide slide":
            return "particle", [], place
        case "slide ball":
            return "on-line", axes[:1], place
        case "slide slide" if not parallel(*axes):
            return "planar-particle", [_normal(axes)], place
        case "slide slide ball" if not parallel(*axes[:2]):
            return "on-plane", [_normal(axes)], place
        case "slide slide hinge" if not parallel(*axes[:2]) and parallel(_normal(axes), axes[2]):
            return "planar", [axes[2]], place
        case "slide hinge" if parallel(*axes):
            return "cylindrical", axes[:1], place
        case "slide hinge" if abs(float(axes[0] @ axes[1])) < PERPENDICULAR:
            return "hinge-on-line", axes, place
        case "hinge hinge" if (
            abs(float(axes[0] @ axes[1])) < PERPENDICULAR and np.linalg.norm(joints[0].at - place) < ONE_POINT
        ):
            return "universal", axes, place
    return None


def _normal(axes: Sequence[Floats]) -> Floats:
    across = np.cross(axes[0], axes[1])
    return across / np.linalg.norm(across)


def _add_forces(draft: Draft, made: DraftJoint, joint: PlacedJoint, *, alone: bool) -> None:
    element = joint.element
    damping, stiffness = element.number("damping", 0.0), element.number("stiffness", 0.0)
    if alone and joint.kind in ("hinge", "slide"):
        made.damping, made.stiffness = damping, stiffness
        made.rest = joint.rest - joint.value
    elif damping or stiffness:
        draft.leave_out(element, "damping and stiffness are taken of a hinge or slide alone")
    for name, why in (("armature", "the inertia of a rotor"), ("frictionloss", "a constant friction")):
        if element.number(name, 0.0):
            draft.leave_out(element, f"{name} is {why}, which is not described")
    if limited(element):
        draft.leave_out(element, "the joint may go beyond its range")

"""Definitions of joints that are of space alone: cylindrical joints, screws and universal joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.joint_definitions import ends_of, in_body
from core.multibody.audit.joints import AXES, Coincidence, SliderDefinition, moments_between, perpendicular, pose_of
from core.multibody.audit.placement import Motion, Numbers, Placement, angle, carried, dot, rate
from core.multibody.audit.turns_in_space import WHOLE, Axis
from core.multibody.language.joints import Cylindrical, Screw, Universal


@dataclass(frozen=True)
class CylindricalDefinition(SliderDefinition):
    """A place stays on a line, about which alone the bodies turn.

    Attributes
    ----------
    axes : tuple of two vectors
        The direction of the line in the axes of each body.
    """

    kind: ClassVar[str] = "cylindrical"
    axes: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())

    def tilt(self, placement: Placement) -> Numbers:
        """Return the difference of the directions of the line in both bodies, shape (3,)."""
        first, second = _carried(self, self.axes, placement)
        return first - second

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {**super().held(placement), "axis": self.tilt(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        found = super().efforts(placement, motion)
        return {**found, **moments_between(self.name, self.a.body, self.b.body, motion)}

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.holding`: no moment about the axis."""
        rates = rate(self.tilt, placement, motion)
        held = {f"{self.name}.moment.{axis}": rates[..., i] for i, axis in enumerate(AXES)}
        return {**self.efforts(placement, motion), **held}


@dataclass(frozen=True)
class ScrewDefinition(CylindricalDefinition):
    """A place that stays on a line moves along it as the bodies turn about it; whole turns are not known.

    Attributes
    ----------
    about : Axis
    way : tuple of float
        The direction of the line in the axes of the body of `b`.
    pitch, begun : float
        Way by one turn, and along the line at the start (m).
    """

    kind: ClassVar[str] = "screw"
    about: Axis = field(kw_only=True)
    way: tuple[float, ...] = field(kw_only=True)
    pitch: float = field(kw_only=True)
    begun: float = field(kw_only=True)

    def ahead_of_turn(self, placement: Placement) -> Numbers:
        """Return by what angle the way along the line is ahead of the turn, without whole turns (rad), shape ()."""
        along = dot(carried(pose_of(placement, self.b.body), self.way), self.a.at(placement) - self.b.at(placement))
        missed = (along - self.begun) / self.pitch * WHOLE - self.about.turn(placement)
        return angle(np.cos(missed), np.sin(missed))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {**super().held(placement), "attitude": self.ahead_of_turn(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        ahead = self.pitch / WHOLE * rate(self.ahead_of_turn, placement, motion)
        return {**super().efforts(placement, motion), f"{self.name}.force": ahead}


@dataclass(frozen=True)
class UniversalDefinition(Coincidence):
    """Two places coincide, and an axis of each body stays at right angles to the other.

    Attributes
    ----------
    axes : tuple of two vectors
        Each in the axes of its body.
    """

    kind: ClassVar[str] = "universal"
    axes: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())

    def cosine(self, placement: Placement) -> Numbers:
        """Return the cosine of the angle between both axes, shape ()."""
        return dot(*_carried(self, self.axes, placement))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {**super().held(placement), "axis": self.cosine(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {**super().efforts(placement, motion), f"{self.name}.moment": rate(self.cosine, placement, motion)}


def _carried(
    joint: CylindricalDefinition | UniversalDefinition,
    axes: tuple[tuple[float, ...], tuple[float, ...]],
    placement: Placement,
) -> list[Numbers]:
    ends = zip((joint.a, joint.b), axes, strict=True)
    return [carried(pose_of(placement, place.body), axis) for place, axis in ends]


@definition_of.register
def cylindrical(connection: Cylindrical, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a cylindrical joint."""
    a, b = ends_of(connection, reader, path)
    axis = reader.unit(connection.axis, (*path, "axis"))
    axes = in_body(reader.start, a.body, axis), in_body(reader.start, b.body, axis)
    return CylindricalDefinition(name, (*a.bodies, *b.bodies), a, b, perpendicular(axes[1]), None, axes)


@definition_of.register
def screw(connection: Screw, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a screw."""
    joint = cylindrical(Cylindrical(connection.a, connection.b, connection.axis), reader, name, path)
    assert isinstance(joint, CylindricalDefinition), "what cylindrical returns"
    axis = reader.unit(connection.axis, (*path, "axis"))
    begun = float(np.dot(axis, joint.a.at(reader.start) - joint.b.at(reader.start)))
    return ScrewDefinition(
        **vars(joint),
        about=Axis.of(reader, joint.a.body, joint.b.body, axis),
        way=joint.axes[1],
        pitch=reader.number(connection.pitch, (*path, "pitch")),
        begun=begun,
    )


@definition_of.register
def universal(connection: Universal, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a universal joint."""
    a, b = ends_of(connection, reader, path)
    axes = [reader.unit(axis, (*path, "axes", i)) for i, axis in enumerate(connection.axes)]
    own = in_body(reader.start, a.body, axes[0]), in_body(reader.start, b.body, axes[1])
    return UniversalDefinition(name, (*a.bodies, *b.bodies), a, b, None, own)

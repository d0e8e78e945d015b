"""Definitions of moments about the axis of a joint of space: motors, dampers, torsion springs and stops.

The turn about the axis is known but for whole turns, as the attitudes of the bodies tell it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Reader
from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.driven import Driven
from core.multibody.audit.formulas import FormulaValue
from core.multibody.audit.joint_definitions import in_body
from core.multibody.audit.joints import perpendicular, pose_of
from core.multibody.audit.placement import Motion, Numbers, Placement, Undefined, angle, carried, dot, spin_of
from core.multibody.language.joints import axes_of_turn
from core.multibody.language.written import GROUND

WHOLE = 2.0 * np.pi
"""A whole turn (rad)."""


@dataclass(frozen=True)
class Axis:
    """The axis about which one body turns relative to another, and two directions across it.

    Attributes
    ----------
    a, b : str or None
        The bodies; None is the ground.
    own : tuple of float
        The axis in the axes of `a`.
    arm : tuple of float
        A direction across it, in the axes of `a`.
    across : tuple of two tuples of float
        That direction at the start and the product of the axis with it, in the axes of `b`.
    """

    a: str | None
    b: str | None
    own: tuple[float, ...]
    arm: tuple[float, ...]
    across: tuple[tuple[float, ...], ...]

    @classmethod
    def of(cls, reader: Reader, a: str | None, b: str | None, axis: tuple[float, ...]) -> Axis:
        """Return the axis that is a unit vector in space at the start."""
        first, second = perpendicular(axis)
        across = tuple(in_body(reader.start, b, e) for e in (first, second))
        return cls(a, b, in_body(reader.start, a, axis), in_body(reader.start, a, first), across)

    def turn(self, placement: Placement) -> Numbers:
        """Return the turn since the start, between -pi and pi (rad), shape ()."""
        arm = carried(pose_of(placement, self.a), self.arm)
        x, y = (dot(arm, carried(pose_of(placement, self.b), e)) for e in self.across)
        return angle(x, y)

    def turning(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate of that turn (rad/s), shape ()."""
        spins = [np.zeros(3) if one is None else np.asarray(spin_of(motion, one)) for one in (self.a, self.b)]
        return dot(carried(pose_of(placement, self.a), self.own), spins[0] - spins[1])


@dataclass(frozen=True)
class AxialTwist(Definition):
    """A moment about an axis that is fixed in both bodies; it acts on the first."""

    axis: Axis

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.torque": self.axis.turning(placement, motion)}


@dataclass(frozen=True)
class AxialMotor(AxialTwist):
    """The rate of the turn is given (rad/s)."""

    kind: ClassVar[str] = "motor"
    rate: FormulaValue

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.rate.quickness(0.0) + abs(float(self.rate.value(self.rate.start, {})))

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"rate": self.axis.turning(placement, motion) - self.rate.value(placement, motion)}


@dataclass(frozen=True)
class AxialDrive(Driven, AxialTwist):
    """The turn is given (rad)."""

    kind: ClassVar[str] = "motor"
    drive: FormulaValue

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`: what the turn misses, without whole turns."""
        missed = self.axis.turn(placement) - self.drive.value(placement, {})
        return {"attitude": angle(np.cos(missed), np.sin(missed))}


@dataclass(frozen=True)
class AxialDamper(AxialTwist):
    """A moment against the rate of the turn, by a coefficient (N m s)."""

    kind: ClassVar[str] = "damper"
    coefficient: float

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.coefficient * self.axis.turning(placement, motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.coefficient * speed


@dataclass(frozen=True)
class AxialDamperByFormula(AxialTwist):
    """A moment against the turn whose value is a formula of its rate."""

    kind: ClassVar[str] = "damper"
    formula: FormulaValue

    @property
    def formulas(self) -> tuple[FormulaValue, ...]:
        """See `Definition.formulas`."""
        return (self.formula,)

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.formula.value(placement, motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.formula.size(placement, size, speed)

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return self.formula.quickness(0.0)


@dataclass(frozen=True)
class AxialSpring(AxialTwist):
    """A linear spring of the turn (N m/rad, rad); of its energy whole turns are not known."""

    kind: ClassVar[str] = "torsion-spring"
    stiffness: float
    rest_angle: float

    def steps(self, force: str) -> tuple[float, ...]:
        """See `Definition.steps`."""
        return (WHOLE * self.stiffness,)

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.stiffness * (self.axis.turn(placement) - self.rest_angle)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.stiffness * (WHOLE + abs(self.rest_angle))

    @property
    def winds(self) -> bool:
        """See `Definition.winds`."""
        return True

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        return self.stiffness / 2.0 * (self.axis.turn(placement) - self.rest_angle) ** 2


@dataclass(frozen=True)
class AxialStop(Definition):
    """The turn stays at least or at most at an angle (rad), by its sense."""

    kind: ClassVar[str] = "contact"
    axis: Axis
    limit: float
    sense: int
    touch: Touch

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return abs(self.limit)

    def steps(self, force: str) -> tuple[float, ...]:
        """See `Definition.steps`."""
        return (WHOLE,)

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.torque": self.sense * (self.axis.turn(placement) - self.limit)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.torque": self.sense * self.axis.turning(placement, motion)}


def axis_between(reader: Reader, a: object, b: object) -> tuple[tuple[str, ...], Axis]:
    """Return the bodies of a connection, and the axis of the joint between them; None and the ground are one."""
    first, second = str(a), GROUND if b is None else str(b)
    joints = axes_of_turn(reader.scene.numbered(), first, second)
    if not joints:
        raise Undefined("the bodies have no axis in common")
    number, written = next(iter(joints.items()))
    axis = reader.unit(written, ("connections", number, "axis"))
    bodies = tuple(one for one in (first, second) if one != GROUND)
    ends = [None if one == GROUND else one for one in (first, second)]
    if ends[1] is not None and number in reader.begun:
        # Fixed in the body since the joint has begun.
        inside = in_body(reader.begun[number], ends[1], axis)
        axis = tuple(carried(reader.start[ends[1]], inside).tolist())
    return bodies, Axis.of(reader, ends[0], ends[1], axis)

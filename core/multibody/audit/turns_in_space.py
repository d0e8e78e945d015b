"""Definitions of moments about the axis of a pin of space: motors with a rate, and dampers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.formulas import FormulaValue
from core.multibody.audit.joint_definitions import in_body
from core.multibody.audit.joints import pose_of
from core.multibody.audit.placement import Motion, Numbers, Placement, Undefined, carried, dot, spin_of
from core.multibody.language.forces import Damper, Motor
from core.multibody.language.joints import axis_of_turn
from core.multibody.language.written import GROUND


@dataclass(frozen=True)
class AxialTwist(Definition):
    """A moment about an axis that is fixed in both bodies; it acts on the first.

    Attributes
    ----------
    a, b : str or None
        None is the ground.
    axis : tuple of float
        In the axes of `a`.
    """

    a: str
    b: str | None
    axis: tuple[float, ...]

    def turning(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate at which the first turns relative to the second (rad/s)."""
        relative = np.asarray(spin_of(motion, self.a) - spin_of(motion, self.b))
        return dot(carried(pose_of(placement, self.a), self.axis), relative)

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.torque": self.turning(placement, motion)}


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
        return {"rate": self.turning(placement, motion) - self.rate.value(placement, motion)}


@dataclass(frozen=True)
class AxialDamper(AxialTwist):
    """A moment against the rate of the turn, by a coefficient (N m s)."""

    kind: ClassVar[str] = "damper"
    coefficient: float

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.coefficient * self.turning(placement, motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.coefficient * speed


def axis_in_body(
    connection: Motor | Damper, reader: Reader
) -> tuple[tuple[str, ...], str, str | None, tuple[float, ...]]:
    """Return the bodies of a connection, the first, the second or None of the ground, and the axis of their pin."""
    a, b = str(connection.a), str(connection.b)
    found = axis_of_turn(reader.scene.numbered(), a, b)
    if found is None:
        raise Undefined("the bodies have no axis in common")
    axis, path = found
    own = in_body(reader, a, reader.unit(axis, path))
    return ((a,), a, None, own) if b == GROUND else ((a, b), a, b, own)

"""Definitions of what formulas of time drive: the turn of a motor, its rate, and the length of a rod."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from core.multibody.audit.formulas import FormulaValue
from core.multibody.audit.joints import RodDefinition
from core.multibody.audit.laws import Twisting
from core.multibody.audit.placement import Motion, Numbers, Placement


@dataclass(frozen=True)
class DrivenTurn(Twisting):
    """A turn is given (rad)."""

    kind: ClassVar[str] = "motor"
    drive: FormulaValue

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.drive.quickness(0.0)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"attitude": self.turn(placement) - self.drive.value(placement, {})}


@dataclass(frozen=True)
class DrivenRate(Twisting):
    """The rate of a turn is given (rad/s)."""

    kind: ClassVar[str] = "motor"
    rate: FormulaValue

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.rate.quickness(0.0) + abs(float(self.rate.value(self.rate.start, {})))

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"rate": self.turning(motion) - self.rate.value(placement, motion)}


@dataclass(frozen=True)
class DrivenRod(RodDefinition):
    """Two places stay at a distance that is given by time; `length` is that at the start (m)."""

    drive: FormulaValue

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.drive.quickness(0.0)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"length": self.distance(placement) - self.drive.value(placement, {})}

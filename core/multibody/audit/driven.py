"""Definitions of what formulas drive or hold: a turn, its rate, the length of a rod, a way along a line, relations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from core.multibody.audit.definition import Definition
from core.multibody.audit.formulas import FormulaValue
from core.multibody.audit.joints import RodDefinition, SliderDefinition
from core.multibody.audit.laws import Twisting
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, dot, rate
from core.multibody.audit.strings import StringDefinition


class Driven:
    """What a formula of time drives, by doing work.

    Attributes
    ----------
    drive : FormulaValue
    """

    drive: FormulaValue

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.drive.quickness(0.0)


@dataclass(frozen=True)
class DrivenTurn(Driven, Twisting):
    """A turn is given (rad)."""

    kind: ClassVar[str] = "motor"
    drive: FormulaValue

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
class DrivenRod(Driven, RodDefinition):
    """Two places stay at a distance that is given by time; `length` is that at the start (m)."""

    drive: FormulaValue

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"length": self.distance(placement) - self.drive.value(placement, {})}


@dataclass(frozen=True)
class DrivenString(Driven, StringDefinition):
    """A string is as long as is given by time (m); the length of its run is that of its way at the start."""

    drive: FormulaValue

    @property
    def drives(self) -> bool:
        """See `Definition.drives`."""
        return True

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        (run,) = self.runs
        return {f"{run.name}.tension": self.drive.value(placement, {}) - run.extent(placement)}


@dataclass(frozen=True)
class DrivenSlider(Driven, SliderDefinition):
    """A place is at a distance along a line that is given by time (m).

    Attributes
    ----------
    direction : tuple of float
        Of the line, in the axes of the body of `b`.
    """

    direction: tuple[float, ...] = ()
    drive: FormulaValue = field(kw_only=True)

    def along(self, placement: Placement) -> Numbers:
        """Return how far the place is along the line (m), shape ()."""
        return dot(self.carried(placement, self.direction), self.a.at(placement) - self.b.at(placement))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {**super().held(placement), "length": self.along(placement) - self.drive.value(placement, {})}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {**super().efforts(placement, motion), f"{self.name}.drive": rate(self.along, placement, motion)}


@dataclass(frozen=True)
class RelationDefinition(Definition):
    """A formula equals another one; the force acts along their difference.

    Attributes
    ----------
    arms : tuple of Place
        The places that the formulas name.
    """

    kind: ClassVar[str] = "relation"
    of: FormulaValue
    equals: FormulaValue
    arms: tuple[Place, ...]

    def works(self) -> bool:
        """See `Definition.works`."""
        return "t" in self.of.inputs or "t" in self.equals.inputs

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return max(self.of.quickness(0.0), self.equals.quickness(0.0)) if self.works() else 0.0

    def apart(self, placement: Placement) -> Numbers:
        """Return what stays zero, shape ()."""
        return self.of.value(placement, {}) - self.equals.value(placement, {})

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"attitude": self.apart(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.force": rate(self.apart, placement, motion)}

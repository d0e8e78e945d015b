"""Definitions of forces that are formulas."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.between_places import BetweenPlaces
from core.multibody.audit.definition import Definition
from core.multibody.audit.formulas import FormulaValue
from core.multibody.audit.laws import Twisting
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, dot, spin_of


@dataclass(frozen=True)
class PullByFormula(BetweenPlaces):
    """A force along the line between two places whose value is a formula."""

    kind: ClassVar[str] = "spring"
    formula: FormulaValue

    @property
    def formulas(self) -> tuple[FormulaValue, ...]:
        """See `Definition.formulas`."""
        return (self.formula,)

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.force": self.formula.value(placement, motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.formula.size(placement, size, speed)

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return self.formula.quickness(least)


@dataclass(frozen=True)
class TwistByFormula(Twisting):
    """A moment between two turns, or on one, whose value is a formula times a sign."""

    kind: ClassVar[str] = "torque"
    formula: FormulaValue
    sign: float

    @property
    def formulas(self) -> tuple[FormulaValue, ...]:
        """See `Definition.formulas`."""
        return (self.formula,)

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": self.sign * self.formula.value(placement, motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.formula.size(placement, size, speed)

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return self.formula.quickness(0.0)


@dataclass(frozen=True)
class ForcesByFormulas(Definition):
    """Forces on places by the formulas of their components, each force times a factor.

    Attributes
    ----------
    every : tuple of (Place, tuple of FormulaValue, float)
    turns : bool
        Whether the components are along the axes of the body.
    """

    kind: ClassVar[str] = "force"
    every: tuple[tuple[Place, tuple[FormulaValue, ...], float], ...]
    turns: bool = False

    @property
    def formulas(self) -> tuple[FormulaValue, ...]:
        """See `Definition.formulas`."""
        return tuple(formula for _, formulas, _ in self.every for formula in formulas)

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """See `Definition.load`."""
        total: Numbers = np.zeros(())
        for place, formulas, factor in self.every:
            values = np.broadcast_arrays(*(formula.value(placement, motion) for formula in formulas))
            force = factor * np.stack(values, axis=-1)
            if self.turns and place.body is not None:
                rotation = placement[place.body].rotation
                assert rotation is not None, "a force turns with a body whose attitude is known"
                force = (rotation @ force[..., None])[..., 0]
            total = total + dot(place.velocity(placement, virtual), force)
        return total

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return max(
            formula.quickness(least / factor if factor > 0.0 else 0.0)
            for _, formulas, factor in self.every
            for formula in formulas
        )


@dataclass(frozen=True)
class TorqueByFormulas(Definition):
    """A torque on a body of space by the formulas of its components.

    Attributes
    ----------
    turns : bool
        Whether the components are along the axes of the body.
    """

    kind: ClassVar[str] = "torque"
    body: str
    components: tuple[FormulaValue, ...]
    turns: bool

    @property
    def formulas(self) -> tuple[FormulaValue, ...]:
        """See `Definition.formulas`."""
        return self.components

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """See `Definition.load`."""
        torque = np.stack(np.broadcast_arrays(*(one.value(placement, motion) for one in self.components)), axis=-1)
        if self.turns:
            rotation = placement[self.body].rotation
            assert rotation is not None, "a torque turns with a body whose attitude is known"
            torque = (rotation @ torque[..., None])[..., 0]
        return dot(np.asarray(spin_of(virtual, self.body)), torque)

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return max(one.quickness(0.0) for one in self.components)

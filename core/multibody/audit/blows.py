"""The definition of a blow: its impulse acts on a place, or turns a body, at its time alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, spin_of
from core.multibody.language.forces import Blow

AXES = ("x", "y", "z")


@dataclass(frozen=True)
class BlowDefinition(Definition):
    """An impulse on a place (N s), or an impulsive torque on a body (N m s), by components in the axes of space."""

    kind: ClassVar[str] = "impulse"
    place: Place
    turns: bool

    @property
    def strikes(self) -> bool:
        """See `Definition.strikes`."""
        return True

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        if not self.turns:
            rate = self.place.velocity(placement, motion)
            return {f"{self.name}.{axis}": rate[..., i] for i, axis in enumerate(AXES[: rate.shape[-1]])}
        spin = np.asarray(spin_of(motion, self.place.body))
        if len(self.place.offset) == 2:
            return {f"{self.name}.torque": spin}
        return {f"{self.name}.torque.{axis}": spin[..., i] for i, axis in enumerate(AXES)}

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`: at other times there is no force."""
        dimension = len(self.place.offset)
        names = AXES[:dimension]
        if self.turns:
            names = ("torque",) if dimension == 2 else tuple(f"torque.{axis}" for axis in AXES)
        return {f"{self.name}.{name}": np.zeros(()) for name in names}


@definition_of.register
def blow(connection: Blow, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a blow."""
    if connection.body is not None:
        return BlowDefinition(name, (connection.body,), Place(connection.body, (0.0,) * reader.dimension), turns=True)
    place = reader.place(connection.place, (*path, "place"))
    return BlowDefinition(name, place.bodies, place, turns=False)

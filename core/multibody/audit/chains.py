"""Heavy chains over a peg."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, across, dot, rate, with_rate


@dataclass(frozen=True)
class ChainDefinition(Definition):
    """A heavy chain over a small smooth peg of the ground, straight on both sides (kg/m, m).

    Attributes
    ----------
    ways : tuple of two tuples of two floats
        Directions of the sides from the peg.
    pulls : tuple of two floats
        Components of gravity along them (m/s^2).
    peg_pull : float
        Scalar product of gravity and the place of the peg (m^2/s^2).
    """

    kind: ClassVar[str] = "chain"
    ends: tuple[Place, Place]
    peg: tuple[float, ...]
    ways: tuple[tuple[float, ...], tuple[float, ...]]
    density: float
    length: float
    pulls: tuple[float, float]
    peg_pull: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.length

    @property
    def mass(self) -> float:
        """See `Definition.mass`."""
        return self.density * self.length

    def sides(self, placement: Placement) -> tuple[Numbers, Numbers]:
        """Return the lengths of the two sides (m)."""
        first, last = (dot(end.at(placement) - np.array(self.peg), np.array(way)) for end, way in self._both)
        return first, last

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        first, last = self.sides(placement)
        beside = self._beside(placement)
        return {"length": first + last - self.length, "line 1": beside[0], "line 2": beside[1]}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = rate(lambda where: np.stack(self.sides(where), axis=-1), placement, motion)
        return {f"{self.name}.{i + 1}.tension": -rates[..., i] for i in range(2)}

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return f"{self.name}.1.tension", f"{self.name}.2.tension"

    def own_rest(
        self, placement: Placement, motion: Motion, gains: Motion, forces: Mapping[str, Numbers]
    ) -> tuple[Numbers, Numbers] | None:
        """See `Definition.own_rest`: that of the chain along itself, between its ends."""
        if any(any(end.offset) for end in self.ends) or any(name not in forces for name in self.forces):
            return None
        first, last = self.sides(placement)
        gain = rate(lambda where: self.sides(where)[0], placement, gains)
        drawn = self.density * (self.pulls[0] * first - self.pulls[1] * last)
        tensions = [forces[name] for name in self.forces]
        rest = self.density * self.length * gain - drawn - tensions[0] + tensions[1]
        size = self.mass * (np.abs(gain) + sum(abs(pull) for pull in self.pulls))
        return rest, size + np.abs(tensions[0]) + np.abs(tensions[1])

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the tension at the peg, and how hard the chain presses on it."""
        z, speed = with_rate(lambda where: self.sides(where)[0], placement, motion)
        share = z / self.length
        hung = self.density * (self.pulls[0] + self.pulls[1]) * z * (1.0 - share)
        tension = forces[f"{self.name}.1.tension"] * (1.0 - share) + forces[f"{self.name}.2.tension"] * share + hung
        bend = float(np.linalg.norm(np.add(*self.ways)))
        pressed = (tension - self.density * speed**2) * bend
        return {f"{self.name}.tension": tension, f"{self.name}.normal": pressed}

    def unanswered(self, placement: Placement, motion: Motion) -> tuple[Numbers, ...]:
        """See `Definition.unanswered`."""
        rates = rate(lambda where: np.stack(self._beside(where), axis=-1), placement, motion)
        return tuple(rates[..., i] for i in range(2))

    def kinetic(self, placement: Placement, motion: Motion) -> Numbers:
        """See `Definition.kinetic`."""
        speed = rate(lambda where: self.sides(where)[0], placement, motion)
        return self.density * self.length / 2.0 * speed**2

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        first, last = self.sides(placement)
        fall = -(self.pulls[0] * first * first + self.pulls[1] * last * last) / 2.0
        return self.density * (fall - self.length * self.peg_pull)

    def _beside(self, placement: Placement) -> tuple[Numbers, Numbers]:
        first, last = (dot(end.at(placement) - np.array(self.peg), across(np.array(way))) for end, way in self._both)
        return first, last

    @property
    def _both(self) -> tuple[tuple[Place, tuple[float, ...]], tuple[Place, tuple[float, ...]]]:
        return (self.ends[0], self.ways[0]), (self.ends[1], self.ways[1])

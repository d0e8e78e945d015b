"""What acts along the line between two places: rods, springs, dampers, attraction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, dot, length


def approach(a: Place, b: Place, placement: Placement, motion: Motion) -> Numbers:
    """Return the rate of the distance of two places in a motion, which may be a virtual one (m/s)."""
    d = b.at(placement) - a.at(placement)
    return dot(d / length(d)[..., None], b.velocity(placement, motion) - a.velocity(placement, motion))


@dataclass(frozen=True)
class BetweenPlaces(Definition):
    """A force along the line between two places, positive where it pulls them together."""

    a: Place
    b: Place

    def distance(self, placement: Placement) -> Numbers:
        """Return the distance of the places (m), shape ()."""
        return length(self.b.at(placement) - self.a.at(placement))

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.force": -approach(self.a, self.b, placement, motion)}

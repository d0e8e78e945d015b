"""What touches: places, rims and balls on faces and on one another, and stops of turns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.placement import Motion, Numbers, Placement, rate
from core.multibody.audit.surfaces import Face, Round, Tip, friction_powers


@dataclass(frozen=True)
class Touching(Definition):
    """What has a gap that does not fall below zero, and rubs where it is closed.

    Attributes
    ----------
    touch : Touch
        Its coefficients.
    """

    kind: ClassVar[str] = "contact"
    touch: Touch

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.touch.static > 0.0

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch


@dataclass(frozen=True)
class OnFace(Touching):
    """A place, rim, ball or ellipsoid that does not pass a face."""

    tip: Tip
    face: Face

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return max(super().driven, abs(self.face.turning))

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.tip.size

    def gap(self, placement: Placement) -> Numbers:
        """Return the gap (m), shape ()."""
        return self.face.gap(placement, self.tip)

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.normal": self.gap(placement)}

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        if not self.touch.friction:
            return {}
        return {f"{self.name}.normal": self.face.slip(placement, motion, self.tip)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slips = [self.face.passing(placement, motion, self.tip)] if self.touch.friction else []
        return {f"{self.name}.normal": rate(self.gap, placement, motion), **friction_powers(self.touch.friction, slips)}


@dataclass(frozen=True)
class OnRound(Touching):
    """Two rims or balls, one of which may be a point, that do not pass one another."""

    round: Round

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.round.size

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.normal": self.round.gap(placement)}

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        if not self.touch.friction:
            return {}
        return {f"{self.name}.normal": self.round.slip(placement, motion)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slips = self.slips(placement, motion).values()
        return {
            f"{self.name}.normal": self.round.gap_rate(placement, motion),
            **friction_powers(self.touch.friction, slips),
        }


@dataclass(frozen=True)
class Stop(Definition):
    """The turn of a body, relative to another or the ground, stays at least or at most at an angle (rad)."""

    kind: ClassVar[str] = "contact"
    a: str
    b: str | None
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

    def gap(self, placement: Placement) -> Numbers:
        """Return how far it may still turn (rad), shape ()."""
        return self.sense * (turn_between(placement, self.a, self.b) - self.limit)

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.torque": self.gap(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.torque": rate(self.gap, placement, motion)}


def turn_between(placement: Placement, a: str, b: str | None) -> Numbers:
    """Return the turn of one body of the plane relative to another, or to the ground (rad)."""
    first = placement[a].turn
    second = None if b is None else placement[b].turn
    assert first is not None, "a body with inertia has a turn"
    return first if second is None else first - second

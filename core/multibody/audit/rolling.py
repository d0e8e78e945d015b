"""What rolls without slip: on faces, rims, cylinders and balls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.definition import Definition
from core.multibody.audit.joints import AXES
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, cross, dot, rate, spin_of
from core.multibody.audit.surfaces import Face, Round, Tip, friction_powers

ZERO: Numbers = np.zeros(())


@dataclass(frozen=True)
class RollingOnFace(Definition):
    """A rim, ball or ellipsoid that rolls on a face, in space on a plane that may turn about its normal (rad/s)."""

    kind: ClassVar[str] = "rolling"
    tip: Tip
    face: Face

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.face.turning != 0.0

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.tip.size

    def gap(self, placement: Placement) -> Numbers:
        """Return the gap (m), shape ()."""
        return self.face.gap(placement, self.tip)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"gap": self.gap(placement)}

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"slip": self.face.slip(placement, motion, self.tip)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slip = self.face.passing(placement, motion, self.tip)
        names = [f"{self.name}.friction"]
        if len(self.face.normal) == 3:
            names = [f"{self.name}.friction.{axis}" for axis in AXES]
        return {f"{self.name}.normal": rate(self.gap, placement, motion), **friction_powers(tuple(names), (slip,))}


@dataclass(frozen=True)
class RollingOnRound(Definition):
    """A rim of the plane that rolls on another, outside or inside it."""

    kind: ClassVar[str] = "rolling"
    round: Round

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.round.size

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"gap": self.round.gap(placement)}

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"slip": self.round.slip(placement, motion)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {
            f"{self.name}.normal": self.round.gap_rate(placement, motion),
            f"{self.name}.friction": self.round.slip(placement, motion),
        }


@dataclass(frozen=True)
class RollingOnCylinder(Definition):
    """A ball that rolls on a cylinder, or inside it where its radius is negative.

    Attributes
    ----------
    axis : tuple of float
        Unit vector.
    """

    kind: ClassVar[str] = "rolling"
    place: Place
    radius: float
    at: Place
    axis: tuple[float, ...]
    cylinder: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius + abs(self.cylinder)

    def gap(self, placement: Placement) -> Numbers:
        """Return (d^2 - r^2)/(2r) with d the distance from the axis and r the reach (m), as `Round.gap`."""
        away, reach = self._away(placement), self.radius + self.cylinder
        return (dot(away, away) - reach**2) / (2.0 * reach)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"gap": self.gap(placement)}

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        along, around = self._slips(placement, motion)
        return {"slip along": along, "slip around": around}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        along, around = self._slips(placement, motion)
        return {
            f"{self.name}.normal": rate(self.gap, placement, motion),
            f"{self.name}.friction.along": along,
            f"{self.name}.friction.around": around,
        }

    def _away(self, placement: Placement) -> Numbers:
        d, a = self.place.at(placement) - self.at.at(placement), np.array(self.axis)
        away: Numbers = d - a * dot(d, a)[..., None]
        return away

    def _slips(self, placement: Placement, motion: Motion) -> tuple[Numbers, Numbers]:
        n, a = self._away(placement) / (self.radius + self.cylinder), np.array(self.axis)
        relative = self.place.velocity(placement, motion) - self.at.velocity(placement, motion)
        slip = relative - self.radius * cross(np.asarray(spin_of(motion, self.place.body)), n)
        return dot(a, slip), dot(cross(a, n), slip)


@dataclass(frozen=True)
class RollingOnBall(Definition):
    """A ball that rolls on a ball of the ground, or inside it where its radius is negative; the force is that on it."""

    kind: ClassVar[str] = "rolling"
    round: Round

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.round.size

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"gap": self.round.gap(placement)}

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"slip": self._slip(placement, motion)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slip = self._slip(placement, motion)
        return {f"{self.name}.{axis}": slip[..., i] for i, axis in enumerate(AXES)}

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return tuple(f"{self.name}.{axis}" for axis in AXES)

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`."""
        n = -self.round.between(placement) / self.round.reach
        return {f"{self.name}.normal": sum((forces[f"{self.name}.{x}"] * n[..., i] for i, x in enumerate(AXES)), ZERO)}

    def _slip(self, placement: Placement, motion: Motion) -> Numbers:
        # The first is the ball, so that the normal from the surface is against the vector between the centres.
        n = -self.round.between(placement) / self.round.reach
        spin = np.asarray(spin_of(motion, self.round.a.body))
        return -self.round.departure(placement, motion) - self.round.radii[0] * cross(spin, n)

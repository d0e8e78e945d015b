"""What touches or rolls: faces, circles and balls, bodies on one another, and stops of turns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.joints import AXES
from core.multibody.audit.placement import (
    Motion,
    Numbers,
    Place,
    Placement,
    across,
    carried,
    cross,
    dot,
    rate,
    spin_of,
)

ZERO: Numbers = np.zeros(())


@dataclass(frozen=True)
class Face:
    """A line of the plane or a plane of space, fixed in the body of `at`; free on the side of its unit normal."""

    at: Place
    normal: tuple[float, ...]

    def normal_in(self, placement: Placement) -> Numbers:
        """Return the normal in space, shape (d,)."""
        pose = None if self.at.body is None else placement[self.at.body]
        # A particle carries directions of the ground.
        return carried(None if pose is None or pose.rotation is None else pose, self.normal)

    def height(self, placement: Placement, place: Place) -> Numbers:
        """Return the height of a place above the face (m), shape ()."""
        return dot(self.normal_in(placement), place.at(placement) - self.at.at(placement))

    def slip(self, placement: Placement, motion: Motion, place: Place, radius: float) -> Numbers:
        """Return the rate of slip of a rim or ball around a place (m/s): along the face in the plane, else a vector."""
        n = self.normal_in(placement)
        relative = place.velocity(placement, motion) - self.at.velocity(placement, motion)
        spin = spin_of(motion, place.body) if radius else 0.0
        if n.shape[-1] == 2:
            # The points of a face move along it as one, so that its turning does not enter.
            return dot(-across(n), relative) + radius * spin
        inside: Numbers = relative - n * dot(n, relative)[..., None]
        return inside - radius * cross(np.asarray(spin), n) if radius else inside


@dataclass(frozen=True)
class Round:
    """Two rims or balls, of which the second is hollow where its radius is negative, and either may be a point."""

    a: Place
    b: Place
    radii: tuple[float, float]

    @property
    def reach(self) -> float:
        """Sum of the radii (m), negative where the first is inside the second."""
        return self.radii[0] + self.radii[1]

    def between(self, placement: Placement) -> Numbers:
        """Return the vector from the first centre to the second (m), shape (d,)."""
        return self.b.at(placement) - self.a.at(placement)

    def departure(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate of the vector between the centres (m/s), shape (d,)."""
        return self.b.velocity(placement, motion) - self.a.velocity(placement, motion)

    def gap_rate(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate of `gap` (m/s)."""
        found: Numbers = dot(self.between(placement), self.departure(placement, motion)) / self.reach
        return found

    def gap(self, placement: Placement) -> Numbers:
        """Return (d^2 - r^2)/(2r) with d the distance and r the reach (m).

        It has the sign of the gap and is equal to it to first order, also in a hollow whose centre d = 0 may pass.
        """
        d = self.between(placement)
        return (dot(d, d) - self.reach**2) / (2.0 * self.reach)

    def slip(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate of slip in the plane (m/s): of the second along the normal turned counter-clockwise."""
        d = self.between(placement)
        along = dot(across(d) / self.reach, self.departure(placement, motion))
        return along - sum(
            radius * spin_of(motion, place.body)
            for place, radius in zip((self.a, self.b), self.radii, strict=True)
            if radius
        )


@dataclass(frozen=True)
class OnFace(Definition):
    """A place, rim or ball that does not pass a face."""

    kind: ClassVar[str] = "contact"
    place: Place
    radius: float
    face: Face
    touch: Touch

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.touch.static > 0.0

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius

    def gap(self, placement: Placement) -> Numbers:
        """Return the gap (m), shape ()."""
        return self.face.height(placement, self.place) - self.radius

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.normal": self.gap(placement)}

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        if not self.touch.friction:
            return {}
        return {f"{self.name}.normal": self.face.slip(placement, motion, self.place, self.radius)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slips = self.slips(placement, motion).values()
        return {f"{self.name}.normal": rate(self.gap, placement, motion), **_rubbing(self.touch.friction, slips)}


@dataclass(frozen=True)
class OnRound(Definition):
    """Two rims or balls, one of which may be a point, that do not pass one another."""

    kind: ClassVar[str] = "contact"
    round: Round
    touch: Touch

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.touch.static > 0.0

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return sum(abs(radius) for radius in self.round.radii)

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
        return {f"{self.name}.normal": self.round.gap_rate(placement, motion), **_rubbing(self.touch.friction, slips)}


def _rubbing(names: tuple[str, ...], slips: Iterable[Numbers]) -> Mapping[str, Numbers]:
    """Return the power of one unit of each component of friction."""
    found: dict[str, Numbers] = {}
    for slip in slips:
        if len(names) == 1:
            found[names[0]] = slip
        else:
            found.update((name, slip[..., i]) for i, name in enumerate(names))
    return found


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


@dataclass(frozen=True)
class RollingOnFace(Definition):
    """A rim or ball that rolls on a face, in space on a plane that may turn about its normal at a rate (rad/s)."""

    kind: ClassVar[str] = "rolling"
    place: Place
    radius: float
    face: Face
    turning: float = 0.0

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.turning != 0.0

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius

    def gap(self, placement: Placement) -> Numbers:
        """Return the gap (m), shape ()."""
        return self.face.height(placement, self.place) - self.radius

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"gap": self.gap(placement)}

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        slip = self.face.slip(placement, motion, self.place, self.radius)
        if not self.turning:
            return {"slip": slip}
        n = self.face.normal_in(placement)
        d = self.place.at(placement) - self.face.at.at(placement)
        return {"slip": slip - self.turning * cross(n, d)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slip = self.face.slip(placement, motion, self.place, self.radius)
        names = [f"{self.name}.friction"]
        if len(self.face.normal) == 3:
            names = [f"{self.name}.friction.{axis}" for axis in AXES]
        return {f"{self.name}.normal": rate(self.gap, placement, motion), **_rubbing(tuple(names), (slip,))}


@dataclass(frozen=True)
class RollingOnRound(Definition):
    """A rim of the plane that rolls on another, outside or inside it."""

    kind: ClassVar[str] = "rolling"
    round: Round

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return sum(abs(radius) for radius in self.round.radii)

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
        return sum(abs(radius) for radius in self.round.radii)

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

"""What bodies touch one another with: faces, and rims or balls."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.placement import (
    Motion,
    Numbers,
    Place,
    Placement,
    Undefined,
    across,
    carried,
    cross,
    dot,
    length,
    spin_of,
)


@dataclass(frozen=True)
class Tip:
    """What touches a face: everything within a radius of a place, or in space an ellipsoid about it.

    Attributes
    ----------
    semi_axes : tuple of float
        Along the body axes (m); that of a disc along its axis is zero. None of what has a radius.
    """

    place: Place
    radius: float = 0.0
    semi_axes: tuple[float, ...] = ()

    @property
    def size(self) -> float:
        """Its largest distance from the place (m)."""
        return max((self.radius, *self.semi_axes))

    def lever(self, placement: Placement, n: Numbers) -> Numbers:
        """Return the vector from the place to the point that is lowest against a unit vector (m), shape (d,).

        That of an ellipsoid x.A^-2 x = 1 with its gradient along -n: x = -A^2 n/|A n|.
        """
        if not self.semi_axes:
            return -self.radius * n
        assert self.place.body is not None, "an ellipsoid belongs to a body"
        axes = placement[self.place.body].rotation
        if axes is None:
            raise Undefined("an ellipsoid whose attitude is not known")
        stretched = np.array(self.semi_axes) * (np.swapaxes(axes, -1, -2) @ n[..., None])[..., 0]
        lowest = np.array(self.semi_axes) * stretched / length(stretched)[..., None]
        found: Numbers = -(axes @ lowest[..., None])[..., 0]
        return found


@dataclass(frozen=True)
class Face:
    """A line of the plane or a plane of space, fixed in the body of `at`; free on the side of its unit normal.

    A plane may turn about its normal through `at`, at a rate `turning` (rad/s).
    """

    at: Place
    normal: tuple[float, ...]
    turning: float = 0.0

    def normal_in(self, placement: Placement) -> Numbers:
        """Return the normal in space, shape (d,)."""
        pose = None if self.at.body is None else placement[self.at.body]
        # A particle carries directions of the ground.
        return carried(None if pose is None or pose.rotation is None else pose, self.normal)

    def gap(self, placement: Placement, tip: Tip) -> Numbers:
        """Return the height of what touches above the face (m), shape ()."""
        n = self.normal_in(placement)
        return dot(n, tip.place.at(placement) - self.at.at(placement)) + dot(n, tip.lever(placement, n))

    def slip(self, placement: Placement, motion: Motion, tip: Tip) -> Numbers:
        """Return the rate of slip of what touches on the face (m/s): along it in the plane, else a vector."""
        found = self.passing(placement, motion, tip)
        if not self.turning:
            return found
        n = self.normal_in(placement)
        arm = tip.place.at(placement) + tip.lever(placement, n) - self.at.at(placement)
        return found - self.turning * cross(n, arm)

    def passing(self, placement: Placement, motion: Motion, tip: Tip) -> Numbers:
        """Return the same on a face that does not turn by itself: it is linear in the motion."""
        n, place = self.normal_in(placement), tip.place
        relative = place.velocity(placement, motion) - self.at.velocity(placement, motion)
        spin = spin_of(motion, place.body) if tip.size else 0.0
        if n.shape[-1] == 2:
            # The points of a face move along it as one, so that its turning does not enter.
            return dot(-across(n), relative) + tip.radius * spin
        if tip.size:
            relative = relative + cross(np.asarray(spin), tip.lever(placement, n))
        inside: Numbers = relative - n * dot(n, relative)[..., None]
        return inside


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

    @property
    def size(self) -> float:
        """Sum of the sizes of the radii (m)."""
        return sum(abs(radius) for radius in self.radii)

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


def friction_powers(names: tuple[str, ...], slips: Iterable[Numbers]) -> Mapping[str, Numbers]:
    """Return the power of one unit of each component of friction."""
    found: dict[str, Numbers] = {}
    for slip in slips:
        if len(names) == 1:
            found[names[0]] = slip
        else:
            found.update((name, slip[..., i]) for i, name in enumerate(names))
    return found

"""Shapes that touch: contacts by corners, the distance of a corner from an outline, and the sums of their forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from core.multibody.audit.contacts import Touching
from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, across, dot, length, rate, spin_of
from core.multibody.audit.surfaces import friction_powers

BESIDE = 1e-9
"""Share of the length of an edge by which what is beside its ends is taken to be above it still: distances from the
edge and from its end differ by the square of that."""


FAR = 1e100
"""Added to the distance from an edge on whose free side the outline of a corner is not."""


class _Nearest(NamedTuple):
    """Distance from a part of an outline, unit normal from it, and what is least for the part that is nearest."""

    size: Numbers
    normal: Numbers
    key: Numbers


@dataclass(frozen=True)
class ByCorners(Definition):
    """A contact of a shape: one contact for every corner, and the sums of their forces."""

    kind: ClassVar[str] = "contact"
    corners: tuple[Definition, ...]

    @property
    def members(self) -> tuple[Definition, ...]:
        """See `Definition.members`."""
        names: list[str] = []
        sums: dict[str, list[str]] = {}
        for corner in self.corners:
            touch = corner.coefficients
            own = [f"{corner.name}.normal", *(() if touch is None else touch.friction)]
            names += own
            for force in own:
                sums.setdefault(f"{self.name}{force[len(corner.name) :]}", []).append(force)
        total = SumOfForces(self.name, self.bodies, tuple(names), tuple((key, tuple(of)) for key, of in sums.items()))
        return (*self.corners, total)


@dataclass(frozen=True)
class SumOfForces(Definition):
    """The forces of a shape, which are the sums of those of its corners."""

    kind: ClassVar[str] = "contact"
    named: tuple[str, ...]
    sums: tuple[tuple[str, tuple[str, ...]], ...]

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return self.named

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`."""
        return {key: np.sum([forces[name] for name in of], axis=0) for key, of in self.sums}


@dataclass(frozen=True)
class OnOutline(Touching):
    """A corner with a radius that does not pass a convex outline of the plane.

    Attributes
    ----------
    corners : tuple of Place
        Of the outline, counter-clockwise.
    radii : tuple of two floats
        Of the corner and of the outline (m).
    beside : tuple of Place
        The corners beside it on its own outline.
    """

    place: Place
    corners: tuple[Place, ...]
    radii: tuple[float, float]
    beside: tuple[Place, ...] = ()

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return sum(self.radii)

    def _nearest(self, placement: Placement) -> tuple[Numbers, Numbers]:
        """Return the distance from the polygon of the outline (m), negative inside, and the unit normal towards it."""
        p = self.place.at(placement)
        beside = [place.at(placement) - p for place in self.beside]
        ends = [corner.at(placement) for corner in self.corners]
        edges: list[_Nearest] = []
        arcs: list[_Nearest] = []
        for a, b in zip(ends, [*ends[1:], ends[0]], strict=True):
            span = length(b - a)
            along, away, near = (b - a) / span[..., None], p - a, BESIDE * span.real
            normal, beyond = -across(along), dot(along, away).real
            height, square = dot(normal, away), dot(away, away)
            above = (beyond >= -near) & (beyond <= span.real + near) & (height.real >= -near)
            # At the end of two edges it is on that of which its own outline is on the free side.
            fits = np.all([dot(normal, side).real >= -near for side in beside], axis=0)
            edges.append(_Nearest(height, normal, np.where(above, np.where(fits, 0.0, FAR) + height.real, np.inf)))
            # What is at an end, up to rounding, is on an edge.
            apart = square.real > near**2
            distance = np.sqrt(np.where(apart, square, 1.0))
            arcs.append(_Nearest(distance, away / distance[..., None], np.where(apart, distance.real, np.inf)))
        size, normal = _least([*edges, *arcs])
        highest = np.max([edge.size.real for edge in edges], axis=0)
        outside = (highest > -BESIDE * span.real) | (len(ends) < 3)
        depth, upwards = _least([edge._replace(key=-edge.size.real) for edge in edges])
        return np.where(outside, size, depth), np.where(outside[..., None], normal, upwards)

    def gap(self, placement: Placement) -> Numbers:
        """Return the distance of the two outlines at the corner (m), shape ()."""
        return self._nearest(placement)[0] - sum(self.radii)

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.normal": self.gap(placement)}

    def slip(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the rate of slip of the corner along the outline (m/s), clockwise around it."""
        _, normal = self._nearest(placement)
        # Where they touch: by its own radius below the corner.
        at = self.place.at(placement) - self.radii[0] * normal
        own = _velocity(self.place, at, placement, motion)
        other = _velocity(self.corners[0], at, placement, motion)
        return dot(-across(normal), own - other)

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        return {f"{self.name}.normal": self.slip(placement, motion)} if self.touch.friction else {}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        slips = self.slips(placement, motion).values()
        return {f"{self.name}.normal": rate(self.gap, placement, motion), **friction_powers(self.touch.friction, slips)}


def _least(found: Sequence[_Nearest]) -> tuple[Numbers, Numbers]:
    """Return distance and normal of the least key."""
    which = np.argmin([one.key for one in found], axis=0)
    sizes = np.stack([one.size for one in found])
    normals = np.stack(np.broadcast_arrays(*(one.normal + 0.0 * one.size[..., None] for one in found)))
    normal = np.take_along_axis(normals, which[None, ..., None], axis=0)[0]
    return np.take_along_axis(sizes, which[None], axis=0)[0], normal


def _velocity(place: Place, at: Numbers, placement: Placement, motion: Motion) -> Numbers:
    """Return the velocity of the point of the body of a place that is somewhere (m/s), shape (2,)."""
    moves = place.velocity(placement, motion)
    if place.body is None or placement[place.body].turn is None:
        return moves
    found: Numbers = moves + np.asarray(spin_of(motion, place.body))[..., None] * across(at - place.at(placement))
    return found

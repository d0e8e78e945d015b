"""What holds places and attitudes to one another: pins, welds, sliders, rods and tracks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.between_places import BetweenPlaces
from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, Pose, across, carried, dot, length, rate

AXES = ("x", "y", "z")


def pose_of(placement: Placement, body: str | None) -> Pose | None:
    """Return where a body is; None of the ground."""
    return None if body is None else placement[body]


def perpendicular(direction: tuple[float, ...]) -> tuple[tuple[float, ...], ...]:
    """Return the unit vectors that complete a unit vector: one in the plane, two in space.

    In space the first is at right angles to the axis that the direction is farthest from.
    """
    t = np.array(direction)
    if len(t) == 2:
        return ((float(-t[1]), float(t[0])),)
    first = np.cross(t, np.eye(3)[int(np.argmin(np.abs(t)))])
    first = first / np.linalg.norm(first)
    return tuple(first.tolist()), tuple(np.cross(t, first).tolist())


def attitude_to(placement: Placement, a: str | None, b: str | None) -> Numbers:
    """Return the attitude of body `a` in the axes of body `b`, each of which may be the ground.

    In the plane it is the difference of their turns; in space the nine cosines between their axes.
    """
    first, second = pose_of(placement, a), pose_of(placement, b)
    known = first if first is not None else second
    assert known is not None, "two places of the ground are not joined"
    if known.position.shape[-1] == 2:
        turns = [np.zeros(()) if pose is None or pose.turn is None else pose.turn for pose in (first, second)]
        return turns[0] - turns[1]
    axes = [carried_axes(pose) for pose in (first, second)]
    product = np.swapaxes(axes[1], -1, -2) @ axes[0]
    return product.reshape(*product.shape[:-2], 9)


def carried_axes(pose: Pose | None) -> Numbers:
    """Return the three axes of a body in space as columns; the identity of the ground."""
    if pose is None:
        return np.eye(3)
    return np.stack([carried(pose, tuple(row)) for row in np.eye(3).tolist()], axis=-1)


@dataclass(frozen=True)
class Coincidence(Definition):
    """A pin or a ball joint: two places coincide; the force is that on the first.

    Attributes
    ----------
    axis : tuple of two tuples of three floats, or None
        A direction about which alone the bodies turn, in the axes of each of them.
    """

    kind: ClassVar[str] = "pin"
    a: Place
    b: Place
    axis: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    def apart(self, placement: Placement) -> Numbers:
        """Return the vector from the second place to the first (m), shape (d,)."""
        return self.a.at(placement) - self.b.at(placement)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        found = {"coincidence": self.apart(placement)}
        return found if self.axis is None else {**found, "axis": self._tilt(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = self.a.velocity(placement, motion) - self.b.velocity(placement, motion)
        found = {f"{self.name}.{axis}": rates[..., i] for i, axis in zip(range(rates.shape[-1]), AXES, strict=False)}
        return found if self.axis is None else found | moments_between(self.name, self.a.body, self.b.body, motion)

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.holding`: no moment about the axis."""
        found = dict(self.efforts(placement, motion))
        if self.axis is not None:
            rates = rate(self._tilt, placement, motion)
            found |= {f"{self.name}.moment.{axis}": rates[..., i] for i, axis in enumerate(AXES)}
        return found

    def _tilt(self, placement: Placement) -> Numbers:
        assert self.axis is not None
        first, second = (
            carried(pose_of(placement, place.body), axis)
            for place, axis in zip((self.a, self.b), self.axis, strict=True)
        )
        return first - second


@dataclass(frozen=True)
class RodDefinition(BetweenPlaces):
    """Two places stay at a distance (m); the force is the pull."""

    kind: ClassVar[str] = "rod"
    length: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.length

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"length": self.distance(placement) - self.length}


@dataclass(frozen=True)
class WeldDefinition(Definition):
    """Two bodies move as one; the force is that on the first, at its place.

    Attributes
    ----------
    carrier : int
        Which of the two carries the vector between the places: 0 or 1.
    between : tuple of float
        From the place of the carrier to the other, in the axes of the carrier (m).
    attitude : ndarray or None
        See `attitude_to`; None where one of them is a particle.
    """

    kind: ClassVar[str] = "weld"
    a: Place
    b: Place
    carrier: int
    between: tuple[float, ...]
    attitude: Numbers | None

    def apart(self, placement: Placement) -> Numbers:
        """Return how far the places are from where they are welded (m), shape (d,)."""
        ends = (self.a, self.b)
        carrier, other = ends[self.carrier], ends[1 - self.carrier]
        arm = np.array(self.between)
        if any(self.between) and carrier.body is not None:
            pose = placement[carrier.body]
            arm = arm if pose.rotation is None else carried(pose, self.between)
        found: Numbers = other.at(placement) - carrier.at(placement) - arm
        return found if self.carrier == 1 else -found

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        found = {"place": self.apart(placement)}
        if self.attitude is None:
            return found
        return {**found, "attitude": attitude_to(placement, self.a.body, self.b.body) - self.attitude}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = rate(self.apart, placement, motion)
        found = {f"{self.name}.{axis}": rates[..., i] for i, axis in zip(range(rates.shape[-1]), AXES, strict=False)}
        return found if self.attitude is None else found | moments_between(self.name, self.a.body, self.b.body, motion)


@dataclass(frozen=True)
class SliderDefinition(Definition):
    """A place stays on a line through another, fixed in the body of that; the bodies do not turn to each other.

    Attributes
    ----------
    normals : tuple of tuples of float
        Unit vectors across the line, in the axes of the body of `b`: one in the plane, two in space.
    attitude : ndarray or None
        See `attitude_to`; None of a track, and where one of them is a particle.
    """

    kind: ClassVar[str] = "slider"
    a: Place
    b: Place
    normals: tuple[tuple[float, ...], ...]
    attitude: Numbers | None = None

    def off(self, placement: Placement) -> Numbers:
        """Return how far the place is beside the line (m), shape (d - 1,)."""
        d = self.a.at(placement) - self.b.at(placement)
        return np.stack([dot(self.carried(placement, normal), d) for normal in self.normals], axis=-1)

    def carried(self, placement: Placement, direction: tuple[float, ...]) -> Numbers:
        """Return a direction that is fixed in the body of `b`; a particle carries directions of the ground."""
        pose = pose_of(placement, self.b.body)
        return carried(None if pose is None or pose.rotation is None else pose, direction)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        found = {"line": self.off(placement)}
        if self.attitude is None:
            return found
        return {**found, "attitude": attitude_to(placement, self.a.body, self.b.body) - self.attitude}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = rate(self.off, placement, motion)
        found = {f"{self.name}.normal": rates[..., 0]}
        if len(self.normals) > 1:
            found = {f"{self.name}.normal.{i + 1}": rates[..., i] for i in range(len(self.normals))}
        return found if self.attitude is None else found | moments_between(self.name, self.a.body, self.b.body, motion)


def moments_between(name: str, a: str | None, b: str | None, motion: Motion) -> dict[str, Numbers]:
    """Return the power of one unit of each component of the moment on body `a`, in space in the axes of space."""
    spins = [motion[body].spin for body in (a, b) if body is not None and body in motion]
    known = next(spin for spin in spins if spin is not None)
    first, second = (np.zeros_like(known) if body is None else motion[body].spin for body in (a, b))
    assert first is not None, "a body whose attitude is held turns"
    assert second is not None, "a body whose attitude is held turns"
    relative = first - second
    if relative.shape[-1:] == (3,):
        return {f"{name}.moment.{axis}": relative[..., i] for i, axis in enumerate(AXES)}
    return {f"{name}.moment": relative}


@dataclass(frozen=True)
class OnCircle(Definition):
    """A place stays on a circle or a sphere; the normal is positive outwards."""

    kind: ClassVar[str] = "track"
    place: Place
    centre: Place
    radius: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius

    def distance(self, placement: Placement) -> Numbers:
        """Return the distance from the centre (m), shape ()."""
        return length(self.place.at(placement) - self.centre.at(placement))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"circle": self.distance(placement) - self.radius}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.normal": rate(self.distance, placement, motion)}

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return (f"{self.name}.normal",)

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`."""
        n = (self.place.at(placement) - self.centre.at(placement)) / self.radius
        normal = forces[f"{self.name}.normal"]
        return {f"{self.name}.{axis}": normal * n[..., i] for i, axis in zip(range(n.shape[-1]), AXES, strict=False)}


@dataclass(frozen=True)
class OnPlane(Definition):
    """A place stays on a plane of space, or on a line of the plane, fixed in the body of `at` (its unit normal)."""

    kind: ClassVar[str] = "track"
    place: Place
    point: Place
    normal: tuple[float, ...]

    def height(self, placement: Placement) -> Numbers:
        """Return the height above the plane (m), shape ()."""
        pose = None if self.point.body is None else placement[self.point.body]
        pose = None if pose is None or pose.rotation is None else pose
        return dot(carried(pose, self.normal), self.place.at(placement) - self.point.at(placement))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"plane": self.height(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.normal": rate(self.height, placement, motion)}


@dataclass(frozen=True)
class OnParabola(Definition):
    """A place stays on y = curvature x^2/2, with x along `tangent` in the axes of the body of the vertex.

    On the ground the force on the place is answered in components; on a body it is not.
    """

    kind: ClassVar[str] = "track"
    place: Place
    vertex: Place
    tangent: tuple[float, ...]
    curvature: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`: the radius of curvature at the vertex."""
        return 1.0 / abs(self.curvature) if self.curvature else 0.0

    def height(self, placement: Placement) -> Numbers:
        """Return how far the place is above the curve, along its axis (m), shape ()."""
        d = self.place.at(placement) - self.vertex.at(placement)
        pose = None if self.vertex.body is None else placement[self.vertex.body]
        tangent = carried(None if pose is None or pose.rotation is None else pose, self.tangent)
        x, y = dot(tangent, d), dot(across(tangent), d)
        return y - self.curvature / 2 * x * x

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"parabola": self.height(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        if self.vertex.body is not None:
            return {}
        rates = self.place.velocity(placement, motion)
        return {f"{self.name}.{axis}": rates[..., i] for i, axis in enumerate("xy")}

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.holding`: along the normal of the curve, of which either component may be answered alone."""
        if self.vertex.body is not None:
            return {}
        return dict.fromkeys((f"{self.name}.x", f"{self.name}.y"), rate(self.height, placement, motion))

    def unanswered(self, placement: Placement, motion: Motion) -> tuple[Numbers, ...]:
        """See `Definition.unanswered`."""
        return () if self.vertex.body is None else (rate(self.height, placement, motion),)

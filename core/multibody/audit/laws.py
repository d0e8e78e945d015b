"""What pulls or drives by a law: springs, dampers, attraction, motors, spinning frames, constant forces and torques."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.between_places import BetweenPlaces, approach
from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.contacts import turn_between
from core.multibody.audit.definition import Definition
from core.multibody.audit.joints import AXES
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, cross, dot, spin_of


@dataclass(frozen=True)
class SpringDefinition(BetweenPlaces):
    """A linear spring (N/m, m)."""

    kind: ClassVar[str] = "spring"
    stiffness: float
    rest_length: float

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.force": self.stiffness * (self.distance(placement) - self.rest_length)}

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return float(np.sqrt(self.stiffness / least)) if least > 0.0 else 0.0

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.stiffness * (size + self.rest_length)

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        return self.stiffness / 2.0 * (self.distance(placement) - self.rest_length) ** 2


@dataclass(frozen=True)
class SpringWithoutLength(Definition):
    """A linear spring whose rest length is zero: its force on the first place has components."""

    kind: ClassVar[str] = "spring"
    a: Place
    b: Place
    stiffness: float

    def between(self, placement: Placement) -> Numbers:
        """Return the vector from the first place to the second (m)."""
        return self.b.at(placement) - self.a.at(placement)

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = self.b.velocity(placement, motion) - self.a.velocity(placement, motion)
        return {f"{self.name}.{axis}": -rates[..., i] for i, axis in zip(range(rates.shape[-1]), AXES, strict=False)}

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        pull = self.stiffness * self.between(placement)
        return {f"{self.name}.{axis}": pull[..., i] for i, axis in zip(range(pull.shape[-1]), AXES, strict=False)}

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return float(np.sqrt(self.stiffness / least)) if least > 0.0 else 0.0

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.stiffness * size

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        d = self.between(placement)
        return self.stiffness / 2.0 * dot(d, d)


@dataclass(frozen=True)
class DamperDefinition(BetweenPlaces):
    """A force against the rate of a distance (N s/m)."""

    kind: ClassVar[str] = "damper"
    coefficient: float

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.force": self.coefficient * approach(self.a, self.b, placement, motion)}

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        return self.coefficient / least if least > 0.0 else 0.0

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.coefficient * speed


@dataclass(frozen=True)
class Attraction(BetweenPlaces):
    """A force of strength/r^2 (N m^2)."""

    kind: ClassVar[str] = "inverse-square"
    strength: float

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.force": self.strength / self.distance(placement) ** 2}

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """See `Definition.quickness`."""
        distance = np.min(self.distance(placement))
        return float(np.sqrt(abs(self.strength) / least / distance**3)) if least > 0.0 else 0.0

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        found: Numbers = 2.0 * abs(self.strength) * size / self.distance(placement) ** 3
        return found

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        return -self.strength / self.distance(placement)


@dataclass(frozen=True)
class Twisting(Definition):
    """A moment between the turns of two bodies of the plane, or of one and the ground; it acts on the first."""

    a: str
    b: str | None

    def turn(self, placement: Placement) -> Numbers:
        """Return the turn of the first relative to the second (rad)."""
        return turn_between(placement, self.a, self.b)

    def turning(self, motion: Motion) -> Numbers:
        """Return the rate of that turn (rad/s)."""
        return np.asarray(spin_of(motion, self.a) - spin_of(motion, self.b))

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.torque": self.turning(motion)}


@dataclass(frozen=True)
class TorsionSpringDefinition(Twisting):
    """A linear spring between two turns (N m/rad, rad)."""

    kind: ClassVar[str] = "torsion-spring"
    stiffness: float
    rest_angle: float

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.stiffness * (self.turn(placement) - self.rest_angle)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.stiffness * (np.abs(self.turn(placement)) + abs(self.rest_angle))

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        return self.stiffness / 2.0 * (self.turn(placement) - self.rest_angle) ** 2


@dataclass(frozen=True)
class TurnDamper(Twisting):
    """A moment against the rate of a turn (N m s)."""

    kind: ClassVar[str] = "damper"
    coefficient: float

    def works(self) -> bool:
        """See `Definition.works`."""
        return True

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.laws`."""
        return {f"{self.name}.torque": -self.coefficient * self.turning(motion)}

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """See `Definition.law_size`."""
        return self.coefficient * speed


@dataclass(frozen=True)
class MotorDefinition(Twisting):
    """A turn has a given rate (rad/s)."""

    kind: ClassVar[str] = "motor"
    rate: float

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.rate != 0.0

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return abs(self.rate)

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.held_rates`."""
        return {"rate": self.turning(motion) - self.rate}


@dataclass(frozen=True)
class ConstantForce(Definition):
    """A constant force on a place (N)."""

    kind: ClassVar[str] = "force"
    place: Place
    force: tuple[float, ...]

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """See `Definition.load`."""
        return dot(self.place.velocity(placement, virtual), np.array(self.force))

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        return -dot(self.place.at(placement), np.array(self.force))


@dataclass(frozen=True)
class ConstantTorque(Definition):
    """A constant torque on a body (N m): in space a vector of one component per axis of space."""

    kind: ClassVar[str] = "torque"
    body: str
    torque: float | tuple[float, ...]

    def works(self) -> bool:
        """See `Definition.works`."""
        return isinstance(self.torque, tuple)

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """See `Definition.load`."""
        spin = np.asarray(spin_of(virtual, self.body))
        return dot(spin, np.array(self.torque)) if isinstance(self.torque, tuple) else spin * self.torque

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`; in space there is none."""
        turn = placement[self.body].turn
        return np.zeros(()) if turn is None or isinstance(self.torque, tuple) else -self.torque * turn


@dataclass(frozen=True)
class SpinningFrameDefinition(Definition):
    """Centrifugal and Coriolis forces in a frame that spins at a rate (rad/s) about an axis through `at`.

    Attributes
    ----------
    across : tuple of floats, or None
        In the plane about a vertical of the plane: the unit vector across that, along which particles are driven out.
        None about the normal of the plane, and in space, where it spins about the z axis.
    """

    kind: ClassVar[str] = "spinning-frame"
    rate: float
    at: tuple[float, ...]
    across: tuple[float, ...] | None
    parts: tuple[RigidBody, ...]

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return abs(self.rate)

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """See `Definition.load`."""
        total: Numbers = np.zeros(())
        for body in self.parts:
            if body.name not in virtual:
                continue
            force = body.mass * self._acceleration(placement[body.name].position, motion[body.name].velocity)
            total = total + dot(virtual[body.name].velocity, force)
            if body.inertia is not None and len(self.at) == 3:
                spin = np.asarray(spin_of(virtual, body.name))
                total = total + dot(spin, self._moment(body, placement, motion))
        return total

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`: that of the centrifugal force."""
        total: Numbers = np.zeros(())
        for body in self.parts:
            away = self._away(placement[body.name].position)
            total = total - body.mass * self.rate**2 / 2.0 * dot(away, away)
            rotation = placement[body.name].rotation
            if body.inertia is not None and len(self.at) == 3:
                assert rotation is not None, "a rigid body of space has an attitude"
                row = rotation[..., 2, :]
                total = total - self.rate**2 / 2.0 * dot(row @ body.inertia, row)
        return total

    def _away(self, position: Numbers) -> Numbers:
        away = position - np.array(self.at)
        if self.across is not None:
            e = np.array(self.across)
            out: Numbers = dot(away, e)[..., None] * e
            return out
        beside: Numbers = away * np.array([1.0, 1.0, 0.0][: len(self.at)])
        return beside

    def _acceleration(self, position: Numbers, velocity: Numbers) -> Numbers:
        away = self.rate**2 * self._away(position)
        if self.across is not None:
            # The force of Coriolis is at right angles to the plane, which holds the particles.
            return away
        turned = np.zeros_like(away + velocity)
        turned[..., 0], turned[..., 1] = velocity[..., 1], -velocity[..., 0]
        return away + 2.0 * self.rate * turned

    def _moment(self, body: RigidBody, placement: Placement, motion: Motion) -> Numbers:
        """Return the moment of the forces of the frame about the centre of mass.

        With J the tensor in the axes of the frame, w the angular velocity in it and W that of the frame, the rate of
        the angular momentum J (w + W) gives J w' + w x J w = M - (w x J W - J (w x W) + W x J (w + W)).
        """
        rotation = placement[body.name].rotation
        assert rotation is not None, "a rigid body of space has an attitude"
        assert body.inertia is not None, "only rigid bodies have a moment"
        tensor = rotation @ body.inertia @ np.swapaxes(rotation, -1, -2)
        w, frame = np.asarray(spin_of(motion, body.name)), np.array([0.0, 0.0, self.rate])

        def of(v: Numbers) -> Numbers:
            found: Numbers = np.einsum("...ij,...j->...i", tensor, v)
            return found

        return -(cross(w, of(frame)) - of(cross(w, frame)) + cross(frame, of(w + frame)))

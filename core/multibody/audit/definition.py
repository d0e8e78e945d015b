"""What a definition of a connection says: what it holds, what stays at or above zero, and how its forces act.

Forces are defined by their virtual power. A force of the answer whose value is F adds F times `efforts` to the power of
every virtual motion of the bodies; what the connection does by a law, `laws` gives the value of. Multiplied out, the
power of all forces is that of the rates of momentum and spin in every virtual motion: the laws of Newton and Euler.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, is_dataclass
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

from core.multibody.audit.placement import Motion, Numbers, Place, Placement, moved

NOTHING: Mapping[str, Numbers] = {}


class InPieces(Protocol):
    """A formula: its value, and its pieces."""

    def value(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the value, shape ()."""

    @property
    def switches(self) -> bool:
        """Whether it has functions of several pieces."""

    def undecided(self, placement: Placement, motion: Motion) -> Numbers:
        """Return whether a placement and its motion, moved by an imaginary step, do not tell its pieces, shape ()."""


@dataclass(frozen=True)
class Definition:
    """The textbook definition of one connection, with its numbers as doubles.

    Every method returns arrays without leading axes of their own; those of placement and motion come first. What is
    linear in the motion takes virtual motions, too.

    Attributes
    ----------
    name : str
        Of the connection in the answer.
    bodies : tuple of str
        Those that it acts on.
    """

    kind: ClassVar[str] = ""
    name: str
    bodies: tuple[str, ...]

    @property
    def members(self) -> tuple[Definition, ...]:
        """The definitions of which it consists, each with forces of its own: itself, if it is one."""
        return (self,)

    @cached_property
    def arm(self) -> float:
        """Largest offset of its places from centres of mass, or component of a place of the ground (m)."""
        return max([abs(x) for place in self.places for x in place.offset], default=0.0)

    @property
    def rolls(self) -> bool:
        """Whether it holds combinations of rates that are no rate of a measure."""
        return type(self).held_rates is not Definition.held_rates

    @property
    def holds(self) -> bool:
        """Whether it holds measures or combinations of rates."""
        return self.rolls or type(self).held is not Definition.held

    @property
    def opens(self) -> bool:
        """Whether it is one-sided."""
        return type(self).gaps is not Definition.gaps

    @property
    def strikes(self) -> bool:
        """Whether it acts by impulses alone."""
        return False

    @property
    def lawful(self) -> bool:
        """Whether some of its forces follow from places and rates."""
        return type(self).laws is not Definition.laws

    @property
    def derives(self) -> bool:
        """Whether some of its forces follow from others."""
        return type(self).derived is not Definition.derived

    @property
    def loads(self) -> bool:
        """Whether it has forces that the answer does not name."""
        return type(self).load is not Definition.load

    @property
    def formulas(self) -> tuple[InPieces, ...]:
        """The formulas by which its forces follow."""
        return ()

    @cached_property
    def switches(self) -> bool:
        """Whether formulas of its forces have several pieces."""
        return any(formula.switches for formula in self.formulas)

    def ahead(self, placement: Placement, motion: Motion) -> Placement:
        """Return a placement in which formulas of several pieces know which one follows; forces are then real parts."""
        return moved(placement, motion, in_time=True) if self.switches else placement

    def undecided(self, placement: Placement, motion: Motion) -> Numbers:
        """Return whether a placement and its motion, moved by an imaginary step, do not tell its pieces, shape ()."""
        none: Numbers = np.zeros((), dtype=bool)
        return sum((formula.undecided(placement, motion) for formula in self.formulas if formula.switches), none)

    @property
    def forces(self) -> tuple[str, ...]:
        """Names of the forces from which others follow."""
        return ()

    def own_rest(
        self, placement: Placement, motion: Motion, gains: Motion, forces: Mapping[str, Numbers]
    ) -> tuple[Numbers, Numbers] | None:
        """Return what is left over of the equation of motion of what has mass in it, and the size of its terms (N).

        None where nothing has mass.

        Parameters
        ----------
        gains : mapping of str to Twist
            Accelerations of the bodies.
        """
        return None

    @property
    def mass(self) -> float:
        """Of what it is itself (kg)."""
        return 0.0

    @property
    def coefficients(self) -> Touch | None:
        """Those of what is one-sided; None of what is held."""
        return None

    @property
    def excluded(self) -> str:
        """The name of what does not push while this does: of one side of a guide without play, the other."""
        return ""

    def steps(self, force: str) -> tuple[float, ...]:
        """Return by how much a gap or a force by a law may be off because whole turns are not counted (m, rad, N m)."""
        return ()

    def without_steps(self, force: str, missed: Numbers) -> Numbers:
        """Return what a force by a law misses, but for its steps."""
        for step in self.steps(force):
            missed = missed - step * np.round(missed / step)
        return missed

    def closed(self, state: Numbers | None, count: int) -> Numbers | None:
        """Return at which of some samples a gap is closed, by its state; None where the answer does not say.

        Parameters
        ----------
        state : ndarray of str, shape (count,), or None
        """
        return None if state is None else state != "open"

    @property
    def reach(self) -> float:
        """Length of what it has by itself: radii, the length of a rod or string (m)."""
        return 0.0

    def quickness(self, placement: Placement, masses: Mapping[str, float], least: float) -> float:
        """Return the largest rate of motion that its law makes (rad/s).

        Parameters
        ----------
        masses : mapping of str to float
            Of the bodies that have any (kg).
        least : float
            The smallest of them.
        """
        return self.driven

    def law_size(self, placement: Placement, size: float, speed: float) -> Numbers | float:
        """Return how large the terms of `laws` are whose difference its force is (N, N m).

        Parameters
        ----------
        size, speed : float
            Sizes of the places and the rates of its bodies (m, m/s).
        """
        return 0.0

    def coefficient_size(self, size: float) -> float:
        """Return how large the terms are whose difference its coefficients of friction are, 1 where these are given.

        Parameters
        ----------
        size : float
            Size of the places of its bodies (m).
        """
        return 1.0

    @property
    def driven(self) -> float:
        """Speed or rate that it prescribes (m/s, rad/s)."""
        return max((place.quickness or 0.0 for place in self.places), default=0.0)

    @property
    def drives(self) -> bool:
        """Whether it may bring energy while impulses act."""
        return self.driven > 0.0 or (self.works() and self.holds)

    def works(self) -> bool:
        """Return whether it takes or brings energy beside its potential: it does where a place is moved."""
        return any(place.quickness is not None for place in self.places)

    @cached_property
    def places(self) -> tuple[Place, ...]:
        """The places that it names."""
        return tuple(_places(tuple(vars(self).values())))

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """Return the measures that stay zero, in m or rad, by a name each; of several numbers, the last axis is theirs.

        A one-sided connection holds nothing.
        """
        return NOTHING

    def held_rates(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """Return combinations of rates that stay zero and are no rate of a measure: roll, and what a motor drives.

        They are affine in the motion: what is driven has a part that does not depend on it.
        """
        return NOTHING

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """Return the measures that stay at or above zero (m, rad), by the force that keeps them there."""
        return NOTHING

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """Return rates of slip (m/s) by the gap to which they belong, in space as a vector of the plane of contact."""
        return NOTHING

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """Return the power of one unit of each force of the answer in a motion, linear in the motion.

        A force that the answer gives in a second way, as components beside a normal, is in `derived`.
        """
        return NOTHING

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """Return the rates along which its forces hold bodies, by the forces: those of `efforts` that follow no law.

        A force that is answered in components may hold along its direction alone.
        """
        laws = self.laws(placement, motion) if self.lawful else NOTHING
        return {name: effort for name, effort in self.efforts(placement, motion).items() if name not in laws}

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """Return the values of the forces of the answer that follow from others of this connection.

        Parameters
        ----------
        forces : mapping of str to ndarray
            Those of `efforts`, as they are answered.
        """
        return NOTHING

    def unanswered(self, placement: Placement, motion: Motion) -> tuple[Numbers, ...]:
        """Return the rates of what is held by forces or moments that the answer does not name, linear in the motion."""
        return ()

    def laws(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """Return the values of the forces that follow from places and rates."""
        return NOTHING

    def load(self, placement: Placement, motion: Motion, virtual: Motion) -> Numbers:
        """Return the power, in a virtual motion, of forces that the answer does not name but the description gives."""
        return np.zeros(())

    def kinetic(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the kinetic energy of what has mass in it (J)."""
        return np.zeros(())

    @property
    def winds(self) -> bool:
        """Whether its potential depends on whole turns that placements do not tell."""
        return False

    def potential(self, placement: Placement) -> Numbers:
        """Return the potential energy (J)."""
        return np.zeros(())


def _places(values: Iterable[object]) -> Iterator[Place]:
    for value in values:
        if isinstance(value, Place):
            yield value
        elif isinstance(value, tuple):
            yield from _places(value)
        elif is_dataclass(value):
            yield from _places(vars(value).values())


@dataclass(frozen=True)
class Touch:
    """Coefficients of what is one-sided.

    Attributes
    ----------
    static, kinetic, restitution : float
    friction : tuple of str
        Names of the forces of friction: none, one in the plane, three in space.
    tangential : float
        Share of the slip that an impact turns back.
    law : str
        Of its impacts: "newton", "poisson" or "stronge".
    """

    static: float
    kinetic: float
    restitution: float
    friction: tuple[str, ...]
    law: str = "newton"
    tangential: float = 0.0

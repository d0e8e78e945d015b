"""What a definition of a connection says: what it holds, what stays at or above zero, and how its forces act.

Forces are defined by their virtual power. A force of the answer whose value is F adds F times `efforts` to the power of
every virtual motion of the bodies; what the connection does by a law, `laws` gives the value of. Multiplied out, the
power of all forces is that of the rates of momentum and spin in every virtual motion: the laws of Newton and Euler.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.placement import Motion, Numbers, Placement

NOTHING: Mapping[str, Numbers] = {}


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

    def potential(self, placement: Placement) -> Numbers:
        """Return the potential energy (J)."""
        return np.zeros(())


@dataclass(frozen=True)
class Touch:
    """Coefficients of what is one-sided.

    Attributes
    ----------
    static, kinetic, restitution : float
    friction : tuple of str
        Names of the forces of friction: none, one in the plane, three in space.
    """

    static: float
    kinetic: float
    restitution: float
    friction: tuple[str, ...]

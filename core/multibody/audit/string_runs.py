"""The course of a string through places and over drums: its straight parts, and how long it is between two marks.

A straight part from drum a to drum b, of radii R and senses of winding k, has with d from centre to centre and
o = k_a R_a - k_b R_b the length sqrt(d^2 - o^2), and the direction u for which d x u = -o. With theta the angle of u
and phi the turns of the drums, the string between two marks on it is as long as

    sqrt(d^2 - o^2) + k_a R_a (phi_a - theta) - k_b R_b (phi_b - theta) + constant:

what is wound on a drum is k R (phi - theta). On a drum over which the string slips phi does not enter, and the parts
before and after it leave the arc k R (theta_before - theta_after).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.multibody.audit.placement import Numbers, Place, Placement, Undefined, across, angle, dot, length


@dataclass(frozen=True)
class StringPoint:
    """What a string passes.

    Attributes
    ----------
    radius : float
        Of a drum; 0 of a place.
    drum : str or None
        The body whose turn winds the string; None of places, and where it slips.
    """

    place: Place
    radius: float = 0.0
    drum: str | None = None


@dataclass(frozen=True)
class Straight:
    """A straight part of a string.

    Attributes
    ----------
    senses : tuple of two ints
        In which sense it winds at its ends: 1 if the drum is on the right of the string, -1 if on the left, 0 without.
    start : tuple of two floats
        Its direction at the start.
    """

    a: StringPoint
    b: StringPoint
    senses: tuple[int, int] = (0, 0)
    start: tuple[float, ...] = ()

    @property
    def offset(self) -> float:
        """k_a R_a - k_b R_b (m)."""
        return self.senses[0] * self.a.radius - self.senses[1] * self.b.radius

    def between(self, placement: Placement) -> Numbers:
        """Return the vector from the first centre to the second (m)."""
        return self.b.place.at(placement) - self.a.place.at(placement)

    def direction(self, placement: Placement) -> tuple[Numbers, Numbers]:
        """Return the length of the part (m) and its direction, shapes () and (d,)."""
        d = self.between(placement)
        if not self.offset:
            size = length(d)
            return size, d / size[..., None]
        square = dot(d, d)
        size = np.sqrt(square - self.offset**2)
        return size, (size[..., None] * d - self.offset * across(d)) / square[..., None]

    def course(self, placement: Placement) -> Numbers:
        """Return the angle of its direction with that of the start, between -pi and pi (rad)."""
        return self._turned(self.direction(placement)[1])

    def _turned(self, u: Numbers) -> Numbers:
        x, y = self.start
        return angle(u[..., 0] * x + u[..., 1] * y, u[..., 1] * x - u[..., 0] * y)

    def extent(self, placement: Placement, turns: Numbers | float = 0.0) -> Numbers:
        """Return the length between marks on its ends, up to a constant (m).

        Parameters
        ----------
        turns : ndarray or float
            Whole turns of its direction since the start, beside the angle `course`.
        """
        if self.senses == (0, 0):
            return length(self.between(placement))
        found, u = self.direction(placement)
        if self.offset:
            found = found - self.offset * (self._turned(u) + 2.0 * np.pi * turns)
        for knot, sense in ((self.a, self.senses[0]), (self.b, -self.senses[1])):
            if knot.drum is not None and sense:
                turn = placement[knot.drum].turn
                assert turn is not None, "a drum that winds has a turn"
                found = found + sense * knot.radius * turn
        return found


@dataclass(frozen=True)
class StringRun:
    """What is between two ends, or drums without slip: one tension.

    Attributes
    ----------
    name : str
        Of the connection, and the number of the run where it has several.
    length : float
        What `extent` is at most, up to the whole turns of its parts (m).
    """

    name: str
    parts: tuple[Straight, ...]
    length: float

    def extent(self, placement: Placement) -> Numbers:
        """Return the sum of the extents of its parts (m), with courses between -pi and pi from the start."""
        return sum((part.extent(placement) for part in self.parts), np.zeros(()))

    def steps(self) -> tuple[float, ...]:
        """Return by how much the extent changes with one whole turn of the course of each part that has one (m)."""
        return tuple(2.0 * np.pi * part.offset for part in self.parts if part.offset)


def straight(a: StringPoint, b: StringPoint, sides: tuple[str | None, str | None], placement: Placement) -> Straight:
    """Return the straight part that touches the given sides of its drums at the start.

    Parameters
    ----------
    sides : tuple of two strings or None
        "left", "right", "below" or "above": where it touches the drum, as seen from the centre of that.

    Raises
    ------
    Undefined
        Where doubles do not show it.
    """
    for first in (1, -1) if a.radius else (0,):
        for second in (1, -1) if b.radius else (0,):
            part = Straight(a, b, (first, second), (1.0, 0.0))
            d = part.between(placement)
            if part.senses != (0, 0) and not dot(d, d) > part.offset**2:
                continue
            _, u = part.direction(placement)
            ways = [sense * across(u) for sense in part.senses]
            if all(side is None or _is_on(way, side) for way, side in zip(ways, sides, strict=True)):
                return Straight(a, b, (first, second), tuple(u.tolist()))
    # The description has been read: its sides decide the course of the string, but not in doubles.
    raise Undefined("a string whose course doubles do not resolve")


def _is_on(way: Numbers, side: str) -> bool:
    component, sign = {"left": (0, -1), "right": (0, 1), "below": (1, -1), "above": (1, 1)}[side]
    return bool(sign * way[component] > 0)


def run_of(
    name: str,
    knots: tuple[StringPoint, ...],
    sides: tuple[tuple[str | None, str | None], ...],
    given: float | None,
    start: Placement,
) -> StringRun:
    """Return a run through some knots, as long as it is at the start unless its length is given."""
    parts = tuple(straight(a, b, pair, start) for (a, b), pair in zip(pairwise(knots), sides, strict=True))
    run = StringRun(name, parts, 0.0)
    return StringRun(name, parts, float(run.extent(start)) if given is None else given)

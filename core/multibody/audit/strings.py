"""Strings through places and over drums, and heavy chains over a peg.

A straight part from drum a to drum b, of radii R and senses of winding k, has with d from centre to centre and
o = k_a R_a - k_b R_b the length sqrt(d^2 - o^2), and the direction u for which d x u = -o. With theta the angle of u
and phi the turns of the drums, the string between two marks on it is as long as

    sqrt(d^2 - o^2) + k_a R_a (phi_a - theta) - k_b R_b (phi_b - theta) + constant:

what is wound on a drum is k R (phi - theta). On a drum over which the string slips phi does not enter, and the parts
before and after it leave the arc k R (theta_before - theta_after).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.placement import (
    Motion,
    Numbers,
    Place,
    Placement,
    Undefined,
    across,
    angle,
    dot,
    length,
    rate,
    with_rate,
)


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
        _, u = self.direction(placement)
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
        found, _ = self.direction(placement)
        if self.offset:
            found = found - self.offset * (self.course(placement) + 2.0 * np.pi * turns)
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


@dataclass(frozen=True)
class StringDefinition(Definition):
    """An inextensible string: every run of it is at most as long as it is; tensions pull its places together."""

    kind: ClassVar[str] = "string"
    runs: tuple[StringRun, ...]
    touch: Touch

    @property
    def coefficients(self) -> Touch | None:
        """See `Definition.coefficients`."""
        return self.touch

    def steps(self, force: str) -> tuple[float, ...]:
        """See `Definition.steps`."""
        return next(run.steps() for run in self.runs if f"{run.name}.tension" == force)

    def closed(self, state: Numbers | None, count: int) -> Numbers | None:
        """See `Definition.closed`: where there are no phases, a string is taut all the time."""
        return np.ones(count, dtype=bool) if state is None else state != "open"

    @cached_property
    def reach(self) -> float:
        """See `Definition.reach`."""
        radii = [knot.radius for run in self.runs for part in run.parts for knot in (part.a, part.b)]
        return max(max(radii), *(abs(run.length) for run in self.runs))

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`.

        A string over drums may lack whole turns of the courses of its parts: see `StringRun.steps`.
        """
        return {f"{run.name}.tension": run.length - run.extent(placement) for run in self.runs}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{run.name}.tension": -rate(run.extent, placement, motion) for run in self.runs}


@dataclass(frozen=True)
class RubbingString(StringDefinition):
    """A string over fixed pegs, on which it rubs: its tension is the mean of those at its ends.

    Its friction, by which the tension grows from the first end to the last, slips with half of the difference of the
    rates of the parts at the ends; `touch` has the coefficients of that.
    """

    def works(self) -> bool:
        """See `Definition.works`."""
        return self.touch.static > 0.0

    def _passed(self, placement: Placement) -> Numbers:
        """Return half of what the first part is longer than the last (m)."""
        (run,) = self.runs
        return (run.parts[0].extent(placement) - run.parts[-1].extent(placement)) / 2.0

    def slips(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.slips`."""
        return {f"{self.name}.tension": rate(self._passed, placement, motion)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {
            **super().efforts(placement, motion),
            f"{self.name}.friction": rate(self._passed, placement, motion),
        }

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return f"{self.name}.tension", f"{self.name}.friction"

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the tensions at the ends."""
        mean, half = forces[f"{self.name}.tension"], forces[f"{self.name}.friction"] / 2.0
        return {f"{self.name}.1.tension": mean - half, f"{self.name}.2.tension": mean + half}


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


@dataclass(frozen=True)
class ChainDefinition(Definition):
    """A heavy chain over a small smooth peg of the ground, straight on both sides (kg/m, m).

    Attributes
    ----------
    ways : tuple of two tuples of two floats
        Directions of the sides from the peg.
    pulls : tuple of two floats
        Components of gravity along them (m/s^2).
    peg_pull : float
        Scalar product of gravity and the place of the peg (m^2/s^2).
    """

    kind: ClassVar[str] = "chain"
    ends: tuple[Place, Place]
    peg: tuple[float, ...]
    ways: tuple[tuple[float, ...], tuple[float, ...]]
    density: float
    length: float
    pulls: tuple[float, float]
    peg_pull: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.length

    @property
    def mass(self) -> float:
        """See `Definition.mass`."""
        return self.density * self.length

    def sides(self, placement: Placement) -> tuple[Numbers, Numbers]:
        """Return the lengths of the two sides (m)."""
        first, last = (dot(end.at(placement) - np.array(self.peg), np.array(way)) for end, way in self._both)
        return first, last

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        first, last = self.sides(placement)
        beside = self._beside(placement)
        return {"length": first + last - self.length, "line 1": beside[0], "line 2": beside[1]}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = rate(lambda where: np.stack(self.sides(where), axis=-1), placement, motion)
        return {f"{self.name}.{i + 1}.tension": -rates[..., i] for i in range(2)}

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return f"{self.name}.1.tension", f"{self.name}.2.tension"

    def own_rest(
        self, placement: Placement, motion: Motion, gains: Motion, forces: Mapping[str, Numbers]
    ) -> tuple[Numbers, Numbers] | None:
        """See `Definition.own_rest`: that of the chain along itself, between its ends."""
        if any(any(end.offset) for end in self.ends) or any(name not in forces for name in self.forces):
            return None
        first, last = self.sides(placement)
        gain = rate(lambda where: self.sides(where)[0], placement, gains)
        drawn = self.density * (self.pulls[0] * first - self.pulls[1] * last)
        tensions = [forces[name] for name in self.forces]
        rest = self.density * self.length * gain - drawn - tensions[0] + tensions[1]
        size = self.mass * (np.abs(gain) + sum(abs(pull) for pull in self.pulls))
        return rest, size + np.abs(tensions[0]) + np.abs(tensions[1])

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the tension at the peg, and how hard the chain presses on it."""
        z, speed = with_rate(lambda where: self.sides(where)[0], placement, motion)
        share = z / self.length
        hung = self.density * (self.pulls[0] + self.pulls[1]) * z * (1.0 - share)
        tension = forces[f"{self.name}.1.tension"] * (1.0 - share) + forces[f"{self.name}.2.tension"] * share + hung
        bend = float(np.linalg.norm(np.add(*self.ways)))
        pressed = (tension - self.density * speed**2) * bend
        return {f"{self.name}.tension": tension, f"{self.name}.normal": pressed}

    def unanswered(self, placement: Placement, motion: Motion) -> tuple[Numbers, ...]:
        """See `Definition.unanswered`."""
        rates = rate(lambda where: np.stack(self._beside(where), axis=-1), placement, motion)
        return tuple(rates[..., i] for i in range(2))

    def kinetic(self, placement: Placement, motion: Motion) -> Numbers:
        """See `Definition.kinetic`."""
        speed = rate(lambda where: self.sides(where)[0], placement, motion)
        return self.density * self.length / 2.0 * speed**2

    def potential(self, placement: Placement) -> Numbers:
        """See `Definition.potential`."""
        first, last = self.sides(placement)
        fall = -(self.pulls[0] * first * first + self.pulls[1] * last * last) / 2.0
        return self.density * (fall - self.length * self.peg_pull)

    def _beside(self, placement: Placement) -> tuple[Numbers, Numbers]:
        first, last = (dot(end.at(placement) - np.array(self.peg), across(np.array(way))) for end, way in self._both)
        return first, last

    @property
    def _both(self) -> tuple[tuple[Place, tuple[float, ...]], tuple[Place, tuple[float, ...]]]:
        return (self.ends[0], self.ways[0]), (self.ends[1], self.ways[1])

"""The first zero of what a motion is watched for: coordinates and rates by the reduced table, forces by the other.

The table as described is expanded only where forces are watched: it is larger, and a length that reaches zero is a
singular place of it, at which no force is known.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.motion.whole import Whole
from core.multibody.search.curves import Curve
from core.multibody.search.first_zero import FirstZero
from core.multibody.search.followed import Found
from core.multibody.search.pieces import Expanded, ExpandedPlaces, ExpandedWhole, Pieces

Quantity = Callable[[Pieces], Curve]


@dataclass(frozen=True)
class Watched:
    """A quantity that is watched.

    Attributes
    ----------
    along : callable
        The quantity along a motion.
    of_forces : bool
        Whether it depends on multipliers.
    jumps : bool
        Whether it matters that it only touches zero.
    singular : bool
        Whether its zero is a singular place of the table as described.
    power : int or None
        Of time with which it begins, where that is known: zero where it is above zero at the start.
    """

    along: Quantity
    of_forces: bool = False
    jumps: bool = False
    singular: bool = False
    power: int | None = None


@dataclass(frozen=True)
class Expansions:
    """Computations of one motion: of its coordinates and rates, and of these with its multipliers.

    Attributes
    ----------
    places, forces : sequence of Expanded
    coarse : two sequences of Expanded
        The same to a few roundings of doubles, where that is faster.
    """

    places: Sequence[Expanded]
    forces: Sequence[Expanded]
    coarse: tuple[Sequence[Expanded], Sequence[Expanded]] = ((), ())

    @classmethod
    def of(cls, runs: Sequence[tuple[Whole, str]], coordinates: Sequence[int] | None = None) -> Expansions:
        """Return those of a whole motion, by some of its runs; of places, those that some coordinates follow."""
        fast = runs if any(whole.is_faster_in_doubles for whole, _ in runs) else []
        coarse = (
            [ExpandedPlaces(*run, coarse=True, of=coordinates) for run in fast],
            [ExpandedWhole(*run, coarse=True) for run in fast],
        )
        places = [ExpandedPlaces(*run, of=coordinates) for run in runs]
        return cls(places, [ExpandedWhole(*run) for run in runs], coarse)

    def by(self, watched: Watched) -> Sequence[Expanded]:
        """Return those that know a quantity."""
        return self.forces if watched.of_forces else self.places


class FirstOfMotion:
    """A search along a motion from time zero on.

    Parameters
    ----------
    expansions : Expansions
    watched : sequence of Watched
    way : float
        -1 for the time before zero.
    """

    def __init__(self, expansions: Expansions, watched: Sequence[Watched], way: float = 1.0) -> None:
        self._numbers = [[i for i, one in enumerate(watched) if one.of_forces == forces] for forces in (False, True)]
        self._searches = [
            FirstZero(
                motions,
                [watched[i].along for i in numbers],
                [watched[i].jumps for i in numbers],
                [watched[i].power for i in numbers],
                way,
                coarse,
            )
            for motions, coarse, numbers in zip(
                (expansions.places, expansions.forces), expansions.coarse, self._numbers, strict=True
            )
        ]
        self._watched, self._places = watched, expansions.places

    @property
    def below(self) -> list[int]:
        """The quantities that are below zero from the start on."""
        both = zip(self._searches, self._numbers, strict=True)
        return [numbers[i] for search, numbers in both for i in search.below]

    def until(self, end: float) -> tuple[int, Found] | None:
        """Return the first zero up to a time and the number of its quantity, as `FirstZero.until` does."""
        best: tuple[int, Found] | None = None
        for search, numbers in zip(self._searches, self._numbers, strict=True):
            if best is not None:
                time = abs(best[1].time)
                end = min(end, time * BEFORE_SINGULAR if self._is_singular(best[1].time) else time)
            found = search.until(end)
            if found is not None and (best is None or abs(found.time) < abs(best[1].time)):
                best = numbers[found.index], found
        return best

    def _is_singular(self, time: float) -> bool:
        """Return whether something of which a zero is a singular place is about to vanish at a time of the motion."""
        lengths = [one.along for one in self._watched if one.singular]
        if not lengths:
            return False
        motion, soon = self._places[0], (1.0 - BEFORE_SINGULAR) * time
        pieces = motion(np.array([time]), np.array([soon]))
        curves = [along(pieces).values[0, :2, 0] for along in lengths]
        return any(abs(value) <= abs(change * soon / pieces.lengths[0]) for value, change in curves)

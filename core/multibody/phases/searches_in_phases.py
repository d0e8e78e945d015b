"""When a quantity takes a value, and how small and large it becomes, in a motion through events.

Between events a quantity is smooth, and searched as in any other motion. At an event it may jump: a value that is
jumped over is not taken, and both sides of a jump count for extremes. What takes its value at an event, up to what is
known of it, takes it there once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import NotApplicable
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.equations.packed import nearest
from core.multibody.phases.stretches import Stretch
from core.multibody.trajectory.columns import COLUMNS_OF_STATES
from core.multibody.trajectory.occurrences import (
    MOST_FOUND,
    ExtremesOf,
    Sampler,
    When,
    away_from_start,
    brackets,
    component,
    coordinates_of,
    extremes_on,
    located,
    unknown,
)
from core.systems.trajectory import Column, How

_SLOPE = 1e-6
"""Share of a stretch over which the slope at its end is formed."""


class SearchInPhases:
    """Searches in a motion.

    Parameters
    ----------
    pieces : sequence of Stretch
        Up to the time until which is searched.
    how : str
        How errors are known.
    """

    def __init__(self, pieces: Sequence[Stretch], how: How) -> None:
        self.pieces, self.how = pieces, how

    def _followed(self, search: When | ExtremesOf) -> Sequence[int] | None:
        """Return the coordinates that the quantity follows, None where it may be any."""
        return coordinates_of(search.quantity, self.pieces[0].phase.models[0].whole.measures.coordinates.frames)

    def occurrences(self, search: When, index: int) -> list[Occurrence]:
        """Return the times after the start at which a quantity takes a value."""
        wanted = MOST_FOUND if search.nth is None else search.nth
        found: list[Occurrence] = []
        for one in self._taken(search, self._samplers(search, index)):
            found.append(replace(one, nth=len(found) + 1))
            if len(found) == wanted:
                break
        return found if search.nth is None else found[search.nth - 1 : search.nth]

    def extremes(self, search: ExtremesOf, index: int) -> SceneExtremes:
        """Return the least and the largest value."""
        found: list[SceneExtremes] = []
        for piece, sampler in zip(self.pieces, self._samplers(search, index), strict=True):
            own = extremes_on(piece.grid(self._followed(search)), sampler, search.quantity)
            times = [nearest(piece.start + arb(t)) for t in (own.least_time, own.largest_time)]
            errors = {name: error + piece.late + 2.0**-52 * max(times) for name, error in own.errors.items()}
            found.append(replace(own, least_time=times[0], largest_time=times[1], errors=errors))
        low, high = min(found, key=lambda one: one.least), max(found, key=lambda one: one.largest)
        last = self.pieces[-1]
        return replace(
            low,
            largest=high.largest,
            largest_time=high.largest_time,
            error=max(low.error, high.error),
            errors={"least_time": low.errors["least_time"], "largest_time": high.errors["largest_time"]},
            until=nearest(last.start + arb(last.length)),
        )

    def _samplers(self, search: When | ExtremesOf, index: int) -> list[Sampler]:
        """Return the samplers of a quantity on every stretch."""
        known: dict[str, Column] = {}
        for group in COLUMNS_OF_STATES:
            columns = self.pieces[0].columns(np.zeros(1), self.how, group)
            known |= columns
            if component(columns, search.quantity) is not None:
                return [self._sampler(piece, group, search) for piece in self.pieces]
        raise unknown(search, index, known)

    def _sampler(self, piece: Stretch, group: str, search: When | ExtremesOf) -> Sampler:
        def sampled(times: Floats) -> Column:
            found = component(piece.columns(np.asarray(times, dtype=np.float64), self.how, group), search.quantity)
            if found is None:
                raise NotApplicable(
                    f"{search.quantity} is not determined in the phase that begins at {float(piece.start):.6g} s",
                    path=("outputs",),
                    remedy="ask for times before it, or for another quantity",
                )
            return found

        return sampled

    def _taken(self, search: When, samplers: Sequence[Sampler]) -> Iterator[Occurrence]:
        """Yield where the value is taken, in order."""
        for number, (piece, sampler) in enumerate(zip(self.pieces, samplers, strict=True)):
            grid = piece.grid(self._followed(search))
            if len(grid) < 2:
                continue
            column = sampler(grid)
            curve, noise = column.values - search.equals, 2.0 * column.error
            end = sampler(grid[-1:])
            curve[[0, -1]] = np.where(np.abs(curve[[0, -1]]) <= noise, 0.0, curve[[0, -1]])
            # What has the value all the time takes it no more.
            if np.all(np.abs(curve) <= noise):
                continue
            away = away_from_start(curve, noise)
            inside = brackets(grid[away:], curve[away:], sampler, search.equals, MOST_FOUND)
            if inside and inside[-1][0] == grid[-1]:
                inside.pop()
            for low, high in inside:
                one = located(sampler, search, low, high, 0)
                time = nearest(piece.start + arb(one.time))
                yield replace(one, time=time, error=one.error + piece.late + 2.0**-52 * abs(time))
            if curve[-1] == 0.0 or self._begins(number + 1, samplers, search):
                yield self._at_end(piece, sampler, search, end)

    def _begins(self, number: int, samplers: Sequence[Sampler], search: When) -> bool:
        """Return whether a stretch begins with the value, and another one follows it."""
        if number == len(samplers):
            return False
        start = samplers[number](np.array([0.0, self.pieces[number].length]))
        return abs(float(start.values[0]) - search.equals) <= 2.0 * start.error

    def _at_end(self, piece: Stretch, sampler: Sampler, search: When, end: Column) -> Occurrence:
        """Return the occurrence at the event that ends a stretch."""
        before = piece.length * (1.0 - _SLOPE)
        slope = abs(float(sampler(np.array([before])).values[0] - end.values[0])) / (piece.length - before)
        time = nearest(piece.start + arb(piece.length))
        off = min(end.error / slope if slope > 0.0 else piece.length, piece.length)
        error = off + piece.late + 2.0**-52 * abs(time)
        return Occurrence(search.quantity, search.equals, end.unit, 0, time, error, self.how)

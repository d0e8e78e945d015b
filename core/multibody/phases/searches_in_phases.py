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
    ValueSearch,
    component,
    require_in_range,
    unknown,
)
from core.multibody.trajectory.quantities import sought_in
from core.multibody.trajectory.search_along import Hit, Sampler, SearchAlong
from core.systems.trajectory import Column, How


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

    def occurrences(self, search: ValueSearch, index: int) -> list[Occurrence]:
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
            ends = sampler(np.array([0.0, piece.length]))
            require_in_range(search.quantity, ends.error, *ends.values)
            least, largest = self._along(piece, sampler, search).extremes()
            error = sampler(np.array([least.time, largest.time])).error
            times = [nearest(piece.start + arb(one.time)) for one in (least, largest)]
            errors = {
                name: one.error + piece.late + 2.0**-52 * time
                for name, one, time in zip(("least_time", "largest_time"), (least, largest), times, strict=True)
            }
            found.append(
                SceneExtremes(
                    search.quantity,
                    ends.unit,
                    least.value,
                    times[0],
                    largest.value,
                    times[1],
                    error,
                    piece.length,
                    False,
                    errors,
                )
            )
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

    def _samplers(self, search: ValueSearch | ExtremesOf, index: int) -> list[Sampler]:
        """Return the samplers of a quantity on every stretch."""
        known: dict[str, Column] = {}
        for group in COLUMNS_OF_STATES:
            columns = self.pieces[0].columns(np.zeros(1), self.how, group)
            known |= columns
            if component(columns, search.quantity) is not None:
                return [self._sampler(piece, group, search) for piece in self.pieces]
        raise unknown(search, index, known)

    def _sampler(self, piece: Stretch, group: str, search: ValueSearch | ExtremesOf) -> Sampler:
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

    def _along(self, piece: Stretch, sampler: Sampler, search: ValueSearch | ExtremesOf) -> SearchAlong:
        """Return the search along a stretch."""
        model = piece.phase.models[0]
        sought = sought_in(model.whole, piece.phase.determined)(search.quantity)
        assert sought is not None
        return SearchAlong(piece.expansions, sought, sampler, piece.length, piece.expanded)

    def _taken(self, search: ValueSearch, samplers: Sequence[Sampler]) -> Iterator[Occurrence]:
        """Yield where the value is taken, in order."""
        searched = [
            (piece, sampler, self._along(piece, sampler, search))
            for piece, sampler in zip(self.pieces, samplers, strict=True)
            if piece.length > 0.0
        ]
        for number, (piece, sampler, along) in enumerate(searched):
            column = sampler(np.array([0.0, piece.length]))
            require_in_range(search.quantity, column.error)
            at_end = None
            for hit in along.hits(search.value):
                if hit.time - piece.extent > hit.error:
                    break
                if hit.time - piece.extent < -hit.error:
                    yield self._occurrence(search, column.unit, piece, hit)
                else:
                    at_end = hit
            begins = number + 1 < len(searched) and searched[number + 1][2].starts_with(search.value)
            if at_end is None and begins and not along.has_throughout(search.value):
                at_end = Hit(piece.extent, 0.0)
            if at_end is not None:
                yield self._occurrence(search, column.unit, piece, at_end)

    def _occurrence(self, search: ValueSearch, unit: str, piece: Stretch, hit: Hit) -> Occurrence:
        time = nearest(piece.start + hit.time)
        error = hit.error + piece.late + float(hit.time.rad()) + 2.0**-52 * abs(time)
        return Occurrence(search.quantity, search.equals, unit, 0, time, error, self.how)

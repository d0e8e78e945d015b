"""When a quantity takes a value, and how small and large it becomes.

Between events a quantity is smooth. At an event it may jump: a value that is jumped over is not taken, and both sides
of a jump count for extremes. What takes its value at an event, up to what is known of it, takes it there once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, count, islice, pairwise

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import distance_bound
from core.errors import AccuracyUnreachable, NotApplicable
from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.equations.packed import nearest
from core.multibody.language.declared_units import Measured
from core.multibody.phases.phase_columns import ColumnsInPhases
from core.multibody.phases.stretches import Stretch, stretches
from core.multibody.search.pieces import PAST_A_PERIOD
from core.multibody.trajectory.column_errors import PLACES_BETWEEN, relative
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
from core.multibody.trajectory.search_along import Hit, SearchAlong
from core.systems.trajectory import Column, How

_WOUND = 2.0**-20
"""Share of the largest value by which what winds on differs from its start after a period, and nothing else does."""


@dataclass(frozen=True)
class _Part:
    """A quantity on a stretch.

    Attributes
    ----------
    unit : str
    period : ball or None
        After which the quantity is the same again; None where that is not shorter than the stretch.
    """

    stretch: Stretch
    along: SearchAlong
    unit: str
    period: Ball | None

    def hits(self, value: Ball) -> Iterator[Hit]:
        """Yield the times at which the quantity has a value; of one that repeats, those of a period again and again."""
        if self.period is None:
            yield from self.along.hits(value)
            return
        late = float(self.period.rad())
        once: list[Hit] = []
        again = 0
        for hit in replace(self.along, end=PAST_A_PERIOD * float(self.period)).hits(value):
            # What follows the end of a period follows the start, where it may not be known from the value there.
            image, earlier = hit.time - self.period, once[again] if again < len(once) else None
            if earlier is not None and abs(image - earlier.time) <= 2.0 * (hit.error + earlier.error + late):
                again += 1
            else:
                once.append(hit)
        for k in count():
            for hit in once:
                time = hit.time + k * self.period
                if time - hit.error > self.stretch.extent:
                    return
                yield Hit(arb(time.mid()), hit.error + k * late)
            if not once:
                return

    def extremes(self, quantity: str) -> SceneExtremes:
        """Return the least and the largest value on the stretch, or in a period."""
        until = self.stretch.length if self.period is None else float(self.period)
        ends = self.along.sampler(np.array([0.0, until]))
        require_in_range(quantity, ends.error, *ends.values)
        both = replace(self.along, end=until).extremes()
        error = max(one.known for one in both)
        times = [nearest(self.stretch.start + arb(one.time)) for one in both]
        # From the start of the scene a time is not rounded, but for the end of the stretch.
        extent = self.stretch.extent
        whole = is_zero(self.stretch.start) and (self.period is not None or is_zero(extent - arb(until)))
        share = 0.0 if whole else 2.0**-52
        late = [one.error + self.stretch.late + share * time for one, time in zip(both, times, strict=True)]
        return SceneExtremes(
            quantity,
            ends.unit,
            both[0].value,
            times[0],
            both[1].value,
            times[1],
            error,
            until,
            self.period is not None,
            # The end of a stretch is that of all that is searched, or one of several: see `Searches.extremes`.
            {
                "least_time": late[0],
                "largest_time": late[1],
                "until": 0.0 if self.period is None else _apart(self.period, until),
            },
        )


class Searches:
    """Searches between the start and a time: every quantity that is searched is as right as is requested.

    Parameters
    ----------
    columns : ColumnsInPhases
    end : float
        Latest time (s).
    how : str
        How errors are known.
    accuracy : float
        Largest error of a quantity, relative to the largest value in columns of its unit, that is tolerated.
    """

    def __init__(self, columns: ColumnsInPhases, end: float, how: How, accuracy: float) -> None:
        self.columns, self.end, self.how, self.accuracy = columns, end, how, accuracy
        self.stretches = list(stretches(columns.motion, end, finer=columns.finer))

    def occurrences(self, search: ValueSearch, index: int) -> list[Occurrence]:
        """Return the times after the start at which a quantity takes a value; it raises as `extremes` does."""
        group, name = self.column(search, index)
        column = self.stretches[0].columns(np.zeros(1), self.how, group)[name]
        Measured(column.unit).check(search.written, ("outputs", index, "when", "equals"), None)
        wanted = MOST_FOUND if search.nth is None else search.nth
        found: list[Occurrence] = []
        for one in islice(self._taken(search, self._parts(search, index)), wanted):
            found.append(replace(one, nth=len(found) + 1))
        return found if search.nth is None else found[search.nth - 1 : search.nth]

    def extremes(self, search: ExtremesOf, index: int) -> SceneExtremes:
        """Return the least and the largest value.

        Raises
        ------
        InvalidParameter
            For a quantity that the scene has not.
        AccuracyUnreachable
            Where pairs of doubles do not reach the accuracy either.
        """
        while True:
            one = self._extremes(search, index)
            # A quantity may be known much better at other times than where it is extreme.
            if one.error <= self.accuracy * max(abs(one.least), abs(one.largest)):
                return one
            group, name = self.column(search, index)
            reached = self._relative(group, name, one.error)
            if reached <= self.accuracy:
                return one
            self._refine(name, reached, index)

    def _extremes(self, search: ExtremesOf, index: int) -> SceneExtremes:
        found = [part.extremes(search.quantity) for part in self._parts(search, index)]
        last = self.stretches[-1]
        reached = last.start + last.extent
        until = nearest(reached)
        late = 0.0 if until == self.end else last.late + _apart(reached, until)
        if len(found) == 1:
            one = found[0]
            return one if one.periodic else replace(one, errors={**one.errors, "until": late})
        least, largest = min(found, key=lambda one: one.least), max(found, key=lambda one: one.largest)
        # The first of those that cannot be told apart, as on one stretch.
        low = next(one for one in found if one.least - least.least <= one.error + least.error)
        high = next(one for one in found if largest.largest - one.largest <= one.error + largest.error)
        return replace(
            low,
            largest=high.largest,
            largest_time=high.largest_time,
            error=max(low.error, high.error),
            errors={**low.errors, "largest_time": high.errors["largest_time"], "until": late},
            until=until,
            periodic=False,
        )

    def _parts(self, search: ValueSearch | ExtremesOf, index: int) -> Iterator[_Part]:
        """Yield a quantity on every stretch."""
        group, name = self.column(search, index)
        while (reached := self._relative(group, name)) > self.accuracy and np.isfinite(reached):
            # What leaves the range of doubles is refused where it is found.
            self._refine(name, reached, index)
        yield from (self._part(stretch, group, search.quantity) for stretch in self.stretches)

    def column(self, search: ValueSearch | ExtremesOf, index: int) -> tuple[str, str]:
        """Return the output that has a quantity, and the name of its column; it raises where the scene has not."""
        known: dict[str, Column] = {}
        for group in COLUMNS_OF_STATES:
            columns = self.stretches[0].columns(np.zeros(1), self.how, group)
            known |= columns
            if component(columns, search.quantity) is not None:
                return group, search.quantity if search.quantity in columns else search.quantity.rpartition(".")[0]
        raise unknown(search, index, known)

    def _part(self, stretch: Stretch, group: str, quantity: str) -> _Part:
        sampler = partial(self._sampled, stretch, group, quantity)
        ends = sampler(np.array([0.0, stretch.length]))
        require_in_range(quantity, ends.error)
        sought = sought_in(stretch.whole, stretch.phase.determined)(quantity)
        assert sought is not None
        expansions = stretch.expansions(sought.follows)
        along = SearchAlong(expansions, sought, sampler, stretch.length, stretch.expanded)
        parts = stretch.whole.parts_of(sought.follows)
        period = stretch.period(parts, stretch.length / PAST_A_PERIOD)
        # What only winds on in a motion that repeats, as an angle does, has another value after a period.
        if period is not None and any(stretch.whole.parts[k][1].winds_on for k in parts):
            period = None
        if period is not None:
            values = sampler(np.array([0.0, float(period), *(float(period) * PLACES_BETWEEN)])).values
            period = period if abs(values[1] - values[0]) <= _WOUND * np.max(np.abs(values)) else None
        return _Part(stretch, along, ends.unit, period)

    def _sampled(self, stretch: Stretch, group: str, quantity: str, times: Floats) -> Column:
        """Return a quantity at times since the start of a stretch."""
        found = component(stretch.columns(np.asarray(times, dtype=np.float64), self.how, group), quantity)
        if found is None:
            raise NotApplicable(
                f"{quantity} is not determined in the phase that begins at {float(stretch.start):.6g} s",
                path=("outputs",),
                remedy="ask for times before it, or for another quantity",
            )
        return found

    def _relative(self, group: str, name: str, error: float | None = None) -> float:
        """Return an error of a column, by default that at some times, relative to the largest value in its unit."""
        columns = replace(self.columns, outputs=(group,)).at(np.append(self.end * PLACES_BETWEEN, self.end))
        if name not in columns:
            # What is not determined in every phase is refused where it is sampled.
            return 0.0
        return relative({name: columns[name].error if error is None else error}, columns)

    def _refine(self, name: str, reached: float, index: int) -> None:
        """Go over to pairs of doubles where doubles do not reach the accuracy, and refuse what these do not reach."""
        if self.columns.finer or not self.columns.numerical:
            raise AccuracyUnreachable(
                self.accuracy,
                reached,
                f"rounding is amplified in {name}, by the motion or by what is computed of it in doubles",
                path=("outputs", index),
                remedy="ask for a shorter time" + (" or a larger accuracy" if reached < 1.0 else ""),
            )
        self.columns = replace(self.columns, finer=True)
        self.stretches = list(stretches(self.columns.motion, self.end, finer=True))

    def _taken(self, search: ValueSearch, parts: Iterator[_Part]) -> Iterator[Occurrence]:
        """Yield where the value is taken, in order."""
        searched = (part for part in parts if part.stretch.length > 0.0)
        for part, following in pairwise(chain(searched, [None])):
            assert part is not None
            extent, at_end = part.stretch.extent, None
            for hit in part.hits(search.value):
                if hit.time - extent > hit.error:
                    break
                if hit.time - extent < -hit.error:
                    yield self._occurrence(search, part, hit)
                else:
                    at_end = hit
            begins = following is not None and following.along.starts_with(search.value)
            if at_end is None and begins and not part.along.has_throughout(search.value):
                at_end = Hit(extent, 0.0)
            if at_end is not None:
                yield self._occurrence(search, part, at_end)

    def _occurrence(self, search: ValueSearch, part: _Part, hit: Hit) -> Occurrence:
        stretch = part.stretch
        time = min(nearest(stretch.start + hit.time), nearest(stretch.start + stretch.extent))
        error = hit.error + stretch.late + float(hit.time.rad()) + 2.0**-52 * abs(time)
        return Occurrence(search.quantity, search.equals, part.unit, 0, time, error, self.how)


def _apart(time: Ball, double: float) -> float:
    """Return a bound of the distance of a time from the double that is answered for it."""
    bound = distance_bound(time, double)
    assert bound is not None, "what is searched ends within the range of doubles"
    return bound

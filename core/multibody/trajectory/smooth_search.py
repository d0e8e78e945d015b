"""Searches along a motion without contacts: every quantity that is searched is as right as is requested."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count, islice

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import Ball
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.motion.whole import Whole
from core.multibody.search.first_of_motion import Expansions
from core.multibody.trajectory.along import period_within
from core.multibody.trajectory.column_errors import PLACES_BETWEEN, relative
from core.multibody.trajectory.columns import COLUMNS_OF_STATES, Columns
from core.multibody.trajectory.events import runs_of
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

_PAST = 1.0 + 2.0**-20
"""Share of a period that is searched: what touches a value at the start does so at the end."""
_WOUND = 2.0**-20
"""Share of the largest value by which what winds on differs from its start after a period, and nothing else does."""


@dataclass
class SmoothSearch:
    """Searches between the start and a time.

    Attributes
    ----------
    determined : sequence of bool
        Which of the forces the scene determines.
    end : float
        Latest time (s).
    accuracy : float
        Largest error of a quantity, relative to the largest value in columns of its unit, that is tolerated.
    numerical : bool
        Whether the motion may be computed in pairs of doubles in place of doubles; `finer`, whether it is.
    """

    whole: Whole
    how: How
    determined: Sequence[bool]
    end: float
    accuracy: float
    numerical: bool
    finer: bool

    def found(self, outputs: Sequence[object]) -> tuple[tuple[Occurrence, ...], tuple[SceneExtremes, ...]]:
        """Return what the searches among some outputs find.

        Raises
        ------
        InvalidParameter
            For a quantity that the scene has not.
        AccuracyUnreachable
            Where pairs of doubles do not reach the accuracy either.
        """
        times: list[Occurrence] = []
        ranges: list[SceneExtremes] = []
        for index, output in enumerate(outputs):
            if isinstance(output, ValueSearch):
                times.extend(self._occurrences(output, index))
            elif isinstance(output, ExtremesOf):
                ranges.append(self._extremes(output, index))
        return tuple(times), tuple(ranges)

    def _occurrences(self, search: ValueSearch, index: int) -> list[Occurrence]:
        """Return the times after the start at which a quantity takes a value."""
        along = self._along(search, index)
        column = along.sampler(np.array([0.0, self.end]))
        require_in_range(search.quantity, column.error)
        wanted = MOST_FOUND if search.nth is None else search.nth
        found = []
        for number, hit in enumerate(islice(self._hits(along, search.value), wanted), 1):
            if search.nth in (None, number):
                time = min(float(hit.time), self.end)
                error = hit.error + 2.0**-52 * time
                found.append(Occurrence(search.quantity, search.equals, column.unit, number, time, error, self.how))
        return found

    def _hits(self, along: SearchAlong, value: Ball) -> Iterator[Hit]:
        """Yield the times at which a quantity has a value; of one that repeats, those of a period again and again."""
        period = self._period(along)
        if period is None:
            yield from (hit for hit in along.hits(value) if not hit.time - hit.error > self.end)
            return
        late = float(period.rad())
        once: list[Hit] = []
        again = 0
        for hit in replace(along, end=_PAST * float(period)).hits(value):
            # What follows the end of a period follows the start, where it may not be known from the value there.
            image, earlier = hit.time - period, once[again] if again < len(once) else None
            if earlier is not None and abs(image - earlier.time) <= 2.0 * (hit.error + earlier.error + late):
                again += 1
            else:
                once.append(hit)
        for k in count():
            for hit in once:
                time = hit.time + k * period
                if time - hit.error > self.end:
                    return
                yield Hit(arb(time.mid()), hit.error + k * late)
            if not once:
                return

    def _extremes(self, search: ExtremesOf, index: int) -> SceneExtremes:
        """Return the least and the largest value between the start and the end, or of a period that is shorter."""
        along = self._along(search, index)
        period = self._period(along)
        end = self.end if period is None else float(period)
        column = along.sampler(np.array([0.0, end]))
        require_in_range(search.quantity, column.error, *column.values)
        least, largest = replace(along, end=end).extremes()
        error = along.sampler(np.array([least.time, largest.time])).error
        return SceneExtremes(
            search.quantity,
            column.unit,
            least.value,
            least.time,
            largest.value,
            largest.time,
            error,
            end,
            period is not None,
            {"least_time": least.error, "largest_time": largest.error},
        )

    def _period(self, along: SearchAlong) -> Ball | None:
        """Return the period of a quantity, None where it has none that is shorter than what is searched.

        What only winds on in a motion that repeats, as an angle does, has another value after a period.
        """
        motions = [self.whole.parts[k][1] for k in self.whole.parts_of(along.sought.follows)]
        period = period_within(motions, self.end / _PAST)
        if period is None or any(motion.winds_on for motion in motions):
            return None
        values = along.sampler(np.array([0.0, float(period), *(float(period) * PLACES_BETWEEN)])).values
        return period if abs(values[1] - values[0]) <= _WOUND * np.max(np.abs(values)) else None

    def _along(self, search: ValueSearch | ExtremesOf, index: int) -> SearchAlong:
        """Return the search along a quantity."""
        sampler = self._sampler(search, index)
        sought = sought_in(self.whole, self.determined)(search.quantity)
        assert sought is not None
        kinds = ("fine", "check") if self.finer and self.numerical else None
        runs = runs_of(self.whole) if kinds is None else [(self.whole, kind) for kind in kinds]
        return SearchAlong(Expansions.of(runs, sought.follows), sought, sampler, self.end)

    def _sampler(self, search: ValueSearch | ExtremesOf, index: int) -> Sampler:
        """Return the samples of a quantity, from the columns among which it is."""
        known: dict[str, Column] = {}
        for group in COLUMNS_OF_STATES:
            columns = self._columns(group, np.zeros(1))
            known |= columns
            if component(columns, search.quantity) is None:
                continue
            name = search.quantity if search.quantity in columns else search.quantity.rpartition(".")[0]
            self._require_reached(group, name, index)

            def sampled(times: Floats, group: str = group) -> Column:
                found = component(self._columns(group, np.asarray(times, dtype=np.float64)), search.quantity)
                assert found is not None
                return found

            return sampled
        raise unknown(search, index, known)

    def _columns(self, group: str, times: Floats) -> dict[str, Column]:
        states = self.whole.states(times, finer=self.finer)
        return Columns(self.whole, times, states, self.how).group(group, self.determined)

    def _require_reached(self, group: str, name: str, index: int) -> None:
        """Go over to pairs of doubles where doubles do not reach the accuracy, and refuse what these do not reach."""
        between = np.append(self.end * PLACES_BETWEEN, self.end)
        while True:
            columns = self._columns(group, between)
            reached = relative({name: columns[name].error}, columns)
            # What leaves the range of doubles is refused where it is found.
            if reached <= self.accuracy or not np.isfinite(reached):
                return
            if self.finer or not self.numerical:
                break
            self.finer = True
        raise AccuracyUnreachable(
            self.accuracy,
            reached,
            f"rounding is amplified in {name}, by the motion or by what is computed of it in doubles",
            path=("outputs", index),
            remedy="ask for a shorter time" + (" or a larger accuracy" if reached < 1.0 else ""),
        )

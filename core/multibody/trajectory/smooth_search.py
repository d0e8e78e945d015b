"""Searches along a motion without contacts: every quantity that is searched is as right as is requested."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.motion.whole import Whole
from core.multibody.trajectory.along import watched_times
from core.multibody.trajectory.column_errors import PLACES_BETWEEN, relative
from core.multibody.trajectory.columns import COLUMNS_OF_STATES, Columns
from core.multibody.trajectory.occurrences import (
    ExtremesOf,
    Sampler,
    When,
    component,
    coordinates_of,
    extremes,
    occurrences,
    unknown,
)
from core.systems.trajectory import Column, How


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
            if isinstance(output, When):
                of = coordinates_of(output.quantity, self.whole.measures.coordinates.frames)
                times.extend(
                    occurrences(watched_times(self.whole, self.end, of=of), self._sampler(output, index), output)
                )
            elif isinstance(output, ExtremesOf):
                ranges.append(extremes(self.whole, self._sampler(output, index), output.quantity, self.end))
        return tuple(times), tuple(ranges)

    def _sampler(self, search: When | ExtremesOf, index: int) -> Sampler:
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

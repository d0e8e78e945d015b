"""What an answer found by searching: the times at which a quantity takes a value, and its least and largest value."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from random import Random

import numpy as np

from core.multibody.answer import Occurrence, SceneExtremes, SceneSolution
from core.multibody.audit.failure import Ledger
from core.multibody.audit.placement import Numbers
from core.multibody.audit.samples import Columns
from core.systems.trajectory import MotionEvent

MOST_SEARCHED = 8
"""Occurrences whose values are compared: with a sample on either side they ask for two dozen times at most."""

ULPS = 2.0**-50
"""Share of a time by which the samples on either side are apart from it at least: a few doubles."""

Found = Occurrence | SceneExtremes


class SearchedQuantities:
    """Occurrences and extremes of an answer, with the times at which their values are compared.

    Parameters
    ----------
    end : float
        Time up to which there is a motion (s).
    """

    def __init__(self, answer: SceneSolution, random: Random, end: float) -> None:
        occurrences = list(answer.occurrences or ())
        if len(occurrences) > MOST_SEARCHED:
            occurrences = random.sample(occurrences, MOST_SEARCHED)
        self.all_occurrences, self.extremes = answer.occurrences or (), answer.extremes or ()
        self.jumps: Numbers = np.array(list(_jumps(answer.events))).reshape(-1, 2)
        self._compared: list[tuple[Found, float]] = [(one, one.equals) for one in occurrences]
        times = [(one.time, one.error) for one in occurrences]
        for one in self.extremes:
            self._compared += [(one, one.least), (one, one.largest)]
            times += [(one.least_time, 0.0), (one.largest_time, 0.0)]
        sides = [(t - max(d, ULPS * t), t, t + max(d, ULPS * t)) for t, d in times]
        self.times: Numbers = np.clip(np.array(sides).reshape(-1), 0.0, end)

    @property
    def names(self) -> list[str]:
        """The quantities that were searched for."""
        return [*(one.quantity for one in self.all_occurrences), *(one.quantity for one in self.extremes)]

    def check(self, ledger: Ledger, asked: Columns, times: Numbers, columns: Columns) -> None:
        """Compare what was found with the motion.

        Parameters
        ----------
        asked : mapping of str to Column
            At `self.times`, which are the last of its rows.
        times : ndarray, shape (n,)
        columns : mapping of str to Column
            Of the answer, at times of its own.
        """
        first = -len(self.times)
        for k, (one, expected) in enumerate(self._compared):
            found = quantity(asked, one.quantity)
            if found is None:
                continue
            value, error = found
            near = value[first + 3 * k : (first + 3 * k + 3) or None]
            off = max(float(near.min()) - expected, expected - float(near.max()), 0.0)
            known = error + one.error if isinstance(one, SceneExtremes) else error
            allowed = known + ledger.rounding * max(float(np.abs(near).max()), abs(expected))
            time = self.times[first + 3 * k + 1 :][:1]
            law = f"{'extreme' if isinstance(one, SceneExtremes) else 'value'} at its time"
            ledger.compare(law, one.quantity, time, np.array([off]), allowed)
        self._check_places(ledger, asked)
        for own in self.extremes:
            self._check_all(ledger, own, times, columns)
        for name, equals, group in _groups(self.all_occurrences):
            self._check_none_missed(ledger, name, equals, group, times, columns)

    def _check_places(self, ledger: Ledger, asked: Columns) -> None:
        """Require that bodies are at the times of extremes where they are said to be."""
        first = len(self._compared) - 2 * len(self.extremes)
        for k, one in enumerate(self.extremes):
            for side, places in enumerate((one.least_places, one.largest_places)):
                row = 3 * (first + 2 * k + side) + 1 - len(self.times)
                for name, place in places.items():
                    column = asked.get(f"{name}.position")
                    if column is None:
                        continue
                    off = np.linalg.norm(column.values[row] - np.array(place))
                    allowed = column.error + one.place_errors[name] + ledger.rounding * np.abs(place).max()
                    time = self.times[row : row + 1 or None]
                    ledger.compare("place of the extreme", name, time, np.array([off]), allowed)

    def _check_all(self, ledger: Ledger, one: SceneExtremes, times: Numbers, columns: Columns) -> None:
        """Require that no sample is beyond the extremes."""
        found = quantity(columns, one.quantity)
        if found is None:
            return
        value, error = found
        within = (times >= 0.0) & (one.periodic | (times <= one.until))
        beyond = np.maximum(np.maximum(value - one.largest, one.least - value), 0.0)[within]
        allowed = error + one.error + ledger.rounding * max(abs(one.least), abs(one.largest))
        ledger.compare("no sample beyond the extremes", one.quantity, times[within], beyond, allowed)

    def _check_none_missed(
        self, ledger: Ledger, name: str, equals: float, group: list[Occurrence], times: Numbers, columns: Columns
    ) -> None:
        """Require that the quantity passes its value no more often among the samples than is listed before them."""
        found = quantity(columns, name)
        if found is None:
            return
        value, error = found
        rest = value - equals
        sure = (times >= 0.0) & (np.abs(rest) > error + ledger.rounding * np.abs(value))
        order = np.argsort(times[sure], kind="stable")
        moments, side = times[sure][order], rest[sure][order] > 0.0
        changed = side[1:] != side[:-1]
        if not {"position", "angle"} & set(name.split(".")):
            # Rates and forces may jump at an event, and do not take the values between.
            begun, over = moments[1:, None] >= self.jumps[:, 0], moments[:-1, None] > self.jumps[:, 1]
            changed &= ~(begun & ~over).any(axis=1)
        passed = moments[1:][changed]
        numbers = [one.nth for one in group]
        for one in group:
            # The n-th lies behind n - 1 others.
            more = int((passed < one.time - one.error).sum()) - (one.nth - 1)
            ledger.compare("occurrences before this one", name, np.array([one.time]), np.array([max(more, 0)]), 0.0)
        if len(group) > 1 and numbers == list(range(1, len(group) + 1)):
            more = max(len(passed) - len(group), 0)
            ledger.compare(
                "occurrences up to the last sample", name, moments[-1:], np.full(len(moments[-1:]), more), 0.0
            )


def _jumps(events: Iterable[MotionEvent]) -> Iterator[tuple[float, float]]:
    """Yield the intervals in which rates jump: at an event, and from the last bounce that is listed to their limit."""
    last: dict[str, float] = {}
    for event in events:
        begin = last.get(event.name, 0.0) if event.kind == "settle" else event.time
        yield min(begin, event.time) - event.error, event.time + event.error
        last[event.name] = event.time


def _groups(found: tuple[Occurrence, ...]) -> Iterator[tuple[str, float, list[Occurrence]]]:
    groups: dict[tuple[str, float], list[Occurrence]] = defaultdict(list)
    for one in found:
        groups[one.quantity, one.equals].append(one)
    for (name, equals), group in groups.items():
        yield name, equals, group


def quantity(columns: Columns, name: str) -> tuple[Numbers, float] | None:
    """Return the values of a column, of a component of one or of its length, and their error; None without it."""
    column = columns.get(name)
    if column is not None:
        return None if column.values.ndim > 1 else (column.values, column.error)
    whole, _, part = name.rpartition(".")
    column = columns.get(whole)
    if column is None or column.values.ndim == 1:
        return None
    if part == "length":
        return np.sqrt((column.values**2).sum(axis=1)), column.error
    letters = "wxyz" if column.values.shape[1] == 4 else "xyz"[: column.values.shape[1]]
    return (column.values[:, letters.index(part)], column.error) if part in letters else None

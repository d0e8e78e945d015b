"""Steps of a motion that is followed numerically: polynomials in time, one after another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from core.arrays import Floats, Integers
from core.errors import AccuracyUnreachable, BudgetExceeded
from core.multibody.equations.packed import Units, state
from core.multibody.motion.series import DONE, FULL, LOST, SLOWED, sampled
from core.multibody.motion.series_pairs import sampled_pairs
from core.multibody.table.table import Table

MOST_STEPS = 20000
"""Steps that one part of a scene may take in one direction of time."""


@dataclass
class Run:
    """Steps in one direction: where they start, their coefficients, and what ended them before the time asked for.

    Attributes
    ----------
    starts : ndarray, shape (s + 1, 2)
        Times, as pairs, and the end of the last step.
    series : ndarray, shape (s, n, order + 1) or (s, n, order + 1, 2)
    singular : bool
        Whether a singular place did.
    slowed : bool
        Whether a slip that may end is beyond the unit of time.
    given_up : bool
        Whether another method goes on better.
    room : ndarray or None
        What the series is the first part of, where there is room for more.
    """

    starts: Floats
    series: Floats
    singular: bool = False
    slowed: bool = False
    given_up: bool = False
    room: Floats | None = field(default=None, repr=False)

    @property
    def end(self) -> float:
        """Time reached."""
        return float(self.starts[-1, 0])

    def followed_by(self, more: Run) -> Run:
        """Return the run whose last step, which ended at a time that was asked for, is replaced by those of another."""
        kept, total, room = len(self.series) - 1, len(self.series) - 1 + len(more.series), self.room
        if room is None or len(room) < total:
            # Twice as much, so that a run which grows step by step is not copied for each.
            room = np.empty((2 * total, *self.series.shape[1:]))
            room[:kept] = self.series[:kept]
        room[kept:total] = more.series
        starts = np.concatenate([self.starts[:kept], more.starts])
        return Run(starts, room[:total], more.singular, more.slowed, more.given_up, room)

    def which(self, times: Floats) -> Integers:
        """Return the step in which each time lies."""
        starts = self.starts[:, 0]
        forward = starts[-1] >= starts[0]
        found = np.searchsorted(starts if forward else -starts, times if forward else -times, side="right") - 1
        return np.clip(found, 0, len(self.series) - 1).astype(np.int64)


def run_by(
    steps: Callable[[Floats, Floats, Floats], tuple[int, int]],
    end: float,
    start: tuple[Floats, Floats],
    shape: tuple[int, ...],
    many: int,
    clock: Floats | None = None,
    before: int = 0,
    gives_up: Callable[[float], bool] | None = None,
) -> Run:
    """Return a run by a function that takes steps until its arrays are full.

    Parameters
    ----------
    steps : callable
        Moves a clock, fills in where steps start and their series; it returns how it ended, and the number of steps.
    end : float
        To what time they are.
    start : tuple of two ndarrays
        Places and rates at the start.
    shape : tuple of int
        Of the series of one step.
    many : int
        Steps for which there is room at once.
    clock : ndarray, shape (2,), optional
        When they start, as a pair; moved along. Zero if omitted.
    before : int
        How many were taken until then.
    gives_up : callable, optional
        Called whenever there is no more room for others, with how many all of the time takes if they stay as long:
        whether another method is better.

    Raises
    ------
    BudgetExceeded
        Where more steps would be needed than one part may take.
    AccuracyUnreachable
        Where the motion leaves the range of doubles.
    """
    clock = np.zeros(2) if clock is None else clock
    starts, series = [], []
    taken, ended, given_up, needed = 0, FULL, False, 0.0
    while ended == FULL and not given_up:
        if before + taken > MOST_STEPS:
            raise BudgetExceeded("steps", needed, MOST_STEPS, path=("times",), remedy="ask for a shorter time")
        chunk_starts, chunk = np.empty((many + 1, 2)), np.empty((many, *shape))
        ended, count = steps(clock, chunk_starts, chunk)
        starts.append(chunk_starts[:count])
        series.append(chunk[:count])
        taken += count
        if ended == FULL:
            needed = (before + taken) * end / float(clock[0])
            given_up = gives_up is not None and gives_up(needed)
    if ended == LOST:
        raise AccuracyUnreachable(None, np.inf, "the motion leaves the range of doubles", path=("times",))
    starts.append(clock[None, :].copy())
    singular, slowed = ended not in (DONE, SLOWED) and not given_up, ended == SLOWED
    if not taken:
        # A run of no duration has one step, so that the start can be evaluated.
        single = np.zeros((1, *shape))
        single[0, :, 0], single[0, :, 1] = start
        return Run(np.array([clock, clock]), single, singular, slowed)
    found = series[0] if len(series) == 1 else np.concatenate(series)
    return Run(np.concatenate(starts), found, singular, slowed, given_up)


def begun(table: Table, units: Units, since: Run | None) -> tuple[tuple[Floats, Floats], Floats, int]:
    """Return the state from which steps are taken, when, and how many were before: at the start, or on from a run.

    The last step of that, which ends at a time that was asked for, is taken once more.
    """
    if since is None:
        return state(table, units), np.zeros(2), 0
    last = since.series[-1]
    return (last[:, 0].copy(), last[:, 1].copy()), since.starts[-2].copy(), len(since.series) - 1


def evaluate(run: Run, times: Floats, tails: Floats | None = None) -> tuple[Floats, Floats]:
    """Return places and rates at times in the units of the arrays, as pairs of shape (t, n, 2).

    Parameters
    ----------
    tails : ndarray, shape (t,), optional
        What is left of the times beyond doubles, for a run in pairs.
    """
    n = run.series.shape[1]
    which = run.which(times)
    q, v = np.zeros((len(times), n, 2)), np.zeros((len(times), n, 2))
    if run.series.ndim == 3:
        first, second = np.empty((len(times), n)), np.empty((len(times), n))
        sampled(run.starts, run.series, np.ascontiguousarray(times), which, first, second)
        q[..., 0], v[..., 0] = first, second
    else:
        paired = np.zeros((len(times), 2))
        paired[:, 0] = times
        if tails is not None:
            paired[:, 1] = tails
        sampled_pairs(run.starts, run.series, paired, which, q, v)
    return q, v

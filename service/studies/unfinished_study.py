"""What is left of a study: stretches of members that are missing, in flight or suspect, and how long they should be."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from service.studies.study import Study

CHUNK_SECONDS = 0.5
"""Processor time that a stretch should take, unless many processes have to be supplied."""

SUPPLY_SECONDS = 0.025
"""Time in which the engine hands out a stretch and stores another, at most half of the time of a process."""

LEAST_SECONDS = 0.05
"""Processor time below which a stretch is not divided among processes."""

LARGEST_CHUNK = 100_000
"""Members of a stretch."""

Stretch = tuple[int, int]

TRIAL: Stretch = (0, 0)
"""Stands for the sample of members that is tried first, whose results are not stored."""


@dataclass(eq=False)
class UnfinishedStudy:
    """An unfinished study.

    Attributes
    ----------
    missing : deque of (int, int)
        Stretches that are not stored and not being computed.
    in_flight : mapping of future to stretch and when it was handed over
    suspects : deque of (int, int)
        Stretches that are to be tried alone.
    deaths : mapping
        How many processes a stretch has ended while it was alone.
    begun : bool
        Whether it is recorded as running, which it is once there is a cluster.
    tried : bool
        Whether a sample of the members has been handed over, which is done first.
    ended : int
        How many processes the study has ended.
    each : float
        Processor time of a member (s), as predicted and then as measured.
    request : bytes
    finishing : Future or None
        Of the damaged stretches, or the statistics where there are none.
    """

    study: Study
    missing: deque[Stretch]
    each: float
    request: bytes
    finishing: Future[tuple[list[Stretch], Any]] | None = None
    in_flight: dict[Any, tuple[Stretch, float]] = field(default_factory=dict)
    suspects: deque[Stretch] = field(default_factory=deque)
    deaths: dict[Stretch, int] = field(default_factory=dict)
    begun: bool = False
    tried: bool = False
    ended: int = 0

    @property
    def done(self) -> bool:
        """Whether nothing is left to be computed."""
        return self.tried and not (self.missing or self.suspects or self.in_flight)

    def next_stretch(self, processes: int) -> Stretch:
        """Take a stretch of about `stretch_seconds`, less where otherwise some processes would have none."""
        start, stop = self.missing.popleft()
        share = max(-(-(stop - start) // processes), int(LEAST_SECONDS / self.each))
        size = max(1, min(LARGEST_CHUNK, int(stretch_seconds(processes) / self.each), share))
        if start + size < stop:
            self.missing.appendleft((start + size, stop))
        return start, min(stop, start + size)


def stretch_seconds(processes: int) -> float:
    """Return the processor time that a stretch should take (s), for that many processes."""
    return max(CHUNK_SECONDS, SUPPLY_SECONDS * processes)


def gaps(stored: list[Stretch], count: int) -> Iterator[Stretch]:
    """Yield what lies between the stretches that are stored."""
    reached = 0
    for start, stop in stored:
        if start > reached:
            yield reached, start
        reached = max(reached, stop)
    if reached < count:
        yield reached, count

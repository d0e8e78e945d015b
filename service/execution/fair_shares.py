"""Which of the long computations go on now: the time is shared by client, equally and in quanta."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from typing import Generic, Protocol, TypeVar

QUANTUM = 0.1
"""Seconds for which a computation goes on before another has its turn: long against the stopping of a process (some
microseconds, and the refilling of its cache), short against what somebody notices."""


MOST_OF_A_CLIENT = 4
"""Computations of one client that take part: its next one waits until one of them ends."""

MOST = 32
"""Computations of all clients together: each holds the memory of its process."""


class Shared(Protocol):
    """What takes part."""

    @property
    def client(self) -> Hashable:
        """Whose it is."""

    @property
    def seconds(self) -> float:
        """For how long it has run until now (s)."""


T = TypeVar("T", bound=Shared)


class FairShares(Generic[T]):
    """Computations that share a number of processors, the client that has used least going first.

    A client is charged for the time that its computations have run (stride scheduling, which shares a processor as
    deficit round robin does: Waldspurger and Weihl, MIT/LCS/TM-528, 1995). A client that comes anew begins at the least
    charge of those who are there: it has saved nothing while it was away. Of one client's computations, the one that
    has run least goes first.
    """

    def __init__(self) -> None:
        # How much of each has been charged already, in the order in which they came.
        self._charged: dict[T, float] = {}
        self._used: dict[Hashable, float] = {}

    def __len__(self) -> int:
        return len(self._charged)

    def __contains__(self, entry: T) -> bool:
        return entry in self._charged

    def __iter__(self) -> Iterator[T]:
        return iter(self._charged)

    @property
    def full(self) -> bool:
        """Whether there is room for no other."""
        return len(self._charged) >= MOST

    def may_have_another(self, client: Hashable) -> bool:
        """Return whether a client may begin another one: always its first, more in half of the room."""
        own = sum(entry.client == client for entry in self._charged)
        return own == 0 or (own < MOST_OF_A_CLIENT and len(self._charged) < MOST // 2)

    def add(self, entry: T) -> None:
        """Have a computation take part; its time until now is charged."""
        self._charge()
        present = {other.client for other in self._charged}
        least = min((self._used[client] for client in present), default=0.0)
        if entry.client not in present:
            # A client that left with more than the least is still ahead of the others by it.
            self._used = {client: used for client, used in self._used.items() if client in present or used > least}
            self._used[entry.client] = max(least, self._used.get(entry.client, 0.0)) if present else 0.0
        self._charged[entry] = 0.0

    def remove(self, entry: T) -> None:
        """Have it take part no longer."""
        self._charge()
        self._charged.pop(entry, None)
        if not self._charged:
            self._used.clear()

    def chosen(self, processors: int, running: set[T]) -> list[T]:
        """Return what goes on now, on at most so many processors.

        While others wait, one client has at most half of the processors, but always one. What runs gives way only
        to what has had a quantum less.
        """
        self._charge()
        waiting: dict[Hashable, list[T]] = {}
        last_first = reversed(list(self._charged))
        for entry in sorted(last_first, key=lambda entry: (-_quanta(entry.seconds), entry in running)):
            waiting.setdefault(entry.client, []).append(entry)
        runs = {entry.client for entry in running}
        most, has = max(1, processors // 2), Counter[Hashable]()
        picked: list[T] = []
        while waiting and len(picked) < processors:
            below = [client for client in waiting if has[client] < most] or list(waiting)
            # One that runs is a quantum ahead of the others before it gives way.
            client = min(below, key=lambda client: self._used[client] + QUANTUM * (has[client] - (client in runs)))
            picked.append(waiting[client].pop())
            has[client] += 1
            if not waiting[client]:
                del waiting[client]
        return picked

    def _charge(self) -> None:
        for entry, charged in self._charged.items():
            seconds = entry.seconds
            self._used[entry.client] += seconds - charged
            self._charged[entry] = seconds


def _quanta(seconds: float) -> int:
    return int(seconds / QUANTUM)

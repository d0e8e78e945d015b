"""What waits for a turn: one queue per client, served in rotation, so that no client's requests delay another's."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Hashable, Iterator
from itertools import islice
from typing import Generic, TypeVar

T = TypeVar("T")


class FairQueue(Generic[T]):
    """First in, first out for each client; round robin among clients."""

    def __init__(self) -> None:
        # In the order in which the clients are served next.
        self._queues: OrderedDict[Hashable, deque[T]] = OrderedDict()

    def __len__(self) -> int:
        return sum(map(len, self._queues.values()))

    def __iter__(self) -> Iterator[T]:
        return (entry for queue in self._queues.values() for entry in queue)

    def append(self, client: Hashable, entry: T) -> None:
        """Put an entry behind the client's others."""
        self._queues.setdefault(client, deque()).append(entry)

    def put_back(self, client: Hashable, entry: T) -> None:
        """Put an entry that had its turn in front of everything."""
        self._queues.setdefault(client, deque()).appendleft(entry)
        self._queues.move_to_end(client, last=False)

    def pop(self) -> T:
        """Take the entry whose turn it is."""
        client, queue = next(iter(self._queues.items()))
        entry = queue.popleft()
        if queue:
            self._queues.move_to_end(client)
        else:
            del self._queues[client]
        return entry

    def remove(self, client: Hashable, entry: T) -> None:
        """Take an entry out, if it is there."""
        queue = self._queues.get(client)
        if queue is not None and entry in queue:
            queue.remove(entry)
            if not queue:
                del self._queues[client]

    def clear(self) -> None:
        """Take everything out."""
        self._queues.clear()

    def ahead_of(self, client: Hashable) -> Iterator[T]:
        """Yield what would be served before a new entry of a client: its own, and as many of each other client."""
        own = len(self._queues.get(client, ()))
        for other, queue in self._queues.items():
            yield from queue if other == client else islice(queue, own + 1)

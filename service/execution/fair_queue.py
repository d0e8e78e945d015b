"""What waits for a turn: one queue per client, served in rotation, so that no client's requests delay another's."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Callable, Hashable, Iterator, Sequence
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

    def pop(self, admitted: Callable[[T], bool]) -> T | None:
        """Take the first client's first entry that is admitted; None if no client's first entry is."""
        client = next((client for client, queue in self._queues.items() if admitted(queue[0])), None)
        if client is None:
            return None
        queue = self._queues[client]
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

    def of(self, client: Hashable) -> Sequence[T]:
        """Return what waits of a client, the first to be served first."""
        return self._queues.get(client, ())

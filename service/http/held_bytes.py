"""Memory that requests and answers take while clients send or read them, bounded in all and for each client."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from contextlib import contextmanager

from service.problems import Refusal

SHARE_OF_ONE = 0.5
"""Of the limit, which one client may hold: what it does not send or read refuses no other."""


class HeldBytes:
    """What is held, by client.

    Parameters
    ----------
    most : int
        Bytes of all clients above which no more is taken.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._of: Counter[Hashable] = Counter()

    @property
    def total(self) -> int:
        """Bytes of all clients."""
        return self._of.total()

    def add(self, client: Hashable, count: int) -> None:
        """Count bytes of a client; negative ones are let go."""
        self._of[client] += count
        if not self._of[client]:
            del self._of[client]

    @contextmanager
    def holding(self, client: Hashable, count: int) -> Iterator[None]:
        """Count bytes of a client as long as something is done."""
        self.add(client, count)
        try:
            yield
        finally:
            self.add(client, -count)

    def require_room(self, client: Hashable, *, close: bool = False) -> None:
        """Refuse more of a client (429); the connection is closed if it is to `close`."""
        own = int(SHARE_OF_ONE * self._most)
        if self._of[client] > own:
            detail = f"requests and unread answers of this client take more than {own} bytes, its share of the limit"
        elif self.total > self._most:
            detail = f"requests and unread answers take more than {self._most} bytes, the limit"
        else:
            return
        headers = (("Connection", "close"),) if close else ()
        raise Refusal("too-busy", f"{detail} max_held_bytes", headers=headers, retry_after=1.0)

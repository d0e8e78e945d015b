"""Memory that requests and answers take while clients send or read them, bounded in all and for each client."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Sequence
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

    Attributes
    ----------
    freed : callable
        Called when a client has more room for answers.
    """

    def __init__(self, most: int) -> None:
        self._most, self._own = most, int(SHARE_OF_ONE * most)
        self.freed: Callable[[], None] = lambda: None
        self._of: Counter[Hashable] = Counter()
        self._answers: Counter[Hashable] = Counter()

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

    def add_answer(self, client: Hashable, count: int) -> None:
        """Count bytes of a client's answers, which are among what it holds; negative ones are let go."""
        self.add(client, count)
        self._answers[client] += count
        if not self._answers[client]:
            del self._answers[client]
        if count < 0:
            self.freed()

    @contextmanager
    def answering(self, client: Hashable, count: int) -> Iterator[None]:
        """Count the bytes of an answer as long as its client reads it."""
        self.add_answer(client, count)
        try:
            yield
        finally:
            self.add_answer(client, -count)

    def may_answer(self, client: Hashable, count: int) -> bool:
        """Return whether a client may hold another answer: any where it has none, others within its share."""
        return client not in self._answers or self._answers[client] + count <= self._own

    @contextmanager
    def reserved(self, client: Hashable, count: int) -> Iterator[None]:
        """Count the bytes of an answer before it is made, or refuse it where its client has no room (429)."""
        if not self.may_answer(client, count):
            raise self._share_taken()
        with self.answering(client, count):
            yield

    def require_share(self, client: Hashable, headers: Sequence[tuple[str, str]] = ()) -> None:
        """Refuse more of a client that holds more than its share (429)."""
        if self._of[client] > self._own:
            raise self._share_taken(headers)

    def require_room(self, client: Hashable, *, close: bool = False) -> None:
        """Refuse more of a client (429); the connection is closed if it is to `close`."""
        headers = (("Connection", "close"),) if close else ()
        self.require_share(client, headers)
        if self.total > self._most:
            detail = f"requests and unread answers take more than {self._most} bytes, the limit max_held_bytes"
            raise Refusal("too-busy", detail, headers=headers, retry_after=1.0)

    def _share_taken(self, headers: Sequence[tuple[str, str]] = ()) -> Refusal:
        detail = f"requests and unread answers of this client take more than {self._own} bytes, its share"
        return Refusal("too-busy", f"{detail} of the limit max_held_bytes", headers=headers, retry_after=1.0)

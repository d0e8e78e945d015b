"""What a connection writes: head and body of a response in one, and none of it left for ever, or lost.

ASGI sends them one by one. Each write is a system call and a packet, and wakes the client: where the cores are shared,
the client then takes the core from the server to read half of the answer. uvicorn waits without limit for a client to
take what is left when a connection closes, or when the next answer is due.

A socket that closes with bytes in it that nobody has read, or receives more afterwards, resets the connection, and the
client may lose what it has not read yet (RFC 9112, 9.6). So what a client still sends is read and dropped for a while.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

LINGERING = 2.0
"""Seconds for which a connection drops what the client still sends of a body that is answered, and once more when it
closes: ten round trips around the world."""

MOST_DROPPED = 16_000_000
"""Bytes that are dropped at most in this time: two of the longest bodies that are answered by default."""


class OneWrite:
    """A transport that holds the first part of what is written until the second, and no longer than the loop's turn.

    Parameters
    ----------
    transport : asyncio.Transport
        Of the connection.
    loop : asyncio.AbstractEventLoop
        Which turns.
    patience : float
        Seconds for which a client may take nothing of what is left.
    sending : callable
        Returns whether the client may still be sending what is not going to be read.
    """

    __slots__ = ("_bearable", "_end", "_first", "_later", "_look", "_loop", "_patience", "_sending", "_transport")

    def __init__(
        self,
        transport: asyncio.Transport,
        loop: asyncio.AbstractEventLoop,
        patience: float,
        sending: Callable[[], bool],
    ) -> None:
        self._transport, self._later, self._first = transport, loop.call_soon, b""
        self._loop, self._patience, self._sending = loop, patience, sending
        self._look: asyncio.TimerHandle | None = None
        self._end: asyncio.TimerHandle | None = None
        self.begin_to_drop()

    def write(self, data: bytes) -> None:
        """Hold the first part; write it with the second; nothing behind the end."""
        if self._end is not None:
            return
        if self._first:
            data, self._first = self._first + data, b""
            self._transport.write(data)
        elif data:
            self._first = data
            self._later(self._flush)

    def close(self) -> None:
        """Write what is held, and close when the client has taken it, or takes no more, and sends no more."""
        self._flush()
        if self._end is not None:
            return
        if self._sending() and self._transport.can_write_eof() and not self._transport.is_closing():
            self._transport.write_eof()
            if not self._transport.is_reading():
                self._transport.resume_reading()
            self._end = self._loop.call_later(LINGERING, self._close)
        else:
            self._close()

    def is_closing(self) -> bool:
        """Return whether nothing is answered any more."""
        return self._end is not None or self._transport.is_closing()

    def begin_to_drop(self) -> None:
        """Count from now on what is dropped."""
        self._bearable = MOST_DROPPED

    def drop(self, data: bytes) -> None:
        """Read what nobody needs; no more of it than is bearable."""
        self._bearable -= len(data)
        if self._bearable < 0:
            self._close()

    def lost(self) -> None:
        """Wait for nothing: the connection is gone."""
        self.expect_nothing()
        if self._end is not None:
            self._end.cancel()

    def _close(self) -> None:
        self._transport.close()
        if self._look is None:
            self.expect_progress()

    def expect_progress(self) -> None:
        """Look from now on whether the client takes some of what is left, and abort where it does not for too long."""
        self.expect_nothing()
        left = self._transport.get_write_buffer_size()
        if left:
            self._look = self._loop.call_later(self._patience, self._progressed, left)

    def expect_nothing(self) -> None:
        """Look no longer."""
        if self._look is not None:
            self._look.cancel()
            self._look = None

    def _progressed(self, before: int) -> None:
        if self._transport.get_write_buffer_size() < before:
            self.expect_progress()
        else:
            self._look = None
            self._transport.abort()

    def _flush(self) -> None:
        if self._first:
            first, self._first = self._first, b""
            self._transport.write(first)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

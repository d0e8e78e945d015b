"""What a connection writes: head and body of a response in one, and none of it left for ever to who does not read.

ASGI sends them one by one. Each write is a system call and a packet, and wakes the client: where the cores are shared,
the client then takes the core from the server to read half of the answer. uvicorn waits without limit for a client to
take what is left when a connection closes, or when the next answer is due.
"""

from __future__ import annotations

import asyncio
from typing import Any


class OneWrite:
    """A transport that holds the first part of what is written until the second, and no longer than the loop's turn."""

    __slots__ = ("_first", "_later", "_look", "_loop", "_patience", "_transport")

    def __init__(self, transport: asyncio.Transport, loop: asyncio.AbstractEventLoop, patience: float) -> None:
        self._transport, self._later, self._first = transport, loop.call_soon, b""
        self._loop, self._patience = loop, patience
        self._look: asyncio.TimerHandle | None = None

    def write(self, data: bytes) -> None:
        """Hold the first part; write it with the second."""
        if self._first:
            data, self._first = self._first + data, b""
            self._transport.write(data)
        elif data:
            self._first = data
            self._later(self._flush)

    def close(self) -> None:
        """Write what is held, and close when the client has taken it, or takes no more."""
        self._flush()
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

"""A connection under uvicorn that is closed when no request begins on it in time, and that answers in one write.

uvicorn has that limit between two requests; it has none before the first, nor while a head arrives piece by piece. It
writes head and body of a response one by one, as ASGI sends them. Each write is a system call and a packet, and wakes
the client: where the cores are shared, the client then takes the core from the server to read half of the answer.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.zttp_impl import ZttpProtocol


class OneWrite:
    """A transport that holds the first part of what is written until the second, and no longer than the loop's turn."""

    __slots__ = ("_first", "_later", "_transport")

    def __init__(self, transport: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        self._transport, self._later, self._first = transport, loop.call_soon, b""

    def write(self, data: bytes) -> None:
        """Hold the first part; write it with the second."""
        if self._first:
            data, self._first = self._first + data, b""
            self._transport.write(data)
        elif data:
            self._first = data
            self._later(self._flush)

    def close(self) -> None:
        """Write what is held, and close."""
        self._flush()
        self._transport.close()

    def _flush(self) -> None:
        if self._first:
            first, self._first = self._first, b""
            self._transport.write(first)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)


class Connection(ZttpProtocol):
    """The protocol of uvicorn whose parser bounds the memory of a connection, with one more use of its keep-alive time.

    The head of a request has to be complete within that time from its first byte, the first request from the opening of
    the connection.
    """

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first request."""
        super().connection_made(OneWrite(transport, self.loop))  # type: ignore[arg-type]
        self._limit()

    def data_received(self, data: bytes) -> None:
        """Pass bytes on; while they are not yet a request, the time that is left is not prolonged."""
        super().data_received(data)
        if self.cycle is not None and not self.cycle.response_complete:
            self._unlimit()
        elif self._late is None:
            self._limit()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._unlimit()
        super().connection_lost(exc)

    def _limit(self) -> None:
        self._late = self.loop.call_later(self.timeout_keep_alive, self.transport.close)

    def _unlimit(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

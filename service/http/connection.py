"""A connection under uvicorn: closed when no request begins on it in time, answering in one write, refusing in JSON.

uvicorn has that limit between two requests; it has none before the first, nor while a head arrives piece by piece. It
writes head and body of a response one by one, as ASGI sends them. Each write is a system call and a packet, and wakes
the client: where the cores are shared, the client then takes the core from the server to read half of the answer.
It refuses what is no request in plain text, and fails on a path that is not in ASCII and on what follows an answer.
It waits without limit for a client to take what is left when a connection closes, or when the next answer is due.
"""

from __future__ import annotations

import asyncio
from typing import Any

import zttp
from uvicorn.protocols.http.zttp_impl import ZttpProtocol

from service.problems import MEDIA_TYPE, REGISTRY, Problem

_REFUSAL = Problem(
    REGISTRY["malformed-request"], "the head of the request or the framing of its body cannot be read, or is too long"
).body()
_REFUSED = [
    (b"content-type", MEDIA_TYPE.encode()),
    (b"content-length", b"%d" % len(_REFUSAL)),
    (b"x-content-type-options", b"nosniff"),
    (b"connection", b"close"),
]


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


class Connection(ZttpProtocol):
    """The protocol of uvicorn whose parser bounds the memory of a connection, with one more use of its keep-alive time.

    The head of a request has to be complete within that time from its first byte, the first request from the opening of
    the connection.
    """

    _late: asyncio.TimerHandle | None = None
    _out: OneWrite

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first request."""
        self._out = OneWrite(transport, self.loop, self.timeout_keep_alive)
        super().connection_made(self._out)  # type: ignore[arg-type]
        self._limit()

    def pause_writing(self) -> None:
        """Wait for the client to take what is written, not for ever."""
        super().pause_writing()
        self._out.expect_progress()

    def resume_writing(self) -> None:
        """Write on."""
        super().resume_writing()
        self._out.expect_nothing()

    def data_received(self, data: bytes) -> None:
        """Pass bytes on; while they are not yet a request, the time that is left is not prolonged."""
        super().data_received(data)
        if self.cycle is not None and not self.cycle.response_complete:
            self._unlimit()
        elif self._late is None:
            self._limit()

    def handle_events(self, event: zttp.Event) -> None:
        """Begin requests; what uvicorn cannot decode is refused."""
        try:
            super().handle_events(event)
        except UnicodeDecodeError:
            self.handle_remote_protocol_error()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is no request, and close; of a request that is being answered, or was, nothing can be said."""
        if self.cycle is not None and self.cycle.response_complete and self.cycle.more_body:
            self.transport.close()
            return
        try:
            self.conn.send_response(400, _REFUSED)
        except zttp.LocalProtocolError:
            self.transport.abort()
            return
        self.conn.send_data(_REFUSAL)
        self.conn.end_message()
        self.transport.write(self.conn.data_to_send())
        self.transport.close()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._unlimit()
        self._out.expect_nothing()
        super().connection_lost(exc)

    def _limit(self) -> None:
        self._late = self.loop.call_later(self.timeout_keep_alive, self.transport.close)

    def _unlimit(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

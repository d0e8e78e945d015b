"""A connection under uvicorn: closed when no request begins on it in time, refusing in JSON what is no request.

uvicorn has that limit between two requests; it has none before the first, nor while a head arrives piece by piece. It
refuses what is no request in plain text, and fails on a path that is not in ASCII and on what follows an answer.
"""

from __future__ import annotations

import asyncio

import zttp
from uvicorn.protocols.http.zttp_impl import ZttpProtocol

from service.http import one_write
from service.http.one_write import OneWrite
from service.problem_types import REGISTRY
from service.problems import MEDIA_TYPE, Problem

_REFUSAL = Problem(
    REGISTRY["malformed-request"], "the head of the request or the framing of its body cannot be read, or is too long"
).body()
_REFUSED = [
    (b"content-type", MEDIA_TYPE.encode()),
    (b"content-length", b"%d" % len(_REFUSAL)),
    (b"x-content-type-options", b"nosniff"),
    (b"connection", b"close"),
]


class Connection(ZttpProtocol):
    """The protocol of uvicorn whose parser bounds the memory of a connection, with one more use of its keep-alive time.

    The head of a request has to be complete within that time from its first byte, the first request from the opening of
    the connection.
    """

    _late: asyncio.TimerHandle | None = None
    _rest: asyncio.TimerHandle | None = None
    _refused = False
    _out: OneWrite

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first request."""
        self._out = OneWrite(transport, self.loop, self.timeout_keep_alive, self._unread)
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
        if self.transport.is_closing():
            self._out.drop(data)
            return
        answered = self.cycle
        if self._rest is not None:
            self._out.drop(data)
            if self.transport.is_closing():
                return
        super().data_received(data)
        if self._rest is not None and (self.cycle is not answered or not self.cycle.more_body):
            self._expect_no_rest()
        if self.cycle is not None and not self.cycle.response_complete:
            self._unlimit()
        elif self._late is None:
            self._limit()

    def on_response_complete(self) -> None:
        """Drop what is left of a body that was answered early, for a while; a longer one ends the connection."""
        super().on_response_complete()
        if self.cycle.more_body and not self.transport.is_closing():
            self._out.begin_to_drop()
            self._rest = self.loop.call_later(one_write.LINGERING, self.transport.close)

    def handle_events(self, event: zttp.Event) -> None:
        """Begin requests; what uvicorn cannot decode is refused."""
        try:
            super().handle_events(event)
        except UnicodeDecodeError:
            self.handle_remote_protocol_error()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is no request, and close; of a request that is being answered, or was, nothing can be said."""
        self._refused = True
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
        self._expect_no_rest()
        self._out.lost()
        super().connection_lost(exc)

    def _unread(self) -> bool:
        """Return whether the client may still be sending what is not read: it was refused, or answered early."""
        return self._refused or (self.cycle is not None and self.cycle.more_body)

    def _limit(self) -> None:
        self._late = self.loop.call_later(self.timeout_keep_alive, self.transport.close)

    def _unlimit(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _expect_no_rest(self) -> None:
        if self._rest is not None:
            self._rest.cancel()
            self._rest = None

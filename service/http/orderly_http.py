"""HTTP/1.1 as uvicorn serves it, where it is not to be done otherwise.

Six things are done otherwise:

- A request that offers to go on in another protocol is answered in this one, as RFC 9110, 7.8, has it. The parser stops
  at the end of its headers and takes its body, and all that is pipelined behind it, for the other protocol; clients
  that offer HTTP/2 with every request would never be heard.
- Fields behind a chunked body are no headers (RFC 9110, 6.5.1): who looks at headers in front of the server, or limits
  them, does not see these.
- A client that leaves is missed by the request that is being answered, not only by the last it has sent: its
  computation is stopped.
- What is no HTTP is answered in its turn: what came before it was accepted, and may be answered by half.
- What lies behind requests that wait is not parsed before their turn, and little of it is read: a request that waits
  takes a hundred times the room of its bytes, and there is no end to what a client may send without reading.
- A head, or the fields behind a body, may have so many bytes and no more: the parser keeps them all.
"""

from __future__ import annotations

import sys
from asyncio import BaseTransport, Event
from collections.abc import Sequence
from functools import partial
from typing import Any

from httptools import HttpRequestParser
from uvicorn._types import ASGI3Application, ASGIReceiveCallable, ASGISendCallable, Scope
from uvicorn.protocols.http.flow_control import FlowControl
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle

from service.http.request_context import PIECES

PARSED_AT_ONCE = 4_096
"""Bytes, at most: each request that they hold is begun, or waits."""

MOST_BEHIND = 65_536
"""Bytes behind requests that wait, beyond which the client is not read."""

LONGEST_HEAD = 65_536
"""Bytes of a head, or of the fields behind a body, beyond which a request is refused."""

_TOO_LONG = f"A request with more than {LONGEST_HEAD} bytes of headers is not read."


class Flow(FlowControl):
    """Flow control that does not read as long as much of what has been read waits to be parsed."""

    full = False
    """Whether it does."""

    def resume_reading(self) -> None:
        """Read on, if there is room."""
        if not self.full:
            super().resume_reading()


class OrderlyProtocol(HttpToolsProtocol):
    """One connection, of which everything is parsed."""

    flow: Flow

    _declined: tuple[bytes, int] | None = None
    """Headers of a request without the offer to upgrade, and the place in what was received where they ended."""

    _answered: RequestResponseCycle | None = None
    """The last request that has been begun to be answered, behind which others may wait."""

    _senseless = False
    """Whether something has arrived that is no HTTP, so that nothing behind it can be understood."""

    _behind = b""
    """What has arrived behind requests that wait."""

    _lines = 0
    """How many bytes have been parsed that neither completed a head nor belonged to a body."""

    def connection_made(self, transport: BaseTransport) -> None:
        """Begin a connection."""
        super().connection_made(transport)  # type: ignore[arg-type]
        self.flow = Flow(self.transport)

    def connection_lost(self, exc: Exception | None) -> None:
        """Tell who answers that the client has gone."""
        super().connection_lost(exc)
        cycle = self._answered
        if cycle is not None and not cycle.response_complete:
            cycle.disconnected = True
            cycle.message_event.set()

    def send_400_response(self, msg: str) -> None:
        """Answer what is no HTTP, after what came before it."""
        self._senseless = True
        cycle, begun = self.cycle, self._begun and self.cycle.more_body
        if begun and self.pipeline:
            # It is the last that came, and nothing has been done about it.
            self.pipeline[0] = cycle, partial(not_understood, msg.encode())
        elif begun and cycle.response_complete:
            self.transport.close()
        elif begun and cycle.response_started:
            cycle.keep_alive = False
        elif begun or cycle is None or cycle.response_complete:
            super().send_400_response(msg)
        else:
            self.cycle = RequestResponseCycle(
                scope={**cycle.scope, "method": "GET"},
                transport=self.transport,
                flow=self.flow,
                logger=self.logger,
                access_logger=self.access_logger,
                access_log=False,
                default_headers=self.server_state.default_headers,
                message_event=Event(),
                expect_100_continue=False,
                keep_alive=False,
                on_response=self.on_response_complete,
            )
            self.pipeline.appendleft((self.cycle, partial(not_understood, msg.encode())))

    def on_headers_complete(self) -> None:
        """Begin to answer; fields that are read from now on until the next request are none of its headers."""
        super().on_headers_complete()
        self._lines = 0
        if self._begun:
            self.headers = []

    def on_body(self, body: bytes) -> None:
        """Hand over a part of a body."""
        self._lines = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Hand over the end of a body, and close the connection after the response if fields behind it say so."""
        if self.headers and self._begun and not self.parser.should_keep_alive():
            # The parser skips all that follows, which would wait for its answers.
            self.cycle.keep_alive = False
            if self.cycle.response_complete:
                self.shutdown()
        super().on_message_complete()
        self._lines = 0

    def on_response_complete(self) -> None:
        """Let go of the request, and go on with the next, or with what has arrived behind all that waited."""
        if self._answered is not None:
            # The one reference that would keep the cycle until the collector of garbage finds it.
            self._answered.scope.pop("extensions", None)
        super().on_response_complete()
        if self._behind and not self.pipeline and not self._lost:
            behind, self._behind = self._behind, b""
            self.flow.full = False
            self.flow.resume_reading()
            self._parse(behind)

    @property
    def _begun(self) -> bool:
        """Whether the last message of which something has been read is a request whose headers are complete."""
        return self.cycle is not None and self.cycle.scope is self.scope

    @property
    def _lost(self) -> bool:
        """Whether nothing that comes now will be answered."""
        return self._senseless or self.transport.is_closing()

    def data_received(self, data: bytes) -> None:
        """Parse what has arrived, unless nothing can be understood any more."""
        if not self._senseless:
            self._parse(data)

    def _parse(self, data: bytes) -> None:
        """Parse what has arrived, up to a request that has to wait."""
        if len(data) <= PARSED_AT_ONCE and not self.pipeline:
            self._feed(data)
            return
        rest, start = self._behind + data, 0
        while start < len(rest) and not (self.pipeline or self._lost):
            self._feed(rest[start : start + PARSED_AT_ONCE])
            start += PARSED_AT_ONCE
        self._behind = b"" if self._lost else rest[start:]
        if self._behind:
            self.flow.full = len(self._behind) > MOST_BEHIND
            self.flow.pause_reading()

    def _feed(self, data: bytes) -> None:
        self._lines += len(data)
        super().data_received(data)
        rest: Any = memoryview(data) if self._declined else b""
        while self._declined and not self._lost:
            (head, end), self._declined = self._declined, None
            rest = rest[end:]
            # The one that stopped may count the connection as closed.
            self.parser = HttpRequestParser(self)
            self.parser.set_dangerous_leniencies(lenient_data_after_close=True)
            super().data_received(head)
            if not self._lost:
                super().data_received(rest)
        if self._lines > LONGEST_HEAD and not self._lost:
            self.send_400_response(_TOO_LONG)

    def _should_upgrade(self) -> bool:
        # Then the parser's calls for this request are passed over and, for an answer, the next method is called.
        return bool(self.scope["method"] != "CONNECT")

    def handle_websocket_upgrade(self) -> None:
        """Have the request read again without the offer to upgrade."""
        version = self.scope.get("http_version", "1.1").encode()
        lines = [b"%b %b HTTP/%b" % (self.scope["method"].encode(), self.url, version)]
        for name, value in self.headers:
            if name == b"connection":
                kept = [token for token in value.split(b",") if token.strip().lower() != b"upgrade"]
                lines.append(b"connection: " + b",".join(kept))
            elif name != b"upgrade":
                lines.append(b"%b: %b" % (name, value))
        stopped = sys.exception()
        assert stopped is not None
        self._declined = b"\r\n".join(lines) + b"\r\n\r\n", stopped.args[0]

    def _start_asgi_task(self, cycle: RequestResponseCycle, app: ASGI3Application) -> None:
        extensions: dict[str, Any] = {PIECES: partial(write_piece, cycle)}
        cycle.scope["extensions"] = extensions
        self._answered = cycle
        super()._start_asgi_task(cycle, app)


async def not_understood(said: bytes, scope: Scope, receive: ASGIReceiveCallable, send: ASGISendCallable) -> None:
    """Answer as uvicorn does what is no HTTP, where that is said in turn."""
    headers = [
        (b"content-type", b"text/plain; charset=utf-8"),
        (b"content-length", b"%d" % len(said)),
        (b"connection", b"close"),
    ]
    await send({"type": "http.response.start", "status": 400, "headers": headers})
    await send({"type": "http.response.body", "body": said, "more_body": False})


async def write_piece(cycle: RequestResponseCycle, parts: Sequence[bytes | memoryview]) -> bool:
    """Send a chunk as its parts are, as `WritePiece` has it; large ones are copied to be joined."""
    if not cycle.chunked_encoding or cycle.response_complete or cycle.scope["method"] == "HEAD":
        return False
    if cycle.flow.write_paused and not cycle.disconnected:
        await cycle.flow.drain()
    if not cycle.disconnected:
        cycle.transport.writelines((b"%x\r\n" % sum(map(len, parts)), *parts, b"\r\n"))
    return True

"""The server's HTTP protocol, with short cuts for small requests and small answers.

uvicorn hands over a body through three coroutines, checks and joins the headers of a response one by one, and writes
headers and body apart; for a small answer this costs as much as finding it. Here a body that has arrived is taken, and
a response whose headers are of known form is written, by one call each. Everything else is uvicorn's own: parsing,
keeping alive, pipelining, back-pressure, disconnection, continuation, shutdown. Where any of them has a say, the short
cut declines, having done nothing, and the application goes the ordinary way of ASGI. See docs/decisions/0009.

Four things are done otherwise:

- A request that offers to go on in another protocol is answered in this one, as RFC 9110, 7.8, has it. The parser stops
  at the end of its headers and takes its body, and all that is pipelined behind it, for the other protocol; clients
  that offer HTTP/2 with every request would never be heard.
- Fields behind a chunked body are no headers (RFC 9110, 6.5.1): who looks at headers in front of the server, or limits
  them, does not see these.
- A client that leaves is missed by the request that is being answered, not only by the last it has sent: its
  computation is stopped.
- What is no HTTP is answered in its turn: what came before it was accepted, and may be answered by half.
"""

from __future__ import annotations

import sys
from asyncio import Event
from collections.abc import Callable, Sequence
from typing import Any

from httptools import HttpRequestParser
from uvicorn._types import ASGI3Application, ASGIReceiveCallable, ASGISendCallable, Scope
from uvicorn.protocols.http.httptools_impl import STATUS_LINE, HttpToolsProtocol, RequestResponseCycle

from service.exchange import DIRECT

LONGEST = 65_536
"""Bytes up to which copying a body behind its headers costs less than writing it by itself."""

LONG = 3e-4
"""Seconds beyond which an answer is sent as soon as it is found: others like it, ready behind it, would delay it more
than a system call costs them."""

_OK = STATUS_LINE[200]
_NO_HTTP = b"Invalid HTTP request received."


class Protocol(HttpToolsProtocol):
    """One connection."""

    _declined: tuple[bytes, int] | None = None
    """Headers of a request without the offer to upgrade, and the place in what was received where they ended."""

    _unsent = b""
    """A response that is sent when everything that is ready to run has run."""

    _answered: RequestResponseCycle | None = None
    """The last request that has been begun to be answered, behind which others may wait."""

    _senseless = False
    """Whether something has arrived that is no HTTP, so that nothing behind it can be understood."""

    def send_soon(self, response: bytes) -> None:
        """Send a response behind all work that is ready, in one go with those of other connections.

        A system call between two answers makes both slower: it drops the processor's caches, and wakes the client's.
        """
        self._unsent = response
        self.loop.call_soon(self._send)

    def _send(self) -> None:
        response, self._unsent = self._unsent, b""
        if response:
            self.transport.write(response)

    def shutdown(self) -> None:
        """Close the connection, or have it closed after the response that is under way."""
        self._send()
        super().shutdown()

    def eof_received(self) -> None:
        """Send what is answered, before the connection is closed because the client sends no more."""
        self._send()

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
        self._send()
        cycle, begun = self.cycle, self._begun and self.cycle.more_body
        if begun and self.pipeline:
            # It is the last that came, and nothing has been done about it.
            self.pipeline[0] = cycle, not_understood
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
            self.pipeline.appendleft((self.cycle, not_understood))

    def on_headers_complete(self) -> None:
        """Begin to answer; fields that are read from now on until the next request are none of its headers."""
        super().on_headers_complete()
        if self._begun:
            self.headers = []

    def on_message_complete(self) -> None:
        """Hand over the end of a body, and close the connection after the response if fields behind it say so."""
        if self.headers and self._begun and not self.parser.should_keep_alive():
            # The parser skips all that follows, which would wait for its answers.
            self.cycle.keep_alive = False
            if self.cycle.response_complete:
                self.shutdown()
        super().on_message_complete()

    @property
    def _begun(self) -> bool:
        """Whether the last message of which something has been read is a request whose headers are complete."""
        return self.cycle is not None and self.cycle.scope is self.scope

    def data_received(self, data: bytes) -> None:
        """Parse what has arrived."""
        if self._senseless:
            return
        self._send()
        super().data_received(data)
        rest: Any = memoryview(data) if self._declined else b""
        while self._declined and not self.transport.is_closing():
            (head, end), self._declined = self._declined, None
            rest = rest[end:]
            # The one that stopped may count the connection as closed.
            self.parser = HttpRequestParser(self)
            self.parser.set_dangerous_leniencies(lenient_data_after_close=True)
            super().data_received(head)
            if not self.transport.is_closing():
                super().data_received(rest)

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
        extensions: dict[str, Any] = {DIRECT: ShortCuts(cycle, self.send_soon)}
        cycle.scope["extensions"] = extensions
        self._answered = cycle
        super()._start_asgi_task(cycle, app)


async def not_understood(scope: Scope, receive: ASGIReceiveCallable, send: ASGISendCallable) -> None:
    """Answer as uvicorn does what is no HTTP, where that is said in turn."""
    headers = [
        (b"content-type", b"text/plain; charset=utf-8"),
        (b"content-length", b"%d" % len(_NO_HTTP)),
        (b"connection", b"close"),
    ]
    await send({"type": "http.response.start", "status": 400, "headers": headers})
    await send({"type": "http.response.body", "body": _NO_HTTP, "more_body": False})


class ShortCuts:
    """The short cuts of one request, as `service.exchange.Direct` describes them.

    Parameters
    ----------
    cycle : RequestResponseCycle
        The request and its response, as uvicorn keeps them.
    """

    __slots__ = ("_cycle", "_send")

    def __init__(self, cycle: RequestResponseCycle, send: Callable[[bytes], None]) -> None:
        self._cycle, self._send = cycle, send

    def read(self, limit: int) -> bytes | None:
        """Return the body and leave everything as its last message would have left it."""
        cycle = self._cycle
        if (
            cycle.more_body
            or cycle.waiting_for_100_continue
            or cycle.disconnected
            or cycle.response_complete
            or len(cycle.body) > limit
        ):
            return None
        body = bytes(cycle.body)
        cycle.body = bytearray()
        cycle.flow.resume_reading()
        cycle.message_event.clear()
        return body

    def write(self, headers: bytes, body: bytes, took: float) -> bool:
        """Send the response and leave everything as its last message would have left it."""
        cycle = self._cycle
        if (
            cycle.response_started
            or cycle.disconnected
            # The connection is to be closed after this response, which has to be said in it.
            or not cycle.keep_alive
            or cycle.waiting_for_100_continue
            or cycle.more_body
            # The client reads more slowly than it asks.
            or cycle.flow.write_paused
            or cycle.access_log
            or cycle.scope["method"] == "HEAD"
            or len(body) > LONGEST
        ):
            return False
        parts = [_OK]
        for name, value in cycle.default_headers:
            parts += (name, b": ", value, b"\r\n")
        parts += (headers, b"\r\n", body)
        # The one reference that would keep the cycle until the collector of garbage finds it.
        del cycle.scope["extensions"]
        cycle.response_started = cycle.response_complete = True
        (self._send if took < LONG else cycle.transport.write)(b"".join(parts))
        cycle.message_event.set()
        cycle.on_response()
        return True

    async def write_piece(self, parts: Sequence[bytes | memoryview]) -> bool:
        """Send a chunk as its parts are; large ones would be copied twice to be joined."""
        cycle = self._cycle
        if not cycle.chunked_encoding or cycle.response_complete or cycle.scope["method"] == "HEAD":
            return False
        if cycle.flow.write_paused and not cycle.disconnected:
            await cycle.flow.drain()
        if not cycle.disconnected:
            cycle.transport.writelines((b"%x\r\n" % sum(map(len, parts)), *parts, b"\r\n"))
        return True

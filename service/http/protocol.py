"""The server's HTTP protocol: a shorter way for plain small questions.

A question that has arrived whole, with a head that has been understood before, is handed to the application's rounds
(`service.http.rounds`) as it is; for a small answer, parsing and the messages of ASGI cost as much as finding it.
Everything else is left to `service.http.orderly_http`, and so to uvicorn: parsing, pipelining, back-pressure,
disconnection, continuation, shutdown. Where any of them has a say, or the rounds decline a question, it goes the
ordinary way of ASGI. See docs/decisions/0009.
"""

from __future__ import annotations

from asyncio import BaseTransport
from typing import Any

from uvicorn.protocols.http.httptools_impl import STATUS_LINE

from service.http.orderly_http import OrderlyProtocol
from service.http.rounds import ROUNDS, Rounds

_OK = STATUS_LINE[200]


class Protocol(OrderlyProtocol):
    """One connection."""

    _rounds: Rounds | None = None
    """Where plain small questions are answered; None if every request has to go the ordinary way."""

    _between = True
    """Whether all that has arrived were whole requests."""

    _held = b""
    """A known head and what has arrived of its body."""

    _waiting = b""
    """A question that waits for its round, as it arrived."""

    _told_at = 0.0
    """When a round has answered last (s, the loop's time)."""

    _opening: tuple[Any, bytes] = (None, b"")
    """Default headers of the server, and how a response begins that has them."""

    def connection_made(self, transport: BaseTransport) -> None:
        """Begin a connection."""
        super().connection_made(transport)
        if not self.access_log and self.limit_concurrency is None:
            self._rounds = self.app_state.get(ROUNDS)

    def told(self, headers: bytes, body: bytes) -> bool:
        """Send the answer to the question that waits, as `service.http.rounds.Asker` has it."""
        self._waiting = b""
        if self.transport.is_closing():
            return False
        server, loop = self.server_state, self.loop
        # The server makes them anew every second.
        if self._opening[0] is not server.default_headers:
            lines = [_OK, *(b"%b: %b\r\n" % header for header in server.default_headers)]
            self._opening = server.default_headers, b"".join(lines)
        self.transport.write(b"%b%b\r\n%b" % (self._opening[1], headers, body))
        server.total_requests += 1
        self._told_at = loop.time()
        if self.timeout_keep_alive_task is None:
            self._wait_for_more(self.timeout_keep_alive)
        return True

    def declined(self) -> None:
        """Have the question that waits answered the ordinary way."""
        data, self._waiting = self._waiting, b""
        if not self.transport.is_closing():
            super().data_received(data)

    def _finish(self) -> None:
        """Have the question that waits answered, before anything else is done about the connection."""
        if self._waiting and self._rounds is not None:
            self._rounds.finish()

    def _wait_for_more(self, seconds: float) -> None:
        self.timeout_keep_alive_task = self.loop.call_later(seconds, self.timeout_keep_alive_handler)

    def timeout_keep_alive_handler(self) -> None:
        """Close a connection on which nothing has been asked for a while; questions do not set back its clock."""
        idle = 0.0 if self._waiting or self._held else self.loop.time() - self._told_at
        if idle < self.timeout_keep_alive and not self.transport.is_closing():
            self._wait_for_more(self.timeout_keep_alive - idle)
        else:
            super().timeout_keep_alive_handler()

    def shutdown(self) -> None:
        """Close the connection, or have it closed after the response that is under way."""
        self._finish()
        if self._held:
            held, self._held = self._held, b""
            super().data_received(held)
        super().shutdown()

    def eof_received(self) -> None:
        """Answer what has been asked, before the connection is closed because the client sends no more."""
        self._finish()

    def on_message_begin(self) -> None:
        """Begin to read a request."""
        self._between = False
        super().on_message_begin()

    def on_message_complete(self) -> None:
        """Note that nothing of another request has been read."""
        super().on_message_complete()
        self._between = True

    def data_received(self, data: bytes) -> None:
        """Hand a plain question to the rounds, and leave what else has arrived to the ordinary way."""
        self._finish()
        cycle, rounds = self.cycle, self._rounds
        idle = self._between and not self._senseless and (cycle is None or cycle.response_complete)
        if rounds is None or not idle:
            super().data_received(data)
            return
        if self._held:
            data, self._held = self._held + data, b""
        head = data[: data.find(b"\r\n\r\n") + 4]
        known, identity = rounds.heads.find(head)
        if known is None:
            super().data_received(data)
            begun = self.cycle
            # What came behind the head was taken for its body; the parser may have seen another end of it.
            if begun is not cycle and self._begun and begun.keep_alive and len(head) + len(begun.body) == len(data):
                rounds.heads.learn(head, self.scope)
        elif len(data) > known.length or self.flow.write_paused:
            super().data_received(data)
        elif len(data) < known.length:
            # Many clients send head and body apart.
            self._held = data
        else:
            self._waiting = data
            rounds.ask(self, known.route, data[len(head) :], identity)

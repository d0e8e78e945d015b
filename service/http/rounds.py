"""Small questions answered in rounds: all that have arrived are read, then all are answered, written and sent.

A small question takes a few microseconds at each of these stations. Carried through all of them by itself, it finds the
processor's caches filled by the others; in rounds the code of a station is fetched once for all. Nor does it take a
task, or the messages of ASGI. See docs/decisions/0009.

A question gets here if it has arrived whole and plainly (`service.http.heads`). Where it then turns out to be anything
but small and sound, it is declined, nothing having been done about it, and goes the ordinary way.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from time import perf_counter
from typing import Any, Protocol

from service.execution.request_handler import RequestHandler
from service.execution.response_cache import ResponseCache
from service.http.etag import Representation
from service.http.heads import Heads
from service.observability.metrics import Metrics
from service.observability.request_records import Records
from service.responses.json_rows import ONE_PIECE, array_size, written
from service.routing import PostRoute

ROUNDS = "polhode.rounds"
"""Name under which an application gives its rounds to the server, in the state of its lifespan."""

SMALL = 1e-4
"""Predicted seconds up to which a question keeps the others of its round waiting for no more than a moment."""

FEW = 1_024
"""Numbers of an answer, likewise; none is written that then has to be sent in pieces."""

SHORT = 2 * ONE_PIECE
"""Bytes of text that cannot hold so many numbers that the answer has to be sent in pieces."""

TOGETHER = 32
"""Questions of one round: with more the first would wait for long, and their objects leave the caches."""


class Asker(Protocol):
    """Who has asked a question and waits for its answer."""

    def told(self, headers: bytes, body: bytes) -> bool:
        """Send a response with status 200, or return False if nobody is there any more."""

    def declined(self) -> None:
        """Have the question answered the ordinary way."""


class _Asked:
    """A question on its way."""

    __slots__ = ("asker", "body", "identity", "route", "since", "whole", "work")

    def __init__(self, asker: Asker, route: PostRoute, body: bytes, identity: bytes | None) -> None:
        self.since = perf_counter()
        self.asker, self.route, self.body, self.identity = asker, route, body, identity
        self.work: Any = None
        """What the last station has made of it."""
        self.whole: Representation | None = None


class Rounds:
    """The rounds of one server process.

    Parameters
    ----------
    heads : Heads
        Of the requests whose questions are answered here.
    answering : RequestHandler
    kept : ResponseCache
    metrics : Metrics
    records : Records
    most_seconds : float
        Predicted time of the longest questions that are answered here (s), at most `SMALL`.
    """

    def __init__(
        self,
        heads: Heads,
        answering: RequestHandler,
        kept: ResponseCache,
        metrics: Metrics,
        records: Records,
        most_seconds: float = SMALL,
    ) -> None:
        self.heads, self._most_seconds = heads, min(most_seconds, SMALL)
        self._answering, self._kept, self._metrics, self._records = answering, kept, metrics, records
        self._asked: list[_Asked] = []

    def ask(self, asker: Asker, route: PostRoute, body: bytes, identity: bytes | None = None) -> None:
        """Have a question answered in the next round; `identity` is what its head says of it."""
        if not self._asked:
            asyncio.get_running_loop().call_soon(self._go)
        self._asked.append(_Asked(asker, route, body, identity))

    def finish(self) -> None:
        """Answer at once all that has been asked."""
        while self._asked:
            self._round()

    def _go(self) -> None:
        self._round()
        if self._asked:
            asyncio.get_running_loop().call_soon(self._go)

    def _round(self) -> None:
        asked, self._asked = self._asked[:TOGETHER], self._asked[TOGETHER:]
        asked = self._through(self._read, asked)
        asked = self._through(self._answer, asked)
        asked = self._through(self._write, asked)
        for one in asked:
            self._send(one)

    def _through(self, station: Callable[[_Asked], bool], asked: Iterable[_Asked]) -> list[_Asked]:
        """Return the questions that a station has let pass."""
        passed = []
        for one in asked:
            try:
                fit = one.whole is not None or station(one)
            except Exception:
                # It is found again, told and logged where the question goes now.
                fit = False
            if fit:
                passed.append(one)
            else:
                one.asker.declined()
        return passed

    def _read(self, one: _Asked) -> bool:
        one.whole = self._kept.get(one.route.path, one.body)
        if one.whole is not None:
            self._metrics.cache_hits.inc()
            return True
        one.work = question = self._answering.read(one.route, one.body)
        return self._answering.price(one.route, question) <= self._most_seconds

    def _answer(self, one: _Asked) -> bool:
        one.work = self._answering.answer(one.route, one.work)
        return True

    def _write(self, one: _Asked) -> bool:
        if array_size(one.work) > FEW:
            return False
        text = written(one.work)
        if len(text) > SHORT:
            return False
        one.whole = Representation(text)
        self._kept.put(one.route.path, one.body, one.whole)
        return True

    def _send(self, one: _Asked) -> None:
        whole, identity = one.whole, self._records.id_of(one.identity)
        assert whole is not None
        took = perf_counter() - one.since
        own = b"%bx-request-id: %b\r\nserver-timing: total;dur=%.3f\r\n" % (whole.section, identity, 1e3 * took)
        sent = one.asker.told(own, whole.text)
        self._records.finished(identity, one.route.operation_id, "POST", 200 if sent else 499, took)

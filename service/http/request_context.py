"""One request and its response."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable, Iterator, Sequence
from ipaddress import IPv4Address, ip_address, ip_network
from math import ceil
from time import perf_counter

from starlette.types import Receive, Scope, Send

from service.http.compression import LEAST, Coding, Compressor, coding_for, compressed, is_compressed, off_loop
from service.http.etag import JSON, NOSNIFF, Header, Representation
from service.http.keys import Key
from service.http.limits import ClientGone
from service.observability import traces
from service.observability.request_records import Records
from service.problems import MEDIA_TYPE, Problem

SHORT = 1_024
"""Bytes below which a piece of a stream is sent together with the next."""

BUFFERED = 65_536
"""Bytes of a response that the server takes at once, whether its client reads or not: the high-water mark of the
transports of asyncio."""

_PROBLEM: Header = (b"content-type", MEDIA_TYPE.encode())
VARY: Header = (b"vary", b"accept")
_VARY_ENCODING: Header = (b"vary", b"accept-encoding")
_NOT_STORED: Header = (b"cache-control", b"no-store")
_REVALIDATE: Header = (b"cache-control", b"no-cache")


def _page_headers(frame_ancestors: str) -> tuple[Header, ...]:
    """Return what guards a page: it loads and asks this service alone, and only these origins may frame it."""
    framed_by = frame_ancestors or "'none'"
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        f"connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors {framed_by}"
    )
    return ((b"content-security-policy", policy.encode()), (b"referrer-policy", b"no-referrer"))


class RequestContext:
    """One request and its response; the request is counted under the name of an operation."""

    __slots__ = (
        "_records",
        "_send",
        "_since",
        "_span",
        "headers",
        "identity",
        "key",
        "operation",
        "receive",
        "scope",
        "started",
    )

    def __init__(self, records: Records, operation: str, scope: Scope, receive: Receive, send: Send) -> None:
        self._since = perf_counter()
        self._records, self.operation, self.scope = records, operation, scope
        self.receive, self._send = receive, send
        self.headers = _by_name(scope["headers"])
        self.started = False
        self.key: Key | None = None
        self.identity = records.id_of(self.headers.get(b"x-request-id"))
        self._span = traces.begun(operation, scope["method"], self.id, self.headers)

    @property
    def id(self) -> str:
        """The request's id."""
        return self.identity.decode()

    @property
    def address(self) -> str:
        """The client's network address; empty where the server does not say."""
        client = self.scope.get("client")
        return client[0] if client else ""

    @property
    def client(self) -> str:
        """By whom a request is counted: the key's name, or the network from which it came."""
        return network_of(self.address) if self.key is None else self.key.name

    async def gone(self) -> None:
        """Return when the client has closed the connection; the body must have been read."""
        while (await self.receive())["type"] != "http.disconnect":
            pass

    async def answer(self, answer: Representation, *, kept: bool = False) -> None:
        """Send a document in one piece, or that the client has it already; compressed once where it is `kept`."""
        if len(answer.body) >= LEAST and is_compressed(answer.content_type):
            coding = self._coding(answer.content_type)
            # The validator is that of the bytes which would be sent, known without them.
            etag = answer.etag if coding is None else coding.tagged(answer.etag)
            body = answer.body
            if coding is not None and not self._has(etag):
                body = await compressed(coding, body, kept=kept)
            answer = answer.coded(body, etag, _headers_of(coding))
        if self._has(answer.etag):
            await self._respond(304, b"", answer.about)
        else:
            await self._respond(200, answer.body, answer.headers)

    async def page(
        self, body: bytes, media_type: bytes, status: int, *, kept: bool = False, frame_ancestors: str = ""
    ) -> None:
        """Send the document of a GET route, which clients revalidate; compressed once where it is `kept`.

        `frame_ancestors` are the origins whose pages may show it in a frame, separated by blanks.
        """
        guards = _page_headers(frame_ancestors) if media_type.startswith(b"text/html") else ()
        page = Representation(body, (b"content-type", media_type), (_REVALIDATE, *guards))
        if status == 200:
            await self.answer(page, kept=kept)
        else:
            await self._respond(status, body, [header for header in page.headers if header[0] != b"etag"])

    async def problem(self, problem: Problem) -> None:
        """Send a problem document."""
        self._records.problem(problem.type.code)
        body = problem.body(self.id)
        headers = [_PROBLEM, (b"content-length", b"%d" % len(body)), NOSNIFF]
        headers += [(name.lower().encode(), value.encode()) for name, value in problem.headers]
        if problem.retry_after is not None:
            headers.append((b"retry-after", b"%d" % max(1, ceil(problem.retry_after))))
        await self._respond(problem.type.status, body, headers)

    async def stream(
        self, pieces: Iterator[bytes | memoryview], etag: bytes, patience: float, headers: Sequence[Header],
        turns: asyncio.Lock,
    ) -> None:  # fmt: skip
        """Send an answer piece by piece, short ones with the next, letting other requests run in between.

        Between two other requests, one piece of one stream is made: the streams of a process share `turns`.

        Raises
        ------
        ClientGone
            If the client has left, or has taken nothing for longer than `patience` (s).
        """
        content_type = dict(headers)[b"content-type"]
        coding = self._coding(content_type)
        if is_compressed(content_type):
            headers = [*headers, *_headers_of(coding)]
        if coding is not None:
            etag = coding.tagged(etag)
        if self._has(etag):
            about = [header for header in headers if header[0] != b"content-type"]
            await self._respond(304, b"", [*about, (b"etag", etag), NOSNIFF])
            return
        await self._start(200, [*headers, (b"etag", etag), NOSNIFF])
        leaving = asyncio.ensure_future(self.gone())
        compressor = None if coding is None else coding.fast()
        more = True
        try:
            while more:
                # Servers accept and drop what is sent on a closed connection: the rest would be written in vain.
                if leaving.done():
                    raise ClientGone
                async with turns:
                    body, more = _gathered(pieces)
                    await asyncio.sleep(0)
                if compressor is not None:
                    body = await _coded(compressor, body, last=not more)
                if more and body:
                    async with asyncio.timeout(patience):
                        await self._send({"type": "http.response.body", "body": body, "more_body": True})
        except TimeoutError:
            raise ClientGone from None
        finally:
            leaving.cancel()
        await self._send({"type": "http.response.body", "body": body, "more_body": False})
        self.close(200)

    async def document(self, body: bytes, status: int, headers: Iterable[Header] = ()) -> None:
        """Send a JSON document that changes, and is not to be stored by anyone."""
        coding = self._coding(JSON[1]) if len(body) >= LEAST else None
        if coding is not None:
            body = await compressed(coding, body)
        length = (b"content-length", b"%d" % len(body))
        headers = (*headers, *_headers_of(coding))
        await self._respond(status, body, [JSON, length, _NOT_STORED, NOSNIFF, *headers])

    async def empty(self, headers: Iterable[Header]) -> None:
        """Answer with headers alone."""
        await self._respond(204, b"", headers)

    async def events(self, events: AsyncIterator[bytes]) -> None:
        """Send server-sent events one by one as they come about.

        Raises
        ------
        ClientGone
            If the client has left.
        """
        await self._start(200, [(b"content-type", b"text/event-stream"), _NOT_STORED, NOSNIFF])
        await self._each(events)

    async def stream_made_elsewhere(self, pieces: Iterator[bytes], media_type: bytes, patience: float) -> None:
        """Send a document whose pieces are made by blocking calls, each in another thread.

        Raises
        ------
        ClientGone
            If the client has left, or has taken nothing for longer than `patience` (s).
        """
        first = await asyncio.to_thread(next, pieces, b"")
        coding = self._coding(media_type)
        coded = _headers_of(coding) if is_compressed(media_type) else ()
        await self._start(200, [(b"content-type", media_type), _NOT_STORED, VARY, NOSNIFF, *coded])
        compressor = None if coding is None else coding.fast()

        async def each() -> AsyncIterator[bytes]:
            piece: bytes | None = first
            while piece is not None:
                following = await asyncio.to_thread(next, pieces, None)
                if compressor is not None:
                    piece = await _coded(compressor, piece, last=following is None)
                if piece:
                    yield piece
                piece = following

        await self._each(each(), patience)

    async def _each(self, pieces: AsyncIterator[bytes], patience: float | None = None) -> None:
        leaving = asyncio.ensure_future(self.gone())
        try:
            async for piece in pieces:
                if leaving.done():
                    raise ClientGone
                async with asyncio.timeout(patience):
                    await self._send({"type": "http.response.body", "body": piece, "more_body": True})
        except TimeoutError:
            raise ClientGone from None
        finally:
            leaving.cancel()
        await self._send({"type": "http.response.body", "body": b"", "more_body": False})
        self.close(200)

    def close(self, status: int) -> None:
        """Count the request as finished."""
        seconds = perf_counter() - self._since
        traces.ended(self._span, status)
        key = None if self.key is None else self.key.name
        self._records.finished(self.identity, self.operation, self.scope["method"], status, seconds, key)

    def _coding(self, content_type: bytes) -> Coding | None:
        return coding_for(self.headers.get(b"accept-encoding"), content_type)

    def _has(self, etag: bytes) -> bool:
        known = self.headers.get(b"if-none-match")
        if known is None:
            return False
        # The comparison is weak (RFC 9110, 13.1.2): a proxy that compresses an answer marks its validator as weak.
        return known == b"*" or etag in [tag.strip().removeprefix(b"W/") for tag in known.split(b",")]

    async def _respond(self, status: int, body: bytes, headers: Iterable[Header]) -> None:
        await self._start(status, headers)
        if self.scope["method"] == "HEAD":
            body = b""
        if len(body) > BUFFERED:
            # The next message is accepted when the client has taken most of this one.
            await self._send({"type": "http.response.body", "body": body, "more_body": True})
            body = b""
        await self._send({"type": "http.response.body", "body": body})
        self.close(status)

    async def _start(self, status: int, headers: Iterable[Header]) -> None:
        timing = b"total;dur=%.3f" % (1e3 * (perf_counter() - self._since))
        own = [(b"x-request-id", self.identity), (b"server-timing", timing)]
        if self.scope.get("http_version") == "1.0" and b"transfer-encoding" in self.headers:
            # A proxy of that version may have framed the request otherwise (RFC 9112, 6.1).
            own.append((b"connection", b"close"))
        self.started = True
        await self._send({"type": "http.response.start", "status": status, "headers": [*headers, *own]})


def network_of(address: str) -> str:
    """Return an IPv4 address, or the network of an IPv6 address, of which a client has all 2**64."""
    if ":" not in address:
        return address
    try:
        found = ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, IPv4Address):
        return str(found)
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ip_network((int(found), 64), strict=False))


def _headers_of(coding: Coding | None) -> tuple[Header, ...]:
    """Return the headers of a document that is compressed for who accepts it."""
    return (_VARY_ENCODING,) if coding is None else (_VARY_ENCODING, (b"content-encoding", coding.name))


async def _coded(compressor: Compressor, piece: bytes, *, last: bool) -> bytes:
    return await off_loop(len(piece), lambda: compressor.compress(piece) + (compressor.flush() if last else b""))


def _by_name(headers: Sequence[Header]) -> dict[bytes, bytes]:
    """Return headers by their names; the values of one that is repeated form a list (RFC 9110, 5.3)."""
    found = dict(headers)
    if len(found) < len(headers):
        found = {name: b", ".join(value for other, value in headers if other == name) for name in found}
    return found


def _gathered(pieces: Iterator[bytes | memoryview]) -> tuple[bytes, bool]:
    """Return the next pieces up to one that is not short, and whether there may be more."""
    gathered = []
    for piece in pieces:
        gathered.append(piece)
        if len(piece) >= SHORT:
            return b"".join(gathered), True
    return b"".join(gathered), False

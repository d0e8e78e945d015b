"""The request path: a pure ASGI application that serves the route table.

FastAPI documents the same table and can serve it too, through `Dispatcher.serve`; going through its own machinery would
cost several times what a small question costs.
"""

from __future__ import annotations

import asyncio
import hashlib
import re
import secrets
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Iterable, MutableMapping, Sequence
from itertools import count
from time import perf_counter
from typing import Any

from core.errors import MechanicsError
from service import archive
from service.answering import Answering
from service.composing import Document, composed
from service.compute import Compute
from service.cors import Cors
from service.guards import ClientGone, negotiated, read_body, require_acceptable, require_json
from service.keys import Key, Keys
from service.logs import LOG
from service.metrics import Metrics
from service.problems import MEDIA_TYPE, REGISTRY, Problem, Refusal, problem_of
from service.routing import Page, Question, Route
from service.settings import Settings

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Header = tuple[bytes, bytes]

_REQUEST_ID = re.compile(rb"[A-Za-z0-9._-]{1,64}")
_NOSNIFF: Header = (b"x-content-type-options", b"nosniff")
_JSON: Header = (b"content-type", b"application/json")
_PROBLEM: Header = (b"content-type", MEDIA_TYPE.encode())
_NPZ: tuple[Header, ...] = ((b"content-type", archive.MEDIA_TYPE.encode()), (b"vary", b"accept"))
_REVALIDATE: Header = (b"cache-control", b"no-cache")
_PAGE_HEADERS: tuple[Header, ...] = (
    (
        b"content-security-policy",
        b"default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        b"connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (b"referrer-policy", b"no-referrer"),
)


class Dispatcher:
    """Serves the routes.

    Parameters
    ----------
    routes : sequence of Route
        The one table.
    answering : Answering
        Answers questions in this process.
    compute : Compute
        Answers questions in others.
    """

    def __init__(
        self,
        routes: Sequence[Route],
        *,
        answering: Answering,
        compute: Compute,
        metrics: Metrics,
        settings: Settings,
    ) -> None:
        self._routes: dict[tuple[str, str], Route] = {(route.method, route.path): route for route in routes}
        self._answering, self._compute, self._metrics, self._settings = answering, compute, metrics, settings
        self._keys = None if settings.keys_file is None else Keys(settings.keys_file, settings.workers)
        self.cors = Cors(settings.cors_origins)
        self._kept: OrderedDict[tuple[str, bytes], tuple[bytes, bytes]] = OrderedDict()
        self._ids = map("{}-{:x}".format, _forever(secrets.token_hex(6)), count(1))
        self._log_from = {"none": 1000, "failures": 500, "all": 0}[settings.log_requests]

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one HTTP request."""
        method = scope["method"]
        route = self._routes.get(("GET" if method == "HEAD" else method, scope["path"]))
        if route is None:
            await self._unrouted(scope, receive, send)
        else:
            await self.serve(route, scope, receive, send)

    async def serve(self, route: Route, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one HTTP request that has been routed."""
        exchange = Exchange(self, route.operation_id, scope, receive, send)
        try:
            if isinstance(route, Question):
                await self._question(route, exchange)
            else:
                await self._page(route, exchange)
        except Refusal as refusal:
            await exchange.problem(refusal.problem)
        except MechanicsError as error:
            await exchange.problem(problem_of(error))
        except ClientGone:
            exchange.close(499)
        except asyncio.CancelledError:
            # The server is being stopped and will not wait any longer.
            if not exchange.started:
                detail = "the service is being stopped"
                await exchange.problem(Problem(REGISTRY["shutting-down"], detail, headers=(("Retry-After", "1"),)))
        except Exception:
            if exchange.started:
                # The answer is cut short, which the transfer coding shows the client.
                LOG.exception("failed in the middle of an answer", extra={"request_id": exchange.id})
                raise
            LOG.exception("failed", extra={"request_id": exchange.id, "operation": route.operation_id})
            detail = "the service failed; the failure is logged under this id"
            await exchange.problem(Problem(REGISTRY["internal-error"], detail, extra={"id": exchange.id}))

    async def _question(self, route: Question, exchange: Exchange) -> None:
        settings, headers = self._settings, exchange.headers
        if self._keys is not None:
            exchange.key = self._keys.admit(headers)
        require_json(headers)
        media = None
        accept = headers.get(b"accept", b"*/*")
        if accept != b"*/*" and accept != b"application/json":
            media = negotiated(accept, (*route.representations, archive.MEDIA_TYPE))
        body = await read_body(exchange.receive, headers, settings.max_body_bytes)
        key = (route.path, body)
        kept = self._kept.get(key) if media is None else None
        if kept is not None:
            self._kept.move_to_end(key)
            self._metrics.cache_hits.inc()
            await exchange.answer(*kept)
            return
        document = await self._document(route, body, media, exchange)
        if media == archive.MEDIA_TYPE:
            self._metrics.samples.inc(document.numbers)
            etag = etag_of(route.path.encode(), media.encode(), body)
            await exchange.stream(document.pieces(), etag, _NPZ)
            return
        if media is not None:
            await exchange.represented(document.whole(), media.encode())
            return
        if document.large:
            self._metrics.samples.inc(document.numbers)
            # The question and the version determine the answer to the bit, so their hash names it.
            await exchange.stream(document.pieces(), etag_of(route.path.encode(), body))
            return
        text = document.whole()
        etag = etag_of(text)
        if settings.cached_answers and len(text) + len(body) <= 8192:
            self._kept[key] = text, etag
            if len(self._kept) > settings.cached_answers:
                self._kept.popitem(last=False)
        await exchange.answer(text, etag)

    async def _document(self, route: Question, body: bytes, media: str | None, exchange: Exchange) -> Document:
        longest = self._settings.deadline_seconds
        if len(body) <= self._settings.inline_bytes:
            question = self._answering.read(route, body)
            # Nothing computes for longer than the deadline, whatever was predicted.
            price = min(self._answering.price(route, question), longest)
            if exchange.key is not None:
                exchange.key.work(price)
            if price <= self._settings.inline_seconds:
                return composed(route, self._answering.answer(route, question), media)
        else:
            # What has not been read has no price yet; reading alone takes about this long.
            price = min(4e-8 * len(body), longest)
            if exchange.key is not None:
                exchange.key.work(price)
        return await self._compute.answer(route, body, price, media, gone=exchange.gone)

    async def _page(self, route: Page, exchange: Exchange) -> None:
        reply = route.content()
        if b"accept" in exchange.headers:
            require_acceptable(exchange.headers[b"accept"], reply.media_type.split(b";", 1)[0])
        await exchange.page(reply.body, reply.media_type, reply.status)

    async def _unrouted(self, scope: Scope, receive: Receive, send: Send) -> None:
        exchange = Exchange(self, "none", scope, receive, send)
        methods = [method for method, path in self._routes if path == scope["path"]]
        preflight = self.cors.preflight(scope["method"], exchange.headers) if self.cors and methods else None
        if preflight is not None:
            await exchange.empty(preflight)
            return
        if methods:
            allowed = ", ".join(methods + (["HEAD"] if "GET" in methods else []))
            detail = f"this path answers {allowed}"
            problem = Problem(REGISTRY["method-not-allowed"], detail, headers=(("Allow", allowed),))
        else:
            problem = Problem(REGISTRY["not-found"], "there is nothing at this path")
        await exchange.problem(problem)

    def next_id(self) -> bytes:
        """Return a request id that no other request has."""
        return next(self._ids).encode()

    def finished(self, exchange: Exchange, status: int, seconds: float) -> None:
        """Count and log a request."""
        self._metrics.observe((exchange.operation, status), seconds)
        if status >= self._log_from:
            LOG.info(
                "request",
                extra={
                    "request_id": exchange.id,
                    "operation": exchange.operation,
                    "method": exchange.scope["method"],
                    "status": status,
                    "milliseconds": round(1e3 * seconds, 3),
                },
            )

    def counted(self, code: str) -> None:
        """Count a problem."""
        self._metrics.problem(code)


class Exchange:
    """One request and its response."""

    __slots__ = (
        "_also",
        "_dispatcher",
        "_identity",
        "_receive",
        "_send",
        "_since",
        "headers",
        "key",
        "operation",
        "scope",
        "started",
    )

    def __init__(self, dispatcher: Dispatcher, operation: str, scope: Scope, receive: Receive, send: Send) -> None:
        self._since = perf_counter()
        self._dispatcher, self.operation, self.scope = dispatcher, operation, scope
        self._receive, self._send = receive, send
        self.headers: dict[bytes, bytes] = dict(scope["headers"])
        self.started = False
        self.key: Key | None = None
        self._also = dispatcher.cors.headers(self.headers) if dispatcher.cors else ()
        given = self.headers.get(b"x-request-id")
        self._identity = given if given and _REQUEST_ID.fullmatch(given) else dispatcher.next_id()

    @property
    def id(self) -> str:
        """The request's id: the client's own where it is short and plain, otherwise a new one."""
        return self._identity.decode()

    @property
    def receive(self) -> Receive:
        """Where the body comes from."""
        return self._receive

    async def gone(self) -> None:
        """Return when the client has closed the connection; the body must have been read."""
        while (await self._receive())["type"] != "http.disconnect":
            pass

    async def answer(self, body: bytes, etag: bytes) -> None:
        """Send an answer in one piece, or that the client has it already."""
        if b"if-none-match" in self.headers and self._has(etag):
            await self._respond(304, b"", [(b"etag", etag)])
            return
        # The same as `_respond`, in line: this is where most requests end.
        since, self.started = self._since, True
        send = self._send
        headers = [
            _JSON,
            (b"content-length", b"%d" % len(body)),
            (b"etag", etag),
            _NOSNIFF,
            (b"x-request-id", self._identity),
            (b"server-timing", b"total;dur=%.3f" % (1e3 * (perf_counter() - since))),
        ]
        if self._also:
            headers += self._also
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": body})
        self._dispatcher.finished(self, 200, perf_counter() - since)

    async def page(self, body: bytes, media_type: bytes, status: int) -> None:
        """Send a document in one piece, or that the client has it already."""
        headers: list[Header] = [_REVALIDATE]
        if media_type.startswith(b"text/html"):
            headers += _PAGE_HEADERS
        if status == 200:
            etag = etag_of(body)
            headers.append((b"etag", etag))
            if self._has(etag):
                await self._respond(304, b"", headers)
                return
        headers += [(b"content-type", media_type), (b"content-length", b"%d" % len(body))]
        await self._respond(status, b"" if self.scope["method"] == "HEAD" else body, headers)

    async def represented(self, body: bytes, media_type: bytes) -> None:
        """Send an answer that is not JSON, or that the client has it already."""
        etag = etag_of(body)
        headers: list[Header] = [(b"etag", etag), (b"vary", b"accept")]
        if self._has(etag):
            await self._respond(304, b"", headers)
            return
        headers += [(b"content-type", media_type), (b"content-length", b"%d" % len(body))]
        await self._respond(200, body, headers)

    async def empty(self, headers: Sequence[Header]) -> None:
        """Send nothing but headers."""
        await self._respond(204, b"", list(headers))

    async def problem(self, problem: Problem) -> None:
        """Send a problem document."""
        self._dispatcher.counted(problem.type.code)
        body = problem.body()
        headers = [_PROBLEM, (b"content-length", b"%d" % len(body))]
        headers += [(name.lower().encode(), value.encode()) for name, value in problem.headers]
        await self._respond(problem.type.status, b"" if self.scope["method"] == "HEAD" else body, headers)

    async def stream(self, pieces: Iterable[bytes], etag: bytes, headers: Sequence[Header] = (_JSON,)) -> None:
        """Send an answer piece by piece, letting other requests run in between."""
        if self._has(etag):
            await self._respond(304, b"", [(b"etag", etag)])
            return
        await self._start(200, [*headers, (b"etag", etag)])
        for piece in pieces:
            await self._send({"type": "http.response.body", "body": piece, "more_body": True})
            await asyncio.sleep(0)
        await self._send({"type": "http.response.body", "body": b"", "more_body": False})
        self.close(200)

    def close(self, status: int) -> None:
        """Count the request as finished."""
        self._dispatcher.finished(self, status, perf_counter() - self._since)

    def _has(self, etag: bytes) -> bool:
        known = self.headers.get(b"if-none-match")
        return known is not None and (known == b"*" or etag in [tag.strip() for tag in known.split(b",")])

    async def _respond(self, status: int, body: bytes, headers: list[Header]) -> None:
        await self._start(status, headers)
        await self._send({"type": "http.response.body", "body": body})
        self.close(status)

    async def _start(self, status: int, headers: list[Header]) -> None:
        milliseconds = 1e3 * (perf_counter() - self._since)
        headers += (
            _NOSNIFF,
            (b"x-request-id", self._identity),
            (b"server-timing", b"total;dur=%.3f" % milliseconds),
        )
        headers += self._also
        self.started = True
        await self._send({"type": "http.response.start", "status": status, "headers": headers})


def etag_of(*parts: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    digest = hashlib.blake2b(parts[0], digest_size=12)
    for part in parts[1:]:
        digest.update(part)
    return b'"' + digest.hexdigest().encode() + b'"'


def _forever(value: str) -> Iterable[str]:
    while True:
        yield value

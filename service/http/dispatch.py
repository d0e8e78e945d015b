"""The request path: a pure ASGI application that serves the route table.

FastAPI documents the same table and can serve it too, through `Dispatcher.serve`; going through its own machinery would
cost several times what a small question costs.
"""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine, Sequence
from typing import Any

from core.errors import MechanicsError
from service import VERSION
from service.execution.admission import Compute
from service.execution.request_handler import RequestHandler
from service.execution.response_cache import ResponseCache
from service.http.cors import Cors
from service.http.etag import JSON, Header, Representation, etag_of
from service.http.heads import Heads
from service.http.keys import Keys
from service.http.limits import ClientGone, Receive, negotiated, read_body, require_acceptable, require_json
from service.http.request_context import VARY, RequestContext, Scope, Send
from service.http.rounds import Rounds
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.observability.request_records import Records
from service.problems import REGISTRY, Problem, Refusal, problem_of
from service.requests.suggestions import nearest_path
from service.responses import npz as archive
from service.responses.json_stream import Document, composed
from service.routing import GetRoute, PostRoute, Route
from service.settings import Settings

_NPZ: tuple[Header, ...] = ((b"content-type", archive.MEDIA_TYPE.encode()), VARY)
_VERSION = VERSION.encode()


class Dispatcher:
    """Serves the routes.

    Parameters
    ----------
    routes : sequence of Route
        The one table.
    answering : RequestHandler
        Answers questions in this process.
    compute : Compute
        Answers questions in others.
    """

    def __init__(
        self,
        routes: Sequence[Route],
        *,
        answering: RequestHandler,
        compute: Compute,
        metrics: Metrics,
        settings: Settings,
    ) -> None:
        self._routes: dict[tuple[str, str], Route] = {(route.method, route.path): route for route in routes}
        self._answering, self._compute, self._metrics, self._settings = answering, compute, metrics, settings
        self._keys = None if settings.keys_file is None else Keys(settings.keys_file, settings.workers)
        self._cors = Cors(settings.cors_origins) or None
        self._kept = ResponseCache(settings.cached_answers, settings.cached_bytes)
        self._records = Records(metrics, settings.log_requests)
        self.rounds = self._made_rounds()

    def _made_rounds(self) -> Rounds | None:
        """Return the rounds in which plain small questions are answered, or None where each request is looked at."""
        if self._keys is not None or self._cors is not None:
            return None
        settings = self._settings
        heads = Heads(self._routes, min(settings.max_body_bytes, settings.inline_bytes))
        return Rounds(heads, self._answering, self._kept, self._metrics, self._records, settings.inline_seconds)

    def __call__(self, scope: Scope, receive: Receive, send: Send) -> Coroutine[Any, Any, None]:
        """Serve one HTTP request, when awaited."""
        method = scope["method"]
        route = self._routes.get(("GET" if method == "HEAD" else method, scope["path"]))
        if route is None:
            return self._unrouted(scope, receive, send)
        return self.serve(route, scope, receive, send)

    async def serve(self, route: Route, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one HTTP request that has been routed."""
        exchange = RequestContext(self._records, self._cors, route.operation_id, scope, receive, send)
        try:
            if isinstance(route, PostRoute):
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

    async def _question(self, route: PostRoute, exchange: RequestContext) -> None:
        settings, headers = self._settings, exchange.headers
        if self._keys is not None:
            exchange.key = self._keys.admit(headers)
        require_json(headers)
        media = None
        accept = headers.get(b"accept", b"*/*")
        if accept != b"*/*" and accept != b"application/json":
            media = negotiated(accept, (*route.representations, archive.MEDIA_TYPE))
        body = await read_body(exchange.receive, headers, settings.max_body_bytes)
        whole = self._kept.get(route.path, body) if media is None else None
        if whole is not None:
            self._metrics.cache_hits.inc()
        else:
            document = await self._document(route, body, media, exchange)
            if media == archive.MEDIA_TYPE:
                await self._stream(document, _etag_of_answer(route, body, media), exchange, _NPZ)
                return
            if media is not None:
                await exchange.represented(document.whole(), media.encode())
                return
            if document.large:
                await self._stream(document, _etag_of_answer(route, body), exchange)
                return
            whole = Representation(document.whole())
            self._kept.put(route.path, body, whole)
        await exchange.answer(whole)

    async def _stream(
        self, document: Document, etag: bytes, exchange: RequestContext, headers: Sequence[Header] = (JSON,)
    ) -> None:
        self._metrics.samples.inc(document.numbers)
        with self._compute.holding(document.memory):
            await exchange.stream(document.pieces(), etag, self._settings.stalled_seconds, headers)

    async def _document(self, route: PostRoute, body: bytes, media: str | None, exchange: RequestContext) -> Document:
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

    async def _page(self, route: GetRoute, exchange: RequestContext) -> None:
        reply = route.content()
        if b"accept" in exchange.headers:
            require_acceptable(exchange.headers[b"accept"], reply.media_type.split(b";", 1)[0])
        await exchange.page(reply.body, reply.media_type, reply.status)

    async def _unrouted(self, scope: Scope, receive: Receive, send: Send) -> None:
        exchange = RequestContext(self._records, self._cors, "none", scope, receive, send)
        methods = [method for method, path in self._routes if path == scope["path"]]
        preflight = self._cors.preflight(scope["method"], exchange.headers) if self._cors and methods else None
        if preflight is not None:
            await exchange.empty(preflight)
            return
        if methods:
            allowed = ", ".join(methods + (["HEAD"] if "GET" in methods else []))
            detail = f"this path answers {allowed}"
            problem = Problem(REGISTRY["method-not-allowed"], detail, headers=(("Allow", allowed),))
        else:
            near = nearest_path(scope["path"], dict.fromkeys(path for _, path in self._routes))
            meant = f"did you mean {near}? " if near else ""
            detail = f"there is nothing at this path; {meant}GET /openapi.json lists every path"
            problem = Problem(REGISTRY["not-found"], detail)
        await exchange.problem(problem)


def _etag_of_answer(route: PostRoute, body: bytes, media: str = "application/json") -> bytes:
    """Return the validator of an answer that is not written yet: question and version determine it to the bit."""
    return etag_of(_VERSION, route.path.encode(), media.encode(), body)

"""The handlers of the route table: from a request to its response, as ASGI applications."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from starlette.types import ASGIApp, Receive, Scope, Send

from core.errors import MechanicsError
from service import VERSION
from service.execution.admission import Compute, Sender
from service.execution.executor import Executor
from service.execution.request_handler import RequestHandler
from service.execution.response_cache import ResponseCache
from service.http.deprecation import DEPRECATED
from service.http.etag import JSON, Header, Representation, etag_of
from service.http.keys import Keys
from service.http.limits import (
    Bodies,
    ClientGone,
    idempotency_key,
    negotiated,
    parameters_of,
    refuse_parameters,
    require_readable,
)
from service.http.request_context import BUFFERED, VARY, RequestContext
from service.observability.failed_checks import FailedChecks
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.observability.request_records import Records
from service.problem_types import OVERDUE, REGISTRY
from service.problems import Problem, Refusal, problem_of
from service.requests.suggestions import nearest_path
from service.responses import npz as archive
from service.responses.json_stream import Document
from service.routing import ENDINGS, GetRoute, PostRoute, ResourceRoute, Route, StudyRoute
from service.settings import Settings

_NPZ: tuple[Header, ...] = ((b"content-type", archive.MEDIA_TYPE.encode()), VARY)
_VERSION = VERSION.encode()


_RESPOND_ASYNC = b"respond-async"
_APPLIED: Header = (b"preference-applied", _RESPOND_ASYNC)
"""RFC 7240, 3 and 4.1."""

Submit = Callable[[RequestContext, bytes, bytes, tuple[Header, ...]], Awaitable[None]]
"""Stores a study, given its request and its plan, and answers, with some headers more."""


class Dispatcher:
    """Serves the routes: `answering` answers questions in this process, `compute` in others, `submit` stores studies.

    While the service is `starting`, questions are refused: answered in this process, they would compile kernels in it.

    Attributes
    ----------
    handlers : mapping
        By method and path, an ASGI application for HTTP requests; HEAD is served where GET is.
    """

    def __init__(
        self,
        routes: Sequence[Route],
        *,
        answering: RequestHandler,
        compute: Compute,
        metrics: Metrics,
        settings: Settings,
        keys: Keys | None = None,
        submit: Submit | None = None,
        starting: Callable[[], bool] = lambda: False,
    ) -> None:
        self._submit, self._starting = submit, starting
        studies = (route for route in routes if isinstance(route, StudyRoute))
        self._later: frozenset[str] = frozenset().union(*(route.paths for route in studies))
        self._compute, self._metrics, self._settings, self._keys = compute, metrics, settings, keys
        self._executor = Executor(answering, compute, metrics, settings)
        self._turns = asyncio.Lock()
        self._cache = ResponseCache(settings.cached_answers)
        self._records = Records(metrics, settings.log_requests)
        self._failed = FailedChecks(settings.failed_requests, metrics)
        self.bodies = Bodies(settings.max_body_bytes, compute.held, settings.body_seconds)
        handlers: dict[tuple[str, str], ASGIApp] = {}
        for route in routes:
            handler: ASGIApp = partial(self._serve, route)
            if (deprecation := DEPRECATED.get(route.operation_id)) is not None:
                handler = deprecation.announced(handler)
            forms = {"": handler} | {ending: _in_form(handler, media) for media, ending in _endings(route).items()}
            for ending, form in forms.items():
                handlers[route.method, route.path + ending] = form
                if route.method == "GET":
                    handlers["HEAD", route.path + ending] = form
        self.handlers: Mapping[tuple[str, str], ASGIApp] = handlers

    async def _serve(self, route: Route, scope: Scope, receive: Receive, send: Send) -> None:
        context = RequestContext(self._records, route.operation_id, scope, receive, send)
        try:
            if self._starting() and isinstance(route, PostRoute | StudyRoute):
                detail = "kernels are being compiled; GET /readyz answers 200 when that is done"
                raise Refusal("not-ready", detail, retry_after=2.0)
            if isinstance(route, PostRoute | StudyRoute):
                refuse_parameters(parameters_of(scope), "must be left out: all of a question is in its body")
            if isinstance(route, StudyRoute):
                await self._study(route, context)
            elif isinstance(route, PostRoute):
                await self._question(route, context)
            elif isinstance(route, ResourceRoute):
                if self._keys is not None:
                    context.key = self._keys.admit(context.headers, context.address)
                await route.respond(context)
            else:
                await self._page(route, context)
        except Refusal as refusal:
            await context.problem(refusal.problem)
        except MechanicsError as error:
            await context.problem(problem_of(error))
        except ClientGone:
            context.close(499)
        except asyncio.CancelledError:
            # The server is being stopped and will not wait any longer.
            if not context.started:
                await context.problem(
                    Problem(REGISTRY["shutting-down"], "the service is being stopped", retry_after=1.0)
                )
        except Exception:
            if context.started:
                # The answer is cut short, which the transfer coding shows the client.
                LOG.exception("failed in the middle of an answer", extra={"request_id": context.id})
                raise
            LOG.exception("failed", extra={"request_id": context.id, "operation": route.operation_id})
            detail = "the service failed; the failure is logged under this id"
            await context.problem(Problem(REGISTRY["internal-error"], detail, extra={"id": context.id}))

    async def _question(self, route: PostRoute, context: RequestContext) -> None:
        headers = context.headers
        if self._keys is not None:
            context.key = self._keys.admit(headers, context.address)
        npz = require_readable(headers, parts=route.takes_parts)
        idempotency_key(headers)
        media = None
        accept = headers.get(b"accept", b"*/*")
        if accept != b"*/*" and accept != b"application/json":
            media = negotiated(accept, ("application/json", *route.representations, archive.MEDIA_TYPE))
            media = None if media == "application/json" else media
        body = await self.bodies.read(context.receive, headers, context.client)
        if route.path in self._later and media is None and not npz and _preferred(headers):
            await self._question_later(route, context, body)
            return
        answer = self._cache.get(route.path, body) if media is None else None
        if answer is not None:
            self._metrics.cache_hits.inc()
        else:
            sender = Sender(context.client, context.key, context.gone)
            try:
                document = await self._executor.answer(route, body, npz, media, sender)
            except (Refusal, MechanicsError) as error:
                problem = error.problem if isinstance(error, Refusal) else problem_of(error)
                self._failed.record(context.id, route.operation_id, body, problem)
                if problem.type.code == OVERDUE:
                    raise Refusal.of(_with_remedy(problem, route.path in self._later)) from None
                raise
            if media == archive.MEDIA_TYPE:
                await self._stream(document, _etag_of_answer(route, body, media), context, _NPZ)
                return
            if media is not None:
                await self._answer(
                    Representation(document.whole(), (b"content-type", media.encode()), (VARY,)), context
                )
                return
            if document.large:
                await self._stream(document, _etag_of_answer(route, body), context)
                return
            answer = Representation(document.whole())
            self._cache.put(route.path, body, answer)
        await self._answer(answer, context)

    async def _answer(self, answer: Representation, context: RequestContext) -> None:
        with self._compute.held.answering(context.client, len(answer.body)):
            await context.answer(answer)

    async def _question_later(self, route: PostRoute, context: RequestContext, body: bytes) -> None:
        """Answer with the state of a study of one answer, once the request has been read."""
        sender = Sender(context.client, context.key, context.gone)
        plan = await self._executor.answer(route, body, False, None, sender, later=True)
        assert self._submit is not None
        await self._submit(context, body, plan.whole(), (_APPLIED,))

    async def _study(self, route: StudyRoute, context: RequestContext) -> None:
        """Answer the request of a study with its plan, in thought, and then store it."""
        if self._keys is not None:
            context.key = self._keys.admit(context.headers, context.address)
        if require_readable(context.headers):
            raise Refusal("unsupported-media-type", "the request of a study is JSON: Content-Type: application/json")
        negotiated(context.headers.get(b"accept", b"*/*"), ("application/json",))
        body = await self.bodies.read(context.receive, context.headers, context.client)
        sender = Sender(context.client, context.key, context.gone)
        plan = await self._executor.answer(route, body, False, None, sender)
        assert self._submit is not None
        await self._submit(context, body, plan.whole(), ())

    async def _stream(
        self, document: Document, etag: bytes, context: RequestContext, headers: Sequence[Header] = (JSON,)
    ) -> None:
        self._metrics.samples.inc(document.numbers)
        with self._compute.held.answering(context.client, document.memory):
            await context.stream(document.pieces(), etag, self._settings.stalled_seconds, headers, self._turns)

    async def _page(self, route: GetRoute, context: RequestContext) -> None:
        if not route.takes_parameters:
            refuse_parameters(parameters_of(context.scope), "is not known here", "a catalogue is answered as a whole")
        reply = route.content()
        if b"accept" in context.headers:
            negotiated(context.headers[b"accept"], (route.media_type,))
        held = self._compute.held
        if len(reply.body) > BUFFERED:
            held.require_share(context.client)
        with held.answering(context.client, len(reply.body)):
            await context.page(
                reply.body,
                reply.media_type,
                reply.status,
                kept=route.fixed,
                frame_ancestors=self._settings.frame_ancestors,
            )

    async def unknown_host(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request to a name that is not the service's (a page may have its own name lead to this address)."""
        detail = "the Host of the request is not one of the setting allowed_hosts"
        await RequestContext(self._records, "none", scope, receive, send).problem(
            Problem(REGISTRY["unknown-host"], detail)
        )

    async def unrouted(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request that no handler is there for."""
        context = RequestContext(self._records, "none", scope, receive, send)
        path = scope["path"].removeprefix(scope.get("root_path", ""))
        methods = [method for method, known in self.handlers if _leads_to(known, path)]
        allowed = ", ".join([*methods, "OPTIONS"])
        if methods and scope["method"] == "OPTIONS":
            await context.empty(((b"allow", allowed.encode()),))
            return
        if methods:
            detail = f"this path answers {allowed}"
            problem = Problem(REGISTRY["method-not-allowed"], detail, headers=(("Allow", allowed),))
        else:
            near = nearest_path(path, dict.fromkeys(known for _, known in self.handlers))
            meant = f"did you mean {near}? " if near else ""
            detail = f"there is nothing at this path; {meant}GET /openapi.json lists every path"
            problem = Problem(REGISTRY["not-found"], detail)
        await context.problem(problem)


def _endings(route: Route) -> Mapping[str, str]:
    """Return the media types of the forms that a route answers under a path of their own, with its endings."""
    archived = isinstance(route, PostRoute) and not isinstance(route, StudyRoute)
    return {**route.endings, **({archive.MEDIA_TYPE: ENDINGS[archive.MEDIA_TYPE]} if archived else {})}


def _in_form(handler: ASGIApp, media: str) -> ASGIApp:
    """Return a handler that answers in a media type, whatever its requests accept."""

    async def serve(scope: Scope, receive: Receive, send: Send) -> None:
        others = [header for header in scope["headers"] if header[0] != b"accept"]
        await handler({**scope, "headers": [*others, (b"accept", media.encode())]}, receive, send)

    return serve


def _with_remedy(problem: Problem, later: bool) -> Problem:
    """Return the problem of a computation that took too long, with what helps; `later` if it may take place later."""
    remedy = (
        "with the header Prefer: respond-async it is answered in the background, as a study"
        if later
        else "requests to this path are not answered in the background: ask for less"
    )
    return replace(problem, detail=f"{problem.detail}; {remedy}")


def _preferred(headers: Mapping[bytes, bytes]) -> bool:
    """Return whether the answer is preferred later, as a study of one."""
    preferences = headers.get(b"prefer", b"").lower().replace(b";", b",").split(b",")
    return _RESPOND_ASYNC in (each.strip() for each in preferences)


def _leads_to(template: str, path: str) -> bool:
    """Return whether a path is a template with something in place of each parameter in braces."""
    known, given = template.split("/"), path.split("/")
    pairs = zip(known, given, strict=False)
    return len(known) == len(given) and all(a == b or (a.startswith("{") and b != "") for a, b in pairs)


def _etag_of_answer(route: PostRoute, body: bytes, media: str = "application/json") -> bytes:
    """Return the validator of an answer that is not written yet: question and version determine it to the bit."""
    return etag_of(_VERSION, route.path.encode(), media.encode(), body)

"""The application: FastAPI with the route table, and the life cycle of its parts.

``uvicorn service.app:app`` or any other ASGI server serves it; ``python -m service`` is the same under uvicorn with the
service's settings.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
from collections.abc import AsyncIterator
from pkgutil import resolve_name
from typing import Any

import orjson
from fastapi import FastAPI
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

from service.execution.admission import Compute
from service.execution.daemon_thread import run_in_daemon_thread
from service.execution.request_handler import RequestHandler
from service.execution.supervision import end_with_supervisor, remove_temporary_files
from service.execution.unused_memory import give_back
from service.http.dispatch import Dispatcher
from service.http.keys import Keys
from service.http.target import host_of, is_allowed, of_target
from service.observability import traces
from service.observability.logs import LOG, configure
from service.observability.metrics import Metrics
from service.openapi.document import ABOUT, openapi, serve_routes
from service.routes.catalogues import catalogues
from service.routes.operations import operations
from service.routes.pages import pages
from service.routing import TABLE, PostRoute, Route, StudyRoute
from service.settings import Settings
from service.studies.resources import Studies
from service.studies.supervisor import Supervisor


class Service(FastAPI):
    """The application.

    A request whose method and path are in the route table goes straight to its handler, by one look into a dict;
    FastAPI would try the routes one by one and pass the request through six middlewares, at five times the cost of a
    small answer. Everything else (unknown paths, methods and protocols, start and stop) takes FastAPI's own way.

    Parameters
    ----------
    settings : Settings
    table : str
        Where the questions are: ``"module:function"``.

    Attributes
    ----------
    address : str
        URL under which the service is announced as ready, where it is known.
    table : tuple of Route
        Everything that is served.
    warm : bool
        Whether every kernel is compiled and the compute processes have been up.
    """

    def __init__(self, settings: Settings, table: str = TABLE) -> None:
        super().__init__(**ABOUT, lifespan=self.lifespan)
        self.settings = settings
        self.warm, self.address = False, ""
        self._starting = False
        self.metrics = Metrics()
        questions: tuple[PostRoute, ...] = resolve_name(table)()
        self.compute = Compute(settings, self.metrics, table)
        terms = self.compute.terms
        self.answering = RequestHandler(questions, terms.budget, terms.limits)
        self._supervisor = Supervisor(settings, table, self.metrics)
        studies = Studies(settings, self._supervisor, self.compute)
        self.table: tuple[Route, ...] = (
            *questions,
            *(studies.routes() if any(isinstance(route, StudyRoute) for route in questions) else ()),
            *catalogues(),
            *operations(ready=lambda: self.warm and self.compute.any_ready, metrics=self.metrics, audit=settings.audit),
            *pages(self.openapi_text),
        )
        self._keys = None if settings.keys_file is None else Keys(settings.keys_file, settings.workers)
        dispatcher = Dispatcher(
            self.table,
            answering=self.answering,
            compute=self.compute,
            metrics=self.metrics,
            settings=settings,
            keys=self._keys,
            submit=studies.submit,
            starting=lambda: self._starting,
        )
        # Paths with parameters in braces are matched by FastAPI, which reads the parameters.
        self._unknown_host = dispatcher.unknown_host
        self._hosts = [name.strip().lower() for name in settings.allowed_hosts.split(",") if name.strip()]
        self._handlers = {route: handler for route, handler in dispatcher.handlers.items() if "{" not in route[1]}
        self._bodies = dispatcher.bodies
        serve_routes(self, dispatcher.handlers, dispatcher.unrouted)
        self._http = self._with_cors(self._known_or_not)
        self._openapi_text = b""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request, or the server's start and stop."""
        await (self._http if scope["type"] == "http" else super().__call__)(scope, receive, send)

    async def _known_or_not(self, scope: Scope, receive: Receive, send: Send) -> None:
        path: str = scope["path"]
        if root := scope.get("root_path"):
            path = path.removeprefix(root)
        if not path.startswith("/"):
            host, path = of_target(path)
            scope = {**scope, "path": (root or "") + path, "raw_path": path.encode()}
            if host:
                # It takes the place of the Host header (RFC 9112, 3.2.2).
                others = [header for header in scope["headers"] if header[0] != b"host"]
                scope["headers"] = [(b"host", host.encode()), *others]
        handler = self._handlers.get((scope["method"], path)) or super().__call__
        if self._hosts and not is_allowed(host_of(scope["headers"]), self._hosts):
            handler = self._unknown_host
        await handler(scope, receive, send)

    def _with_cors(self, app: ASGIApp) -> ASGIApp:
        origins = [origin.strip() for origin in self.settings.cors_origins.split(",") if origin.strip()]
        if not origins:
            return app
        return CORSMiddleware(
            app,
            allow_origins=origins,
            allow_methods=("GET", "HEAD", "POST", "DELETE"),
            allow_headers=(
                *("authorization", "content-type", "idempotency-key", "if-none-match", "prefer"),
                *("traceparent", "x-request-id"),
            ),
            expose_headers=(
                *("deprecation", "etag", "link", "location", "preference-applied", "retry-after", "server-timing"),
                *("sunset", "x-request-id"),
            ),
            max_age=3600,
        )

    def openapi(self) -> dict[str, Any]:
        """Return the OpenAPI document."""
        return openapi(self.table)

    def openapi_text(self) -> bytes:
        """Return the OpenAPI document as JSON."""
        if not self._openapi_text:
            self._openapi_text = orjson.dumps(self.openapi())
        return self._openapi_text

    @contextlib.asynccontextmanager
    async def lifespan(self, app: Any = None) -> AsyncIterator[None]:
        """Get ready, in one server process while health is already answered; stop the compute processes at the end."""
        if not LOG.hasHandlers():
            # Servers configure their own logging, not that of an application.
            configure(self.settings.log_level)
        self._starting = True
        end_traces = traces.export() if self.settings.traces else None
        kept_up = [self._warm(), self._publish(), self._bodies.watch(), self._supervisor.watch()]
        if self._keys is not None:
            kept_up.append(self._keys.follow())
        tasks = [asyncio.create_task(work) for work in kept_up]
        end_with_supervisor()
        try:
            if self.settings.workers > 1:
                # Connections that this process does not accept yet are accepted by the others: whichever answers a
                # request is ready.
                await tasks[0]
            yield
        finally:
            self.warm = False
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await asyncio.gather(self.compute.stop(), self._supervisor.stop())
            self._supervisor.store.close()
            if end_traces is not None:
                await run_in_daemon_thread(end_traces)
            remove_temporary_files()

    async def _warm(self) -> None:
        try:
            await asyncio.gather(run_in_daemon_thread(self._prepare), self.compute.start())
        except Exception:
            LOG.exception("the service could not get ready")
            raise
        # What has been built until now stays for good: the collector of garbage need not walk through it ever again.
        gc.freeze()
        gc.enable()
        give_back()
        self.warm, self._starting = True, False
        at = f" at {self.address}" if self.address else ""
        LOG.info("ready%s", at, extra={"compute_processes": self.compute.size})

    async def _publish(self) -> None:
        while self.metrics.shared is not None:
            self.metrics.shared.publish()
            await asyncio.sleep(1.0)

    def _prepare(self) -> None:
        # What writing the document leaves free is taken up by what stays.
        self.openapi_text()
        self.answering.warm(work=self.settings.inline_work)


def create_app(settings: Settings | None = None) -> Service:
    """Return the application; settings come from the environment unless given."""
    return Service(settings or Settings())


app = create_app()

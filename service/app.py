"""The application: puts the parts together and holds their life cycle."""

from __future__ import annotations

import asyncio
import contextlib
import gc
from collections.abc import AsyncIterator
from pkgutil import resolve_name
from typing import Any

import orjson
from fastapi import FastAPI

from service.execution.admission import Compute
from service.execution.daemon_thread import run_in_daemon_thread
from service.execution.request_handler import RequestHandler
from service.execution.supervision import end_with_supervisor
from service.http.dispatch import Dispatcher
from service.http.limits import Receive
from service.http.request_context import Scope, Send
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.openapi.document import documented, openapi
from service.routes.catalogues import catalogues
from service.routes.operations import operations
from service.routes.pages import pages
from service.routing import TABLE, PostRoute, Route
from service.settings import Settings


class Service:
    """The ASGI application.

    Attributes
    ----------
    routes : tuple of Route
        The one table.
    documented : FastAPI
        The same table as FastAPI sees it: the OpenAPI document, and a second way in that answers the same bytes.
    warm : bool
        Whether every kernel is compiled and the compute processes have been up.
    """

    def __init__(self, settings: Settings, table: str = TABLE) -> None:
        self.settings = settings
        self.warm = False
        self.metrics = Metrics()
        asked: tuple[PostRoute, ...] = resolve_name(table)()
        self.compute = Compute(settings, self.metrics, table)
        terms = self.compute.terms
        self._answering = RequestHandler(asked, terms.budget, terms.limits)
        self.routes: tuple[Route, ...] = (
            *asked,
            *catalogues(),
            *operations(ready=lambda: self.warm and self.compute.any_ready, metrics=self.metrics),
            *pages(self.openapi),
        )
        self.dispatcher = Dispatcher(
            self.routes, answering=self._answering, compute=self.compute, metrics=self.metrics, settings=settings
        )
        self.documented: FastAPI = documented(self.routes, self.dispatcher.serve, self.lifespan)
        self._openapi = b""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request, or the server's start and stop."""
        if scope["type"] == "http":
            await self.dispatcher(scope, receive, send)
        elif scope["type"] == "lifespan":
            await self.documented(scope, receive, send)
        else:
            # Websockets are not spoken here.
            await send({"type": "websocket.close", "code": 1000})

    def openapi(self) -> bytes:
        """Return the OpenAPI document as JSON."""
        if not self._openapi:
            self._openapi = orjson.dumps(openapi(self.documented), option=orjson.OPT_INDENT_2)
        return self._openapi

    @contextlib.asynccontextmanager
    async def lifespan(self, app: Any = None) -> AsyncIterator[None]:
        """Get ready in the background, while health is already answered; stop the compute processes at the end."""
        warming = asyncio.create_task(self._warm())
        publishing = asyncio.create_task(self._publish())
        end_with_supervisor()
        try:
            yield
        finally:
            self.warm = False
            publishing.cancel()
            warming.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await warming
            await self.compute.stop()

    async def _warm(self) -> None:
        try:
            await asyncio.gather(run_in_daemon_thread(self._prepare), self.compute.start())
        except Exception:
            LOG.exception("the service could not get ready")
            raise
        # What has been built until now stays for good: the collector of garbage need not walk through it ever again.
        gc.collect()
        gc.freeze()
        self.warm = True
        LOG.info("ready", extra={"compute_processes": self.compute.size})

    async def _publish(self) -> None:
        while self.metrics.shared is not None:
            self.metrics.shared.publish()
            await asyncio.sleep(1.0)

    def _prepare(self) -> None:
        self._answering.warm()
        self.openapi()


def create_app(settings: Settings | None = None) -> Service:
    """Return the application; settings come from the environment unless given."""
    return Service(settings or Settings())

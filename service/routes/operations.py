"""For those who run the service: is it alive, is it ready, what has it done."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import Field

from service.observability.metrics import CONTENT_TYPE, Metrics
from service.problem_types import REGISTRY
from service.problems import MEDIA_TYPE, Problem
from service.routing import GetRoute, Reply
from service.schemas import View


class Status(View):
    """State of the service."""

    status: str = Field(description="alive, or ready.")
    audit: str | None = Field(
        default=None,
        description='"off" where answers are not checked against the laws of mechanics before they are sent.',
    )


_ALIVE = Reply(b'{"status":"alive"}')
_READY = Reply(b'{"status":"ready"}')
_READY_WITHOUT_AUDIT = Reply(b'{"status":"ready","audit":"off"}')


def operations(*, ready: Callable[[], bool], metrics: Metrics, audit: bool) -> tuple[GetRoute, ...]:
    """Return the routes for operation."""
    preparing = Problem(REGISTRY["not-ready"], "kernels are being compiled and compute processes started")
    prepared = _READY if audit else _READY_WITHOUT_AUDIT
    waiting = Reply(preparing.body(), MEDIA_TYPE.encode(), 503)

    return (
        GetRoute(
            "/healthz",
            "get_health",
            "Whether the process answers",
            "operations",
            lambda: _ALIVE,
            Status,
            example=lambda: {"status": "alive"},
        ),
        GetRoute(
            "/readyz",
            "get_readiness",
            "Whether every kernel is compiled and the compute processes are up",
            "operations",
            lambda: prepared if ready() else waiting,
            Status,
            example=lambda: {"status": "ready"},
        ),
        GetRoute(
            "/metrics",
            "get_metrics",
            "Counters in Prometheus' text format",
            "operations",
            lambda: Reply(metrics.exposition(), CONTENT_TYPE),
            media_type="text/plain",
        ),
    )

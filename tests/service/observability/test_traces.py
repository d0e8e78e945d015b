"""Spans of requests and computations, received by a tracer that keeps them (the API's classes; no exporter)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from opentelemetry import trace
from opentelemetry.context import Context
from opentelemetry.trace import NonRecordingSpan, SpanContext, StatusCode, TraceFlags

from service.observability import traces
from tests.service.conftest import client_of, inline_toys
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

TRACE, PARENT = 0x4BF92F3577B34DA6A3CE929D0E0E4736, 0x00F067AA0BA902B7
TRACEPARENT = f"00-{TRACE:032x}-{PARENT:016x}-01"
"""The example of W3C Trace Context, 3.2.2.5."""


class Kept(NonRecordingSpan):
    def __init__(self, name: str, parent: SpanContext, number: int) -> None:
        super().__init__(SpanContext(parent.trace_id or 1, number, False, TraceFlags(1)))
        self.name, self.parent = name, parent
        self.attributes: dict[str, Any] = {}
        self.status: Any = None
        self.ended = False

    def set_attribute(self, key: str, value: Any) -> None:
        self.attributes[key] = value

    def set_status(self, status: Any, description: str | None = None) -> None:
        self.status = status

    def end(self, end_time: int | None = None) -> None:
        self.ended = True


class Tracer:
    def __init__(self) -> None:
        self.spans: list[Kept] = []

    def start_span(self, name: str, context: Context | None, kind: Any, attributes: Any) -> Kept:
        span = Kept(name, trace.get_current_span(context).get_span_context(), len(self.spans) + 1)
        span.attributes |= attributes
        self.spans.append(span)
        return span

    @contextmanager
    def start_as_current_span(self, name: str, *, attributes: Any, **options: Any) -> Iterator[Kept]:
        span = self.start_span(name, None, None, attributes)
        yield span
        span.end()


@pytest.fixture
def spans(monkeypatch: pytest.MonkeyPatch) -> list[Kept]:
    tracer = Tracer()
    monkeypatch.setattr(traces, "_TRACER", tracer)
    return tracer.spans


async def test_a_request_has_a_span_in_the_trace_of_its_client(spans: list[Kept]) -> None:
    async with client_of(inline_toys()) as client:
        response = await client.post("/v1/toy", json=GOOD, headers={"traceparent": TRACEPARENT, "x-request-id": "mine"})
        assert response.status_code == 200
        await client.post("/v1/toy", json=GOOD | {"behaviour": "fail"})
    first, second = spans
    assert (first.name, first.parent.trace_id, first.parent.span_id) == ("ask_toy", TRACE, PARENT)
    assert first.attributes == {
        "http.request.method": "POST",
        "polhode.request_id": "mine",
        "http.response.status_code": 200,
    }
    assert (first.ended, first.status) == (True, None)
    # A request without one has a trace of its own, whatever came before on its connection.
    assert not second.parent.is_valid
    assert (second.ended, second.status) == (True, StatusCode.ERROR)


async def test_a_computation_is_within_its_request(spans: list[Kept]) -> None:
    request = traces.begun("ask_toy", "POST", "mine", {})
    with traces.computing("/v1/toy") as span:
        span.set_attribute("polhode.used_seconds", 0.5)
    assert spans[1].parent == request.get_span_context()
    assert (spans[1].name, spans[1].ended) == ("compute", True)
    assert spans[1].attributes == {"url.path": "/v1/toy", "polhode.used_seconds": 0.5}

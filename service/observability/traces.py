"""OpenTelemetry traces: a span for each request, and within it one for each computation in a compute process.

Spans cost a microsecond each as long as nothing receives them; `export` sends them on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from opentelemetry import propagate, trace
from opentelemetry.context import Context, attach
from opentelemetry.trace import Span, SpanKind, StatusCode

from service import VERSION

_TRACER = trace.get_tracer("polhode", VERSION)


def begun(operation: str, method: str, identity: str, headers: Mapping[bytes, bytes]) -> Span:
    """Begin the span of a request, in the trace of its client where it names one (W3C Trace Context)."""
    context = Context()
    if b"traceparent" in headers:
        carrier = {name: headers[name.encode()].decode("latin-1") for name in _NAMES if name.encode() in headers}
        context = propagate.extract(carrier, context)
    attributes = {"http.request.method": method, "polhode.request_id": identity}
    span = _TRACER.start_span(operation, context, SpanKind.SERVER, attributes)
    # Each request has a task of its own, in which computations find its span.
    attach(trace.set_span_in_context(span))
    return span


_NAMES = ("traceparent", "tracestate")


def ended(span: Span, status: int) -> None:
    """End the span of a request."""
    span.set_attribute("http.response.status_code", status)
    if status >= 500:
        span.set_status(StatusCode.ERROR)
    span.end()


@contextmanager
def computing(path: str) -> Iterator[Span]:
    """Have a span for a computation, from its queue to its reply."""
    with _TRACER.start_as_current_span(
        "compute", attributes={"url.path": path}, record_exception=False, set_status_on_exception=False
    ) as span:
        yield span


def export() -> Callable[[], None]:
    """Send spans by OTLP to where the variables OTEL_* say; return what sends the last ones and ends that.

    Raises
    ------
    ImportError
        Without the extra ``polhode[traces]``.
    """
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
        from opentelemetry.sdk.resources import Resource
        from opentelemetry.sdk.trace import TracerProvider
        from opentelemetry.sdk.trace.export import BatchSpanProcessor
    except ImportError:
        raise ImportError("POLHODE_TRACES needs the extra polhode[traces]") from None

    provider = TracerProvider(resource=Resource.create({"service.name": "polhode", "service.version": VERSION}))
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter()))
    trace.set_tracer_provider(provider)

    def end() -> None:
        provider.shutdown()

    return end

"""What the service counts about itself, in a registry of its own, for GET /metrics."""

from __future__ import annotations

import os
from bisect import bisect_left
from collections.abc import Iterator
from itertools import accumulate
from pathlib import Path

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, HistogramMetricFamily
from prometheus_client.registry import Collector

from service.observability.shared_counts import DIRECTORY, SharedCounts

CONTENT_TYPE = b"text/plain; version=0.0.4; charset=utf-8"

_SECONDS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)


class Timings(Collector):
    """A histogram of requests by operation and status, counted by one process without a lock: the event loop's thread.

    The library's own takes two locks and a search from below for each observation, a tenth of a small answer's time.
    """

    def __init__(self, name: str, documentation: str) -> None:
        self._name, self._documentation = name, documentation
        # The last entry of each row is the sum of seconds.
        self._rows: dict[tuple[str, int], list[float]] = {}

    def observe(self, key: tuple[str, int], seconds: float) -> None:
        """Count a request."""
        row = self._rows.get(key)
        if row is None:
            row = self._rows[key] = [0.0] * (len(_SECONDS) + 2)
        row[bisect_left(_SECONDS, seconds)] += 1.0
        row[-1] += seconds

    def collect(self) -> Iterator[HistogramMetricFamily]:
        """Yield what was counted, as the library asks for it."""
        family = HistogramMetricFamily(self._name, self._documentation, labels=("operation", "status"))
        ends = [*map(str, _SECONDS), "+Inf"]
        for (operation, status), row in list(self._rows.items()):
            buckets = list(zip(ends, accumulate(row[:-1]), strict=True))
            family.add_metric((operation, str(status)), buckets, row[-1])
        yield family


class Tally(Collector):
    """A count kept by one process without a lock, likewise."""

    def __init__(self, name: str, documentation: str) -> None:
        self._name, self._documentation, self._count = name, documentation, 0

    def inc(self) -> None:
        """Count one more."""
        self._count += 1

    def collect(self) -> Iterator[CounterMetricFamily]:
        """Yield the count, as the library asks for it."""
        yield CounterMetricFamily(self._name, self._documentation, self._count)


class Metrics:
    """Counters and histograms of one server process, or of all of them where they share a directory.

    The one histogram of requests by operation and status gives rates, latencies and refusals, and costs one
    observation per request.
    """

    def __init__(self) -> None:
        self.registry = registry = CollectorRegistry()
        timings = Timings("polhode_request_seconds", "Time from the request's headers to the last byte of the answer.")
        self.cache_hits = Tally("polhode_cache_hits", "Answers given from the cache.")
        registry.register(timings)
        registry.register(self.cache_hits)
        self.observe = timings.observe
        directory = os.environ.get(DIRECTORY)
        self.shared = None if directory is None else SharedCounts(registry, Path(directory))
        self._problems = Counter("polhode_problems", "Answers that are problems.", ("code",), registry=registry)
        self.samples = Counter("polhode_samples", "Numbers in arrays of large answers.", registry=registry)
        self.job_seconds = Histogram(
            "polhode_job_seconds", "Time of questions in compute processes.", buckets=_SECONDS, registry=registry
        )
        self.long_inline = Counter(
            "polhode_long_inline", "Requests that held the event loop for more than 20 ms.", ("operation",),
            registry=registry,
        )  # fmt: skip
        self.handed_over = Counter(
            "polhode_handed_over", "Requests that were begun in the event loop and given to a compute process.",
            ("operation",), registry=registry,
        )  # fmt: skip
        self.backlog = Gauge("polhode_backlog_seconds", "Predicted time of the work that waits.", registry=registry)
        self.workers_lost = Counter("polhode_workers_lost", "Compute processes that died.", registry=registry)

    def problem(self, code: str) -> None:
        """Count an answer that is a problem."""
        self._problems.labels(code).inc()

    def exposition(self) -> bytes:
        """Return everything in Prometheus' text format."""
        if self.shared is None:
            return generate_latest(self.registry)
        summed = CollectorRegistry()
        summed.register(self.shared)
        return generate_latest(summed)

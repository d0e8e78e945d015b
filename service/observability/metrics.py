"""What the service counts about itself, in a registry of its own, for GET /metrics."""

from __future__ import annotations

import os
from pathlib import Path

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

from service.observability.shared_counts import DIRECTORY, SharedCounts

CONTENT_TYPE = b"text/plain; version=0.0.4; charset=utf-8"

_SECONDS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)


class Metrics:
    """Counters and histograms of one server process, or of all of them where they share a directory.

    The one histogram of requests by operation and status gives rates, latencies and refusals, and costs one
    observation per request.
    """

    def __init__(self) -> None:
        self.registry = registry = CollectorRegistry()
        requests = Histogram(
            "polhode_request_seconds", "Time from the request's headers to the last byte of the answer.",
            ("operation", "status"), buckets=_SECONDS, registry=registry,
        )  # fmt: skip
        self._labels = requests.labels
        # Finding an observer by its labels costs more than the observation.
        self._observers: dict[tuple[str, int], Histogram] = {}
        self.cache_hits = Counter("polhode_cache_hits", "Answers given from the cache.", registry=registry)
        directory = os.environ.get(DIRECTORY)
        self.shared = None if directory is None else SharedCounts(registry, Path(directory))
        self._problems = Counter("polhode_problems", "Answers that are problems.", ("code",), registry=registry)
        self.failed_checks = Counter(
            "polhode_failed_checks", "Answers withheld because they break a law of mechanics.", ("operation", "law"),
            registry=registry,
        )  # fmt: skip
        self.samples = Counter("polhode_samples", "Numbers in arrays of large answers.", registry=registry)
        self.job_seconds = Histogram(
            "polhode_job_seconds",
            "Processor time of questions in compute processes.",
            buckets=_SECONDS,
            registry=registry,
        )
        self.long_inline = Counter(
            "polhode_long_inline", "Requests that held the event loop for more than 20 ms.", ("operation",),
            registry=registry,
        )  # fmt: skip
        self.handed_over = Counter(
            "polhode_handed_over", "Requests that were begun in the event loop and given to a compute process.",
            ("operation",), registry=registry,
        )  # fmt: skip
        self.waiting = Gauge("polhode_waiting", "Questions that wait for a compute process.", registry=registry)
        self.long = Gauge("polhode_long", "Long questions that share the compute processes in turn.", registry=registry)
        self.moved = Counter(
            "polhode_moved", "Questions that used up their slice and were moved to the long class.", registry=registry
        )
        self.used_seconds = Counter(
            "polhode_used_seconds",
            "Processor time of compute processes, by the name of the key.",
            ("key",),
            registry=registry,
        )
        self.studies = Gauge("polhode_studies", "Studies that are not finished.", registry=registry)
        self.members_missing = Gauge(
            "polhode_study_members_missing", "Members of unfinished studies that have no result yet.", registry=registry
        )
        self.workers_lost = Counter("polhode_workers_lost", "Compute processes that died.", registry=registry)

    def observe(self, key: tuple[str, int], seconds: float) -> None:
        """Count a request by operation and status."""
        observer = self._observers.get(key)
        if observer is None:
            observer = self._observers[key] = self._labels(key[0], str(key[1]))
        observer.observe(seconds)

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

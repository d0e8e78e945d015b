"""What is counted, against the library's own metrics that are fed the same."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from inspect import getsource
from math import inf, nextafter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.parser import text_string_to_metric_families

from service.observability.metrics import CONTENT_TYPE, Metrics, Tally, Timings

ROOT = Path(__file__).parents[3]
ENDS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)
EDGES = [near for end in ENDS for near in (nextafter(end, 0.0), end, nextafter(end, inf))]
SECONDS = st.sampled_from([0.0, *EDGES, 1e9]) | st.floats(0.0, 100.0)
OBSERVED = st.lists(
    st.tuples(st.sampled_from(["ask_toy", "none", 'quoted "\\\n']), st.sampled_from([200, 404]), SECONDS), max_size=30
)

Samples = dict[tuple[str, tuple[tuple[str, str], ...]], float]


def read(text: bytes) -> Samples:
    """Return the samples of an exposition, read by the library's parser, without those that tell a time of day."""
    return {
        (sample.name, tuple(sorted(sample.labels.items()))): sample.value
        for family in text_string_to_metric_families(text.decode())
        for sample in family.samples
        if not sample.name.endswith("_created")
    }


def kinds(text: bytes) -> dict[str, tuple[str, str]]:
    families = text_string_to_metric_families(text.decode())
    return {f.name: (f.type, f.documentation) for f in families if not f.name.endswith("_created")}


@given(OBSERVED)
@settings(deadline=None, derandomize=True, max_examples=60)
def test_timings_are_the_librarys_histogram(observed: list[tuple[str, int, float]]) -> None:
    ours, theirs = CollectorRegistry(), CollectorRegistry()
    timings = Timings("x_seconds", "How long.")
    ours.register(timings)
    histogram = Histogram("x_seconds", "How long.", ("operation", "status"), buckets=ENDS, registry=theirs)
    for operation, status, seconds in observed:
        timings.observe((operation, status), seconds)
        histogram.labels(operation, str(status)).observe(seconds)
    assert read(generate_latest(ours)) == read(generate_latest(theirs))
    assert kinds(generate_latest(ours)) == kinds(generate_latest(theirs))


@pytest.mark.parametrize("count", [0, 1, 3])
def test_a_tally_is_the_librarys_counter(count: int) -> None:
    ours, theirs = CollectorRegistry(), CollectorRegistry()
    tally, counter = Tally("x_hits", "Hits."), Counter("x_hits", "Hits.", registry=theirs)
    ours.register(tally)
    for _ in range(count):
        tally.inc()
        counter.inc()
    assert read(generate_latest(ours)) == read(generate_latest(theirs)) == {("x_hits_total", ()): float(count)}
    assert kinds(generate_latest(ours)) == kinds(generate_latest(theirs))


def fed(metrics: Metrics) -> Metrics:
    for key, seconds in ((("ask_toy", 200), 0.003), (("ask_toy", 200), 11.0), (("none", 404), 0.0005)):
        metrics.observe(key, seconds)
    metrics.cache_hits.inc()
    for code in ("too-busy", "too-busy", "not-found"):
        metrics.problem(code)
    metrics.samples.inc(300_000)
    metrics.job_seconds.observe(0.4)
    metrics.backlog.set(1.25)
    metrics.workers_lost.inc()
    return metrics


EXPECTED = {
    ("polhode_request_seconds_count", (("operation", "ask_toy"), ("status", "200"))): 2.0,
    ("polhode_request_seconds_sum", (("operation", "ask_toy"), ("status", "200"))): 11.003,
    ("polhode_request_seconds_count", (("operation", "none"), ("status", "404"))): 1.0,
    ("polhode_request_seconds_bucket", (("le", "0.0005"), ("operation", "none"), ("status", "404"))): 1.0,
    ("polhode_request_seconds_bucket", (("le", "10.0"), ("operation", "ask_toy"), ("status", "200"))): 1.0,
    ("polhode_request_seconds_bucket", (("le", "+Inf"), ("operation", "ask_toy"), ("status", "200"))): 2.0,
    ("polhode_cache_hits_total", ()): 1.0,
    ("polhode_problems_total", (("code", "too-busy"),)): 2.0,
    ("polhode_problems_total", (("code", "not-found"),)): 1.0,
    ("polhode_samples_total", ()): 300_000.0,
    ("polhode_job_seconds_count", ()): 1.0,
    ("polhode_job_seconds_bucket", (("le", "0.5"),)): 1.0,
    ("polhode_job_seconds_bucket", (("le", "0.25"),)): 0.0,
    ("polhode_backlog_seconds", ()): 1.25,
    ("polhode_workers_lost_total", ()): 1.0,
}


def test_the_exposition_tells_all_that_was_counted() -> None:
    found = read(fed(Metrics()).exposition())
    assert {name: found.get(name) for name in EXPECTED} == EXPECTED


def test_metrics_share_nothing() -> None:
    fed(Metrics())
    found = read(Metrics().exposition())
    assert found
    assert set(found.values()) == {0.0}


def test_the_media_type_is_the_librarys_for_this_format() -> None:
    assert CONTENT_TYPE.startswith(b"text/plain; version=0.0.4")
    assert all(line.isascii() for line in fed(Metrics()).exposition().splitlines())


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], bytes]:
    place = str(tmp_path_factory.mktemp("shared"))

    def told(script: str) -> bytes:
        environment = {**os.environ, "PROMETHEUS_MULTIPROC_DIR": place, "PYTHONPATH": str(ROOT)}
        return subprocess.run(
            [sys.executable, "-c", script], cwd=place, env=environment, check=True, capture_output=True
        ).stdout

    return told


def test_processes_that_share_a_directory_tell_sums(shared: Callable[[str], bytes]) -> None:
    """The first tells what one process tells that shares with none."""
    feed = "\n".join(
        (
            "from __future__ import annotations",
            "from service.observability.metrics import Metrics",
            getsource(fed),
            "print(fed(Metrics()).exposition().decode())",
        )
    )
    first = read(shared(feed))
    assert {name: first.get(name) for name in EXPECTED} == EXPECTED
    second = read(shared(feed))
    # What waits in a process that has ended waits no more.
    waiting = "polhode_backlog_seconds", ()
    assert first[waiting] == second[waiting] > 0.0
    assert {name: value for name, value in first.items() if name != waiting and second.get(name) != 2 * value} == {}
    assert {name for name, _ in first} == {name for name, _ in read(fed(Metrics()).exposition())}


def test_without_a_directory_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    fed(Metrics()).exposition()
    assert list(tmp_path.iterdir()) == []

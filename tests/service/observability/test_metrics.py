"""What the service counts about itself, as the library's parser reads it."""

from __future__ import annotations

from pathlib import Path

import pytest
from prometheus_client.parser import text_string_to_metric_families

from service.observability.metrics import CONTENT_TYPE, Metrics

Samples = dict[tuple[str, tuple[tuple[str, str], ...]], float]


def read(text: bytes) -> Samples:
    """Return the samples of an exposition, read by the library's parser, without those that tell a time of day."""
    return {
        (sample.name, tuple(sorted(sample.labels.items()))): sample.value
        for family in text_string_to_metric_families(text.decode())
        for sample in family.samples
        if not sample.name.endswith("_created")
    }


def fed(metrics: Metrics) -> Metrics:
    for key, seconds in ((("ask_toy", 200), 0.003), (("ask_toy", 200), 11.0), (("none", 404), 0.0005)):
        metrics.observe(key, seconds)
    metrics.cache_hits.inc()
    for code in ("too-busy", "too-busy", "not-found"):
        metrics.problem(code)
    metrics.samples.inc(300_000)
    metrics.job_seconds.observe(0.4)
    metrics.waiting.set(3)
    metrics.long.set(2)
    metrics.moved.inc()
    metrics.used_seconds.labels("laboratory").inc(0.4)
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
    ("polhode_waiting", ()): 3.0,
    ("polhode_long", ()): 2.0,
    ("polhode_moved_total", ()): 1.0,
    ("polhode_used_seconds_total", (("key", "laboratory"),)): 0.4,
    ("polhode_workers_lost_total", ()): 1.0,
}


def test_the_exposition_has_every_counter() -> None:
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


def test_without_a_directory_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    fed(Metrics()).exposition()
    assert list(tmp_path.iterdir()) == []

"""Several server processes tell one sum, whatever becomes of their files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from prometheus_client import CollectorRegistry, Counter, Gauge, generate_latest

from service.observability.shared_counts import DIRECTORY, SharedCounts, sharing

ROOT = Path(__file__).parents[3]

OTHER = """
import sys
from pathlib import Path
from prometheus_client import CollectorRegistry, Counter, Gauge
from service.observability.shared_counts import SharedCounts

registry = CollectorRegistry()
Counter("questions", "Asked.", ("operation",), registry=registry).labels("precession").inc(5)
Gauge("waiting", "Now.", registry=registry).set(7)
SharedCounts(registry, Path(sys.argv[1])).publish()
print("published", flush=True)
sys.stdin.read()
"""


class Mine:
    """The counts of this process."""

    def __init__(self, directory: Path) -> None:
        registry = CollectorRegistry()
        counter = Counter("questions", "Asked.", ("operation",), registry=registry)
        counter.labels("precession").inc(2)
        counter.labels("wobble").inc()
        Gauge("waiting", "Now.", registry=registry).set(1)
        self.shared = SharedCounts(registry, directory)

    def lines(self) -> set[str]:
        summed = CollectorRegistry()
        summed.register(self.shared)
        return {line for line in generate_latest(summed).decode().splitlines() if not line.startswith("#")}


def published(directory: Path) -> subprocess.Popen[str]:
    other = subprocess.Popen(
        [sys.executable, "-c", OTHER, str(directory)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT,
    )  # fmt: skip
    assert other.stdout is not None
    assert other.stdout.readline() == "published\n"
    return other


ALONE = {'questions_total{operation="precession"} 2.0', 'questions_total{operation="wobble"} 1.0', "waiting 1.0"}
TOGETHER = {'questions_total{operation="precession"} 7.0', 'questions_total{operation="wobble"} 1.0', "waiting 8.0"}


def test_counts_are_summed_and_gauges_are_those_of_processes_that_live(tmp_path: Path) -> None:
    mine = Mine(tmp_path)
    mine.shared.publish()
    assert mine.lines() == ALONE
    other = published(tmp_path)
    assert mine.lines() == TOGETHER
    other.communicate("")
    assert mine.lines() == TOGETHER - {"waiting 8.0"} | {"waiting 1.0"}


def test_a_file_that_is_damaged_counts_for_nothing(tmp_path: Path) -> None:
    for content in (b"", b"\x80", b"nonsense"):
        (tmp_path / "1").write_bytes(content)
        assert Mine(tmp_path).lines() == ALONE


def test_on_a_full_disk_what_was_written_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = Mine(tmp_path)
    mine.shared.publish()
    (written,) = tmp_path.iterdir()
    before = written.read_bytes()

    def full(self: Path, data: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    mine.shared.publish()
    assert [*tmp_path.iterdir()] == [written]
    assert written.read_bytes() == before
    assert mine.lines() == ALONE


def test_without_a_directory_each_counts_for_itself(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("tempfile.tempdir", "/dev/null/none")
    with sharing():
        assert DIRECTORY not in os.environ
    assert "no directory can be made" in caplog.records[0].message


def test_a_directory_is_left_by_nobody() -> None:
    with sharing():
        directory = Path(os.environ[DIRECTORY])
        assert directory.is_dir()
        (directory / "1").write_text("")
    assert not directory.exists()
    assert DIRECTORY not in os.environ

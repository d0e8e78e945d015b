"""Files of results: in folders and in other storage, whose errors are those of the operating system."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.studies.chunk_files import ChunkFiles, CorruptedChunk, packed

DATA = packed(
    {
        "start": 3,
        "inputs": np.ones((2, 1)),
        "figures": np.array([[1.0], [np.nan]]),
        "failures": np.zeros(2, np.uint16),
        "warnings": np.zeros(2, np.uint16),
        "failure_names": [],
        "warning_names": [],
    }
)


@pytest.mark.parametrize("kind", ["folder", "file", "memory"])
def test_what_is_written_is_read_until_it_is_removed(tmp_path: Path, kind: str) -> None:
    files = ChunkFiles({"folder": str(tmp_path), "file": f"file://{tmp_path}", "memory": "memory://results"}[kind])
    files.write("a", 3, 5, DATA)
    assert files.read("a", 3, 5).figures[0, 0] == 1.0
    with pytest.raises(CorruptedChunk):
        files.read("a", 3, 6)
    files.remove("a")
    files.remove("a")
    with pytest.raises(CorruptedChunk):
        files.read("a", 3, 5)


def test_errors_of_other_storage_are_those_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    from fsspec.implementations.memory import MemoryFileSystem

    class Unreachable(Exception):
        """As botocore has its own."""

    def fail(*arguments: Any, **settings: Any) -> Any:
        raise Unreachable("no connection")

    files = ChunkFiles("memory://results")
    for name in ("pipe_file", "cat_file", "exists"):
        monkeypatch.setattr(MemoryFileSystem, name, fail)
    for work in (
        lambda: files.write("a", 3, 5, DATA),
        lambda: files.read("a", 3, 5),
        lambda: files.remove("a"),
    ):
        with pytest.raises(OSError, match="no connection"):
            work()


def test_a_url_that_no_library_knows_is_an_error_of_the_storage() -> None:
    with pytest.raises(OSError, match="nowhere"):
        ChunkFiles("nowhere://results")

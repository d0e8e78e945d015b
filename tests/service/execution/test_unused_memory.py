"""Memory that is given back, as Linux counts it."""

from __future__ import annotations

import ctypes
from pathlib import Path

import pytest

from service.execution.unused_memory import give_back

BLOCKS, BYTES = 50_000, 2000


def resident() -> int:
    """Return the bytes of this process that are in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.mark.skipif(
    not Path("/proc/self/statm").exists() or not hasattr(ctypes.CDLL(None), "malloc_trim"), reason="needs Linux, glibc"
)
def test_what_is_free_below_something_in_use_is_given_back() -> None:
    """The last block is above the others, so that freeing them leaves them with the allocator."""
    blocks = [bytes(BYTES) for _ in range(BLOCKS)]
    last = bytes(BYTES)
    del blocks
    kept = resident()
    give_back()
    assert kept - resident() > BLOCKS * BYTES // 2
    assert len(last) == BYTES

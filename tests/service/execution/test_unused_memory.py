"""Memory that is given back, as Linux counts it."""

from __future__ import annotations

import ctypes
import re
import zlib
from pathlib import Path

import numba
import pytest

from service.execution.unused_memory import CODE, give_back

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


def resident_code(library: str) -> int:
    """Return the bytes of a shared library's code that are in the memory of this process."""
    text = Path("/proc/self/smaps").read_text()
    return sum(1024 * int(size) for size in re.findall(rf" r-xp .*{library}.*\n(?:[A-Z].*\n)*?Rss: +([0-9]+) kB", text))


@pytest.mark.skipif(not Path("/proc/self/smaps").exists(), reason="needs Linux")
def test_code_that_has_been_run_is_given_back_and_runs_again() -> None:
    """Compiling runs tens of megabytes of the compiler."""

    def twice(number: int) -> int:
        return 2 * number

    assert numba.njit(twice)(3) == 6
    run = resident_code("libllvmlite")
    assert run > 10_000_000
    give_back()
    assert resident_code("libllvmlite") < run // 10
    assert numba.njit(twice)(4) == 8
    assert zlib.crc32(b"123456789") == 0xCBF43926


def test_only_code_of_files_is_given_back() -> None:
    """What is compiled in this process is in no file; tables that the loader has written to are not as in theirs."""
    start, end = "7f6fa5965000", "7f6faa994000"
    code = f"{start}-{end} r-xp 00365000 fe:00 1234      "
    assert (
        CODE.findall(f"{code} /usr/lib/libz.so.1.2.13\n{code} /opt/a/_c.cpython-311-x86_64-linux-gnu.so\n")
        == [(start, end)] * 2
    )
    others = ["[vdso]", "", "/memfd:code", "/dev/zero", "/usr/lib/libz.so.1 (deleted)", "/usr/bin/python3.11"]
    assert not CODE.findall("".join(f"{code} {name}\n" for name in others))
    assert not CODE.findall(f"{code.replace('r-xp', 'r--p')} /usr/lib/libz.so.1\n")
    assert not CODE.findall(f"{code.replace('r-xp', 'rwxp')} /usr/lib/libz.so.1\n")

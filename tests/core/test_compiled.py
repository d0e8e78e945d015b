"""The cache of compiled code: whatever happens to it, the same numbers come out."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

PROGRAM = """
from core.compiled import kernel

@kernel()
def double(x):
    return x + x

@kernel("float64(float64)")
def quadruple(x):
    return double(double(x))

print(double(1.5), quadruple(1.5))
print(sum(sum(dispatcher.stats.cache_hits.values()) for dispatcher in (double, quadruple)))
"""

FULL = """
import resource, signal
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
"""
"""Every write fails, as on a disk without room."""


class Program:
    """A program with two kernels, and the directory of their compiled code."""

    def __init__(self, directory: Path) -> None:
        self.cache = directory / "cache"
        self.cache.mkdir()
        self.file = directory / "program.py"
        self.file.write_text(PROGRAM)

    def run(self, before: str = "", **environment: str) -> tuple[int, str]:
        """Return how many functions were not compiled anew, and what was written as an error."""
        entry = f"{before}\nimport runpy\nrunpy.run_path({str(self.file)!r}, run_name='program')"
        given = {"NUMBA_CACHE_DIR": str(self.cache), "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(
            [sys.executable, "-c", entry], capture_output=True, text=True, env={**os.environ, **given, **environment}
        )
        assert done.returncode == 0, done.stderr
        numbers, hits = done.stdout.splitlines()
        assert numbers == "3.0 6.0"
        return int(hits), done.stderr

    def files(self, ending: str) -> list[Path]:
        found = sorted(self.cache.rglob(f"*.{ending}"))
        assert found
        return found


@pytest.fixture
def program(tmp_path: Path) -> Program:
    return Program(tmp_path)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Program:
    """A program whose kernels are compiled and read back."""
    program = Program(tmp_path_factory.mktemp("compiled"))
    assert program.run()[0] == 0
    assert program.run() == (2, "")
    return program


INLINED = """
from core.compiled import kernel

FACTOR = 2.0

@kernel()
def double(x):
    return FACTOR * x
"""

CALLING = """
from inlined import double
from core.compiled import kernel

@kernel("float64(float64)")
def quadruple(x):
    return double(double(x))

@kernel("float64(float64)")
def half(x):
    return 0.5 * x

print(half(3.0), quadruple(1.5))
print(sum(sum(dispatcher.stats.cache_hits.values()) for dispatcher in (half, quadruple)))
"""


class TwoFiles(Program):
    """A program with a kernel that calls one of another file, and one that does not."""

    def __init__(self, directory: Path) -> None:
        super().__init__(directory)
        self.file.write_text(CALLING)
        self.inlined = directory / "inlined.py"
        self.inlined.write_text(INLINED)

    def printed(self, program: Path | None = None) -> tuple[str, int]:
        """Return the numbers, and how many functions were not compiled anew."""
        given = {"NUMBA_CACHE_DIR": str(self.cache), "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, "-W", "error", str(program or self.file)]
        done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **given}, check=True)
        numbers, hits = done.stdout.splitlines()
        return numbers, int(hits)


@pytest.mark.parametrize(
    ("old", "new", "numbers", "hits"),
    [
        ("FACTOR = 2.0", "FACTOR = 3.0", "1.5 13.5", 1),
        ("FACTOR * x", "FACTOR + x", "1.5 5.5", 1),
        ("FACTOR = 2.0", "# Of a comment nothing is compiled.\n\nFACTOR = 2.0\nOTHER = 3.0", "1.5 6.0", 2),
    ],
)
def test_what_calls_a_changed_function_is_compiled_again_and_nothing_else(
    tmp_path: Path, old: str, new: str, numbers: str, hits: int
) -> None:
    program = TwoFiles(tmp_path)
    assert program.printed() == ("1.5 6.0", 0)
    program.inlined.write_text(INLINED.replace(old, new))
    assert program.printed() == (numbers, hits)


def test_what_is_loaded_can_be_inlined_again(tmp_path: Path) -> None:
    """Its LLVM module was released when its machine code was loaded."""
    program = TwoFiles(tmp_path)
    program.printed()
    program.file.write_text(CALLING.replace("double(double(x))", "double(double(double(x)))"))
    assert program.printed() == ("1.5 12.0", 1)


def test_in_another_directory_nothing_is_compiled_again(tmp_path: Path) -> None:
    program = TwoFiles(tmp_path)
    program.printed()
    copy = tmp_path / "copy"
    copy.mkdir()
    for file in (program.file, program.inlined):
        (copy / file.name).write_bytes(file.read_bytes())
    assert program.printed(copy / program.file.name) == ("1.5 6.0", 2)


def test_what_compiled_code_may_not_depend_on_is_refused(tmp_path: Path) -> None:
    """A dictionary has no text by which a change of it would be seen."""
    program = TwoFiles(tmp_path)
    program.inlined.write_text(INLINED.replace("FACTOR = 2.0", "FACTOR = {}"))
    with pytest.raises(subprocess.CalledProcessError) as fault:
        program.printed()
    assert "compiled code may not depend on FACTOR" in fault.value.stderr


def truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def emptied(data: bytes) -> bytes:
    return b""


def flipped(data: bytes) -> bytes:
    """Return data with one bit changed, in the machine code."""
    middle = data.index(b"ELF") + 200
    return data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]


@pytest.mark.parametrize(("ending", "damage"), [("nbi", truncated), ("nbc", emptied), ("nbc", flipped)])
def test_what_is_damaged_is_compiled_again(compiled: Program, ending: str, damage: Callable[[bytes], bytes]) -> None:
    for file in compiled.files(ending):
        file.write_bytes(damage(file.read_bytes()))
    hits, errors = compiled.run()
    assert hits == 0
    assert "CacheUnusable" in errors
    # The new code is written in place of the damaged.
    assert compiled.run() == (2, "")


def test_on_a_full_disk_nothing_is_cached(program: Program) -> None:
    hits, errors = program.run(FULL)
    assert hits == 0
    assert "CacheUnusable" in errors
    assert program.run()[0] == 0


def test_where_nothing_can_be_written_nothing_is_cached(program: Program) -> None:
    """Neither where it should be, nor beside the program, nor in a home."""
    program.file.with_name("__pycache__").write_text("no directory")
    hits, errors = program.run(NUMBA_CACHE_DIR="/dev/null/none", HOME="/dev/null", XDG_CACHE_HOME="/dev/null/none")
    assert hits == 0
    assert "compiled code cannot be kept" in errors

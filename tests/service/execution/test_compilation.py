"""When kernels are compiled before the service starts, and what that leaves behind."""

from __future__ import annotations

import shutil
import sys
import time
from pathlib import Path

import pytest

from service.execution import compilation


@pytest.fixture
def directory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A directory of compiled code that does not exist yet."""
    made = tmp_path / "compiled"
    monkeypatch.setattr(compilation, "code_directory", lambda: made)
    return made


def names(directory: Path) -> list[str]:
    return sorted(file.name for file in directory.iterdir())


def test_kernels_are_compiled_once(monkeypatch: pytest.MonkeyPatch, directory: Path) -> None:
    runs: list[list[list[str]]] = []
    monkeypatch.setattr(compilation, "run_together", lambda commands: runs.append(list(commands)) is None)
    compilation.ensure_compiled()
    compilation.ensure_compiled()
    # As many processes as there are orders of compilation, each by its name.
    assert [[command[-1] for command in run] for run in runs] == [list(compilation.FIRST)]
    assert [name.partition("-")[0] for name in names(directory)] == ["complete"]


def test_a_compilation_that_fails_is_tried_again(monkeypatch: pytest.MonkeyPatch, directory: Path) -> None:
    runs: list[object] = []

    def fail(commands: object) -> bool:
        runs.append(commands)
        return False

    monkeypatch.setattr(compilation, "run_together", fail)
    compilation.ensure_compiled()
    compilation.ensure_compiled()
    assert len(runs) == 2
    assert not directory.exists()


def test_a_directory_that_cannot_be_written_does_not_stop_the_start(
    monkeypatch: pytest.MonkeyPatch, directory: Path
) -> None:
    directory.write_text("a file in its place")
    monkeypatch.setattr(compilation, "run_together", lambda commands: True)
    compilation.ensure_compiled()


def test_the_digest_is_that_of_the_content(tmp_path: Path) -> None:
    first = tmp_path / "one" / "core"
    first.mkdir(parents=True)
    (first / "kernel.py").write_text("a = 1\n")
    digest = compilation.sources_digest([first])
    copied = tmp_path / "two" / "core"
    shutil.copytree(first, copied)
    assert compilation.sources_digest([copied]) == digest
    (copied / "kernel.py").write_text("a = 2\n")
    assert compilation.sources_digest([copied]) != digest
    (copied / "kernel.py").rename(copied / "other.py")
    assert compilation.sources_digest([copied]) != digest


def test_commands_run_at_the_same_time_and_all_must_succeed(tmp_path: Path) -> None:
    # Each waits for the file that the other writes.
    program = "import pathlib, sys, time\npathlib.Path(sys.argv[1]).touch()\n"
    program += "while not pathlib.Path(sys.argv[2]).exists(): time.sleep(0.01)\n"
    one, two = str(tmp_path / "one"), str(tmp_path / "two")
    assert compilation.run_together([[sys.executable, "-c", program, *pair] for pair in ((one, two), (two, one))])
    assert not compilation.run_together([[sys.executable, "-c", "import sys; sys.exit(1)"], [sys.executable, "-c", ""]])


def test_a_command_does_not_outlive_what_started_the_others() -> None:
    since = time.monotonic()
    with pytest.raises(FileNotFoundError):
        compilation.run_together([[sys.executable, "-c", "import time; time.sleep(600)"], ["/no/such/program"]])
    # Popen would otherwise be waited for.
    assert time.monotonic() - since < 300


def test_names_of_modules_are_right() -> None:
    from importlib.util import find_spec

    assert all(find_spec(module) for modules in compilation.FIRST.values() for module in modules)

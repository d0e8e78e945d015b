"""Directories of owners that live, that are gone, of others and of other kinds."""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from service.execution import scratch
from service.execution.scratch import LockedTempDir
from tests.service.conftest import ROOT, Server

KIND = "polhode-results-"
OWNER = f"""
import sys, time
from pathlib import Path
from service.execution.scratch import LockedTempDir
own = LockedTempDir({KIND!r}, Path(sys.argv[1]))
Path(own.name, "answer").write_bytes(bytes(1000))
print(own.name, flush=True)
time.sleep(60)
"""


def test_it_is_there_until_it_is_removed(tmp_path: Path) -> None:
    own = LockedTempDir(KIND, tmp_path)
    Path(own.name, "answer").write_bytes(b"1")
    assert [Path(own.name)] == list(tmp_path.iterdir())
    assert Path(own.name).stat().st_mode & 0o777 == 0o700
    own.remove()
    own.remove()
    assert not list(tmp_path.iterdir())


def test_without_a_place_it_is_among_temporary_files() -> None:
    own = LockedTempDir("polhode-test-")
    assert Path(own.name).parent == Path(tempfile.gettempdir())
    own.remove()


def test_what_an_owner_leaves_who_is_killed_is_removed_by_the_next_and_not_before(tmp_path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", OWNER, str(tmp_path)], cwd=ROOT, stdout=subprocess.PIPE) as owner:
        assert owner.stdout is not None
        theirs = Path(owner.stdout.readline().decode().strip())
        first = LockedTempDir(KIND, tmp_path)
        assert {path.name for path in tmp_path.iterdir()} == {theirs.name, Path(first.name).name}
        assert Path(theirs, "answer").exists()
        owner.send_signal(signal.SIGKILL)
        owner.wait()
    assert Path(theirs, "answer").exists()
    second = LockedTempDir(KIND, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {Path(first.name).name, Path(second.name).name}
    first.remove()
    second.remove()


def test_what_is_not_surely_abandoned_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "kept").touch()
    place = tmp_path / "place"
    place.mkdir()
    (place / f"{KIND}link").symlink_to(elsewhere)
    (place / f"{KIND}file").touch()
    (place / "polhode-of-another-kind").mkdir()
    LockedTempDir(KIND, place).remove()
    assert len(list(place.iterdir())) == 3
    assert (elsewhere / "kept").exists()
    of_another_user = place / f"{KIND}theirs"
    of_another_user.mkdir()
    with monkeypatch.context() as patched:
        patched.setattr(scratch.os, "geteuid", lambda: os.getuid() + 1)
        LockedTempDir(KIND, place).remove()
    assert of_another_user.exists()
    LockedTempDir(KIND, place).remove()
    assert not of_another_user.exists()


@pytest.mark.parametrize("moment", ["before it is locked", "while it is being locked", "once it is locked"])
def test_one_that_is_taken_for_abandoned_while_it_is_made_is_made_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    locked = scratch._locked
    taken: list[str] = []

    def interfered(path: str) -> int:
        if taken:
            return locked(path)
        taken.append(path)
        if moment == "while it is being locked":
            other = locked(path)
            try:
                return locked(path)
            finally:
                os.close(other)
        if moment == "before it is locked":
            os.rmdir(path)
            return locked(path)
        lock = locked(path)
        os.rmdir(path)
        return lock

    monkeypatch.setattr(scratch, "_locked", interfered)
    own = LockedTempDir(KIND, tmp_path)
    assert own.name != taken[0]
    assert [Path(own.name)] == list(tmp_path.iterdir())
    own.remove()


def test_where_nothing_can_be_locked_it_is_made_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(path: str) -> int:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(scratch, "_locked", refused)
    first, second = LockedTempDir(KIND, tmp_path), LockedTempDir(KIND, tmp_path)
    assert {Path(first.name), Path(second.name)} == set(tmp_path.iterdir())
    first.remove()
    second.remove()
    assert not list(tmp_path.iterdir())


def test_many_at_once_do_not_take_each_others(tmp_path: Path) -> None:
    with ThreadPoolExecutor(8) as threads:
        made = list(threads.map(lambda _: LockedTempDir(KIND, tmp_path), range(200)))
    assert {Path(own.name) for own in made} == set(tmp_path.iterdir())
    assert len({own.name for own in made}) == 200
    for own in made:
        own.remove()
    assert not list(tmp_path.iterdir())


def test_a_server_removes_what_a_killed_one_has_left(start_server: Callable[..., Server], tmp_path: Path) -> None:
    settings = {"POLHODE_COMPUTE_WORKERS": "1", "POLHODE_SCRATCH": str(tmp_path)}
    killed = start_server(**settings)
    killed.wait_until_ready()
    (left,) = tmp_path.glob(f"{KIND}*")
    killed.process.kill()
    killed.process.communicate(timeout=30)
    assert left.exists()
    server = start_server(**settings)
    server.wait_until_ready()
    (own,) = tmp_path.glob(f"{KIND}*")
    assert own != left
    assert str(left) in server.stop()
    assert not list(tmp_path.iterdir())

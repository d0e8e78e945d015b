"""The process that works on studies: it ends with its server, however that ends, and another goes on."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from service.observability.metrics import Metrics
from service.settings import Settings
from service.studies.folder import Ownership
from service.studies.study import SUCCESSFUL
from service.studies.supervisor import Supervisor
from tests.service.conftest import PATIENCE, ROOT
from tests.service.studies.conftest import Desk, sleeping
from tests.service.studies.toy_table import TABLE

Desks = Callable[..., Desk]

SERVER = f"""
import time
from service.observability.metrics import Metrics
from service.settings import Settings
from service.studies.supervisor import Supervisor

Supervisor(Settings(), {TABLE!r}, Metrics()).ensure()
time.sleep(300)
"""

FAULTY = f"""
import sys, threading, time
from service.studies import runner
from service.studies.engine import Engine

def turn(engine):
    threading.Thread(target=time.sleep, args=(300,)).start()
    raise KeyError

Engine.turn, runner.GRACE, sys.argv[1:] = turn, 0.1, [{TABLE!r}]
runner.main()
"""
"""A process whose engine fails, with a thread for which the interpreter would wait."""

STUDY = sleeping(0.01, 200)


def until(condition: Callable[[], object], seconds: float = PATIENCE) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.mark.anyio
async def test_a_killed_server_costs_what_was_being_computed(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    folder = tmp_path / "data"
    desk = desk_on(in_process, folder)
    identity = desk.submit(STUDY, 0.1)
    environment = {**os.environ, "POLHODE_DATA": str(folder), "POLHODE_STUDY_WORKERS": "1"}
    server = subprocess.Popen([sys.executable, "-c", SERVER], cwd=ROOT, env=environment)
    until(lambda: desk.study(identity).done)
    server.send_signal(signal.SIGKILL)
    server.wait()
    # The process that it started sees its end, and lets the folder go.
    until(lambda: not Ownership(folder).taken)
    stored = set(desk.store.chunks(identity))
    assert 0 < desk.study(identity).done < 200
    settings = Settings(data=str(folder), study_workers=1, study_idle_seconds=0.5)
    supervisor = Supervisor(settings, TABLE, Metrics())
    supervisor.ensure()
    until(lambda: desk.study(identity).status == SUCCESSFUL)
    assert stored < set(desk.store.chunks(identity))
    other = desk_on(in_process, tmp_path / "other")
    again = other.submit(STUDY, 1.0)
    other.work()
    assert desk.bits(identity) == other.bits(again)
    # With nothing to do it ends by itself.
    until(lambda: not Ownership(folder).taken)
    await supervisor.stop()
    supervisor.store.close()


@pytest.mark.anyio
async def test_what_is_owned_by_another_process_is_left_to_it(tmp_path: Path) -> None:
    ownership = Ownership(tmp_path)
    assert ownership.acquire()
    environment = {**os.environ, "POLHODE_DATA": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "service.studies.runner", TABLE],
        cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=100, check=True,
    )  # fmt: skip
    assert json.loads(done.stderr)["message"] == "another process works on the studies of this folder"
    supervisor = Supervisor(Settings(data=str(tmp_path)), TABLE, Metrics())
    supervisor.ensure()
    await supervisor.stop()
    assert ownership.acquire() is False


def test_a_process_that_has_failed_ends_whatever_its_threads_do(tmp_path: Path) -> None:
    """Its server waits for its end before it starts another."""
    environment = {**os.environ, "POLHODE_DATA": str(tmp_path), "POLHODE_DASK": "tcp://127.0.0.1:1"}
    process = subprocess.Popen(
        [sys.executable, "-c", FAULTY], cwd=ROOT, env=environment, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    # Its input stays open, as that of a process whose server lives.
    assert process.wait(PATIENCE) == 1
    assert process.stdin is not None
    process.stdin.close()
    assert not Ownership(tmp_path).taken


@pytest.mark.anyio
async def test_studies_are_looked_after_again_whatever_has_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process that works on studies and is killed would otherwise be missed for good."""
    monkeypatch.setattr("service.studies.supervisor.LOOK_EVERY", 0.01)
    supervisor, again = Supervisor(Settings(data=str(tmp_path)), TABLE, Metrics()), asyncio.Event()
    loop, looks = asyncio.get_running_loop(), 0

    def unfinished() -> list[object]:
        nonlocal looks
        looks += 1
        if looks == 1:
            raise RuntimeError
        loop.call_soon_threadsafe(again.set)
        return []

    monkeypatch.setattr(supervisor.store, "unfinished", unfinished)
    watch = asyncio.create_task(supervisor.watch())
    await asyncio.wait_for(again.wait(), PATIENCE)
    watch.cancel()
    await asyncio.gather(watch, return_exceptions=True)

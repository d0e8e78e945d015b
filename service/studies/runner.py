"""The process that works on the studies of a folder: python -m service.studies.runner TABLE.

A server starts it with the first study; it ends when there have been none for a while, and with the server, whose end
it sees at its standard input. Of several, the one that owns the folder works and the others end at once.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from multiprocessing import forkserver

from service.execution.worker import terms_of
from service.observability.logs import LOG, configure
from service.problems import Refusal
from service.settings import Settings
from service.studies.chunk_files import ChunkFiles
from service.studies.cluster import Cluster
from service.studies.engine import PAUSE, Engine
from service.studies.folder import Ownership, data_folder
from service.studies.store import Store

NICE = 15
"""After the processes that answer requests."""

GRACE = 10.0
"""Seconds after which the process ends whatever the cluster does."""


def main() -> None:
    """Work until there is nothing to do, or the server has ended."""
    settings, table = Settings(), sys.argv[1]
    configure(settings.log_level)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # What it starts has the same priority.
    os.nice(NICE)
    folder = data_folder(settings)
    ownership = Ownership(folder)
    if not ownership.acquire():
        LOG.info("another process works on the studies of this folder", extra={"folder": str(folder)})
        return
    if not settings.dask:
        prepare_processes()
    stopped = threading.Event()
    signal.signal(signal.SIGTERM, lambda number, frame: stopped.set())
    threading.Thread(target=_end_with_server, args=(stopped,), daemon=True).start()
    store, files = Store(folder), ChunkFiles(settings.studies_results or str(folder / "studies"))
    engine = Engine(
        store, files, Cluster(settings, folder / "scratch"), terms_of(settings, table),
        settings.deadline_seconds, settings.answer_seconds,
    )  # fmt: skip
    try:
        work(engine, stopped, settings.study_idle_seconds)
    finally:
        # Also after a fault: the interpreter would wait for the engine's threads, and the server for this process.
        threading.Thread(target=_end_in_any_case, daemon=True).start()
        engine.stop()
        store.close()
        ownership.release()


def prepare_processes() -> None:
    """Start the fork server of the local cluster, which imports what it needs while this process does so, too."""
    # A process has one core: threads of libraries would take those of the others.
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))
    forkserver.set_forkserver_preload(["service.studies.preload"])
    forkserver.ensure_running()


def work(engine: Engine, stopped: threading.Event, idle: float) -> None:
    """Have an engine work until it is stopped or has had nothing to do for some time (s)."""
    last = time.monotonic()
    while not stopped.is_set() and time.monotonic() - last < idle:
        try:
            if engine.turn():
                last = time.monotonic()
        except Refusal as refusal:
            LOG.error("%s", refusal.problem.detail)
            stopped.wait(PAUSE)


def _end_with_server(stopped: threading.Event) -> None:
    # Without the lock of a buffer, which the interpreter could not take while it ends.
    while os.read(sys.stdin.fileno(), 4096):
        pass
    stopped.set()
    _end_in_any_case()


def _end_in_any_case() -> None:
    time.sleep(GRACE)
    os._exit(1)


if __name__ == "__main__":
    main()

"""Sees to it, in a server process, that unfinished studies are worked on, and that old ones are removed."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from threading import Lock

from service.http.keys import Key
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.problems import Refusal
from service.settings import Settings
from service.studies.chunk_files import ChunkFiles
from service.studies.cluster import TRIED_AGAIN, require_scheduler
from service.studies.folder import Ownership, data_folder
from service.studies.store import Store, reason_of
from service.studies.study import ACCEPTED, Study

LOOK_EVERY = 1.0
"""Seconds."""

CLEAN_EVERY = 60.0
"""Seconds."""

KEEP_DISMISSED = 120.0
"""Seconds in which clients that watch a study learn that it was dismissed."""

DAY = 86_400.0


class Supervisor:
    """Starts the process that works on studies where it is missing; `watch` runs as long as the server.

    Parameters
    ----------
    settings : Settings
    table : str
        Where the questions are: ``"module:function"``.
    metrics : Metrics
    """

    def __init__(self, settings: Settings, table: str, metrics: Metrics) -> None:
        self._settings, self._table, self._metrics = settings, table, metrics
        folder = data_folder(settings)
        self.store = Store(folder)
        self.results = settings.studies_results or str(folder / "studies")
        self._ownership = Ownership(folder)
        self._charged: dict[str, tuple[Key, float]] = {}
        self._runner: subprocess.Popen[bytes] | None = None
        self._turn = Lock()

    def files(self) -> ChunkFiles:
        """Return where results are stored."""
        return ChunkFiles(self.results)

    def charge(self, identity: str, key: Key, seconds: float) -> None:
        """Have a key that was charged some time for a study be charged, at its end, what it has taken (s)."""
        self._charged[identity] = key, seconds

    def ensure(self) -> None:
        """Start the process, unless there is one that works on this folder."""
        # Requests and the watch may come at once; a process that nobody holds would end.
        with self._turn:
            self._start()

    def _start(self) -> None:
        if (self._runner is not None and self._runner.poll() is None) or self._ownership.taken:
            return
        environment = {
            f"POLHODE_{name.upper()}": str(value)
            for name, value in self._settings.model_dump().items()
            if value is not None
        }
        self._runner = subprocess.Popen(
            [sys.executable, "-m", "service.studies.runner", self._table],
            stdin=subprocess.PIPE,
            env={**os.environ, **environment},
        )

    async def watch(self) -> None:
        """Look after the studies of the folder until cancelled."""
        cleaned = -CLEAN_EVERY
        while True:
            try:
                for key, seconds in await asyncio.to_thread(self._look):
                    key.charge(seconds)
                if time.monotonic() - cleaned > CLEAN_EVERY:
                    cleaned = time.monotonic()
                    await asyncio.to_thread(self.clean)
            except (OSError, Refusal) as fault:
                LOG.error("the studies cannot be looked after: %s", fault)
            # Nothing else would start the process again that works on studies: they would be accepted for good.
            except Exception:
                LOG.exception("looking after the studies has failed")
            await asyncio.sleep(LOOK_EVERY)

    def _look(self) -> list[tuple[Key, float]]:
        """Return what keys are still to be charged for studies that have ended (s)."""
        unfinished = self.store.unfinished()
        self._metrics.studies.set(len(unfinished))
        self._metrics.members_missing.set(sum(study.count - study.done for study in unfinished))
        if unfinished:
            self.ensure()
        accepted = [study for study in unfinished if study.status == ACCEPTED]
        if accepted and self._settings.dask:
            self._require_scheduler(accepted)
        ended = [*self._charged.keys() - {study.id for study in unfinished}]
        return [charge for identity in ended for charge in self._rest_of(identity)]

    def _rest_of(self, identity: str) -> Iterator[tuple[Key, float]]:
        key, charged = self._charged.pop(identity)
        study = self.store.get(identity)
        if study is not None:
            yield key, study.seconds - charged

    def _require_scheduler(self, accepted: list[Study]) -> None:
        """Say of studies that nothing works on yet if their scheduler cannot be reached.

        The process that works on them may take long to start on a busy machine.
        """
        try:
            require_scheduler(self._settings.dask)
        except (OSError, ValueError) as fault:
            for study in accepted:
                self.store.note(study.id, f"{TRIED_AGAIN}: {reason_of(fault)}")

    def clean(self) -> None:
        """Remove what was finished too long ago."""
        now, keep = time.time(), DAY * self._settings.studies_keep_days
        for study in self.store.finished_before(now - keep, now - min(keep, KEEP_DISMISSED)):
            self.files().remove(study.id)
            self.store.remove(study.id)

    async def stop(self) -> None:
        """End the process that was started, which leaves everything as it is stored."""
        runner = self._runner
        if runner is not None and runner.stdin is not None:
            runner.stdin.close()
            runner.terminate()
            try:
                await asyncio.to_thread(runner.wait, 15.0)
            except subprocess.TimeoutExpired:
                runner.kill()
                runner.wait()

"""Where large questions are answered: in warm processes of their own, which can be killed and are replaced.

Admission is by predicted time: a question whose turn would come too late is refused at once, which keeps short the time
of those that are accepted.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import pickle
from collections.abc import Awaitable, Callable, Iterator
from itertools import count
from math import ceil
from pathlib import Path
from typing import Any

from service.execution.scratch import LockedTempDir
from service.execution.worker import Asked, Failed, map_shared_memory, serve, terms_of
from service.execution.worker_pool import DeadlineExceeded, Job, Processes, QueueTimeout, Stopped, WorkerDied
from service.http.limits import ClientGone
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.problems import Problem, Refusal
from service.responses.json_stream import Document
from service.routing import PostRoute
from service.settings import Settings

MEMORY = 20.0
"""About how many of the last jobs tell how fast this machine is."""


class SpeedCorrection:
    """How long computations take on this machine, as it is loaded now, in proportion to their prices."""

    def __init__(self) -> None:
        # One second of what was predicted, as long as nothing is known.
        self._predicted = self._taken = 1.0

    @property
    def ratio(self) -> float:
        """Time over price."""
        return self._taken / self._predicted

    def learn(self, price: float, seconds: float) -> None:
        """Take a finished computation into account."""
        kept = 1.0 - 1.0 / MEMORY
        self._predicted = kept * self._predicted + price
        self._taken = kept * self._taken + seconds


class Compute:
    """The compute processes of one server process.

    Parameters
    ----------
    settings : Settings
    metrics : Metrics
    table : str
        Where the route table is: ``"module:function"``.

    Attributes
    ----------
    pace : SpeedCorrection
        By which prices are corrected where times are predicted.
    processes : Processes
    """

    def __init__(self, settings: Settings, metrics: Metrics, table: str) -> None:
        self._settings, self._metrics = settings, metrics
        self.terms = terms_of(settings, table)
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.size = settings.compute_workers or max(1, cores // settings.workers)
        self.processes = Processes(self.size, serve, (self.terms,), "service.execution.forkserver_preload", self._lost)
        self._scratch: LockedTempDir | None = None
        self._numbers = count()
        self.pace = SpeedCorrection()
        self._promised = 0.0
        self._jobs = self._held = 0
        self._up = self._stopping = False

    async def start(self) -> None:
        """Start the processes and return when each is ready."""
        memory = Path("/dev/shm")
        directory = self._settings.scratch or (memory if os.access(memory, os.W_OK) else None)
        self._scratch = LockedTempDir("polhode-results-", directory)
        await self.processes.start()
        self._up = True

    async def stop(self) -> None:
        """Refuse and kill what still runs, and release the memory."""
        self._stopping = True
        await self.processes.stop()
        if self._scratch is not None:
            self._scratch.remove()

    @property
    def backlog(self) -> float:
        """Predicted time until a question that is accepted now would have its turn (s)."""
        return self._promised * self.pace.ratio / self.size

    @property
    def held(self) -> int:
        """Memory of the answers that clients are reading (bytes)."""
        return self._held

    @contextlib.contextmanager
    def holding(self, memory: int) -> Iterator[None]:
        """Count the memory (bytes) of an answer while its client reads it."""
        self._held += memory
        try:
            yield
        finally:
            self._held -= memory

    async def answer(
        self, route: PostRoute, body: bytes, price: float, media: str | None, gone: Callable[[], Awaitable[None]]
    ) -> Document:
        """Return the answer to a question, computed and composed in another process.

        Parameters
        ----------
        price : float
            Predicted time (s).
        media : str or None
            Media type of the document, None for JSON.
        gone : callable
            Returns when the client has gone; the computation is then killed.

        Raises
        ------
        Refusal
            The question's own problem, 429 for too long a queue, or 503 for a computation that was killed.
        ClientGone
        """
        if self._stopping:
            raise _stopped()
        if not self._up or self._scratch is None:
            raise Refusal("not-ready", "the compute processes are not up yet", headers=(("Retry-After", "1"),))
        self._admit()
        file, deadline = Path(self._scratch.name, str(next(self._numbers))), self._settings.deadline_seconds
        self._promised += price
        self._jobs += 1
        self._metrics.backlog.set(self.backlog)
        asked = Asked(route.path, body, media, str(file), deadline)
        job = self.processes.submit(
            pickle.dumps(asked, pickle.HIGHEST_PROTOCOL), deadline, self._settings.max_backlog_seconds + deadline
        )
        watch = asyncio.ensure_future(gone())
        try:
            await asyncio.wait((job.reply, watch), return_when=asyncio.FIRST_COMPLETED)
            if not job.reply.done():
                raise ClientGone
            result = self._outcome(job)
            # A long body was not read yet when it was priced, so that its price tells nothing about the machine.
            if len(body) <= self._settings.inline_bytes:
                self.pace.learn(price, job.seconds)
            self._metrics.job_seconds.observe(job.seconds)
            if isinstance(result, Document):
                return map_shared_memory(result, file)
        finally:
            watch.cancel()
            self.processes.drop(job)
            file.unlink(missing_ok=True)
            # Nothing is promised to nobody; differences would leave a rest of rounding.
            self._jobs -= 1
            self._promised = self._promised - price if self._jobs else 0.0
            self._metrics.backlog.set(self.backlog)
        if isinstance(result, Problem):
            raise Refusal.of(result)
        raise RuntimeError(f"in a compute process:\n{result.traceback}")

    def _admit(self) -> None:
        most = self._settings.max_held_bytes
        if self._held > most:
            detail = f"answers that are still being read take more than {most} bytes, the limit max_held_bytes"
            raise Refusal("too-busy", detail, headers=(("Retry-After", "1"),), extra={"retry_after_seconds": 1.0})
        limit = self._settings.max_backlog_seconds
        wait = self.backlog - limit
        if wait > 0.0:
            raise Refusal(
                "too-busy",
                f"more than {limit:g} s of work wait already, the limit max_backlog_seconds",
                headers=(("Retry-After", str(max(1, ceil(wait)))),),
                extra={"retry_after_seconds": round(max(wait, 1e-3), 3)},
            )

    def _outcome(self, job: Job) -> Document | Problem | Failed:
        limit = self._settings.deadline_seconds
        try:
            result: Any = pickle.loads(job.reply.result())
        except DeadlineExceeded:
            detail = f"the computation took longer than {limit:g} s, the limit deadline_seconds, and was stopped"
            raise Refusal("deadline-exceeded", detail) from None
        except WorkerDied:
            detail = "the process that computed this answer died; other questions are not affected"
            raise Refusal("worker-lost", detail, headers=(("Retry-After", "1"),)) from None
        except QueueTimeout:
            detail = "no compute process became free for this question in time; it was not begun"
            raise Refusal("not-ready", detail, headers=(("Retry-After", "1"),)) from None
        except Stopped:
            raise _stopped() from None
        outcome: Document | Problem | Failed = result
        return outcome

    def _lost(self, code: int) -> None:
        self._metrics.workers_lost.inc()
        LOG.error("a compute process died and is replaced", extra={"exit_code": code})


def _stopped() -> Refusal:
    return Refusal("shutting-down", "the service is being stopped", headers=(("Retry-After", "1"),))

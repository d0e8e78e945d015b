"""Answers requests that are too large for the event loop in other processes, which can be killed.

No cost is predicted: the compute processes are scheduled by what they use, the clients in turn. A request is refused
only for what its own client has waiting, or for what all of them hold in memory.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Awaitable, Callable, Hashable
from dataclasses import dataclass
from typing import Any

from service.execution import PRELOAD
from service.execution.job import DeadlineExceeded, Job, NoProcess, SliceUsed, Stopped, WorkerDied
from service.execution.lifeline import Lifeline
from service.execution.messages import decoded, encoded
from service.execution.worker import Failed, Task, serve, terms_of
from service.execution.worker_pool import Processes
from service.http.held_bytes import HeldBytes
from service.http.keys import Key
from service.http.limits import ClientGone
from service.observability import traces
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.problems import Problem, Refusal
from service.responses.json_stream import Document
from service.routing import PostRoute
from service.settings import Settings

COMPUTE_NICE = 10
"""The server process goes first where both compete for a core."""


@dataclass(frozen=True)
class Sender:
    """Who sent a request.

    Attributes
    ----------
    client : hashable
        By which requests have their turns in rotation: the key's name, or the address.
    key : Key or None
        Charged with the time that is spent.
    gone : callable
        Returns when the client has left; what runs for it is then killed.
    """

    client: Hashable
    key: Key | None
    gone: Callable[[], Awaitable[None]]


class Compute:
    """The compute processes of one server process.

    Attributes
    ----------
    size : int
        Processors that they take at most.
    processes : Processes
    held : HeldBytes
        Of requests until they are answered, of answers while they are read.
    """

    def __init__(self, settings: Settings, metrics: Metrics, table: str) -> None:
        self._settings, self._metrics = settings, metrics
        self.terms = terms_of(settings, table)
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.size = settings.compute_workers or max(1, cores // settings.workers)
        self.held = HeldBytes(settings.max_held_bytes)
        self.processes = Processes(
            self.size, serve, (self.terms, COMPUTE_NICE), PRELOAD, self._lost, metrics.moved.inc, held=self.held
        )
        metrics.waiting.set_function(lambda: self.processes.waiting)
        metrics.long.set_function(lambda: self.processes.long)
        self._up = self._stopping = False
        self._lifeline: Lifeline | None = None

    async def start(self) -> None:
        """Start the processes and return when each is ready."""
        self._lifeline = Lifeline()
        await self.processes.start()
        self._up = True

    async def stop(self) -> None:
        """Refuse and kill what still runs."""
        self._stopping = True
        await self.processes.stop()
        if self._lifeline is not None:
            self._lifeline.close()
            self._lifeline = None

    @property
    def any_ready(self) -> bool:
        """Whether there are processes that work or wait for work."""
        return self.processes.any_ready

    async def answer(
        self, route: PostRoute, body: bytes, npz: bool, media: str | None, sender: Sender, *, later: bool = False
    ) -> Document:
        """Return the answer to a request, read, computed and composed in other processes.

        Parameters
        ----------
        npz : bool
            Whether the body is a numpy archive.
        media : str or None
            Media type of the document, None for JSON.
        later : bool
            Whether the request is only read, and the plan of a study of one answer returned.

        Raises
        ------
        Refusal
            The request's own problem, 429 for too long a queue or a quota that is used up, or 503 for a computation
            that was killed.
        ClientGone
        """
        if self._stopping:
            raise _stopped()
        if not self._up:
            raise Refusal("not-ready", "the compute processes are not up yet", retry_after=1.0)
        with self.held.holding(sender.client, len(body)):
            self._require_turn(sender)
            if later:
                return await self._done(Task(route.path, body, npz, media, later=True), sender)
            for attempt in range(len(route.in_short)):
                with contextlib.suppress(SliceUsed):
                    return await self._done(Task(route.path, body, npz, media, attempt), sender, may_be_long=False)
            return await self._done(Task(route.path, body, npz, media, len(route.in_short)), sender)

    def _require_turn(self, sender: Sender) -> None:
        self.held.require_room(sender.client)
        waiting, limit = self.processes.waiting_of(sender.client), self._settings.max_waiting
        if len(waiting) >= limit:
            waited = waiting[0].waited
            detail = (
                f"{limit} requests of this client wait, the limit max_waiting, the first of them for {waited:.1f} s"
            )
            raise Refusal("too-busy", detail, retry_after=max(1.0, waited))

    async def _done(self, task: Task, sender: Sender, *, may_be_long: bool = True) -> Document:
        """Return what a process replies, or raise why it does not; time and key are settled however it ends."""
        deadline = self._settings.deadline_seconds
        job = self.processes.submit(encoded(task), sender.client, longest=deadline, may_be_long=may_be_long)
        watch = asyncio.ensure_future(sender.gone())
        with traces.computing(task.path) as span:
            try:
                await asyncio.wait((job.reply, watch), return_when=asyncio.FIRST_COMPLETED)
                if not job.reply.done():
                    raise ClientGone
            finally:
                watch.cancel()
                self.processes.drop(job)
                span.set_attribute("polhode.used_seconds", job.used)
                if sender.key is not None:
                    sender.key.charge(job.used)
                self._metrics.job_seconds.observe(job.used)
                self._metrics.used_seconds.labels("" if sender.key is None else sender.key.name).inc(job.used)
        result = self._result(job)
        if isinstance(result, Problem):
            raise Refusal.of(result)
        if isinstance(result, Failed):
            raise RuntimeError(f"in a compute process:\n{result.traceback}")
        assert isinstance(result, Document)
        return result

    def _result(self, job: Job) -> Any:
        limit = self._settings.deadline_seconds
        try:
            return decoded(job.reply.result())
        except DeadlineExceeded:
            detail = f"the computation took more than {limit:g} s of processor time, the limit deadline_seconds"
            raise Refusal("deadline-exceeded", detail) from None
        except WorkerDied:
            detail = "the process that computed this answer died; other requests are not affected"
            raise Refusal("worker-lost", detail, retry_after=1.0) from None
        except NoProcess:
            detail = "there is no compute process at present, and none came for this request in time"
            raise Refusal("not-ready", detail, retry_after=1.0) from None
        except Stopped:
            raise _stopped() from None

    def _lost(self, code: int) -> None:
        self._metrics.workers_lost.inc()
        LOG.error("a compute process died and is replaced", extra={"exit_code": code})


def _stopped() -> Refusal:
    return Refusal("shutting-down", "the service is being stopped", retry_after=1.0)

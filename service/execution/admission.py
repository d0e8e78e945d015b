"""Answers requests that are too large for the event loop in other processes, which can be killed.

One process reads every such request and predicts its cost. A request that would wait too long is refused at once; the
others are answered by the compute processes, the clients in rotation.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections import defaultdict
from collections.abc import Awaitable, Callable, Hashable, Iterator
from dataclasses import dataclass
from typing import Any

from service.execution import PRELOAD
from service.execution.job import DeadlineExceeded, Job, QueueTimeout, Stopped, WorkerDied
from service.execution.messages import decoded, encoded
from service.execution.speed import SpeedCorrection
from service.execution.worker import Failed, Task, answer, price, serve, terms_of
from service.execution.worker_pool import Processes
from service.http.keys import Key
from service.http.limits import ClientGone
from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.problems import Problem, Refusal
from service.responses.json_stream import Document
from service.routing import PostRoute
from service.settings import Settings

SECONDS_PER_BYTE = 1e-7
"""Of reading a request, which is done twice; what it asks for is not known before."""

READER_NICE, COMPUTE_NICE = 5, 10
"""The reader goes before the computations, so that requests are refused in time where every core computes."""


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
    speed : mapping of str to SpeedCorrection
        By path, by which prices are corrected where times are predicted.
    reader, processes : Processes
        The process that reads and prices, and those that answer.
    """

    def __init__(self, settings: Settings, metrics: Metrics, table: str) -> None:
        self._settings, self._metrics = settings, metrics
        self.terms = terms_of(settings, table)
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.size = settings.compute_workers or max(1, cores // settings.workers)
        self.reader = Processes(1, serve, (self.terms, price, READER_NICE), PRELOAD, self._lost)
        self.processes = Processes(self.size, serve, (self.terms, answer, COMPUTE_NICE), PRELOAD, self._lost)
        self.speed: defaultdict[str, SpeedCorrection] = defaultdict(SpeedCorrection)
        self._held = 0
        self._up = self._stopping = False

    async def start(self) -> None:
        """Start the processes and return when each is ready."""
        await asyncio.gather(self.reader.start(), self.processes.start())
        self._up = True

    async def stop(self) -> None:
        """Refuse and kill what still runs."""
        self._stopping = True
        await asyncio.gather(self.reader.stop(), self.processes.stop())

    @property
    def any_ready(self) -> bool:
        """Whether there are processes that work or wait for work."""
        return self.reader.any_ready and self.processes.any_ready

    @property
    def held(self) -> int:
        """Memory of the answers that clients are reading (bytes)."""
        return self._held

    @contextlib.contextmanager
    def holding(self, memory: int) -> Iterator[None]:
        """Count memory (bytes): of a request until it is answered, of an answer while its client reads it."""
        self._held += memory
        try:
            yield
        finally:
            self._held -= memory

    async def answer(self, route: PostRoute, body: bytes, npz: bool, media: str | None, sender: Sender) -> Document:
        """Return the answer to a request, read, computed and composed in other processes.

        Parameters
        ----------
        npz : bool
            Whether the body is a numpy archive.
        media : str or None
            Media type of the document, None for JSON.

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
        deadline = self._settings.deadline_seconds
        task = Task(route.path, body, npz, media, deadline)
        with self.holding(len(body)):
            self._require_turn(self.reader, sender)
            reading = SECONDS_PER_BYTE * len(body)
            predicted = await self._done(self.reader, task, reading, sender)
            # Nothing computes for longer than the deadline, whatever was predicted.
            seconds = min(reading + predicted, deadline)
            self._require_turn(self.processes, sender)
            if sender.key is not None:
                sender.key.work(seconds)
            document: Document = await self._done(self.processes, task, seconds, sender)
            return document

    def _require_turn(self, processes: Processes, sender: Sender) -> None:
        most = self._settings.max_held_bytes
        if self._held > most:
            detail = f"requests and unread answers take more than {most} bytes, the limit max_held_bytes"
            raise Refusal("too-busy", detail, retry_after=1.0)
        limit = self._settings.max_backlog_seconds
        wait = processes.wait_of(sender.client) - limit
        if wait > 0.0:
            detail = f"more than {limit:g} s of work wait already, the limit max_backlog_seconds"
            raise Refusal("too-busy", detail, retry_after=wait)

    async def _done(self, processes: Processes, task: Task, price: float, sender: Sender) -> Any:
        """Return what a process replies, or raise why it does not; time and key are settled however it ends."""
        limits, computes = self._settings, processes is self.processes
        speed = self.speed[task.path] if computes else SpeedCorrection()
        job = processes.submit(
            encoded(task),
            sender.client,
            price * speed.ratio,
            longest=limits.deadline_seconds,
            patience=limits.max_backlog_seconds + limits.deadline_seconds,
        )
        self._metrics.backlog.set(self.processes.backlog)
        watch = asyncio.ensure_future(sender.gone())
        try:
            await asyncio.wait((job.reply, watch), return_when=asyncio.FIRST_COMPLETED)
            if not job.reply.done():
                raise ClientGone
            result = self._result(job)
        finally:
            watch.cancel()
            finished = job.reply.done() and job.reply.exception() is None
            processes.drop(job)
            # A computation that was cut short counts only if it has already taken longer than predicted.
            if computes and (finished or job.seconds > job.predicted):
                speed.learn(price, job.seconds)
            if sender.key is not None:
                # A price that was taken is replaced by what it came to.
                sender.key.charge(job.seconds - price if computes else job.seconds)
            if computes and finished:
                self._metrics.job_seconds.observe(job.seconds)
            self._metrics.backlog.set(self.processes.backlog)
        if isinstance(result, Problem):
            raise Refusal.of(result)
        if isinstance(result, Failed):
            raise RuntimeError(f"in a compute process:\n{result.traceback}")
        return result

    def _result(self, job: Job) -> Any:
        limit = self._settings.deadline_seconds
        try:
            return decoded(job.reply.result())
        except DeadlineExceeded:
            detail = f"the computation took longer than {limit:g} s, the limit deadline_seconds, and was stopped"
            raise Refusal("deadline-exceeded", detail) from None
        except WorkerDied:
            detail = "the process that computed this answer died; other requests are not affected"
            raise Refusal("worker-lost", detail, retry_after=1.0) from None
        except QueueTimeout:
            detail = "no compute process became free for this request in time; it was not begun"
            raise Refusal("not-ready", detail, retry_after=1.0) from None
        except Stopped:
            raise _stopped() from None

    def _lost(self, code: int) -> None:
        self._metrics.workers_lost.inc()
        LOG.error("a compute process died and is replaced", extra={"exit_code": code})


def _stopped() -> Refusal:
    return Refusal("shutting-down", "the service is being stopped", retry_after=1.0)

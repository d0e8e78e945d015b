"""Where large questions are answered: in warm processes of their own, which can be killed and are replaced.

Admission is by predicted time: a question whose turn would come too late is refused at once, which keeps short the time
of those that are accepted.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import tempfile
from collections.abc import Awaitable, Callable
from concurrent.futures import BrokenExecutor, TimeoutError
from itertools import count
from math import ceil
from pathlib import Path
from threading import Thread
from time import perf_counter
from typing import Any

from pebble import ProcessExpired, ProcessFuture, ProcessPool

from core.integration.budget import Budget
from service.guards import ClientGone
from service.logs import LOG
from service.metrics import Metrics
from service.problems import Problem, Refusal
from service.reading import Limits
from service.routing import Answer, Question
from service.settings import Settings
from service.worker import Terms, prepare, restored, work


class Compute:
    """The compute processes of one server process.

    Parameters
    ----------
    settings : Settings
    metrics : Metrics
    table : str
        Where the route table is: ``"module:function"``.
    """

    def __init__(self, settings: Settings, metrics: Metrics, table: str) -> None:
        self._settings, self._metrics = settings, metrics
        self.terms = Terms(
            table,
            Budget(samples=settings.max_samples, evaluations=settings.max_evaluations),
            Limits(settings.max_nesting, settings.max_keys, settings.max_arrays),
        )
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.size = settings.compute_workers or max(1, cores // settings.workers)
        self._pool: ProcessPool | None = None
        self._scratch: tempfile.TemporaryDirectory[str] | None = None
        self._numbers = count()
        self._promised = 0.0
        self._tasks: set[ProcessFuture[Any]] = set()
        self._stopping = False

    async def start(self) -> None:
        """Start the processes and return when each has answered something."""
        memory = Path("/dev/shm")
        directory = self._settings.scratch or (memory if os.access(memory, os.W_OK) else None)
        self._scratch = tempfile.TemporaryDirectory(prefix="polhode-", dir=directory, ignore_cleanup_errors=True)
        # The fork server has everything imported, so that a process that is lost is replaced within milliseconds;
        # forking the server process itself, with its threads and its event loop, would not be safe.
        self._pool = self._new_pool()
        greetings = [self._pool.schedule(_greet, (0.05,)) for _ in range(self.size)]
        await asyncio.gather(*map(asyncio.wrap_future, greetings))

    def _new_pool(self) -> ProcessPool:
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload(["service.prepared"])
        return ProcessPool(self.size, initializer=prepare, initargs=(self.terms,), context=context)

    def _schedule(self, pool: ProcessPool, *question: Any) -> ProcessFuture[Any]:
        """Hand a question to the pool; a pool that broke (a process died while it read) is replaced."""
        try:
            return pool.schedule(work, question, timeout=self._settings.deadline_seconds)
        except RuntimeError:
            if self._stopping:
                raise _stopped() from None
            LOG.exception("the pool of compute processes broke and is replaced")
            self._metrics.workers_lost.inc()
            self._pool = fresh = self._new_pool()
            # Nobody would ever answer what the broken pool still has.
            for task in tuple(self._tasks):
                task.cancel()  # type: ignore[no-untyped-call]
            Thread(target=_dispose, args=(pool,), daemon=True).start()
            return fresh.schedule(work, question, timeout=self._settings.deadline_seconds)

    async def stop(self) -> None:
        """Refuse and kill what still runs, and release the memory."""
        self._stopping = True
        # The pool by itself would leave the questions in flight waiting for ever.
        for task in tuple(self._tasks):
            task.cancel()  # type: ignore[no-untyped-call]
        if self._pool is not None:
            self._pool.stop()  # type: ignore[no-untyped-call]
            await asyncio.to_thread(self._pool.join)
        if self._scratch is not None:
            self._scratch.cleanup()

    @property
    def backlog(self) -> float:
        """Predicted time until a question that is accepted now would have its turn (s)."""
        return self._promised / self.size

    async def answer(self, route: Question, body: bytes, price: float, gone: Callable[[], Awaitable[None]]) -> Answer:
        """Return the answer to a question, computed in another process.

        Parameters
        ----------
        price : float
            Predicted time (s).
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
        if self._pool is None or self._scratch is None:
            raise Refusal("not-ready", "the compute processes are not up yet", headers=(("Retry-After", "1"),))
        self._admit()
        file = Path(self._scratch.name, str(next(self._numbers)))
        since = perf_counter()
        self._promised += price
        self._metrics.backlog.set(self.backlog)
        try:
            task = self._schedule(self._pool, self.terms, route.path, body, str(file))
        except BaseException:
            self._promised -= price
            raise
        self._tasks.add(task)
        future = asyncio.wrap_future(task)
        watch = asyncio.ensure_future(gone())
        try:
            await asyncio.wait((future, watch), return_when=asyncio.FIRST_COMPLETED)
            if not future.done():
                raise ClientGone
            result = restored(self._outcome(future), file)
        finally:
            watch.cancel()
            task.cancel()  # type: ignore[no-untyped-call]
            self._tasks.discard(task)
            file.unlink(missing_ok=True)
            # Nothing is promised to nobody; differences would leave a rest of rounding.
            self._promised = self._promised - price if self._tasks else 0.0
            self._metrics.backlog.set(self.backlog)
        seconds = perf_counter() - since
        self._metrics.job_seconds.observe(seconds)
        if isinstance(result, Problem):
            raise Refusal.of(result)
        answer: Answer = result
        return answer

    def _admit(self) -> None:
        limit = self._settings.max_backlog_seconds
        if self.backlog > limit:
            raise Refusal(
                "too-busy",
                f"more than {limit:g} s of work wait already, the limit max_backlog_seconds",
                headers=(("Retry-After", str(max(1, ceil(self.backlog - limit)))),),
            )

    def _outcome(self, future: asyncio.Future[Any]) -> Any:
        try:
            if future.cancelled():
                raise _stopped() if self._stopping else _lost()
            return future.result()
        except TimeoutError:
            limit = self._settings.deadline_seconds
            detail = f"the computation took longer than {limit:g} s, the limit deadline_seconds, and was stopped"
            raise Refusal("deadline-exceeded", detail) from None
        except ProcessExpired as error:
            self._metrics.workers_lost.inc()
            LOG.error("a compute process died", extra={"exit_code": error.exitcode})
            raise _lost() from None
        except BrokenExecutor:
            # Raised for each question of a pool that found itself broken; the next one replaces the pool.
            raise _lost() from None


def _lost() -> Refusal:
    detail = "the process that computed this answer died; other questions are not affected"
    return Refusal("worker-lost", detail, headers=(("Retry-After", "1"),))


def _dispose(pool: ProcessPool) -> None:
    pool.stop()  # type: ignore[no-untyped-call]
    pool.join()


def _stopped() -> Refusal:
    return Refusal("shutting-down", "the service is being stopped", headers=(("Retry-After", "1"),))


def _greet(seconds: float) -> None:
    """Occupy a process for a moment, so that as many greetings as processes reach every process."""
    from time import sleep

    sleep(seconds)

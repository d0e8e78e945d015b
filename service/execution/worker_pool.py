"""Processes that answer one request at a time over a socket of their own, and are killed and replaced one by one.

They share nothing: a process that dies, at whatever moment, takes with it only the request that it had begun. One that
does not begin at once (it is stopped, or was dead already) loses the request to another. Starting a process may wait
for the fork server, so that is done in threads; all else happens in the event loop, without waiting.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import socket
from collections import deque
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from multiprocessing.connection import wait
from multiprocessing.context import ForkServerProcess
from threading import Lock, Thread
from time import perf_counter
from typing import Any

from service.execution.daemon_thread import call_soon_if_open, run_in_daemon_thread
from service.execution.fair_queue import FairQueue
from service.execution.job import DeadlineExceeded, Job, QueueTimeout, Stopped, WorkerDied
from service.execution.messages import Buffer
from service.execution.worker_process import Process
from service.observability.logs import LOG

BEGIN_SECONDS = 5.0
"""Time in which a process has to begin what it is given: longer than a sound one waits for a core on a busy machine."""

PAUSE = 0.5
"""Seconds before another attempt where a process could not be started, or did not live until it was ready."""

LONGEST_PAUSE = 30.0
"""What the pause grows to while nothing can be started."""

_EXIT_CODES = Lock()
"""Starting a process polls all others; of two threads that read an exit code at the same time one would find none."""


class Processes:
    """A number of warm processes.

    Parameters
    ----------
    size : int
        Number of processes.
    main : callable
        Runs in each process, given its end of the connection and `arguments`.
    preload : str
        Module that the fork server imports once for all processes.
    lost : callable
        Called with the exit code of a process that died by itself.
    """

    def __init__(
        self, size: int, main: Callable[..., None], arguments: Sequence[Any], preload: str, lost: Callable[[int], None]
    ) -> None:
        # The fork server has everything imported, so that a process that is lost is replaced within milliseconds;
        # forking the server process itself, with its threads and its event loop, would not be safe.
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload([preload])
        self.size = size
        self._main, self._arguments, self._lost = main, tuple(arguments), lost
        self._waiting: FairQueue[Job] = FairQueue()
        self._idle: deque[Process] = deque()
        self._all: set[Process] = set()
        self._starting: set[asyncio.Task[None]] = set()
        self._turn = asyncio.Lock()
        self._up = asyncio.Event()
        self._stopping = False

    @property
    def pids(self) -> dict[int, bool]:
        """Process ids, and whether each works on something."""
        return {process.handle.pid or 0: process.job is not None for process in self._all}

    @property
    def ready(self) -> bool:
        """Whether all processes are there and ready."""
        return sum(process.ready and not process.killed for process in self._all) == self.size

    @property
    def any_ready(self) -> bool:
        """Whether there is a process that works or waits for work."""
        return any(process.ready and not process.killed for process in self._all)

    def process_of(self, job: Job) -> Process | None:
        """Return the process that works on a request."""
        return next((process for process in self._all if process.job is job), None)

    async def start(self) -> None:
        """Start all processes and return when each is ready."""
        for _ in range(self.size):
            self._replace(0.0)
        await self._up.wait()

    def submit(
        self, request: Sequence[Buffer], client: Hashable, predicted: float, *, longest: float, patience: float
    ) -> Job:
        """Have a request answered.

        Parameters
        ----------
        request : sequence of bytes
            As `messages.encoded` returns it.
        client : hashable
        predicted : float
            How long it is expected to take (s).
        longest : float
            Time after which its process is killed (s).
        patience : float
            Time that it may wait for its turn (s).
        """
        job = Job(request, client, predicted, longest)
        if self._stopping:
            job.fail(Stopped())
            return job
        self._time(job, patience, self._give_up, QueueTimeout())
        self._waiting.append(client, job)
        self._hand_out()
        return job

    def wait_of(self, client: Hashable) -> float:
        """Return the predicted time until a new request of a client would have its turn (s)."""
        return self._rest_of_running(sum(job.predicted for job in self._waiting.ahead_of(client)))

    @property
    def backlog(self) -> float:
        """Predicted time of all that runs and waits, shared by the processes (s)."""
        return self._rest_of_running(sum(job.predicted for job in self._waiting))

    def _rest_of_running(self, seconds: float) -> float:
        for process in self._all:
            if (job := process.job) is not None:
                rest = job.predicted - job.seconds
                # One that takes longer than predicted is expected to take as long again.
                seconds += rest if rest > 0.0 else max(0.0, min(job.seconds, job.longest - job.seconds))
        return seconds / self.size

    def drop(self, job: Job) -> None:
        """Make sure that nothing works on a request any more."""
        job.reply.cancel()
        process = self._detach(job)
        if process is not None:
            process.kill()
        else:
            self._waiting.remove(job.client, job)

    def heard(self, process: Process, message: memoryview | None) -> None:
        """Act on a message; None for one of no length."""
        job = process.job
        if process.killed:
            return
        if not process.ready:
            process.ready = True
            if self.ready:
                self._up.set()
        elif job is None:
            return
        elif message is None:
            job.begun = True
            self._time(job, job.longest, self._give_up, DeadlineExceeded())
            return
        else:
            self._detach(job)
            if not job.reply.done():
                job.reply.set_result(message)
        self._idle.append(process)
        self._hand_out()

    def ended(self, process: Process) -> None:
        """Answer for what a process has left, and start another."""
        self._all.discard(process)
        if process in self._idle:
            self._idle.remove(process)
        job = process.job
        if job is not None:
            self._detach(job)
            if job.begun:
                job.fail(WorkerDied())
            else:
                # It was on its way to a process that was dead already: it is not that request's fault.
                self._put_back(job)
        if not self._stopping:
            self._replace(0.0 if process.ready else PAUSE)
            self._hand_out()
        Thread(target=self._bury, args=(process, asyncio.get_running_loop()), daemon=True).start()

    async def stop(self) -> None:
        """Refuse what waits, kill what runs."""
        self._stopping = True
        for task in tuple(self._starting):
            task.cancel()
        for job in (*self._waiting, *(process.job for process in self._all)):
            if job is not None:
                job.fail(Stopped())
        self._waiting.clear()
        for process in tuple(self._all):
            process.kill()
        until = perf_counter() + 5.0
        while self._all and perf_counter() < until:
            await asyncio.sleep(0.005)

    def _hand_out(self) -> None:
        while self._waiting and self._idle:
            job, process = self._waiting.pop(), self._idle.popleft()
            job.since = perf_counter()
            self._time(job, BEGIN_SECONDS, self._not_begun)
            process.give(job)

    def _time(self, job: Job, seconds: float, late: Callable[..., None], *arguments: Any) -> None:
        if job.timer is not None:
            job.timer.cancel()
        job.timer = asyncio.get_running_loop().call_later(seconds, late, job, *arguments)

    def _not_begun(self, job: Job) -> None:
        """Take a request from a process that does nothing, which is killed and replaced."""
        process = self._detach(job)
        if process is not None:
            LOG.error("a compute process did not begin a request", extra={"pid": process.handle.pid})
            process.kill()
            self._put_back(job)

    def _put_back(self, job: Job) -> None:
        if not job.reply.done():
            job.since = job.until = 0.0
            self._time(job, job.longest, self._give_up, QueueTimeout())
            self._waiting.put_back(job.client, job)
            self._hand_out()

    def _detach(self, job: Job) -> Process | None:
        """Stop the clocks of a request, and separate it from the process that it was given to, which is returned."""
        job.until = job.until or perf_counter()
        if job.timer is not None:
            job.timer.cancel()
        process = self.process_of(job)
        if process is not None:
            process.job = None
        return process

    def _give_up(self, job: Job, error: Exception) -> None:
        job.fail(error)
        self.drop(job)

    def _replace(self, pause: float) -> None:
        task = asyncio.ensure_future(self._begin(pause))
        self._starting.add(task)
        task.add_done_callback(self._starting.discard)

    async def _begin(self, pause: float) -> None:
        await asyncio.sleep(pause)
        while True:
            try:
                handle, ours = await self._started()
                break
            # Whatever is lacking, files or threads or memory: a process that is not replaced would be missed for good.
            except Exception:
                LOG.exception("a compute process could not be started")
                pause = min(max(2.0 * pause, PAUSE), LONGEST_PAUSE)
                await asyncio.sleep(pause)
        process = Process(self, handle)
        self._all.add(process)
        ours.setblocking(False)
        await asyncio.get_running_loop().create_unix_connection(lambda: process, sock=ours)

    async def _started(self) -> tuple[ForkServerProcess, socket.socket]:
        """Return a new process and our end of the connection to it."""
        # One at a time: all wait for the same fork server.
        async with self._turn:
            ours, theirs = socket.socketpair()
            try:
                return await run_in_daemon_thread(partial(self._spawn, theirs)), ours
            except BaseException:
                ours.close()
                raise

    def _spawn(self, end: socket.socket) -> ForkServerProcess:
        with end, _EXIT_CODES:
            handle = self._context.Process(target=self._main, args=(end, *self._arguments), daemon=True)
            handle.start()
            return handle

    def _bury(self, process: Process, loop: asyncio.AbstractEventLoop) -> None:
        handle, killed = process.handle, process.killed
        # The connection may have ended before the process.
        if not wait([handle.sentinel], 1.0):
            handle.kill()
            wait([handle.sentinel])
        with _EXIT_CODES:
            code = handle.exitcode or 0
            handle.close()
        if not (killed or self._stopping):
            call_soon_if_open(loop, self._lost, code)

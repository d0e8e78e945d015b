"""Processes that answer one request at a time over a socket of their own, and are killed and replaced one by one.

Nobody foresees how long a request takes, so they are scheduled by what they use (multilevel feedback). Each begins in
the short class. One that has used its slice of processor time is moved to the long class while it runs: its process is
stopped and continued there in turn with the others, and another process takes its place in the short class.

They share nothing: a process that dies, at whatever moment, takes with it only the request that it had begun. One that
does not begin at once (it is stopped, or was dead already) loses the request to another. All of this happens in the
event loop, without waiting.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Hashable, Sequence
from math import isfinite
from time import perf_counter
from typing import Any

from service.execution.fair_queue import FairQueue
from service.execution.fair_shares import QUANTUM, FairShares
from service.execution.job import DeadlineExceeded, Job, NoProcess, SliceUsed, Stopped, WorkerDied
from service.execution.messages import Buffer
from service.execution.process_starter import ProcessStarter
from service.execution.unread_answers import UnreadAnswers
from service.execution.worker_process import Process
from service.http.held_bytes import HeldBytes
from service.observability.logs import LOG

BEGIN_SECONDS = 5.0
"""Time in which a process has to begin what it is given: longer than a sound one waits for a core on a busy machine."""

SLICE = 0.02
"""Seconds of processor time in the short class: most small scenes are answered in less."""

RESERVE = 1
"""Processes beside one for each processor that are ready to take the place of one whose request turns out long."""


class Processes:
    """A number of warm processes.

    Parameters
    ----------
    size : int
        Number of processors that they take at most.
    main : callable
        Runs in each process, given its end of the connection and `arguments`.
    preload : str
        Module that the fork server imports once for all processes.
    lost : callable
        Called with the exit code of a process that died by itself.
    moved : callable
        Called when a request is moved to the long class.
    held : HeldBytes
        Of answers; one for which its client has no room stays in its process.
    slice_seconds : float
        Processor time that a request may use in the short class (s).
    reserve : int
        Processes beside one for each processor that are ready at any time.
    """

    def __init__(
        self,
        size: int,
        main: Callable[..., None],
        arguments: Sequence[Any],
        preload: str,
        lost: Callable[[int], None],
        moved: Callable[[], None] = lambda: None,
        *,
        held: HeldBytes,
        slice_seconds: float = SLICE,
        reserve: int = RESERVE,
    ) -> None:
        self.size = size
        self._starter = ProcessStarter(main, arguments, preload)
        self._lost, self._moved = lost, moved
        self._slice, self._kept = slice_seconds, size + reserve
        self._waiting: FairQueue[Job] = FairQueue()
        self._short: set[Job] = set()
        self._long: FairShares[Job] = FairShares()
        self._unread = UnreadAnswers(held, self._hand_out)
        self._turns: asyncio.TimerHandle | None = None
        self._idle: deque[Process] = deque()
        self._all: set[Process] = set()
        self._starting: set[asyncio.Task[None]] = set()
        self._up = asyncio.Event()
        self._stopping = False

    @property
    def pids(self) -> dict[int, bool]:
        """Process ids, and whether each works on something."""
        return {process.handle.pid or 0: process.job is not None for process in self._all}

    @property
    def ready(self) -> bool:
        """Whether all processes are there and ready."""
        return sum(process.ready and not process.killed for process in self._all) >= self._needed

    @property
    def any_ready(self) -> bool:
        """Whether there is a process that works or waits for work."""
        return any(process.ready and not process.killed for process in self._all)

    @property
    def waiting(self) -> int:
        """Number of requests that no process has begun."""
        return len(self._waiting)

    @property
    def long(self) -> int:
        """Number of requests in the long class."""
        return len(self._long)

    @property
    def unread(self) -> int:
        """Number of answers for which their clients have no room."""
        return len(self._unread)

    def waiting_of(self, client: Hashable) -> Sequence[Job]:
        """Return the requests of a client that no process has begun, the first to have its turn first."""
        return self._waiting.of(client)

    def process_of(self, job: Job) -> Process | None:
        """Return the process that works on a request."""
        return next((process for process in self._all if process.job is job), None)

    async def start(self) -> None:
        """Start all processes and return when each is ready."""
        self._keep_up()
        await self._up.wait()

    def submit(
        self,
        request: Sequence[Buffer],
        client: Hashable,
        *,
        longest: float,
        may_be_long: bool = True,
    ) -> Job:
        """Have a request answered.

        Parameters
        ----------
        request : sequence of bytes
            As `messages.encoded` returns it.
        client : hashable
        longest : float
            Processor time that it may use; its process is then killed (s).
        may_be_long : bool
            Whether it is moved to the long class when it has used its slice; otherwise its process is then killed.
        """
        job = Job(request, client, longest, may_be_long=may_be_long)
        if self._stopping:
            job.fail(Stopped())
            return job
        self._time(job, longest, self._unserved)
        self._waiting.append(client, job)
        self._hand_out()
        return job

    def drop(self, job: Job) -> None:
        """Make sure that nothing works on a request any more; whoever has its reply counts that from now on."""
        job.reply.cancel()
        self._unread.forget(job)
        process = self._detach(job)
        if process is not None:
            process.kill()
        else:
            self._waiting.remove(job.client, job)
        self._hand_out()

    def announced(self, process: Process, length: int) -> None:
        """Take that a reply is ready: the request needs no processor any more."""
        job = process.job
        if process.killed or job is None:
            return
        self._rest(job)
        process.go_on()
        self._unread.announce(job, process, length)
        self._keep_up()
        self._hand_out()

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
            self._time(job, job.longest, self._overdue)
            if isfinite(self._slice):
                asyncio.get_running_loop().call_later(self._slice, self._sliced, job)
            return
        else:
            self._detach(job)
            if not job.reply.done():
                job.reply.set_result(message)
        if len(self._all) > self._kept + self._needed:
            # Left over from long requests that have ended; some are kept for the next ones.
            process.kill()
        else:
            process.go_on()
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
            self._keep_up(failed=not process.ready)
            self._hand_out()
        quiet = process.killed or self._stopping
        self._starter.bury(process.handle, (lambda code: None) if quiet else self._lost)

    async def stop(self) -> None:
        """Refuse what waits, kill what runs."""
        self._stopping = True
        for task in tuple(self._starting):
            task.cancel()
        for job in (*self._waiting, *(process.job for process in self._all)):
            if job is not None:
                job.fail(Stopped())
        self._waiting.clear()
        if self._turns is not None:
            self._turns.cancel()
        for process in tuple(self._all):
            process.kill()
        until = perf_counter() + 5.0
        while (self._all or self._starter.burying) and perf_counter() < until:
            await asyncio.sleep(0.005)

    def _hand_out(self) -> None:
        """Begin what can be begun in the short class, and divide the other processors among the long requests."""
        # Where there are several processors, the long class keeps one: a stream of short requests does not end it.
        most = max(1, self.size - 1) if len(self._long) else self.size
        while self._idle and len(self._short) < most:
            job = self._waiting.pop(self._may_begin)
            if job is None:
                break
            process = self._idle.popleft()
            job.run()
            self._short.add(job)
            self._time(job, BEGIN_SECONDS, self._not_begun)
            process.give(job)
        self._share()

    @property
    def _needed(self) -> int:
        """Number of processes: those of the short class, and those that are taken for long."""
        return self._kept + len(self._long) + len(self._unread)

    def _may_begin(self, job: Job) -> bool:
        """Return whether a request may begin, which may turn out long; not while its client has answers to read."""
        if self._unread.has(job.client):
            return False
        return not self._long.full if job.is_long else self._long.may_have_another(job.client)

    def _share(self) -> None:
        """Stop and continue the processes of the long class, so that no more run than there are processors."""
        if self._turns is not None:
            self._turns.cancel()
            self._turns = None
        if not len(self._long):
            return
        processors = max(self.size - len(self._short), min(1, self.size - 1))
        working = {process.job: process for process in self._all if process.job is not None}
        running = {job for job in self._long if not working[job].stopped}
        chosen = self._long.chosen(processors, running)
        for job in running.difference(chosen):
            working[job].stop()
            job.rest()
            if job.timer is not None:
                job.timer.cancel()
        for job in chosen:
            if working[job].stopped:
                working[job].go_on()
                job.run()
                self._time(job, job.longest - working[job].used, self._overdue)
        if len(chosen) < len(self._long):
            self._turns = asyncio.get_running_loop().call_later(QUANTUM, self._share)

    def _sliced(self, job: Job) -> None:
        """Move a request to the long class if it has used its slice."""
        process = self.process_of(job)
        if process is None or job not in self._short:
            return
        left = process.left_of(self._slice)
        if left > 0.0:
            asyncio.get_running_loop().call_later(max(left, 0.1 * self._slice), self._sliced, job)
        elif not job.may_be_long:
            self._give_up(job, SliceUsed())
        elif self._long.full:
            # It begins again when there is room, rather than being refused for the requests of others.
            job.is_long = True
            self._take_back(job)
        else:
            job.is_long = True
            self._short.discard(job)
            self._long.add(job)
            self._moved()
            self._keep_up()
            self._hand_out()

    def _overdue(self, job: Job) -> None:
        """End a request that has used its time."""
        process = self.process_of(job)
        left = 0.0 if process is None else process.left_of(job.longest)
        if left > 0.0:
            self._time(job, left, self._overdue)
        else:
            self._give_up(job, DeadlineExceeded())

    def _unserved(self, job: Job) -> None:
        """End a request that waits where there is no process; nobody is refused for the requests of others."""
        if self.any_ready:
            self._time(job, job.longest, self._unserved)
        else:
            self._give_up(job, NoProcess())

    def _time(self, job: Job, seconds: float, late: Callable[[Job], None]) -> None:
        if job.timer is not None:
            job.timer.cancel()
        job.timer = asyncio.get_running_loop().call_later(seconds, late, job)

    def _not_begun(self, job: Job) -> None:
        """Take a request from a process that does nothing."""
        LOG.error("a compute process did not begin a request")
        self._take_back(job)

    def _take_back(self, job: Job) -> None:
        """Have a request begun anew by another process; its own is killed and replaced."""
        process = self._detach(job)
        if process is not None:
            process.kill()
        self._put_back(job)

    def _put_back(self, job: Job) -> None:
        if not job.reply.done():
            job.forget()
            self._time(job, job.longest, self._unserved)
            self._waiting.put_back(job.client, job)
            self._hand_out()

    def _rest(self, job: Job) -> None:
        """Stop the clocks of a request, which takes part in no class any more."""
        job.rest()
        self._short.discard(job)
        self._long.remove(job)
        if job.timer is not None:
            job.timer.cancel()

    def _detach(self, job: Job) -> Process | None:
        """Rest, and separate a request from the process that it was given to, which is returned."""
        self._rest(job)
        process = self.process_of(job)
        if process is not None:
            job.used = process.used
            process.job = None
        return process

    def _give_up(self, job: Job, error: Exception) -> None:
        job.fail(error)
        self.drop(job)

    def _keep_up(self, *, failed: bool = False) -> None:
        """Start as many processes as are lacking; after a pause if the last one failed."""
        lacking = self._needed - len(self._starting) - sum(not each.killed for each in self._all)
        for _ in range(lacking):
            task = asyncio.ensure_future(self._begin(failed))
            self._starting.add(task)
            task.add_done_callback(self._starting.discard)

    async def _begin(self, failed: bool) -> None:
        task = asyncio.current_task()
        handle, ours = await self._starter.start(failed=failed)
        process = Process(self, handle)
        self._all.add(process)
        # From now on it counts as one that is there.
        self._starting.difference_update({task})
        ours.setblocking(False)
        await asyncio.get_running_loop().create_unix_connection(lambda: process, sock=ours)

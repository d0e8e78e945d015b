"""Answers that stay in the processes which have computed them until their clients have room for them.

Nobody knows how large an answer is before it is computed. A client whose questions were all let in while it held
nothing could otherwise have their answers take all of the memory, by not reading them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable

from service.execution.job import Job
from service.execution.worker_process import Process
from service.http.held_bytes import HeldBytes


class UnreadAnswers:
    """What processes have ready, and what of it is on its way here.

    Parameters
    ----------
    held : HeldBytes
        Counts what is here until it is written to clients.
    received : callable
        Called when answers that had to wait no longer do.
    """

    def __init__(self, held: HeldBytes, received: Callable[[], None]) -> None:
        self._held, self._received = held, received
        self._counted: dict[Job, int] = {}
        self._waiting: dict[Job, tuple[Process, int]] = {}
        held.freed = self._freed

    def __len__(self) -> int:
        """How many processes wait."""
        return len(self._waiting)

    def has(self, client: Hashable) -> bool:
        """Return whether an answer to a client waits."""
        return any(job.client == client for job in self._waiting)

    def announce(self, job: Job, process: Process, length: int) -> None:
        """Receive an answer of so many bytes, or have its process wait with it."""
        if self._held.may_answer(job.client, length):
            self._count(job, length)
        else:
            process.hold_back()
            self._waiting[job] = process, length

    def forget(self, job: Job) -> None:
        """Count no longer what has been passed on, or is lost."""
        self._waiting.pop(job, None)
        if (length := self._counted.pop(job, 0)) > 0:
            self._held.add_answer(job.client, -length)

    def _count(self, job: Job, length: int) -> None:
        self._counted[job] = length
        self._held.add_answer(job.client, length)

    def _freed(self) -> None:
        if self._waiting:
            # What passes an answer on counts it anew, in the same turn of the loop.
            asyncio.get_running_loop().call_soon(self._receive)

    def _receive(self) -> None:
        for job, (process, length) in tuple(self._waiting.items()):
            if self._held.may_answer(job.client, length):
                del self._waiting[job]
                self._count(job, length)
                process.receive()
        self._received()

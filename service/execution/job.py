"""A request on its way through the compute processes, and why one may come back without an answer."""

from __future__ import annotations

import asyncio
from collections.abc import Hashable, Sequence
from time import perf_counter

from service.execution.messages import Buffer


class WorkerDied(Exception):
    """The process died while it worked on the request."""


class DeadlineExceeded(Exception):
    """The request was worked on for longer than it may be; its process was killed."""


class SliceUsed(Exception):
    """The request, which is not to become long, used its slice; its process was killed."""


class NoProcess(Exception):
    """There was no process for the request, and none came in time."""


class Stopped(Exception):
    """The processes are being stopped."""


class Job:
    """A request on its way.

    Attributes
    ----------
    client : hashable
        Who sent it; clients have their turns in rotation.
    longest : float
        Processor time that it may use (s).
    may_be_long : bool
        Whether it goes on in the long class when it has used its slice, or is ended.
    reply : asyncio.Future of memoryview
        Fails with `WorkerDied`, `DeadlineExceeded`, `SliceUsed`, `NoProcess` or `Stopped`.
    begun : bool
        Whether a process works on it, or has.
    is_long : bool
        Whether it has used its slice.
    used : float
        Processor time that it has used, once no process works on it any more (s).
    """

    def __init__(
        self, request: Sequence[Buffer], client: Hashable, longest: float, *, may_be_long: bool = True
    ) -> None:
        self.request, self.client, self.longest, self.may_be_long = request, client, longest, may_be_long
        self.reply: asyncio.Future[memoryview] = asyncio.get_running_loop().create_future()
        self.submitted = perf_counter()
        self.begun = self.is_long = False
        self.used = 0.0
        self.timer: asyncio.TimerHandle | None = None
        self._ran, self._since = 0.0, 0.0

    @property
    def seconds(self) -> float:
        """How long a process has worked on it; the time in which the process was stopped does not count (s)."""
        return self._ran + (perf_counter() - self._since if self._since else 0.0)

    @property
    def waited(self) -> float:
        """How long ago it was submitted (s)."""
        return perf_counter() - self.submitted

    def run(self) -> None:
        """Note that a process works on it from now on."""
        self._since = self._since or perf_counter()

    def rest(self) -> None:
        """Note that none does for now."""
        self._ran, self._since = self.seconds, 0.0

    def forget(self) -> None:
        """Note that none ever did."""
        self._ran, self._since, self.used, self.begun = 0.0, 0.0, 0.0, False

    def fail(self, error: Exception) -> None:
        """Answer with an error, unless there is an answer or the client has left."""
        if not self.reply.done():
            self.reply.set_exception(error)

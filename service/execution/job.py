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


class QueueTimeout(Exception):
    """No process became free for the request in time."""


class Stopped(Exception):
    """The processes are being stopped."""


class Job:
    """A request on its way.

    Attributes
    ----------
    client : hashable
        Who sent it; clients have their turns in rotation.
    predicted : float
        How long it is expected to take (s).
    reply : asyncio.Future of memoryview
        Fails with `WorkerDied`, `DeadlineExceeded`, `QueueTimeout` or `Stopped`.
    begun : bool
        Whether a process works on it, or has.
    """

    def __init__(self, request: Sequence[Buffer], client: Hashable, predicted: float, longest: float) -> None:
        self.request, self.client, self.predicted, self.longest = request, client, predicted, longest
        self.reply: asyncio.Future[memoryview] = asyncio.get_running_loop().create_future()
        self.since = self.until = 0.0
        self.begun = False
        self.timer: asyncio.TimerHandle | None = None

    @property
    def seconds(self) -> float:
        """How long a process has worked on it, or did (s)."""
        return (self.until or perf_counter()) - self.since if self.since else 0.0

    def fail(self, error: Exception) -> None:
        """Answer with an error, unless there is an answer or the client has left."""
        if not self.reply.done():
            self.reply.set_exception(error)

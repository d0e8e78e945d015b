"""One compute process, seen from the event loop: a connection that takes a request and hears its answer."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from typing import Protocol, cast

import numpy as np

from service.execution.job import Job
from service.execution.messages import LENGTH

WAITS = 10.0
"""A process that waits for something, after so many times as long as it may use the processor, counts as one that has
used it. One that waits for a core alone, beside other programs that take all of them, does not."""


class Listener(Protocol):
    """Receives what comes from a process."""

    def announced(self, process: Process, length: int) -> None:
        """Take that it is about to send a reply of so many bytes."""

    def heard(self, process: Process, message: memoryview | None) -> None:
        """Take a message, None for that it is ready or has begun."""

    def ended(self, process: Process) -> None:
        """Take that it has ended."""


class Process(asyncio.BufferedProtocol):
    """One process, seen from the event loop.

    Messages are received where they stay: a large one is never copied.
    """

    def __init__(self, listener: Listener, handle: ForkServerProcess) -> None:
        self._listener, self.handle = listener, handle
        self._transport: asyncio.Transport | None = None
        self._length = memoryview(bytearray(LENGTH))
        self._target, self._filled = self._length, 0
        self.ready = self.killed = self.stopped = False
        self.job: Job | None = None
        self._used_before = 0.0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Keep the connection."""
        self._transport = cast(asyncio.Transport, transport)

    def give(self, job: Job) -> None:
        """Send a request."""
        assert self._transport is not None
        self.job = job
        with contextlib.suppress(OSError):
            self._used_before = self._processor_seconds()
        self._transport.writelines(job.request)

    def get_buffer(self, sizehint: int) -> memoryview:
        """Return where the next bytes belong."""
        return self._target[self._filled :]

    def buffer_updated(self, count: int) -> None:
        """Take in messages: nothing for "ready" and then for "begun", something for a reply."""
        self._filled += count
        if self._filled < len(self._target):
            return
        received, self._target, self._filled = self._target, self._length, 0
        if received is not self._length:
            self._listener.heard(self, received)
        elif length := int.from_bytes(received, "little"):
            # Memory that is not written before the message fills it.
            self._target = np.empty(length, np.uint8).data
            self._listener.announced(self, length)
        else:
            self._listener.heard(self, None)

    def connection_lost(self, error: Exception | None) -> None:
        """The process has ended."""
        self._transport = None
        self._listener.ended(self)

    @property
    def used(self) -> float:
        """Processor time since it was given its last request (s)."""
        try:
            return self._processor_seconds() - self._used_before
        except OSError:
            # It has ended, or the system has no such clocks: the time for which it has run.
            return 0.0 if self.job is None else self.job.seconds

    def left_of(self, most: float) -> float:
        """Return what is left of the processor time that its request may use (s), nothing if it waits for something."""
        if self.job is None or (self.job.seconds >= WAITS * most and not self._runnable):
            return 0.0
        return most - self.used

    @property
    def _runnable(self) -> bool:
        with contextlib.suppress(OSError):
            # proc_pid_stat(5): the state comes after the name, which may have blanks and brackets.
            return Path(f"/proc/{self.handle.pid}/stat").read_bytes().rpartition(b")")[2].split()[0] == b"R"
        return False

    def _processor_seconds(self) -> float:
        # The clock of another process (clock_getcpuclockid(3)), which Python has for threads alone.
        return time.clock_gettime(~(self.handle.pid or 0) << 3 | 2)

    def stop(self) -> None:
        """Have it do nothing until it is continued; what it has done is kept."""
        self.stopped = True
        self._signal(signal.SIGSTOP)

    def go_on(self) -> None:
        """Continue what was stopped."""
        if self.stopped:
            self.stopped = False
            self._signal(signal.SIGCONT)

    def hold_back(self) -> None:
        """Receive nothing from it until it is to be received: its reply stays where it is."""
        if self._transport is not None:
            self._transport.pause_reading()

    def receive(self) -> None:
        """Receive what was held back."""
        if self._transport is not None and not self._transport.is_reading():
            self._transport.resume_reading()

    def kill(self) -> None:
        """End it at once, whatever it does."""
        self.killed = True
        # Its end is heard of by reading.
        self.receive()
        self._signal(signal.SIGKILL)

    def _signal(self, number: signal.Signals) -> None:
        # Its handle learns of its end from the fork server alone, and would take it for dead once that has ended. It
        # lives as long as its connection does.
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.handle.pid or 0, number)

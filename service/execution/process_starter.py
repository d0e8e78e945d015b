"""Starts processes from a fork server, and takes leave of those that have ended, both in threads."""

from __future__ import annotations

import asyncio
import multiprocessing
import socket
from collections.abc import Callable, Sequence
from functools import partial
from multiprocessing.connection import wait
from multiprocessing.context import ForkServerProcess
from threading import Lock, Thread
from typing import Any

from service.execution.daemon_thread import call_soon_if_open, run_in_daemon_thread
from service.observability.logs import LOG

PAUSE = 0.5
"""Seconds before another attempt where a process could not be started, or did not live until it was ready."""

LONGEST_PAUSE = 30.0
"""What the pause grows to while nothing can be started."""

_EXIT_CODES = Lock()
"""Starting a process polls all others; of two threads that read an exit code at the same time one would find none."""


class ProcessStarter:
    """Starts processes that run `main`, given its end of a connection and `arguments`.

    The fork server imports the module `preload` once for all processes, so that a process that is lost is replaced
    within milliseconds; forking the server process itself, with its threads and its event loop, would not be safe.
    """

    def __init__(self, main: Callable[..., None], arguments: Sequence[Any], preload: str) -> None:
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload([preload])
        self._main, self._arguments = main, tuple(arguments)
        self._turn = asyncio.Lock()
        self._burials: list[Thread] = []

    @property
    def burying(self) -> bool:
        """Whether the end of a process is still waited for; the exit of this one would find its handle half closed."""
        return any(thread.is_alive() for thread in self._burials)

    async def start(self, *, failed: bool) -> tuple[ForkServerProcess, socket.socket]:
        """Return a new process and our end of the connection to it; begin after a pause if the last one failed."""
        pause = PAUSE if failed else 0.0
        while True:
            await asyncio.sleep(pause)
            try:
                return await self._started()
            # Whatever is lacking, files or threads or memory: a process that is not replaced would be missed for good.
            except Exception:
                LOG.exception("a compute process could not be started")
                pause = min(max(2.0 * pause, PAUSE), LONGEST_PAUSE)

    async def _started(self) -> tuple[ForkServerProcess, socket.socket]:
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

    def bury(self, handle: ForkServerProcess, lost: Callable[[int], None]) -> None:
        """Have a process end that has closed its connection; `lost` is called in this event loop with its exit code."""
        thread = Thread(target=self._bury, args=(handle, lost, asyncio.get_running_loop()), daemon=True)
        thread.start()
        self._burials = [*(one for one in self._burials if one.is_alive()), thread]

    def _bury(self, handle: ForkServerProcess, lost: Callable[[int], None], loop: asyncio.AbstractEventLoop) -> None:
        # The connection may have ended before the process.
        if not wait([handle.sentinel], 1.0):
            handle.kill()
            wait([handle.sentinel])
        with _EXIT_CODES:
            code = handle.exitcode or 0
            handle.close()
        call_soon_if_open(loop, lost, code)

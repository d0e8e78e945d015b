"""A server process ends with the supervisor that started it, so that none is left on the port."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
from multiprocessing.util import get_temp_dir
from shutil import rmtree

from service.observability.logs import LOG


def end_with_supervisor() -> None:
    """Have this process ended gracefully when the process that started it has ended, if that was a supervisor."""
    parent, loop = multiprocessing.parent_process(), asyncio.get_running_loop()
    if parent is None:
        return

    def end() -> None:
        loop.remove_reader(parent.sentinel)
        LOG.error("the supervisor has ended; this server process ends, too", extra={"supervisor": parent.pid})
        os.kill(os.getpid(), signal.SIGTERM)

    loop.add_reader(parent.sentinel, end)


def remove_temporary_files() -> None:
    """Remove what multiprocessing keeps for this process, if a supervisor started it.

    uvicorn ends such a process by the signal that stopped it, before multiprocessing would remove anything.
    """
    if multiprocessing.parent_process() is not None:
        rmtree(get_temp_dir(), ignore_errors=True)

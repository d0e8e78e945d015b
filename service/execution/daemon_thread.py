"""Blocking calls in threads of their own, whose results reach the event loop."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from threading import Thread
from typing import Any


async def run_in_daemon_thread(work: Callable[[], Any]) -> Any:
    """Return the result of a blocking call, made in a thread that does not delay the exit of the process."""
    loop = asyncio.get_running_loop()
    done: asyncio.Future[Any] = loop.create_future()

    def settle(result: Any, error: BaseException | None) -> None:
        if done.cancelled():
            return
        if error is None:
            done.set_result(result)
        else:
            done.set_exception(error)

    def run() -> None:
        try:
            outcome, error = work(), None
        except BaseException as raised:
            outcome, error = None, raised
        call_soon_if_open(loop, settle, outcome, error)

    Thread(target=run, daemon=True).start()
    return await done


def call_soon_if_open(loop: asyncio.AbstractEventLoop, call: Callable[..., None], *arguments: Any) -> None:
    """Call something in the event loop from another thread, unless the loop is closed."""
    with contextlib.suppress(RuntimeError):
        loop.call_soon_threadsafe(call, *arguments)

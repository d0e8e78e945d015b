"""Coroutines begun before they have a task: what needs not wait for anything never gets one.

Python 3.12 has eager tasks; here the first step is taken by hand, and a task takes over a coroutine that waits.
"""

from __future__ import annotations

from asyncio import AbstractEventLoop, Task
from collections.abc import Coroutine, Generator
from typing import Any


def begun(coroutine: Coroutine[Any, Any, None], loop: AbstractEventLoop) -> Task[None] | None:
    """Run a coroutine as far as it goes without waiting; return the task that goes on with it, or None at its end.

    Until it first waits it must not ask for its task, as time limits and task groups do.
    """
    try:
        awaited = coroutine.send(None)
    except StopIteration:
        return None
    return loop.create_task(_Begun(coroutine, awaited))


class _Begun(Coroutine[Any, Any, None]):
    """A coroutine that waits already, and says so once more to the task that asks for its first step."""

    __slots__ = ("_awaited", "_coroutine", "_told")

    def __init__(self, coroutine: Coroutine[Any, Any, None], awaited: Any) -> None:
        self._coroutine, self._awaited, self._told = coroutine, awaited, False

    def send(self, value: Any) -> Any:
        if self._told:
            return self._coroutine.send(value)
        awaited, self._awaited, self._told = self._awaited, None, True
        return awaited

    def throw(self, *error: Any) -> Any:
        self._told = True
        return self._coroutine.throw(*error)

    def close(self) -> None:
        self._coroutine.close()

    def __await__(self) -> Generator[Any, Any, None]:
        raise TypeError("a task takes this over; nothing else awaits it")

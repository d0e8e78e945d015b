"""For how long a request has been under way."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event, Thread
from types import TracebackType
from typing import Self

FIRST, EVERY = 1.0, 0.25
"""Time before the first report, and between two (s)."""


@dataclass(frozen=True)
class Progress:
    """A request that takes longer than a second.

    Attributes
    ----------
    path : str
        Of the endpoint.
    elapsed : float
        Since the request was sent (s).
    done : bool
        Whether this is the last report: the request is answered, refused or given up.
    """

    path: str
    elapsed: float
    done: bool = False


def bar(progress: Progress) -> None:
    """Write a line to standard error, and clear it at the end."""
    if progress.done:
        sys.stderr.write("\r\033[K")
    else:
        sys.stderr.write(f"\r{progress.path} {progress.elapsed:.0f} s")
    sys.stderr.flush()


class Reporting:
    """Reports the progress of one request from a thread, while the caller waits for the answer.

    Parameters
    ----------
    report : callable or None
        Called with a `Progress`; None reports nothing.
    path : str
    """

    def __init__(self, report: Callable[[Progress], object] | None, path: str) -> None:
        self._report, self._path = report, path
        self._start, self._ended = time.monotonic(), Event()
        self._thread = Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        if self._report is not None:
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        if self._report is not None:
            self._thread.join()

    def _run(self) -> None:
        assert self._report is not None
        if self._ended.wait(FIRST):
            return
        while True:
            self._report(Progress(self._path, time.monotonic() - self._start))
            if self._ended.wait(EVERY):
                break
        self._report(Progress(self._path, time.monotonic() - self._start, done=True))

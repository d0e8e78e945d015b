"""How far a request is: its elapsed time beside the time that the service predicted for it."""

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

WIDTH = 30
"""Characters of the bar."""


@dataclass(frozen=True)
class Progress:
    """A request that takes longer than a second.

    Attributes
    ----------
    path : str
        Of the endpoint.
    elapsed : float
        Since the request was sent (s).
    expected : float or None
        Predicted by ``POST /v1/plan`` (s), without the time in the queue; None for what is not planned.
    done : bool
        Whether this is the last report: the request is answered, refused or given up.
    """

    path: str
    elapsed: float
    expected: float | None
    done: bool = False


def bar(progress: Progress) -> None:
    """Write a line with a bar to standard error, and clear it at the end."""
    if progress.done:
        sys.stderr.write("\r\033[K")
    elif progress.expected:
        share = min(1.0, progress.elapsed / progress.expected)
        filled = "#" * round(WIDTH * share)
        sys.stderr.write(
            f"\r{progress.path} [{filled:{WIDTH}}] {progress.elapsed:.0f} s of about {progress.expected:.0f} s"
        )
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
    expected : float or None
        As in `Progress`.
    """

    def __init__(self, report: Callable[[Progress], object] | None, path: str, expected: float | None) -> None:
        self._report, self._path, self._expected = report, path, expected
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
            self._report(Progress(self._path, time.monotonic() - self._start, self._expected))
            if self._ended.wait(EVERY):
                break
        self._report(Progress(self._path, time.monotonic() - self._start, self._expected, done=True))

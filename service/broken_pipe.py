"""The end of a command whose output nobody reads any more, as in ``polhode openapi | head``."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

UNREAD = 141
"""Status of such an end: that of a program that is stopped by SIGPIPE, 128 + 13, as shells report it."""


@contextmanager
def ending_with_its_reader() -> Iterator[None]:
    """Write all that a command has said; end it without a word once its reader has gone.

    Python ignores SIGPIPE, rightly for a server, whose connections may break: a command meets the error instead.
    """
    try:
        try:
            yield
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        # What is still buffered would raise the error again when the interpreter ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(UNREAD)

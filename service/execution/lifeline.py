"""Continues what this process has stopped when it ends, in whatever way it ends."""

from __future__ import annotations

import subprocess

_WAIT = "trap '' HUP INT TERM; read -r _; kill -CONT 0"
"""Waits for the end of its input, and continues all of its process group; signals that end a server do not end it."""


class Lifeline:
    """A shell that waits for this process to end, however that comes about, and continues its process group then.

    A compute process ends as its server does, by the end of their connection; one that is stopped would not see it, and
    would stay with its fork server for good. What is not stopped takes no notice of being continued.
    """

    def __init__(self) -> None:
        self._shell = subprocess.Popen(
            ["/bin/sh", "-c", _WAIT], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    def close(self) -> None:
        """End it; what is stopped is continued."""
        self._shell.communicate()

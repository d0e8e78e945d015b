"""Where studies are stored on this machine, and which process works on them."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

from service.settings import Settings

LOCK = "studies.lock"

CHECKOUT = Path(__file__).parents[2]
"""Folder of a checkout, whose studies are its own; an installed package has no project file there."""


def data_folder(settings: Settings) -> Path:
    """Return the folder of data, which need not exist yet."""
    if settings.data:
        return Path(settings.data)
    if (CHECKOUT / "pyproject.toml").exists():
        return CHECKOUT / ".data"
    base = os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share"
    return Path(base) / "polhode"


def make_private(folder: Path) -> None:
    """Make a folder into which nobody else can look, whatever the file mode creation mask and the folders above."""
    folder.mkdir(parents=True, exist_ok=True)
    folder.chmod(0o700)


class Ownership:
    """The right to work on the studies of a folder, which one process has at a time.

    The operating system ends it with the process, however that ends.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / LOCK
        self._file: int | None = None

    def acquire(self) -> bool:
        """Return whether the right is this process's now."""
        file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o600)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(file)
            return False
        self._file = file
        return True

    def release(self) -> None:
        """Let another process have it."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    @property
    def taken(self) -> bool:
        """Whether another process has it."""
        if self.acquire():
            self.release()
            return False
        return True

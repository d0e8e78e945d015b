"""Directories for files on their way between processes, which do not outlive a server that is killed for long.

A server that is killed cannot remove its directory, which lies in shared memory as a rule and would hold it until the
machine is started anew. So its owner keeps the directory locked; the lock ends with the process, however that ends, and
whoever makes a directory of the same kind first removes those that nobody has locked. Directories of other users, and
those of other kinds, are left alone.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import tempfile
from pathlib import Path

from service.observability.logs import LOG


class LockedTempDir:
    """A directory of this process's own.

    Parameters
    ----------
    kind : str
        What its name begins with, which tells it from all whose owners keep no lock.
    within : Path or None
        Where it is made; None for the system's place for temporary files.

    Attributes
    ----------
    name : str
        Its path.
    """

    def __init__(self, kind: str, within: Path | None = None) -> None:
        within = Path(tempfile.gettempdir()) if within is None else within
        _remove_abandoned(kind, within)
        self._lock: int | None = None
        while True:
            self._directory = tempfile.TemporaryDirectory(prefix=kind, dir=within, ignore_cleanup_errors=True)
            self.name = self._directory.name
            try:
                self._lock = _locked(self.name)
                if os.path.isdir(self.name):
                    return
                os.close(self._lock)
            except (BlockingIOError, FileNotFoundError):
                # Another server that is being started has found it before it was locked.
                pass
            except OSError:
                # Where nothing can be locked, nobody can take it for abandoned.
                return
            self._directory.cleanup()

    def remove(self) -> None:
        """Remove it and all that is in it."""
        self._directory.cleanup()
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None


def _locked(path: str | Path) -> int:
    """Return a descriptor that keeps a directory locked until it is closed.

    Raises
    ------
    BlockingIOError
        If another process has it locked.
    OSError
        If it is no directory of this user's, or cannot be locked.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        if os.fstat(descriptor).st_uid != os.geteuid():
            raise PermissionError(f"{path} belongs to another user")
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor


def _remove_abandoned(kind: str, within: Path) -> None:
    for path in within.glob(f"{kind}*"):
        with contextlib.suppress(OSError):
            lock = _locked(path)
            try:
                shutil.rmtree(path, ignore_errors=True)
            finally:
                os.close(lock)
            LOG.info("removed what a server that was killed had left", extra={"directory": str(path)})

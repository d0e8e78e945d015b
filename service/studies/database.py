"""The database of studies as a file: where it is, how it is made and opened, who may read it.

It is in the mode of a write-ahead log: readers never wait for the writer.
"""

from __future__ import annotations

import fcntl
import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

DATABASE = "studies.sqlite"

PATIENCE = 5.0
"""Seconds for which a process waits for another's writing."""

LONGEST_LOG = 2**22
"""Bytes to which the log beside the database is cut when it has been written into it."""

_TABLES = """
CREATE TABLE IF NOT EXISTS studies (
    id TEXT PRIMARY KEY, owner TEXT NOT NULL, request BLOB NOT NULL, plan TEXT NOT NULL, status TEXT NOT NULL,
    message TEXT NOT NULL, created REAL NOT NULL, started REAL, finished REAL, statistics TEXT,
    done INTEGER NOT NULL DEFAULT 0, failed INTEGER NOT NULL DEFAULT 0, seconds REAL NOT NULL DEFAULT 0.0,
    address TEXT NOT NULL DEFAULT ''
);
CREATE TABLE IF NOT EXISTS chunks (
    study TEXT NOT NULL, start INTEGER NOT NULL, stop INTEGER NOT NULL, failed INTEGER NOT NULL,
    seconds REAL NOT NULL, PRIMARY KEY (study, start)
) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS studies_by_owner ON studies (owner, created);
"""


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Wait until no other process, and no other store of this one, prepares the database of a folder."""
    held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(held, fcntl.LOCK_EX)
        yield
    finally:
        os.close(held)


def opened(folder: Path) -> sqlite3.Connection:
    """Return a connection to the database of a folder, for one thread at a time; both are made where they are missing.

    Raises
    ------
    OSError, sqlite3.Error
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    file = folder / DATABASE
    # Of two processes that change the mode of a new database at once, SQLite refuses one without waiting.
    with _alone_in(folder):
        # The files beside the database get the permissions that it has. A file that SQLite may have open is never
        # opened here: closing it again would release the locks of this process.
        with suppress(FileExistsError):
            os.close(os.open(file, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600))
        file.chmod(0o600)
        return _prepared(file)


def _prepared(file: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(file, timeout=PATIENCE, isolation_level=None, check_same_thread=False)
    # What is removed is given back to the file system; this has to come before the tables.
    connection.execute("PRAGMA auto_vacuum = FULL")
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute(f"PRAGMA journal_size_limit = {LONGEST_LOG}")
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.executescript(_TABLES)
    if "address" not in [row[1] for row in connection.execute("PRAGMA table_info(studies)")]:
        # Databases of earlier versions.
        connection.execute("ALTER TABLE studies ADD COLUMN address TEXT NOT NULL DEFAULT ''")
    return connection

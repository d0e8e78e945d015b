"""The record of studies: one SQLite database in the folder of data, written by any number of processes.

A study is a row; so is each stretch of its members whose results are stored.
"""

from __future__ import annotations

import json
import os
import secrets
import sqlite3
import time
import zlib
from base64 import urlsafe_b64encode
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from threading import Lock
from typing import Any

from service.observability.logs import LOG
from service.problems import Refusal
from service.studies.database import DATABASE, opened
from service.studies.study import ACCEPTED, DISMISSED, RUNNING, STATES, SUCCESSFUL, UNFINISHED, Owner, Quotas, Study

PLANNED = {"path", "count", "shape", "inputs", "figures", "together", "seconds", "bytes"}
"""What a plan says."""

SHARE_OF_ONE = 0.5
"""Of the bytes of all studies, which those of one owner may take."""

_COMPRESSED = b"\x78"
"""First byte of a compressed request (RFC 1950); no JSON text begins with it."""

ID_BYTES = 18
"""Of the id of a study: 144 bits, which nobody guesses."""

ORDERS = {
    sign + name: f"{name} {direction}"
    for name in ("created", "started", "finished")
    for sign, direction in (("-", "DESC"), ("", "ASC"))
}
"""Orders of lists, by the names that clients give them; times that there are not yet count as the earliest."""

_STUDY = """SELECT id, owner, plan, status, message, created, started, finished, done, failed, seconds FROM studies """


class Store:
    """The database in a folder, which is made where it is missing.

    Raises
    ------
    Refusal
        ``storage-unavailable``, by every method, where the folder cannot be read or written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._turn = Lock()
        self._connection: sqlite3.Connection | None = None

    def close(self) -> None:
        """Close the connection; the next call opens another."""
        with self._turn:
            self._drop()

    def _drop(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    @property
    def exists(self) -> bool:
        """Whether there has been a study."""
        return (self.folder / DATABASE).exists()

    @contextmanager
    def _connected(self) -> Iterator[sqlite3.Connection]:
        # Closing the last connection to a database writes its log into it: this one stays open.
        with self._turn:
            try:
                if self._connection is None:
                    self._connection = opened(self.folder)
                yield self._connection
            except (OSError, sqlite3.Error) as fault:
                self._drop()
                raise storage_unavailable(fault, self._reason(fault)) from fault
            except BaseException:
                # Nothing is left half written.
                self._drop()
                raise

    def _reason(self, fault: Exception) -> str:
        # SQLite says of every folder that it cannot write to that a file cannot be opened.
        if self.folder.is_dir() and not os.access(self.folder, os.W_OK):
            return "it cannot be written to"
        return reason_of(fault)

    def create(self, owner: Owner, request: bytes, plan: Mapping[str, Any], most: Quotas, identity: str = "") -> str:
        """Record a study and return its id, which cannot be guessed unless one is given.

        Raises
        ------
        Refusal
            429 for too many unfinished studies, 503 for too many bytes.
        """
        identity = identity or secrets.token_urlsafe(ID_BYTES)
        body = zlib.compress(request, 1)
        # Of clients without keys, each has an address; with keys, a client may have many.
        own = ("owner = ?", (owner.name,)) if owner.name else ("owner = ? AND address = ?", tuple(owner))
        with self._connected() as connection:
            connection.execute("BEGIN IMMEDIATE")
            _require_few(connection, ("owner = ?", (owner.name,)), most.studies, "max_studies")
            if not owner.name:
                _require_few(connection, own, most.of_address, "max_address_studies")
            needed = plan["bytes"] + len(body)
            _require_room(connection, ("TRUE", ()), needed, most.bytes, "the limit max_studies_bytes")
            share = int(SHARE_OF_ONE * most.bytes)
            _require_room(connection, own, needed, share, "one client's share of max_studies_bytes")
            connection.execute(
                "INSERT INTO studies (id, owner, address, request, plan, status, message, created)"
                " VALUES (?, ?, ?, ?, ?, ?, '', ?)",
                (identity, *owner, body, json.dumps(plan), ACCEPTED, time.time()),
            )
            connection.execute("COMMIT")
        return identity

    def get(self, identity: str, owner: str | None = None) -> Study | None:
        """Return a study, None if there is none with this id, or it is another owner's."""
        if not self.exists:
            return None
        with self._connected() as connection:
            row = connection.execute(_STUDY + "WHERE id = ?", (identity,)).fetchone()
        found = None if row is None else _study(row)
        return found if found is not None and owner in (None, found.owner) else None

    def repeats(self, identity: str, request: bytes, path: str) -> bool:
        """Return whether there is a study with an id already.

        Raises
        ------
        Refusal
            If it is that of another request.
        """
        known = self.get(identity)
        if known is None:
            return False
        if (self.request(identity), known.plan["path"]) != (request, path):
            raise Refusal("idempotency-key-reused", "another request was sent with this Idempotency-Key")
        return True

    def request(self, identity: str) -> bytes:
        """Return the request of a study as it was sent, which may have megabytes."""
        with self._connected() as connection:
            row = connection.execute("SELECT request FROM studies WHERE id = ?", (identity,)).fetchone()
        sent = b"" if row is None else bytes(row[0])
        return zlib.decompress(sent) if sent.startswith(_COMPRESSED) else sent

    def listed(self, owner: str, order: str, start: int, count: int) -> list[Study]:
        """Return some of an owner's studies in one of `ORDERS`."""
        return self._where(f"WHERE owner = ? ORDER BY {order}, created, id LIMIT ? OFFSET ?", (owner, count, start))

    def unfinished(self) -> list[Study]:
        """Return every study that is not finished, the earliest first."""
        return self._where("WHERE status IN (?, ?) ORDER BY created, id", UNFINISHED)

    def finished_before(self, moment: float, dismissed: float) -> list[Study]:
        """Return the studies that ended before a moment (s since 1970), or were dismissed before another."""
        return self._where("WHERE finished < ? OR (status = ? AND finished < ?)", (moment, DISMISSED, dismissed))

    def _where(self, condition: str, values: tuple[Any, ...]) -> list[Study]:
        if not self.exists:
            return []
        with self._connected() as connection:
            rows = map(_study, connection.execute(_STUDY + condition, values))
            return [study for study in rows if study is not None]

    def chunks(self, identity: str) -> list[tuple[int, int]]:
        """Return the stretches of members whose results are stored, in member order."""
        with self._connected() as connection:
            rows = connection.execute("SELECT start, stop FROM chunks WHERE study = ? ORDER BY start", (identity,))
            return [(start, stop) for start, stop in rows]

    def add_chunk(self, identity: str, start: int, stop: int, failed: int, seconds: float) -> None:
        """Record that the results of a stretch are stored; what hindered the study no longer does."""
        with self._connected() as connection:
            connection.execute("BEGIN IMMEDIATE")
            connection.execute("INSERT INTO chunks VALUES (?, ?, ?, ?, ?)", (identity, start, stop, failed, seconds))
            connection.execute(
                "UPDATE studies SET done = done + ?, failed = failed + ?, seconds = seconds + ?,"
                " message = CASE WHEN finished IS NULL THEN '' ELSE message END WHERE id = ?",
                (stop - start, failed, seconds, identity),
            )
            connection.execute("COMMIT")

    def note_bytes(self, identity: str, count: int) -> None:
        """Record what the results of a study take where that was not known before."""
        self._write("UPDATE studies SET plan = json_set(plan, '$.bytes', ?) WHERE id = ?", (count, identity))

    def drop_chunk(self, identity: str, start: int) -> None:
        """Record that the results of a stretch cannot be read; a study that was finished goes on."""
        with self._connected() as connection:
            connection.execute("BEGIN IMMEDIATE")
            gone = connection.execute(
                "DELETE FROM chunks WHERE study = ? AND start = ? RETURNING stop - start, failed, seconds",
                (identity, start),
            ).fetchall()
            for counted in gone:
                connection.execute(
                    "UPDATE studies SET done = done - ?, failed = failed - ?, seconds = seconds - ? WHERE id = ?",
                    (*counted, identity),
                )
            connection.execute(
                "UPDATE studies SET status = ?, finished = NULL, statistics = NULL WHERE id = ? AND status = ?",
                (RUNNING, identity, SUCCESSFUL),
            )
            connection.execute("COMMIT")

    def begin(self, identity: str) -> None:
        """Record that a study is being worked on; what hindered it no longer does."""
        self._write(
            "UPDATE studies SET message = '', status = ?, started = COALESCE(started, ?) WHERE id = ? AND status = ?",
            (RUNNING, time.time(), identity, ACCEPTED),
        )

    def finish(self, identity: str, statistics: Any) -> None:
        """Record the statistics of a study whose members are all done, unless it was dismissed meanwhile."""
        self._write(
            "UPDATE studies SET status = ?, finished = ?, statistics = ? WHERE id = ? AND status IN (?, ?)",
            (SUCCESSFUL, time.time(), json.dumps(statistics), identity, *UNFINISHED),
        )

    def end(self, identity: str, status: str, message: str) -> bool:
        """Record that a study has failed or is dismissed; return whether it was unfinished."""
        return self._write(
            "UPDATE studies SET status = ?, finished = ?, message = ? WHERE id = ? AND status IN (?, ?)",
            (status, time.time(), message, identity, *UNFINISHED),
        )

    def note(self, identity: str, message: str) -> None:
        """Record what is to be said about an unfinished study."""
        self._write("UPDATE studies SET message = ? WHERE id = ? AND message != ?", (message, identity, message))

    def statistics(self, identity: str) -> Any:
        """Return the statistics of a successful study."""
        with self._connected() as connection:
            (text,) = connection.execute("SELECT statistics FROM studies WHERE id = ?", (identity,)).fetchone()
        return None if text is None else json.loads(text)

    def remove(self, identity: str) -> None:
        """Forget a study."""
        self._write("DELETE FROM chunks WHERE study = ?", (identity,))
        self._write("DELETE FROM studies WHERE id = ?", (identity,))

    def _write(self, statement: str, values: tuple[Any, ...]) -> bool:
        with self._connected() as connection:
            return connection.execute(statement, values).rowcount > 0


Condition = tuple[str, tuple[str, ...]]
"""Which studies are counted: SQL and its values."""


def identity_of(owner: Owner, name: bytes) -> str:
    """Return the id of the study that an owner has given a name."""
    digest = sha256(json.dumps(owner).encode() + name).digest()
    return urlsafe_b64encode(digest[:ID_BYTES]).decode()


def _require_few(connection: sqlite3.Connection, which: Condition, most: int, limit: str) -> None:
    """Refuse another study where so many are unfinished."""
    condition, values = which
    (unfinished,) = connection.execute(
        f"SELECT COUNT(*) FROM studies WHERE {condition} AND status IN (?, ?)", (*values, *UNFINISHED)
    ).fetchone()
    if unfinished >= most:
        detail = f"{unfinished} studies are unfinished already, the limit {limit}"
        raise Refusal("too-busy", detail, retry_after=10.0)


def _require_room(connection: sqlite3.Connection, which: Condition, needed: int, most: int, limit: str) -> None:
    """Refuse a study that needs more bytes than are free, with the results that are still to be computed."""
    condition, values = which
    (taken,) = connection.execute(
        "SELECT COALESCE(SUM(LENGTH(request) + COALESCE(LENGTH(statistics), 0)"
        " + CASE WHEN status != ? AND json_valid(plan) THEN json_extract(plan, '$.bytes') ELSE 0 END), 0)"
        f" FROM studies WHERE {condition}",
        (DISMISSED, *values),
    ).fetchone()
    if taken + needed > most:
        raise Refusal(
            "storage-unavailable",
            f"requests and results of studies may take {most} bytes, {limit}, of which {max(0, most - taken)} are free "
            f"and {needed} are needed: remove studies that are not needed any more, or ask for fewer members",
        )


def _study(row: tuple[Any, ...]) -> Study | None:
    """Return a study as it is recorded, None where its row is damaged: the others are not to suffer from it."""
    identity, owner, plan, status, *rest = row
    try:
        # An earlier version did not record what results take.
        known = {"bytes": 0, **json.loads(plan)}
    except ValueError:
        known = {}
    if not known.keys() >= PLANNED or status not in STATES:
        LOG.error("the record of a study is damaged", extra={"study": identity})
        return None
    return Study(identity, owner, known, status, *rest)


def storage_unavailable(fault: Exception, reason: str | None = None) -> Refusal:
    """Return the refusal of what cannot be stored, and log the fault itself."""
    LOG.error("the folder of data cannot be used", extra={"reason": str(fault)})
    return Refusal(
        "storage-unavailable", f"the folder of data cannot be used: {reason or reason_of(fault)}", retry_after=10.0
    )


def reason_of(fault: Exception) -> str:
    """Return what clients are told of a fault; its own words may hold paths, addresses and credentials."""
    if isinstance(fault, Refusal):
        return str(fault.problem.detail)
    if isinstance(fault, sqlite3.Error):
        return str(fault)
    number = getattr(fault, "errno", None)
    # Those of the resolution of names are negative.
    return os.strerror(number) if number is not None and number > 0 else "it cannot be reached"

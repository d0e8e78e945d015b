"""Who may ask: keys that are kept as hashes in a file, each with its own rate and its own work.

Each line of the file is ``name hash rate work``: SHA-256 of the key in hexadecimal, requests per second and seconds of
predicted computation per minute, where ``-`` sets no limit. Lines that are empty or begin with ``#`` do not count. Keys
are made by ``python -m service --new-key``; they are random and long, so that a plain hash cannot be searched. The file
is read again when it has changed: keys come, go and change while the service runs. Each server process has its own
share of the limits.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import re
import secrets
import stat
from collections.abc import Mapping, Sequence
from math import ceil, inf
from pathlib import Path
from time import monotonic

from service.observability.logs import LOG
from service.problems import Refusal

BURST = 10.0
"""Seconds of its rate, and minute's tenths of its work, that a key may use at once."""

LOOK_AFTER = 1.0
"""Seconds between two looks at the file."""

_LINE = re.compile(r"([\w.-]{1,64})\s+([0-9a-f]{64})\s+(-|\d+(?:\.\d+)?)\s+(-|\d+(?:\.\d+)?)")


class Allowance:
    """What is left of a limit that refills evenly.

    Parameters
    ----------
    rate : float
        Per second; infinite for no limit.
    most : float
        What can be saved up.
    """

    def __init__(self, rate: float, most: float) -> None:
        self._rate, self._most, self._left, self._seen = rate, most, most, monotonic()

    def take(self, amount: float) -> float:
        """Take an amount and return 0, or the seconds until it may be asked for again; a debt is let run up once."""
        if self._rate == inf:
            return 0.0
        now = monotonic()
        self._left = min(self._most, self._left + self._rate * (now - self._seen))
        self._seen = now
        # Otherwise an amount above all that can be saved up could never be had.
        needed = min(amount, self._most)
        if self._left < needed:
            return (needed - self._left) / self._rate if self._rate > 0.0 else 3600.0
        self._left -= amount
        return 0.0

    def charge(self, amount: float) -> None:
        """Take an amount, whatever is left, or give it back if it is negative."""
        if self._rate != inf:
            self._left = min(self._most, self._left - amount)


class Key:
    """One key's name, hash and what is left of its limits."""

    def __init__(self, name: str, digest: bytes, rate: float, work: float, share: int) -> None:
        self.name, self.digest, self.limits = name, digest, (rate, work)
        rate, work = rate / share, work / 60.0 / share
        self._requests = Allowance(rate, max(1.0, rate * BURST) if rate else 0.0)
        self._work = Allowance(work, work * 6.0 * BURST)

    def request(self) -> None:
        """Count a request, or refuse it."""
        self._take(self._requests, 1.0, "requests")

    def work(self, seconds: float) -> None:
        """Count predicted computation (s), or refuse it."""
        self._take(self._work, seconds, "work")

    def charge(self, seconds: float) -> None:
        """Count computation (s) that was done, or give back what was counted too much."""
        self._work.charge(seconds)

    def _take(self, allowance: Allowance, amount: float, what: str) -> None:
        wait = allowance.take(amount)
        if wait > 0.0:
            detail = f"the quota of {what} of this key is used up"
            raise Refusal("quota-exceeded", detail, headers=(("Retry-After", str(max(1, ceil(wait)))),))


class Keys:
    """The keys in a file.

    Parameters
    ----------
    path : Path
    share : int
        Number of server processes that share the limits.

    Raises
    ------
    ValueError
        For a file that cannot be understood; a later one is logged, and the keys before it stay.
    """

    def __init__(self, path: Path, share: int = 1) -> None:
        self._path, self._share = path, share
        self._stamp = self._stamped()
        self._keys = self._read({})
        self._looked = monotonic()

    def admit(self, headers: Mapping[bytes, bytes]) -> Key:
        """Return the key of a request after counting it.

        Raises
        ------
        Refusal
            401 without a known key, 429 beyond its rate.
        """
        self._look()
        scheme, _, given = headers.get(b"authorization", b"").partition(b" ")
        digest = hashlib.sha256(given.strip()).digest()
        found = None
        # Every key is compared, in constant time, so that the time of an answer tells nothing of any.
        for key in self._keys:
            if hmac.compare_digest(key.digest, digest):
                found = key
        if found is None or scheme.lower() != b"bearer":
            detail = "send a known key as Authorization: Bearer"
            raise Refusal("unauthorized", detail, headers=(("WWW-Authenticate", "Bearer"),))
        found.request()
        return found

    def _look(self) -> None:
        now = monotonic()
        if now - self._looked < LOOK_AFTER:
            return
        self._looked = now
        try:
            stamp = self._stamped()
            if stamp != self._stamp:
                self._keys = self._read({key.digest: key for key in self._keys})
                self._stamp = stamp
                LOG.info("keys were read again", extra={"keys": len(self._keys)})
        except (OSError, ValueError):
            LOG.exception("the file of keys cannot be read; the keys before stay")

    def _stamped(self) -> tuple[int, int, int]:
        state = os.stat(self._path)
        if not stat.S_ISREG(state.st_mode):
            # Reading a pipe would wait for its writer, and everybody with it.
            raise ValueError(f"{self._path} is no file")
        return state.st_mtime_ns, state.st_size, state.st_ino

    def _read(self, known: Mapping[bytes, Key]) -> Sequence[Key]:
        """Return the keys of the file; those whose limits are unchanged keep what is left of them."""
        keys = []
        for number, line in enumerate(self._path.read_text(encoding="utf-8").splitlines(), 1):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            parts = _LINE.fullmatch(line.strip())
            if parts is None:
                raise ValueError(f"line {number} of {self._path} is not: name hash rate work")
            rate, work = (inf if limit == "-" else float(limit) for limit in parts.group(3, 4))
            key = Key(parts[1], bytes.fromhex(parts[2]), rate, work, self._share)
            before = known.get(key.digest)
            same = before is not None and (before.name, before.limits) == (key.name, key.limits)
            keys.append(before if same and before is not None else key)
        return tuple(keys)


def new_key(name: str) -> tuple[str, str]:
    """Return a new key, and the line that admits it without limits."""
    key = f"polhode-{secrets.token_urlsafe(32)}"
    line = f"{name} {hashlib.sha256(key.encode()).hexdigest()} - -"
    if _LINE.fullmatch(line) is None:
        raise ValueError("a name has up to 64 letters, digits, dots, underscores and hyphens")
    return key, line

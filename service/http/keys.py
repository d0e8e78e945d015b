"""API keys: hashes in a file, each key with its own rate of requests and of computation.

Each line of the file is ``name hash rate work``: SHA-256 of the key in hexadecimal, requests per second and seconds of
computation per minute, where ``-`` sets no limit. Empty lines and lines that begin with ``#`` are ignored. Keys are
made by ``python -m service --new-key``; they are random and long, so that a plain hash cannot be searched. The file is
read again when it has changed: keys come, go and change while the service runs. A file that is incomplete (a malformed
line, none at all, no line feed at the end) is reported and not used. Each server process has its own share of the
limits.
"""

from __future__ import annotations

import asyncio
import hashlib
import os
import re
import secrets
import stat
from collections.abc import Mapping
from math import inf
from pathlib import Path
from time import monotonic

from cachetools import LRUCache

from service.observability.logs import LOG
from service.problems import Refusal

BURST = 10.0
"""Seconds of its rate, and minute's tenths of its work, that a key may use at once."""

LOOK_EVERY = 1.0
"""Seconds between two looks at the file."""

WRONG_KEYS_PER_SECOND = 1.0
"""Rate of requests with unknown keys that an address may send; after ten of them at once."""

ADDRESSES = 10_000
"""Number of addresses that are remembered for that."""

_SUSPENDED = 3600.0
"""Seconds after which a key whose limit is zero is told to ask again: its line may have changed."""

_LINE = re.compile(r"([\w.-]{1,64})\s+([0-9a-f]{64})\s+(-|\d+(?:\.\d+)?)\s+(-|\d+(?:\.\d+)?)")

Stamp = tuple[int, int, int]


class Allowance:
    """What is left of a limit that refills evenly.

    Parameters
    ----------
    rate : float
        Per second; infinite for no limit.
    most : float
        What can be saved up.
    """

    __slots__ = ("_left", "_most", "_rate", "_seen")

    def __init__(self, rate: float, most: float) -> None:
        self._rate, self._most, self._left, self._seen = rate, most, most, monotonic()

    def take(self, amount: float) -> float:
        """Take an amount and return 0, or the seconds until it may be taken; a debt is let run up once."""
        if self._rate == inf:
            return 0.0
        if self._rate == 0.0:
            return _SUSPENDED if amount > 0.0 else 0.0
        now = monotonic()
        self._left = min(self._most, self._left + self._rate * (now - self._seen))
        self._seen = now
        # Otherwise an amount above all that can be saved up could never be had.
        needed = min(amount, self._most)
        if self._left < needed:
            return (needed - self._left) / self._rate
        self._left -= amount
        return 0.0

    def charge(self, amount: float) -> None:
        """Take an amount, whatever is left, or give it back if it is negative."""
        if self._rate != inf:
            self._left = min(self._most, self._left - amount)


class Key:
    """One key's name, and what is left of its limits."""

    __slots__ = ("_requests", "_work", "limits", "name")

    def __init__(self, name: str, rate: float, work: float, share: int) -> None:
        self.name, self.limits = name, (rate, work)
        rate, work = rate / share, work / 60.0 / share
        self._requests = Allowance(rate, max(1.0, rate * BURST) if rate else 0.0)
        self._work = Allowance(work, work * 6.0 * BURST)

    def request(self) -> None:
        """Count a request, or refuse it."""
        _take(self._requests, 1.0, "the quota of requests of this key is used up")

    def work(self, seconds: float) -> None:
        """Count computation (s), or refuse it."""
        _take(self._work, seconds, "the quota of work of this key is used up")

    def charge(self, seconds: float) -> None:
        """Count computation (s) that was done, or give back what was counted too much."""
        self._work.charge(seconds)


def _take(allowance: Allowance, amount: float, detail: str) -> None:
    wait = allowance.take(amount)
    if wait > 0.0:
        raise Refusal("quota-exceeded", detail, retry_after=wait)


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
        For a file that cannot be used; a later one is logged, and the keys before it stay.
    """

    def __init__(self, path: Path, share: int = 1) -> None:
        self._path, self._share = path, share
        self._keys: Mapping[bytes, Key] = {}
        self._stamp = self._stamped()
        self._keys = self._read()
        self._wrong: LRUCache[str, Allowance] = LRUCache(ADDRESSES)

    def __len__(self) -> int:
        return len(self._keys)

    def admit(self, headers: Mapping[bytes, bytes], address: str = "") -> Key:
        """Return the key of a request from an address after counting it.

        Raises
        ------
        Refusal
            401 without a known key, 429 beyond its rate, or after too many unknown keys from the address.
        """
        scheme, _, given = headers.get(b"authorization", b"").partition(b" ")
        # A hash is looked up, so that the time which that takes depends on no key.
        key = self._keys.get(hashlib.sha256(given.strip()).digest())
        if key is not None and scheme.lower() == b"bearer":
            key.request()
            return key
        allowance = self._wrong.get(address)
        if allowance is None:
            allowance = self._wrong[address] = Allowance(WRONG_KEYS_PER_SECOND, BURST)
        _take(allowance, 1.0, "too many requests with unknown keys came from this address")
        detail = "send a known key as Authorization: Bearer"
        raise Refusal("unauthorized", detail, headers=(("WWW-Authenticate", "Bearer"),))

    async def follow(self) -> None:
        """Read the file again whenever it has changed, until cancelled; the reading is done in another thread."""
        while True:
            await asyncio.sleep(LOOK_EVERY)
            await asyncio.to_thread(self.refresh)

    def refresh(self) -> None:
        """Read the file again if it has changed; what cannot be used is logged, once for each change."""
        try:
            stamp = self._stamped()
            if stamp == self._stamp:
                return
            self._stamp = stamp
            self._keys = self._read()
            LOG.info("keys were read again", extra={"keys": len(self._keys)})
        except (OSError, ValueError) as error:
            LOG.error("the file of keys cannot be used, the keys before it stay: %s", error)

    def _stamped(self) -> Stamp:
        state = os.stat(self._path)
        if not stat.S_ISREG(state.st_mode):
            # Reading a pipe would wait for its writer.
            raise ValueError(f"{self._path} is no file")
        return state.st_mtime_ns, state.st_size, state.st_ino

    def _read(self) -> Mapping[bytes, Key]:
        """Return the keys of the file by their hashes; those whose limits are unchanged keep what is left of them."""
        keys: dict[bytes, Key] = {}
        text = self._path.read_text(encoding="utf-8")
        if not text.endswith("\n"):
            raise ValueError(f"{self._path} does not end with a line feed; it may be incomplete")
        for number, line in enumerate(text.splitlines(), 1):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            parts = _LINE.fullmatch(line.strip())
            if parts is None:
                raise ValueError(f"line {number} of {self._path} is not: name hash rate work")
            rate, work = (inf if limit == "-" else float(limit) for limit in parts.group(3, 4))
            digest = bytes.fromhex(parts[2])
            before = self._keys.get(digest)
            same = before is not None and (before.name, before.limits) == (parts[1], (rate, work))
            keys[digest] = before if same and before is not None else Key(parts[1], rate, work, self._share)
        if not keys:
            raise ValueError(f"{self._path} has no keys")
        return keys


def new_key(name: str) -> tuple[str, str]:
    """Return a new key, and the line that admits it without limits."""
    key = f"polhode-{secrets.token_urlsafe(32)}"
    line = f"{name} {hashlib.sha256(key.encode()).hexdigest()} - -"
    if _LINE.fullmatch(line) is None:
        raise ValueError("a name has up to 64 letters, digits, dots, underscores and hyphens")
    return key, line

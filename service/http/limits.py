"""Limits on a request before its body is read as a document: media types, transfer coding, size and time."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Awaitable, Callable, Hashable, Iterable, Mapping, MutableMapping, Sequence
from time import monotonic
from typing import Any
from urllib.parse import parse_qs

from starlette.types import Scope

from service.http.held_bytes import HeldBytes
from service.problems import MOST_FAULTS, Fault, Refusal, headline

Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Headers = Mapping[bytes, bytes]

LONGEST_ACCEPT = 1_024
"""Bytes of an Accept header that is read."""

LONGEST_PARAMETER = 40
"""Letters of an unknown parameter's name that are repeated in its refusal."""

LONGEST_KEY = 255
"""Bytes of an Idempotency-Key; the services that brought the header into use allow as many."""

# Java sends ".2", which RFC 9110 does not have.
_WEIGHT = re.compile(r"0(\.\d{0,3})?|\.\d{1,3}|1(\.0{0,3})?")
_CLOSE = ("Connection", "close")


class ClientGone(Exception):
    """The client closed the connection."""


def parameters_of(scope: Scope) -> dict[str, list[str]]:
    """Return the parameters in the address of a request."""
    query: bytes = scope.get("query_string", b"")
    return parse_qs(query.decode("latin-1"), keep_blank_values=True) if query else {}


def refuse_parameters(names: Iterable[str], rule: str, remedy: str | None = None) -> None:
    """Refuse a request with parameters in its address that it must not have, if there are any."""
    faults = [Fault(f"?{name[:LONGEST_PARAMETER]}", rule, remedy) for name in names]
    if faults:
        raise Refusal("invalid-parameter", headline(faults), faults=faults[:MOST_FAULTS])


def require_readable(headers: Headers, *, parts: bool = False) -> bool:
    """Return whether a body is declared as no JSON: a numpy archive or, where these are taken, several parts.

    Raises
    ------
    Refusal
        For another media type.
    """
    declared = headers.get(b"content-type", b"")
    if declared != b"application/json":
        declared = declared.split(b";", 1)[0].strip().lower()
        taken = (b"application/json", b"application/x-npz", *((b"multipart/form-data",) if parts else ()))
        if declared not in taken:
            detail = f"the body must be declared as Content-Type: {b', or '.join(taken).decode()}"
            raise Refusal("unsupported-media-type", detail)
    if headers.get(b"content-encoding", b"identity").lower() != b"identity":
        raise Refusal("unsupported-media-type", "compressed bodies are not read; send the body as it is")
    if headers.get(b"transfer-encoding", b"chunked").lower() != b"chunked":
        raise Refusal("unsupported-transfer-coding", "chunked is the only transfer coding", headers=(_CLOSE,))
    return declared != b"application/json"


def idempotency_key(headers: Headers) -> bytes:
    """Return what makes a repeated request the same one, empty for none; refuse one that is too long."""
    key = headers.get(b"idempotency-key", b"")
    if len(key) > LONGEST_KEY:
        fault = Fault("Idempotency-Key", f"must have at most {LONGEST_KEY} bytes")
        raise Refusal("invalid-parameter", headline([fault]), faults=[fault])
    return key


def negotiated(accept: bytes, offered: Sequence[str]) -> str:
    """Return the media type that an Accept header prefers, the first of equals (RFC 9110, 12.5.1).

    Raises
    ------
    Refusal
        406 if it admits none, or is too long.
    """
    if len(accept) > LONGEST_ACCEPT:
        raise Refusal("not-acceptable", f"the Accept header has more than {LONGEST_ACCEPT} bytes")
    weights = dict(_weighted(entry) for entry in accept.decode("latin-1").lower().split(",") if entry.strip())

    def weight(media: str) -> float:
        ranges = (media, media.split("/", 1)[0] + "/*", "*/*")
        return next((weights[entry] for entry in ranges if entry in weights), 0.0) if weights else 1.0

    best = max(offered, key=weight)
    if weight(best) <= 0.0:
        raise Refusal("not-acceptable", f"this answer is {' or '.join(offered)}")
    return best


def _weighted(entry: str) -> tuple[str, float]:
    media, *parameters = (part.strip() for part in entry.split(";"))
    given = next((part[2:] for part in parameters if part.startswith("q=")), "1")
    return media, float(given) if _WEIGHT.fullmatch(given) else 0.0


class Bodies:
    """Reads request bodies, and bounds what all that are under way take together, and for how long.

    Parameters
    ----------
    limit : int
        Bytes of one body.
    held : HeldBytes
        With unfinished bodies, of which no more is read where there is no room.
    seconds : float
        Time in which a body must have arrived; enforced while `watch` runs.
    """

    def __init__(self, limit: int, held: HeldBytes, seconds: float) -> None:
        self._limit, self._held, self._seconds = limit, held, seconds
        # One look at all of them now and then costs less than a timer for each.
        self._since: dict[asyncio.Task[Any] | None, float] = {}
        self._late: set[asyncio.Task[Any] | None] = set()

    async def read(self, receive: Receive, headers: Headers, client: Hashable) -> bytes:
        """Return the body of a client's request.

        Raises
        ------
        Refusal
            413 for a body that is too long, 408 for one that is too slow, 429 where too much is held. Of a body that is
            too long up to four times the limit is read and dropped first, so that a client which writes before it reads
            gets to see the answer.
        ClientGone
            The connection was closed before the body was complete.
        """
        task = asyncio.current_task()
        self._since[task] = monotonic()
        try:
            declared = headers.get(b"content-length", b"")
            if declared.isdigit() and int(declared) > self._limit:
                if b"expect" not in headers and int(declared) <= 4 * self._limit:
                    await _drop(receive, 4 * self._limit)
                raise self._too_large()
            message = await receive()
            body: bytes = message.get("body", b"")
            if message["type"] == "http.request" and not message.get("more_body") and len(body) <= self._limit:
                return body
            return await self._rest(message, receive, client)
        except asyncio.CancelledError:
            if task is None or task not in self._late:
                raise
            task.uncancel()
            detail = f"the body did not arrive within {self._seconds:g} s, the limit body_seconds"
            raise Refusal("body-too-slow", detail, headers=(_CLOSE,), extra={"limit": self._seconds}) from None
        finally:
            del self._since[task]
            self._late.discard(task)

    async def watch(self) -> None:
        """Refuse bodies that have been under way for too long, until cancelled."""
        while True:
            await asyncio.sleep(min(1.0, self._seconds))
            overdue = monotonic() - self._seconds
            for task, since in list(self._since.items()):
                if since < overdue and task is not None:
                    self._late.add(task)
                    task.cancel()

    async def _rest(self, message: MutableMapping[str, Any], receive: Receive, client: Hashable) -> bytes:
        parts: list[bytes] = []
        size = 0
        try:
            while True:
                if message["type"] != "http.request":
                    raise ClientGone
                parts.append(message.get("body", b""))
                size += len(parts[-1])
                self._held.add(client, len(parts[-1]))
                if size > self._limit:
                    parts.clear()
                    if message.get("more_body"):
                        await _drop(receive, 4 * self._limit - size)
                    raise self._too_large()
                self._held.require_room(client, close=True)
                if not message.get("more_body"):
                    return b"".join(parts)
                message = await receive()
        finally:
            self._held.add(client, -size)

    def _too_large(self) -> Refusal:
        detail = f"the body has more than {self._limit} bytes, the limit max_body_bytes"
        return Refusal("body-too-large", detail, headers=(_CLOSE,), extra={"limit": self._limit})


async def _drop(receive: Receive, most: int) -> None:
    while most > 0:
        message = await receive()
        if message["type"] != "http.request":
            raise ClientGone
        most -= len(message.get("body", b""))
        if not message.get("more_body"):
            return

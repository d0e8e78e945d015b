"""Limits on a request before its body is read as a document: media types and size."""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable, Iterable, Mapping, MutableMapping
from typing import Any

from service.problems import Refusal

Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Headers = Mapping[bytes, bytes]

_WEIGHT = re.compile(r"0(\.\d{0,3})?|1(\.0{0,3})?")


class ClientGone(Exception):
    """The client closed the connection; there is nobody to answer."""


MOST_ACCEPT_BYTES = 1024
"""Of an Accept header: each of its entries is looked at."""


def require_readable(headers: Headers) -> bool:
    """Return whether a body is declared as a numpy archive; refuse one that is not, nor as JSON."""
    declared = headers.get(b"content-type", b"")
    if declared != b"application/json":
        declared = declared.split(b";", 1)[0].strip().lower()
        if declared not in (b"application/json", b"application/x-npz"):
            detail = "the body must be declared as Content-Type: application/json, or application/x-npz"
            raise Refusal("unsupported-media-type", detail)
    if headers.get(b"content-encoding", b"identity").lower() != b"identity":
        raise Refusal("unsupported-media-type", "compressed bodies are not read; send the body as it is")
    return declared == b"application/x-npz"


def require_acceptable(accept: bytes, offered: bytes = b"application/json") -> None:
    """Refuse a request whose Accept header admits none of what is offered."""
    accept = accept.lower()
    family = offered.split(b"/", 1)[0] + b"/*"
    if accept and not (b"*/*" in accept or offered in accept or family in accept):
        raise Refusal("not-acceptable", f"this answer is {offered.decode()}")


def negotiated(accept: bytes, others: Iterable[str]) -> str | None:
    """Return which of `others` an Accept header prefers to JSON, None where that is JSON (RFC 9110, 12.5.1).

    Raises
    ------
    Refusal
        406 if it admits none.
    """
    if len(accept) > MOST_ACCEPT_BYTES:
        raise Refusal("not-acceptable", f"the Accept header has more than {MOST_ACCEPT_BYTES} bytes")
    weights = dict(_weighted(entry) for entry in accept.decode("latin-1").lower().split(",") if entry.strip())

    def weight(media: str) -> float:
        ranges = (media, media.split("/", 1)[0] + "/*", "*/*")
        return next((weights[entry] for entry in ranges if entry in weights), 0.0) if weights else 1.0

    offered = ("application/json", *others)
    best = max(offered, key=weight)
    if weight(best) <= 0.0:
        raise Refusal("not-acceptable", f"this answer is {' or '.join(offered)}")
    return None if best == offered[0] else best


def _weighted(entry: str) -> tuple[str, float]:
    media, *parameters = (part.strip() for part in entry.split(";"))
    given = next((part[2:] for part in parameters if part.startswith("q=")), "1")
    return media, float(given) if _WEIGHT.fullmatch(given) else 0.0


async def read_body(receive: Receive, headers: Headers, limit: int) -> bytes:
    """Return the request's body, never holding more than `limit` bytes of it.

    Raises
    ------
    Refusal
        413 for a longer body. Up to four times the limit is read and dropped first, so that a client which writes
        before it reads gets to see the answer.
    ClientGone
        The connection was closed before the body was complete.
    """
    declared = headers.get(b"content-length", b"")
    if declared.isdigit() and int(declared) > limit:
        if b"expect" not in headers and int(declared) <= 4 * limit:
            await _drop(receive, 4 * limit)
        raise _too_large(limit)
    message = await receive()
    body: bytes = message.get("body", b"")
    if message["type"] == "http.request" and not message.get("more_body") and len(body) <= limit:
        return body
    parts, size = [body], len(body)
    while True:
        if message["type"] != "http.request":
            raise ClientGone
        if size > limit:
            parts.clear()
            if message.get("more_body"):
                await _drop(receive, 4 * limit - size)
            raise _too_large(limit)
        if not message.get("more_body"):
            return b"".join(parts)
        message = await receive()
        parts.append(message.get("body", b""))
        size += len(parts[-1])


async def _drop(receive: Receive, most: int) -> None:
    while most > 0:
        message = await receive()
        if message["type"] != "http.request":
            raise ClientGone
        most -= len(message.get("body", b""))
        if not message.get("more_body"):
            return


def _too_large(limit: int) -> Refusal:
    detail = f"the body has more than {limit} bytes, the limit max_body_bytes"
    return Refusal("body-too-large", detail, headers=(("Connection", "close"),), extra={"limit": limit})

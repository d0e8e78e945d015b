"""From an operation to its answer, without input and output: both clients send what is yielded here."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from typing import Any
from urllib.parse import urlencode
from uuid import uuid4

from polhode_client.arrays import ARCHIVE, body_of, read_answer
from polhode_client.operation import Operation
from polhode_client.refused import Refused

BUSY = (429, 503)


@dataclass(frozen=True)
class Sent:
    """A request."""

    method: str
    path: str
    headers: Mapping[str, str]
    body: bytes | None


@dataclass(frozen=True)
class Received:
    """A response, its header names in lower case."""

    status: int
    headers: Mapping[str, str]
    body: bytes


Step = Sent | float
"""A request to be sent, or seconds to be waited."""


def exchange(
    operation: Operation,
    question: Mapping[str, Any] | None,
    query: Mapping[str, Any] | None,
    patience: float,
) -> Generator[Step, Received | None, Any]:
    """Yield what is to be done, and return the answer.

    Parameters
    ----------
    query : mapping or None
        Parameters of the address; those that are None are left out.
    patience : float
        Longest sum of the waits before a request is sent again (s).

    Raises
    ------
    Refused
        With the service's problem.
    """
    # Questions to operations that answer JSON are answered as archives, too, which hold arrays as they are.
    archived = question is not None and operation.media == "application/json" and not operation.once
    accepted = f"{ARCHIVE}, application/json;q=0.9" if archived else operation.media
    headers = {"accept": f"{accepted}, application/problem+json;q=0.1"}
    if operation.once:
        headers["idempotency-key"] = uuid4().hex
    given = urlencode({name: value for name, value in (query or {}).items() if value is not None})
    path = f"{operation.path}?{given}" if given else operation.path
    body = None
    if question is not None:
        body, headers["content-type"] = body_of(question)
    while True:
        received = yield Sent(operation.method, path, headers, body)
        assert received is not None
        if received.status < 400:
            kind = received.headers.get("content-type", "").partition(";")[0]
            return read_answer(received.body, kind)
        wait = _seconds(received.headers.get("retry-after"))
        if received.status not in BUSY or wait is None or wait > patience:
            raise Refused.read(received.status, received.body, wait)
        patience -= max(wait, 0.01)
        yield wait


def _seconds(header: str | None) -> float | None:
    """Return how long a Retry-After header says to wait: seconds, or a date (RFC 9110, 10.2.3)."""
    if header is None:
        return None
    try:
        return max(0.0, float(header))
    except ValueError:
        pass
    try:
        return max(0.0, (parsedate_to_datetime(header) - datetime.now(UTC)).total_seconds())
    except (TypeError, ValueError):
        return None

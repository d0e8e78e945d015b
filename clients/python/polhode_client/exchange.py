"""From an operation to its answer, without input and output: both clients send what is yielded here."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from typing import Any

from polhode_client.arrays import ARCHIVE, body_of, read_answer
from polhode_client.operations import Operation
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
    media: str | None,
    patience: float,
) -> Generator[Step, Received | None, Any]:
    """Yield what is to be done, and return the answer.

    Parameters
    ----------
    media : str or None
        Media type of a text; None for a document.
    patience : float
        Longest sum of the waits before a request is sent again (s).

    Raises
    ------
    Refused
        With the service's problem.
    """
    accepted = media or ("application/json" if question is None else f"{ARCHIVE}, application/json;q=0.9")
    headers = {"accept": f"{accepted}, application/problem+json;q=0.1"}
    body = None
    if question is not None:
        body, headers["content-type"] = body_of(question)
    while True:
        received = yield Sent(operation.method, operation.path, headers, body)
        assert received is not None
        if received.status < 400:
            kind = received.headers.get("content-type", "").partition(";")[0]
            return received.body.decode() if media not in (None, ARCHIVE) else read_answer(received.body, kind)
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

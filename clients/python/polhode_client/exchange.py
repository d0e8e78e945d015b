"""From an operation to its answer, without input and output: both clients send what is yielded here."""

from __future__ import annotations

import json
from collections.abc import Generator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from typing import Any

from polhode_client.arrays import ARCHIVE, body_of, read_answer
from polhode_client.operations import Operation
from polhode_client.refused import Refused

BUSY = (429, 503)
PLAN = "/v1/plan"


@dataclass(frozen=True)
class Sent:
    """A request."""

    method: str
    path: str
    headers: Mapping[str, str]
    body: bytes | None
    expected: float | None = None
    """Predicted time of the answer (s), if it was planned."""


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
    *,
    planned: bool = False,
) -> Generator[Step, Received | None, Any]:
    """Yield what is to be done, and return the answer.

    Parameters
    ----------
    media : str or None
        Media type of a text; None for a document.
    patience : float
        Longest sum of the waits before a request is sent again (s).
    planned : bool
        Whether to have the question planned first, if it is sent as JSON.

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
    expected = None
    if planned and body is not None and headers["content-type"] != ARCHIVE and operation.path != PLAN:
        plan = b'{"path": "%s", "request": %s}' % (operation.path.encode(), body)
        received = yield Sent("POST", PLAN, {"content-type": "application/json"}, plan)
        expected = _expected(received)
    while True:
        received = yield Sent(operation.method, operation.path, headers, body, expected)
        assert received is not None
        if received.status < 400:
            kind = received.headers.get("content-type", "").partition(";")[0]
            return received.body.decode() if media not in (None, ARCHIVE) else read_answer(received.body, kind)
        wait = _seconds(received.headers.get("retry-after"))
        if received.status not in BUSY or wait is None or wait > patience:
            raise Refused.read(received.status, received.body, wait)
        patience -= max(wait, 0.01)
        yield wait


def _expected(received: Received | None) -> float | None:
    """Return the predicted time of a plan (s), None if there is none."""
    if received is None or received.status != 200:
        return None
    cost = json.loads(received.body)["cost"]
    return None if cost is None else float(cost["milliseconds"]) / 1000.0


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

"""What is recorded of every request: an id, a measurement, for some of them a line in the log."""

from __future__ import annotations

import re
import secrets
from itertools import count
from logging import DEBUG, INFO

from service.observability.logs import LOG
from service.observability.metrics import Metrics

PROBES = ("get_health", "get_readiness")
"""Operations that supervisors send all the time, failing as long as the service starts."""

_PLAIN_ID = re.compile(rb"[A-Za-z0-9._-]{1,64}")


class Records:
    """The records of one server process; `log_requests` is the setting of that name."""

    def __init__(self, metrics: Metrics, log_requests: str) -> None:
        self._observe = metrics.observe
        self.problem = metrics.problem
        self._log_from = {"none": 1000, "failures": 500, "all": 0}[log_requests]
        self._prefix = secrets.token_hex(6).encode()
        self._numbers = count(1)

    def id_of(self, given: bytes | None) -> bytes:
        """Return a request's id: the client's own where it is short and plain, otherwise one that no other has."""
        if given and _PLAIN_ID.fullmatch(given):
            return given
        return b"%b-%x" % (self._prefix, next(self._numbers))

    def finished(
        self, identity: bytes, operation: str, method: str, status: int, seconds: float, key: str | None = None
    ) -> None:
        """Count a request, and log it if such requests are, with the name of the key that it came with."""
        self._observe((operation, status), seconds)
        if status >= self._log_from:
            LOG.log(
                DEBUG if operation in PROBES else INFO,
                "request",
                extra={
                    "request_id": identity.decode(),
                    "operation": operation,
                    "method": method,
                    "status": status,
                    "milliseconds": round(1e3 * seconds, 3),
                    **({} if key is None else {"key": key}),
                },
            )

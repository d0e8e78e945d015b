"""What is kept of answers that did not pass their check: a count, a line in the log and, where set, the request."""

from __future__ import annotations

from pathlib import Path

from service.observability.logs import LOG
from service.observability.metrics import Metrics
from service.problems import Problem

CODE = "self-check-failed"


class FailedChecks:
    """Records answers that were withheld; `folder` is the setting failed_requests, empty where none is kept."""

    def __init__(self, folder: str, metrics: Metrics) -> None:
        self._count = metrics.failed_checks.labels
        self._folder = Path(folder) if folder else None

    def record(self, request_id: str, operation: str, body: bytes, problem: Problem) -> None:
        """Count and log a failed check, and keep the body of the request; other problems leave no trace here."""
        if problem.type.code != CODE:
            return
        self._count(operation, str(problem.extra.get("law", ""))).inc()
        about = {f"check_{name}": value for name, value in problem.extra.items()}
        LOG.error("answer withheld", extra={"request_id": request_id, "operation": operation, **about})
        if self._folder is None:
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            # Ids are short and plain: see `Records.id_of`.
            (self._folder / f"{request_id}.json").write_bytes(body)
        except OSError:
            LOG.exception("a request cannot be kept", extra={"request_id": request_id})

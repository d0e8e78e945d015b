"""The one exception of the client: a request that the service answers with a problem (RFC 9457)."""

from __future__ import annotations

import json
from typing import Any, cast

from polhode_client.documents import Fault, ProblemDocument


class Refused(Exception):
    """The service answered with a problem.

    Attributes
    ----------
    status : int
        HTTP status.
    code : str
        Stable; the service's GET /v1/errors lists them all. "unknown" for a reply that is no problem of the service,
        such as that of a proxy.
    title : str
        The same for every occurrence of the code.
    detail : str
        What happened this time.
    errors : list
        Each with a pointer into the question, what must hold there and, where there is one, the remedy.
    retry_after : float or None
        When the request may be sent again (s).
    problem : dict
        The whole document.
    """

    def __init__(self, problem: ProblemDocument, retry_after: float | None = None) -> None:
        self.status, self.code = int(problem["status"]), problem["code"]
        self.title, self.detail = problem["title"], problem["detail"]
        self.errors: list[Fault] = problem.get("errors") or []
        self.retry_after = problem.get("retry_after_seconds") or retry_after
        self.problem = problem
        super().__init__(self.detail)

    @classmethod
    def read(cls, status: int, content: bytes, retry_after: float | None = None) -> Refused:
        """Return the refusal that a response says."""
        try:
            found: Any = json.loads(content)
        except ValueError:
            found = None
        if not isinstance(found, dict) or "code" not in found:
            text = f"status {status} without a problem of the service"
            found = {"type": "about:blank", "title": "Unknown", "status": status, "detail": text, "code": "unknown"}
        return cls(cast(ProblemDocument, found), retry_after)

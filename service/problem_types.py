"""The registry of problem types that GET /v1/errors publishes: what can go wrong over HTTP, and what to do about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class ProblemType:
    """One entry of the registry that GET /v1/errors publishes.

    Attributes
    ----------
    code : str
        Stable name for machines.
    status : int
        HTTP status.
    title : str
        The same for every occurrence.
    meaning : str
        When it happens and what to do about it.
    """

    code: str
    status: int
    title: str
    meaning: str

    @property
    def uri(self) -> str:
        """Identifier of the type, which leads to its entry in the registry."""
        return f"/v1/errors#{self.code}"


OVERDUE = "deadline-exceeded"
"""Of a computation that took longer than it may."""

REGISTRY: Mapping[str, ProblemType] = {
    entry.code: entry
    for entry in (
        ProblemType(
            "malformed-request",
            400,
            "The request is not HTTP",
            "Send HTTP/1.1 as RFC 9112 has it, with a Host, a path in ASCII, and a head of moderate length.",
        ),
        ProblemType(
            "invalid-json", 400, "The body cannot be read as JSON", "Send one JSON document in UTF-8 (RFC 8259)."
        ),
        ProblemType(
            "too-complex", 400, "The body is nested too deeply or has too many keys", "Send a flatter document."
        ),
        ProblemType(
            "duplicate-key",
            400,
            "An object names a key twice",
            "It is not clear which of the two values is meant. Send each key once.",
        ),
        ProblemType(
            "invalid-archive",
            400,
            "The body cannot be read as a numpy archive",
            "Send arrays of plain numbers and metadata.json, as numpy.savez packs them.",
        ),
        ProblemType("unauthorized", 401, "A key is needed", "Send Authorization: Bearer with a key of this service."),
        ProblemType("not-found", 404, "There is nothing here", "GET /openapi.json lists every path."),
        ProblemType(
            "method-not-allowed", 405, "This path does not answer this method", "The Allow header lists the methods."
        ),
        ProblemType(
            "results-not-ready",
            404,
            "The study has no results",
            "Fetch them when its status is successful; a dismissed study has none.",
        ),
        ProblemType("not-acceptable", 406, "No representation fits the Accept header", "Accept application/json."),
        ProblemType(
            "body-too-slow",
            408,
            "The body did not arrive in time",
            "The detail states the limit; send the body without pauses.",
        ),
        ProblemType(
            "body-too-large",
            413,
            "The body is too large",
            "The detail states the limit; send less, or several requests.",
        ),
        ProblemType(
            "unknown-host",
            421,
            "The service does not answer to this host name",
            "Use a host name of the setting allowed_hosts.",
        ),
        ProblemType(
            "unsupported-media-type",
            415,
            "The body has another media type",
            "Send Content-Type: application/json, or application/x-npz.",
        ),
        ProblemType(
            "invalid-parameter",
            422,
            "A parameter is missing, unknown or outside its range",
            "Each entry of errors points at a place in the document that was sent and says what must hold there.",
        ),
        ProblemType(
            "idempotency-key-reused",
            422,
            "The Idempotency-Key belongs to another request",
            "Send each request with a key of its own; a repeated request is sent as it was before.",
        ),
        ProblemType(
            "unphysical-inertia",
            422,
            "No body has this inertia",
            "No distribution of positive mass has this tensor or these moments of inertia.",
        ),
        ProblemType(
            "open-mesh", 422, "The mesh does not enclose a volume", "Close the mesh; every edge needs two faces."
        ),
        ProblemType(
            "not-applicable",
            422,
            "The method or model does not exist for this system",
            "Choose another method, or none: the service then chooses.",
        ),
        ProblemType(
            "accuracy-unreachable",
            422,
            "The requested accuracy cannot be reached",
            "The members requested and achievable state both accuracies.",
        ),
        ProblemType(
            "budget-exceeded",
            422,
            "The request needs more work than one request may have",
            "The members what, needed and limit state how much; request less, or several parts.",
        ),
        ProblemType("mechanics-error", 422, "The request has no answer", "The detail says why."),
        ProblemType(
            "too-busy",
            429,
            "More work is waiting than can be done in time",
            "Send the request again after the time in the Retry-After header.",
        ),
        ProblemType(
            "quota-exceeded",
            429,
            "The key's quota is used up",
            "Send the request again after the time in the Retry-After header, or request less.",
        ),
        ProblemType(
            "internal-error",
            500,
            "The service failed",
            "The request is not at fault. Report the id, under which the failure is logged.",
        ),
        ProblemType(
            "self-check-failed",
            500,
            "The answer did not pass its check",
            "The result violates a law of mechanics beyond its stated errors. It is therefore wrong and not sent. The "
            "request is not at fault. The members law, connection, time, residual and allowed state which; report the "
            "id of the request.",
        ),
        ProblemType(
            "unsupported-transfer-coding",
            501,
            "The body has a transfer coding that is not understood",
            "Send the body with its Content-Length, or chunked.",
        ),
        ProblemType(
            "worker-lost",
            503,
            "The process that computed this answer died",
            "Other requests are not affected. Send the request again.",
        ),
        ProblemType(
            OVERDUE,
            503,
            "The computation took longer than it may",
            "Where the detail says so, send the request with the header `Prefer: respond-async`: it is then answered "
            "in the background, as a study of one. Or request fewer samples, a lower accuracy, or a narrower range of "
            "what is looked for.",
        ),
        ProblemType(
            "no-room",
            503,
            "Not enough memory for the answer",
            "With a Retry-After header, memory or files of the machine are used up: send the request again after that "
            "time. Without one, the answer needs more than a process may take: request fewer samples.",
        ),
        ProblemType(
            "storage-unavailable",
            503,
            "The study cannot be stored",
            "The disk is full, or the folder of data cannot be written; the detail says which. Nothing was accepted.",
        ),
        ProblemType("shutting-down", 503, "The service is being stopped", "Send the request again in a moment."),
        ProblemType("not-ready", 503, "The service is still starting", "Send the request again in a moment."),
    )
}


def registry() -> list[dict[str, Any]]:
    """Return the registry as GET /v1/errors publishes it."""
    return [
        {"code": t.code, "type": t.uri, "status": t.status, "title": t.title, "meaning": t.meaning}
        for t in REGISTRY.values()
    ]

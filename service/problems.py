"""What goes wrong, as HTTP: one registry of problem types and one table from the mechanics' error tree into it.

Documents follow RFC 9457. Nothing that a client sent is echoed, except a short name of a key inside a JSON pointer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import orjson

from core import errors
from core.assessment.feedback.entry_fault import EntryFault
from core.errors import pointer_of
from core.formulas import UnknownName
from core.multibody.equations.starting_pieces import NoPiece

MEDIA_TYPE = "application/problem+json"
MOST_FAULTS = 20
MOST_BYTES = 1900
LONGEST_REMEDY = 80
"""Characters of a remedy that a headline repeats."""

KNOWN = "known here: "
"""How a remedy begins that lists names."""


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

MECHANICS: Mapping[type[errors.MechanicsError], str] = {
    errors.MechanicsError: "mechanics-error",
    errors.InvalidParameter: "invalid-parameter",
    errors.SlackAtStart: "invalid-parameter",
    errors.PlacesDisagree: "invalid-parameter",
    UnknownName: "invalid-parameter",
    EntryFault: "invalid-parameter",
    NoPiece: "invalid-parameter",
    errors.UnphysicalInertia: "unphysical-inertia",
    errors.OpenMesh: "open-mesh",
    errors.NotApplicable: "not-applicable",
    errors.AccuracyUnreachable: "accuracy-unreachable",
    errors.BudgetExceeded: "budget-exceeded",
    errors.SelfCheckFailed: "self-check-failed",
}
"""The one table from errors to problems; a class that is not listed takes its nearest listed ancestor's entry."""


@dataclass(frozen=True)
class Fault:
    """One entry of a problem's list: a place in the client's document and what must hold there."""

    pointer: str
    detail: str
    remedy: str | None = None

    @property
    def sentence(self) -> str:
        """The place and what must hold there."""
        return f"{self.pointer or 'the document'} {self.detail}"

    def document(self) -> dict[str, str]:
        """Return the entry as it is written."""
        entry = {"pointer": self.pointer, "detail": self.detail}
        return entry | {"remedy": self.remedy} if self.remedy else entry


class Refusal(Exception):
    """A request that is answered by a problem; the parameters are those of `Problem`, by its code."""

    def __init__(
        self,
        code: str,
        detail: str,
        *,
        faults: Sequence[Fault] = (),
        headers: Sequence[tuple[str, str]] = (),
        extra: Mapping[str, Any] | None = None,
        retry_after: float | None = None,
    ) -> None:
        super().__init__(code, detail)
        self.problem = Problem(REGISTRY[code], detail, tuple(faults), tuple(headers), extra or {}, retry_after)

    @classmethod
    def of(cls, problem: Problem) -> Refusal:
        """Return the refusal that a problem amounts to."""
        refusal = cls(problem.type.code, problem.detail)
        refusal.problem = problem
        return refusal


@dataclass(frozen=True)
class Problem:
    """One occurrence of a problem.

    Attributes
    ----------
    type : ProblemType
    detail : str
        One sentence about this occurrence.
    faults : tuple of Fault
        Places in the client's document.
    headers : tuple of (str, str)
        Of the response, for example Allow.
    extra : mapping
        Further members of the document.
    retry_after : float or None
        Time after which the request may be sent again (s); the header has it in whole seconds.
    """

    type: ProblemType
    detail: str
    faults: tuple[Fault, ...] = ()
    headers: tuple[tuple[str, str], ...] = ()
    extra: Mapping[str, Any] = field(default_factory=dict)
    retry_after: float | None = None

    def body(self, request_id: str = "") -> bytes:
        """Return the document, with as many faults as fit into the bounds on their number and on its length.

        Parameters
        ----------
        request_id : str
            Of the request that is refused, by which this occurrence is identified.
        """
        document: dict[str, Any] = {
            "type": self.type.uri,
            "title": self.type.title,
            "status": self.type.status,
            "detail": self.detail,
            "code": self.type.code,
            **({"instance": f"urn:polhode:request:{request_id}", "request_id": request_id} if request_id else {}),
            **self.extra,
        }
        if self.retry_after is not None:
            document["retry_after_seconds"] = round(max(self.retry_after, 1e-3), 3)
        left = MOST_BYTES - len(orjson.dumps(document))
        entries: list[dict[str, str]] = []
        for fault in self.faults[:MOST_FAULTS]:
            entry = fault.document()
            left -= len(orjson.dumps(entry)) + 1
            if left < 0 and entries:
                break
            entries.append(entry)
        if entries:
            document["errors"] = entries
        return orjson.dumps(document)


def code_of(error: errors.MechanicsError) -> str:
    """Return the problem code of an error of the mechanics."""
    return next(MECHANICS[cls] for cls in type(error).__mro__ if cls in MECHANICS)


def problem_of(error: errors.MechanicsError) -> Problem:
    """Return the problem that an error raised while a question is being answered amounts to."""
    faults: tuple[Fault, ...] = (Fault(pointer_of(error.path), error.detail, error.remedy),)
    detail = error.detail
    if isinstance(error, errors.InvalidParameter):
        every = (error, *error.further)
        faults = tuple(Fault(pointer_of(fault.path), f"must {fault.rule}", fault.remedy) for fault in every)
        detail = headline(faults)
    known = ("detail", "path", "remedy", "rule", "further")
    data = {name: value for name, value in vars(error).items() if name not in known}
    return Problem(REGISTRY[code_of(error)], detail, faults, extra=data)


def headline(faults: Sequence[Fault]) -> str:
    """Return one sentence about faults: the first, with its remedy unless that is long, and how many more there are."""
    first = faults[0]
    brief = first.remedy is not None and len(first.remedy) <= LONGEST_REMEDY and not first.remedy.startswith(KNOWN)
    advice = f" ({first.remedy})" if brief else ""
    return f"{first.sentence}{advice}" + (f", and {len(faults) - 1} more" if len(faults) > 1 else "")


def registry() -> list[dict[str, Any]]:
    """Return the registry as GET /v1/errors publishes it."""
    return [
        {"code": t.code, "type": t.uri, "status": t.status, "title": t.title, "meaning": t.meaning}
        for t in REGISTRY.values()
    ]

"""What goes wrong, as HTTP: problem documents, and one table from the mechanics' error tree into their types.

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
from service.problem_types import REGISTRY, ProblemType

MEDIA_TYPE = "application/problem+json"
MOST_FAULTS = 20
MOST_BYTES = 1900
LONGEST_REMEDY = 80
"""Characters of a remedy that a headline repeats."""

KNOWN = "known here: "
"""How a remedy begins that lists names."""


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

"""Requests that hold core's dataclasses as they are, and views of the answers for the documentation.

Answers are never passed through these views; they are written as they come from the handlers. A test compares the two.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from math import isfinite
from typing import Annotated, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from core.errors import BudgetExceeded, InvalidParameter
from core.quantities import Time
from core.systems.budget import Budget
from service import VERSION
from service.requests.error_messages import ARRAY, OBJECT

SIGNATURE = {"source": "polhode", "version": VERSION}


class Request(BaseModel):
    """Base of every question: strict, closed and immutable."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, arbitrary_types_allowed=False)


class View(BaseModel):
    """Base of every view of an answer."""

    model_config = ConfigDict(extra="forbid")


class Signature(View):
    """Who answered."""

    source: Literal["polhode"]
    version: str = Field(description="Version of the service; equal questions get equal bytes within one version.")


class Warned(View):
    """Something the client should know about an answer that is given all the same."""

    code: str
    detail: str
    pointer: str | None = Field(default=None, description="RFC 6901 pointer into the question.")


class Envelope(View):
    """What every answer carries."""

    signature: Signature
    warnings: list[Warned]


def fields_of(found: Any) -> dict[str, Any]:
    """Return a dataclass of core field by field, mappings as JSON objects."""
    return {
        entry.name: dict(value) if isinstance(value, Mapping) else value
        for entry in fields(found)
        for value in (getattr(found, entry.name),)
    }


class ProblemFault(View):
    """A place in the document that was sent and what must hold there."""

    pointer: str = Field(description="RFC 6901 pointer into the document that was sent.")
    detail: str
    remedy: str | None = None


class ProblemDocument(BaseModel):
    """RFC 9457 problem document."""

    type: str
    title: str
    status: int
    detail: str
    code: str = Field(description="Stable; GET /v1/errors lists them all.")
    instance: str | None = Field(default=None, description="This occurrence: a URN that ends in the request's id.")
    request_id: str | None = Field(default=None, description="The same id as in the X-Request-ID header.")
    errors: list[ProblemFault] | None = None


class Span(Request):
    """Evenly spaced times, both ends included, exactly as numpy.linspace gives them."""

    start: Time
    stop: Time
    count: int = Field(ge=1, le=10**9)

    def values(self) -> NDArray[np.float64]:
        """Return the times, shape (count,)."""
        # Near the largest double the last product may overflow, in whose place the stop itself is put.
        with np.errstate(over="ignore"):
            return np.linspace(self.start, self.stop, self.count)


class Counted(Protocol):
    """Evenly spaced times, in whatever kind of number."""

    @property
    def count(self) -> int:
        """How many."""


class ObjectOrArray:
    """Labels the two members of a union, so that a fault is told about the one that the client meant."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        schema: dict[str, Any] = handler(source)
        first, second = schema["choices"]
        return {"type": "union", "mode": "left_to_right", "choices": [(first, OBJECT), (second, ARRAY)]}


Times = Annotated[Span | Annotated[list[Time], Field(min_length=1)], ObjectOrArray()]
"""Times from the given state, which holds at t = 0; they may be negative and in any order."""


def sample_count(times: Counted | list[Any], budget: Budget) -> int:
    """Return the number of samples without making them.

    Raises
    ------
    BudgetExceeded
        For more samples than one answer may have.
    InvalidParameter
        For a span whose width leaves the range of doubles.
    """
    count = len(times) if isinstance(times, list) else times.count
    if count > budget.samples:
        remedy = "ask for fewer times, or in several questions"
        path = ("times",) if isinstance(times, list) else ("times", "count")
        raise BudgetExceeded("samples", count, budget.samples, path=path, remedy=remedy)
    if isinstance(times, Span) and not isfinite(times.stop - times.start):
        remedy = "bring start and stop nearer to each other, or give a list"
        raise InvalidParameter(("times", "stop"), "lie within 1.8e308 s of start", remedy=remedy)
    return count


def sample_times(times: Span | list[float], budget: Budget) -> NDArray[np.float64]:
    """Return the times, shape (n,), or refuse them as `sample_count` does."""
    sample_count(times, budget)
    if not isinstance(times, Span):
        return np.array(times, dtype=np.float64)
    return times.values()


Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]
QuaternionRow = Annotated[list[float], Field(min_length=4, max_length=4)]

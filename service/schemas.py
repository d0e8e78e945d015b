"""Requests that hold core's dataclasses as they are, and views of the answers for the documentation.

Answers are never passed through these views; they are written as they come from the handlers. A test compares the two.
Views of what is also answered in decimal strings are generic in the kind of number, so that their fields stand once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from math import isfinite
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from core.errors import BudgetExceeded, InvalidParameter, Path
from core.quantities import Time, Unit
from core.systems.budget import Budget
from core.systems.rounding import ROUND_TRIP
from service import VERSION
from service.requests.declared_units import unit_at
from service.requests.layout import ARRAY, OBJECT

SIGNATURE = {"source": "polhode", "version": VERSION}


class DecimalString(str):
    """A number of a certified answer: a decimal string whose digits are proven."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "str"}


N = TypeVar("N")
"""Kind of number in which an answer is written: `float` or `DecimalString`."""

Vector = Annotated[list[N], Field(min_length=3, max_length=3)]
Matrix = Annotated[list[Vector[N]], Field(min_length=3, max_length=3)]
QuaternionRow = Annotated[list[N], Field(min_length=4, max_length=4)]
UnitVector = Annotated[Vector[N], Unit("1")]
AngularVelocityRow = Annotated[Vector[N], Unit("rad s^-1")]
Ratio = Annotated[N, Unit("1")]
Seconds = Annotated[N, Unit("s")]
Radians = Annotated[N, Unit("rad")]
RadiansPerSecond = Annotated[N, Unit("rad s^-1")]
PerSecond = Annotated[N, Unit("s^-1")]
Joules = Annotated[N, Unit("J")]
Errors = dict[str, Annotated[float | None, Unit("as in the field of that name")]]
"""Bounds of the errors of the figures beside it, by their names; of a vector its length, null where the figure is."""
AngularMomentumMagnitude = Annotated[N, Unit("kg m^2 s^-1")]


class Request(BaseModel):
    """Base of every question: strict, closed and immutable."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, arbitrary_types_allowed=False)

    def unit_of(self, path: Path) -> str | None:
        """Return the unit in which the number at a path of the question is written, None where it is not known."""
        return unit_at(type(self), path)


class View(BaseModel):
    """Base of every view of an answer."""

    model_config = ConfigDict(extra="forbid")

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        # A view in one kind of number is described as the view is.
        if cls.__doc__ is None and cls.__pydantic_generic_metadata__["origin"] is not None:
            cls.__doc__ = cls.__pydantic_generic_metadata__["origin"].__doc__


class Signature(View):
    """Name and version of the service."""

    source: Literal["polhode"]
    version: str = Field(description="Version of the service; equal questions get equal bytes within one version.")


class Notice(View):
    """Something the client should know about an answer that is given all the same."""

    code: str = Field(description="Stable name for machines.")
    detail: str = Field(description="One sentence for people.")
    pointer: str | None = Field(default=None, description="RFC 6901 pointer into the question.")


class Signed(View):
    """What every document carries."""

    signature: Signature


class Envelope(Signed):
    """What every answer carries."""

    warnings: list[Notice] = Field(description="What the client should know about the answer.")


def fields_of(found: Any) -> dict[str, Any]:
    """Return a dataclass of core field by field, mappings as JSON objects."""
    answer = {name: getattr(found, name) for name in _names_of_fields(found.__class__)}
    # Most are numbers, and what is a mapping is slow to find out.
    mappings = [name for name, value in answer.items() if type(value) not in _PLAIN and isinstance(value, Mapping)]
    return answer | {name: dict(answer[name]) for name in mappings} if mappings else answer


_PLAIN = frozenset({type(None), float, int, bool, str, tuple, list})
"""Types of most fields."""


@cache
def _names_of_fields(cls: type[Any]) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(cls))


class Fault(View):
    """A place in the document that was sent and what must hold there."""

    pointer: str = Field(description="RFC 6901 pointer into the document that was sent.")
    detail: str = Field(description="What must hold there.")
    remedy: str | None = Field(default=None, description="What would mend it.")


class ProblemDocument(BaseModel):
    """RFC 9457 problem document."""

    type: str = Field(description="URI reference of the problem type, an entry of GET /v1/errors.")
    title: str = Field(description="The same for every occurrence.")
    status: int = Field(description="HTTP status.")
    detail: str = Field(description="What happened this time.")
    code: str = Field(description="Stable name for machines; GET /v1/errors lists them all.")
    instance: str | None = Field(default=None, description="This occurrence: a URN that ends in the request's id.")
    request_id: str | None = Field(default=None, description="The request's id, as in the X-Request-ID header.")
    errors: list[Fault] | None = Field(default=None, description="Places in the document that was sent, at most 20.")
    what: str | None = Field(default=None, description="What is counted, where a budget is exceeded.")
    needed: int | None = Field(default=None, description="How much of it the question needs.")
    limit: int | None = Field(default=None, description="How much of it one question may have.")
    requested: Ratio[float] | None = Field(default=None, description="Relative error that was tolerated.")
    achievable: Ratio[float] | None = Field(default=None, description="Relative error that can be reached.")
    retry_after_seconds: Seconds[float] | None = Field(default=None, description="When to ask again.")
    id: str | None = Field(default=None, description="Request id under which a failure is logged.")


class _ReadAsOne:
    """Has the union read and documented as one thing, so that a fault names its place and not its members."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        choices = [
            {"type": "literal", "expected": ["meaningful"]},
            {"type": "int", "strict": True, "ge": 1, "le": ROUND_TRIP},
        ]
        return {
            "type": "custom-error",
            "schema": {"type": "union", "mode": "left_to_right", "choices": choices},
            "custom_error_type": "digits",
            "custom_error_message": f"must be 'meaningful' or an integer from 1 to {ROUND_TRIP}",
        }

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        whole = {"type": "integer", "minimum": 1, "maximum": ROUND_TRIP}
        return {"anyOf": [{"type": "string", "const": "meaningful"}, whole]}


Rounding = Annotated[Literal["meaningful"] | int, _ReadAsOne()]
ROUND: Any = Field(
    default=None,
    description="Write samples with fewer digits: 'meaningful' keeps the decimal places that the error and the "
    "inherited error support, a number keeps as many significant digits. The stated error covers it. "
    "Default: every number reads back as the same double.",
)


class Span(Request):
    """Evenly spaced times, both ends included, exactly as numpy.linspace gives them."""

    start: Time = Field(description="First time.")
    stop: Time = Field(description="Last time.")
    count: int = Field(ge=1, le=10**9, description="Number of times.")

    def values(self) -> NDArray[np.float64]:
        """Return the times, shape (count,)."""
        # Near the largest double the last product may overflow, in whose place the stop itself is put.
        with np.errstate(over="ignore"):
            return np.linspace(self.start, self.stop, self.count)


class ObjectOrArray:
    """Labels the two members of a union, so that a fault names the one that the client meant."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        schema: dict[str, Any] = handler(source)
        first, second = schema["choices"]
        return {"type": "union", "mode": "left_to_right", "choices": [(first, OBJECT), (second, ARRAY)]}


Times = Annotated[Span | Annotated[list[Time], Field(min_length=1)], ObjectOrArray()]
"""Times from the given state, which holds at t = 0; they may be negative and in any order."""


def require_one(question: Any, first: str, *others: str) -> None:
    """Raise `InvalidParameter` unless a question gives exactly one of its fields."""
    if sum(getattr(question, name) is not None for name in (first, *others)) != 1:
        remedy = f"give one of {', '.join((first, *others[:-1]))} and {others[-1]}"
        both = "both" if len(others) == 1 else "more than one"
        raise InvalidParameter(first, f"be given, or {' or '.join(others)}, and not {both}", remedy=remedy)


def number_of(times: Any) -> int:
    """Return the number of times, in a list or evenly spaced, in whatever kind of number."""
    return len(times) if isinstance(times, list) else int(times.count)


def ends_of(times: Any) -> list[float]:
    """Return times among which are the least and the largest (s)."""
    if isinstance(times, list):
        return times
    # A single time is the start, wherever the stop is.
    return [times.start, times.stop] if times.count > 1 else [times.start]


def in_closed_form(method: Any) -> bool:
    """Return whether nothing is to be integrated."""
    return method is None or bool(method.kind == "closed-form")


def sample_count(times: Any, budget: Budget) -> int:
    """Return the number of samples without making them.

    Raises
    ------
    BudgetExceeded
        For more samples than one answer may have.
    InvalidParameter
        For a span whose width leaves the range of doubles.
    """
    count = number_of(times)
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

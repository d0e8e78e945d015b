"""The same questions to any number of digits: asked with ``digits``, answered in ball arithmetic as decimal strings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal, Union

from pydantic import BaseModel, Field

from core.certified.decimals import decimal_of_fraction
from core.certified.raising import check_digits
from core.integration.budget import Budget
from core.integration.trajectory import Work
from service.numerals import SpanInNumerals, instants
from service.reading import ByPresence
from service.routing import Answer, Example, Question
from service.schemas import View, sample_count

SET_UP = 5e-3
"""Predicted time without samples (s). A precision may be raised a hundredfold, so no such question runs in the server."""


class AccuracyInDigits(View):
    """How right every number of the answer is."""

    requested: int = Field(description="Significant digits.")
    error: str = Field(
        description="Largest error of any number, relative to itself: 0.51 units of its last digit, proven. What is "
        "smaller than 10^(-2 digits) of the largest norm of its vector is given as far as that place."
    )
    how: Literal["ball arithmetic"]


def accuracy(digits: int) -> Answer:
    """Return what is said of every number that was made with so many digits."""
    return {"requested": digits, "error": f"5.1e-{digits}", "how": "ball arithmetic"}


def work(samples: int) -> Work:
    """Return the cost of an answer."""
    return Work(samples=samples)


@dataclass(frozen=True)
class PerSample:
    """Predicted time of a sample of d digits, first + second d + third d^2 (s); measured in docs/physics/certified.md."""

    first: float
    second: float
    third: float

    def price(self, digits: int, samples: int) -> float:
        """Return the predicted time of an answer (s)."""
        return SET_UP + samples * (self.first + digits * (self.second + digits * self.third))


@dataclass(frozen=True)
class InDigits:
    """What is asked and answered where a question has ``digits``.

    Attributes
    ----------
    question, answer : type
        Pydantic models.
    handle, price : callable
        As in `Question`.
    examples : mapping
        By a short name.
    """

    question: type[BaseModel]
    answer: type[BaseModel]
    handle: Callable[[Any, Budget], Answer]
    price: Callable[[Any, Budget], float]
    examples: Mapping[str, Example] = field(default_factory=dict)


def with_digits(route: Question, other: InDigits) -> Question:
    """Return a route that answers its own question and, where that has ``digits``, the other."""

    def handle(question: Any, budget: Budget) -> Answer:
        return (other if isinstance(question, other.question) else route).handle(question, budget)

    def price(question: Any, budget: Budget) -> float:
        return (other if isinstance(question, other.question) else route).price(question, budget)

    either = Union.__getitem__((route.question, other.question))
    return replace(
        route,
        question=Annotated.__class_getitem__((either, ByPresence("digits"))),  # type: ignore[attr-defined]
        answer=Union.__getitem__((route.answer, other.answer)),
        handle=handle,
        price=price,
        examples={**route.examples, **other.examples},
    )


def times_written(times: SpanInNumerals | list[float | str], digits: int) -> list[str]:
    """Return times as decimal strings."""
    return [decimal_of_fraction(time, digits) for time in instants(times)]


def affordable(times: Any, digits: int, numbers: int, budget: Budget) -> int:
    """Return the number of samples, of so many numbers each, or raise `BudgetExceeded`."""
    samples = sample_count(times, budget)
    check_digits(digits, numbers * samples)
    return samples


def longest(numbers: Sequence[Any]) -> int:
    """Return the number of characters of the longest numeral, those of a double if there is none."""
    return max((len(number) for number in numbers if isinstance(number, str)), default=17)

"""The same questions to any number of digits: asked with ``digits``, answered in ball arithmetic as decimal strings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Annotated, Any, Literal, Union

from pydantic import BaseModel, Field

from core.certified.adaptive_precision import check_digits
from core.certified.decimals import decimal_of_fraction
from core.certified.exact_bodies import MOST_PARTS
from core.certified.exact_inputs import exact
from core.certified.exact_mass import ExactMass
from core.notices import Notice
from core.systems.budget import Budget
from service.execution.cost_model import CalibratedCost, CostModel
from service.requests.decimal_models import SpanInNumerals, instants
from service.requests.request_reader import DiscriminatedByKey
from service.routing import Answer, Example, PostRoute
from service.schemas import View, sample_count

BESIDE: Mapping[str, str] = {
    "accuracy": "the digits say how accurate the answer is",
    "method": "every digit is proven in closed form, and a method steps in doubles",
    "measure": "a measurement steps in doubles, of which no digit is proven",
    "round": "the digits say how many are written",
    "input_uncertainty": "every number of the question is taken as exact",
}
"""What a question has only without digits, and why."""

REMEDIES: Mapping[str, str] = {
    "must be a number": 'give a JSON number; decimal strings are taken, as exact numbers, only beside "digits" '
    "(16 to 1000)",
    "digits": "give a whole number from 16 to 1000, or leave it out for an answer in double precision",
}

SET_UP = 5e-3
"""Predicted time without samples (s): precision may be raised a hundredfold, so no such question runs in the server."""


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


@dataclass(frozen=True)
class PerSample:
    """Predicted time of a sample of d digits: constant + linear d + quadratic d^2 (s).

    Attributes
    ----------
    constant, linear, quadratic : float
    """

    constant: float
    linear: float
    quadratic: float

    def seconds(self, digits: int) -> float:
        """Return the time of one sample (s)."""
        return self.constant + digits * (self.linear + digits * self.quadratic)


@dataclass(frozen=True)
class Cost:
    """What an answer in so many digits will cost.

    Attributes
    ----------
    samples : int
    numbers : int
        In each sample.
    each : PerSample
        Time of a sample.
    before : float
        Time before the first (s).
    beside : int
        Numbers beside those of the samples.
    text : float
        Bytes that are no numbers.
    """

    samples: int
    numbers: int
    each: PerSample
    before: float = 0.0
    beside: int = 10
    text: float = 600.0


@dataclass(frozen=True)
class CertifiedCost:
    """Price of a question with ``digits``, by what is counted of it."""

    cost: Callable[[Any, Budget], Cost]

    def __call__(self, question: Any, budget: Budget) -> float:
        """Return the predicted time of computing an answer (s)."""
        cost, digits = self.cost(question, budget), int(question.digits)
        return SET_UP + cost.before + cost.samples * cost.each.seconds(digits)

    def size(self, question: Any, budget: Budget) -> float:
        """Return the predicted length of an answer as JSON (bytes)."""
        cost, digits = self.cost(question, budget), int(question.digits)
        # A numeral has a sign, a point, two quotes and a comma.
        return cost.text + (cost.beside + cost.samples * cost.numbers) * (digits + 5.0)


@dataclass(frozen=True)
class InDigits:
    """What is asked and answered where a question has ``digits``.

    Attributes
    ----------
    question, answer : type
        Pydantic models.
    handle, price, planning_probe, examples
        As in `PostRoute`.
    """

    question: type[BaseModel]
    answer: type[BaseModel]
    handle: Callable[[Any, Budget], Answer]
    price: CostModel
    planning_probe: Callable[[Any], Any] | None = None
    examples: Mapping[str, Example] = field(default_factory=dict)


@dataclass(frozen=True)
class EitherPrice(CalibratedCost):
    """Price of a route that answers two questions: its own, and another in so many digits."""

    other: InDigits

    def __call__(self, question: Any, budget: Budget) -> float:
        """Return the predicted time of computing an answer (s)."""
        if isinstance(question, self.other.question):
            return self.other.price(question, budget)
        return super().__call__(question, budget)

    def size(self, question: Any, budget: Budget) -> float:
        """Return the predicted length of an answer as JSON (bytes)."""
        if isinstance(question, self.other.question):
            return self.other.price.size(question, budget)
        return super().size(question, budget)


def with_digits(route: PostRoute, other: InDigits) -> PostRoute:
    """Return a route that answers its own question and, where that has ``digits``, the other."""

    def handle(question: Any, budget: Budget) -> Answer:
        return (other if isinstance(question, other.question) else route).handle(question, budget)

    def planning_probe(question: Any) -> Any:
        found = (other if isinstance(question, other.question) else route).planning_probe
        return question if found is None else found(question)

    assert isinstance(route.price, CalibratedCost)
    either = Union.__getitem__((route.question, other.question))
    return replace(
        route,
        question=Annotated.__class_getitem__((either, DiscriminatedByKey("digits", BESIDE, REMEDIES))),  # type: ignore[attr-defined]
        answer=Union.__getitem__((route.answer, other.answer)),
        handle=handle,
        small=lambda question: not isinstance(question, other.question) and route.small(question),
        price=EitherPrice(route.price.operation, route.price.counts, other),
        planning_probe=planning_probe,
        examples={**route.examples, **other.examples},
    )


def notices(body: ExactMass) -> tuple[Notice, ...]:
    """Return what every answer about a question's body has to say of it."""
    return tuple(notice.inside("body") for notice in body.notices)


def times_written(times: Iterable[Fraction], digits: int) -> list[str]:
    """Return times as decimal strings."""
    return [decimal_of_fraction(time, digits) for time in times]


def affordable(times: Any, digits: int, numbers: int, budget: Budget) -> int:
    """Return the number of samples, of so many numbers each, or raise `BudgetExceeded`."""
    samples = sample_count(times, budget)
    check_digits(digits, numbers * samples)
    return samples


def ends(times: SpanInNumerals | list[float | str]) -> tuple[Fraction, Fraction]:
    """Return the earliest and the latest of the times."""
    if isinstance(times, list):
        found = instants(times)
    else:
        found = exact(times.start, ("times", "start")), exact(times.stop, ("times", "stop"))
    return min(found), max(found)


def summing(body: BaseModel) -> float:
    """Return the predicted time to sum a body in rational arithmetic (s)."""
    positions: Any = getattr(body, "positions", ())
    length = max((longest(row) for row in positions), default=0)
    # Every part turns and moves by denominators of its own, which multiply; more parts are refused, at no cost.
    parts = min(_parts(body), MOST_PARTS)
    return len(positions) * (1.2e-4 + 8.5e-9 * length * length) + parts * (4e-3 + 5e-5 * parts)


def _parts(body: Any) -> int:
    return sum(max(1, _parts(part.body)) for part in getattr(body, "parts", ()))


def longest(numbers: Sequence[Any]) -> int:
    """Return the number of characters of the longest numeral, those of a double if there is none."""
    return max((len(number) for number in numbers if isinstance(number, str)), default=17)

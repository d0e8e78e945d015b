"""What every certified answer says, and how the route of a certified question is made from that of an ordinary one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from typing import Any, Literal

from pydantic import Field

from core.bodies.exact_mass import ExactMass
from core.digits.adaptive_precision import check_digits
from core.digits.decimals import decimal_of_fraction
from core.notices import Notice
from core.systems.budget import Budget
from service.requests.decimal_models import inexact_doubles
from service.routing import Answer, PostRoute
from service.schemas import DecimalString, Envelope, Ratio, View, sample_count

ROOT = "/v1/certified"

ONLY_ORDINARY: Mapping[str, str] = {
    "accuracy": "the digits say how accurate the answer is",
    "method": "every digit is proven in closed form, and a method steps in doubles",
    "measure": "a measurement steps in doubles, of which no digit is proven",
    "round": "the digits say how many are written",
    "input_uncertainty": "every number of the question is taken as exact",
}
"""Fields that a certified question lacks, and why."""


class CertifiedAccuracy(View):
    """How right every number of the answer is."""

    requested: int = Field(description="Significant digits.")
    error: Ratio[DecimalString] = Field(
        description="Largest error of any number, relative to itself: 0.51 units of its last digit, proven. What is "
        "smaller than 10^(-2 digits) of the largest norm of its vector is given as far as that place."
    )
    how: Literal["ball arithmetic"]


class Certified(Envelope):
    """What every certified answer carries."""

    accuracy: CertifiedAccuracy


def samples_of(times: Any, digits: int, numbers: int, budget: Budget) -> int:
    """Return the number of samples, of so many numbers each, or raise `BudgetExceeded`."""
    samples = sample_count(times, budget)
    check_digits(digits, numbers * samples)
    return samples


Handler = Callable[[Any, Budget], Answer]


def certified_route(route: PostRoute, handle: Handler, *, description: str = "", **own: Any) -> PostRoute:
    """Return the route of the certified form of a question; `own` are the other fields of a `PostRoute`."""
    summary = f"{route.summary}; every digit proven"
    only_here = {
        name: f"{why}; POST {route.path} takes it"
        for name, why in ONLY_ORDINARY.items()
        if name in route.question.model_fields
    }
    return PostRoute(
        ROOT + route.path.removeprefix("/v1"),
        "certified_" + route.operation_id,
        summary,
        "certified",
        handle=_saying_what_was_read(handle),
        **own,
        description=f"{COMPUTED} {description or EXACTLY_AS_READ}",
        elsewhere=only_here,
    )


COMPUTED = "Computed in ball arithmetic: every number of the answer is a decimal string of so many proven digits."

EXACTLY_AS_READ = (
    "Numbers of the question are exact: decimal strings mean what they say, and JSON numbers are the doubles next to "
    'them. "0.1" is not 0.1, which the answer warns of.'
)


def _saying_what_was_read(handle: Handler) -> Handler:
    """Return a handler that warns of JSON numbers whose decimals no double has."""

    def warning(question: Any, budget: Budget) -> Answer:
        answer = handle(question, budget)
        places = list(islice(inexact_doubles(question), 1))
        if not places:
            return answer
        detail = (
            "JSON numbers are read as doubles, and this one is not the decimal that is written: give decimals in "
            "quotes where all the digits count"
        )
        return answer | {"warnings": [*answer.get("warnings", ()), Notice("read-as-double", detail, places[0])]}

    return warning


def naming_certified(route: PostRoute, paths: Iterable[str]) -> PostRoute:
    """Return a route that, if its question has a certified form, names that to who sends `digits`."""
    path = ROOT + route.path.removeprefix("/v1")
    if path not in paths:
        return route
    return replace(route, elsewhere={"digits": f"POST {path} answers to any number of digits from 16 to 1000"})


def accuracy(digits: int) -> Answer:
    """Return what is said of every number that was made with so many digits."""
    return {"requested": digits, "error": f"5.1e-{digits}", "how": "ball arithmetic"}


def notices(body: ExactMass) -> tuple[Notice, ...]:
    """Return what every answer about a question's body has to say of it."""
    return tuple(notice.inside("body") for notice in body.notices)


def times_written(times: Iterable[Fraction], digits: int) -> list[str]:
    """Return times as decimal strings."""
    return [decimal_of_fraction(time, digits) for time in times]

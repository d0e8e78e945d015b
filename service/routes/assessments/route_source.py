"""A route as the source of an assessed question's answers, units and scales."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from core.assessment.graded_question import GradedQuestion
from core.errors import MechanicsError, Path
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.work import spend
from service.problems import Refusal
from service.requests.declared_units import has_field, numbers_within, outputs_of, unit_at
from service.responses.json_rows import written
from service.routes.bodies import properties_of
from service.routes.certified.answers import ONLY_ORDINARY
from service.routing import Answer, PostRoute

DIGITS = 20
"""In which figures are proven: more than doubles have."""

PROVING = 100
"""Work (`core.work`) of an answer in proven digits."""


@dataclass(frozen=True)
class RouteSource:
    """Answers of a route; see `core.assessment.graded_question.Source`.

    Attributes
    ----------
    read : callable
        From JSON bytes to the question; raises `Refusal`.
    proven : tuple of PostRoute and callable, optional
        The route that answers in proven digits, and how it is read.
    """

    route: PostRoute
    read: Callable[[bytes], Any]
    budget: Budget
    proven: tuple[PostRoute, Callable[[bytes], Any]] | None = None

    @property
    def subject(self) -> str:
        """Last steps of the path."""
        return self.route.path.removeprefix("/v1/")

    @cached_property
    def outputs(self) -> frozenset[str]:
        """What a request may name as its outputs."""
        return outputs_of(self.route.question)

    def answer(self, request: str) -> Answer:
        """Return the answer to a request, given as JSON."""
        try:
            return self.route.handle(self.read(request.encode()), self.budget)
        except Refusal as refusal:
            raise Refused(refusal) from None

    def certified(self, request: Any) -> Answer | None:
        """Return the answer in proven decimal strings, None where there is none."""
        if self.proven is None:
            return None
        route, read = self.proven
        spend(PROVING)
        document = {name: value for name, value in request.items() if name not in ONLY_ORDINARY} | {"digits": DIGITS}
        try:
            return route.handle(read(json.dumps(document).encode()), self.budget)
        except (MechanicsError, Refusal):
            return None

    def errors(self, request: Any) -> tuple[Mapping[str, Any], str] | None:
        """Return bounds of the errors of the answer's figures and what they rest on, None without."""
        if self.route.errors is None:
            return None
        return self.route.errors(self.read(json.dumps(request).encode()), self.budget)

    def takes(self, field: str) -> bool:
        """Return whether a request may have a field."""
        return has_field(self.route.question, field)

    def unit_of_answer(self, path: Path) -> str | None:
        """Return the declared unit of a figure."""
        return unit_at(self.route.answer, path)

    def units_of_request(self, request: Any) -> Callable[[Path], str | None]:
        """Return a function from the path of a number of a request to its written unit, None if unknown."""
        question = self.read(json.dumps(request).encode())
        return lambda path: question.unit_of(path)

    def scales(self, answer: Mapping[str, Any], request: Any) -> Mapping[str, float]:
        """Return, by unit, the largest magnitude of an answer's numbers; of the request's where those are 0."""
        found: dict[str, float] = {}
        for model, document in ((self.route.answer, json.loads(written(answer))), (self.route.question, request)):
            here: dict[str, float] = {}
            for unit, magnitude in numbers_within(model, document):
                here[unit] = max(here.get(unit, 0.0), magnitude)
            found = here | {unit: magnitude for unit, magnitude in found.items() if magnitude > 0.0}
        return found

    def rotation(self, request: Any) -> TorqueFree | None:
        """Return the free rotation that a request is about."""
        question = self.read(json.dumps(request).encode())
        return TorqueFree(properties_of(question.body), np.array(question.angular_velocity))


class Refused(MechanicsError):
    """A request that the reader refused."""

    def __init__(self, refusal: Refusal) -> None:
        super().__init__(refusal.problem.detail)
        self.refusal = refusal


def graded_question(
    route: PostRoute,
    read: Callable[[bytes], Any],
    request: Any,
    budget: Budget,
    uncertainty: float | Mapping[Path, float] | None,
    proven: tuple[PostRoute, Callable[[bytes], Any]] | None = None,
) -> GradedQuestion:
    """Return the question that a request to a route asks; see `RouteSource` and `GradedQuestion`."""
    return GradedQuestion(RouteSource(route, read, budget, proven), request, uncertainty)

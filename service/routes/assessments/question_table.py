"""Questions inside of other requests: a path and a request, read and answered as if they had been sent there."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from typing import Any

from pydantic import Field

from core.assessment.graded_question import GradedQuestion
from core.errors import MechanicsError, Path, inside_field, pointer_of
from core.systems.budget import Budget
from service.problems import Fault, Problem, Refusal, headline
from service.requests.declared_units import unit_at
from service.requests.request_reader import Limits, Reader
from service.requests.suggestions import nearest_path
from service.routes.assessments.route_source import Refused, RouteSource, graded_question
from service.routes.certified.answers import ROOT
from service.routing import PostRoute
from service.schemas import Request

WITHIN: Path = ("question", "request")


class EndpointRequest(Request):
    """A request to another endpoint, whose answer is the reference."""

    path: str = Field(max_length=200, description="Of the endpoint, for example /v1/rotation/precession.")
    request: dict[str, Any] = Field(description="The body that it would be sent.")


class QuestionTable:
    """The routes whose answers can be references, some of which have proven digits, too; `purpose` is for refusals."""

    def __init__(
        self, routes: Sequence[PostRoute], certified: Sequence[PostRoute], purpose: str = "be assessed"
    ) -> None:
        self._purpose = purpose
        self._routes: Mapping[str, PostRoute] = {route.path: route for route in routes}
        self._certified: Mapping[str, PostRoute] = {route.path: route for route in certified}
        self._reader = cache(self._new_reader)

    def route(self, question: EndpointRequest) -> PostRoute:
        """Return the route of a question, or refuse the path."""
        if question.path not in self._routes:
            near = nearest_path(question.path, self._routes)
            remedy = f"did you mean {near}?" if near else "GET /openapi.json lists every path"
            fault = Fault("/question/path", f"must be the path of a question that can {self._purpose}", remedy)
            raise Refusal("invalid-parameter", headline([fault]), faults=[fault])
        return self._routes[question.path]

    def source(self, question: EndpointRequest, budget: Budget) -> RouteSource:
        """Return what answers a question and others to the same path."""
        route = self.route(question)
        return RouteSource(route, self._reader(route.path).read, budget)

    def graded(
        self, question: EndpointRequest, request: Any, budget: Budget, uncertainty: float | Mapping[Path, float] | None
    ) -> GradedQuestion:
        """Return a request, that of the question or a changed one, as one to be graded."""
        route = self.route(question)
        twin = self._certified.get(ROOT + route.path.removeprefix("/v1"))
        proven = None if twin is None else (twin, self._reader(twin.path).read)
        return graded_question(route, self._reader(route.path).read, request, budget, uncertainty, proven)

    def answered(
        self, question: EndpointRequest, budget: Budget, uncertainty: float | Mapping[Path, float] | None
    ) -> GradedQuestion:
        """Return the question with its answer; refusals of it point into the document that holds it."""
        graded = self.graded(question, question.request, budget, uncertainty)
        with within_question():
            graded.answer  # noqa: B018
        return graded

    def readable(self, question: EndpointRequest) -> PostRoute:
        """Return the route of a question, or refuse one that cannot be read."""
        route = self.route(question)
        with within_question():
            self._read(route, question.request)
        return route

    def unit_of(self, question: EndpointRequest, path: Path) -> str | None:
        """Return the unit of a number of the question as it is written, None where it is not known."""
        route = self.route(question)
        try:
            unit: str | None = self._read(route, question.request).unit_of(path)
        except (Refusal, MechanicsError):
            # What is refused as it stands may be asked with other numbers.
            return unit_at(route.question, path)
        return unit

    def small(self, question: EndpointRequest) -> bool:
        """Return whether the question, or the problem that answers it, may be begun in the event loop."""
        try:
            route = self.route(question)
            return route.small(self._read(route, question.request))
        except (Refusal, MechanicsError):
            return True

    def _read(self, route: PostRoute, request: Any) -> Any:
        return self._reader(route.path).read(json.dumps(request).encode())

    def _new_reader(self, path: str) -> Reader[Any]:
        route = self._routes[path] if path in self._routes else self._certified[path]
        # The document that holds the request has been held against the service's own limits.
        return Reader(route.question, Limits(10**4, 10**9, 10**9, 10**9), route.elsewhere)


@contextmanager
def within_question() -> Iterator[None]:
    """Have refusals of the question point into the document that holds it."""
    try:
        with inside_field(*WITHIN):
            yield
    except Refusal as refusal:
        raise moved_inside(refusal.problem, WITHIN) from None
    except Refused as refused:
        raise moved_inside(refused.refusal.problem, WITHIN) from None


def moved_inside(problem: Problem, path: Path) -> Refusal:
    """Return the refusal of a part of a document, with pointers into the document."""
    faults = problem.faults or (Fault("", problem.detail),)
    moved = [Fault(pointer_of(path) + fault.pointer, fault.detail, fault.remedy) for fault in faults]
    code = problem.type.code if problem.type.status == 422 else "invalid-parameter"
    return Refusal(code, headline(moved), faults=moved, extra=problem.extra)

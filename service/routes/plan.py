"""Any other question, planned: what it would be answered with, at which cost and error.

The request is run. A plan that has used its slice of processor time is ended and made again from less: from the request
at few of its times, then without running it (`PostRoute.in_short`).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any, Literal

from pydantic import Field

from core.errors import BudgetExceeded, MechanicsError
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.methods.fixed_step import FixedStep
from service.execution.request_handler import signed
from service.problem_types import REGISTRY
from service.problems import MOST_FAULTS, Fault, Problem, Refusal, problem_of
from service.requests.request_reader import Limits, Reader
from service.requests.suggestions import nearest_path
from service.responses.json_stream import composed
from service.routes.described_answer import ScenePart
from service.routes.step_counts import EXPLICIT, least_evaluations
from service.routing import Answer, ExpectedDuration, PostRoute, never
from service.schemas import DecimalString, Envelope, Ratio, Request, View, ends_of, in_closed_form, sample_count
from service.schemas import Fault as FaultView

WITHIN = "/request"

WITHIN_SLICE = ExpectedDuration("immediate", "it was answered within 20 ms of processor time")

AT_ENDS = "it was not answered within 20 ms of processor time, but at the ends of its times, and samples are counted"


class PlanRequest(Request):
    """A request that is not sent: where to, and what."""

    path: str = Field(max_length=200, description="Of the endpoint, for example /v1/rotation/trajectory.")
    request: Any = Field(description="The body that it would be sent.")


class PlannedModel(View):
    """The model that would be used; the other fields are those of the answer, where it has them."""

    name: str = Field(description="For example torque-free rigid body.")
    why: str = Field(description="The facts of the question that selected it.")
    degrees_of_freedom: int = Field(description="Of the motion that is computed, not of the body.")
    regime: str | None = Field(default=None, description="The branch of the solution that applies.")
    mobility: int | None = Field(default=None, description="Degrees of freedom of a described scene.")
    coordinates: int | None = Field(default=None, description="Coordinates that remain of a described scene.")
    rows: int | None = Field(default=None, description="Equations of constraint that remain of it.")
    described: tuple[int, int] | None = Field(default=None, description="Coordinates and equations before.")
    apart: list[ScenePart[float]] | None = Field(default=None, description="Its parts.")
    noticed: list[str] | None = Field(default=None, description="Sentences about it.")


class PlannedCost(View):
    """What an answer costs, where that is counted exactly: it holds on every machine."""

    evaluations: int | None = Field(
        description="Of equations of motion; null if the method chooses its steps and the question was not run to its "
        "end."
    )
    samples: int | None = Field(description="Of the motion; null where none is sampled.")
    members: int | None = Field(default=None, description="Of a study.")
    bytes: int | None = Field(description="Length of the answer as JSON; null if the question was not run to its end.")


class PlannedError(View):
    """How wrong the answer would be, relative to the largest norm of the whole motion."""

    error: Ratio[float] | Ratio[DecimalString] = Field(
        description="A decimal string for certified questions, then relative to each number."
    )
    how: str = Field(description="As in the answer.")
    inherited: Ratio[float] | None = Field(
        description="Error propagated from the uncertainty of the inputs; null where nothing is known of the phase."
    )


class PlannedFault(FaultView):
    """What the request would be refused for."""

    code: str = Field(description="Of the problem.")


Duration = Literal["immediate", "seconds", "minutes", "beyond the limit"]


class PlanAnswer(Envelope):
    """A plan."""

    path: str = Field(description="As in the request.")
    answerable: bool | None = Field(
        description="Whether the request would be answered; null where that is known only by running it to its end. "
        "A closed form that is answered at the ends of its times is answered."
    )
    duration: Duration | None = Field(
        description="immediate: within 20 ms of processor time; seconds: longer, up to the deadline of a request, at "
        "which it is ended; minutes: a study; beyond the limit: refused for its size; null where it is refused "
        "otherwise."
    )
    why: str | None = Field(description="What the duration is known from; null where the request would be refused.")
    model: PlannedModel | None = Field(description="null for questions that no model of motion is chosen for.")
    method: Method | None = Field(description="null where no motion is computed.")
    cost: PlannedCost | None = Field(description="null if the request would be refused.")
    accuracy: PlannedError | None = Field(
        description="null where no error is stated, or the question was not run to its end."
    )
    errors: list[PlannedFault] = Field(description="What the request would be refused for.")


def planning(routes: Sequence[PostRoute]) -> PostRoute:
    """Return the route that plans questions to `routes`."""
    table: Mapping[str, PostRoute] = {route.path: route for route in routes}

    @cache
    def reader(path: str) -> Reader[Any]:
        # The document that holds the request has been held against the service's own limits.
        return Reader(table[path].question, Limits(10**4, 10**9, 10**9, 10**9), table[path].elsewhere)

    def plan(planned: Planned, question: PlanRequest, budget: Budget) -> Answer:
        route = table.get(question.path)
        if route is None:
            near = nearest_path(question.path, table)
            remedy = f"did you mean {near}?" if near else "GET /openapi.json lists every path"
            fault = Fault("/path", "must be the path of a question", remedy)
            return _refused(question.path, Problem(REGISTRY["not-found"], fault.detail, (fault,)), "")
        try:
            request = reader(route.path).read(json.dumps(question.request).encode())
            return {"path": route.path, **planned(route, request, budget)}
        except Refusal as refusal:
            return _refused(route.path, refusal.problem, WITHIN)
        except MechanicsError as error:
            return _refused(route.path, problem_of(error), WITHIN)

    return PostRoute(
        "/v1/plan",
        "plan",
        "What is known beforehand of any request: model, method, cost, error and faults",
        "accuracy",
        PlanRequest,
        PlanAnswer,
        partial(plan, _run),
        description="Always answered with 200: what the request would be refused for stands under `errors`. The "
        "request is run for at most 20 ms of processor time; how long one takes that is not answered by then, and "
        "whether it is answered, is known only by running it.",
        in_short=(partial(plan, _run_at_ends), partial(plan, _unrun)),
    )


Planned = Callable[[PostRoute, Any, Budget], Answer]
"""How a question to a route is planned."""


def _run(route: PostRoute, request: Any, budget: Budget) -> Answer:
    """Plan a question by its answer."""
    evaluations = _evaluations(request, budget)
    found = route.answer_for_plan(request, budget)
    if found is None:
        return _unrun(route, request, budget)
    length = len(composed(route, signed(found), None).whole())
    done = found.get("work")
    evaluations = evaluations if done is None else done.evaluations
    plan = _plan(request, found, evaluations) | WITHIN_SLICE._asdict()
    plan["cost"]["bytes"] = length
    warnings = [notice.inside("request") for notice in found.get("warnings", ())]
    return plan | {"answerable": True, "accuracy": _stated(found), "warnings": warnings}


def _run_at_ends(route: PostRoute, request: Any, budget: Budget) -> Answer:
    """Plan a question by the answer at few of its times, where it has any.

    Where work grows with counts that the question states, the answer at the ends of its times decides whether there is
    one. Elsewhere a motion has to be followed to its end for that: the model is known at the first time alone.
    """
    times = getattr(request, "times", None)
    if times is None:
        return _unrun(route, request, budget)
    counted = route.small is not never and in_closed_form(getattr(request, "method", None))
    ends = ends_of(times)
    few = sorted({min(ends), max(ends)}) if counted else ends[:1]
    try:
        found = route.handle(request.model_copy(update={"times": few}), budget)
    except MechanicsError:
        if counted:
            raise
        # The question as a whole may be answered.
        return _unrun(route, request, budget)
    plan = _plan(request, found, _evaluations(request, budget)) | route.duration._asdict()
    return plan | ({"answerable": True, "why": AT_ENDS} if counted else {})


def _unrun(route: PostRoute, request: Any, budget: Budget) -> Answer:
    """Plan a question by what it states."""
    return _plan(request, {}, _evaluations(request, budget)) | route.duration._asdict()


def _plan(request: Any, fields: Answer, evaluations: int | None) -> Answer:
    """Return what a plan has of a question that is not answered, with the model of an answer at its start."""
    model = fields.get("model")
    members = fields.get("members")
    if model is None and members:
        model = members[0]["model"]
    method = getattr(request, "method", None)
    return {
        "answerable": None,
        "model": model,
        "method": {"kind": "closed-form"} if method is None and _stated(fields) else method,
        "cost": {
            "evaluations": evaluations,
            "samples": _samples(request),
            "members": _members(request),
            "bytes": None,
        },
        "accuracy": None,
        "errors": [],
        "warnings": [],
    }


def _stated(fields: Answer) -> dict[str, Any] | None:
    """Return the statement of error of an answer; of an ensemble, the worst member's."""
    stated = [fields["accuracy"]] if "accuracy" in fields else [one["accuracy"] for one in fields.get("members", ())]
    if not stated:
        return None
    known = [entry if isinstance(entry, dict) else vars(entry) for entry in stated]
    worst: dict[str, Any] = max(known, key=lambda entry: float(entry["error"]))
    # A certified answer's is a decimal string, as it may be below the range of doubles.
    return {"error": worst["error"], "how": worst["how"], "inherited": worst.get("inherited")}


def _evaluations(request: Any, budget: Budget) -> int | None:
    """Return the number of evaluations of a method with a fixed step, 0 where none is run, None if it is not known.

    Raises
    ------
    BudgetExceeded
        For more evaluations or samples than the budget.
    """
    method = getattr(request, "method", None)
    if in_closed_form(method) or request.times is None:
        return 0 if getattr(request, "methods", None) is None else None
    if not isinstance(method, FixedStep):
        return None
    # Steps between samples are counted from all of them.
    sample_count(request.times, budget)
    count = least_evaluations(method, request.times)
    if count > budget.evaluations:
        remedy = "use a larger step, or ask for earlier times"
        raise BudgetExceeded("evaluations", count, budget.evaluations, path=("method", "step"), remedy=remedy)
    return count if isinstance(method, EXPLICIT) else None


def _members(request: Any) -> int | None:
    return request.all_members().members if hasattr(request, "all_members") else None


def _samples(request: Any) -> int | None:
    times = getattr(request, "times", None)
    if times is None:
        return None
    starts, sample = getattr(request, "angular_velocities", None), getattr(request, "sample", None)
    members = sample.count if sample is not None else len(starts) if starts is not None else 1
    return int((len(times) if isinstance(times, list) else times.count) * members)


def _refused(path: str, problem: Problem, within: str) -> Answer:
    faults = problem.faults or (Fault("", problem.detail),)
    errors = []
    for fault in faults[:MOST_FAULTS]:
        entry = {"code": problem.type.code, "pointer": within + fault.pointer, "detail": fault.detail}
        errors.append(entry | {"remedy": fault.remedy} if fault.remedy else entry)
    nothing = dict.fromkeys(("why", "model", "method", "cost", "accuracy"))
    duration = "beyond the limit" if problem.type.code == "budget-exceeded" else None
    return {"path": path, "answerable": False, "duration": duration, **nothing, "errors": errors, "warnings": []}

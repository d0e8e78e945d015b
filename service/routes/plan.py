"""Any other question, planned: what it would be answered with, at which cost and error; it is not answered."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Annotated, Any

from pydantic import Field

from core.errors import BudgetExceeded, MechanicsError
from core.notices import Notice
from core.quantities import Unit
from core.systems.budget import Budget
from core.systems.methods import Method
from service.execution.cost_model import UNCOUNTABLE, CalibratedCost, calibration, one
from service.execution.request_handler import signed
from service.problems import MOST_FAULTS, REGISTRY, Fault, Problem, Refusal, problem_of
from service.requests.request_reader import Limits, Reader
from service.requests.suggestions import nearest_path
from service.responses.json_rows import written
from service.routes.described_answer import ScenePart
from service.routes.planning_probes import OF_FEW_STEPS, in_closed_form
from service.routing import Answer, PlanningProbe, PostRoute
from service.schemas import DecimalString, Envelope, Ratio, Request, View
from service.schemas import Fault as FaultView

WITHIN = "/request"


class PlanRequest(Request):
    """A request that is not sent: where to, and what."""

    path: str = Field(max_length=200, description="Of the endpoint, for example /v1/rotation/trajectory.")
    request: Any = Field(description="The body that it would be sent.")


class PlannedModel(View):
    """The model that would answer; fields beside the first three are those of the answer, where it has them."""

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
    """What an answer would cost. Counts and bytes hold on every machine, milliseconds on the calibrated one, idle.

    Waiting for a turn is not foreseen, nor the time that the answer travels.
    """

    evaluations: int | None = Field(description="Of equations of motion; null if they are not foreseen.")
    samples: int | None = Field(description="Of the motion; null where none is sampled.")
    bytes: int = Field(description="Length of the answer as JSON.")
    milliseconds: Annotated[float, Unit("ms")] = Field(description="Time of computing and writing the answer.")


class PlannedError(View):
    """How wrong the answer would be, relative to the largest norm of the whole motion."""

    error: Ratio[float] | Ratio[DecimalString] = Field(
        description="A decimal string for certified questions, then relative to each number."
    )
    how: str = Field(description="closed form: a bound; record of the method: an order of magnitude.")
    inherited: Ratio[float] | None = Field(
        description="Error propagated from the uncertainty of the inputs; null where nothing is known of the phase."
    )


class PlannedFault(FaultView):
    """What the request would be refused for."""

    code: str = Field(description="Of the problem.")


class PlanAnswer(Envelope):
    """A plan."""

    path: str = Field(description="As in the request.")
    answerable: bool = Field(description="Whether the request would be answered.")
    model: PlannedModel | None = Field(description="null for questions that no model of motion is chosen for.")
    method: Method | None = Field(description="null where no motion is computed.")
    cost: PlannedCost | None = Field(description="null if the request would be refused.")
    accuracy: PlannedError | None = Field(description="null where no error is stated.")
    errors: list[PlannedFault] = Field(description="What the request would be refused for.")


def planning(routes: Sequence[PostRoute]) -> PostRoute:
    """Return the route that plans questions to `routes`."""
    table: Mapping[str, PostRoute] = {route.path: route for route in routes}

    @cache
    def reader(path: str) -> Reader[Any]:
        # The document that holds the request has been held against the service's own limits.
        return Reader(table[path].question, Limits(10**4, 10**9, 10**9, 10**9), table[path].elsewhere)

    def plan(question: PlanRequest, budget: Budget) -> Answer:
        route = table.get(question.path)
        if route is None:
            near = nearest_path(question.path, table)
            remedy = f"did you mean {near}?" if near else "GET /openapi.json lists every path"
            fault = Fault("/path", "must be the path of a question", remedy)
            return _refused(question.path, Problem(REGISTRY["not-found"], fault.detail, (fault,)), "")
        try:
            request = reader(route.path).read(json.dumps(question.request).encode())
            return {"path": route.path, **_planned(route, request, budget)}
        except Refusal as refusal:
            return _refused(route.path, refusal.problem, WITHIN)
        except MechanicsError as error:
            return _refused(route.path, problem_of(error), WITHIN)

    return PostRoute(
        "/v1/plan",
        "plan",
        "Model, method, cost, error and refusals of any other question, which is not answered",
        "accuracy",
        PlanRequest,
        PlanAnswer,
        plan,
        CalibratedCost("plan", one),
        description="Always answered with 200: what the request would be refused for stands under `errors`.",
    )


def _planned(route: PostRoute, request: Any, budget: Budget) -> Answer:
    seconds = route.price(request, budget)
    method, evaluations = getattr(request, "method", None), _evaluations(route, request, budget)
    probed = route.planning_probe
    probe = PlanningProbe(route.handle(request, budget)) if probed is None else probed(request, budget)
    seconds = seconds if probe.seconds is None else probe.seconds
    fields, exact = probe.fields, probe.exact
    length = _length(fields, probe.growth)
    model, stated, notices = fields.get("model"), _stated(fields), list(fields.get("warnings", ()))
    if model is None and fields.get("members"):
        model = fields["members"][0]["model"]
    if probe.error is not None:
        notices = [notice for notice in (exact or fields)["warnings"] if notice.code not in OF_FEW_STEPS]
        if probe.error > request.accuracy:
            detail = f"with this setting the error of {request.method.kind} is of the order of {probe.error:.1g}"
            notices.append(Notice("accuracy-not-reached", detail, ("method",)))
        inherited = (_stated(exact) or {}).get("inherited")
        stated = {"error": probe.error, "how": "record of the method", "inherited": inherited}
    elif stated:
        method = {"kind": "closed-form"}
    return {
        "answerable": True,
        "model": model,
        "method": method,
        "cost": {
            "evaluations": evaluations,
            "samples": _samples(request),
            "bytes": round(length),
            "milliseconds": round(1e3 * (seconds + length * calibration().writing), 3),
        },
        "accuracy": stated,
        "errors": [],
        "warnings": [notice.inside("request") for notice in notices],
    }


def _length(fields: Answer, growth: Mapping[str, float]) -> float:
    """Return the length of an answer as JSON, of which some fields are so many times as long as those given."""
    entries = signed(fields).items()
    # Quotes, colon and comma of each entry, and the braces around all.
    return 1.0 + sum(len(name) + 4 + len(written(value)) * growth.get(name, 1.0) for name, value in entries)


def _stated(fields: Answer) -> dict[str, Any] | None:
    """Return the statement of error of an answer; of an ensemble, the worst member's."""
    stated = [fields["accuracy"]] if "accuracy" in fields else [one["accuracy"] for one in fields.get("members", ())]
    if not stated:
        return None
    known = [entry if isinstance(entry, dict) else vars(entry) for entry in stated]
    worst: dict[str, Any] = max(known, key=lambda entry: float(entry["error"]))
    # A certified answer's is a decimal string, as it may be below the range of doubles.
    return {"error": worst["error"], "how": worst["how"], "inherited": worst.get("inherited")}


def _evaluations(route: PostRoute, request: Any, budget: Budget) -> int | None:
    if not isinstance(route.price, CalibratedCost):
        return 0
    counted = route.price.counts(request, budget)
    # How many steps ladders take, and methods that choose them in scenes, is only known by running them.
    method = getattr(request, "method", None)
    fixed = hasattr(method, "step")
    scene = "connections" in counted or ("motions" in counted and not in_closed_form(method))
    if "ladders" in counted or (scene and not fixed):
        return None
    count = round(min(UNCOUNTABLE, sum(n for name, n in counted.items() if name.startswith("evaluations of "))))
    if fixed and count > budget.evaluations:
        remedy = "use a larger step, or ask for earlier times"
        raise BudgetExceeded("evaluations", count, budget.evaluations, path=("method", "step"), remedy=remedy)
    return count


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
    nothing = dict.fromkeys(("model", "method", "cost", "accuracy"))
    return {"path": path, "answerable": False, **nothing, "errors": errors, "warnings": []}

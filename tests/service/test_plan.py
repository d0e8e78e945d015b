"""Plans: what they state is what then happens, and what would be refused is refused in them."""

from __future__ import annotations

import dataclasses
import os
from random import Random
from typing import Any, get_args

import orjson
import pytest

from core.errors import MechanicsError
from core.systems.budget import Budget
from core.systems.methods import Method
from service.execution.request_handler import RequestHandler
from service.problems import Refusal, problem_of
from service.requests.request_reader import Limits
from service.responses.json_stream import composed
from service.routes import questions
from service.routes.assessments.route_source import RouteSource
from service.routes.scenes import members, name_of
from service.routing import PostRoute
from tests.service.conftest import client_of, inline_service
from tests.service.random_questions import questions_of

SERVICE = inline_service()
ROUTES = {route.path: route for route in questions()}
UNPLANNED = ("/v1/plan", "/v1/assessments", "/v1/variants", "/v1/studies", "/v1/find")
DOCUMENTS = ("/v1/scenes/import", "/v1/scenes/export")
# Plans are made of any other question; these cost their question. Studies have a test of their own.
PLANNED = [(route, name) for route in ROUTES.values() if route.path not in UNPLANNED for name in route.examples]
PATH = "/v1/rotation/trajectory"
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
DRAWN = questions_of({name_of(scene): scene.outputs for scene in members()})
EACH = int(os.environ.get("RANDOM_QUESTIONS", "40"))
"""How many random questions are asked at each endpoint."""
INTEGRATORS = [method for method in get_args(get_args(Method)[0]) if method.kind != "closed-form"]
FREE: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
    "angular_velocity": [0.3, 1.0, 0.2],
    "times": {"start": 0.0, "stop": 30.0, "count": 61},
}

pytestmark = pytest.mark.anyio


async def planned(path: str, request: Any) -> Any:
    async with client_of(SERVICE) as client:
        response = await client.post("/v1/plan", json={"path": path, "request": request})
    assert response.status_code == 200
    return response.json()


def planned_in_short(path: str, request: Any, attempt: int = 2) -> Any:
    """Return a plan as it is made when so many attempts have used their slice."""
    route = ROUTES["/v1/plan"]
    read = HANDLER.read(route, orjson.dumps({"path": path, "request": request}))
    return orjson.loads(composed(route, HANDLER.answer(route, read, attempt), None).whole())


async def asked(path: str, request: Any) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(path, content=orjson.dumps(request), headers={"content-type": "application/json"})


@pytest.mark.parametrize(("route", "name"), PLANNED, ids=[f"{route.path}: {name}" for route, name in PLANNED])
async def test_a_plan_that_ran_to_the_end_has_the_figures_of_the_answer(route: PostRoute, name: str) -> None:
    request = dict(route.examples[name].question)
    plan, response = await planned(route.path, request), await asked(route.path, request)
    answer = response.json()
    assert plan["answerable"]
    assert plan["errors"] == []
    assert plan["duration"] == "immediate"
    if route.path != "/v1/work-precision":
        # Its answers have times.
        assert plan["cost"]["bytes"] == len(response.content)
    if "model" in answer:
        assert plan["model"] == answer["model"]
    if "accuracy" in answer:
        assert {name: plan["accuracy"][name] for name in ("error", "how")} == {
            name: answer["accuracy"][name] for name in ("error", "how")
        }
    if "work" in answer:
        assert plan["cost"]["evaluations"] == answer["work"]["evaluations"]
        assert plan["cost"]["samples"] in (None, answer.get("requested_samples", answer["work"]["samples"]))


@pytest.mark.parametrize(
    "method",
    [{"kind": "explicit-euler", "step": 0.001}, {"kind": "runge-kutta-4", "step": 0.005}],
    ids=lambda method: method["kind"],
)
async def test_evaluations_of_explicit_steps_are_counted(method: dict[str, Any]) -> None:
    answer = (await asked(PATH, FREE | {"method": method})).json()
    plan = planned_in_short(PATH, FREE | {"method": method}, 1)
    assert plan["duration"] == "seconds"
    assert plan["cost"]["evaluations"] == answer["work"]["evaluations"]
    assert plan["method"] == method
    assert plan["model"] == answer["model"]


@pytest.mark.parametrize(
    "method", [{"kind": "dormand-prince-853", "tolerance": 1e-13}, {"kind": "implicit-midpoint", "step": 0.1}]
)
def test_what_a_method_takes_that_iterates_or_chooses_its_steps_is_not_foreseen(method: dict[str, Any]) -> None:
    plan = planned_in_short(PATH, FREE | {"method": method, "times": [1e5]})
    assert plan["duration"] == "seconds"
    assert plan["cost"]["evaluations"] is None
    assert plan["accuracy"] is None


async def test_the_bound_of_the_closed_form_is_foreseen_exactly() -> None:
    plan, answer = await planned(PATH, FREE), (await asked(PATH, FREE)).json()
    for name in ("error", "how", "inherited"):
        assert plan["accuracy"][name] == answer["accuracy"][name]
    assert plan["method"] == {"kind": "closed-form"}


@pytest.mark.parametrize(
    "change",
    [
        {"accuracy": 2.0},
        {"accuracy": 1e-300},
        {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, -1.0]}},
        {"body": {"kind": "principal-moments", "moments": [1.0, 2.0]}},
        {"body": {"kind": "sphere"}},
        {"times": []},
        {"times": {"start": 0.0, "stop": 1.0, "count": 10**8}},
        {"times": [1e300]},
        {"unknown": 1},
        {"attitude": [0.0, 0.0, 0.0, 0.0]},
        {"attitude": [1.0, 0.0, 0.0, 0.0], "method": {"kind": "runge-kutta-4", "step": 0.1}},
        {"method": {"kind": "explicit-euler", "step": 1e-9}},
        {"angular_velocity": [1.0, 2.0]},
    ],
    ids=str,
)
async def test_refusals_are_those_of_the_request_itself(change: dict[str, Any]) -> None:
    request = FREE | change
    plan, problem = await planned(PATH, request), (await asked(PATH, request)).json()
    assert problem["status"] >= 400
    assert not plan["answerable"]
    assert plan["cost"] is None
    assert {entry["code"] for entry in plan["errors"]} == {problem["code"]}
    assert [entry["pointer"] for entry in plan["errors"]] == ["/request" + e["pointer"] for e in problem["errors"]]


@pytest.mark.parametrize("request_", [None, 3, [], "text", {}, {"body": 10**400}])
async def test_anything_can_be_planned(request_: Any) -> None:
    for path in ROUTES:
        if path not in UNPLANNED:
            assert not (await planned(path, request_))["answerable"]


async def test_an_unknown_path_is_reported() -> None:
    plan = await planned("/v1/nothing", {})
    assert [(entry["code"], entry["pointer"]) for entry in plan["errors"]] == [("not-found", "/path")]
    (fault,) = (await planned("/v1/rotation/trajectories", {}))["errors"]
    assert fault["remedy"] == "did you mean /v1/rotation/trajectory?"


def test_a_plan_that_is_made_without_an_answer_states_what_is_counted() -> None:
    request = FREE | {"times": {"start": 0.0, "stop": 1e4, "count": 10**6}}
    for attempt, model in ((1, "torque-free rigid body"), (2, None)):
        plan = planned_in_short(PATH, request | {"method": {"kind": "explicit-euler", "step": 1e-3}}, attempt)
        # Samples lie a little more than ten steps apart; all but the first and the last take one more step each.
        assert plan["cost"] == {"evaluations": 10**7 + 10**6 - 2, "samples": 10**6, "members": None, "bytes": None}
        assert (plan["answerable"], plan["duration"], plan["accuracy"]) == (None, "seconds", None)
        assert "known only by running it" in plan["why"]
        assert (plan["model"] and plan["model"]["name"]) == model


def test_where_samples_are_counted_the_ends_of_the_times_decide() -> None:
    request = FREE | {"times": {"start": 0.0, "stop": 1e4, "count": 10**6}}
    plan = planned_in_short(PATH, request, 1)
    assert (plan["answerable"], plan["duration"], plan["cost"]["samples"]) == (True, "seconds", 10**6)
    assert (plan["model"]["name"], plan["method"]) == ("torque-free rigid body", {"kind": "closed-form"})
    far = planned_in_short(PATH, request | {"times": {"start": 0.0, "stop": 1e300, "count": 10**6}}, 1)
    assert (far["answerable"], far["errors"][0]["code"]) == (False, "accuracy-unreachable")
    # Without a run, that is not known.
    assert planned_in_short(PATH, request, 2)["answerable"] is None


@pytest.mark.parametrize("attempt", [1, 2])
def test_whatever_is_not_run_is_refused_for_what_it_states(attempt: int) -> None:
    for request in (FREE | {"unknown": 1}, FREE | {"method": {"kind": "explicit-euler", "step": 1e-9}}):
        plan = planned_in_short(PATH, request, attempt)
        assert (plan["answerable"], len(plan["errors"])) == (False, 1)


async def test_what_is_refused_for_its_size_is_beyond_the_limit() -> None:
    plan = await planned(PATH, FREE | {"times": {"start": 0.0, "stop": 1.0, "count": 10**8}})
    assert (plan["answerable"], plan["duration"]) == (False, "beyond the limit")
    assert (await planned(PATH, FREE | {"unknown": 1}))["duration"] is None


async def test_a_study_is_planned_without_running_its_question(monkeypatch: pytest.MonkeyPatch) -> None:
    study = {
        "question": {"path": PATH, "request": FREE | {"method": {"kind": "explicit-euler", "step": 1e-4}}},
        "vary": [{"pointer": "/angular_velocity/0", "values": [0.1, 0.2, 0.3]}],
        "quantities": ["/energy/initial"],
    }

    def never(source: RouteSource, request: str) -> None:
        raise AssertionError("the question is run")

    monkeypatch.setattr(RouteSource, "answer", never)
    plan = await planned("/v1/studies", study)
    assert (plan["answerable"], plan["errors"]) == (None, [])
    assert (plan["duration"], plan["cost"]["members"], plan["model"]) == ("minutes", 3, None)
    for changes, pointer in (
        ({"quantities": ["no pointer"]}, "/request/quantities/0"),
        ({"quantities": ["/no_such_figure"]}, "/request/quantities/0"),
        ({"vary": [{"pointer": "/nowhere", "values": [1.0]}]}, "/request/vary/0/pointer"),
    ):
        (fault,) = (await planned("/v1/studies", study | changes))["errors"]
        assert fault["pointer"] == pointer
    unknown = study | {"question": {"path": PATH, "request": FREE | {"unknown": 1}}}
    (fault,) = (await planned("/v1/studies", unknown))["errors"]
    assert fault["pointer"] == "/request/question/request/unknown"


@pytest.mark.parametrize("method", INTEGRATORS, ids=lambda method: method.kind)
async def test_every_integrator_is_planned_and_run(method: Any) -> None:
    name = dataclasses.fields(method)[0].name
    request = FREE | {"method": {"kind": method.kind, name: {"step": 0.01, "tolerance": 1e-6}[name]}}
    plan = await planned(PATH, request)
    assert plan["errors"] == []
    assert (await asked(PATH, request)).status_code == 200


def answered(path: str, request: Any) -> tuple[Any, bytes]:
    route = ROUTES[path]
    answer = HANDLER.answer(route, HANDLER.read(route, orjson.dumps(request)))
    text = composed(route, answer, None).whole()
    return orjson.loads(text), text


def test_random_questions_are_drawn_for_every_endpoint() -> None:
    # Fits take longer than the slice of a plan; their examples are planned, as are those of documents.
    assert {*DRAWN, *UNPLANNED, *DOCUMENTS, "/v1/fits"} == set(ROUTES)


@pytest.mark.parametrize("path", DRAWN)
def test_plans_of_random_questions_have_the_figures_of_their_answers(path: str) -> None:
    random, left = Random(path), EACH
    for _ in range(10 * EACH):
        request = DRAWN[path](random)
        plan, _ = answered("/v1/plan", {"path": path, "request": request})
        try:
            answer, text = answered(path, request)
        except (MechanicsError, Refusal) as refused:
            problem = refused.problem if isinstance(refused, Refusal) else problem_of(refused)
            assert {entry["code"] for entry in plan["errors"]} == {problem.type.code}, request
            continue
        assert plan["answerable"], request
        left -= 1
        assert plan["duration"] == "immediate", request
        if path != "/v1/work-precision":
            of_motion = answer if "model" in answer else answer.get("members", [{}])[0]
            assert plan["model"] == of_motion.get("model"), request
            assert plan["cost"]["bytes"] == len(text), request
        if left == 0:
            return
    pytest.fail("nearly all questions are refused")

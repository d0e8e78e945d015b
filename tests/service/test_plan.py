"""Plans: what they foresee is what then happens, and what would be refused is told as it would be."""

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
from core.work import work_limit
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
UNPLANNED = ("/v1/plan", "/v1/assessments", "/v1/variants", "/v1/studies")
# Plans are made of any other question; assessments and variants cost their question. Studies have a test of their own.
PLANNED = [(route, name) for route in ROUTES.values() if route.path not in UNPLANNED for name in route.examples]
PATH = "/v1/rotation/trajectory"
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
DRAWN = questions_of({name_of(scene): scene.outputs for scene in members()})
EACH = int(os.environ.get("RANDOM_QUESTIONS", "40"))
"""How many random questions are asked at each endpoint."""
UNITS = 200_000
"""Work (`core.work`) that no plan of such a question exceeds."""
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


async def asked(path: str, request: Any) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(path, content=orjson.dumps(request), headers={"content-type": "application/json"})


@pytest.mark.parametrize(("route", "name"), PLANNED, ids=[f"{route.path}: {name}" for route, name in PLANNED])
async def test_a_plan_foresees_the_answer(route: PostRoute, name: str) -> None:
    request = dict(route.examples[name].question)
    plan, response = await planned(route.path, request), await asked(route.path, request)
    answer = response.json()
    assert plan["answerable"]
    assert plan["errors"] == []
    if "model" in answer:
        assert plan["model"] == answer["model"]
        assert plan["model"] == answer["model"]
    if route.path == "/v1/scenes":
        # The error of a described scene is only known from its motion.
        assert plan["accuracy"] is None
    elif "model" in answer and request.get("method") is None:
        assert plan["accuracy"]["how"] == answer["accuracy"]["how"]
    if "work" in answer:
        assert plan["cost"]["samples"] in (None, answer.get("requested_samples", answer["work"]["samples"]))
    assert 0.5 <= plan["cost"]["bytes"] / len(response.content) <= 2.0
    assert plan["cost"]["milliseconds"] > 0.0


@pytest.mark.parametrize(
    "method",
    [
        {"kind": "explicit-euler", "step": 0.01},
        {"kind": "runge-kutta-4", "step": 0.05},
        {"kind": "implicit-midpoint", "step": 0.01},
        {"kind": "symmetric-splitting", "step": 0.01},
        {"kind": "dormand-prince-853", "tolerance": 1e-8},
        {"kind": "lsoda", "tolerance": 1e-6},
        {"kind": "radau", "tolerance": 1e-6},
    ],
    ids=lambda method: method["kind"],
)
async def test_evaluations_of_a_method_are_foreseen_within_a_factor_of_two(method: dict[str, Any]) -> None:
    plan, answer = await planned(PATH, FREE | {"method": method}), (await asked(PATH, FREE | {"method": method})).json()
    assert 0.5 <= plan["cost"]["evaluations"] / answer["work"]["evaluations"] <= 2.0
    assert plan["method"] == method
    # An order of magnitude is promised; methods of high order may be off by two.
    assert 1e-2 <= plan["accuracy"]["error"] / answer["accuracy"]["error"] <= 1e2


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


async def test_plans_run_nothing() -> None:
    """A question of a million samples by ten million evaluations is planned in the time of a small one."""
    request = FREE | {"times": {"start": 0.0, "stop": 1e4, "count": 10**6}}
    plan = await planned(PATH, request | {"method": {"kind": "explicit-euler", "step": 1e-3}})
    # Samples lie a little more than ten steps apart; all but the first and the last take one more step each.
    assert plan["cost"]["evaluations"] == 10**7 + 10**6 - 2
    assert plan["cost"]["samples"] == 10**6
    with work_limit(2000):
        answered("/v1/plan", {"path": PATH, "request": request | {"round": "meaningful"}})
    assert plan["cost"]["milliseconds"] > 100.0 * (await planned(PATH, FREE))["cost"]["milliseconds"]


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
    assert (plan["answerable"], plan["errors"]) == (True, [])
    # Of each member: 300,000 evaluations.
    assert plan["cost"]["milliseconds"] > 1.0
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


async def test_rows_that_do_not_change_are_foreseen_as_short_as_they_are() -> None:
    path, sphere = "/v1/rotation/trajectory", {"kind": "ball", "mass": 1.0, "radius": 1.0}
    request = {"body": sphere, "angular_velocity": [0, 0, 1], "times": {"start": 0, "stop": 100, "count": 5000}}
    plan, response = await planned(path, request), await asked(path, request)
    assert plan["cost"]["bytes"] == pytest.approx(len(response.content), rel=0.1)


def answered(path: str, request: Any) -> tuple[Any, bytes]:
    route = ROUTES[path]
    answer = HANDLER.answer(route, HANDLER.read(route, orjson.dumps(request)))
    text = composed(route, answer, None).whole()
    return orjson.loads(text), text


def test_random_questions_are_drawn_for_every_endpoint() -> None:
    assert {*DRAWN, *UNPLANNED} == set(ROUTES)


@pytest.mark.parametrize("path", DRAWN)
def test_model_and_length_of_random_answers_are_foreseen(path: str) -> None:
    random, left = Random(path), EACH
    for _ in range(10 * EACH):
        request = DRAWN[path](random)
        with work_limit(UNITS):
            plan, _ = answered("/v1/plan", {"path": path, "request": request})
        try:
            answer, text = answered(path, request)
        except (MechanicsError, Refusal) as refused:
            problem = refused.problem if isinstance(refused, Refusal) else problem_of(refused)
            # A run that leaves the doubles on its way is not foreseen: nothing of it is run but its first steps.
            if not any(fault.pointer.startswith("/method") for fault in problem.faults):
                assert {entry["code"] for entry in plan["errors"]} == {problem.type.code}, request
            continue
        assert plan["answerable"], request
        of_motion = answer if "model" in answer else answer.get("members", [{}])[0]
        assert plan["model"] == of_motion.get("model"), request
        assert 0.5 <= plan["cost"]["bytes"] / len(text) <= 2.0, request
        left -= 1
        if left == 0:
            return
    pytest.fail("nearly all questions are refused")
